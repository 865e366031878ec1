# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""States of a run saved to files and gone back to, also those that a bag holds."""

import os
from pathlib import Path
from typing import NamedTuple

from .publish_rates import check_publish_rates
from ..bag.branch import parent_of
from ..bag.reader import open_bag
from ..bag.recorded_run import RecordedRun
from ..bag.rerun import simulator_at
from ..scene import scene_quantities, SceneError
from ..simulation.carry_over import begun_anew
from ..simulation.checkpoint import checkpoint, FORMAT, restored
from ..simulation.settings import SECOND


class _Held(NamedTuple):
    """
    A run that is held.

    history: see Run, up to the bag to go back into; was_paused; was_recorded: into that bag.
    """

    history: list
    was_paused: bool
    was_recorded: bool


class States:
    """
    Saves the state of a Run and lets it go on from a saved or a recorded one.

    Methods return (success, message). ask: Mailbox.ask; options: dict of the node's own
    parameters; prepare(simulator): returns when the kernels for a Simulator are ready; resumed,
    goes_on: called without arguments in the run's thread after the run went on, or went over to
    another state; follow_up: after the latter, here.
    """

    def __init__(self, run, ask, options, *, prepare, resumed, goes_on, follow_up):
        self._run, self._ask, self._options = run, ask, options
        self._prepare, self._resumed = prepare, resumed
        self._goes_on, self._follow_up = goes_on, follow_up

    def save(self, file):
        """Write the state of the present tick to a file, in place of an older state."""
        path, run = Path(file).expanduser(), self._run
        text, where, failure = self._ask(lambda: (
            checkpoint(run.simulator), run.now(), run.simulator.failure))
        if failure is not None:
            return False, f'not saved: the run has stopped: {failure}'
        try:
            if path.exists() and not _is_state(path):
                return False, f'state.file: {path} is no saved state and stays; choose another'
            path.parent.mkdir(parents=True, exist_ok=True)
            beside = path.with_name(f'{path.name}.{os.getpid()}')
            beside.write_text(text, encoding='utf-8')
            os.replace(beside, path)
        except OSError as error:
            return False, f'state.file: {path} cannot be written: {error.strerror}'
        return True, f'{where}: {path}'

    def load(self, file, seconds):
        """Go on, in a new epoch, from a saved state, or from an instant [s] of a bag."""
        path = Path(file).expanduser()
        history = []
        try:
            if path.suffix == '.mcap' or path.is_dir():
                simulator, begin_ns = _out_of_bag(path, round(seconds * SECOND))
                history.append(([path], begin_ns))
            else:
                simulator = restored(path.read_bytes(), f'state.file: {path}')
            self._make_ready(simulator, path)
        except OSError as error:
            return False, f'state.file: {path} cannot be read: {error.strerror}'
        except ValueError as error:
            return False, str(error)
        return self._change_over(simulator, path, history)

    def rewind(self, seconds):
        """Go on, in a new epoch, from an instant [s] of this one that is recorded."""
        time_ns = round(seconds * SECOND)
        try:
            held = self._ask(lambda: self._hold(time_ns))
        except SceneError as error:
            return False, str(error)
        self._run.finish_bags()
        paths, _ = held.history[-1]
        path = paths[0]
        try:
            path = _file_with(paths, time_ns)
            simulator, _ = _out_of_bag(path, time_ns)
            self._make_ready(simulator, path)
        except ValueError as error:
            return False, self._give_up(held, str(error))
        return self._change_over(simulator, path, held.history, held)

    def restart_time(self):
        """Go on from the present state, in a new epoch, at time 0."""
        answer = self._ask(self._restart_time)
        self._follow_up()
        return answer

    def _restart_time(self):
        run = self._run
        if run.simulator.failure is not None:
            return False, f'{run.simulator.failure}; then call ~/reset'
        problem = run.go_on_as(begun_anew(run.simulator))
        self._goes_on()
        return True, run.epoch(problem)

    def _give_up(self, held, reason):
        """Let a held run go on; return the reason, with what could not be done either."""
        try:
            self._ask(lambda: self._let_go(held))
        except SceneError as error:
            return f'{reason}; no longer recording: {error}'
        return reason

    def _make_ready(self, simulator, path):
        """Compile what a Simulator needs; raise SceneError if this node cannot go on as it."""
        scene, ours = simulator.scene, self._run.simulator.scene
        if _kind(scene) != _kind(ours):
            raise SceneError(f"state.file: {path} is a state of the scene '{scene.name}', with "
                             f"other bodies, anchors or springs than those here: '{ours.name}'")
        check_publish_rates(simulator.settings.rate, self._options)
        self._prepare(simulator)

    def _change_over(self, simulator, path, history, held=None):
        """Let the run, which may be held, go on as a Simulator; return (success, message)."""
        parent = parent_of(path.name, simulator)
        begins_bag = held is not None and held.was_recorded

        def change_over():
            run, failed = self._run, self._run.simulator.failure is not None
            problem = run.go_on_as(simulator, parent, history, begins_bag)
            run.paused = not failed and (run.paused if held is None else held.was_paused)
            self._goes_on()
            return True, run.epoch(problem)

        answer = self._ask(change_over)
        self._follow_up()
        return answer

    def _hold(self, time_ns):
        """Hold the run and end the bag that has an instant; return the _Held, or SceneError."""
        run = self._run
        asked = f'state.time: {time_ns / SECOND:.9g} s'
        if time_ns > run.simulator.time_ns:
            raise SceneError(f'{asked} has not come yet, this is {run.now()}')
        history = [bag for bag in run.history if bag[1] <= time_ns]
        if not history:
            raise SceneError(f'{asked} is not recorded; go back to what is, or record from the '
                             'start (record.enable)')
        is_recorded = run.bag is not None and run.bag.paths is history[-1][0]
        held = _Held(history, run.paused, is_recorded)
        run.paused = True
        if is_recorded:
            run.detach_bag()
        return held

    def _let_go(self, held):
        """Let a held run go on as before; raise SceneError if it can no longer be recorded."""
        run = self._run
        run.paused = held.was_paused
        self._resumed()
        if held.was_recorded:
            run.start_recording()
            run.publish()


def _out_of_bag(path, time_ns):
    """Return a Simulator at an instant of a recorded run, and when that begins; or ValueError."""
    with open_bag(path) as bag:
        run = RecordedRun(bag)
        return simulator_at(run, time_ns), run.begin_ns


def _file_with(paths, time_ns):
    """Return which file of a bag, each a bag itself, in order of time, holds an instant."""
    def begin_ns(path):
        with open_bag(path) as bag:
            return RecordedRun(bag).begin_ns

    return next((path for path in reversed(paths[1:]) if begin_ns(path) <= time_ns), paths[0])


def _is_state(path):
    with open(path, 'rb') as stream:
        return FORMAT.encode() in stream.read(100)


def _kind(scene):
    """Return what has to be equal of two scenes for one to go on as the other, in one node."""
    return ([(type(member), member.name) for member in scene.members],
            [(spring.from_, spring.to) for spring in scene.springs], [*scene_quantities(scene)])
