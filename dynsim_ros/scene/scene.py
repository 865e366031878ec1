# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A scene: what is simulated, as data."""

from dataclasses import dataclass
from functools import cached_property

from .air import Air
from .bodies import Particle, Rigid
from .errors import did_you_mean, SceneError, shown
from .quantity import check_quantities, quantity


@dataclass(frozen=True, kw_only=True)
class Scene:
    """
    Bodies, anchors and springs in a gravity field and in air; any number of each.

    bodies, anchors, springs: sequences, kept as tuples; no two members have the same name;
    gravity: None for no gravity; down: (3,) unit vector in world; air: None for no air.
    Raises SceneError if a name or a reference is wrong.
    """

    name: str = 'scene'
    bodies: tuple
    anchors: tuple = ()
    springs: tuple = ()
    gravity: float | None = quantity('m/s^2', 'acceleration of gravity', minimum=0.0,
                                     maximum=1e6, default=None)
    down: tuple = quantity('', 'direction of gravity in world', kind='direction', minimum=-1e6,
                           maximum=1e6, default=(0.0, 0.0, -1.0))
    air: Air | None = None
    description: str = ''

    def __post_init__(self):
        check_quantities(self, '')
        if not self.name or len(self.name) > 100 or not self.name.isprintable():
            raise SceneError(f'name: {shown(self.name)} is no name of a scene; give 1 to 100 '
                             'characters that can be printed')
        if any('\ud800' <= letter <= '\udfff' for letter in self.description):
            raise SceneError('description: has half a character (a surrogate); leave it out')
        for section in ('bodies', 'anchors', 'springs'):
            object.__setattr__(self, section, tuple(getattr(self, section)))
        if not self.bodies:
            raise SceneError('bodies: there are none; give at least one')
        names = [member.name for member in self.members]
        for name in names:
            if names.count(name) > 1:
                raise SceneError(f"name '{name}' is used more than once; bodies, anchors and "
                                 'springs need a name of their own each')
        for spring in self.springs:
            self._check_spring(spring)

    def _check_spring(self, spring):
        for field, end in (('from', spring.from_), ('to', spring.to)):
            if end not in self.ends:
                raise SceneError(f"{spring.name}.{field}: '{end}' is no anchor and no body; "
                                 + did_you_mean(end, self.ends))
            offset = getattr(spring, f'{field}_offset')
            if offset is not None and not isinstance(self.ends[end], Rigid):
                raise SceneError(f"{spring.name}.{field}_offset: '{end}' is a point and has no "
                                 f'attachment points; leave {field}_offset out')
        if not any(isinstance(self.ends[end], Particle) for end in (spring.from_, spring.to)):
            raise SceneError(f'{spring.name}: both ends are anchors; one end must be a body')

    @property
    def members(self):
        """Return bodies, anchors and springs, in the order of the scene."""
        return (*self.bodies, *self.anchors, *self.springs)

    @cached_property
    def ends(self):
        """Return {name: anchor or body}: what a spring can be attached to."""
        return {member.name: member for member in (*self.anchors, *self.bodies)}
