# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The bag of a run: its states, its commands, and all that is needed to live it again."""

from __future__ import annotations

from dataclasses import asdict
from datetime import datetime, timezone
import json
from pathlib import Path
from typing import NamedTuple

from .bag_files import BagFiles, NO_LIMITS
from .recorder import Recorder
from .run_names import CHECKPOINT_ATTACHMENT, PARAMETER_METADATA, RUN_METADATA, SCENE_ATTACHMENT
from .run_names import TOPIC_METADATA
from .. import __version__
from ..messages.commands import command_messages, recorded_command_topics
from ..messages.epoch import EPOCH
from ..messages.qos import COMMAND
from ..messages.state_hash import STATE_HASH
from ..scene import get_values, Scene, scene_to_yaml
from ..simulation.checkpoint import checkpoint


class RunBag:
    """
    Records one epoch of a run.

    channels: what is recorded besides the epoch and commands; node: full name of the node;
    resolve(topic): returns the full name of a topic, None to put relative ones below the node;
    parameters: {name: value} beside those of scene and settings, always up to date; rows:
    TickRows of the channels that have a row; limits: beyond them another file begins, a whole bag
    itself; sync_period: see Recorder; parent: {name: text} about the run that this one is a branch
    of. Raises OSError or ValueError if the file cannot be made; it is never overwritten.
    """

    def __init__(self, path, simulator, channels, rows, *, node='/dynsim', resolve=None,
                 compression='zstd', parameters=None, wait=False, limits=NO_LIMITS,
                 sync_period=0.0, parent=None):
        """Create the file and write down how the run stands."""
        path = Path(path).expanduser()
        self._simulator, self._node, self._parent = simulator, node, parent or {}
        resolve = resolve or (lambda topic: full_name(topic, node))
        self._topics = [(topic, resolve(topic), *what)
                        for topic, *what in _topics(simulator.scene, channels)]
        self._parameters = {} if parameters is None else parameters
        self._files = BagFiles(path.parent, compression, f'dynsim_ros {__version__}', limits,
                               self._describe)
        try:
            writer = self._files.begin(path, _Start.of(simulator, self._parameters))
        except BaseException:
            self._files.close()
            raise
        # Latched: who reads the bag is told it first, as who subscribes is.
        self._latched, self._last_hash = _latched(simulator), None
        self.recorder = Recorder(writer, wait=wait, sync_period=sync_period)
        self.recorder.declare_rows(rows, [self._ids[channel.topic] for channel in rows.channels])

    @property
    def path(self):
        """Return the path of the bag, of its last file so far if it has several."""
        return self.recorder.path

    @property
    def paths(self):
        """Return the paths of the bag's files, a list that the next one is added to."""
        return self.recorder.paths

    @property
    def content(self):
        """Return in one clause how many messages are in which files."""
        first, *others = self.recorder.paths
        return f'{self.recorder.messages} messages in {first}' + (
            f' to {others[-1].name}' if others else '')

    def put_rows(self, rows, stamp_ns, wanted):
        """Record the wanted rows of the instant that TickRows were filled in with last."""
        if self._files.is_next_due(stamp_ns, self.recorder):
            self._files.go_on(stamp_ns, self.recorder,
                              _Start.of(self._simulator, self._parameters))
            self._latched = _latched(self._simulator)
        if self._latched:
            self._put(stamp_ns, [])
        self.recorder.put_rows(rows, stamp_ns, wanted)

    @property
    def can_put_many(self):
        """Tell whether rows may be put many at a time: not where a next file may begin."""
        return not self._files.limits.are_set

    def put_many_rows(self, rows, stamps, wanted):
        """Record likewise the first instants filled in last; stamps: (instants,) int64 [ns]."""
        if self._latched:
            self._put(int(stamps[0]), [])
        self.recorder.put_many_rows(rows, stamps, wanted)

    def put(self, stamp_ns, messages):
        """Record {topic: CDR bytes} at a time [ns]."""
        self._put(stamp_ns, messages.items())

    def put_command(self, stamp_ns, command):
        """Record a command that took effect at a time [ns]."""
        self._put(stamp_ns, command_messages(command, stamp_ns), keep=True)

    def put_last(self, stamp_ns, simulator):
        """Record how the run stands at the end, a time [ns]: its hash."""
        self._put(stamp_ns, [(STATE_HASH.topic, STATE_HASH.encode(simulator.snapshot(), None))],
                  keep=True)

    def _put(self, stamp_ns, messages, keep=False):
        ids = self._ids
        if self._latched:
            messages, keep = [*self._latched.items(), *messages], True
            self._latched = None
        messages = [(ids[topic], as_sent(data)) for topic, data in messages
                    if topic != STATE_HASH.topic or self._is_new(data)]
        if messages:
            self.recorder.put(stamp_ns, messages, keep)

    def _is_new(self, state_hash):
        """Tell whether a hash is not the one that was recorded last."""
        before, self._last_hash = self._last_hash, state_hash
        return state_hash != before

    def close(self):
        """Finish the file; harmless when repeated."""
        self.recorder.close()
        self._files.close()

    def _describe(self, writer, start):
        """Write down how the run stands, a _Start, and what can be in the file."""
        writer.add_attachment(SCENE_ATTACHMENT, scene_to_yaml(start.scene).encode(),
                              'application/yaml')
        writer.add_attachment(CHECKPOINT_ATTACHMENT, start.checkpoint.encode(),
                              'application/json')
        writer.add_metadata(RUN_METADATA, {**start.about(self._node), **self._parent})
        writer.add_metadata(PARAMETER_METADATA,
                            {name: json.dumps(value) for name, value in start.values.items()})
        writer.add_metadata(TOPIC_METADATA, {topic: full for topic, full, *_ in self._topics})
        self._ids = {topic: writer.add_channel(*what) for topic, *what in self._topics}


class _Start(NamedTuple):
    """How a run stands where a file begins."""

    scene: Scene
    epoch: int
    tick: int
    time_ns: int
    values: dict
    checkpoint: str

    @classmethod
    def of(cls, simulator, parameters):
        """Return it for a Simulator; parameters: beside those of scene and settings."""
        scene = simulator.scene
        values = {**get_values(scene), **asdict(simulator.settings), **parameters}
        return cls(scene, simulator.epoch, simulator.tick, simulator.time_ns, values,
                   checkpoint(simulator))

    def about(self, node):
        """Return the metadata about the run; node: full name of the node."""
        return {'version': __version__, 'scene': self.scene.name, 'node': node,
                'epoch': str(self.epoch), 'start_tick': str(self.tick),
                'start_time_ns': str(self.time_ns),
                'recorded_at': datetime.now(timezone.utc).isoformat(timespec='seconds')}


def _latched(simulator):
    """Return {topic: CDR bytes} of what stands first in a file."""
    snapshot = simulator.snapshot()
    return {channel.topic: channel.encode(snapshot, None) for channel in (EPOCH, STATE_HASH)}


def full_name(topic, node):
    """Return the full name of a topic that is not remapped; node: full name of the node."""
    return topic if topic[0] == '/' else f'{node}/{topic}'


def as_sent(data):
    """Return CDR bytes as subscribers get them: DDS pads them to a multiple of four."""
    return data + bytes(-len(data) % 4)


def _topics(scene, channels):
    """Return [(topic, type name, quality of service)] of all that a bag can hold."""
    topics = [(channel.topic, channel.type_name, channel.qos) for channel in (EPOCH, *channels)]
    return topics + [(topic, name, COMMAND)
                     for topic, name in recorded_command_topics(scene).items()]
