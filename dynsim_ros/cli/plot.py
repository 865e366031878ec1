# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `plot`: figures of a recorded run, alone or beside another one."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
import sys

from .bag_options import add_selection, load_selection
from .command_line import CommandLine
from .offline_program import run_offline

_DESCRIPTION = """\
Draw what a bag has of positions, orientations, velocities, wrenches and energies against time.

FILE is an MCAP file, of this package or any other, or the folder of a rosbag2 recording; of a file
that was cut off, what can be read is drawn. Every axis has its unit; orientations are quaternions
x y z w. Anchors are drawn if they move, or if --topics names them. Large bags are thinned to what
can be seen, peaks stay. Needs matplotlib."""

_EPILOG = """
examples:
  plot runs/run.mcap
  plot runs/run.mcap -o figure.pdf --topics 'sphere/*' --start 2 --end 5
  plot runs/run.mcap --compare runs/other.mcap -o both.svg --topics '*/pose' energy"""


def main(args: Sequence[str] | None = None) -> int:
    """Plot a bag; return 0, 2 with an error on stderr, or 130 if stopped."""
    return run_offline(_plot, args, 'the figure')


def _plot(args: Sequence[str], _) -> int:
    options = _parser().parse_args(args)
    try:
        # Imported here so that --help is quick, and works without it.
        from .plot_figure import draw, ENDINGS
    except ModuleNotFoundError as error:
        if error.name.partition('.')[0] != 'matplotlib':
            raise
        raise ImportError('plot needs matplotlib: pip install matplotlib') from None

    output = Path(options.output or f'{Path(options.file).stem}.png')
    if output.suffix not in ENDINGS:
        raise ValueError(f"--output {output}: its ending is '{output.suffix}', a figure can be "
                         + ', '.join(ENDINGS))
    runs = [load_selection(options, path) for path in (options.file, options.compare) if path]
    drawn = _drawn(runs, bool(options.topics))
    label = 'simulated time [s]' if runs[0].info else 'time since the first message [s]'
    draw(drawn, label, output, _names(runs) if options.compare else None)
    if not options.quiet:
        print(output)
    return 0


def _drawn(runs, all_anchors: bool):
    """Return what is drawn of a run, beside another one if there are two; raise ValueError."""
    from .plot_comparison import pair
    from .plot_panels import bands, moving_anchors

    anchors = None if all_anchors else set().union(*map(moving_anchors, runs))
    found = [bands(run, anchors) for run in runs]
    for run, blocks in zip(runs, found):
        if not blocks:
            raise ValueError(f'{run.path} holds nothing to plot: there is no pose, twist, wrench '
                             'or energy among what is asked for')
    alone = pair(*found) if len(found) > 1 else []
    if alone:
        print(f'warning: only in one of the two: {", ".join(alone)}', file=sys.stderr)
    return found[0]


def _names(runs) -> tuple[str, str]:
    """Return what two runs are called in the figure."""
    first, second = (run.path for run in runs)
    return (first.name, second.name) if first.name != second.name else (str(first), str(second))


def _parser() -> CommandLine:
    """Return the parser of the command line."""
    parser = CommandLine('plot', _DESCRIPTION, _EPILOG)
    parser.add_argument('file', metavar='FILE', help='the bag')
    parser.add_argument('-o', '--output', metavar='FIGURE',
                        help='the figure: .png, .pdf or .svg (default: the name of the bag with '
                             '.png, here)')
    parser.add_argument('--compare', metavar='OTHER',
                        help='another bag, drawn over this one, with the difference below')
    add_selection(parser)
    parser.add_argument('-q', '--quiet', action='store_true',
                        help='print warnings and errors only')
    return parser


if __name__ == '__main__':
    sys.exit(main())
