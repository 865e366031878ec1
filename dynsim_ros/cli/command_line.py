# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the command lines of all executables have in common."""

from __future__ import annotations

import argparse
from typing import NoReturn


class CommandLine(argparse.ArgumentParser):
    """Takes options by their whole names; what is wrong is told in one line."""

    def __init__(self, name: str, description: str, epilog: str | None = None):
        """Take the name of the executable, and what its help begins and ends with."""
        super().__init__(name, description=description, epilog=epilog, allow_abbrev=False,
                         formatter_class=argparse.RawDescriptionHelpFormatter)

    def error(self, message: str) -> NoReturn:
        """Tell what is wrong and exit with 2."""
        self.exit(2, f'error: {message}; {self.prog} --help tells what there is\n')
