# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Rehearse a change; print, as JSON, what kernels this process got from the disk by that."""

import json

from dynsim_ros.integrators import METHODS
from dynsim_ros.physics.energies import energies
from dynsim_ros.scene import Particle, Scene
from dynsim_ros.simulation import Simulator
from dynsim_ros.simulation.rehearsal import Rehearsal
from dynsim_ros.simulation.rows.kernel import fill_rows

METHOD = 'explicit_euler'
KERNELS = {METHOD: METHODS[METHOD].advance, 'energies': energies, 'fill_rows': fill_rows}

scene = Scene(name='fall', bodies=[Particle(name='p', mass=1.0)], gravity=9.81)
simulator = Simulator(scene, integrator=METHOD)
simulator.prepare()
assert not any(sum(kernel.stats.cache_hits.values()) for kernel in KERNELS.values())
rehearsal = Rehearsal(simulator, {'gravity': 0.0})
assert rehearsal.is_over(120.0) and rehearsal.error is None, rehearsal.error
print(json.dumps({name: sum(kernel.stats.cache_hits.values())
                  for name, kernel in KERNELS.items()}))
