# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of any type as arrays: of types that are not installed, as rosbags encodes them."""

from dynsim_ros.bag import load
from dynsim_ros.bag.load_bag import TopicError
from loaded import plain
from mcap.writer import Writer
import numpy as np
import pytest
from rosbags.typesys import get_types_from_msg, get_typestore, Stores

READING = """\
std_msgs/Header header
bool ok
uint8[3] flags
float32[] samples   # after an odd number of bytes
lab_msgs/Part[2] parts
lab_msgs/Part[] more
string unit
string<=9[] tags
int64 COUNT=5
int64 count 7
char letter
"""
PART = 'uint8 kind\nfloat64 value\n'
HEADER = 'builtin_interfaces/Time stamp\nstring frame_id\n'
TIME = 'int32 sec\nuint32 nanosec\n'
TEXT = ('=' * 80 + '\n').join([READING, f'MSG: lab_msgs/Part\n{PART}',
                               f'MSG: std_msgs/Header\n{HEADER}',
                               f'MSG: builtin_interfaces/msg/Time\n{TIME}'])
NAME = 'lab_msgs/msg/Reading'


@pytest.fixture(scope='module')
def types():
    store = get_typestore(Stores.EMPTY)
    for name, text in ((NAME, READING), ('lab_msgs/msg/Part', PART),
                       ('std_msgs/msg/Header', HEADER), ('builtin_interfaces/msg/Time', TIME)):
        store.register(get_types_from_msg(text, name))
    return store


def reading(types, number, samples=3, unit='mV', more=1):
    kinds = types.types
    part, header, time = (kinds[name] for name in (
        'lab_msgs/msg/Part', 'std_msgs/msg/Header', 'builtin_interfaces/msg/Time'))
    return kinds[NAME](
        header=header(stamp=time(sec=number, nanosec=5), frame_id='bench'), ok=number % 2 == 0,
        flags=np.array([1, number, 255], np.uint8),
        samples=np.arange(samples, dtype=np.float32) + number,
        parts=[part(kind=1, value=0.1 * number), part(kind=2, value=-np.inf)],
        more=[part(kind=i, value=float(i)) for i in range(more)], unit=unit, tags=['a', 'bcd'],
        count=-number, letter=65)


def as_dict(message, name, types):
    """Return a message of rosbags as plain() has it."""
    if hasattr(message, '__msgtype__'):
        return {field: as_dict(getattr(message, field), field, types)
                for field in message.__dataclass_fields__ if not field.startswith('_')
                and field != 'COUNT'}
    if isinstance(message, np.ndarray):
        return message.tobytes() if message.dtype == np.uint8 else message.tolist()
    return [as_dict(part, name, types) for part in message] if isinstance(message, list) \
        else message


def write(path, messages, text=TEXT, encoding='cdr'):
    """Write CDR messages 1 ms apart."""
    with open(path, 'wb') as stream:
        writer = Writer(stream)
        writer.start('ros2')
        schema = writer.register_schema(NAME, 'ros2msg', text.encode())
        channel = writer.register_channel('/reading', encoding, schema)
        for number, data in enumerate(messages):
            writer.add_message(channel, number * 10 ** 6, data, number * 10 ** 6)
        writer.finish()


@pytest.mark.parametrize('little_endian', [True, False])
@pytest.mark.parametrize('more', [0, 1, 3])
@pytest.mark.parametrize('text', [TEXT, TEXT.replace('\n', '\r\n')], ids=['lf', 'crlf'])
def test_a_type_that_is_not_installed(tmp_path, types, little_endian, more, text):
    sent = [reading(types, number, more=more) for number in range(20)]
    write(tmp_path / 'a.mcap', [bytes(types.serialize_cdr(message, NAME,
                                                          little_endian=little_endian))
                                for message in sent], text)
    run = load(tmp_path / 'a.mcap')
    wanted = [as_dict(message, NAME, types) for message in sent]
    if not more:
        wanted = [{**message, 'more': []} for message in wanted]
    assert [plain(row) for row in run['/reading']] == wanted
    assert [message for _, message in run.messages('reading')] == wanted
    assert run['reading']['samples'].shape == (20, 3)


