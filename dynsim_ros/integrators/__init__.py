# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The integration methods, chosen by name."""

from .adaptive_steps import IntegrationError
from .kernel_kind import kernel_kind
from .methods import DEFAULT_METHOD, method_named, METHODS
from .stepping import new_steps

__all__ = ['DEFAULT_METHOD', 'IntegrationError', 'METHODS', 'kernel_kind', 'method_named',
           'new_steps']
