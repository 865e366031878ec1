# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bodies that are put into another state while a run goes on; a state that begins anew in time."""

from dynsim_ros.scene import load_scene, with_values
from dynsim_ros.simulation import CommandError, MoveAnchor, PlaceBody, PushBody, Simulator
from dynsim_ros.simulation.carry_over import begun_anew
from dynsim_ros.simulation.checkpoint import checkpoint, restored
from newton_euler import NewtonEuler, rotation_of
import numpy as np
import pytest

SPHERE = load_scene('sphere_on_spring')
STATE = {'position': (0.1, -0.2, 1.3), 'velocity': (0.4, 0.5, -0.6),
         'orientation': (0.0, 0.6, 0.0, 0.8), 'angular_velocity': (-1.0, 2.0, 0.5)}


def placed(scene=SPHERE, state=None, **settings):
    """Return a Simulator whose first body was put somewhere at 0.25 s."""
    simulator = Simulator(scene, **settings)
    simulator.run(0.25)
    simulator.apply(PlaceBody(scene.bodies[0].name, STATE if state is None else state))
    return simulator


def test_the_body_is_there_at_once():
    simulator = placed()
    now = simulator.snapshot()
    assert (now.tick, now.time_ns) == (25, 250_000_000)
    assert [tuple(part) for part in (
        now.position('sphere'), now.velocity('sphere'), now.angular_velocity('sphere'))] == [
            STATE['position'], STATE['velocity'], STATE['angular_velocity']]
    # in Python (w, x, y, z), in commands as in messages
    assert tuple(now.orientation('sphere')) == (0.8, 0.0, 0.6, 0.0)


@pytest.mark.parametrize('method', [{'integrator': 'rk4', 'step': 5e-5},
                                    {'integrator': 'auto', 'tolerance': 1e-12}])
def test_it_goes_on_as_if_it_had_begun_there(method):
    simulator = placed(**method)
    simulator.run(0.5)
    begun = with_values(SPHERE, {f'sphere.{part}': value for part, value in STATE.items()})
    r, v, rotation, omega = NewtonEuler(begun).solve([0.5])[0]['sphere']
    end = simulator.snapshot()
    np.testing.assert_allclose(end.position('sphere'), r, atol=1e-10)
    np.testing.assert_allclose(end.velocity('sphere'), v, atol=1e-9)
    np.testing.assert_allclose(end.angular_velocity('sphere'), omega, atol=1e-8)
    np.testing.assert_allclose(rotation_of(end.orientation('sphere')).as_matrix(), rotation,
                               atol=1e-9)
    # what it was given is nobody's work, and no error of the integration
    assert abs(end.energy.imbalance) < 1e-8


def test_a_closed_motion_becomes_another_one():
    """A particle on the line of its spring is computed in closed form, beside it no longer."""
    scene = load_scene('particle_on_spring')
    for state in ({'position': (0.0, 0.0, 1.5), 'velocity': (0.0, 0.0, 0.3)},
                  {'position': (0.2, 0.1, 1.2), 'velocity': (0.5, 0.0, 0.1)}):
        simulator = placed(scene, state)
        simulator.run(0.5)
        begun = with_values(scene, {f'particle.{part}': value for part, value in state.items()})
        r, v = NewtonEuler(begun).solve([0.5])[0]['particle'][:2]
        np.testing.assert_allclose(simulator.snapshot().position('particle'), r, atol=1e-7)
        np.testing.assert_allclose(simulator.snapshot().velocity('particle'), v, atol=1e-6)


def test_what_is_not_given_stays():
    before = placed(state={'position': STATE['position']}).snapshot()
    simulator = Simulator(SPHERE)
    simulator.run(0.25)
    now = simulator.snapshot()
    assert tuple(before.position('sphere')) == STATE['position']
    # a step ends where it is put: within the tolerance, it is where it was in the midst of one
    for part in ('velocity', 'orientation', 'angular_velocity'):
        np.testing.assert_allclose(getattr(before, part)('sphere'), getattr(now, part)('sphere'),
                                   rtol=1e-10)


@pytest.mark.parametrize('command, words', [
    (PlaceBody('spher', STATE), "'spher' is no body of this scene; did you mean 'sphere'"),
    (PlaceBody('hand', {'position': (0, 0, 2)}), "'hand' is no body"),
    (PlaceBody('sphere', {'position': (0, 0, float('nan'))}),
     r'sphere.position\[2\]: nan is not finite'),
    (PlaceBody('sphere', {'position': (0, 0, 2e6)}), 'out of range: -1e.06 to 1e.06 m'),
    (PlaceBody('sphere', {'velocity': (1, 2)}), 'is not a list of 3 numbers in m/s'),
    (PlaceBody('sphere', {'orientation': (0, 0, 0, 0.5)}), 'its norm is 0.5, a unit quaternion'),
    (PlaceBody('sphere', {'orientation': None}), 'is not a list of 4 numbers'),
    (PlaceBody('sphere', {'mass': 2.0}), "'sphere.mass' is no part of the state of this body")])
def test_refused_whole(command, words):
    simulator = Simulator(SPHERE)
    simulator.run(0.1)
    before = checkpoint(simulator)
    with pytest.raises(CommandError, match=words):
        simulator.apply(command)
    assert checkpoint(simulator) == before


def test_a_particle_has_no_orientation():
    simulator = Simulator(load_scene('particle_on_spring'))
    with pytest.raises(CommandError, match="'particle.orientation' is no part of the state"):
        simulator.apply(PlaceBody('particle', {'orientation': (0, 0, 0, 1)}))


def test_time_begins_anew_and_all_else_goes_on():
    simulator = Simulator(SPHERE, anchor_interpolation='linear', wrench_timeout=0.1,
                          tolerance=1e-12)
    simulator.run(0.25)
    simulator.apply(PushBody('sphere', (0.0, 3.0, 0.0)))
    simulator.run(0.03)
    simulator.apply(MoveAnchor('hand', (0.2, 0.0, 2.1)))
    simulator.run(0.02)
    other = restored(checkpoint(begun_anew(simulator)))
    assert (other.time_ns, other.tick) == (0, 0)
    np.testing.assert_array_equal(other.snapshot().state, simulator.snapshot().state)
    for duration in (0.04, 0.04, 0.3):
        simulator.run(duration)
        other.run(duration)
        one, two = simulator.snapshot(), other.snapshot()
        np.testing.assert_array_equal(two.pushes, one.pushes)
        np.testing.assert_allclose(two.anchors, one.anchors, atol=1e-15)
        np.testing.assert_allclose(two.state, one.state, atol=1e-9)
        assert two.energy.imbalance == pytest.approx(one.energy.imbalance, abs=1e-9)
