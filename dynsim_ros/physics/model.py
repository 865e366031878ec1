# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
A scene in the form that the compiled kernels take: numbers in arrays, None for what is absent.

The kernels are compiled for the types of what they are given, so that a scene without air (None)
runs code in which air does not occur.
"""

from typing import NamedTuple

import numpy as np

from .gravity import gravity_force
from .inertia import body_inertia, inverse
from .vector import norm
from ..scene import Particle, Rigid

# The direction of a spring is r L / (L^2 + epsilon^2). At this fraction of the spring's own
# lengths epsilon is lost in rounding, to the last bit, wherever L is above a millionth of them.
_EPSILON = 2.0 ** -64
# No epsilon comes from a shorter length [m] than this: 1 / epsilon^2 must be finite.
_SHORTEST = 1e-130


class SpringEnds(NamedTuple):
    """
    Where one end of each spring of a group is: at anchors, at particles or on rigid bodies.

    Exactly one of anchor, particle and body: (n,) indices, the others None; offset: (n, 3)
    body-fixed [m] where it is body, or AxisOffset, None where the state has the arm (see arms).
    """

    anchor: np.ndarray | None
    particle: np.ndarray | None
    body: np.ndarray | None
    offset: np.ndarray | None


class SpringGroup(NamedTuple):
    """
    Springs with the same kinds of ends P and Q.

    damping: None where they have no dampers; reach_at: where in a state the reach of a single one
    has its place, if it has any, see reach and reaches; is_kept: True where it is there, else
    None.
    """

    p: SpringEnds
    q: SpringEnds
    stiffness: np.ndarray
    natural_length: np.ndarray
    epsilon: np.ndarray
    damping: np.ndarray | None
    reach_at: int | None = None
    is_kept: bool | None = None


class ModelAir(NamedTuple):
    """Air: None for a drag that is absent, or that acts on no body, and for what is still."""

    linear_drag: float | None
    rotational_drag: float | None
    velocity: tuple | None
    angular_velocity: tuple | None


class Model(NamedTuple):
    """
    What the kernels know of a scene.

    Rigid bodies, `rigid` of them, come before particles. several: how many bodies and how many of
    them are rigid, None for a single one: the kernels then need no loop and no memory. mass:
    (bodies,) [kg], inverse_mass: 1 / m [1/kg]; round_body: (n,) indices of the bodies whose
    inertia is the same about every axis, round_inertia: (n,) [kg m^2], inverse_round_inertia: one
    over it, or None; general_body: (m,) indices of the others, inertia and inverse_inertia:
    (m, 3, 3) in body axes, or None; weight: (bodies, 3) force of gravity in world [N] or None;
    springs: tuple of SpringGroup or None; connections: the number of springs, None for a single
    one (or none); spring_bodies: (springs, 2) index of the body at P and at Q of each, -1 at an
    anchor; air: ModelAir or None. Where the structure is known when kernels are compiled, several
    and all indices are Known: see structure.
    """

    mass: np.ndarray
    inverse_mass: np.ndarray
    rigid: int
    several: tuple | None
    round_body: np.ndarray | None
    round_inertia: np.ndarray | None
    inverse_round_inertia: np.ndarray | None
    general_body: np.ndarray | None
    inertia: np.ndarray | None
    inverse_inertia: np.ndarray | None
    weight: np.ndarray | None
    springs: tuple | None
    connections: int | None
    spring_bodies: np.ndarray | None
    air: ModelAir | None


def body_order(scene):
    """Return the scene's bodies in the order of the model."""
    return sorted(scene.bodies, key=lambda body: not isinstance(body, Rigid))


