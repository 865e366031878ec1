# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
How the state of a model lies in one array, and the parts of it that the kernels address.

Positions (3 per body), velocities (3 per body), quaternions (4 per rigid body), angular
velocities (3 per rigid body), then the work done so far by dampers, air, anchors and pushes [J].
A particle has no place among quaternions and angular velocities.
"""

import math

from numba import types
import numpy as np

from .jit import formula, overload
from .known import Known, KnownType
from .model import body_order
from .rotation import quaternion_norm

WORKS = ('damper', 'air', 'anchor', 'push')
# What is kept beside the state of a single body on a single spring, see arms and reach: the arm,
# and the reach: the vector to the body from the anchor, and two numbers that its length is found
# by.
ARM = 6 + 7 + len(WORKS)
REACH = ARM + 3
VECTOR, EXCESS, CORRECTION, REACH_SIZE = 0, 3, 4, 5


@formula
def single_rigid_count(round_body, general_body):
    """Return how many rigid bodies there are, one or none, where there is one body."""
    if round_body is not None:
        return 1
    if general_body is not None:
        return 1
    return 0


def body_counts(several, round_body, general_body):
    """Return (bodies, rigid bodies); known when compiled for a single body or a structure."""
    return several or (1, single_rigid_count(round_body, general_body))


@overload(body_counts)
def _body_counts(several, round_body, general_body):
    if isinstance(several, types.NoneType):
        return lambda several, round_body, general_body: (
            1, single_rigid_count(round_body, general_body))
    return lambda several, round_body, general_body: several


@formula
def counts(model):
    """Return (bodies, rigid bodies)."""
    return body_counts(model.several, model.round_body, model.general_body)


def moving_size(works, bodies, rigid):
    """Return how much of the state changes: all but the works where these are not counted."""
    return work_at(bodies, rigid) + (0 if works is None else len(WORKS))


@overload(moving_size)
def _moving_size(works, bodies, rigid):
    counted = 0 if isinstance(works, types.NoneType) else len(WORKS)
    if isinstance(bodies, KnownType):
        size = Known(work_at(bodies.number, rigid.number) + counted)
        return lambda works, bodies, rigid: size
    return lambda works, bodies, rigid: work_at(bodies, rigid) + counted


@formula
def velocity_at(bodies):
    """Return where the velocities begin; bodies: number of bodies."""
    return 3 * bodies


@formula
def quaternion_at(bodies):
    """Return where the quaternions begin."""
    return 6 * bodies


@formula
def omega_at(bodies, rigid):
    """Return where the angular velocities begin; rigid: number of rigid bodies."""
    return 6 * bodies + 4 * rigid


@formula
def work_at(bodies, rigid):
    """Return where the works begin."""
    return 6 * bodies + 7 * rigid


@formula
def quaternion(y, i):
    """Return four numbers w, x, y, z of y, beginning at index i."""
    return (y[i], y[i + 1], y[i + 2], y[i + 3])


@formula
def put_quaternion(y, i, q):
    """Write a quaternion to y, beginning at index i."""
    y[i] = q[0]
    y[i + 1] = q[1]
    y[i + 2] = q[2]
    y[i + 3] = q[3]


@formula
def normalise(bodies, rigid, y):
    """
    Divide every quaternion of y by its norm (sheet, 4.2).

    Returns the largest distance of a norm from 1: what the normalisation has removed. A norm a
    thousand times too large or too small is no rounding: the quaternion becomes not a number.
    """
    largest = 0.0
    for i in range(quaternion_at(bodies), omega_at(bodies, rigid), 4):
        q = quaternion(y, i)
        n = quaternion_norm(q)
        if not 1e-3 < n < 1e3:
            n = math.nan
        largest = max(largest, abs(n - 1.0))
        put_quaternion(y, i, (q[0] / n, q[1] / n, q[2] / n, q[3] / n))
    return largest


def state_size(bodies, rigid):
    """Return the length of the state array."""
    return 6 * bodies + 7 * rigid + len(WORKS)


def initial_state(scene, model):
    """Return the state at the start of a run: (state_size,) float64."""
    bodies = body_order(scene)
    rigid = bodies[:model.rigid]
    parts = [[body.position for body in bodies], [body.velocity for body in bodies],
             [body.orientation for body in rigid], [body.angular_velocity for body in rigid],
             np.zeros(len(WORKS))]
    return np.concatenate([np.ravel(np.array(part, dtype=float)) for part in parts])
