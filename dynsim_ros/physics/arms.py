# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The arm of an attachment point beside the state: d(arm)/dt = omega x arm.

Forces then need not wait until the offset has been turned by the quaternion, which is only summed
up beside them. Within a step of high order this is as exact: the arm comes from the quaternion at
the start of each. For a single body whose inertia is the same about every axis, on a single
spring to an anchor; elsewhere arms come from quaternions. Beside it lies the reach: see there.

States with an arm are Cells; it lies behind the state of a single body, works included.
"""

from numba import types

from .fused import fused
from .jit import formula, overload
from .kinematics import attachment_arm
from .lanes import choose
from .model import Model, SpringEnds, SpringGroup
from .state import ARM, omega_at, quaternion, quaternion_at, REACH
from .vector import add, at, cross, put, scale

_QUATERNION, _OMEGA = quaternion_at(1), omega_at(1, 1)


def kept_end(model, is_absent):
    """
    Return 0 or 1, the end P or Q whose arm is kept, or None where none is.

    model: Model, or the types of its parts as such; is_absent(part): whether a part is None.
    """
    if (not is_absent(model.several) or not is_absent(model.connections)
            or is_absent(model.round_body) or is_absent(model.springs)):
        return None
    group = model.springs[0]
    on_body = [not is_absent(ends.body) for ends in (group.p, group.q)]
    return on_body.index(True) if on_body.count(True) == 1 else None


@formula
def turned_offset(ends, y):
    """Return the arm of the attachment point of the first of some SpringEnds: (3,) [m]."""
    return attachment_arm(quaternion(y, _QUATERNION), at(ends.offset[0], 0))


def arm_of_state(model, y):
    """Return the arm (3,) [m] in a state of numbers or Lanes, None where it is not kept."""
    end = kept_end(model, lambda part: part is None)
    return None if end is None else turned_offset(model.springs[0][end], y)


@overload(arm_of_state)
def _arm_of_state(model, y):
    end = kept_end(Types(model), is_none)
    if end is None:
        return lambda model, y: None
    return lambda model, y: turned_offset(model.springs[0][end], y)


def with_arm(model):
    """Return the Model for states with a reach and an arm; itself where none is kept."""
    end = kept_end(model, lambda part: part is None)
    if end is None:
        return model
    return armed(model, model.springs[0][1 - end], model.springs[0][end])


@overload(with_arm)
def _with_arm(model):
    end = kept_end(Types(model), is_none)
    if end is None:
        return lambda model: model
    other = 1 - end
    return lambda model: armed(model, model.springs[0][other], model.springs[0][end])


@formula
def armed(model, p, q):
    """Return a Model whose spring, from an anchor P to a body at Q, is found in the state."""
    group = model.springs[0]
    group = SpringGroup(SpringEnds(p.anchor, p.particle, p.body, None),
                        SpringEnds(q.anchor, q.particle, q.body, None), group.stiffness,
                        group.natural_length, group.epsilon, group.damping, REACH, True)
    return with_springs(model, (group,))


@formula
def with_springs(model, springs):
    """Return a Model with other SpringGroups."""
    return Model(model.mass, model.inverse_mass, model.rigid, model.several, model.round_body,
                 model.round_inertia, model.inverse_round_inertia, model.general_body,
                 model.inertia, model.inverse_inertia, model.weight, springs, model.connections,
                 model.spring_bodies, model.air)


class Types:
    """The types of the parts of a NamedTuple, by name or index, as the parts themselves."""

    def __init__(self, numba_type):
        self._parts = numba_type.types
        self._names = getattr(numba_type, 'fields', ())

    def __getattr__(self, name):
        return self[self._names.index(name)]

    def __getitem__(self, i):
        part = self._parts[i]
        return Types(part) if isinstance(part, types.BaseTuple) else part


def is_none(part):
    return isinstance(part, types.NoneType)


@formula
def begin_arm(arm, h, y, behind, here):
    """Let the arm of a midpoint rule begin; less what it is at the start, as all of the state."""
    if arm is not None:
        put(behind, ARM, (0.0 * h, 0.0 * h, 0.0 * h))
        put(here, ARM, scale(h, cross(at(y, _OMEGA), arm)))


@formula
def restart_arm(arm, ended, h, y, behind, here):
    """Let the arm begin anew in the lanes in which a sequence has ended."""
    if arm is not None:
        first = scale(h, cross(at(y, _OMEGA), arm))
        for i in range(3):
            here[ARM + i] = choose(ended, 0.0, here[ARM + i])
        put(behind, ARM, (choose(ended, first[0], behind[ARM]),
                          choose(ended, first[1], behind[ARM + 1]),
                          choose(ended, first[2], behind[ARM + 2])))


@formula
def put_arm(arm, here, state):
    """Write to a state where its arm has come to."""
    if arm is not None:
        put(state, ARM, add(arm, at(here, ARM)))


@formula
def step_arm(arm, h, state, behind):
    """Add 2 h times the arm's rate in a state, as the midpoint rule does."""
    if arm is not None:
        rate = cross(at(state, _OMEGA), at(state, ARM))
        for i in range(3):
            behind[ARM + i] = fused(h + h, rate[i], behind[ARM + i])
