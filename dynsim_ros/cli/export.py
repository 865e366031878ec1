# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `export`: a bag as CSV files, or as arrays of numpy."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
import sys

from .bag_options import add_selection, load_selection
from .command_line import CommandLine
from .offline_program import run_offline

_DESCRIPTION = """\
Write the messages of a bag to files for other programs.

FILE is an MCAP file, of this package or any other, or the folder of a rosbag2 recording; of a file
that was cut off, what can be read is written. OUTPUT becomes a folder with a CSV file for each
topic, the time first, or one .npz file of numpy if its name ends so."""

_EPILOG = """
examples:
  export runs/run.mcap
  export runs/run.mcap -o tables --topics '*/pose' energy --start 2 --end 5
  export runs/run.mcap -o run.npz"""


def main(args: Sequence[str] | None = None) -> int:
    """Export a bag; return 0, 2 with an error on stderr, or 130 if stopped."""
    return run_offline(_export, args, 'the output')


def _export(args: Sequence[str], _) -> int:
    options = _parser().parse_args(args)
    # Imported here so that --help is quick.
    from ..bag.export_files import write_arrays, write_folder

    run = load_selection(options, options.file)
    output = Path(options.output or Path(options.file).stem)
    if not (run or run.irregular):
        raise ValueError(f'{options.file} holds no message that could be written')
    as_arrays = output.suffix == '.npz'
    for topic, reason in run.left_out.items():
        if as_arrays or topic not in run.irregular:
            print(f'warning: left out: {topic} ({reason})', file=sys.stderr)
    names = write_arrays(run, output) if as_arrays else write_folder(run, output)
    if not options.quiet:
        print(f'{output}: ' + ', '.join(names))
    return 0


def _parser() -> CommandLine:
    """Return the parser of the command line."""
    parser = CommandLine('export', _DESCRIPTION, _EPILOG)
    parser.add_argument('file', metavar='FILE', help='the bag')
    parser.add_argument('-o', '--output', metavar='OUTPUT',
                        help='the folder, or a file that ends in .npz; never overwritten '
                             '(default: the name of the bag without its ending, here)')
    add_selection(parser)
    parser.add_argument('-q', '--quiet', action='store_true',
                        help='print warnings and errors only')
    return parser


if __name__ == '__main__':
    sys.exit(main())