def build_model(scene):
    """Return the Model of a Scene; what is zero is absent."""
    bodies = body_order(scene)
    inertias = [body_inertia(body) for body in bodies if isinstance(body, Rigid)]
    is_round = [isinstance(inertia, float) for inertia in inertias]
    # A kind of inertia that no body has is absent: None, not an empty array.
    round_body, general_body = np.flatnonzero(is_round), np.flatnonzero(np.logical_not(is_round))
    mass = np.array([body.mass for body in bodies])
    round_inertia = np.array([inertias[i] for i in round_body]) if len(round_body) else None
    matrices = np.array([inertias[i] for i in general_body]) if len(general_body) else None
    weight = None
    if scene.gravity:
        weight = np.array([gravity_force.py_func(body.mass, scene.gravity, scene.down)
                           for body in bodies])
    springs = [spring for spring in scene.springs if spring.stiffness or spring.damping]
    groups = _spring_groups(scene, springs, bodies)
    return Model(
        mass=mass, inverse_mass=1.0 / mass, rigid=len(inertias),
        several=(len(bodies), len(inertias)) if len(bodies) > 1 else None,
        round_body=round_body if len(round_body) else None,
        round_inertia=round_inertia,
        inverse_round_inertia=None if round_inertia is None else 1.0 / round_inertia,
        general_body=general_body if len(general_body) else None,
        inertia=matrices,
        inverse_inertia=None if matrices is None else np.array([*map(inverse, matrices)]),
        weight=weight, springs=groups, connections=len(springs) if len(springs) > 1 else None,
        spring_bodies=_spring_bodies(groups), air=_air(scene, inertias))


def _air(scene, inertias):
    air = scene.air
    if air is None:
        return None
    linear = air.linear_drag or None
    rotational = (air.rotational_drag or None) if inertias else None
    if linear is None and rotational is None:
        return None
    return ModelAir(linear, rotational, air.velocity if linear and any(air.velocity) else None,
                    air.angular_velocity if rotational and any(air.angular_velocity) else None)


def _spring_groups(scene, springs, bodies):
    if not springs:
        return None
    index = {member.name: i for members in (bodies, scene.anchors)
             for i, member in enumerate(members)}
    groups = {}
    for spring in springs:
        ends = ((scene.ends[spring.from_], spring.from_offset),
                (scene.ends[spring.to], spring.to_offset))
        kind = (*(_end_kind(member) for member, _ in ends), bool(spring.damping))
        groups.setdefault(kind, []).append((spring, *ends))
    return tuple(_group(kind, members, index) for kind, members in groups.items())


def _spring_bodies(groups):
    if groups is None:
        return None
    return np.concatenate([np.stack([_bodies_at(group.p), _bodies_at(group.q)], axis=1)
                           for group in groups])


def _bodies_at(ends):
    if ends.anchor is not None:
        return np.full_like(ends.anchor, -1)
    return ends.particle if ends.particle is not None else ends.body


def _end_kind(member):
    if not isinstance(member, Particle):
        return 'anchor'
    return 'body' if isinstance(member, Rigid) else 'particle'


def _group(kind, members, index):
    p_kind, q_kind, damped = kind
    springs, p, q = zip(*members)
    return SpringGroup(
        p=_ends(p_kind, p, index), q=_ends(q_kind, q, index),
        stiffness=np.array([spring.stiffness for spring in springs]),
        natural_length=np.array([spring.natural_length for spring in springs]),
        epsilon=np.array([_epsilon(*member) for member in members]),
        damping=np.array([spring.damping for spring in springs]) if damped else None)


def _ends(kind, ends, index):
    indices = np.array([index[member.name] for member, _ in ends])
    offset = np.array([_offset(*end) for end in ends]) if kind == 'body' else None
    return SpringEnds(**{name: indices if name == kind else None
                         for name in ('anchor', 'particle', 'body')}, offset=offset)


def _offset(body, offset):
    return body.default_offset if offset is None else offset


def _epsilon(spring, *ends):
    lengths = [spring.natural_length]
    lengths += [norm.py_func(_offset(*end)) for end in ends if isinstance(end[0], Rigid)]
    return _EPSILON * (max(*lengths, _SHORTEST) if any(lengths) else 1.0)
