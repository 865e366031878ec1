# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Compile for this machine what scenes need, so that their first run starts at once.

Usage: python -m dynsim_ros.cli.warm_up [SCENE ...] (default: sphere_on_spring). What is compiled
serves all scenes with the same kinds of bodies and forces, and stays in the user's cache folder.
"""

import sys
import time


def main(args=None) -> int:
    """Compile; return 0, or 2 with an error on stderr."""
    from ..bag.chunk_records import prepare_finding
    from ..bag.pack_rows import prepare_packing
    from ..scene import load_scene
    from ..simulation import Simulator

    for name in (sys.argv[1:] if args is None else args) or ['sphere_on_spring']:
        started = time.monotonic()
        try:
            Simulator(load_scene(name)).prepare()
            prepare_packing()
            prepare_finding()
        except ValueError as error:
            print(f'error: {error}', file=sys.stderr)
            return 2
        print(f'{name}: ready in {time.monotonic() - started:.1f} s')
    return 0


if __name__ == '__main__':
    sys.exit(main())
