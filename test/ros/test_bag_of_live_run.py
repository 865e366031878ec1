# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The bag of a live run, read by others, holds what a subscriber received: byte for byte."""

import json

from dynsim_ros.cli.simulate import main as simulate
from dynsim_ros.scene import load_scene
from geometry_msgs.msg import PointStamped, WrenchStamped
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from other_readers import fields
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from ros_client import stamps, type_named
from rosbags.highlevel import AnyReader
from rosbags.typesys import get_types_from_msg, get_typestore, Stores
from scene_topics import DIAGNOSTICS, forces, positions, SPHERE
from std_msgs.msg import UInt64

TOPICS = {**SPHERE, '/diagnostics': DIAGNOSTICS}
TICK = 10_000_000


class Recorded:
    """A recorded run: path of the bag, what was heard, when commands were given."""

    def __init__(self, node, client):
        client.listen(TOPICS)
        client.more('sphere/pose')
        client.pause()
        client.drain()
        client.clear()
        self.path = node.folder / client.record(True).message
        client.pause(False)
        client.more('sphere/pose', 20)
        client.pause()
        point, wrench = PointStamped(), WrenchStamped()
        point.point.x, point.point.z = 0.4, 2.5
        wrench.wrench.force.y = 7.0
        self.commanded = self._now(client)
        client.publish('hand/command', point)
        client.publish('sphere/wrench_command', wrench)
        client.drain()
        client.steps(5, 'sphere/pose')
        self.changed = self._now(client)
        assert client.set_group({'gravity': 1.5, 'integrator': 'semi_implicit_euler'}).successful
        assert not client.configure({'gravity': -1e9})[0].successful
        client.steps(1, 'sphere/pose')
        client.pause(False)
        client.more('/diagnostics', 2)
        client.pause()
        client.drain()
        self.reply = client.record(False).message
        client.drain()
        self.heard = {client.full(topic): data for topic, data in client.heard.items()}
        self.types = {client.full(topic): kind for topic, kind in TOPICS.items()}
        self.hashes = {}
        for topic in self.types:
            (info,) = client.node.get_publishers_info_by_topic(topic)
            self.hashes[topic] = f'RIHS01_{bytes(info.topic_type_hash.value).hex()}'
        with open(self.path, 'rb') as stream:
            reader = make_reader(stream, decoder_factories=[DecoderFactory()])
            self.summary = reader.get_summary()
            self.messages = list(reader.iter_messages(log_time_order=False))
            self.decoded = list(reader.iter_decoded_messages(log_time_order=False))
            self.metadata = {item.name: item.metadata for item in reader.iter_metadata()}
            self.attachments = {item.name: item.data for item in reader.iter_attachments()}

    def of(self, topic):
        """Return (log time, bytes) of the messages of a topic, as mcap reads them."""
        return [(message.log_time, message.data) for _, channel, message in self.messages
                if channel.topic == topic]

    @staticmethod
    def _now(client):
        return stamps([client.last('sphere/pose')])[0]


@pytest.fixture(scope='module')
def run(start, connect):
    node = start()
    return Recorded(node, connect(node))


def full(topic):
    return topic if topic.startswith('/') else f'/dynsim/{topic}'


@pytest.mark.parametrize('topic', map(full, TOPICS))
def test_mcap_reads_what_was_heard(run, topic):
    heard = run.heard[topic]
    assert len(heard) >= 2
    # a subscriber that listens all the time; /diagnostics come before the recording, too
    assert [data for _, data in run.of(topic)] == heard[-len(run.of(topic)):]
    assert topic == '/diagnostics' or len(run.of(topic)) == len(heard)


@pytest.mark.parametrize('topic', map(full, TOPICS))
def test_rosbags_reads_what_was_heard(run, topic):
    with AnyReader([run.path]) as reader:
        found = [bytes(data) for connection, _, data in reader.messages()
                 if connection.topic == topic]
        kinds = {c.topic: c.msgtype for c in reader.connections}
    assert found == run.heard[topic][-len(found):] and found
    assert kinds[topic] == run.types[topic]


