# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The bodies of a scene: particle, sphere, box, rigid body of any inertia."""

from dataclasses import dataclass
import math

from .errors import SceneError
from .names import check_name
from .quantity import check_quantities, quantity

_ZERO = (0.0, 0.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class Particle:
    """
    A point with mass; it has no orientation, no angular velocity and no moments.

    position: (3,) in world [m]; velocity: (3,) in world [m/s]; both at the start of the run.
    """

    name: str
    mass: float = quantity('kg', 'mass', minimum=1e-9, maximum=1e6)
    position: tuple = quantity('m', 'centre of mass in world at the start', kind='vector',
                               minimum=-1e6, maximum=1e6, initial=True, default=_ZERO)
    velocity: tuple = quantity('m/s', 'velocity of the centre of mass in world at the start',
                               kind='vector', minimum=-1e6, maximum=1e6, initial=True,
                               default=_ZERO)

    def __post_init__(self):
        check_name(self.name)
        check_quantities(self, f'{self.name}.')

    @property
    def default_offset(self):
        """Return where a spring attaches: a particle has no extent, hence None."""
        return None


@dataclass(frozen=True, kw_only=True)
class Rigid(Particle):
    """
    What every body with an orientation has; use Sphere, Box or RigidBody.

    orientation: (4,) unit quaternion (w, x, y, z) that rotates body to world;
    angular_velocity: (3,) in world [rad/s]; both at the start of the run.
    """

    orientation: tuple = quantity('', 'unit quaternion, body to world, at the start '
                                  '(as a list: x y z w)', kind='orientation', minimum=-1.1,
                                  maximum=1.1, initial=True, default=(1.0, 0.0, 0.0, 0.0))
    angular_velocity: tuple = quantity('rad/s', 'angular velocity in world at the start',
                                       kind='vector', minimum=-1e6, maximum=1e6, initial=True,
                                       default=_ZERO)

    @property
    def default_offset(self):
        """Return where a spring attaches unless told otherwise: (3,) body-fixed [m]."""
        return _ZERO


@dataclass(frozen=True, kw_only=True)
class Sphere(Rigid):
    """A solid sphere of uniform density; springs attach at radius times b_z by default."""

    radius: float = quantity('m', 'radius', minimum=1e-9, maximum=1e4)

    @property
    def default_offset(self):
        """Return the point on the edge of the sphere along body z: (3,) body-fixed [m]."""
        return (0.0, 0.0, self.radius)


@dataclass(frozen=True, kw_only=True)
class Box(Rigid):
    """A solid box of uniform density; springs attach at the middle of its +z face by default."""

    size: tuple = quantity('m', 'edge lengths along body x, y, z', kind='vector', minimum=1e-9,
                           maximum=1e4)

    @property
    def default_offset(self):
        """Return the middle of the face towards body +z: (3,) body-fixed [m]."""
        return (0.0, 0.0, 0.5 * self.size[2])


@dataclass(frozen=True, kw_only=True)
class RigidBody(Rigid):
    """
    A body given by mass and inertia about its centre of mass, in body axes [kg m^2].

    inertia: one number (the same about every axis), three principal moments, or a symmetric
    3 x 3 matrix.
    """

    inertia: object = quantity('kg m^2', 'inertia about the centre of mass in body axes',
                               kind='inertia', minimum=1e-15, maximum=1e12)

    def __post_init__(self):
        super().__post_init__()
        value = self.inertia
        if isinstance(value, float):
            return
        if isinstance(value[0], float):
            moments = sorted(value)
        else:
            if any(value[i][j] != value[j][i] for i, j in ((0, 1), (0, 2), (1, 2))):
                raise SceneError(f'{self.name}.inertia: the matrix {value} is not symmetric')
            moments = _symmetric_eigenvalues(value)
        # A body of positive mass everywhere obeys both; rounding is given its due. A matrix of
        # a thin rod, turned, has a moment of about zero, and cannot be inverted.
        if moments[0] <= 1e-12 * moments[2] or moments[0] + moments[1] < moments[2] * (1.0 - 1e-9):
            shown = ', '.join(f'{m:.6g}' for m in moments)
            raise SceneError(
                f'{self.name}.inertia: principal moments {shown} kg m^2 belong to no body; each '
                'must be above 0 and none above the sum of the other two')


def _symmetric_eigenvalues(matrix):
    """Return the eigenvalues, ascending, of a symmetric 3 x 3 matrix (Smith's closed form)."""
    (a, d, f), (_, b, e), (_, _, c) = matrix
    off = d * d + e * e + f * f
    mean = (a + b + c) / 3.0
    spread = (a - mean) ** 2 + (b - mean) ** 2 + (c - mean) ** 2 + 2.0 * off
    if spread == 0.0:
        return [mean] * 3
    p = math.sqrt(spread / 6.0)
    a, b, c, d, e, f = ((a - mean) / p, (b - mean) / p, (c - mean) / p, d / p, e / p, f / p)
    half_determinant = 0.5 * (a * (b * c - e * e) - d * (d * c - e * f) + f * (d * e - b * f))
    angle = math.acos(max(-1.0, min(1.0, half_determinant))) / 3.0
    return sorted(mean + 2.0 * p * math.cos(angle + 2.0 * math.pi * i / 3.0) for i in range(3))
