# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `recover`: makes bags whole that were interrupted or damaged."""

from __future__ import annotations

import sys

from .command_line import CommandLine
from .offline_program import run_offline
from .terminal import write

_DESCRIPTION = """\
Make MCAP files whole that were interrupted or damaged: all that is intact in them can be read by
every program then, and what is missing is listed.

A file that is only cut off is finished where it is. Otherwise a new file takes its place, at the
end and at once; the damaged one is kept beside it as FILE.damaged. A file that is whole stays as
it is, and so does one that is being written. Whenever it is interrupted, recovery can be begun
again: nothing is lost on the way."""

_EPILOG = """\
examples:
  recover runs/*.mcap
  recover /media/card/run.mcap --output run.mcap"""


def main(args=None) -> int:
    """Recover; return 0, or 2 with an error on stderr for each file that could not be."""
    return run_offline(_recover, args, 'the output')


def _recover(args, _) -> int:
    parser = _parser()
    options = parser.parse_args(args)
    if options.output and len(options.files) > 1:
        parser.error('--output is for one FILE')
    # Imported here so that --help is quick.
    from ..bag.recovery.recover import recover

    status = 0
    for path in options.files:
        try:
            found = recover(path, options.output)
        except ValueError as error:
            print(f'error: {error}', file=sys.stderr)
            status = 2
            continue
        if not options.quiet:
            for line in _lines(found):
                write(sys.stdout, f'{line}\n')
    return status


def _lines(found):
    """Return what is told of a file, line by line."""
    times = '' if found.first_ns is None else (
        f' from {found.first_ns * 1e-9:.3f} s to {found.last_ns * 1e-9:.3f} s')
    done = 'is whole' if found.was_whole else 'recovered'
    yield f'{found.path}: {done}, {found.messages} messages{times}'
    for hole in found.holes:
        yield f'{found.path}: {hole}'
    if found.kept is not None:
        yield f'{found.path}: the damaged file is kept as {found.kept}'


def _parser() -> CommandLine:
    parser = CommandLine('recover', _DESCRIPTION, _EPILOG)
    add = parser.add_argument
    add('files', metavar='FILE', nargs='+', help='an MCAP file, of any program')
    add('-o', '--output', metavar='FILE',
        help='write there, and leave the damaged file as it is; for one FILE (default: none)')
    add('-q', '--quiet', action='store_true', help='print errors only')
    return parser


if __name__ == '__main__':
    sys.exit(main())
