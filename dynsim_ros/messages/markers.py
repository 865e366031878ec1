# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A scene as markers for RViz and Foxglove: bodies with their axes, anchors, springs as coils."""

from __future__ import annotations

import math

import numpy as np

from .cdr import Template
from .channel import Channel, FOR_VIEWERS_NS, stamp, WORLD
from ..physics.rotation import rotate
from ..scene import Box, Rigid, Sphere
from ..scene.orientation import to_ros

MARKERS = 'visualization_msgs/msg/MarkerArray'
# visualization_msgs/Marker: kinds of marker.
_CUBE, _SPHERE, _LINE_STRIP, _LINE_LIST = 1, 2, 4, 5
_BODY, _ANCHOR, _SPRING = (0.25, 0.5, 0.9, 0.8), (0.9, 0.3, 0.2, 1.0), (0.6, 0.6, 0.6, 1.0)
_AXES = ((0.9, 0.1, 0.1, 1.0), (0.1, 0.7, 0.1, 1.0), (0.1, 0.2, 0.95, 1.0))
_IDENTITY = (0.0, 0.0, 0.0, 1.0)

# A coil: turns between straight ends. Each point of it lies so far along the spring, and so far to
# either side; as much as that takes is worked out once.
_COIL_ALONG = np.linspace(0.1, 0.9, 65).reshape(-1, 1)
_COIL_ANGLES = np.linspace(0.0, 8 * 2.0 * np.pi, 65).reshape(-1, 1)
_COIL_COS, _COIL_SIN = np.cos(_COIL_ANGLES), np.sin(_COIL_ANGLES)


class _Markers:
    """The markers of a scene as it is at some instant, and how they are filled in."""

    def __init__(self, scene):
        self.scene = scene
        scale = drawing_scale(scene)
        parts = [part for i, body in enumerate(scene.bodies) for part in _body(body, i, scale)]
        parts += [_anchor(i, scale) for i in range(len(scene.anchors))]
        parts += [_spring(scene, spring, i, scale) for i, spring in enumerate(scene.springs)]
        self._numbers = [numbers for _, numbers in parts]
        first = len(parts) - len(scene.springs)
        self._pack = Template(MARKERS, {'markers': [marker for marker, _ in parts]}, blocks={
            f'markers.{i}.points' for i in range(first, len(parts))}).pack

    def encode(self, snapshot, stamp_ns):
        """Return the message for a snapshot of the scene."""
        values = []
        for numbers in self._numbers:
            values += stamp(stamp_ns)
            values += numbers(snapshot)
        return self._pack(*values)


def marker_channel(scene):
    """Return the Channel 'markers' of a scene, at most 25 times a second."""
    markers = _Markers(scene)

    def encode_markers(snapshot, stamp_ns):
        nonlocal markers
        if snapshot.scene is not markers.scene:
            # A radius or an attachment point may have changed.
            markers = _Markers(snapshot.scene)
        return markers.encode(snapshot, stamp_ns)

    return Channel('markers', MARKERS, encode_markers, interval_ns=FOR_VIEWERS_NS)


def drawing_scale(scene):
    """Return a length to draw by what has no size of its own [m]."""
    sizes = [min(_size(body, 0.1)) for body in scene.bodies if isinstance(body, (Sphere, Box))]
    lengths = [0.2 * spring.natural_length for spring in scene.springs if spring.natural_length]
    return min([*sizes, *lengths], default=0.1)


def _size(body, scale):
    if isinstance(body, Sphere):
        return (2.0 * body.radius,) * 3
    if isinstance(body, Box):
        return body.size
    return (scale,) * 3


def _marker(namespace, number, kind, scale, color, **more):
    """Return a visualization_msgs/Marker with every number fixed but stamp, pose and points."""
    return {
        'header': {'frame_id': WORLD}, 'ns': namespace, 'id': number, 'type': kind, 'action': 0,
        'scale': _xyz(scale), 'color': _rgba(color), 'lifetime': {'sec': 0, 'nanosec': 0},
        'frame_locked': False, 'points': [], 'colors': [],
        'texture': {'header': {'stamp': {'sec': 0, 'nanosec': 0}}, 'data': []},
        'uv_coordinates': [], 'mesh_file': {'data': []}, 'mesh_use_embedded_materials': False,
        **more}


