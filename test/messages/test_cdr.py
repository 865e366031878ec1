# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
from importlib import import_module
import math
import random

from dynsim_ros.messages.cdr import decode, encode, Template
from dynsim_ros.messages.definitions import definition
from mcap.records import Schema
from mcap_ros2.decoder import DecoderFactory
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from rosbags.typesys import get_types_from_msg, get_typestore, Stores

STAMPED = ('geometry_msgs/msg/PointStamped', 'geometry_msgs/msg/PoseStamped',
           'geometry_msgs/msg/TwistStamped', 'geometry_msgs/msg/WrenchStamped')
FIXED = (*STAMPED, 'std_msgs/msg/Header', 'std_msgs/msg/UInt64', 'rosgraph_msgs/msg/Clock',
         'geometry_msgs/msg/PoseWithCovarianceStamped')
FREE = ('diagnostic_msgs/msg/DiagnosticArray', 'visualization_msgs/msg/MarkerArray',
        'std_msgs/msg/Float64MultiArray', 'rcl_interfaces/msg/Parameter',
        'sensor_msgs/msg/PointCloud2', 'sensor_msgs/msg/Imu', 'std_msgs/msg/Empty',
        'std_msgs/msg/Int8MultiArray', 'std_msgs/msg/Float32', 'std_msgs/msg/Int16MultiArray')
RANGES = {'bool': (0, 1), 'int8': (-128, 127), 'int16': (-2 ** 15, 2 ** 15 - 1),
          'uint16': (0, 2 ** 16 - 1), 'int32': (-2 ** 31, 2 ** 31 - 1),
          'uint32': (0, 2 ** 32 - 1), 'int64': (-2 ** 63, 2 ** 63 - 1), 'uint64': (0, 2 ** 64 - 1)}


def any_message(type_name, dice, text=None):
    """Return a dict with every field, numbers and lengths by chance."""
    return {field.name: any_field(field, dice, text) for field in definition(type_name).fields}


def any_field(field, dice, text):
    if not field.is_sequence and field.length is None:
        return any_value(field.type_name, dice, text)
    count = field.length or dice.randrange(min(field.bound or 4, 4))
    values = [any_value(field.type_name, dice, text) for _ in range(count)]
    return bytes(values) if field.type_name in ('byte', 'char', 'uint8') else values


def any_value(type_name, dice, text):
    if '/' in type_name:
        return any_message(type_name, dice, text)
    if type_name == 'string':
        return text if text is not None else 'ä€xyz'[:dice.randrange(6)]
    if type_name.startswith('float'):
        return float(dice.randrange(-2 ** 20, 2 ** 20)) / 2 ** 7
    value = dice.randint(*RANGES.get(type_name, (0, 255)))
    return bool(value) if type_name == 'bool' else value


def ros_message(type_name, value):
    """Return rclpy's message for a dict."""
    package, _, name = type_name.split('/')
    message = getattr(import_module(f'{package}.msg'), name)()
    for field in definition(type_name).fields:
        given = value[field.name]
        if field.is_message:
            array = field.is_sequence or field.length
            given = ([ros_message(field.type_name, element) for element in given] if array
                     else ros_message(field.type_name, given))
        elif field.type_name == 'byte':
            given = [bytes([element]) for element in given] if field.is_sequence else bytes(
                [given])
        setattr(message, field.name, given)
    return message


def as_dict(type_name, message):
    """Return the dict for a message object of rclpy, rosbags or mcap_ros2."""
    result = {}
    for field in definition(type_name).fields:
        value = getattr(message, field.name)
        array = field.is_sequence or field.length
        if field.is_message:
            value = ([as_dict(field.type_name, element) for element in value] if array
                     else as_dict(field.type_name, value))
        elif field.type_name in ('byte', 'char', 'uint8'):
            # mcap_ros2 takes a byte for a signed one.
            flat = [element[0] if isinstance(element, bytes) else int(element) % 256
                    for element in (value if array else [value])]
            value = bytes(flat) if array else flat[0]
        elif array:
            value = [getattr(element, 'item', lambda e=element: e)() for element in value]
        result[field.name] = value
    return result


def check_against_all(type_name, value, data):
    """Check bytes against rclpy, rosbags and mcap_ros2, and theirs against ours."""
    message = ros_message(type_name, value)
    theirs = serialize_message(message)
    assert deserialize_message(data, type(message)) == message
    assert decode(type_name, theirs) == decode(type_name, data) == value
    # rclpy takes a generous guess of the size, for empty sequences above all, and sends it all.
    assert len(data) <= len(theirs)
    store = get_typestore(Stores.EMPTY)
    text = definition(type_name).text
    store.register(get_types_from_msg(text, type_name))
    other = store.deserialize_cdr(data, type_name)
    assert as_dict(type_name, other) == value
    assert decode(type_name, bytes(store.serialize_cdr(other, type_name))) == value
    big = bytes(store.serialize_cdr(other, type_name, little_endian=False))
    assert big[1] == 0 and decode(type_name, big) == value
    if definition(type_name).fields:
        schema = Schema(1, text.encode(), 'ros2msg', type_name)
        assert as_dict(type_name, DecoderFactory().decoder_for('cdr', schema)(data)) == value


@pytest.mark.parametrize('type_name', STAMPED)
@pytest.mark.parametrize('length', range(18))
def test_frame_names_of_every_length(type_name, length):
    value = any_message(type_name, random.Random(length), 'f' * length)
    check_against_all(type_name, value, encode(type_name, value))


