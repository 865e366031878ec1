# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What recording costs: a whole run into a bag, beside mcap.Writer on the same messages."""

import json
from pathlib import Path
import resource
import subprocess
import sys
import tempfile
import time

from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer
from recording import by_bursts, recorded_ticks

SCENE, RATE, COMPRESSION = 'sphere_on_spring', 1000, 'zstd'
# Simulated time of the shorter and the longer run [s]: their difference is free of the start.
DURATIONS = (10, 310)
# Ticks that the recorder alone is given.
ALONE = 40_000


def simulate(folder, seconds):
    """Record a run offline; return its processor time [s] and the path of its bag."""
    path = Path(folder, f'{seconds}.mcap')
    path.unlink(missing_ok=True)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(
        [sys.executable, '-m', 'dynsim_ros.cli.simulate', SCENE, '-q', '--duration', str(seconds),
         '--set', f'rate={RATE}', '--compression', COMPRESSION, '--output', str(path)],
        check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, path


def step_only(seconds):
    """Return the processor time of the same run without messages and bag [s]."""
    script = ('import time; from dynsim_ros.scene import load_scene; '
              'from dynsim_ros.simulation import Simulator; '
              f'simulator = Simulator(load_scene({SCENE!r}), rate={RATE}.0); '
              'simulator.advance_ticks(100); start = time.process_time(); '
              f'simulator.advance_ticks({seconds * RATE}); '
              'print(time.process_time() - start)')
    return float(subprocess.run([sys.executable, '-c', script], check=True, text=True,
                                stdout=subprocess.PIPE).stdout)


def messages_of(path):
    """Return [(topic, type, stamp, bytes)] of a bag."""
    with path.open('rb') as stream:
        return [(channel.topic, schema.name, message.log_time, message.data)
                for schema, channel, message in make_reader(stream).iter_messages()]


def mcap_writer(messages, folder):
    """Write messages as mcap.Writer does by default; return the processor time [s]."""
    with open(Path(folder, 'peer.mcap'), 'wb') as stream:
        start = time.process_time()
        writer = Writer(stream, compression=CompressionType.ZSTD)
        writer.start(profile='ros2')
        channels = {}
        for topic, kind, _, _ in messages[:1000]:
            if topic not in channels:
                schema = writer.register_schema(kind, 'ros2msg', b'')
                channels[topic] = writer.register_channel(topic, 'cdr', schema)
        for topic, _, stamp, data in messages:
            writer.add_message(channels[topic], stamp, data, stamp)
        writer.finish()
        return time.process_time() - start


def measure(rounds):
    """
    Return microseconds a message of each round, how many topics and messages a second there are.

    'simulate': stepping, building and recording together; 'recorded': the same less stepping;
    'recorder': recording alone, see recording.py; 'mcap.Writer': writing alone.
    """
    ours, recorded, recorder, peer = [], [], [], []
    rows, blocks = recorded_ticks(ALONE)
    alone = ALONE * len(rows.channels)
    with tempfile.TemporaryDirectory(prefix='dynsim_ros_bench_') as folder:
        for _ in range(rounds):
            (short, path), (long, long_path) = (simulate(folder, t) for t in DURATIONS)
            messages = messages_of(path)
            more = summary_count(long_path) - len(messages)
            ours.append(1e6 * (long - short) / more)
            stepping = step_only(DURATIONS[1] - DURATIONS[0])
            recorded.append(1e6 * (long - short - stepping) / more)
            peer.append(1e6 * mcap_writer(messages, folder) / len(messages))
            bag = Path(folder, 'alone.mcap')
            recorder.append(1e6 * by_bursts(bag, rows, blocks, COMPRESSION) / alone)
            bag.unlink()
    return {'simulate': ours, 'recorded': recorded, 'recorder': recorder, 'mcap.Writer': peer,
            'topics': len({topic for topic, *_ in messages}),
            'messages a second': more / (DURATIONS[1] - DURATIONS[0])}


def summary_count(path):
    with path.open('rb') as stream:
        return make_reader(stream).get_summary().statistics.message_count


if __name__ == '__main__':
    print(json.dumps(measure(2), indent=1))
