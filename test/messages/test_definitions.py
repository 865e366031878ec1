# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
import os
import subprocess
import sys

from dynsim_ros.messages import definitions
from dynsim_ros.messages.definitions import definition, MessageDefinitionError
import pytest
from rosbags.typesys import get_types_from_msg, get_typestore, Stores

TYPES = (
    'diagnostic_msgs/msg/DiagnosticArray', 'geometry_msgs/msg/PointStamped',
    'geometry_msgs/msg/PoseStamped', 'geometry_msgs/msg/TwistStamped',
    'geometry_msgs/msg/WrenchStamped', 'rcl_interfaces/msg/Parameter', 'rosgraph_msgs/msg/Clock',
    'sensor_msgs/msg/PointCloud2', 'std_msgs/msg/Empty', 'std_msgs/msg/Float64MultiArray',
    'std_msgs/msg/Header', 'std_msgs/msg/UInt64', 'tf2_msgs/msg/TFMessage',
    'visualization_msgs/msg/MarkerArray')


@pytest.fixture
def fresh():
    """Forget what was found, before and after."""
    def forget():
        definitions.definition.cache_clear()
        definitions._read.cache_clear()

    forget()
    yield
    forget()


@pytest.mark.parametrize('name', TYPES)
def test_text_gives_the_installed_type_hash(name):
    # rosbags builds the hash from the text alone: a nested definition that lacks would show.
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg(definition(name).text, name))
    assert store.hash_rihs01(name) == definition(name).type_hash


def test_fields():
    fields = {field.name: field for field in definition('sensor_msgs/msg/PointCloud2').fields}
    assert list(fields) == ['header', 'height', 'width', 'fields', 'is_bigendian', 'point_step',
                            'row_step', 'data', 'is_dense']
    assert fields['header'].type_name == 'std_msgs/msg/Header' and fields['header'].is_message
    assert fields['fields'].is_sequence and fields['fields'].length is None
    (covariance,) = [field for field in definition('geometry_msgs/msg/PoseWithCovariance').fields
                     if field.name == 'covariance']
    assert covariance.length == 36 and not covariance.is_sequence
    assert [field.default for field in definition('geometry_msgs/msg/Quaternion').fields] == [
        0.0, 0.0, 0.0, 1.0]


def test_nested_definitions_are_separated_as_ros2msg_wants():
    parts = definition('geometry_msgs/msg/PoseStamped').text.split('=' * 80 + '\n')
    assert [part.splitlines()[0] for part in parts[1:]] == [
        'MSG: std_msgs/Header', 'MSG: builtin_interfaces/Time', 'MSG: geometry_msgs/Pose',
        'MSG: geometry_msgs/Point', 'MSG: geometry_msgs/Quaternion']


def test_prefixes_of_a_workspace_come_first(tmp_path, monkeypatch, fresh):
    folder = tmp_path / 'share' / 'toy_msgs' / 'msg'
    folder.mkdir(parents=True)
    (folder / 'Toy.msg').write_text('geometry_msgs/Point[<=3] points\nstring<=5 name "abc"\n')
    monkeypatch.setenv('AMENT_PREFIX_PATH', f'/nowhere{os.pathsep}{tmp_path}')
    toy = definition('toy_msgs/msg/Toy')
    assert toy.type_hash == '' and toy.text.endswith('float64 z\n')
    assert (toy.fields[0].bound, toy.fields[1].default) == (3, 'abc')


def test_found_beside_the_python_package(tmp_path, monkeypatch, fresh):
    monkeypatch.delenv('AMENT_PREFIX_PATH', raising=False)
    monkeypatch.setattr(sys, 'prefix', str(tmp_path))
    assert definition('geometry_msgs/msg/Point').fields[0].name == 'x'


@pytest.mark.parametrize(('name', 'part'), [
    ('toy_msgs/msg/Toy', 'install ros-jazzy-toy-msgs or source the workspace that has it'),
    ('geometry_msgs/msg/Nothing', sys.prefix),
    ('PoseStamped', 'write package/msg/Name'),
    ('std_srvs/srv/Trigger', 'write package/msg/Name'),
])
def test_missing_type_is_one_line(name, part):
    with pytest.raises(MessageDefinitionError) as caught:
        definition(name)
    text = str(caught.value)
    assert name in text and part in text and '\n' not in text


def test_unreadable_definition_is_named(tmp_path, monkeypatch, fresh):
    folder = tmp_path / 'share' / 'toy_msgs' / 'msg'
    folder.mkdir(parents=True)
    (folder / 'Toy.msg').write_text('float64 2x\n')
    monkeypatch.setenv('AMENT_PREFIX_PATH', str(tmp_path))
    with pytest.raises(MessageDefinitionError, match=r"'toy_msgs/msg/Toy' in .*Toy.msg cannot"):
        definition('toy_msgs/msg/Toy')


def test_nothing_here_imports_rclpy():
    code = ('import sys, dynsim_ros.messages.cdr, dynsim_ros.messages.qos, '
            'dynsim_ros.bag.reader, dynsim_ros.bag.recorder\n'
            'from dynsim_ros.messages.cdr import encode\n'
            'encode("geometry_msgs/msg/PoseStamped")\n'
            'assert not [name for name in sys.modules if name.startswith(("rclpy", "geometry"))]')
    environment = {key: value for key, value in os.environ.items() if key != 'AMENT_PREFIX_PATH'}
    subprocess.run([sys.executable, '-c', code], check=True, env=environment, timeout=60)
