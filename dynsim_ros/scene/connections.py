# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What holds the bodies: anchors (points that are moved, not pushed) and spring-dampers."""

from dataclasses import dataclass

from .errors import SceneError, shown
from .names import check_name
from .quantity import check_quantities, quantity


@dataclass(frozen=True, kw_only=True)
class Anchor:
    """
    A massless point whose motion is given, not computed.

    position: (3,) in world [m]; velocity: (3,) in world [m/s], with which it goes on from there.
    """

    name: str
    position: tuple = quantity('m', 'position in world, until commanded', kind='vector',
                               minimum=-1e6, maximum=1e6)
    velocity: tuple = quantity('m/s', 'constant velocity in world', kind='vector', minimum=-1e6,
                               maximum=1e6, default=(0.0, 0.0, 0.0))

    def __post_init__(self):
        check_name(self.name)
        check_quantities(self, f'{self.name}.')


@dataclass(frozen=True, kw_only=True)
class Spring:
    """
    A translational spring-damper between the points P (from) and Q (to).

    from_, to: name of an anchor or a body; from_offset, to_offset: (3,) body-fixed vector from
    the centre of mass to the attachment point [m], None for the body's default point (a sphere:
    radius times b_z); damping: None when the spring has no damper at all.
    """

    name: str
    from_: str
    to: str
    stiffness: float = quantity('N/m', 'stiffness k', minimum=0.0, maximum=1e12)
    natural_length: float = quantity('m', 'natural length', minimum=0.0, maximum=1e6)
    damping: float | None = quantity('N s/m', 'damping b', minimum=0.0, maximum=1e9, default=None)
    from_offset: tuple | None = quantity('m', 'attachment point P, body-fixed', kind='vector',
                                         minimum=-1e4, maximum=1e4, default=None)
    to_offset: tuple | None = quantity('m', 'attachment point Q, body-fixed', kind='vector',
                                       minimum=-1e4, maximum=1e4, default=None)

    def __post_init__(self):
        check_name(self.name)
        check_quantities(self, f'{self.name}.')
        for field, end in (('from', self.from_), ('to', self.to)):
            if not isinstance(end, str):
                raise SceneError(f'{self.name}.{field}: {shown(end)} is no name; give the name of '
                                 'an anchor or a body')
        if self.from_ == self.to:
            raise SceneError(f"{self.name}: both ends are at '{self.to}'; name two different ones")
