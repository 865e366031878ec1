# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The simulator: the only place where time advances."""

import copy
from dataclasses import replace
import math

import numpy as np

from .anchors import Anchors
from .changes import changed
from .commands import checked, CommandError, MoveAnchor, PlaceBody, PushBody, SetValues
from .layout import Layout
from .look_ahead import known_until, ticks_ahead
from .rows.kernel import Instants, prepare_rows
from .settings import SECOND, SETTING_NAMES, Settings
from .snapshot import Snapshot
from .step_memory import recall, remember
from .trajectory import Trajectory
from .way_back import way_back
from ..integrators import DEFAULT_METHOD, IntegrationError, kernel_kind, new_steps
from ..integrators.entry import entry
from ..physics.drive import Drive
from ..physics.energies import energies
from ..physics.model import build_model
from ..physics.state import initial_state, WORKS
from ..scene import get_value
from ..scene.orientation import from_ros


# Of a state with larger numbers (SI) than this, energies and forces might not be finite.
_LARGEST = 1e100
# Ticks that are computed in one go: they take some memory.
MOST_AT_ONCE = 1024
# Single ticks are computed so many ahead, at least and at most, where no step is needed for them.
_FEWEST_AHEAD, MOST_AHEAD = 3, 64


class DivergenceError(ArithmeticError):
    """The motion is no longer finite; the simulator stands at its last finite state."""


