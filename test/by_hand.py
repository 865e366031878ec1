# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Single steps of the methods on a scene, in plain Python, without the loop that chooses steps."""

from contextlib import contextmanager

from dynsim_ros.integrators import (adaptive_steps, dop853_tableau, fixed_steps, METHODS,
                                    radau_tableau)
from dynsim_ros.integrators.dense_output import (dense_explicit, DENSE_SIZE, dense_stiff,
                                                 explicit_table, make_unit, radau_table,
                                                 stiff_table, write_state)
from dynsim_ros.integrators.dop853 import dense_dop853, dop853
from dynsim_ros.integrators.gragg import gragg, gragg_schedule
from dynsim_ros.integrators.lane_schedule import FINER
from dynsim_ros.integrators.memory import new_memory
from dynsim_ros.integrators.radau import dense_radau, radau
from dynsim_ros.integrators.stiff import stiff, stiff_schedule
from dynsim_ros.integrators.stormer import stormer, stormer_schedule
from dynsim_ros.physics.drive import undisturbed_drive
from dynsim_ros.physics.model import build_model
from dynsim_ros.physics.motion import rates
from dynsim_ros.physics.state import counts, initial_state, moving_size, normalise
from dynsim_ros.simulation import simulator, snapshot
from dynsim_ros.simulation.layout import Layout
from newton_euler import rotation_distance
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

RULES = {'gragg': (gragg, gragg_schedule), 'stormer': (stormer, stormer_schedule),
         'stiff': (stiff, stiff_schedule), 'dop853': (dop853, dop853_tableau.table),
         'radau': (radau, radau_tableau.table)}
# Of a step of radau: its iteration then goes on as long as it makes a difference, and it begins
# without a step before.
ALONE = (1e-13, 0.0, None)


class ByHand:
    """
    A scene and a method: a name of RULES, or of a method of fixed step.

    sequences: what the schedule of an extrapolation is made from, as in the package unless given:
    substeps, then perhaps stages; drive: fields of Drive that are not as for a run without
    commands.
    """

    def __init__(self, scene, method, sequences=(), **drive):
        self.model, self.method = build_model(scene), method
        self.start = initial_state(scene, self.model)
        self.drive = undisturbed_drive(scene)._replace(**drive)
        self.bodies, self.rigid = counts(self.model)
        self.size = moving_size(self.drive.works, self.bodies, self.rigid)
        self.memory = new_memory(len(self.start), len(scene.springs))
        if method in RULES:
            self._take, schedule = RULES[method]
            self.plan = schedule(*sequences)

    def rates(self, t, y):
        """Return dy/dt; y: (size,) or longer."""
        out = np.zeros_like(y)
        rates(self.model, self.drive, t, y, out)
        return out

    def step(self, t, h, y):
        """Return the state after a step, before its quaternions are normalised, and the error."""
        y_new, error = y.copy(), np.zeros_like(y)
        rate = () if self.method == 'stiff' else (self.rates(t, y),)
        alone = ALONE if self.method == 'radau' else ()
        self._take(self.model, self.drive, self.plan, self.size, t, h, y, *rate, *alone,
                   self.memory, y_new, error)
        return y_new, error

    def run(self, duration, steps, y=None):
        """Return (steps, size) states after each of some equal steps from y, or from the start."""
        y, h, found = (self.start if y is None else y).copy(), duration / steps, []
        fixed = METHODS.get(self.method)
        for n in range(steps):
            if fixed and fixed.advance:
                fixed.advance.py_func(self.model, self.drive, round(n * h * 1e9), round(h * 1e9),
                                      1, y, self.memory)
            else:
                y, _ = self.step(n * h, h, y)
                normalise(self.bodies, self.rigid, y)
            found.append(y.copy())
        return np.array(found)

    def dense(self, t, h, y, fractions, substeps=FINER):
        """Return the states at fractions of a step, from the dense output; substeps: of that."""
        y_new, _ = self.step(t, h, y)
        normalise(self.bodies, self.rigid, y_new)
        coefficients = np.zeros(DENSE_SIZE * len(y))
        given = (self.model, self.drive)
        if self.method == 'stiff':
            dense_stiff(*given, stiff_table(), self.size, t, h, y, y_new, self.memory,
                        coefficients)
        elif self.method == 'radau':
            dense_radau(self.model, radau_table(), self.size, y, self.memory, coefficients)
        else:
            build, table = {'dop853': (dense_dop853, self.plan)}.get(
                self.method, (dense_explicit, explicit_table(substeps)))
            build(*given, table, self.size, t, h, y, self.rates(t, y), y_new,
                  self.rates(t + h, y_new), self.memory, coefficients)
        out = np.tile(y, (len(fractions), 1))
        for row, fraction in zip(out, fractions):
            write_state(self.size, coefficients, 2 * fraction - 1, row)
            make_unit(self.bodies, self.rigid, row)
        return out


def errors(scene, y, motion):
    """Return the errors of position, velocity, orientation and angular velocity of a state."""
    layout, found = Layout(scene), np.zeros(4)
    for body, (r, v, matrix, omega) in motion.items():
        parts = [np.linalg.norm(y[layout.position(body)] - r),
                 np.linalg.norm(y[layout.velocity(body)] - v), 0.0, 0.0]
        if matrix is not None:
            parts[2] = rotation_distance(y[layout.orientation(body)],
                                         Rotation.from_matrix(matrix))
            parts[3] = np.linalg.norm(y[layout.angular_velocity(body)] - omega)
        found = np.maximum(found, parts)
    return found


@contextmanager
def nothing_compiled():
    """Let Simulator and Propagator run as plain Python: for short runs that takes less time."""
    # as compiled code does: infinite and no number are what they are
    with pytest.MonkeyPatch.context() as patch, np.errstate(all='ignore'):
        for module in (adaptive_steps, fixed_steps, simulator):
            patch.setattr(module, 'entry', lambda kernel, *_: kernel.py_func)
        for name in 'energies', 'wrenches':
            patch.setattr(snapshot, name, getattr(snapshot, name).py_func)
        yield
