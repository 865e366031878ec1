# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Where this package's scenes, configuration and launch files lie, however it was installed."""

import os
from pathlib import Path
import sys

_NAME = 'dynsim_ros'


class ShareError(ValueError):
    """The package's own files were not found; one line of text."""


def share_directory():
    """
    Find the folder that holds scenes/, config/ and launch/, as a Path.

    Looked at, in this order: the source tree (also when installed editable, or by colcon with
    --symlink-install), share/dynsim_ros in each folder above the package (pip, colcon),
    share/dynsim_ros in each prefix of AMENT_PREFIX_PATH, and in the Python's own prefix.
    Raises ShareError where none of them has it.
    """
    package = Path(__file__).absolute().parent
    for candidate in _candidates(package):
        if (candidate / 'scenes').is_dir():
            return candidate
    raise ShareError(
        f'share/{_NAME} with its scenes was found neither above {package} nor in '
        'AMENT_PREFIX_PATH: install the package again, or source its workspace')


def _candidates(package):
    for folder in (package, package.resolve()):
        if (folder.parent / 'package.xml').is_file():
            yield folder.parent
    for above in (*package.parents, *package.resolve().parents):
        yield above / 'share' / _NAME
    for prefix in os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep):
        if prefix:
            yield Path(prefix, 'share', _NAME)
    yield Path(sys.prefix, 'share', _NAME)
