# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The energy of a run changes by the work that damper, air, anchor and push do, each alone too."""

from dynsim_ros.scene import load_scene, with_values
from dynsim_ros.simulation import MoveAnchor, PushBody, SetValues, Simulator
import numpy as np
import pytest
from scipy.integrate import simpson

SCENE = load_scene('sphere_on_spring')
LOSSLESS = {'air.linear_drag': 0, 'air.rotational_drag': 0, 'spring.damping': 0}
WIND = {'air.velocity': (2, 0, 1), 'air.angular_velocity': (0, 3, 0)}


def run(changes, duration=2.0, step=2e-4):
    return Simulator(with_values(SCENE, changes), integrator='rk4', step=step,
                     rate=1000).run(duration)


def works(trajectory):
    return trajectory.snapshots[-1].energy.work


def gained(trajectory):
    return trajectory.energy()[-1] - trajectory.energy()[0]


def power(trajectory, kind):
    """Return (n,) power of the air or of the damper's reaction on the sphere [W]."""
    rows = []
    for snapshot in trajectory.snapshots:
        force, torque = snapshot.wrench(kind, 'sphere')
        rows.append(force @ snapshot.velocity('sphere')
                    + torque @ snapshot.angular_velocity('sphere'))
    return np.array(rows)


def test_without_any_of_them_energy_stays():
    found = run(LOSSLESS)
    assert set(works(found).values()) == {0.0}
    np.testing.assert_allclose(found.energy(), found.energy()[0], atol=1e-9)


@pytest.mark.parametrize('kind, changes', [
    ('damper', {**LOSSLESS, 'spring.damping': 0.5}),
    ('air', {**LOSSLESS, **WIND, 'air.linear_drag': 0.1, 'air.rotational_drag': 0.001})])
def test_work_of_damper_and_of_air_alone(kind, changes):
    """Simpson's rule over the wrench that is published, times the velocity."""
    found = run(changes)
    assert works(found)[kind] == pytest.approx(gained(found), abs=1e-9)
    assert works(found)[kind] == pytest.approx(simpson(power(found, kind), x=found.time),
                                               abs=1e-8)
    assert [name for name, work in works(found).items() if work] == [kind]


def test_a_damper_only_takes_and_a_wind_can_give():
    assert works(run({**LOSSLESS, 'spring.damping': 0.5}))['damper'] < -0.1
    storm = {'air.velocity': (20, 0, 0), 'sphere.position': (-0.3, 0, 1.2)}
    assert works(run({**LOSSLESS, **storm, 'air.linear_drag': 0.1}))['air'] > 0.1


def test_work_of_a_moving_anchor_alone():
    """The hand feels what the spring does to the sphere, reversed."""
    velocity = np.array([0.3, -0.2, 0.5])
    found = run({**LOSSLESS, 'hand.velocity': velocity})
    pull = [snapshot.wrench('spring', 'sphere')[0] for snapshot in found.snapshots]
    assert works(found)['anchor'] == pytest.approx(simpson(pull @ velocity, x=found.time),
                                                   abs=1e-8)
    assert works(found)['anchor'] == pytest.approx(gained(found), abs=1e-9)


def test_work_of_a_push_alone():
    """A constant force does F . (r2 - r1)."""
    simulator = Simulator(with_values(SCENE, LOSSLESS), integrator='rk4', step=2e-4,
                          wrench_timeout=0)
    force = np.array([1.0, -2.0, 0.5])
    before = simulator.snapshot()
    simulator.apply(PushBody('sphere', force))
    simulator.run(1.0)
    after = simulator.snapshot()
    way = after.position('sphere') - before.position('sphere')
    assert after.energy.work['push'] == pytest.approx(force @ way, abs=1e-12)
    assert after.energy.total - before.energy.total == pytest.approx(force @ way, abs=1e-9)


@pytest.mark.parametrize('method, near', [('rk4', 1e-14), ('auto', 1e-9)])
def test_a_jump_of_an_anchor_is_work_of_the_anchor(method, near):
    simulator = Simulator(SCENE, integrator=method)
    simulator.run(0.5)
    before = simulator.snapshot().energy
    simulator.apply(MoveAnchor('hand', (0.2, 0, 2.1)))
    after = simulator.snapshot().energy
    assert abs(after.total - before.total) > 0.1
    assert after.work['anchor'] - before.work['anchor'] == pytest.approx(
        after.total - before.total, rel=1e-12, abs=near)
    assert after.imbalance == pytest.approx(before.imbalance, abs=near)


@pytest.mark.parametrize('method, near', [('rk4', 0.0), ('auto', 1e-9)])
def test_a_changed_quantity_is_no_work_and_no_imbalance(method, near):
    simulator = Simulator(SCENE, integrator=method, step=2e-4)
    simulator.run(0.5)
    before = simulator.snapshot().energy
    simulator.apply(SetValues({'spring.stiffness': 300, 'sphere.mass': 3}))
    after = simulator.snapshot().energy
    assert after.total - before.total > 1
    assert after.work == pytest.approx(before.work, rel=0.0, abs=near)
    assert after.imbalance == pytest.approx(before.imbalance, abs=1e-13 + near)


def test_imbalance_is_the_error_of_the_integration_and_falls_with_the_step():
    """All at once, through commands; the balance is of the order of the method, 4."""
    def imbalance(step):
        simulator = Simulator(with_values(SCENE, {**WIND, 'hand.velocity': (0.1, 0, 0)}),
                              integrator='rk4', step=step, anchor_interpolation='linear')
        simulator.run(0.5)
        simulator.apply(PushBody('sphere', (3, 0, 1), (0.001, 0.002, 0)))
        simulator.run(0.3)
        simulator.apply(MoveAnchor('hand', (0.3, 0.2, 2)))
        return np.abs(simulator.run(1.0).imbalance()).max()

    coarse, fine = imbalance(5e-4), imbalance(2.5e-4)
    assert fine < 1e-11
    assert coarse / fine == pytest.approx(16, rel=0.1)
