# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The loop of all methods that choose their own steps.

Every method takes a step from y, with the rate of y where it needs it, and estimates its error;
the loop accepts or repeats it, and chooses the next step. Steps lie where the method puts them;
the state at an instant within a step comes from the method's dense output.

The clock is an array of float64, see BASE to FLOOR; times in it are [s] since BASE, a whole
number of seconds after the beginning, so that they keep their last bits in the longest run.
"""

import math
from typing import NamedTuple

import numpy as np

from .dense_output import build_dense, make_unit, write_state, write_two_states
from .dop853 import dop853
from .error_norm import error_norm
from .gragg import gragg
from .lane_schedule import Schedule
from .logarithm import binary_logarithm, binary_power
from .memory import load, number_row, store
from .radau import keep_stages, radau
from .stiff import stiff
from .stormer import stormer
from ..physics.jit import formula, kernel
from ..physics.motion import rates
from ..physics.state import counts, moving_size, normalise, omega_at, quaternion_at

# The clock: whole seconds, end and length of the last step, length of the next one, binary
# logarithm of the last error estimate over the tolerance, whether the dense output of the last
# step is built; for how many steps the watch has seen what it waits for, and the steps have become
# shorter; what rounding leaves of the error estimate of a step; for how long all has been calm;
# after how many steps another method may be tried, and how many more have to pass before the time
# after that.
(BASE, END, STEP, NEXT, LAST_ERROR, DENSE, WATCHED, SHRUNK, FLOOR, CALM, TRIAL, WAIT) = range(12)
CLOCK_SIZE = 12
# Length of the last step before the first one.
TO_BEGIN = -1.0
# What is counted: steps, rejected steps, evaluations of the right-hand side in a row, steps that
# were accepted at the limit of rounding.
STEPS, REJECTED, EVALUATIONS, ROUNDED = range(4)
COUNTS_SIZE = 4

REACHED, BUDGET_SPENT, STEP_TOO_SHORT, SWITCH, AT_REST = range(5)

# log2(0.9) and log2(0.6): not from the C library, whose last bits are not the same everywhere.
_LOG_SAFETY, _LOG_AT_ONCE = -0.15200309344504995, -0.7369655941662062
_SLOWEST, _FASTEST = 0.1, 5.0
_LONGEST = 100.0
# Of the time: a step that is not longer than some units of its last place is none.
_SHORTEST = 1e-15
# Steps that become shorter so many times in a row do so because of rounding.
_PERSISTENCE = 20.0
# So many steps in a row convince the watch that they are long, or short.
_PATIENCE, _SHORT_PATIENCE = 10, 3
# Steps until the next trial of another method: at first, and at most.
_SHORTEST_WAIT, _LONGEST_WAIT = 32.0, 4096.0
# Where velocities change by more than this part of them in an explicit step, a stiff step, several
# times as long, would fail; noise of the step control is not above so many tolerances.
_SMOOTH, _NOISE = 0.3, 100.0
# Units of the last place that rounding leaves of an error estimate.
_UNITS = 20.0 * 2.0 ** -52
# How long a run has to be calm before it is at rest [s].
CALM_TIME = 1.0
# Where no velocity is above something, vibrations have accelerations up to this times it [1/s].
_FAST = 100.0
# The tolerance of a step is this part of the one that is asked for, because errors add up.
MARGIN = 0.02
# Rounding makes no error estimate larger than this.
_ROUNDING = 1e-8
# Of a step: an instant that lies not more than this behind it may be taken for its end.
_ROUGHLY = 1e-15


class Tableaux(NamedTuple):
    """The data of the method in use, None for the others; dense: table of its dense output."""

    gragg: Schedule | None
    stormer: Schedule | None
    stiff: Schedule | None
    dop853: np.ndarray | None
    radau: np.ndarray | None
    dense: np.ndarray


class Grid(NamedTuple):
    """
    Instants at which states are wanted.

    first, period: [ns] since the beginning; states: (n, size), filled; done: (1,) how many are.
    Where only the end of a step is wanted: one instant that is never reached.
    """

    first: int
    period: int
    states: np.ndarray
    done: np.ndarray


@formula
def attempt(gragg_plan, stormer_plan, stiff_plan, dop853_data, radau_data, model, drive, size, t,
            h, y, rate, tolerance, h_before, kept, memory, y_new, error):
    """Take one step with the method that is there; return how many evaluations in a row."""
    if gragg_plan is not None:
        gragg(model, drive, gragg_plan, size, t, h, y, rate, memory, y_new, error)
        return gragg_plan.rows
    if stormer_plan is not None:
        stormer(model, drive, stormer_plan, size, t, h, y, rate, memory, y_new, error)
        return stormer_plan.rows
    if stiff_plan is not None:
        stiff(model, drive, stiff_plan, size, t, h, y, memory, y_new, error)
        return stiff_plan.rows
    if dop853_data is not None:
        dop853(model, drive, dop853_data, size, t, h, y, rate, memory, y_new, error)
        return 11
    if radau_data is not None:
        return radau(model, drive, radau_data, size, t, h, y, rate, tolerance, h_before, kept,
                     memory, y_new, error)
    return 0


@formula
def step_factor(logarithm, last, per_power):
    """
    Return by how much the next step may be longer: Gustafsson's PI control.

    logarithm, last: to base 2, of the error estimate over the tolerance, of this step and of the
    one before it; per_power: one over the power of the step in the estimate. Where the error is
    far below the tolerance the step goes where it should be at once.
    """
    return binary_power(max(_LOG_SAFETY + 0.2 * per_power * last - 0.5 * per_power * logarithm,
                            _LOG_AT_ONCE - per_power * logarithm))


@formula
def is_rounding(change, change_of_step, power, error):
    """
    Return whether an error estimate is what rounding makes of it, so that it can get no smaller.

    change, change_of_step: logarithms of the ratios of this estimate and step to those of the
    attempt before; a step that becomes shorter should lower the estimate by its power.
    """
    return error < _ROUNDING and change > 0.3 * power * change_of_step


@formula
def watched(watch, step, seen):
    """Return for how many steps in a row the step has been beyond the watch."""
    if watch > 0.0 and step >= watch or watch < 0.0 and step <= -watch:
        return seen + 1.0
    return 0.0


@formula
def is_smooth(first, end, y, y_new, noise):
    """Return whether no velocity from `first` to before `end` changes much from y to y_new."""
    size, change = noise, 0.0
    for i in range(first, end):
        size = max(size, abs(y[i]), abs(y_new[i]))
        change = max(change, abs(y_new[i] - y[i]))
    return change <= _SMOOTH * size


@formula
def postpone(clock, steps):
    """Let another method be tried some steps later only, and more of them each time."""
    wait = max(clock[WAIT], _SHORTEST_WAIT)
    clock[TRIAL] = steps + wait
    clock[WAIT] = min(math.floor(1.25 * wait), _LONGEST_WAIT)


@formula
def speaks_for_another(watch, bodies, rigid, y, y_new, noise, steps, clock):
    """
    Return whether, once the watch is convinced, another method is to be tried.

    The explicit one at once; a stiff one when its time has come and the last step, from y to
    y_new, was smooth; noise: velocities that are none [m/s, rad/s]; steps: taken so far.
    """
    if watch < 0.0:
        return True
    if steps < clock[TRIAL]:
        return False
    omegas = omega_at(bodies, rigid)
    if (is_smooth(3 * bodies, 6 * bodies, y, y_new, noise)
            and is_smooth(omegas, omegas + 3 * rigid, y, y_new, noise)):
        return True
    postpone(clock, steps)
    return False


@formula
def is_calm(first, end, rate, calm):
    """Return whether no rate from `first` to before `end` is above `calm`."""
    for i in range(first, end):
        if not abs(rate[i]) <= calm:
            return False
    return True


@formula
def calm_for(bodies, rigid, rate, calm, before):
    """
    Return for how long all has been calm; before: how long, if it is now [s].

    It is as long as no velocity is above `calm`, and no acceleration above what fast vibrations
    of such velocities have.
    """
    quaternions, omegas = quaternion_at(bodies), omega_at(bodies, rigid)
    if (is_calm(0, 3 * bodies, rate, calm) and is_calm(quaternions, omegas, rate, calm)
            and is_calm(3 * bodies, quaternions, rate, _FAST * calm)
            and is_calm(omegas, omegas + 3 * rigid, rate, _FAST * calm)):
        return before
    return 0.0


@formula
def since_base(time, base):
    """Return an instant, given in [ns] since the beginning, in [s] since the clock's base."""
    return (time - np.int64(base) * 1000000000) * 1e-9


