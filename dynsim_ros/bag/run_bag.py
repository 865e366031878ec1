# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The bag of a run: its states, its commands, and in which scene and settings it began."""

from __future__ import annotations

from dataclasses import asdict
from datetime import datetime, timezone
import json
from pathlib import Path

from .bag_files import BagFiles, NO_LIMITS
from .recorder import Recorder
from .. import __version__
from ..messages.commands import command_messages, command_topics
from ..messages.epoch import EPOCH
from ..messages.qos import COMMAND
from ..scene import get_values, scene_to_yaml

SCENE_ATTACHMENT = 'scene.yaml'
RUN_METADATA = 'dynsim_ros'
PARAMETER_METADATA = 'parameters'


class RunBag:
    """
    Records one epoch of a run.

    channels: what is recorded besides the epoch and commands; node: full name of the node;
    resolve(topic): returns the full name of a topic, None to put relative ones below the node;
    parameters: {name: value} beside those of scene and settings, always up to date; rows:
    TickRows of the channels that have a row; limits: beyond them another file begins, a whole bag
    itself; sync_period: see Recorder. Raises OSError or ValueError if the file cannot be made; it
    is never overwritten.
    """

    def __init__(self, path, simulator, channels, rows, *, node='/dynsim', resolve=None,
                 compression='zstd', parameters=None, wait=False, limits=NO_LIMITS,
                 sync_period=0.0):
        """Create the file and write down how the run stands."""
        path = Path(path).expanduser()
        self._simulator, self._node = simulator, node
        resolve = resolve or (lambda topic: topic if topic[0] == '/' else f'{node}/{topic}')
        self._topics = [(topic, resolve(topic), *what)
                        for topic, *what in _topics(simulator.scene, channels)]
        self._parameters = {} if parameters is None else parameters
        self._files = BagFiles(path.parent, compression, f'dynsim_ros {__version__}', limits,
                               self._describe)
        try:
            writer = self._files.begin(path, simulator, self._parameters)
        except BaseException:
            self._files.close()
            raise
        # Latched: who reads the bag is told it first, as who subscribes is.
        self._latched = _latched(simulator)
        self.recorder = Recorder(writer, wait=wait, sync_period=sync_period)
        self.recorder.declare_rows(rows, [self._ids[channel.topic] for channel in rows.channels])

    @property
    def path(self):
        """Return the path of the bag, of its last file so far if it has several."""
        return self.recorder.path

    @property
    def content(self):
        """Return in one clause how many messages are in which files."""
        first, *others = self.recorder.paths
        return f'{self.recorder.messages} messages in {first}' + (
            f' to {others[-1].name}' if others else '')

    def put_rows(self, rows, stamp_ns, wanted):
        """Record the wanted rows of the instant that TickRows were filled in with last."""
        if self._files.is_next_due(stamp_ns, self.recorder):
            self._files.go_on(stamp_ns, self.recorder, self._simulator.copy(),
                              dict(self._parameters))
            self._latched = _latched(self._simulator)
        if self._latched:
            self._put(stamp_ns, [])
        self.recorder.put_rows(rows, stamp_ns, wanted)

    def put(self, stamp_ns, messages):
        """Record {topic: CDR bytes} at a time [ns]."""
        self._put(stamp_ns, messages.items())

    def put_command(self, stamp_ns, command):
        """Record a command that took effect at a time [ns]."""
        self._put(stamp_ns, command_messages(command, stamp_ns), keep=True)

    def _put(self, stamp_ns, messages, keep=False):
        ids = self._ids
        if self._latched:
            messages = [*self._latched.items(), *messages]
            self._latched = None
        self.recorder.put(
            stamp_ns, [(ids[topic], _as_sent(data)) for topic, data in messages], keep)

    def close(self):
        """Finish the file; harmless when repeated."""
        self.recorder.close()
        self._files.close()

    def _describe(self, writer, simulator, parameters):
        """Write down how the run stands, and what can be in the file."""
        _describe(writer, simulator, self._node, parameters)
        self._ids = {topic: writer.add_channel(*what) for topic, *what in self._topics}


def _latched(simulator):
    """Return {topic: CDR bytes} of what stands first in a file."""
    return {EPOCH.topic: EPOCH.encode(simulator.snapshot(), None)}


def _as_sent(data):
    """Return CDR bytes as subscribers get them: DDS pads them to a multiple of four."""
    return data + bytes(-len(data) % 4)


def _topics(scene, channels):
    """Return [(topic, type name, quality of service)] of all that a bag can hold."""
    topics = [(channel.topic, channel.type_name, channel.qos) for channel in (EPOCH, *channels)]
    return topics + [(topic, name, COMMAND) for topic, name in command_topics(scene).items()]


def _describe(writer, simulator, node, parameters):
    """Write down the scene, the parameters and how the run stands."""
    writer.add_attachment(SCENE_ATTACHMENT, scene_to_yaml(simulator.scene).encode(),
                          'application/yaml')
    writer.add_metadata(RUN_METADATA, _run_metadata(simulator, node))
    values = {**get_values(simulator.scene), **asdict(simulator.settings), **parameters}
    writer.add_metadata(PARAMETER_METADATA,
                        {name: json.dumps(value) for name, value in values.items()})


def _run_metadata(simulator, node):
    return {'version': __version__, 'scene': simulator.scene.name, 'node': node,
            'epoch': str(simulator.epoch), 'start_tick': str(simulator.tick),
            'start_time_ns': str(simulator.time_ns),
            'recorded_at': datetime.now(timezone.utc).isoformat(timespec='seconds')}