def _xyz(a):
    return {'x': float(a[0]), 'y': float(a[1]), 'z': float(a[2])}


def _xyzw(q):
    return dict(zip('xyzw', map(float, q)))


def _rgba(color):
    return dict(zip('rgba', color))


# Each of the following gives a marker and what fills in its leaves from a snapshot.

def _body(body, number, scale):
    size = _size(body, scale)
    kind = _CUBE if isinstance(body, Box) else _SPHERE
    if not isinstance(body, Rigid):
        fixed = {'orientation': _xyzw(_IDENTITY)}
        yield (_marker('bodies', number, kind, size, _BODY, pose=fixed),
               lambda snapshot: snapshot.position(body.name).tolist())
        return

    def pose(snapshot):
        return (*snapshot.position(body.name).tolist(),
                *to_ros(snapshot.orientation(body.name).tolist()))

    yield _marker('bodies', number, kind, size, _BODY), pose
    # The axes reach through the surface, so that the spin shows.
    ends = [_xyz([0.65 * size[axis] * end * (i == axis) for i in range(3)])
            for axis in range(3) for end in (0.0, 1.0)]
    colors = [_rgba(_AXES[axis]) for axis in range(3) for _ in range(2)]
    yield _marker('axes', number, _LINE_LIST, (0.06 * max(size), 0.0, 0.0), _SPRING, points=ends,
                  colors=colors), pose


def _anchor(number, scale):
    marker = _marker('anchors', number, _CUBE, (0.4 * scale,) * 3, _ANCHOR,
                     pose={'orientation': _xyzw(_IDENTITY)})
    return marker, lambda snapshot: snapshot.anchors[number, :3].tolist()


def _spring(scene, spring, number, scale):
    radius = 0.15 * scale
    marker = _marker('springs', number, _LINE_STRIP, (0.04 * scale, 0.0, 0.0), _SPRING,
                     pose={'position': _xyz((0, 0, 0)), 'orientation': _xyzw(_IDENTITY)},
                     points=[{}] * (len(_COIL_ALONG) + 2))

    def points(snapshot):
        points = coil(_end(scene, spring.from_, spring.from_offset, snapshot),
                      _end(scene, spring.to, spring.to_offset, snapshot), radius)
        return (points.astype('<f8', copy=False).tobytes(),)

    return marker, points


def _end(scene, name, offset, snapshot):
    """Return where an end of a spring is: (3,) in world [m]."""
    if name in snapshot.layout.anchors:
        return snapshot.anchor_position(name)
    position = snapshot.position(name)
    member = scene.ends[name]
    if not isinstance(member, Rigid):
        return position
    offset = member.default_offset if offset is None else offset
    return position + rotate.py_func(snapshot.orientation(name).tolist(), offset)


def coil(p, q, radius):
    """Return (n, 3) points of a helix with straight ends from p to q, both (3,) in world [m]."""
    points = np.empty((len(_COIL_ALONG) + 2, 3))
    along = q - p
    points[0], points[-1] = p, q
    first, second = _across(along.tolist(), radius)
    points[1:-1] = p + _COIL_ALONG * along + _COIL_COS * first + _COIL_SIN * second
    return points


def _across(along, length):
    """Return two vectors of a length, (2, 3), at right angles to (3,) and to each other."""
    size = math.hypot(*along)
    # A spring of no length has no direction either: any will do.
    u = [a / size for a in along] if size > 1e-9 else [0.0, 0.0, 1.0]
    least = min(range(3), key=lambda i: abs(u[i]))
    first = [(i == least) - u[least] * u[i] for i in range(3)]
    size = math.hypot(*first)
    x, y, z = (a * length / size for a in first)
    return np.array([(x, y, z), (u[1] * z - u[2] * y, u[2] * x - u[0] * z, u[0] * y - u[1] * x)])
