# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
import itertools
import os
import pty
import signal
import subprocess
import sys
import time

from bag_samples import sample_messages, write_sample
from dynsim_ros.bag.writer import BagWriter
from dynsim_ros.messages.cdr import decode, encode
from mcap.writer import Writer
import pytest
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from ros_listener import Listener
from std_srvs.srv import Trigger

COMMAND = [sys.executable, '-m', 'dynsim_ros.cli.replay']
POSE = 'geometry_msgs/msg/PoseStamped'
CONTROL = set(map(chr, range(32))) - {'\n'}

pytestmark = pytest.mark.usefixtures('discovery')


@pytest.fixture(scope='module')
def bag(tmp_path_factory):
    path = tmp_path_factory.mktemp('bags') / 'sample.mcap'
    write_sample(path)
    return path


@pytest.fixture(scope='module')
def ears(discovery):
    listener = Listener(
        f'/sample/pose={POSE}', '/sample/twist=geometry_msgs/msg/TwistStamped',
        '/sample/epoch=std_msgs/msg/UInt64+latched', f'/ghost/pose={POSE}',
        f'/lab/pose={POSE}', '/burst=std_msgs/msg/UInt64', '/clock=rosgraph_msgs/msg/Clock')
    yield listener
    listener.close()


@pytest.fixture
def listener(ears):
    """Give a subscriber in another process that has heard nothing yet."""
    time.sleep(0.1)
    ears.heard.clear()
    return ears


