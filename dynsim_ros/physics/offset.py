# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The arms of attachment points by their offsets: one on an axis of its body is turned in half."""

from typing import NamedTuple

from numba import types
import numpy as np

from .fused import fused
from .jit import formula, overload
from .kinematics import attachment_arm
from .known import Known
from .vector import at


class AxisOffset(NamedTuple):
    """Offsets on an axis of the body, 0, 1 or 2; distance: (n,) along it [m]."""

    axis: Known
    distance: np.ndarray


def offset_arm(q, offset, s):
    """
    Return the vector from the centre of mass to attachment point s, in world: (3,) [m].

    q: orientation (w, x, y, z); offset: (n, 3) in body axes [m], or AxisOffset.
    """
    if isinstance(offset, AxisOffset):
        return _axis_arm(offset.axis)(q, offset.distance[s])
    return attachment_arm(q, at(offset[s], 0))


@overload(offset_arm)
def _offset_arm(q, offset, s):
    if isinstance(offset, types.Array):
        return lambda q, offset, s: attachment_arm(q, at(offset[s], 0))
    axis_arm = _axis_arm(offset[0].number)
    return lambda q, offset, s: axis_arm(q, offset.distance[s])


@formula
def turned_axis(w, a, b, c, distance):
    """Return `distance` along axis a of a body, in world, in the order a, b, c; a, b, c: of q."""
    twice = 2.0 * distance
    return (fused(-twice, fused(b, b, c * c), distance), twice * fused(a, b, w * c),
            twice * fused(a, c, -w * b))


@formula
def x_arm(q, distance):
    """Return the arm of a point on the x axis of a body."""
    return turned_axis(q[0], q[1], q[2], q[3], distance)


@formula
def y_arm(q, distance):
    """Return the arm of a point on the y axis of a body."""
    y, z, x = turned_axis(q[0], q[2], q[3], q[1], distance)
    return (x, y, z)


@formula
def z_arm(q, distance):
    """Return the arm of a point on the z axis of a body."""
    z, x, y = turned_axis(q[0], q[3], q[1], q[2], distance)
    return (x, y, z)


def _axis_arm(axis):
    return (x_arm, y_arm, z_arm)[axis]