@pytest.mark.parametrize('topic', map(full, TOPICS))
def test_mcap_ros2_support_decodes_the_same(run, topic):
    ours = [message for _, channel, _, message in run.decoded if channel.topic == topic]
    kind = type_named(run.types[topic])
    theirs = [deserialize_message(data, kind) for data in run.heard[topic]][-len(ours):]
    for number in (0, len(ours) // 2, -1):
        other = fields(theirs[number])
        assert json.dumps(fields(ours[number]), sort_keys=True).replace('[0]', '0') == json.dumps(
            other, sort_keys=True).replace('[0]', '0')


def test_times_are_the_stamps_and_never_go_back(run):
    times = [message.log_time for _, _, message in run.messages]
    assert times == sorted(times)
    for schema, channel, message, decoded in run.decoded:
        assert message.log_time == message.publish_time
        if hasattr(decoded, 'header') and schema.name != TOPICS['markers']:
            stamp = decoded.header.stamp
            assert message.log_time == stamp.sec * 10 ** 9 + stamp.nanosec, channel.topic


def test_the_epoch_stands_first(run):
    epoch = (run.messages[0][2].log_time, bytes(serialize_message(UInt64(data=0))))
    assert run.messages[0][1].topic == '/dynsim/epoch'
    assert run.of('/dynsim/epoch') == [epoch]


def test_commands_are_there_when_they_took_effect(run):
    (moved,) = run.of('/dynsim/hand/command')
    (pushed,) = run.of('/dynsim/sphere/wrench_command')
    assert moved[0] == pushed[0] == run.commanded
    hands = dict(zip([time for time, _ in run.of('/dynsim/hand/pose')],
                     positions(decoded(run, '/dynsim/hand/pose'))[:, 0]))
    assert hands[run.commanded] == 0.0 and hands[run.commanded + TICK] == 0.4
    assert [message.wrench.force.y for message in decoded(run, '/dynsim/sphere/wrench_command')
            ] == [7.0]


def decoded(run, topic):
    """Return the messages of a topic as mcap-ros2-support decodes them."""
    return [message for _, channel, _, message in run.decoded if channel.topic == topic]


def test_parameter_changes_are_there_when_they_took_effect(run):
    topic = '/dynsim/parameter_command'
    assert [time for time, _ in run.of(topic)] == [run.changed] * 2
    changes = {message.name: message.value for message in decoded(run, topic)}
    assert changes['gravity'].double_value == 1.5
    assert changes['integrator'].string_value == 'semi_implicit_euler'
    weights = dict(zip([time for time, _ in run.of('/dynsim/sphere/wrench/gravity')],
                       forces(decoded(run, '/dynsim/sphere/wrench/gravity'))[:, 2]))
    assert weights[run.changed] == -9.81 and weights[run.changed + TICK] == -1.5


def test_the_file_is_a_finished_ros2_bag(run):
    with open(run.path, 'rb') as stream:
        header = make_reader(stream).get_header()
    assert header.profile == 'ros2' and header.library.startswith('dynsim_ros ')
    assert run.summary.statistics.message_count == len(run.messages)
    assert run.reply == f'{len(run.messages)} messages in {run.path.parent.name}/{run.path.name}'
    channels = {channel.topic: channel for channel in run.summary.channels.values()}
    assert set(channels) == {*run.types, '/tf', *map(full, (
        'epoch', 'state_hash', 'hand/command', 'sphere/wrench_command', 'parameter_command',
        'parameter_group'))}
    assert {channel.message_encoding for channel in channels.values()} == {'cdr'}
    assert 'rosbag2' not in run.metadata


@pytest.mark.parametrize('topic', map(full, TOPICS))
def test_type_hashes_and_definitions(run, topic):
    (channel,) = [c for c in run.summary.channels.values() if c.topic == topic]
    schema = run.summary.schemas[channel.schema_id]
    assert (schema.name, schema.encoding) == (run.types[topic], 'ros2msg')
    assert channel.metadata['topic_type_hash'] == run.hashes[topic]
    # rosbags works the hash out from the text: it is whole and is that of the type
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg(schema.data.decode(), schema.name))
    assert store.generate_msgdef(schema.name, ros_version=2)[0]
    assert store.hash_rihs01(schema.name) == run.hashes[topic]


def test_the_scene_and_the_parameters_are_inside(run, tmp_path):
    path = tmp_path / 'sphere_on_spring.yaml'
    path.write_bytes(run.attachments['scene.yaml'])
    assert load_scene(str(path)) == load_scene('sphere_on_spring')
    values = {name: json.loads(value) for name, value in run.metadata['parameters'].items()}
    assert values['gravity'] == 9.81 and values['sphere.position'] == [0.3, 0.0, 1.2]
    assert (values['integrator'], values['rate'], values['scene']) == (
        'auto', 100.0, 'sphere_on_spring')
    assert values['real_time_factor'] == 1.0
    assert run.metadata['dynsim_ros']['node'] == '/dynsim'
    assert run.metadata['dynsim_ros']['epoch'] == '0'
    assert run.metadata['dynsim_ros']['version'].count('.') == 2


def test_the_offline_run_writes_the_same(start, tmp_path):
    """Let both run from the start to the same instant: equal bytes on every topic of the state."""
    node = start('-p', 'record.enable:=true', '-p', 'duration:=1.0', '-p', 'sphere.mass:=1.3')
    node.wait()
    offline = tmp_path / 'offline.mcap'
    assert simulate(['sphere_on_spring', '-d', '1', '-o', str(offline), '-q', '--set',
                     'sphere.mass=1.3']) == 0

    def content(path):
        with open(path, 'rb') as stream:
            return {(channel.topic, message.log_time): message.data
                    for _, channel, message in make_reader(stream).iter_messages()
                    if channel.topic != '/diagnostics'}

    assert content(node.bags[0]) == content(offline)
