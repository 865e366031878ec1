# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the executables that need no ROS have in common: signals and errors."""

from __future__ import annotations

from collections.abc import Callable, Sequence
import sys

from .signals import Signals


def run_offline(program: Callable[[Sequence[str], Signals], int], args: Sequence[str] | None,
                output: str) -> int:
    """
    Run program(arguments, signals); return its status, 2 after an error, 130 if stopped.

    args: None for those of the process, which then ends by itself; output: what an OSError is
    about that does not name its file.
    """
    signals = Signals()
    try:
        return signals.run(
            lambda: program(sys.argv[1:] if args is None else args, signals), stopped=130)
    except (ValueError, ImportError) as error:
        print(f'error: {error}', file=sys.stderr)
    except OSError as error:
        print(f'error: {error.filename or output}: {error.strerror}; choose another --output',
              file=sys.stderr)
    finally:
        if args is None:
            signals.ignore()
    return 2
