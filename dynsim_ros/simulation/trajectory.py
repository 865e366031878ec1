# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The states that a run went through, as arrays."""

import numpy as np


class Trajectory:
    """
    Snapshots of one run in order of time.

    snapshots: list of Snapshot; time: (n,) [s]. The methods return one row per snapshot.
    """

    def __init__(self, snapshots):
        self.snapshots = snapshots
        self.time = np.array([snapshot.time_ns for snapshot in snapshots]) / 1e9

    def position(self, body):
        """Return (n, 3) positions of a body's centre of mass in world [m]."""
        return np.array([snapshot.position(body) for snapshot in self.snapshots])

    def velocity(self, body):
        """Return (n, 3) velocities of a body's centre of mass in world [m/s]."""
        return np.array([snapshot.velocity(body) for snapshot in self.snapshots])

    def orientation(self, body):
        """Return (n, 4) quaternions (w, x, y, z), body to world, of a rigid body."""
        return np.array([snapshot.orientation(body) for snapshot in self.snapshots])

    def angular_velocity(self, body):
        """Return (n, 3) angular velocities of a rigid body in world [rad/s]."""
        return np.array([snapshot.angular_velocity(body) for snapshot in self.snapshots])

    def energy(self):
        """Return (n,) mechanical energies [J]."""
        return np.array([snapshot.energy.total for snapshot in self.snapshots])

    def imbalance(self):
        """Return (n,) errors of the energy balance [J]."""
        return np.array([snapshot.energy.imbalance for snapshot in self.snapshots])
