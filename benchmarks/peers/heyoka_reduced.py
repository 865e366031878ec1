# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
heyoka, given the reduced equations of a sphere on one spring that dynsim_ros integrates itself.

They know that the spring's force does not depend on the sphere's turning about its own arm s:
d = Q - P, v, s and omega follow from each other, and one quadrature gives the twist psi,
d psi/dt = omega . (s + r n) / (r + s . n) with a fixed unit vector n. The orientation is the
shortest rotation from n to s / r, times psi about n, times a constant one. heyoka keeps one n for
a whole run: that of the middle of the arm's directions; runs whose arm comes close to -n are out.
"""

from algebra import add, cross, dot, is_zero, Numbers, plus, scale, subtract
from dynsim_ros.scene import Rigid, Sphere
import numpy as np
from quaternions import conjugate, product, rotated, shortest
from reference import references
from states import initial, moments_of_inertia, Places

from . import heyoka, installed

settings = heyoka.settings


def available():
    return installed('heyoka')[1]


def supports(case):
    scene = case.scene
    counts = (len(scene.bodies), len(scene.springs))
    if counts != (1, 1) or not isinstance(scene.bodies[0], Sphere):
        return 'the reduced equations are those of one sphere on one spring'
    if np.min(arm_directions(case) @ fixed_direction(case)) < -0.5:
        return 'the arm turns over, which needs another fixed direction in mid-run'
    return None


def prepare(case, setting):
    scene = case.scene
    body, start = scene.bodies[0], initial(scene)
    n = fixed_direction(case)
    arm = rotated(start[6:10], arm_in_body(scene))
    radius = np.linalg.norm(arm)
    rest = product(conjugate(shortest(n, arm / radius)), start[6:10])
    anchor = next(end for end in scene.ends.values() if not isinstance(end, Rigid))
    place, drift = np.array(anchor.position), np.array(anchor.velocity)
    y0 = np.concatenate([start[:3] + arm - place, start[3:6], arm, start[10:], [0.0]])
    end_place = place + case.duration * drift

    def state_of(y):
        d, v, s, omega, psi = y[:3], y[3:6], y[6:9], y[9:12], y[12]
        twist = np.array([np.cos(psi / 2), *(np.sin(psi / 2) * n)])
        q = product(shortest(n, s / np.linalg.norm(s)), product(twist, rest))
        return np.concatenate([end_place + d - s, v, q, omega])

    return heyoka.end_run(system(scene, body, drift, radius, n), y0, case.duration, setting.value,
                          state_of)


def system(scene, body, drift, radius, n):
    """Return the reduced equations in heyoka's symbols."""
    import heyoka as symbols

    y = symbols.make_vars(*(f'y{i}' for i in range(13)))
    numbers = Numbers(symbols.expression, lambda a: a ** -0.5)
    d, v, s, omega = ([*y[i:i + 3]] for i in (0, 3, 6, 9))
    spring, air = scene.springs[0], scene.air
    point = subtract(add(v, cross(omega, s)), [float(a) for a in drift])
    inverse = numbers.inverse_sqrt(dot(d, d))
    pull = spring.stiffness * (spring.natural_length * inverse - 1.0)
    if spring.damping:
        pull = pull - spring.damping * (dot(point, d) * (inverse * inverse))
    force = scale(pull, d)
    moment = cross(s, force)
    acceleration, spin = scale(1.0 / body.mass, force), 1.0 / moments_of_inertia(body)[0][0]
    if scene.gravity:
        acceleration = add(acceleration, [scene.gravity * a for a in scene.down])
    alpha = scale(spin, moment)
    if air is not None:
        wind = subtract(v, list(air.velocity))
        acceleration = subtract(acceleration, scale((air.linear_drag or 0.0) / body.mass, wind))
        whirl = subtract(omega, list(air.angular_velocity))
        alpha = subtract(alpha, scale((air.rotational_drag or 0.0) * spin, whirl))
    n = [float(a) for a in n]
    twist = dot(omega, add(s, [radius * a for a in n])) / plus(radius, dot(s, n))
    right = [*point, *acceleration, *cross(omega, s), *alpha, twist]
    return [(a, symbols.expression(b) if is_zero(b) else b) for a, b in zip(y, right)]


def arm_in_body(scene):
    spring, body = scene.springs[0], scene.bodies[0]
    offset = spring.to_offset if spring.to == body.name else spring.from_offset
    return np.array(body.default_offset if offset is None else offset)


def arm_directions(case):
    """Return unit vectors along the arm during the run: (n, 3)."""
    place = Places(case.scene).orientation(0)
    states = np.array([initial(case.scene), *references()[case.name]['samples']])
    arm = arm_in_body(case.scene)
    return np.array([rotated(q, arm / np.linalg.norm(arm)) for q in states[:, place]])


def fixed_direction(case):
    middle = arm_directions(case).mean(axis=0)
    return middle / np.linalg.norm(middle)
