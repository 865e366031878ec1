# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
A bag of a million messages, written, read and recovered, beside mcap and rosbags in one run.

Usage: python benchmarks/bag.py [--messages N] [--kills N]. The messages are ticks of the default
scene at 1 kHz. Every measurement has a process of its own. Writes bag.md.
"""

import argparse
import multiprocessing
from pathlib import Path
import resource
import shutil
import tempfile
import time

from bag_killed import losses, summed_up
from dynsim_ros.bag import load
from dynsim_ros.bag.reader import open_bag
from dynsim_ros.bag.recorder import Recorder
from dynsim_ros.bag.recovery.recover import recover
from dynsim_ros.bag.writer import BagWriter
from dynsim_ros.messages.definitions import definition
from dynsim_ros.messages.scene_channels import scene_channels
from dynsim_ros.messages.tick_rows import TickRows
from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import Simulator
from mcap.reader import make_reader, NonSeekingReader
from mcap.writer import CompressionType, Writer
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Writer as RosbagsWriter
from rosbags.rosbag2.storage_mcap import McapReader

TICK_NS = 1_000_000
# Of the ticks that are recorded over and over: all that differs is their time.
DIFFERENT = 5000
HEAD = """\
# A bag of {messages} messages

`make bench-bag` (three minutes): the ticks of the default scene at 1 kHz, {rows} messages each,
ready made, zstd. Each line is one run in a process of its own, without its start. dynsim_ros is
handed rows of ticks, as the node does; the others get message after message. All read the file
that dynsim_ros wrote. What has fewer messages has lost them to the damage.