@formula
def place_in_step(grid, number, base, end, per_half):
    """
    Return where an instant of the grid lies in the last step: -1: start, 1: end.

    base, end: of the clock; per_half: one over half the step's length.
    """
    return 1.0 + (since_base(grid.first + number * grid.period, base) - end) * per_half


@formula
def fill_grid(grid, tableaux, model, drive, bodies, rigid, size, base, end, step, clock, counted,
              y, rate, y_new, rate_new, memory, dense):
    """Write the states of the grid that lie in the last step; build the dense output first."""
    per_half = 2.0 / step
    first, done, count = grid.done[0], grid.done[0], grid.states.shape[0]
    while done < count:
        s = place_in_step(grid, done, base, end, per_half)
        if s > 1.0:
            break
        if clock[DENSE] == 0.0:
            counted[EVALUATIONS] += build_dense(
                tableaux.stiff, tableaux.dop853, tableaux.radau, model, drive,
                tableaux.dense, size, base + end - step, step, y, rate, y_new, rate_new, memory,
                dense)
            clock[DENSE] = 1.0
        s_next = place_in_step(grid, done + 1, base, end, per_half)
        if s_next <= 1.0 and done + 1 < count:
            write_two_states(size, dense, s, grid.states[done], s_next, grid.states[done + 1])
            done += 2
        else:
            write_state(size, dense, s, grid.states[done])
            done += 1
    # Behind the others: numbers that were just written four at a time are slow to be read again.
    for number in range(first, done):
        make_unit(bodies, rigid, grid.states[number])
    grid.done[0] = done


