# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `rerun`: lives a recorded run again, without ROS and as fast as it can."""

from __future__ import annotations

import argparse
import math
import sys
import time

from .command_line import CommandLine
from .offline_program import run_offline
from .progress import Progress
from .simulate import named_values, run_to_end

_DESCRIPTION = """\
Simulate a recorded run again from its bag and compare every recorded state, bit for bit.

FILE is a bag of sim_node, simulate or rerun. Where nothing differs the answer is
'identical, N states', else the first tick, quantity and difference. With what changes the run
(--set, --commands, --scene) or -o it is written to a new bag from --from on: a branch. With
--integrator, --tolerance or --step it is computed by another method, and the largest differences
are told."""

_EPILOG = """\
times are simulated seconds since the run began, as in the stamps of its messages

examples:
  rerun runs/run.mcap
  rerun runs/run.mcap --from 2 --set spring.stiffness=200 -o stiffer.mcap
  rerun runs/run.mcap --from 2 --until 9 --commands pull.yaml --keep-commands
  rerun runs/run.mcap --integrator radau --tolerance 1e-12"""


def main(args=None) -> int:
    """
    Live a run again; return 0, or 1 if it differs or diverges, 2 with an error, 130 if stopped.

    A branch that is stopped or diverges leaves a finished bag.
    """
    return run_offline(_rerun, args, 'the bag')


def _rerun(args, signals) -> int:
    options = _parser().parse_args(args)
    # Imported here so that --help is quick.
    from ..bag.reader import open_bag
    from ..bag.recorded_run import RecordedRun

    is_branch = (options.set or options.commands or options.scene is not None
                 or options.output is not None)
    method = {name: value for name, value in (
        ('integrator', options.integrator), ('tolerance', options.tolerance),
        ('step', options.step)) if value is not None}
    if is_branch and method:
        given = ', '.join(f'--{name}' for name in method)
        raise ValueError(f'{given}: tells how far another method is from the recorded run; for a '
                         'branch give it with --set')
    if options.keep_commands and not options.commands:
        raise ValueError('--keep-commands: goes with --commands only; without it the recorded '
                         'ones are carried out')
    with open_bag(options.file) as bag:
        known_problem = bag.problem
        if known_problem:
            _warn(known_problem)
        run = RecordedRun(bag)
        begin_ns, until_ns = (value if value is None else round(value * 1e9)
                              for value in (options.begin, options.until))
        _check_times(run, begin_ns, until_ns, is_branch)
        if is_branch:
            return _branch(run, begin_ns, until_ns, options, signals)
        if method:
            return _other_method(run, begin_ns, until_ns, method, options.quiet, signals)
        status = _compare(run, begin_ns, until_ns, options.quiet, signals)
        if bag.problem != known_problem:
            _warn(f'{bag.problem}: what could not be read was not compared')
            return status or 1
        return status


def _check_times(run, begin_ns, until_ns, is_branch):
    """Raise ValueError for times that the bag does not hold, or in the wrong order."""
    begin, end = run.begin_ns, run.end_ns
    for name, value in (('--from', begin_ns), ('--until', until_ns)):
        beyond = value is not None and value > end and not (is_branch and name == '--until')
        if value is not None and (value < begin or beyond):
            raise ValueError(f'{name}: {run.path} holds {begin * 1e-9:.9g} s to '
                             f'{end * 1e-9:.9g} s of its run, not {value * 1e-9:.9g} s')
    if until_ns is not None and until_ns <= (begin if begin_ns is None else begin_ns):
        raise ValueError(f'--until: {until_ns * 1e-9:.9g} s is not after the beginning')


def _compare(run, begin_ns, until_ns, quiet, signals) -> int:
    from ..bag.rerun import compare

    progress = _progress(run, run.begin_ns, until_ns, quiet)
    signals.hold()
    started = time.monotonic()
    outcome = compare(run, begin_ns, until_ns, _stopper(progress, run.begin_ns, signals))
    elapsed = time.monotonic() - started
    if signals.requested:
        return 130
    if outcome.difference is not None:
        progress.say(f'different from {outcome.difference}')
        return 1
    if not outcome.states + outcome.hashes:
        progress.clear()
        begin = run.begin_ns if begin_ns is None else begin_ns
        end = run.end_ns if until_ns is None else until_ns
        raise ValueError(f'{run.path} holds no state from {begin * 1e-9:.9g} s to '
                         f'{end * 1e-9:.9g} s: there is nothing to compare')
    seconds = (outcome.time_ns - run.begin_ns) * 1e-9
    progress.say(f'identical, {outcome.states} states ({outcome.hashes} hashes, '
                 f'{outcome.commands} commands; {seconds:g} s lived again in {elapsed:.2f} s)')
    return 0