@pytest.mark.parametrize('type_name', FIXED + FREE)
@pytest.mark.parametrize('seed', range(8))
def test_any_content(type_name, seed):
    value = any_message(type_name, random.Random(seed))
    check_against_all(type_name, value, encode(type_name, value))


@pytest.mark.parametrize('type_name', FIXED + FREE)
def test_defaults_are_those_of_ros(type_name):
    package, _, name = type_name.split('/')
    message = getattr(import_module(f'{package}.msg'), name)()
    assert deserialize_message(encode(type_name), type(message)) == message


@pytest.mark.parametrize('type_name', FIXED + FREE)
def test_every_cut_is_an_error(type_name):
    data = encode(type_name, any_message(type_name, random.Random(5)))
    for end in range(len(data)):
        with pytest.raises(ValueError, match=r'the data (end after|are not plain CDR)') as caught:
            decode(type_name, data[:end])
        assert '\n' not in str(caught.value)


def test_wild_length_does_not_fill_the_memory():
    with pytest.raises(ValueError, match='the data end after'):
        decode('std_msgs/msg/Float64MultiArray', b'\0\1\0\0' + b'\xff' * 40)


@pytest.mark.parametrize(('type_name', 'value', 'part'), [
    ('std_msgs/msg/UInt64', {'data': -1}, r'std_msgs/msg/UInt64.data: -1 does not fit uint64'),
    ('std_msgs/msg/UInt64', {'data': 1.5}, r'1.5 does not fit uint64'),
    ('std_msgs/msg/Float32', {'data': 1e300}, r'1e\+300 does not fit float32'),
    ('std_msgs/msg/Float64', {'data': 'x'}, r"'x' does not fit float64"),
    ('std_msgs/msg/String', {'data': 1}, r'1 is not a string'),
    ('std_msgs/msg/String', {'dat': ''}, r"has no field 'dat': its fields are data"),
    ('std_msgs/msg/Header', {'stamp': 3}, r'Header.stamp: 3 is not a dict'),
    ('std_msgs/msg/Float64MultiArray', {'data': 3.0}, r'3.0 is not a sequence'),
    ('geometry_msgs/msg/PoseWithCovariance', {'covariance': [0.0]}, r'1 elements where 36'),
])
def test_what_does_not_fit_is_named(type_name, value, part):
    with pytest.raises(ValueError, match=part):
        encode(type_name, value)


@pytest.mark.parametrize('type_name', FIXED)
@pytest.mark.parametrize('length', range(18))
def test_template_equals_the_general_encoder(type_name, length):
    dice = random.Random(length)
    frame = 'w' * length
    has_header = any(field.name == 'header' for field in definition(type_name).fields)
    fixed = {'header': {'frame_id': frame}} if has_header else {}
    template = Template(type_name, fixed)
    values = [dice.randrange(10 ** 9) for _ in template.leaves]
    data = template.pack(*values)
    nested = decode(type_name, data)
    for leaf, value in zip(template.leaves, values, strict=True):
        found = nested
        for part in leaf.split('.'):
            found = found[int(part)] if isinstance(found, list) else found[part]
        assert found == value
    assert data == encode(type_name, nested)
    assert len(data) == template.size
    check_against_all(type_name, nested, data)


def test_template_leaves_of_a_pose():
    assert Template('geometry_msgs/msg/PoseStamped').leaves == (
        'header.stamp.sec', 'header.stamp.nanosec', 'pose.position.x', 'pose.position.y',
        'pose.position.z', 'pose.orientation.x', 'pose.orientation.y', 'pose.orientation.z',
        'pose.orientation.w')


def test_template_with_given_numbers_and_elements():
    fixed = {'data': [], 'layout': {'data_offset': 7, 'dim': [{'label': 'abc', 'size': 2}, {}]}}
    template = Template('std_msgs/msg/Float64MultiArray', fixed)
    assert template.leaves == ('layout.dim.0.stride', 'layout.dim.1.size', 'layout.dim.1.stride')
    assert decode('std_msgs/msg/Float64MultiArray', template.pack(3, 4, 5)) == {
        'layout': {'data_offset': 7, 'dim': [{'label': 'abc', 'size': 2, 'stride': 3},
                                             {'label': '', 'size': 4, 'stride': 5}]}, 'data': []}


def test_template_passes_nan_on():
    template = Template('std_msgs/msg/Float64')
    assert math.isnan(decode('std_msgs/msg/Float64', template.pack(math.nan))['data'])


@pytest.mark.parametrize(('type_name', 'fixed', 'part'), [
    ('diagnostic_msgs/msg/DiagnosticArray', {}, r'status is a sequence.*use encode\(\)'),
    ('geometry_msgs/msg/PoseStamped', {'frame_id': 'x'}, r"has no field 'frame_id'"),
    ('geometry_msgs/msg/PoseStamped', {'header': {'frame_id': 3}}, r'3 is not a string'),
])
def test_template_refuses(type_name, fixed, part):
    with pytest.raises(ValueError, match=part):
        Template(type_name, fixed)


@pytest.mark.parametrize('values', [(), (1, 2, 3), (0, -1), ('a', 2)])
def test_pack_refuses(values):
    with pytest.raises(ValueError, match=r'builtin_interfaces/msg/Time'):
        Template('builtin_interfaces/msg/Time').pack(*values)
