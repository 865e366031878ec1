# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `sim_node`: simulates a scene live on ROS 2."""

from __future__ import annotations

import gc
import inspect
import os
import sys

from .command_line import CommandLine
from .ros_arguments import split
from .signals import Signals
from .status_line import StatusLine

_DESCRIPTION = """\
Simulate a scene of bodies on spring-dampers as a ROS 2 node, in real time.

Publishes poses, twists and wrenches, takes commands, parameters and services, and records
runs to MCAP. Everything but the options below is a ROS parameter."""

_TOPICS = """
and every quantity of the scene, such as gravity [m/s^2], air.linear_drag [N s/m],
<body>.mass [kg], <spring>.stiffness [N/m], <spring>.damping [N s/m],
<spring>.natural_length [m], <anchor>.position [m]; see: ros2 param describe /dynsim NAME

topics, relative to ~/ (/dynsim): <body>/pose, <body>/twist, <body>/wrench/{spring,damper,air,
gravity,net}, <anchor>/pose, energy, markers, epoch, state_hash; also /diagnostics, /tf (if
tf2_msgs is installed) and, if asked for, /clock
commands: <anchor>/command (PointStamped), <body>/wrench_command (WrenchStamped),
parameter_command (rcl_interfaces/Parameter)
services: ~/pause and ~/record (SetBool), ~/step, ~/step_until, ~/reset, ~/save_state,
~/load_state and ~/rewind (Trigger); also those of simulation_interfaces (if it is installed)

examples:
  sim_node --ros-args -p scene:=double_pendulum_of_spheres -p record.enable:=true
  sim_node --ros-args -p scene:=./my_scene.yaml -p rate:=1000.0 -p duration:=10.0
  sim_node --ros-args -p spring.stiffness:=250.0 -p sphere.mass:=2.0 -r __ns:=/lab"""


def main(args=None) -> int:
    """Run the node; return 0, also when stopped by a signal, or 2 with an error on stderr."""
    signals = Signals()
    # Other threads give the interpreter back sooner, so that ticks are less late.
    sys.setswitchinterval(0.0005)
    try:
        return signals.run(lambda: _simulate(sys.argv[1:] if args is None else args, signals))
    except ImportError as error:
        print(f'error: {error}: install or source ROS 2 Jazzy', file=sys.stderr)
    except ValueError as error:
        print(f'error: {error}', file=sys.stderr)
    finally:
        if args is None:
            signals.ignore()
    return 2


def _simulate(args, signals) -> int:
    own, ros_args = split(args)
    options = _parser(own).parse_args(own)
    # Imported here so that --help needs no ROS.
    from ..ros.context import ros_context, spinning
    from ..ros.sim_node import SimNode

    line = StatusLine(not options.quiet and (options.status or sys.stdout.isatty()))
    with ros_context('sim_node', ros_args):
        line.show('starting: loading the kernels (compiling them takes a while the first time)')
        try:
            node = SimNode(is_ending=signals.is_requested, aside=line.aside)
            _settle()
            signals.hold()
        finally:
            line.end()
        try:
            with spinning(node) as spin_some:
                node.begin()
                _spin_until_end(node, spin_some, signals, line)
        finally:
            line.end()
            has_ended = node.end()
            node.destroy_node()
    if not has_ended:
        _leave()
    return 0


def _settle():
    """Do now what would hold up ticks later: the first line in a log does, and all numba keeps."""
    inspect.getframeinfo(inspect.currentframe())
    gc.collect()
    gc.freeze()


def _leave():
    """End the process here: a thread that compiles cannot be ended, nor left behind by Python."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)


def _spin_until_end(node, spin_some, signals, line):
    while not (signals.requested or node.run.finished or node.ticker.error):
        spin_some(0.1)
        if line.is_due():
            line.show(node.ticker.mailbox.ask(lambda: _status(node)))
    if node.ticker.error:
        raise node.ticker.error


def _status(node) -> str:
    """Return the state of a run in one line; within the run's thread."""
    simulator, bag = node.run.simulator, node.run.bag
    snapshot = simulator.snapshot()
    body = snapshot.layout.bodies[0]
    x, y, z = snapshot.position(body)
    state = 'diverged' if simulator.failure else 'paused' if node.run.paused else 'running'
    recorded = f'{bag.recorder.messages} recorded' if bag else 'not recording'
    factor = node.diagnostics.real_time_factor
    pace = '    -' if factor is None else f'{factor:5.2f}'
    return (f'{state}  t {simulator.time:9.3f} s  x{pace}  '
            f'{body} ({x:+.4f}, {y:+.4f}, {z:+.4f}) m  E {snapshot.energy.total:.5f} J  '
            f'{recorded}')


def _parser(own) -> CommandLine:
    """Return the parser of the command line, without the part that belongs to ROS."""
    parser = CommandLine('sim_node', _DESCRIPTION)
    if {'-h', '--help'} & set(own):
        # Takes a while to gather.
        parser.epilog = _epilog()
    parser.add_argument('--status', action='store_true',
                        help='show a status line also where the output is no terminal '
                             '(default: on a terminal only)')
    parser.add_argument('-q', '--quiet', action='store_true', help='show no status line')
    return parser


def _epilog() -> str:
    """Return parameters with units and defaults, topics and services."""
    from ..ros.own_parameters import OWN
    from ..simulation.settings import setting_description, SETTING_NAMES, Settings

    settings = Settings()
    rows = [(name, own.default, own.description) for name, own in OWN.items()]
    rows += [(name, getattr(settings, name), setting_description(name)) for name in SETTING_NAMES]
    parameters = [f'  {name:22} {_shown(default):18} {description}'
                  for name, default, description in rows]
    return '\n'.join(['parameters (-p name:=value behind --ros-args), their defaults:',
                      *parameters, _TOPICS])


def _shown(value) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


if __name__ == '__main__':
    sys.exit(main())
