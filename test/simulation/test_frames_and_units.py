# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
A motion does not depend on the frame or on the units in which it is described.

The whole scene is turned, moved, and set in uniform motion; or told in other units of mass, length
and time. Nothing is known of the motion itself but that it must come out the same.
"""

from by_hand import ByHand, nothing_compiled
from dynsim_ros.scene import get_value, scene_quantities, with_values
from dynsim_ros.simulation import Propagator
from dynsim_ros.simulation.layout import Layout
from newton_euler import rotation_of
import numpy as np
import pytest
from references import load
from scipy.spatial.transform import Rotation

TURN = Rotation.from_rotvec([0.7, -1.1, 0.4])
SHIFT, DRIFT = np.array([0.3, -2.0, 0.9]), np.array([0.25, 0.5, -0.125])
# Of mass, length and time in each unit.
DIMENSIONS = {'': (0, 0, 0), 'kg': (1, 0, 0), 'm': (0, 1, 0), 'm/s': (0, 1, -1),
              'm/s^2': (0, 1, -2), 'rad/s': (0, 0, -1), 'kg m^2': (1, 2, 0), 'N/m': (1, 0, -2),
              'N s/m': (1, 0, -1), 'N m s/rad': (1, 2, -1)}
STEPPED = ('gragg', 'stormer', 'stiff', 'dop853', 'rk4', 'leapfrog')


def scene_for(method):
    return load('S1' if method == 'stormer' else 'any_inertia')[0]


def quaternion(rotation):
    return np.roll(rotation.as_quat(), 1)


def moved_scene(scene, turn=TURN):
    """Return the scene in a frame that is turned, and moves along."""
    changes = {}
    for name in scene_quantities(scene):
        value, part = get_value(scene, name), name.rpartition('.')[2]
        if part == 'orientation':
            changes[name] = (turn * Rotation.from_quat(value)).as_quat().tolist()
        elif part in ('position', 'velocity', 'angular_velocity', 'down'):
            changes[name] = (turn.apply(value) + {'position': SHIFT, 'velocity': DRIFT}.get(
                part, np.zeros(3))).tolist()
    return with_values(scene, changes)


def moved_state(scene, y, t, turn=TURN):
    """Return a state as the moved scene has it."""
    y, layout = y.copy(), Layout(scene)
    for body in layout.bodies:
        r, v = layout.position(body), layout.velocity(body)
        y[r], y[v] = turn.apply(y[r]) + SHIFT + DRIFT * t, turn.apply(y[v]) + DRIFT
        q, omega = layout.orientation(body), layout.angular_velocity(body)
        if q is not None:
            y[q], y[omega] = quaternion(turn * rotation_of(y[q])), turn.apply(y[omega])
    return y


def difference(scene, ours, theirs):
    """Return the largest difference of two states; a quaternion may have the other sign."""
    ours, layout = ours.copy(), Layout(scene)
    for q in filter(None, map(layout.orientation, layout.bodies)):
        ours[q] *= np.sign(ours[q] @ theirs[q])
    return np.abs(ours - theirs)[:layout.work.start].max()


# With quaternions whose norm is not 1 within a step, the others turn with the frame only as
# exactly as they compute the motion.
@pytest.mark.parametrize('method, turn', [
    *((method, TURN) for method in ('gragg', 'stormer', 'leapfrog')),
    *((method, Rotation.identity()) for method in ('stiff', 'dop853', 'rk4'))])
def test_the_same_steps_in_another_frame(method, turn):
    scene = scene_for(method)
    here = ByHand(scene, method).run(0.2, 8)[-1]
    there = ByHand(moved_scene(scene, turn), method).run(0.2, 8)[-1]
    assert difference(scene, here, there) > 0.3
    assert difference(scene, moved_state(scene, here, 0.2, turn), there) < 1e-10


@pytest.mark.parametrize('method', ['extrapolation', 'dop853', 'auto'])
def test_the_same_motion_in_another_frame(method):
    scene = load('any_inertia')[0]
    with nothing_compiled():
        here, there = (Propagator(each, integrator=method, tolerance=1e-10).end_state(1.0)
                       for each in (scene, moved_scene(scene)))
    assert difference(scene, moved_state(scene, here, 1.0), there) < 1e-10


def scene_in(scene, units):
    """Return the scene in other units: (mass, length, time) as multiples of the new ones."""
    return with_values(scene, {
        name: scaled(get_value(scene, name), each.unit, units)
        for name, each in scene_quantities(scene).items()})


def scaled(value, unit, units):
    return (np.array(value) * np.prod(np.power(units, DIMENSIONS[unit]))).tolist()


def state_in(scene, y, units):
    """Return a state in other units."""
    y, layout = y.copy(), Layout(scene)
    for body in layout.bodies:
        y[layout.position(body)] *= units[1]
        y[layout.velocity(body)] *= units[1] / units[2]
        if layout.angular_velocity(body) is not None:
            y[layout.angular_velocity(body)] /= units[2]
    return y


@pytest.mark.parametrize('method', STEPPED)
@pytest.mark.parametrize('units', [(2.0, 1.0, 1.0), (1.0, 0.5, 1.0), (1.0, 1.0, 0.25),
                                   (2.0 ** 5, 2.0 ** 4, 2.0 ** 3)])
def test_powers_of_two_as_units_change_no_bit(method, units):
    scene = scene_for(method)
    here = ByHand(scene, method).run(0.25, 8)[-1]
    there = ByHand(scene_in(scene, units), method).run(0.25 * units[2], 8)[-1]
    np.testing.assert_array_equal(state_in(scene, here, units), there)


@pytest.mark.parametrize('method', STEPPED)
def test_millimetres_grams_and_milliseconds(method):
    scene, units = scene_for(method), (1e3, 1e3, 1e3)
    here = ByHand(scene, method).run(0.2, 8)[-1]
    there = ByHand(scene_in(scene, units), method).run(0.2 * units[2], 8)[-1]
    assert difference(scene, here, state_in(scene, there, (1e-3, 1e-3, 1e-3))) < 2e-11


@pytest.mark.parametrize('method', ['extrapolation', 'dop853', 'auto'])
def test_the_same_motion_in_centimetres_and_decagrams(method):
    scene, units = load('any_inertia')[0], (1e2, 1e2, 1.0)
    with nothing_compiled():
        here, there = (Propagator(each, integrator=method, tolerance=1e-10).end_state(1.0)
                       for each in (scene, scene_in(scene, units)))
    # the tolerance is of the larger numbers now
    assert difference(scene, here, state_in(scene, there, (1e-2, 1e-2, 1.0))) < 1e-9