def _other_method(run, begin_ns, until_ns, method, quiet, signals) -> int:
    from ..bag.rerun import simulator_at
    from ..simulation import DivergenceError, SetValues
    from ..simulation.largest_difference import largest_differences

    one = simulator_at(run, run.begin_ns if begin_ns is None else begin_ns)
    other = one.twin()
    other.apply(SetValues(method))
    _check_method(other.settings.integrator, method)
    end_ns = run.end_ns if until_ns is None else until_ns
    progress = _progress(run, one.time_ns, end_ns, quiet)
    since_ns, since_tick = one.time_ns, one.tick
    signals.hold()
    try:
        found = largest_differences(one, other, run.commands(one.time_ns), end_ns,
                                    _stopper(progress, since_ns, signals))
    except DivergenceError as error:
        progress.clear()
        print(f'error: {error}', file=sys.stderr)
        return 1
    if signals.requested:
        return 130
    named = ', '.join(f'{name} {value}' for name, value in method.items())
    progress.say(f'{named}: largest differences from the recorded run in '
                 f'{(one.time_ns - since_ns) * 1e-9:g} s from tick {since_tick} on')
    for largest in found:
        progress.say(f'  {largest}')
    return 0


def _check_method(integrator, given):
    """Raise ValueError where what was given of a method means nothing to the integrator."""
    from ..integrators import method_named

    has_tolerance = method_named(integrator).advance is None
    useless, useful = ('step', 'tolerance') if has_tolerance else ('tolerance', 'step')
    if useless in given:
        raise ValueError(f'--{useless}: means nothing to {integrator}, which goes by its '
                         f'{useful}; give --{useful}, or another --integrator')


def _branch(run, begin_ns, until_ns, options, signals) -> int:
    from ..bag.bag_names import new_path
    from ..bag.branch import branch, Changes
    from ..bag.run_sink import RunSink
    from ..scene import load_scene
    from ..simulation.command_file import read_commands
    from ..simulation.offline import OfflineRun

    scene = load_scene(options.scene) if options.scene is not None else None
    commands = options.commands and read_commands(
        options.commands, scene or run.simulator.scene)
    made = branch(run, begin_ns, Changes(named_values(options.set), commands,
                                         options.keep_commands, scene))
    simulator = made.simulator
    end_ns = run.end_ns if until_ns is None else until_ns
    if end_ns <= simulator.time_ns:
        raise ValueError(f'--from: nothing follows {simulator.time:.9g} s in {run.path}; give '
                         '--until')
    path = options.output or new_path('runs', simulator.scene.name)
    simulator.prepare()
    begin_ns, tick = simulator.time_ns, simulator.tick
    progress = _progress(run, begin_ns, end_ns, options.quiet)
    signals.hold()
    sink = RunSink(path, simulator, origin_ns=run.origin_ns, node=run.node,
                   compression=options.compression, parent=made.parent,
                   tell=lambda time_ns: progress.show((time_ns - begin_ns) * 1e-9))
    offline = OfflineRun(simulator, made.commands, sink)
    status, error = run_to_end(offline, (end_ns - begin_ns) * 1e-9, sink, progress, signals)
    progress.say(f'branch of {run.path.name} at tick {tick}, {begin_ns * 1e-9:.9g} s, until '
                 f'{simulator.time:.9g} s: {sink.content}')
    if error:
        print(f'error: {error}', file=sys.stderr)
    return status


def _progress(run, begin_ns, until_ns, quiet):
    end_ns = run.end_ns if until_ns is None else until_ns
    return Progress((end_ns - begin_ns) * 1e-9, quiet=quiet)


def _stopper(progress, begin_ns, signals):
    """Return a function of a Simulator that shows how far it is and tells whether to stop."""
    def is_stopped(simulator):
        progress.show((simulator.time_ns - begin_ns) * 1e-9)
        return signals.requested
    return is_stopped


def _warn(text):
    print(f'warning: {text}', file=sys.stderr)


def _parser() -> CommandLine:
    parser = CommandLine('rerun', _DESCRIPTION, _EPILOG)
    add = parser.add_argument
    add('file', metavar='FILE', help='the bag')
    add('--from', dest='begin', type=_seconds, metavar='SECONDS',
        help='compare from there on, or begin the branch at the first tick at or after it '
             '(default: the beginning of the bag)')
    add('--until', type=_seconds, metavar='SECONDS',
        help='end there; a branch can go on beyond the bag (default: the end of the bag)')
    add('-s', '--set', nargs='+', action='extend', default=[], metavar='NAME=VALUE',
        help='change quantities of the scene and settings where the branch begins')
    add('-c', '--commands', metavar='FILE',
        help='timed commands, a YAML file as for simulate, instead of the recorded ones')
    add('--keep-commands', action='store_true', help='with --commands: the recorded ones as well')
    add('--scene', metavar='SCENE',
        help='go on with another scene, a name or the path of a YAML file')
    add('-o', '--output', metavar='FILE',
        help='the bag of the branch; never overwritten (default runs/<scene>_<date>_<time>.mcap)')
    add('--compression', choices=('zstd', 'lz4', 'none'), default='zstd',
        help='of the bag of the branch (default zstd)')
    add('--integrator', metavar='NAME', help='compute it by another method and compare')
    add('--tolerance', type=float, metavar='X', help='with another tolerance, likewise')
    add('--step', type=float, metavar='SECONDS', help='with another fixed step, likewise')
    add('-q', '--quiet', action='store_true', help='print warnings and errors only')
    return parser


def _seconds(text) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 <= value <= 1e9:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number of seconds from 0 to 1e9")
    return value


if __name__ == '__main__':
    sys.exit(main())