@pytest.fixture
def start(request):
    """Give a function that starts a replay, which does not outlive the test."""
    started = []

    def start(*arguments):
        process = subprocess.Popen([*COMMAND, *map(str, arguments)], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        started.append(process)
        return process

    yield start
    for process in started:
        if process.poll() is None:
            process.kill()
        process.communicate()


def replay(*arguments):
    """Run a replay to its end; return the finished process after checking its exit status."""
    done = subprocess.run([*COMMAND, '--wait-acked', '0.2', *map(str, arguments)],
                          capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert not CONTROL & set(done.stdout + done.stderr)
    return done


def refused(*arguments):
    """Run a replay that has to be refused; return the one line it gives as the error."""
    done = subprocess.run([*COMMAND, *map(str, arguments)], capture_output=True, text=True,
                          timeout=60)
    assert (done.returncode, done.stdout) == (2, '')
    (line,) = [line for line in done.stderr.splitlines() if 'rcl' not in line.split(':')[0]]
    return line


class Remote:
    """Calls the services of a replay."""

    def __enter__(self):
        self._context = rclpy.Context()
        rclpy.init(context=self._context)
        self._node = Node('remote', context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        return self

    def __exit__(self, *_):
        self._executor.shutdown()
        self._node.destroy_node()
        rclpy.shutdown(context=self._context)

    def call(self, name):
        client = self._node.create_client(Trigger, f'/dynsim_replay/{name}')
        assert client.wait_for_service(10)
        answer = client.call_async(Trigger.Request())
        self._executor.spin_until_future_complete(answer, 10)
        self._node.destroy_client(client)
        assert answer.result().success
        return answer.result().message


@pytest.mark.parametrize('rate', [1, 4])
def test_arrives_byte_for_byte_and_in_time(bag, listener, rate):
    done = replay(bag, '--rate', rate)
    messages = sample_messages()
    heard = listener.wait(len(messages))
    for topic in {topic for topic, _, _ in messages}:
        assert [item.data for item in heard if item.topic == topic] == [
            data for name, _, data in messages if name == topic]
    poses = [item.time for item in heard if item.topic == '/sample/pose']
    assert poses[-1] - poses[0] == pytest.approx(0.99 / rate, abs=0.15)
    shifts = sorted(when - number * 0.01 / rate for number, when in enumerate(poses))
    assert shifts[75] - shifts[25] < 0.03
    assert done.stdout.splitlines() == [
        f'{bag}: 3 topics, playing 0.990 s', 'replayed 201 messages']
    assert done.stderr == ''


def test_part_of_the_bag_under_another_name(bag, listener):
    done = replay(bag, '--topics', '/sample/p*', '--remap', '/sample/pose:=/ghost/pose',
                  '--start-offset', '0.5', '--duration', '0.2', '--quiet')
    heard = listener.wait(21)
    assert [(item.topic, item.data) for item in heard] == [
        ('/ghost/pose', data) for topic, stamp, data in sample_messages()
        if topic == '/sample/pose' and 0.5e9 <= stamp <= 0.7e9]
    assert (done.stdout, done.stderr) == ('', '')


def test_ros_arguments(bag, listener):
    replay(bag, '--topics', '/sample/pose', '--rate', '10', '--ros-args', '-r',
           '/sample/pose:=/lab/pose', '-r', '__node:=player')
    assert {item.topic for item in listener.wait(100)} == {'/lab/pose'}


def test_clock(bag, listener):
    replay(bag, '--clock', '50', '--rate', '0.8', '--topics', '/sample/epoch', '/sample/twist')
    listener.wait(101)
    clocks = [decode('rosgraph_msgs/msg/Clock', item.data)['clock']
              for item in listener.of('/clock')]
    times = [stamp['sec'] + stamp['nanosec'] * 1e-9 for stamp in clocks]
    assert times == sorted(times) and 0.0 <= times[0] < 0.1
    assert times[-1] == pytest.approx(0.99, abs=0.001)
    assert 45 <= len(times) <= 66


def test_pause_and_resume(bag, listener, start):
    process = start(bag, '--start-paused', '--rate', '0.5', '--wait-acked', '0')
    assert process.stdout.readline() == (
        f'{bag}: 3 topics, playing 0.990 s, paused: call the service ~/resume to start\n')
    with Remote() as remote:
        assert remote.call('pause') == 'paused at 0.000 s'
        assert not listener.heard
        assert remote.call('resume') == 'playing at 0.000 s'
        listener.wait(40)
        held = remote.call('pause')
        time.sleep(0.2)
        count = len(listener.heard)
        time.sleep(0.5)
        assert len(listener.heard) == count < 201
        assert remote.call('resume') == held.replace('paused', 'playing')
    assert process.wait(20) == 0
    poses = [item for item in listener.wait(201) if item.topic == '/sample/pose']
    assert len(poses) == 100
    gaps = [after.time - before.time for before, after in itertools.pairwise(poses)]
    assert max(gaps) > 0.6


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_loop_until_a_signal(bag, listener, start, number):
    process = start(bag, '--loop', '--rate', '4', '--clock')
    listener.wait(450)
    process.send_signal(number)
    process.send_signal(number)
    out, err = process.communicate(timeout=10)
    assert (process.returncode, err) == (0, '')
    assert out.splitlines()[-1].startswith('stopped after ')
    poses = [item.data for item in listener.of('/sample/pose')]
    once = [data for topic, _, data in sample_messages() if topic == '/sample/pose']
    assert poses == (once * 20)[:len(poses)] and len(poses) > 100


@pytest.mark.parametrize('delay', [0.05, 0.2, 0.4])
def test_an_early_signal(bag, start, delay):
    process = start(bag, '--loop')
    time.sleep(delay)
    process.terminate()
    _, err = process.communicate(timeout=10)
    assert 'Traceback' not in err
    # Before Python has come to this program, nobody but the system can answer the signal.
    assert process.returncode in (0, -signal.SIGTERM)


def test_the_last_of_a_burst_arrives(tmp_path, listener):
    with BagWriter(tmp_path / 'burst.mcap') as writer:
        channel = writer.add_channel('/burst', 'std_msgs/msg/UInt64')
        for number in range(3000):
            writer.write(channel, 0, encode('std_msgs/msg/UInt64', {'data': number}))
    # The last --wait-acked counts.
    replay(tmp_path / 'burst.mcap', '--wait-acked', '3.5')
    heard = listener.wait(3000)
    assert [decode('std_msgs/msg/UInt64', item.data)['data'] for item in heard] == [
        *range(3000)]


def test_a_cut_file_is_played_as_far_as_it_goes(tmp_path, listener):
    write_sample(tmp_path / 'whole.mcap', chunk_size=3000, compression='none')
    content = (tmp_path / 'whole.mcap').read_bytes()
    (tmp_path / 'cut.mcap').write_bytes(content[:len(content) // 2])
    done = replay(tmp_path / 'cut.mcap', '--rate', '10')
    count = int(done.stdout.splitlines()[-1].split()[1])
    assert done.stderr.startswith('warning: the file ends in the middle of a ')
    assert f': {count} messages up to 0.' in done.stderr
    assert 50 < len(listener.wait(count)) == count < 201


def test_what_cannot_be_played_is_left_out(tmp_path, listener):
    with open(tmp_path / 'a.mcap', 'wb') as stream:
        writer = Writer(stream)
        writer.start()
        for topic, type_name, encoding, metadata in (
                ('/a', 'nowhere_msgs/msg/Nothing', 'cdr', {}),
                ('/b', 'std_msgs/msg/UInt64', 'json', {}),
                ('/c', 'std_msgs/msg/UInt64', 'cdr', {'topic_type_hash': 'RIHS01_00'}),
                ('/d-e', 'std_msgs/msg/UInt64', 'cdr', {}),
                ('/burst', 'std_msgs/msg/UInt64', 'cdr', {})):
            schema = writer.register_schema(type_name, 'ros2msg', b'uint64 data')
            channel = writer.register_channel(topic, encoding, schema, metadata)
            writer.add_message(channel, 5, encode('std_msgs/msg/UInt64', {'data': 7}), 5)
        writer.finish()
    done = replay(tmp_path / 'a.mcap')
    assert done.stderr.splitlines() == [
        "warning: left out: /a (type 'nowhere_msgs/msg/Nothing' is not installed), /b (its "
        "messages are 'json', not CDR), /c (type 'std_msgs/msg/UInt64' was recorded with another "
        "definition), /d-e ('/d-e' is no ROS topic name)"]
    assert [item.topic for item in listener.wait(1)] == ['/burst']
    assert refused(tmp_path / 'a.mcap', '--topics', '/a') == (
        "error: no topic can be played: /a (type 'nowhere_msgs/msg/Nothing' is not installed)")


def test_what_is_no_bag(tmp_path):
    (tmp_path / 'a.mcap').write_text('gravity: 9.81')
    assert refused(tmp_path / 'a.mcap') == f'error: {tmp_path}/a.mcap is not an MCAP file'
    assert refused(tmp_path / 'b.mcap') == f'error: {tmp_path}/b.mcap: No such file or directory'


@pytest.mark.parametrize(('arguments', 'part'), [
    (['--topics', '/nothing'], "no topic '/nothing' in "),
    (['--remap', '/nothing:=/b'], "no topic '/nothing' to remap in "),
    (['--remap', '/sample/pose:=/a-b'], "cannot remap /sample/pose: '/a-b' is no topic name"),
    (['--start-offset', '5'], 'start offset 5 s lies behind the end of '),
    (['--ros-args', '-p', 'x'], 'ROS cannot start: '),
    (['--ros-args', '-r', '__node:=a-b'], 'ROS cannot start: '),
    (['--ros-args', '--nothing'], '--nothing'),
])
def test_what_does_not_fit_the_bag(bag, arguments, part):
    line = refused(bag, *arguments)
    assert line.startswith('error: ') and part in line


@pytest.mark.parametrize(('arguments', 'part'), [
    (['--rate', '0'], '0 is out of range: 1e-06 to 1e+06'),
    (['--rate', 'nan'], "'nan' is not a number"), (['--rate', '1e308'], '1e308 is out of range'),
    (['--clock', '-1'], '-1 is out of range: 1e-06 to 1e+06'),
    (['--duration', '-1'], '-1 s is out of range: 0 to 1e+09 s'),
    (['--start-offset', '1e300'], '1e300 s is out of range'),
    (['--remap', 'a'], "'a' is not of the form OLD:=NEW"), ([], 'required: FILE')])
def test_wrong_options(capsys, arguments, part):
    from dynsim_ros.cli.replay import main
    with pytest.raises(SystemExit) as ended:
        main([*(['x.mcap'] if arguments else []), *arguments])
    assert ended.value.code == 2 and part in capsys.readouterr().err


def test_help_needs_no_ros():
    code = ('import sys; sys.modules["rclpy"] = None\n'
            'from dynsim_ros.cli.replay import main; main(["--help"])')
    done = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True, timeout=30)
    assert done.returncode == 0
    for part in ('--rate', '--loop', '--start-offset', '--duration', '--topics', '--remap',
                 '--clock', '--start-paused', '--quiet', '~/resume', 'default 3 s'):
        assert part in done.stdout


def test_a_terminal_gets_a_bar(bag, listener):
    ours, theirs = pty.openpty()
    process = subprocess.Popen([*COMMAND, '--wait-acked', '0', str(bag)], stdout=theirs,
                               stderr=theirs, env=dict(os.environ, COLUMNS='100'))
    os.close(theirs)
    shown = b''
    try:
        while True:
            shown += os.read(ours, 4096)
    except OSError:
        # The other end of a pseudo-terminal was closed.
        pass
    os.close(ours)
    assert process.wait(10) == 0
    text = shown.decode()
    assert '\r\x1b[K[####' in text and ' of 1.0 s' in text and ' messages' in text
    assert text.endswith('replayed 201 messages\r\n')
