# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Where a Chromium is, in which the tests of test/browser open the viewer's pages.

As a script: ends with an error where there is none.
"""

import os
import shutil
import sys

NAMES = ('chromium', 'chromium-browser', 'google-chrome', 'google-chrome-stable')
MISSING = ('no Chromium was found: install one (Debian: apt install chromium), or give the path '
           'of one as CHROMIUM')


def chromium():
    """Return the path of a Chromium, None where there is none."""
    return os.environ.get('CHROMIUM') or next(filter(None, map(shutil.which, NAMES)), None)


if __name__ == '__main__' and chromium() is None:
    sys.exit(f'error: {MISSING}')
