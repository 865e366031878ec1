# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A scene as frames for tf: one for each body and anchor, all of them placed in the world."""

from __future__ import annotations

from .cdr import Template
from .channel import Channel, FOR_VIEWERS_NS, stamp, WORLD
from .qos import Qos
from ..scene import Anchor, Rigid
from ..scene.orientation import to_ros

TRANSFORMS = 'tf2_msgs/msg/TFMessage'
TF = '/tf'
# As broadcasters of tf offer it.
_QOS = Qos(depth=100)
_UNTURNED = {'rotation': {'x': 0.0, 'y': 0.0, 'z': 0.0, 'w': 1.0}}


def frame(node, member):
    """Return the frame of a body or an anchor; node: full name of the node, as /lab/dynsim."""
    return f'{node.strip("/")}/{member}'


def transform_channel(scene, node):
    """Return the Channel '/tf' of a scene, as often as the markers; node: full name."""
    # Their names, and which of them can turn, never change.
    members = (*scene.bodies, *scene.anchors)
    pack = Template(TRANSFORMS, {'transforms': [
        {'header': {'frame_id': WORLD}, 'child_frame_id': frame(node, member.name),
         'transform': {} if isinstance(member, Rigid) else _UNTURNED}
        for member in members]}).pack

    def encode_transforms(snapshot, stamp_ns):
        values = []
        for member in members:
            values += stamp(stamp_ns)
            values += _place(snapshot, member)
        return pack(*values)

    return Channel(TF, TRANSFORMS, encode_transforms, _QOS, interval_ns=FOR_VIEWERS_NS)


def _place(snapshot, member):
    """Return where a body or an anchor is: x, y, z [m], and of what can turn x, y, z, w."""
    if isinstance(member, Anchor):
        return snapshot.anchor_position(member.name).tolist()
    place = snapshot.position(member.name).tolist()
    if isinstance(member, Rigid):
        place += to_ros(snapshot.orientation(member.name).tolist())
    return place
