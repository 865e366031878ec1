# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `replay`: publishes a recorded bag again."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
import math
import sys

from .command_line import CommandLine
from .progress import Progress
from .ros_arguments import split
from .signals import Signals

_DESCRIPTION = """\
Publish the messages of a bag on the topics they were recorded from, with the recorded timing.

FILE is an MCAP file, of this package or any other whose message types are installed, or the
folder of a rosbag2 recording. Of a file that was cut off, what can be read is played."""

_EPILOG = """\
services while playing (std_srvs/srv/Trigger):
  ~/pause, ~/resume    hold the time of the bag, and let it go on (/dynsim_replay/pause ...)

examples:
  replay runs/run.mcap --rate 0.5 --clock
  replay runs/run.mcap --topics '/dynsim/*/pose' --remap /dynsim/sphere/pose:=/ghost/pose
  replay runs/run.mcap --start-offset 2 --duration 5 --loop --ros-args -r __ns:=/lab"""


def main(args: Sequence[str] | None = None) -> int:
    """Replay a bag; return 0, also when stopped by a signal, or 2 with an error on stderr."""
    signals = Signals()
    try:
        return signals.run(lambda: _replay(sys.argv[1:] if args is None else args, signals))
    except ImportError as error:
        print(f'error: {error}: install or source ROS 2 Jazzy', file=sys.stderr)
    except ValueError as error:
        print(f'error: {error}', file=sys.stderr)
    finally:
        if args is None:
            signals.ignore()
    return 2


def _replay(args: Sequence[str], signals: Signals) -> int:
    """Open the bag, start the node and play."""
    own, ros_args = split(args)
    options = _parser().parse_args(own)
    # Imported here so that --help needs no ROS.
    from ..bag.reader import open_bag
    from ..ros.replayer import Replayer, ReplayOptions
    from ..ros.serving import serving

    with open_bag(options.file) as bag:
        known_problem = bag.problem
        if known_problem:
            _warn(known_problem)
        # What follows starts a thread, which nothing may interrupt.
        signals.hold()
        with serving('dynsim_replay', ros_args) as node:
            player = Replayer(node, bag, ReplayOptions(
                rate=options.rate, loop=options.loop, start_offset=options.start_offset,
                duration=options.duration, topics=options.topics, remap=dict(options.remap),
                clock_hz=options.clock, start_paused=options.start_paused, wait=options.wait,
                wait_acked=options.wait_acked))
            for warning in player.warnings:
                _warn(warning)
            _play(player, bag, options.quiet, signals)
        if bag.problem != known_problem:
            _warn(bag.problem)
    return 0


def _play(player, bag, quiet: bool, signals: Signals):
    """Play, showing how far it is, until the end or a signal."""
    progress = Progress(player.duration, quiet=quiet)
    progress.say(f'{bag.path}: {len(player.topics)} topics, playing {player.duration:.3f} s'
                 + (', paused: call the service ~/resume to start' if player.paused else ''))

    def report(seconds: float):
        state = ', paused' if player.paused else ''
        progress.show(seconds, f'{player.published} messages{state}')

    try:
        finished = player.run(signals.is_requested, report)
    finally:
        progress.clear()
    progress.say(('replayed' if finished else 'stopped after') + f' {player.published} messages')


def _parser() -> CommandLine:
    """Return the parser of the command line, without the part that belongs to ROS."""
    parser = CommandLine('replay', _DESCRIPTION, _EPILOG)
    add = parser.add_argument
    add('file', metavar='FILE', help='the bag')
    add('-r', '--rate', type=_positive, default=1.0, metavar='X',
        help='seconds of the bag per second, above 0 (default 1)')
    add('-l', '--loop', action='store_true', help='begin again at the end, until stopped')
    add('--start-offset', type=_not_negative, default=0.0, metavar='SECONDS',
        help='leave out the beginning of the bag (default 0 s)')
    add('--duration', type=_not_negative, metavar='SECONDS',
        help="play so much of the bag's time (default: all that is left, in s)")
    add('--topics', nargs='+', action='extend', default=[], metavar='TOPIC',
        help='play only these recorded topics; * and ? stand for any text (default: all)')
    add('--remap', nargs='+', action='extend', default=[], type=_renaming, metavar='OLD:=NEW',
        help='publish a recorded topic under another name (default: none)')
    add('--clock', nargs='?', type=_positive, const=40.0, default=0.0, metavar='HZ',
        help="publish the bag's time on /clock, HZ times a second (default: off; "
             'without HZ: 40 Hz)')
    add('--start-paused', action='store_true', help='wait for the service ~/resume to begin')
    add('--wait', type=_not_negative, default=3.0, metavar='SECONDS',
        help='wait at most so long for each topic to have a subscriber before the first message, '
             'and 1 s once one has; not with --start-paused (default 3 s)')
    add('--wait-acked', type=_not_negative, default=3.5, metavar='SECONDS',
        help='wait at most so long at the end until subscribers have confirmed the last messages; '
             'most DDS ask them every 3 s (default 3.5 s)')
    add('-q', '--quiet', action='store_true', help='print warnings and errors only')
    return parser


def _positive(text: str) -> float:
    """Return a number above 0."""
    value = _number(text)
    if not 1e-6 <= value <= 1e6:
        raise argparse.ArgumentTypeError(f'{text} is out of range: 1e-06 to 1e+06')
    return value


def _not_negative(text: str) -> float:
    """Return a number of at least 0."""
    value = _number(text)
    if not 0 <= value <= 1e9:
        raise argparse.ArgumentTypeError(f'{text} s is out of range: 0 to 1e+09 s')
    return value


def _number(text: str) -> float:
    """Return a finite number."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"'{text}' is not a number")
    return value


def _renaming(text: str) -> tuple[str, str]:
    """Return the two names of OLD:=NEW."""
    old, separator, new = text.partition(':=')
    if not (old and separator and new):
        raise argparse.ArgumentTypeError(f"'{text}' is not of the form OLD:=NEW")
    return old, new


def _warn(text: str | None):
    """Print a warning."""
    print(f'warning: {text}', file=sys.stderr)


if __name__ == '__main__':
    sys.exit(main())
