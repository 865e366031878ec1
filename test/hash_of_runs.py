# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Print, as JSON, {scene: every bit of a short commanded run of it, hashed}."""

import hashlib
import json

from dynsim_ros.scene import load_scene, scene_names
from dynsim_ros.simulation import MoveAnchor, PushBody, Simulator
import numpy as np


def bits_of(scene):
    """Return a digest of states, wrenches and energies of a run."""
    simulator = Simulator(scene, rate=333, wrench_timeout=0.05)
    digest = hashlib.sha256()
    for command in (PushBody(scene.bodies[0].name, (1, 2, 3)),
                    *(MoveAnchor(anchor.name, (0.1, 0.2, 2)) for anchor in scene.anchors)):
        simulator.apply(command)
        for snapshot in simulator.run(0.1).snapshots:
            digest.update(snapshot.state.tobytes() + snapshot.forces.tobytes())
            energy = snapshot.energy
            digest.update(np.array([energy.kinetic, energy.gravitational, energy.spring,
                                    energy.imbalance, *energy.work.values()]).tobytes())
    return digest.hexdigest()


def main():
    """Print the digests of all scenes of the package."""
    print(json.dumps({name: bits_of(load_scene(name)) for name in scene_names()}))


if __name__ == '__main__':
    main()
