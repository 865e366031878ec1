# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded run lived again: to compare it with itself, or to go on from an instant of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from .comparison import Comparison, Difference
from .reader import BagError
from .recorded_run import RecordedRun
from ..scene import SceneError
from ..simulation import DivergenceError, Simulator
from ..simulation.settings import SECOND


@dataclass(frozen=True)
class Outcome:
    """
    What came of a comparison: instants and hashes that were equal, commands that were carried out.

    difference: the first one, or None; time_ns: how far it went.
    """

    states: int
    hashes: int
    commands: int
    time_ns: int
    difference: Difference | None


def compare(run: RecordedRun, begin_ns: int | None = None, end_ns: int | None = None,
            is_stopped: Callable[[Simulator], bool] = lambda simulator: False) -> Outcome:
    """
    Simulate a recorded run again and compare every recorded state, bit for bit.

    begin_ns, end_ns: simulated time, compare what lies between only; is_stopped: asked again and
    again. Raises BagError for a command that cannot be read or carried out.
    """
    simulator = run.simulator.twin()
    comparison = Comparison(run.channels, simulator.layout)
    difference, commands = None, 0
    for time_ns, command, messages in run.events(end_ns):
        if difference is not None or is_stopped(simulator):
            break
        if messages is not None and begin_ns is not None and time_ns < begin_ns:
            continue
        difference = _go_on(simulator, time_ns)
        if difference is None and messages is not None:
            difference = comparison.difference(simulator, time_ns + run.origin_ns, messages)
        elif difference is None and command is not None:
            _carry_out(run, simulator, command)
            commands += 1
    return Outcome(comparison.states, comparison.hashes, commands, simulator.time_ns, difference)


def simulator_at(run: RecordedRun, time_ns: int) -> Simulator:
    """
    Return a Simulator at the first tick at or after an instant of a recorded run.

    It stands there as the run did before it was commanded anything at that tick. Raises BagError
    for an instant that the bag does not hold.
    """
    if not run.begin_ns <= time_ns <= run.end_ns:
        raise BagError(f'{run.path} holds {run.begin_ns / SECOND:.9g} s to '
                       f'{run.end_ns / SECOND:.9g} s of its run, not {time_ns / SECOND:.9g} s')
    simulator = run.simulator.twin()
    for at_ns, command in run.commands():
        if at_ns >= time_ns:
            break
        difference = _go_on(simulator, at_ns)
        if difference is not None:
            raise BagError(f'{run.path}: not reproduced: {difference}')
        _carry_out(run, simulator, command)
    ticks = -((simulator.time_ns - time_ns) // simulator.settings.tick_ns)
    try:
        simulator.advance_ticks(max(ticks, 0))
    except DivergenceError as error:
        raise BagError(f'{run.path}: not reproduced: {error}') from None
    return simulator


def _go_on(simulator, time_ns):
    """Advance to an instant of the recorded run; return a Difference if that is not possible."""
    try:
        if time_ns != simulator.time_ns:
            simulator.advance_to(time_ns)
    except ValueError:
        return Difference(simulator.tick, simulator.time_ns, 'the instant that comes next',
                          f'{time_ns / SECOND:.9f} s', 'no tick')
    except DivergenceError as error:
        return Difference(simulator.tick, simulator.time_ns, 'the motion', 'finite', str(error))
    return None


def _carry_out(run, simulator, command):
    try:
        simulator.apply(command)
    except SceneError as error:
        raise BagError(f'{run.path}: the command of tick {simulator.tick}, '
                       f'{simulator.time:.9g} s, cannot be carried out: {error}') from None
