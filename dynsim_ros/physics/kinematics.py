# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Kinematics of an attachment point Q of a rigid body (sheet, 2.1)."""

from .jit import formula
from .rotation import rotate
from .vector import add, cross, dot


@formula
def attachment_arm(q, offset):
    """
    Return the vector from the centre of mass to Q, in world: (3,) [m].

    q: orientation (w, x, y, z); offset: (3,) in body axes [m]; on the edge of a sphere r b_z.
    """
    return rotate(q, offset)


@formula
def attachment_position(position, arm):
    """Return the position of Q in world: (3,) [m]; position: of the centre of mass; arm: (3,)."""
    return add(position, arm)


@formula
def attachment_velocity(velocity, angular_velocity, arm):
    """Return v + omega x arm, the velocity of Q in world: (3,) [m/s]."""
    return add(velocity, cross(angular_velocity, arm))


@formula
def attachment_rate(velocity, angular_velocity, u, turn):
    """
    Return the velocity of an attachment point along u [m/s]: (v + omega x arm) . u.

    velocity: (3,) of the centre of mass [m/s]; angular_velocity: (3,) [rad/s]; u: (3,) unit
    vector; turn: (3,) arm x u [m]; all in world. (omega x arm) . u is written omega . turn.
    """
    return dot(velocity, u) + dot(angular_velocity, turn)