@formula
def begin_rates(stiff_plan, model, drive, t, y, rate):
    """Write the rates of y, where the method needs them."""
    if stiff_plan is None:
        rates(model, drive, t, y, rate)


@formula
def begin(model, drive, bodies, rigid, size, power, tolerance, fastest, clock, y, rate, ahead,
          change):
    """
    Let a run begin in the state y at the time of the clock; writes its rates.

    fastest: rate of its springs [1/s]: lengths are known to some units of their last place, which
    springs turn into velocities times their rate; ahead, change: Cells to use; else as advance.

    The first step is as long as the clock says; where it says nothing, as Hairer's rule has it:
    from the sizes of the rates and of their change over a small step.
    """
    t = clock[BASE] + clock[END]
    rates(model, drive, t, y, rate)
    reach = 1.0
    for i in range(3 * bodies):
        reach = max(reach, abs(y[i]))
    clock[FLOOR] = _UNITS * reach * max(1.0, fastest)
    clock[STEP] = 0.0
    clock[DENSE] = 0.0
    clock[WATCHED] = 0.0
    clock[CALM] = 0.0
    clock[LAST_ERROR] = 0.0
    if clock[NEXT] == 0.0:
        h = max(1e-3 / (error_norm(bodies, rigid, y, rate) + 1e-6), 1e-15)
        for i in range(size):
            ahead[i] = y[i] + h * rate[i]
        rates(model, drive, t + h, ahead, change)
        for i in range(size):
            change[i] = (change[i] - rate[i]) / h
        largest = max(error_norm(bodies, rigid, y, rate), error_norm(bodies, rigid, y, change))
        longest = binary_power(binary_logarithm(tolerance / max(largest, 1e-15)) / power)
        clock[NEXT] = min(100.0 * h, longest, _LONGEST)


