# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is known of the rotation of one rigid body on which no spring exerts a moment."""

from typing import NamedTuple

from ..closed_form import is_along, keeps_axis, reaches
from ...physics.rotation import rotation_matrix
from ...physics.vector import add, dot, scale, transform, transform_back

ZERO = (0.0, 0.0, 0.0)


class Rotation(NamedTuple):
    """
    A rotation at time 0; vectors (3,) in world.

    orientation (w, x, y, z); omega [rad/s]; torque: commanded [N m]; drag [N m s/rad] and whirl
    [rad/s] of the air, both zero where no air resists.
    """

    orientation: tuple
    omega: tuple
    torque: tuple
    drag: float
    whirl: tuple

    @property
    def is_free(self):
        """Return whether no moment ever acts."""
        return self.torque == ZERO and (
            self.drag == 0.0 or self.omega == ZERO and self.whirl == ZERO)

    @property
    def keeps_axis(self):
        """Return whether a body of scalar inertia turns about a fixed axis."""
        return (keeps_axis(self.omega, self.torque) and keeps_axis(self.omega, self.whirl)
                and keeps_axis(self.torque, self.whirl))

    @property
    def final(self):
        """Return the angular velocity that a body tends to; drag: not zero."""
        return add(self.whirl, scale(1.0 / self.drag, self.torque))

    def is_soon_stopped(self, inertia):
        """Return whether the series for what air does to a spin about any axis reaches."""
        return self.drag > 0.0 and reaches(self.omega, self.final, self.drag / inertia)

    def inertia_about_axis(self, matrix):
        """
        Return the inertia [kg m^2] about a principal axis along which all vectors are, or None.

        matrix: (3, 3) in body axes. Along it to the last bit: the axis may be an unstable one.
        """
        vectors = [vector for vector in (self.omega, self.torque, self.whirl) if any(vector)]
        axis = transform_back(rotation_matrix(self.orientation), vectors[0])
        along = transform(matrix, axis)
        if is_along(axis, along) and all(is_along(vectors[0], vector) for vector in vectors[1:]):
            return dot(along, axis) / dot(axis, axis)
        return None


def rotations_of(model, drive, start):
    """Return the Rotations of the rigid bodies of a model; start: the state."""
    bodies, rigid = len(model.mass), model.rigid
    drag, whirl = 0.0, ZERO
    if model.air is not None and model.air.rotational_drag:
        drag, whirl = model.air.rotational_drag, model.air.angular_velocity or (0.0, 0.0, 0.0)
    found = []
    for i in range(rigid):
        q, w = 6 * bodies + 4 * i, 6 * bodies + 4 * rigid + 3 * i
        torque = ZERO if drive.pushes is None else tuple(drive.pushes[w:w + 3].tolist())
        found.append(Rotation(tuple(start[q:q + 4].tolist()), tuple(start[w:w + 3].tolist()),
                              torque, drag, whirl))
    return found
