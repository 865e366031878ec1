# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a recorded run might have become: it goes on differently from an instant on."""

from __future__ import annotations

from dataclasses import dataclass

from .recorded_run import RecordedRun
from .rerun import simulator_at
from ..scene import scene_quantities, SceneError
from ..simulation import SetValues, Simulator
from ..simulation.carry_over import carried_over
from ..simulation.changes import changed
from ..simulation.commands import checked
from ..simulation.settings import SECOND, SETTING_NAMES
from ..simulation.state_hash import state_hash


@dataclass(frozen=True)
class Changes:
    """
    What is to be different from there on, None for what is not.

    values: {name: value} of quantities and settings; commands: [(time_ns, command)] instead of the
    recorded ones, or with keep_commands beside them; scene: Scene.
    """

    values: dict | None = None
    commands: list | None = None
    keep_commands: bool = False
    scene: object = None


@dataclass(frozen=True)
class Branch:
    """A Simulator where a branch begins, its commands, and what its bag says of its parent."""

    simulator: Simulator
    commands: list
    parent: dict[str, str]


def branch(run: RecordedRun, begin_ns: int | None, changes: Changes) -> Branch:
    """
    Return the Branch of a recorded run at the first tick at or after an instant.

    begin_ns: None for the beginning of the bag; where that is the beginning of the run, another
    scene begins as it says, and initial conditions can be among the values. Raises BagError, or
    SceneError for changes that are not possible.
    """
    simulator = simulator_at(run, run.begin_ns if begin_ns is None else begin_ns)
    parent = parent_of(run.path.name, simulator)
    recorded, values = run.commands(simulator.time_ns), dict(changes.values or {})
    if begin_ns is None and _has_just_begun(simulator):
        simulator = _begun(simulator, changes.scene or simulator.scene, values)
        values.clear()
    elif changes.scene is not None:
        simulator = carried_over(simulator, changes.scene)
    commands = _commands(simulator, recorded, changes)
    if values:
        simulator.changed_by(values)
        # The last word at the instant at which the branch begins.
        place = sum(time_ns <= simulator.time_ns for time_ns, _ in commands)
        commands.insert(place, (simulator.time_ns, SetValues(values)))
    return Branch(simulator, commands, parent)


def parent_of(name: str, simulator: Simulator) -> dict[str, str]:
    """Return what a bag says of its parent; name: of its file; simulator: where it is left."""
    return {'parent': name, 'parent_epoch': str(simulator.epoch),
            'parent_tick': str(simulator.tick), 'parent_time_ns': str(simulator.time_ns),
            'parent_hash': state_hash(simulator.snapshot())}


def _has_just_begun(simulator):
    """Tell whether nothing has happened yet to a simulator."""
    fresh = Simulator(simulator.scene, simulator.settings)
    return state_hash(fresh.snapshot()) == state_hash(simulator.snapshot())


def _begun(simulator, scene, values):
    """Return a Simulator that begins with a scene, some of its values changed."""
    begun = Simulator(*changed(scene, simulator.settings, values, at_start=True))
    begun.epoch = simulator.epoch
    return begun


def _commands(simulator, recorded, changes):
    """Return the commands of a branch in order of time."""
    if changes.commands is None:
        return _possible(simulator.scene, recorded)
    for time_ns, _ in changes.commands:
        if time_ns < simulator.time_ns:
            raise SceneError(f'a command at {time_ns / SECOND:.9g} s lies before the branch, '
                             f'which begins at {simulator.time:.9g} s: leave it out')
    kept = _possible(simulator.scene, recorded) if changes.keep_commands else []
    return sorted([*kept, *changes.commands], key=lambda timed: timed[0])


def _possible(scene, recorded):
    """Return recorded commands; raise SceneError for one that a scene does not take."""
    quantities = {*scene_quantities(scene), *SETTING_NAMES}
    for time_ns, command in recorded:
        where = f'the recorded command at {time_ns / SECOND:.9g} s'
        try:
            checked(command, scene)
        except SceneError as error:
            raise SceneError(f'{where}: {error}; give other commands') from None
        unknown = set(command.values) - quantities if isinstance(command, SetValues) else ()
        if unknown:
            raise SceneError(f"{where} sets '{min(unknown)}', which the scene does not have; give "
                             'other commands')
    return list(recorded)
