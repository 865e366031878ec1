# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
A scene's motion in closed form as the compiled kernel takes it; None for what does not occur.

Vectors are (3,) in world, SI units, at the instant at which the motion begins (time 0).
"""

from typing import NamedTuple

import numpy as np

from ..closed_form import SpringLine
from ...physics.model import Model


class Flights(NamedTuple):
    """Free flight of all bodies; acceleration: (bodies, 3); drag, wind: None without drag."""

    mass: np.ndarray
    acceleration: np.ndarray
    drag: float | None
    wind: tuple | None


class Centred(NamedTuple):
    """A single body on springs of natural length zero; see on_centred_springs."""

    mass: float
    stiffness: float
    centre: tuple
    centre_velocity: tuple
    acceleration: tuple
    drag: float | None
    wind: tuple | None


class Line(NamedTuple):
    """A single body on the line of its only spring; arm: from its centre to the spring's end."""

    spring: SpringLine
    arm: tuple


class Spins(NamedTuple):
    """
    Rotations about fixed axes without resistance, with a constant inertia about each.

    body: (n,); inertia: (n,) [kg m^2]; acceleration: (n, 3) by commanded torques [rad/s^2].
    """

    body: np.ndarray
    inertia: np.ndarray
    acceleration: np.ndarray


class Slowed(NamedTuple):
    """The same with rotational drag [N m s/rad]; whirl: angular velocity of the air [rad/s]."""

    body: np.ndarray
    inertia: np.ndarray
    acceleration: np.ndarray
    drag: float
    whirl: tuple


class Whirls(NamedTuple):
    """
    Rotations with scalar inertia that the air soon takes along with it, about any axes.

    As Slowed, and decay: (n,) [1/s]; final: (n, 3) what the spin tends to [rad/s]; series:
    (n, TERMS, 4) and constant: (n, 4) from whirl_series and constant_of_whirl, as soon as known:
    (1,) is True, see Tops.
    """

    body: np.ndarray
    inertia: np.ndarray
    acceleration: np.ndarray
    drag: float
    whirl: tuple
    decay: np.ndarray
    final: np.ndarray
    series: np.ndarray
    constant: np.ndarray
    known: np.ndarray


class Tops(NamedTuple):
    """
    Rotations without moments.

    body: (n,); moments: (n, 3), axes: (n, 3, 3), from principal_axes; constants: (n, TOP_SIZE),
    TorqueFree laid flat, as soon as known: (1,) is True: the compiled kernel finds them, which
    plain Python takes long for.
    """

    body: np.ndarray
    moments: np.ndarray
    axes: np.ndarray
    constants: np.ndarray
    known: np.ndarray


class Holding(NamedTuple):
    """
    What is needed for the works of springs and anchors that hold a single body.

    impulse: what acts on it besides springs and drag [N]; damping: of its only spring; linear,
    quadratic: the anchors' work is that of their mean velocity plus linear t + quadratic t^2.
    """

    mass: float
    force: tuple
    velocity: tuple
    linear: float
    quadratic: float
    damping: float
    drag: float
    wind: tuple


class Balance(NamedTuple):
    """
    What is needed for the works.

    pushes: forces laid out as the state, None without any; resists: whether there is air, whirls:
    with rotational drag; energy, spin_energy: mechanical, and of the rotations, at time 0 [J].
    """

    model: Model
    anchors: np.ndarray
    pushes: np.ndarray | None
    resists: bool
    whirls: bool
    energy: float
    spin_energy: float
    holding: Holding | None


class ClosedScene(NamedTuple):
    """A motion in closed form; start: the state at time 0; balance: None without works."""

    start: np.ndarray
    bodies: int
    rigid: int
    flights: Flights | None = None
    centred: Centred | None = None
    line: Line | None = None
    spins: Spins | None = None
    slowed: Slowed | None = None
    whirls: Whirls | None = None
    tops: Tops | None = None
    balance: Balance | None = None


# Which parts are None where nothing ever moves.
AT_REST = (False, False, False) + (True,) * (len(ClosedScene._fields) - 3)
