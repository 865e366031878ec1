# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A run taken out of its bag: how it began, what was commanded when, and what came of it."""

from __future__ import annotations

from collections.abc import Iterator
import json

from .reader import Bag, BagError
from .run_bag import full_name
from .run_names import CHECKPOINT_ATTACHMENT, PARAMETER_METADATA, RUN_METADATA, SCENE_ATTACHMENT
from .run_names import TOPIC_METADATA
from ..messages.commands import command_of, command_topics, group_size, GROUP_TOPIC
from ..messages.commands import PARAMETER_TOPIC
from ..messages.scene_channels import scene_channels
from ..messages.state_hash import decode_state_hash, STATE_HASH
from ..scene import scene_quantities, SceneError
from ..scene.yaml_file import parse_scene
from ..simulation import Settings, SetValues, Simulator
from ..simulation.checkpoint import CheckpointError, restored
from ..simulation.settings import SECOND, SETTING_NAMES


class RecordedRun:
    """
    A run in a bag, which is left open.

    bag: Bag; simulator: Simulator as it was when the bag was begun; node: full name of the node;
    origin_ns: added to simulated time in stamps; begin_ns, end_ns: simulated time; channels:
    Channels of the scene, recorded or not. Raises BagError for a bag that holds no run.
    """

    def __init__(self, bag: Bag):
        """Take out how the run began."""
        self.bag = bag
        about = bag.metadata.get(RUN_METADATA)
        if about is None or SCENE_ATTACHMENT not in bag.attachments:
            raise BagError(f'{bag.path} holds no run: it was not recorded by sim_node, simulate '
                           'or rerun')
        try:
            self.simulator = self._first(about)
        except (CheckpointError, SceneError) as error:
            raise BagError(f'{bag.path}: {error}') from None
        except (KeyError, ValueError, TypeError) as error:
            raise BagError(f'{bag.path}: what it says about its run is damaged: '
                           f'{type(error).__name__}: {error}') from None
        self.node: str = about.get('node', '/dynsim')
        self._scene = scene = self.simulator.scene
        self.channels = scene_channels(scene, self.simulator.layout, self.node)
        self._commands = {*command_topics(scene), GROUP_TOPIC}
        names = bag.metadata.get(TOPIC_METADATA, {})
        self._relative = {
            names.get(topic, full_name(topic, self.node)): topic
            for topic in (*self._commands, *(channel.topic for channel in self.channels))}
        self._quantities = {*scene_quantities(scene), *SETTING_NAMES}
        self.begin_ns = self.simulator.time_ns
        self.origin_ns = self._origin()
        self.end_ns = max(bag.end_ns - self.origin_ns, self.begin_ns)

    @property
    def path(self):
        """Return the path of the bag."""
        return self.bag.path

    @property
    def parameters(self) -> dict:
        """Return {name: value} of all parameters when the bag was begun."""
        return {name: json.loads(value) for name, value
                in self.bag.metadata.get(PARAMETER_METADATA, {}).items()}

    def _first(self, about):
        """Return the Simulator as it was when the bag was begun; about: metadata of the run."""
        scene = parse_scene(self.bag.attachments[SCENE_ATTACHMENT][1].decode())
        if CHECKPOINT_ATTACHMENT in self.bag.attachments:
            simulator = restored(self.bag.attachments[CHECKPOINT_ATTACHMENT][1])
            if simulator.scene != scene:
                raise CheckpointError('the scene of the checkpoint is not the one beside it')
        elif int(about['start_time_ns']) == 0:
            settings = {name: value for name, value in self.parameters.items()
                        if name in SETTING_NAMES}
            simulator = Simulator(scene, Settings(**settings))
        else:
            raise CheckpointError(
                f'it begins at {int(about["start_time_ns"]) / SECOND:.9g} s without a checkpoint, '
                f'which version {about.get("version")} did not write')
        simulator.epoch = int(about['epoch'])
        return simulator

    def _origin(self):
        """Return what the stamps begin with: simulated time is in the messages of hashes."""
        topics = [full for full, topic in self._relative.items()
                  if topic == STATE_HASH.topic and full in self.bag.channels]
        if not topics:
            return self.bag.start_ns - self.begin_ns
        for _, stamp_ns, data in self.bag.messages(topics):
            try:
                return stamp_ns - decode_state_hash(data).time_ns
            except ValueError:
                break
        return self.bag.start_ns - self.begin_ns

    def commands(self, begin_ns=None, end_ns=None) -> list:
        """Return [(simulated time [ns], command)], without those before begin_ns, after end_ns."""
        return [(time_ns, command)
                for time_ns, command, _ in self._events(self._commands, begin_ns, end_ns)
                if command is not None]

    def events(self, end_ns=None) -> Iterator[tuple]:
        """
        Yield (simulated time [ns], command, None) or (…, None, messages) in order.

        messages: [(topic relative to the node, CDR bytes)] that were recorded at one instant
        between two commands. Raises BagError for a command that cannot be read.
        """
        return self._events({*self._relative.values()}, None, end_ns)

    def _events(self, topics, begin_ns, end_ns):
        wanted = [full for full, topic in self._relative.items() if topic in topics]
        first, last = (time_ns if time_ns is None else time_ns + self.origin_ns
                       for time_ns in (begin_ns, end_ns))
        messages = ((self._relative[full], stamp_ns, data) for full, stamp_ns, data
                    in self.bag.messages(wanted, first, last))
        at_once, now = [], None
        for topic, stamp_ns, parts in _with_groups(messages, self._knows_groups()):
            is_command = topic in self._commands
            if at_once and (is_command or stamp_ns != now):
                yield now - self.origin_ns, None, at_once
                at_once = []
            now = stamp_ns
            if is_command:
                yield now - self.origin_ns, self._command(topic, now, parts), None
            else:
                at_once.append((topic, parts[0]))
        if at_once:
            yield now - self.origin_ns, None, at_once

    def _knows_groups(self):
        """Tell whether the bag says which parameters were set as a group."""
        return any(self._relative.get(full) == GROUP_TOPIC for full in self.bag.channels)

    def _command(self, topic, stamp_ns, parts):
        """Return the command that some messages are, None for one that is not the simulator's."""
        try:
            command = command_of(topic, parts, self._scene)
        except ValueError as error:
            raise BagError(f'{self.path}: a command of {(stamp_ns - self.origin_ns) / SECOND:.9g} '
                           f's cannot be read: {error}') from None
        if not isinstance(command, SetValues):
            return command
        # The node's own parameters change nothing of the motion.
        values = {name: value for name, value in command.values.items()
                  if name in self._quantities}
        return SetValues(values) if values else None


def _with_groups(messages, knows_groups):
    """
    Yield (topic, stamp [ns], [CDR bytes]): several for parameters that were set as a group.

    messages: (topic, stamp, CDR bytes). Without knowledge of groups, parameters of one instant
    that follow each other are one; of a group that breaks off, with its bag, nothing comes.
    """
    group, left, since = [], 0, None
    for topic, stamp_ns, data in messages:
        if topic == GROUP_TOPIC:
            left = group_size(data)
            continue
        is_parameter = topic == PARAMETER_TOPIC
        if group and not left and not (is_parameter and stamp_ns == since):
            yield PARAMETER_TOPIC, since, group
            group = []
        if not is_parameter or not (left or not knows_groups):
            yield topic, stamp_ns, [data]
            continue
        group.append(data)
        since = stamp_ns
        if left == 1:
            yield topic, stamp_ns, group
            group = []
        left = max(left - 1, 0)
    if group and not knows_groups:
        yield PARAMETER_TOPIC, since, group