def test_columns(tmp_path, types):
    write(tmp_path / 'a.mcap', [bytes(types.serialize_cdr(reading(types, 4), NAME))])
    columns = load(tmp_path / 'a.mcap').columns('reading')
    assert {name: column.tolist() for name, column in columns.items()} == {
        'header.stamp.sec': [4], 'header.stamp.nanosec': [5], 'header.frame_id': ['bench'],
        'ok': [True], 'flags.0': [1], 'flags.1': [4], 'flags.2': [255], 'samples.0': [4.0],
        'samples.1': [5.0], 'samples.2': [6.0], 'parts.0.kind': [1], 'parts.0.value': [0.4],
        'parts.1.kind': [2], 'parts.1.value': [-np.inf], 'more.0.kind': [0],
        'more.0.value': [0.0], 'unit': ['mV'], 'tags.0': ['a'], 'tags.1': ['bcd'],
        'count': [-4], 'letter': [65]}


@pytest.mark.parametrize(('change', 'reason'), [
    ({'samples': 5}, "the length of 'samples' varies"), ({'samples': 2}, 'they have '),
    ({'unit': 'mVA'}, "the length of 'unit' varies")])
def test_messages_without_a_fixed_layout_come_one_by_one(tmp_path, types, change, reason):
    sent = [reading(types, 1), reading(types, 2), reading(types, 3, **change)]
    write(tmp_path / 'a.mcap', [bytes(types.serialize_cdr(message, NAME)) for message in sent])
    run = load(tmp_path / 'a.mcap')
    assert run.left_out['/reading'].startswith(reason) and list(run) == []
    with pytest.raises(TopicError) as caught:
        run['/reading']
    assert str(caught.value) == (f'/reading in {run.path} is no array of messages: '
                                 f'{run.left_out["/reading"]}')
    assert [(stamp, message) for stamp, message in run.messages('/reading')] == [
        (number * 10 ** 6, as_dict(message, NAME, types)) for number, message in enumerate(sent)]


@pytest.mark.parametrize(('options', 'reason'), [
    ({'encoding': 'json'}, "they are 'json', not CDR"),
    ({'text': ''}, "no definition of 'lab_msgs/msg/Reading' in "),
    ({'text': READING}, "no definition of 'lab_msgs/msg/Part' in "),
    ({'text': 'float64'}, "the definition of 'lab_msgs/msg/Reading' in the bag cannot be read: "),
    ({'text': TEXT.replace('bool ok', 'wstring ok')}, 'ok: type wstring is not supported')])
def test_what_cannot_be_read(tmp_path, types, options, reason):
    write(tmp_path / 'a.mcap', [bytes(types.serialize_cdr(reading(types, 1), NAME))], **options)
    left_out = load(tmp_path / 'a.mcap').left_out['/reading']
    assert left_out.startswith(reason) and '\n' not in left_out


@pytest.mark.parametrize('data', [b'', b'\0\1', b'\0\1\0\0abc', b'\0\3\0\0' + bytes(99),
                                  b'\0\1\0\0' + b'\xff' * 99])
def test_bytes_that_are_no_such_message(tmp_path, data):
    write(tmp_path / 'a.mcap', [data])
    left_out = load(tmp_path / 'a.mcap').left_out['/reading']
    assert left_out.startswith(f'{NAME}: the data ') and '\n' not in left_out


def test_a_type_that_is_installed_needs_no_text(tmp_path):
    with open(tmp_path / 'a.mcap', 'wb') as stream:
        writer = Writer(stream)
        writer.start('ros2')
        for name in ('std_msgs/msg/UInt64', 'std_msgs/msg/Empty'):
            schema = writer.register_schema(name, 'ros2msg', b'')
            channel = writer.register_channel(f'/{name[-5:]}', 'cdr', schema)
            for number in range(9):
                writer.add_message(channel, number, b'\0\1\0\0' + bytes([number] * 8), number)
        writer.finish()
    run = load(tmp_path / 'a.mcap')
    assert run['Int64']['data'].tolist() == [0x0101010101010101 * number for number in range(9)]
    assert run['Empty'].shape == (9,) and run['Empty'].dtype.names == ()
