# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The state of a run at one instant, and what follows from it: forces, energies."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .layout import Layout
from .settings import Settings
from ..physics.drive import Drive
from ..physics.energies import energies
from ..physics.model import Model
from ..physics.motion import accelerations
from ..physics.state import WORKS
from ..physics.wrenches import wrenches
from ..scene import Scene

# Rows of the array that the kernel for wrenches fills.
WRENCH_KINDS = ('spring', 'damper', 'air', 'gravity')


@dataclass(frozen=True)
class Energy:
    """
    Energies and the work done since the start of the run [J].

    work: {'damper', 'air', 'anchor', 'push'}: done on the bodies and springs by each;
    imbalance: total minus what it was at the start minus all work: the error of the integration.
    """

    kinetic: float
    gravitational: float
    spring: float
    work: dict
    imbalance: float

    @property
    def total(self):
        """Return the mechanical energy [J]."""
        return self.kinetic + self.gravitational + self.spring


@dataclass(frozen=True)
class Snapshot:
    """
    One instant of a run; arrays in world axes, SI units.

    time_ns: simulated time since the start of the epoch; tick: number of the tick; epoch: how
    often the run was reset; scene: as it is then; state: see physics.state; anchors: (n, 6)
    position and velocity; pushes: commanded wrenches, laid out as the state; reference_energy:
    [J], see Energy.
    """

    time_ns: int
    tick: int
    epoch: int
    scene: Scene
    layout: Layout
    model: Model
    state: np.ndarray
    anchors: np.ndarray
    pushes: np.ndarray
    reference_energy: float
    settings: Settings
    under_way: tuple

    def position(self, body):
        """Return the position of a body's centre of mass: (3,) [m]."""
        return self.state[self.layout.position(body)]

    def velocity(self, body):
        """Return the velocity of a body's centre of mass: (3,) [m/s]."""
        return self.state[self.layout.velocity(body)]

    def orientation(self, body):
        """Return a rigid body's quaternion (w, x, y, z), body to world; None for a particle."""
        place = self.layout.orientation(body)
        return None if place is None else self.state[place]

    def angular_velocity(self, body):
        """Return a rigid body's angular velocity: (3,) [rad/s]; None for a particle."""
        place = self.layout.angular_velocity(body)
        return None if place is None else self.state[place]

    def anchor_position(self, anchor):
        """Return the position of an anchor: (3,) [m]."""
        return self.anchors[self.layout.anchors.index(anchor), :3]

    def anchor_velocity(self, anchor):
        """Return the velocity of an anchor: (3,) [m/s]."""
        return self.anchors[self.layout.anchors.index(anchor), 3:]

    @cached_property
    def forces(self):
        """Return forces and torques by kind, (4, size): rows WRENCH_KINDS, laid out as state."""
        return self.computed_forces()

    def computed_forces(self):
        """Return what `forces` does, computed anew."""
        out = np.zeros((len(WRENCH_KINDS), self.layout.size))
        wrenches(self.model, self.anchors, 0.0, self.state, out)
        return out

    @cached_property
    def net_forces(self):
        """Return the sum of all forces and torques and the commanded ones, as one such row."""
        return self.forces.sum(axis=0) + self.pushes

    def force_row(self, kind):
        """Return the forces and torques of one kind, or 'net', laid out as the state."""
        return self.net_forces if kind == 'net' else self.forces[WRENCH_KINDS.index(kind)]

    def wrench(self, kind, body):
        """
        Return (force, torque) on a body about its centre of mass: (3,) [N], (3,) [N m].

        kind: 'spring', 'damper', 'air', 'gravity' or 'net'; torque is None for a particle.
        """
        row = self.force_row(kind)
        place = self.layout.angular_velocity(body)
        return row[self.layout.velocity(body)], None if place is None else row[place]

    @cached_property
    def accelerations(self):
        """Return linear and angular accelerations in world [m/s^2, rad/s^2], as one such row."""
        out = np.zeros(self.layout.size)
        drive = Drive(self.anchors, True if self.scene.anchors else None, self.pushes, None)
        accelerations(self.model, drive, 0.0, self.state, out)
        return out

    @cached_property
    def energy(self):
        """Return the Energy of this instant."""
        kinetic, gravitational, spring = energies(self.model, self.anchors, 0.0, self.state)
        damper, air, anchor, push = works = self.state[self.layout.work].tolist()
        total = kinetic + gravitational + spring
        return Energy(kinetic, gravitational, spring, dict(zip(WORKS, works)),
                      total - self.reference_energy - (damper + air + anchor + push))
