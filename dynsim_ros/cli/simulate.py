# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `simulate`: runs a scene without ROS processes, as fast as it can."""

from __future__ import annotations

import argparse
import sys
import time

from .command_line import CommandLine
from .offline_program import run_offline
from .progress import Progress

_DESCRIPTION = """\
Simulate a scene into a bag, without any ROS process and as fast as the machine can.

The bag is the same that the live node records: same topics, same bytes (but for /diagnostics,
which tells about a live process). SCENE is the name of a scene that comes with the package, or
the path of a YAML file."""

_EPILOG = """
settings and quantities for --set, with their defaults:
{settings}
  and every quantity of the scene, such as gravity [m/s^2], <body>.mass [kg],
  <body>.position [m], <spring>.stiffness [N/m]; lists as [x,y,z], quaternions as [x,y,z,w]

a file of commands is a YAML list:
  - {{time: 1.0, anchor: hand, position: [0.2, 0, 2]}}           s, m
  - {{time: 2.0, body: sphere, force: [0, 5, 0]}}                N (also torque: N m)
  - {{time: 3.0, set: {{spring.stiffness: 200, gravity: 1.62}}}}

scenes: {scenes}

examples:
  simulate sphere_on_spring --duration 10 --output run.mcap
  simulate two_anchors --set rate=1000 step=0.0005 sphere.mass=0.8 --commands pull.yaml"""


def main(args=None) -> int:
    """
    Simulate; return 0, 2 with an error on stderr, 1 if the motion diverged, 130 if stopped.

    The bag is finished in any case.
    """
    return run_offline(_simulate, args, 'the bag')


def _simulate(args, signals) -> int:
    options = _parser(args).parse_args(args)
    # Imported here so that --help is quick.
    from ..bag.bag_names import new_path
    from ..bag.run_sink import RunSink
    from ..scene import load_scene
    from ..simulation.command_file import read_commands
    from ..simulation.error_estimate import estimate_error
    from ..simulation.offline import OfflineRun, simulator_with

    simulator = simulator_with(load_scene(options.scene), named_values(options.set))
    commands = read_commands(options.commands, simulator.scene) if options.commands else []
    path = options.output or new_path('runs', simulator.scene.name)
    progress = Progress(options.duration, quiet=options.quiet)
    progress.say(f'{simulator.scene.name}: {options.duration:g} s with '
                 f'{simulator.settings.integrator} at {simulator.settings.rate:g} Hz')
    simulator.prepare()
    signals.hold()
    bag = RunSink(path, simulator, compression=options.compression,
                  tell=lambda time_ns: progress.show(time_ns * 1e-9))
    run = OfflineRun(simulator, commands, bag)
    started = time.monotonic()
    status, error = run_to_end(run, options.duration, bag, progress, signals)
    elapsed = time.monotonic() - started
    if simulator.shortfall:
        progress.say(simulator.shortfall)
    progress.say(f'{simulator.time:g} s simulated in {elapsed:.2f} s '
                 f'({simulator.time / elapsed:.3g} times real time); '
                 f'{bag.content}')
    if run.commands and status == 0:
        progress.say(f'{len(run.commands)} commands lie at the end or behind it and were not '
                     f'carried out, the first at {run.commands[0][0] * 1e-9:g} s')
    if options.error and status == 0:
        # The run itself again, from its start, and a finer one.
        try:
            estimate = estimate_error(simulator, commands, options.duration)
        except ValueError as none:
            raise ValueError('--error: nothing more exact to compare the run with: '
                             f'{none}') from None
        print(f'error at the end, estimated: {estimate}')
    if error:
        print(f'error: {error}', file=sys.stderr)
    return status


def run_to_end(run, duration, bag, progress, signals):
    """Run into a RunSink and finish it; return the exit status and what went wrong, or None."""
    from ..simulation import DivergenceError

    status, error = 0, None
    try:
        # Without a bag there is no use in going on.
        run.run(duration, lambda: signals.requested or bag.is_failing)
    except DivergenceError as diverged:
        status, error = 1, str(diverged)
    finally:
        bag.close()
        progress.clear()
    if bag.error:
        return 2, bag.error
    return (130 if signals.requested else status), error


def named_values(assignments) -> dict:
    """Return {name: value} from texts NAME=VALUE; raise ValueError."""
    from ..scene import load_yaml

    values = {}
    for text in assignments:
        name, equals, value = text.partition('=')
        if not equals or not name:
            raise ValueError(f"--set: '{text}' is not of the form NAME=VALUE")
        if name.strip() in values:
            raise ValueError(f'--set {text}: {name.strip()} is set twice')
        try:
            values[name.strip()] = load_yaml(value)
        except ValueError as error:
            raise ValueError(f'--set {text}: {error}') from None
    return values


def _parser(own) -> CommandLine:
    parser = CommandLine('simulate', _DESCRIPTION)
    if {'-h', '--help'} & set(own):
        # Takes a while to gather.
        parser.epilog = _epilog()
    add = parser.add_argument
    add('scene', metavar='SCENE', help='name of a scene, or the path of a YAML file')
    add('-d', '--duration', type=_seconds, default=10.0, metavar='SECONDS',
        help='simulated time (default 10 s)')
    add('-o', '--output', metavar='FILE',
        help='the bag; never overwritten (default runs/<scene>_<date>_<time>.mcap)')
    add('-s', '--set', nargs='+', action='extend', default=[], metavar='NAME=VALUE',
        help='change quantities of the scene and settings before the start')
    add('-c', '--commands', metavar='FILE', help='timed commands, a YAML file')
    add('--compression', choices=('zstd', 'lz4', 'none'), default='zstd',
        help='of the bag (default zstd)')
    add('-e', '--error', action='store_true',
        help='estimate the error at the end, by a finer second run')
    add('-q', '--quiet', action='store_true', help='print errors, and what -e is for, only')
    return parser


def _epilog() -> str:
    from ..scene import scene_names
    from ..simulation.settings import setting_description, SETTING_NAMES, Settings

    settings = Settings()
    rows = [f'  {name:22} {getattr(settings, name)!s:10} {setting_description(name)}'
            for name in SETTING_NAMES]
    return _EPILOG.format(settings='\n'.join(rows), scenes=', '.join(scene_names()))


def _seconds(text) -> float:
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 1e-9 <= value <= 1e9:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number of seconds from 1e-9 to 1e9")
    return value


if __name__ == '__main__':
    sys.exit(main())