@kernel
def advance(model, drive, tableaux, power, tolerance, fastest, limit, budget, watch, calm, clock,
            counted, states, memory, dense, grid):
    """
    Take steps until the grid is filled, or `limit` is reached.

    power: of h in the error estimate; tolerance: of the run, in the norm of error_norm; fastest:
    see begin; limit: [ns] since the beginning: a step ends there, and none goes on; budget: the
    most attempts; watch: steps that stay longer than this [s], or where it is negative shorter
    than -watch, end the run with SWITCH; calm: a run that has been calm for CALM_TIME, see
    calm_for, ends with AT_REST; 0: none does; clock, counted: see above; states: (4, size) start
    and end of the last step, the rates there; dense: (size * DENSE_SIZE,), followed for radau by
    the stages. Returns REACHED, BUDGET_SPENT, STEP_TOO_SHORT, SWITCH or AT_REST.
    """
    bodies, rigid = counts(model)
    size = moving_size(drive.works, bodies, rigid)
    y = number_row(model.several, memory, 0, size)
    y_new = number_row(model.several, memory, 1, size)
    rate = number_row(model.several, memory, 2, size)
    rate_new = number_row(model.several, memory, 3, size)
    error = number_row(model.several, memory, 4, size)
    load(size, states[0], y)
    load(size, states[1], y_new)
    load(size, states[2], rate)
    load(size, states[3], rate_new)
    if clock[STEP] == TO_BEGIN:
        begin(model, drive, bodies, rigid, size, power, tolerance, fastest, clock, y_new, rate_new,
              y, rate)
    status = REACHED
    stalled = 0
    noise = _NOISE * tolerance
    tolerance = max(MARGIN * tolerance, clock[FLOOR])
    # What a next step waits for is multiplied, not divided, and not in memory.
    per_tolerance, per_power = 1.0 / tolerance, 1.0 / power
    base, reached, step = clock[BASE], clock[END], clock[STEP]
    following, last_error = clock[NEXT], clock[LAST_ERROR]
    while True:
        # Asked here too: what is in fill_grid would be got ready at every step.
        if step > 0.0 and since_base(grid.first + grid.done[0] * grid.period,
                                     base) <= reached + _ROUGHLY * step:
            fill_grid(grid, tableaux, model, drive, bodies, rigid, size, base, reached, step,
                      clock, counted, y, rate, y_new, rate_new, memory, dense)
        target = since_base(limit, base)
        if grid.done[0] >= grid.states.shape[0] or reached >= target:
            break
        if budget <= 0:
            status = BUDGET_SPENT
            break
        clock[WATCHED] = watched(watch, following, clock[WATCHED])
        if clock[WATCHED] >= (_PATIENCE if watch > 0.0 else _SHORT_PATIENCE):
            clock[WATCHED] = 0.0
            if speaks_for_another(watch, bodies, rigid, y, y_new, noise, counted[STEPS], clock):
                status = SWITCH
                break
        if clock[CALM] >= CALM_TIME:
            clock[CALM] = 0.0
            status = AT_REST
            break
        for i in range(size):
            y[i] = y_new[i]
            rate[i] = rate_new[i]
        accepted = False
        before, h_before = math.inf, 1.0
        while not accepted and budget > 0:
            budget -= 1
            h = min(following, _LONGEST)
            end = reached + h
            # Not a last step that is much shorter than the others.
            if end + 1e-3 * h >= target:
                end = target
            elif end + h > target:
                end = 0.5 * (reached + target)
            natural = h
            h = end - reached
            if not h > _SHORTEST * reached + 1e-300:
                status = STEP_TOO_SHORT
                break
            t = base + reached
            counted[EVALUATIONS] += attempt(
                tableaux.gragg, tableaux.stormer, tableaux.stiff, tableaux.dop853,
                tableaux.radau, model, drive, size, t, h, y, rate, tolerance, step, dense, memory,
                y_new, error)
            ratio = error_norm(bodies, rigid, y, error) * per_tolerance
            if not ratio < 1e30:
                ratio = 1e30
            logarithm = binary_logarithm(max(ratio, 1e-30))
            accepted = ratio <= 1.0
            if not accepted:
                stalled = stalled + 1 if is_rounding(
                    logarithm - before, binary_logarithm(h / h_before), power,
                    ratio * tolerance) else 0
                before, h_before = logarithm, h
                accepted = stalled >= 2
            if accepted:
                factor = step_factor(logarithm, last_error, per_power)
                if ratio > 1.0:
                    counted[ROUNDED] += 1
                    # No shorter step would be better.
                    factor = 2.0
                clock[SHRUNK] = clock[SHRUNK] + 1.0 if factor < 1.0 else 0.0
                if clock[SHRUNK] >= _PERSISTENCE:
                    # So long without effect: the estimates are rounding.
                    clock[SHRUNK] = 0.0
                    factor = _FASTEST
                last_error = logarithm
                longer = h * min(max(factor, _SLOWEST), _FASTEST)
                # A step that was cut short says nothing against the length it would have had.
                following = max(longer, natural) if h < natural else longer
                counted[STEPS] += 1
            else:
                factor = binary_power(_LOG_SAFETY - logarithm / power)
                following = h * min(max(factor, _SLOWEST), 0.7)
                counted[REJECTED] += 1
        if not accepted:
            if status == REACHED:
                status = BUDGET_SPENT
            for i in range(size):
                y_new[i] = y[i]
                rate_new[i] = rate[i]
            step = 0.0
            break
        keep_stages(tableaux.radau, model, size, memory, dense)
        normalise(bodies, rigid, y_new)
        whole = math.floor(end)
        step = h
        base += whole
        reached = end - whole
        if end == target:
            # The limit, with the rounding that it has seen from the new whole second.
            reached = since_base(limit, base)
        clock[DENSE] = 0.0
        begin_rates(tableaux.stiff, model, drive, base + reached, y_new, rate_new)
        counted[EVALUATIONS] += 1
        if calm > 0.0:
            clock[CALM] = calm_for(bodies, rigid, rate_new, calm, clock[CALM] + h)
    clock[BASE], clock[END], clock[STEP] = base, reached, step
    clock[NEXT], clock[LAST_ERROR] = following, last_error
    store(size, y, states[0])
    store(size, y_new, states[1])
    store(size, rate, states[2])
    store(size, rate_new, states[3])
    return status
