# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The methods that the grids compare, ours and the peers', each run on one cell."""

from dataclasses import dataclass
import warnings

from dynsim_ros.integrators import IntegrationError
from dynsim_ros.simulation import Propagator
from metric import error
import numpy as np
import peers
from stability_cells import case_of
from states import Places

# Attempts at a step: auto has what a call has by default, the others what takes about as long.
BUDGETS = {'auto': 200_000, 'radau': 20_000}
BUDGET = 100_000
STAGES = {'rk4': 4, 'leapfrog': 1, 'semi_implicit_euler': 1, 'linearly_implicit_euler': 1,
          'explicit_euler': 1, 'explicit_euler_axis_angle': 1, 'RK4': 4, 'Euler': 1,
          'implicitfast': 1, 'semi-implicit Euler': 1}
# A method of fixed step, and a peer, is asked for this error.
PLAIN = 1e-3
# The difference at the start that shows how a cell magnifies errors.
CHANGE = 1e-8


@dataclass(frozen=True)
class Method:
    """A method as it stands in the tables; peer: None for ours; value: tolerance, or None."""

    name: str
    setting: str
    peer: str | None = None
    value: float | None = None


METHODS = (
    Method('auto 1e-6', 'auto', None, 1e-6), Method('auto 1e-9', 'auto', None, 1e-9),
    Method('extrapolation 1e-6', 'extrapolation', None, 1e-6),
    Method('stiff 1e-6', 'stiff', None, 1e-6), Method('radau 1e-6', 'radau', None, 1e-6),
    Method('dop853 1e-6', 'dop853', None, 1e-6),
    *(Method(name.replace('_', ' '), name) for name in (
        'rk4', 'leapfrog', 'semi_implicit_euler', 'linearly_implicit_euler', 'explicit_euler',
        'explicit_euler_axis_angle')),
    *(Method(f'MuJoCo {name}', name, 'mujoco') for name in ('Euler', 'implicitfast', 'RK4')),
    Method('PyBullet', 'semi-implicit Euler', 'pybullet'),
    Method('Drake RK3 1e-6', 'RK3', 'drake', 1e-6),
    Method('Drake radau3 1e-6', 'radau3', 'drake', 1e-6))


@dataclass(frozen=True)
class Result:
    """What came of a run: the state, or why there is none; shortfall: what the method says."""

    state: np.ndarray | None = None
    refused: str | None = None
    work: int | None = None
    shortfall: str | None = None


def run(job):
    """Return the Result of (Method, Parameters)."""
    method, parameters = job
    case = case_of(parameters)
    try:
        if method.peer is not None:
            return run_peer(method, parameters, case)
        return run_own(case, method.setting, method.value, parameters.step,
                       BUDGETS.get(method.setting, BUDGET))
    except Exception as reason:  # peers refuse with errors of any kind
        return Result(refused=(str(reason).splitlines() or [repr(reason)])[0])


def run_own(case, name, tolerance, step, budget):
    changes = {'step': step} if tolerance is None else {'tolerance': tolerance}
    propagator = Propagator(case.scene, budget=budget, integrator=name, **changes)
    try:
        state, refused = propagator.end_state(case.duration)[:Places(case.scene).size], None
    except IntegrationError as reason:
        state, refused = None, str(reason)
    if tolerance is None:
        return Result(state, refused, STAGES[name] * round(case.duration / step))
    return Result(state, refused, propagator.counts['evaluations'], propagator.shortfall)


def run_peer(method, parameters, case):
    warnings.simplefilter('ignore')
    if method.peer == 'pybullet':
        import stability_pybullet
        state = stability_pybullet.end_state(case, parameters.step)
    else:
        value = parameters.step if method.value is None else method.value
        prepared = peers.peer(method.peer).prepare(case, peers.Setting(method.setting, value))
        state = np.array(prepared.state(prepared.run()))
    work = None
    if method.value is None:
        work = STAGES[method.setting] * round(case.duration / parameters.step)
    return Result(state, work=work)


def reference(parameters):
    """
    Return (state, how, growth) of a cell, or None where nothing gets there.

    growth: what the cell makes of a difference at the start, at least 1.
    """
    for name, budget in (('extrapolation', 1_000_000), ('radau', 100_000)):
        ends = []
        for change in (0.0, CHANGE):
            case = case_of(parameters, change)
            result = run_own(case, name, 1e-12, None, budget)
            if result.state is None or not np.isfinite(result.state).all():
                break
            ends.append(result.state)
        if len(ends) == 2:
            growth = error(case.scene, ends[1], ends[0]) / CHANGE
            return ends[0], f'{name} 1e-12', max(1.0, growth)
    return None
