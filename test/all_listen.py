# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Topics that are published whoever listens."""


class AllListen:
    """As Audience, where somebody listens to every publisher."""

    version = 0

    def of(self, create):
        return create(None)

    def hears(self, publisher):
        return True
