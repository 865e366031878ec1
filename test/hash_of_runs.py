# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Print, as JSON, {scene and method: every bit of a short commanded run of it, hashed}.

Arguments: the method of a scene of which alone to do so, and the scene, else of all.
"""

import hashlib
import json
import re
import sys

from dynsim_ros.scene import load_scene, scene_names
from dynsim_ros.simulation import MoveAnchor, PushBody, Simulator
import numpy as np

# Motions in closed form, which cost little: long enough that the last bits of functions come in.
CLOSED = {('falling_in_wind', 'auto'): 8.0, ('spinning_box', 'auto'): 8.0}  # s
# The methods that choose their steps take long to compile: with a scene of every kind of body.
RUNS = [*((name, 'rk4') for name in scene_names()), *CLOSED,
        ('particle_on_spring', 'auto'), ('sphere_on_spring', 'auto')]


def bits_of(name, method):
    """Return a digest of states, wrenches and energies of a run of a scene of the package."""
    scene = load_scene(name)
    simulator = Simulator(scene, integrator=method, rate=333, wrench_timeout=0.05)
    digest = hashlib.sha256()
    for command in (PushBody(scene.bodies[0].name, (1, 2, 3)),
                    *(MoveAnchor(anchor.name, (0.1, 0.2, 2)) for anchor in scene.anchors)):
        simulator.apply(command)
        for snapshot in simulator.run(CLOSED.get((name, method), 0.1)).snapshots:
            digest.update(snapshot.state.tobytes() + snapshot.forces.tobytes())
            energy = snapshot.energy
            digest.update(np.array([energy.kinetic, energy.gravitational, energy.spring,
                                    energy.imbalance, *energy.work.values()]).tobytes())
    return digest.hexdigest()


def bits_of_all():
    """Return {scene and method: digest}."""
    return {f'{name} {method}': bits_of(name, method) for name, method in RUNS}


def called_by_kernels():
    """Return the names of the functions outside of them that the kernels used so far call."""
    kernels = {id(value): value for name, module in [*sys.modules.items()]
               if name.startswith('dynsim_ros.') for value in vars(module).values()
               if hasattr(value, 'overloads')}
    return {name for kernel in kernels.values() for compiled in kernel.overloads.values()
            for name in re.findall(r'^declare [^@]*@"?([^"(]+)', str(
                compiled.library._get_module_for_linking()), re.MULTILINE)}


def main():
    """Print the digests of all runs, or of the one that is asked for."""
    if len(sys.argv) > 1:
        method, name = sys.argv[1:]
        print(json.dumps({f'{name} {method}': bits_of(name, method)}))
    else:
        print(json.dumps(bits_of_all()))


if __name__ == '__main__':
    main()
