# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded run in memory: what its bag tells of bodies, energies, scene and commands."""

from __future__ import annotations

from functools import cached_property
import json

import numpy as np

from .load_bag import LoadedBag
from .load_columns import element_names, vectors
from .reader import BagError
from .run_names import PARAMETER_METADATA, SCENE_ATTACHMENT
from ..scene import did_you_mean, parse_scene, Rigid, Scene


class LoadedRun(LoadedBag):
    """
    A LoadedBag with views of a run, each a new array: one row a message.

    Units are SI, vectors are in world. What a bag has not is a BagError of one line.
    """

    def position(self, name: str) -> np.ndarray:
        """Return (n, 3) positions of a body's centre of mass, or of an anchor [m]."""
        return vectors(self[f'{name}/pose']['pose']['position'], 'xyz')

    def quaternion(self, body: str) -> np.ndarray:
        """Return (n, 4) quaternions x y z w, the order of ROS, body to world."""
        self._must_turn(body)
        return vectors(self[f'{body}/pose']['pose']['orientation'], 'xyzw')

    def velocity(self, body: str) -> np.ndarray:
        """Return (n, 3) velocities of a body's centre of mass [m/s]."""
        return vectors(self[f'{body}/twist']['twist']['linear'], 'xyz')

    def angular_velocity(self, body: str) -> np.ndarray:
        """Return (n, 3) angular velocities of a body [rad/s]."""
        self._must_turn(body)
        return vectors(self[f'{body}/twist']['twist']['angular'], 'xyz')

    def force(self, body: str, kind: str = 'net') -> np.ndarray:
        """Return (n, 3) forces on a body [N]; kind: spring, damper, air, gravity or net."""
        return vectors(self[f'{body}/wrench/{kind}']['wrench']['force'], 'xyz')

    def torque(self, body: str, kind: str = 'net') -> np.ndarray:
        """Return (n, 3) torques on a body about its centre of mass [N m]; kind: as in force."""
        self._must_turn(body)
        return vectors(self[f'{body}/wrench/{kind}']['wrench']['torque'], 'xyz')

    def energy(self, name: str = 'total') -> np.ndarray:
        """Return (n,) of an energy or work [J], such as 'kinetic', 'work_air', 'imbalance'."""
        values = self['energy']
        names = element_names(values) or []
        if name not in names:
            raise BagError(f"no energy '{name}' in {self.path}; " + did_you_mean(name, names))
        return values['data'][:, names.index(name)].astype(float)

    @cached_property
    def parameters(self) -> dict:
        """Return {name: value} of all parameters at the beginning, empty where there are none."""
        recorded = self.metadata.get(PARAMETER_METADATA, {})
        return {name: json.loads(text) for name, text in recorded.items()}

    @property
    def has_scene(self) -> bool:
        """Tell whether the bag holds its scene: others may attach what merely has the name."""
        return bool(self.info) and SCENE_ATTACHMENT in self.attachments

    @cached_property
    def scene(self) -> Scene:
        """Return the scene in which the run began; raises BagError where the bag has none."""
        if not self.has_scene:
            raise BagError(f'{self.path} holds no scene: dynsim_ros did not record it')
        return parse_scene(self.attachments[SCENE_ATTACHMENT][1].decode())

    @cached_property
    def commands(self) -> list[tuple]:
        """Return [(time [ns], command)] as they took effect: see simulation.commands."""
        # Imported here: it takes what simulates, which takes a second to import.
        from .load_commands import command_makers, grouped

        makers = {}
        for name, maker in command_makers(self.scene).items():
            topic = f'{self.info.get("node", "")}/{name}'
            if topic in self.channels and self.channels[topic].count:
                makers[topic] = maker
        return grouped((time_ns, makers[topic](message))
                       for topic, time_ns, message in self._decoded(makers))

    def _must_turn(self, name: str):
        """Raise BagError for what the scene knows to have no orientation."""
        if not self.has_scene:
            return
        member = self.scene.ends.get(name)
        if member is not None and not isinstance(member, Rigid):
            kind = 'an anchor' if member in self.scene.anchors else 'a particle'
            raise BagError(f"'{name}' is {kind}: it has no orientation, nor does it turn")