| what | by | wall s | CPU s | µs a message | peak memory MB | messages | file MB |
|---|---|---|---|---|---|---|---|
"""


def recorded_ticks():
    """Return (TickRows, blocks of some ticks)."""
    simulator = Simulator(load_scene('sphere_on_spring'), rate=1e9 / TICK_NS)
    rows = TickRows(scene_channels(simulator.scene, simulator.layout), simulator.layout)
    blocks = []
    for tick in range(DIFFERENT):
        rows.fill(simulator.instant(), tick * TICK_NS, rows.of())
        blocks.append(rows.block.copy())
        simulator.advance_tick()
    return rows, blocks


def messages_of(rows, blocks, ticks):
    """Yield (number of the channel, time, CDR bytes) of all messages, ready made."""
    made = [[block[start:end].tobytes() for start, end in rows.spans] for block in blocks]
    for tick in range(ticks):
        for number, data in enumerate(made[tick % DIFFERENT]):
            yield number, tick * TICK_NS, data


def write_rows(path, rows, blocks, ticks):
    """Write as the node does."""
    wanted, views = rows.of(), [memoryview(block) for block in blocks]
    with Recorder(BagWriter(path), wait=True) as recorder:
        recorder.declare_rows(rows, [recorder.add_channel(f'/{channel.topic}', channel.type_name)
                                     for channel in rows.channels])
        for tick in range(ticks):
            rows.view = views[tick % DIFFERENT]
            recorder.put_rows(rows, tick * TICK_NS, wanted)
    return recorder.messages


def write_mcap(path, rows, blocks, ticks):
    """Write with mcap.Writer, which has no thread."""
    count = 0
    with open(path, 'wb') as stream:
        writer = Writer(stream, compression=CompressionType.ZSTD)
        writer.start('ros2')
        ids = []
        for channel in rows.channels:
            schema = writer.register_schema(channel.type_name, 'ros2msg',
                                            definition(channel.type_name).text.encode())
            ids.append(writer.register_channel(f'/{channel.topic}', 'cdr', schema))
        for number, stamp, data in messages_of(rows, blocks, ticks):
            writer.add_message(ids[number], stamp, data, stamp)
            count += 1
        writer.finish()
    return count


def write_rosbags(path, rows, blocks, ticks):
    """Write with rosbags, chunks compressed."""
    count = 0
    folder = path.with_suffix('')
    writer = RosbagsWriter(folder, version=9, storage_plugin=StoragePlugin.MCAP)
    writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
    with writer:
        connections = [writer.add_connection(
            f'/{channel.topic}', channel.type_name, msgdef=definition(channel.type_name).text,
            rihs01=definition(channel.type_name).type_hash) for channel in rows.channels]
        for number, stamp, data in messages_of(rows, blocks, ticks):
            writer.write(connections[number], stamp, data)
            count += 1
    (made,) = folder.glob('*.mcap')
    made.rename(path)
    return count


def read_ours(path):
    """Read with dynsim_ros."""
    with open_bag(path) as bag:
        return sum(1 for _ in bag.messages())


def load_ours(path):
    """Load as arrays by topic, as load() gives them."""
    run = load(path)
    return sum(map(len, run.values()))


def read_mcap(path):
    """Read with the reader of mcap that uses the index."""
    with open(path, 'rb') as stream:
        return sum(1 for _ in make_reader(stream).iter_messages())


def read_mcap_through(path):
    """Read with the reader of mcap that needs no index, up to where the file breaks off."""
    count = 0
    with open(path, 'rb') as stream:
        try:
            for _ in NonSeekingReader(stream).iter_messages(log_time_order=False):
                count += 1
        except Exception as error:
            print(f'({type(error).__name__}: {error})')
    return count


def read_rosbags(path):
    """Read with rosbags."""
    reader = McapReader(path)
    reader.open()
    count = sum(1 for _ in reader.messages(reader.connections, 0, 2 ** 62))
    reader.close()
    return count


def recover_ours(path):
    """Recover in place, or into a new file where something is damaged."""
    return recover(path).messages


def recover_by_mcap(path):
    """Copy what the reader of mcap gives to another file, until it fails."""
    count, ids = 0, {}
    with open(path, 'rb') as stream, open(path.with_suffix('.copy'), 'wb') as copy:
        writer = Writer(copy, compression=CompressionType.ZSTD)
        writer.start('ros2')
        messages = NonSeekingReader(stream).iter_messages(log_time_order=False)
        try:
            for schema, channel, message in messages:
                if channel.id not in ids:
                    number = writer.register_schema(schema.name, schema.encoding, schema.data)
                    ids[channel.id] = writer.register_channel(channel.topic, 'cdr', number)
                writer.add_message(ids[channel.id], message.log_time, message.data,
                                   message.publish_time)
                count += 1
        except Exception as error:
            print(f'({type(error).__name__}: {error})')
        writer.finish()
    return count


def measured(call, *arguments):
    """Return what a call returns, and wall time, CPU time [s] and peak memory [MB] of it."""
    def run(pipe):
        begin, cpu = time.perf_counter(), time.process_time()
        result = call(*arguments)
        wall, cpu = time.perf_counter() - begin, time.process_time() - cpu
        pipe.send((result, wall, cpu, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024))

    receiving, sending = multiprocessing.Pipe()
    process = multiprocessing.get_context('fork').Process(target=run, args=(sending,))
    process.start()
    sending.close()
    try:
        return receiving.recv()
    except EOFError:
        raise RuntimeError(f'{call.__name__} failed') from None
    finally:
        process.join()


def line(what, by, path, call, *arguments):
    """Return one line of the table."""
    count, wall, cpu, memory = measured(call, path, *arguments)
    text = (f'| {what} | {by} | {wall:.2f} | {cpu:.2f} | {wall / max(count, 1) * 1e6:.2f} | '
            f'{memory:.0f} | {count} | {path.stat().st_size / 1e6:.1f} |\n')
    print(text, end='', flush=True)
    return text


def table(folder, messages):
    """Return all lines."""
    rows, blocks = recorded_ticks()
    ticks = -(-messages // len(rows.channels))
    path, other = folder / 'a.mcap', folder / 'b.mcap'
    text = line('write', 'dynsim_ros', path, write_rows, rows, blocks, ticks)
    text += line('write', 'mcap.Writer', other, write_mcap, rows, blocks, ticks)
    other.unlink()
    text += line('write', 'rosbags', other, write_rosbags, rows, blocks, ticks)
    other.unlink()
    for by, call in (('dynsim_ros', read_ours), ('mcap', read_mcap),
                     ('mcap, not seeking', read_mcap_through), ('rosbags', read_rosbags)):
        text += line('read', by, path, call)
    text += line('load as arrays', 'dynsim_ros', path, load_ours)
    size = path.stat().st_size
    damage = {'cut off at 99 %': lambda stream: stream.truncate(size * 99 // 100),
              'damaged in the middle': lambda stream: (
                  stream.seek(size // 2), stream.write(bytes(1000)))}
    for what, spoil in damage.items():
        for by, call in (('dynsim_ros', recover_ours),
                         ('mcap, reader to writer', recover_by_mcap)):
            shutil.copy(path, other)
            with open(other, 'r+b') as stream:
                spoil(stream)
            text += line(f'recover one {what}', by, other, call)
    return text, len(rows.channels)


def main():
    """Measure, print and write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--messages', type=int, default=1_000_000)
    parser.add_argument('--kills', type=int, default=30)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        lines, rows = table(Path(folder), options.messages)
    text = HEAD.format(messages=f'{options.messages:,}'.replace(',', ' '), rows=rows) + lines
    text += f'\nAt 1 kHz, kill -9, then `recover`: {summed_up(losses(options.kills))}.\n'
    print(text.splitlines()[-1])
    Path(__file__).with_suffix('.md').write_text(text, encoding='utf-8')


if __name__ == '__main__':
    main()
