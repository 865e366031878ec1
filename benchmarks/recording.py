# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
What recording costs: rows of ticks in a thread, beside mcap.Writer with the same compression.

Usage: python benchmarks/recording.py [SECONDS] (default 40). Both record the same ticks of the
default scene. CPU: of the whole process, per message, without building the messages; put: what
the putting thread takes for a tick at 1 kHz, and the longest of all. Writes recording.md.
"""

from pathlib import Path
import sys
import tempfile
import time

from dynsim_ros.bag.recorder import Recorder
from dynsim_ros.bag.writer import BagWriter
from dynsim_ros.messages.definitions import definition
from dynsim_ros.messages.scene_channels import scene_channels
from dynsim_ros.messages.tick_rows import TickRows
from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import Simulator
from mcap.writer import CompressionType, Writer
import numpy as np

TYPES = {'none': CompressionType.NONE, 'lz4': CompressionType.LZ4, 'zstd': CompressionType.ZSTD}
TICK_NS, ROUNDS = 1_000_000, 5
# As many ticks at a time as a node at 1 kHz takes that nobody listens to.
BURST = 40
HEAD = """\
# Recording

`python benchmarks/recording.py`: the ticks of the default scene at 1 kHz, {rows} messages each.
CPU is that of the whole process for {seconds:g} s of ticks at full speed, handed over one by one,
as a node does that somebody listens to, or {burst} at a time, as one does that nobody listens to.
put is the time of the thread that hands a tick over while ticks come at 1 kHz, the longest one of
such a run of {seconds:g} s; medians of {rounds} runs and of 3 at 1 kHz.

| compression | mcap.Writer, CPU µs a message | rows one by one | ratio | rows {burst} ticks at a \
time | ratio | put µs a tick | longest put µs | bytes a message, mcap.Writer / rows |
|---|---|---|---|---|---|---|---|---|
"""


def recorded_ticks(count):
    """Return (TickRows, blocks of so many ticks)."""
    simulator = Simulator(load_scene('sphere_on_spring'), rate=1e9 / TICK_NS)
    rows = TickRows(scene_channels(simulator.scene, simulator.layout), simulator.layout)
    blocks = []
    for tick in range(count):
        rows.fill(simulator.instant(), tick * TICK_NS, rows.of())
        blocks.append(rows.block.copy())
        simulator.advance_tick()
    return rows, blocks


def by_library(path, rows, blocks, compression):
    """Return CPU [s] that mcap.Writer takes for the messages, inline."""
    messages = [[block[start:end].tobytes() for start, end in rows.spans] for block in blocks]
    with open(path, 'wb') as stream:
        begin = time.process_time()
        writer = Writer(stream, compression=TYPES[compression])
        writer.start('ros2')
        ids = []
        for channel in rows.channels:
            schema = writer.register_schema(channel.type_name, 'ros2msg',
                                            definition(channel.type_name).text.encode())
            ids.append(writer.register_channel(channel.topic, 'cdr', schema))
        for tick, parts in enumerate(messages):
            for number, data in zip(ids, parts):
                writer.add_message(number, tick * TICK_NS, data, tick * TICK_NS)
        writer.finish()
        return time.process_time() - begin


def new_recorder(path, rows, compression):
    """Return a Recorder for rows."""
    recorder = Recorder(BagWriter(path, compression=compression), wait=True)
    recorder.declare_rows(rows, [recorder.add_channel(f'/{channel.topic}', channel.type_name)
                                 for channel in rows.channels])
    return recorder


def by_rows(path, rows, blocks, compression):
    """Return CPU [s] of all."""
    wanted, views = rows.of(), [memoryview(block) for block in blocks]
    begin = time.process_time()
    recorder = new_recorder(path, rows, compression)
    for tick, rows.view in enumerate(views):
        recorder.put_rows(rows, tick * TICK_NS, wanted)
    recorder.close()
    return time.process_time() - begin


def by_bursts(path, rows, blocks, compression):
    """Return likewise CPU [s] where several ticks are handed over at a time."""
    wanted, blocks = rows.of(), np.array(blocks)
    stamps = TICK_NS * np.arange(len(blocks))
    begin = time.process_time()
    recorder = new_recorder(path, rows, compression)
    for first in range(0, len(blocks), BURST):
        rows.blocks = blocks[first:first + BURST]
        recorder.put_many_rows(rows, stamps[first:first + BURST], wanted)
    recorder.close()
    return time.process_time() - begin


def puts_in_time(path, rows, blocks, compression):
    """Return the times of all puts [s] while ticks come at 1 kHz."""
    wanted, recorder, puts = rows.of(), new_recorder(path, rows, compression), []
    due = time.perf_counter()
    for tick, block in enumerate(blocks):
        rows.view = memoryview(block)
        due += TICK_NS * 1e-9
        time.sleep(max(due - time.perf_counter(), 0.0))
        start = time.perf_counter()
        recorder.put_rows(rows, tick * TICK_NS, wanted)
        puts.append(time.perf_counter() - start)
    recorder.close()
    return puts


def line(folder, rows, blocks, compression):
    """Return one line of the table."""
    library, ours, bursts = [], [], []
    for number in range(ROUNDS):
        paths = [folder / f'{compression}_{number}_{name}' for name in ('a', 'b', 'd')]
        library.append(by_library(paths[0], rows, blocks, compression))
        ours.append(by_rows(paths[1], rows, blocks, compression))
        bursts.append(by_bursts(paths[2], rows, blocks, compression))
    puts = [puts_in_time(folder / f'{compression}_{i}_c', rows, blocks, compression)
            for i in range(3)]
    messages = len(blocks) * len(rows.channels)
    theirs, mine, together = (np.median(part) / messages * 1e6
                              for part in (library, ours, bursts))
    sizes = [path.stat().st_size / messages for path in paths]
    return (f'| {compression} | {theirs:.2f} | {mine:.3f} | {theirs / mine:.0f} | '
            f'{together:.3f} | {theirs / together:.0f} | '
            f'{np.median(puts) * 1e6:.2f} | {np.median(np.max(puts, axis=1)) * 1e6:.0f} | '
            f'{sizes[0]:.0f} / {sizes[1]:.0f} |')


def main():
    """Measure, print and write the table."""
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 40.0
    # As the node does: the writing thread gives the interpreter back sooner.
    sys.setswitchinterval(0.0005)
    rows, blocks = recorded_ticks(round(seconds * 1e9 / TICK_NS))
    text = HEAD.format(rows=len(rows.channels), rounds=ROUNDS, seconds=seconds, burst=BURST)
    with tempfile.TemporaryDirectory() as folder:
        for compression in TYPES:
            text += line(Path(folder), rows, blocks, compression) + '\n'
    print(text, end='')
    Path(__file__).with_suffix('.md').write_text(text, encoding='utf-8')


if __name__ == '__main__':
    main()