class Simulator:
    """
    Runs a scene.

    scene: Scene; settings: Settings, or its fields as keywords. Time is an integer number of
    nanoseconds since the start of the epoch. The integrator's steps lie on a grid of its own,
    which begins anew where a command takes effect; at an instant between two points of the grid
    the state comes from a shorter step that is not kept. Who looks at the run, and how often,
    changes no bit of it.
    """

    def __init__(self, scene, settings=None, **changes):
        self.initial_scene = scene
        self.initial_settings = replace(settings or Settings(), **changes)
        self.epoch = -1
        self.reset()

    def reset(self):
        """Go back to the initial scene and settings at time 0, in a new epoch."""
        self.epoch += 1
        self.scene = self.initial_scene
        self.settings = self.initial_settings
        self.time_ns = 0
        self.tick = 0
        self.failure = None
        self._steps, self._counted, self._way_back = None, (0, 0), None
        self._build()
        self.layout = Layout(self.scene)
        self._state = initial_state(self.scene, self._model)
        self._pushes = np.zeros_like(self._state)
        self._push_ends = {}
        self._anchors = Anchors(self.scene)
        self._reference_energy = self._energy()

    def _build(self):
        self._forget_ahead()
        self._model, self._energies = build_model(self.scene), None
        if self._steps is not None:
            self._counted = self.counts
        self._steps = None
        # In which state the motion that now goes on began, if it has begun.
        self._begun_in, self._is_begun = None, False

    def _forget_ahead(self):
        self._take_back()
        # States at the next ticks, as far as they are known by now; how many of them are past.
        self._ahead, self._past = (), 0

    def _take_back(self):
        """Undo steps that no tick has needed yet."""
        if self._way_back is not None:
            go_back, self._begun_in, self._is_begun, _ = self._way_back
            go_back()
            needed, tick_ns = self._past, self.settings.tick_ns
            if needed:
                self._steps.fill(self.time_ns - (needed - 1) * tick_ns, tick_ns,
                                 np.empty((needed, self.layout.size)))
            self._way_back, self._ahead, self._past = None, (), 0

    def _begin_steps(self):
        """Let the integration begin at the present instant, under what is in force."""
        if self._steps is None:
            self._steps = self._new_steps()
        self._anchors.rebase(self.time_ns)
        self._steps.begin(self.time_ns, self._state)
        self._begun_in, self._is_begun = self._state, True

    def _new_steps(self):
        return new_steps(self.settings, self._model, self._drive(self._anchors), self.layout.size)

    def _drive(self, anchors):
        # Anchors can be commanded to move, and bodies be pushed, at any time: without a pause for
        # compiling.
        return Drive(anchors.motion, True if self.scene.anchors else None, self._pushes, True)

    @property
    def normalisation_removed(self):
        """Return the sum of what normalising the quaternions removed since the last change."""
        self._take_back()
        return 0.0 if self._steps is None else self._steps.removed

    @property
    def counts(self):
        """Return (steps, rejected steps) of the integrator since the start of the epoch."""
        if self._steps is None:
            return self._counted
        self._take_back()
        return tuple(before + int(count) for before, count
                     in zip(self._counted, self._steps.counts))

    @property
    def shortfall(self):
        """Return, in words, what keeps the method from its tolerance; None where nothing does."""
        self._take_back()
        return None if self._steps is None else self._steps.shortfall

    @property
    def time(self):
        """Return the simulated time [s]."""
        return self.time_ns / SECOND

    def snapshot(self):
        """Return the Snapshot of the present instant."""
        return Snapshot(self.time_ns, self.tick, self.epoch, self.scene, self.layout, self._model,
                        self._state.copy(), self._anchors.motion_at(self.time_ns),
                        self._pushes.copy(), self._reference_energy, self.settings,
                        (dict(self._push_ends), self._under_way()))

    def instant(self):
        """Return the Instants of the present one, to be used before anything changes."""
        return self._instants(self.time_ns, self._state.reshape(1, -1))

    def prepare(self):
        """Compile, or load from the disk cache, all that a tick of this scene needs."""
        is_first, was_begun = self._steps is None, self._is_begun
        if not was_begun:
            self._begin_steps()
        self._steps.prepare()
        self._is_begun = was_begun
        if is_first:
            # What was found out about the first step is not to outlive a command that comes now.
            self._steps.reset()
        self._energy()
        prepare_rows(self.instant())

    def prepare_ahead(self):
        """Compile, or load likewise, what the method may go over to later on; after prepare."""
        if self.settings.integrator == DEFAULT_METHOD:
            self._steps.prepare_ahead(self._state)

    def kernel_kind(self, values):
        """
        Return which kernels are needed after a change, {name: value} as in SetValues: hashable.

        Where it is the same, prepare needs the same ones. Raises SceneError; nothing is compiled.
        """
        scene, settings = self.changed_by(values)
        anchors = copy.deepcopy(self._anchors)
        anchors.rebase(self.time_ns)
        _set_anchors(anchors, scene, values)
        return kernel_kind(settings, build_model(scene), self._drive(anchors), self._state)

    def memory(self):
        """
        Return all that the run from here on depends on, beside scene and settings.

        A dict of numbers, lists and such dicts: see docs/rerunning.md.
        """
        anchors, goes_on = self._anchors, self.failure is None
        self._take_back()
        return {
            'time_ns': self.time_ns, 'tick': self.tick, 'failure': self.failure,
            'state': self._state.tolist(), 'reference_energy': float(self._reference_energy),
            'pushes': self._pushes.tolist(), 'push_ends_ns': dict(self._push_ends),
            'anchors': {'since_ns': anchors.since, 'motion': anchors.motion.tolist(),
                        'under_way': self._under_way()},
            'counted': list(self._counted),
            'begun_in': self._begun_in.tolist() if self._is_begun and goes_on else None,
            'steps': remember(self._steps) if self._steps is not None and goes_on else None}

    def recall(self, memory):
        """
        Go on from where a simulator of the same scene and settings stood, to the same bits.

        memory: what `memory` returned. Raises ValueError, KeyError or TypeError for what is no
        such memory; is then no longer to be used.
        """
        self.reset()
        self.time_ns, self.tick = int(memory['time_ns']), int(memory['tick'])
        self.failure = memory['failure']
        for array, values in ((self._state, memory['state']), (self._pushes, memory['pushes'])):
            array[:] = _numbers(values, array.shape)
        self._reference_energy = float(memory['reference_energy'])
        self._push_ends.update((self._known(body), int(end))
                               for body, end in memory['push_ends_ns'].items())
        self._anchors.go_on(int(memory['anchors']['since_ns']),
                            _numbers(memory['anchors']['motion'], self._anchors.motion.shape))
        for i, (target, commanded) in enumerate(memory['anchors']['under_way']):
            self._anchors.put_under_way(i, target, commanded)
        self._recall_steps(memory)

    def _recall_steps(self, memory):
        steps, begun_in = memory['steps'], memory['begun_in']
        if steps is not None:
            self._steps = self._new_steps()
            begun = None
            if begun_in is not None:
                self._begun_in, self._is_begun = _numbers(begun_in, self._state.shape), True
                begun = self._anchors.since, self._begun_in
            recall(self._steps, steps, begun)
        self._counted = tuple(map(int, memory['counted']))

    def _known(self, body):
        if body not in self.layout.bodies:
            raise ValueError(f"'{body}' is no body")
        return body

    def _under_way(self):
        return [self._anchors.under_way(i) for i in range(len(self.scene.anchors))]

    def twin(self):
        """Return a Simulator that stands where this one does and goes on to the same bits."""
        other = Simulator(self.scene, self.settings)
        other.recall(copy.deepcopy(self.memory()))
        other.follow(self)
        return other

    def follow(self, other):
        """Let the epoch and what a reset goes back to be those of another Simulator."""
        self.epoch = other.epoch
        self.initial_scene, self.initial_settings = other.initial_scene, other.initial_settings

    def copy(self):
        """Return a Simulator that stands where this one does, and goes its own way from there."""
        other = copy.copy(self)
        other._way_back = None
        other._state, other._pushes = self._state.copy(), self._pushes.copy()
        other._push_ends, other._anchors = dict(self._push_ends), copy.deepcopy(self._anchors)
        # Entries of kernels are this process's own: a copy may be sent to another one.
        other._steps, other._is_begun, other._energies = None, False, None
        other._forget_ahead()
        return other

    def advance_tick(self):
        """Advance by one tick; raise DivergenceError if the motion is no longer finite."""
        if self.known_ahead():
            self.take(1)
        else:
            self.advance(self.settings.tick_ns)
            self.tick += 1

    def known_ahead(self):
        """Return at how many of the next ticks the states are known without another step."""
        if self._past == len(self._ahead) and self._is_begun and self.failure is None:
            self._look_ahead()
        return len(self._ahead) - self._past

    def step_ahead(self):
        """
        Take the steps that the next tick needs, if it needs any; return as known_ahead.

        What changes the motion before that tick, or looks at the steps, has them taken back.
        """
        known, tick_ns = self.known_ahead(), self.settings.tick_ns
        if known or self.failure or self._steps is None or self._count_even(1) < 1:
            return known
        several = ticks_ahead(self._steps, tick_ns) if self._is_begun else 1
        # Fewer if the motion diverges before the last one.
        return self._step_over(self._count_even(several)) or self._step_over(1)

    def _step_over(self, ticks):
        """Take the steps that some ticks need; return as step_ahead."""
        self._forget_ahead()
        self._way_back = way_back(self._steps), self._begun_in, self._is_begun, ticks
        states, tick_ns = np.empty((ticks, self.layout.size)), self.settings.tick_ns
        if not self._is_begun:
            self._begin_steps()
        try:
            self._steps.fill(self.time_ns + tick_ns, tick_ns, states, self._next_change())
        except IntegrationError:
            states[:] = np.nan  # the tick itself will say so
        if _is_finite(states.ravel()):
            self._ahead = states
            if ticks == 1:
                self._look_ahead()
        else:
            self._take_back()
        return len(self._ahead)

    def instants_ahead(self, count):
        """Return the Instants of that many of the next ticks whose states are known."""
        return self._instants(self.time_ns + self.settings.tick_ns,
                              self._ahead[self._past:self._past + count])

    def _instants(self, first_ns, states):
        anchors = self._anchors
        return Instants(self._model, anchors.motion, first_ns - anchors.since, self._pushes,
                        self._reference_energy, states, self.settings.tick_ns)

    def take(self, count):
        """Advance by some ticks, at least one, whose states are known."""
        self._past += count
        if self._way_back is not None and self._past >= self._way_back[-1]:
            self._way_back = None
        self._state = self._ahead[self._past - 1]
        self.time_ns += count * self.settings.tick_ns
        self.tick += count

    def _look_ahead(self):
        """Compute the states at the next ticks, if the last step has gone past some of them."""
        tick_ns = self.settings.tick_ns
        known = (known_until(self._steps) - self.time_ns) // tick_ns
        count = min(self._count_even(known), MOST_AHEAD)
        if count >= _FEWEST_AHEAD:
            states = np.empty((count, self.layout.size))
            self._steps.fill(self.time_ns + tick_ns, tick_ns, states, self._next_change())
            if _is_finite(states.ravel()):
                self._ahead, self._past = states, 0

    def advance_ticks(self, count):
        """
        Advance by some ticks in one go, to the state that single ticks lead to.

        Raises DivergenceError where a single tick would, and then stands at the tick before.
        """
        while count > 0:
            count -= len(self.pass_ticks(count).states)

    def pass_ticks(self, most):
        """
        Advance by some ticks, one at least, in one go; return the Instants of them all.

        They are to be used before anything changes. Raises DivergenceError as above.
        """
        even, before = self._count_even(most), self.time_ns
        states = self._advance_even(even) if even > 1 else ()
        if len(states) == 0:
            self.advance_tick()
            return self.instant()
        return self._instants(before + self.settings.tick_ns, states)

    def advance_to(self, time_ns):
        """Advance by whole ticks to an instant; ValueError if none of them ends there."""
        ticks, rest = divmod(time_ns - self.time_ns, self.settings.tick_ns)
        if rest or ticks < 0:
            raise ValueError(f'{time_ns * 1e-9:.9f} s is no whole number of ticks after '
                             f'{self.time:.9f} s, at {self.settings.rate:g} Hz')
        self.advance_ticks(ticks)

    def _count_even(self, count):
        """Return how many of some ticks, MOST_AT_ONCE at most, end before the next change."""
        change = self._next_change()
        if change is not None:
            count = min(count, (change - self.time_ns - 1) // self.settings.tick_ns)
        return min(count, MOST_AT_ONCE)

    def _advance_even(self, count):
        """Advance by ticks without a change among them, as far as all is well; return states."""
        if self.failure is not None:
            return ()
        self._forget_ahead()
        if not self._is_begun:
            self._begin_steps()
        tick_ns = self.settings.tick_ns
        states = np.full((count, self.layout.size), np.nan)
        problem = None
        try:
            self._steps.fill(self.time_ns + tick_ns, tick_ns, states, self._next_change())
        except IntegrationError as error:
            problem = error  # the states from there on are no numbers
        is_good = np.abs(states).max(axis=1) < _LARGEST
        good = count if is_good.all() else int(is_good.argmin())
        if good:
            self._state = states[good - 1].copy()
            self.time_ns += good * tick_ns
            self.tick += good
        if good < count and problem is None:
            self._check(states[good], self.time_ns + tick_ns)
        if good == 0 and problem is not None:
            self._give_up(problem, self.time_ns + tick_ns)
        return states[:good]

    def run(self, duration):
        """Advance by a duration [s], rounded up to whole ticks; return a Trajectory."""
        snapshots = [self.snapshot()]
        end = self.time_ns + round(duration * SECOND)
        while self.time_ns < end:
            self.advance_tick()
            snapshots.append(self.snapshot())
        return Trajectory(snapshots)

    def advance(self, duration_ns):
        """Advance by an integer number of nanoseconds; raise DivergenceError as above."""
        if self.failure is not None:
            raise DivergenceError(self.failure)
        end = self.time_ns + duration_ns
        while (change := self._next_change()) is not None and change <= end:
            self._integrate_to(change, change)
            self._begin_here()
            self._anchors.arrive()
            self._end_pushes()
        self._integrate_to(end, change)

    def apply(self, command):
        """
        Carry out a command at the present instant, whole; what follows is under it.

        Returns the command with its values as they are in force. Raises CommandError or
        SceneError, and has then changed nothing.
        """
        return self.carry_out(checked(command, self.scene))

    def carry_out(self, command):
        """Do the same with what `checked` has returned."""
        if isinstance(command, MoveAnchor):
            self._move_anchor(command)
        elif isinstance(command, PushBody):
            self._push(command)
        elif isinstance(command, PlaceBody):
            self._place(command)
        elif isinstance(command, SetValues):
            return self._set_values(command.values)
        else:
            raise CommandError(f'{command!r} is no command')
        return command

    def changed_by(self, values):
        """Return (scene, settings) as they would be after SetValues(values): see changed."""
        return changed(self.scene, self.settings, values)

    def _next_change(self):
        arrival = self._anchors.next_change()
        if not self._push_ends:
            return arrival
        end = min(self._push_ends.values())
        return end if arrival is None else min(end, arrival)

    def _integrate_to(self, end, change):
        """Take steps until an instant has been reached or passed; change: see _next_change."""
        self._forget_ahead()
        if not self._is_begun:
            self._begin_steps()
        try:
            state = self._steps.state_at(end, change)
        except IntegrationError as error:
            self._give_up(error, end)
        self._check(state, end)
        self._state = state
        self.time_ns = end

    def _give_up(self, error, end):
        self.failure = (f'the motion cannot be computed between {self.time:.9g} s and '
                        f'{end / SECOND:.9g} s of simulated time: {error}; the state of '
                        f'{self.time:.9g} s is kept')
        raise DivergenceError(self.failure) from error

    def _check(self, state, end):
        """Raise DivergenceError unless the state of an instant after this one is finite."""
        if not _is_finite(state):
            self.failure = self._describe_failure(state, end)
            raise DivergenceError(self.failure)

    def _describe_failure(self, state, end):
        layout = self.layout
        where = next((body for body in layout.bodies
                      for part in (layout.position, layout.velocity, layout.orientation,
                                   layout.angular_velocity)
                      if part(body) and not _is_finite(state[part(body)])), layout.bodies[0])
        return (f"the motion of '{where}' is no longer finite between {self.time:.9g} s and "
                f'{end / SECOND:.9g} s of simulated time; the state of {self.time:.9g} s is kept; '
                f'give a shorter step than {self.settings.step:g} s or smaller stiffness, damping '
                'or drag')

    def _begin_here(self):
        """Let a step end at the present instant: what follows is under something new."""
        self._forget_ahead()
        if self._is_begun:
            self._state = self._steps.cut(self.time_ns)
            self._is_begun = False
        self._anchors.rebase(self.time_ns)

    def _move_anchor(self, command):
        self._begin_here()
        before = self._energy()
        self._anchors.command(self.layout.anchors.index(command.anchor), command.position,
                              self.settings.anchor_interpolation == 'linear',
                              self.settings.tick_ns)
        self._add_anchor_work(self._energy() - before)

    def _add_anchor_work(self, work):
        """Count the energy that a jump of an anchor gives to its springs as work of the anchor."""
        place = self.layout.work.start + WORKS.index('anchor')
        self._state[place] += work

    def _push(self, command):
        self._begin_here()
        self._pushes[self.layout.velocity(command.body)] = command.force
        if (place := self.layout.angular_velocity(command.body)) is not None:
            self._pushes[place] = command.torque
        self._push_ends.pop(command.body, None)
        if self.settings.wrench_timeout and any((*command.force, *command.torque)):
            timeout = round(self.settings.wrench_timeout * SECOND)
            self._push_ends[command.body] = self.time_ns + max(timeout, 1)

    def _place(self, command):
        self._begin_here()
        before = self._energy()
        for part, value in command.values.items():
            place = getattr(self.layout, part)(command.body)
            self._state[place] = from_ros(value) if part == 'orientation' else value
        # What the body is given so is no error of the integration.
        self._reference_energy += self._energy() - before

    def _end_pushes(self):
        for body in [body for body, end in self._push_ends.items() if end <= self.time_ns]:
            del self._push_ends[body]
            self._pushes[self.layout.velocity(body)] = 0.0
            if (place := self.layout.angular_velocity(body)) is not None:
                self._pushes[place] = 0.0

    def _set_values(self, values):
        scene, settings = self.changed_by(values)
        self._begin_here()
        before = self._energy()
        _set_anchors(self._anchors, scene, values)
        moved = self._energy()
        self._add_anchor_work(moved - before)
        self.scene, self.settings = scene, settings
        self._build()
        self._reference_energy += self._energy() - moved
        return SetValues({name: getattr(settings, name) if name in SETTING_NAMES
                          else get_value(scene, name) for name in values})

    def _energy(self):
        arguments = self._model, self._anchors.motion_at(self.time_ns), 0.0, self._state
        if self._energies is None:
            self._energies = entry(energies, *arguments)
        kinetic, gravitational, spring = self._energies(*arguments)
        return kinetic + gravitational + spring


def _set_anchors(anchors, scene, values):
    """Put the Anchors whose position or velocity is among changed values where a scene says."""
    for i, anchor in enumerate(scene.anchors):
        if f'{anchor.name}.position' in values:
            anchors.place(i, anchor.position)
        if {f'{anchor.name}.position', f'{anchor.name}.velocity'} & set(values):
            anchors.set_velocity(i, anchor.velocity)


def _is_finite(state):
    """Return whether a state and all that is computed from it are finite numbers."""
    # Not a number is not below anything. Squares are added up in a tenth of the time: as it is far
    # from what they are compared with, how they are rounded does not matter.
    return bool(state.dot(state) < _LARGEST or np.abs(state).max() < _LARGEST)


def _numbers(values, shape):
    """Return values as an array of a shape; raise ValueError if they are none."""
    array = np.array(values, float)
    if array.size != math.prod(shape) or not np.isfinite(array).all():
        raise ValueError(f'{array.size} numbers where {math.prod(shape)} finite ones are expected')
    return array.reshape(shape)
