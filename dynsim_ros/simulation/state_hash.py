# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
A hash of all that a run depends on at an instant: equal where every bit is equal.

SHA-256 of, one behind the other: the text 'dynsim_ros state 1' and a line feed; tick and time
[ns] as int64; state, anchors, pushes and reference energy (see Snapshot) as float64, all with the
little end first; what is under way as JSON; SHA-256 of scene and settings as JSON.
"""

from dataclasses import asdict
import hashlib
import json
import struct

from ..scene import get_values

_HEAD = b'dynsim_ros state 1\n'


def state_hash(snapshot):
    """Return the hash of a Snapshot: 64 hexadecimal digits."""
    digest = hashlib.sha256(_HEAD)
    digest.update(struct.pack('<qq', snapshot.tick, snapshot.time_ns))
    for array in (snapshot.state, snapshot.anchors, snapshot.pushes):
        digest.update(array.astype('<f8', copy=False).tobytes())
    digest.update(struct.pack('<d', snapshot.reference_energy))
    push_ends, anchors = snapshot.under_way
    digest.update(json.dumps([sorted(push_ends.items()), anchors]).encode())
    digest.update(_of_scene(snapshot.scene, snapshot.settings))
    return digest.hexdigest()


class _Kept:
    """The digest that was worked out last, and for what."""

    made_for, digest = (None, None), b''


def _of_scene(scene, settings):
    # By identity: what is equal need not have the same bits, and both are replaced, never changed.
    before, digest = _Kept.made_for, _Kept.digest
    if before[0] is not scene or before[1] is not settings:
        values = {'scene': get_values(scene), 'settings': asdict(settings)}
        digest = hashlib.sha256(json.dumps(values, sort_keys=True).encode()).digest()
        _Kept.made_for, _Kept.digest = (scene, settings), digest
    return digest
