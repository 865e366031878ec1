# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Use a kernel and print, as JSON, where the kernels' cache is and how it served.

With the argument `import` no kernel is used; with `nowhere` no byte can be written to any file,
as on a full disk.
"""

import json
import resource
import sys

if 'nowhere' in sys.argv:
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))
    sys.dont_write_bytecode = True

from dynsim_ros.physics import jit
from dynsim_ros.physics.energies import energies
from dynsim_ros.physics.model import build_model
from dynsim_ros.physics.state import initial_state
from dynsim_ros.scene import Particle, Scene
import numpy as np


def main():
    """Print the energy of a moving particle, and cache folder, hits and misses."""
    scene = Scene(bodies=(Particle(name='p', mass=1, velocity=(2, 0, 0)),))
    model = build_model(scene)
    found = {'package': jit.__file__, 'cache': str(jit._DIRECTORY)}
    if 'import' not in sys.argv:
        found['energy'] = energies(model, np.empty((0, 6)), 0.0, initial_state(scene, model))[0]
        found['hits'] = sum(energies.stats.cache_hits.values())
        found['misses'] = sum(energies.stats.cache_misses.values())
    print(json.dumps(found))


if __name__ == '__main__':
    main()
