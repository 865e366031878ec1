# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bags of any writer as arrays, beside what the message-wise readers make of them."""

import sys

from bag_samples import KINDS_OF_MCAP, sample_messages, TOPICS, write_foreign, write_sample
from dynsim_ros.bag import load
from dynsim_ros.bag.reader import BagError, open_bag
from dynsim_ros.messages.cdr import decode
from dynsim_ros.messages.definitions import definition
from dynsim_ros.messages.qos import LATCHED, Qos
from loaded import plain
from mcap.writer import CompressionType
import numpy as np
import pytest
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
import yaml


def content(run):
    """Return {topic: [(log time, message as nested dict)]} of the arrays of a run."""
    return {topic: list(zip(run.time_ns(topic).tolist(), map(plain, values), strict=True))
            for topic, values in run.items()}


def expected(messages):
    """Return the same of (topic, time, CDR bytes), in order of time."""
    found = {}
    for topic, stamp, data in sorted(messages, key=lambda message: message[1]):
        found.setdefault(topic, []).append((stamp, decode(TOPICS[topic][0], data)))
    return found


@pytest.mark.parametrize('compression', list(CompressionType))
@pytest.mark.parametrize('options', KINDS_OF_MCAP, ids=str)
def test_any_kind_of_mcap(tmp_path, options, compression):
    messages = sample_messages(50)
    write_foreign(tmp_path / 'a.mcap', messages, compression=compression, **options)
    run = load(tmp_path / 'a.mcap')
    assert content(run) == expected(messages)
    assert (run.problem, run.left_out) == (None, {})


@pytest.mark.parametrize('mode', list(CompressionMode))
def test_rosbags_folders(tmp_path, mode):
    messages = sample_messages()
    writer = Writer(tmp_path / 'bag', version=9, storage_plugin=StoragePlugin.MCAP)
    writer.set_compression(mode, CompressionFormat.ZSTD)
    with writer:
        connections = {topic: writer.add_connection(
            topic, type_name, msgdef=definition(type_name).text,
            rihs01=definition(type_name).type_hash) for topic, (type_name, _) in TOPICS.items()}
        for topic, stamp, data in messages:
            writer.write(connections[topic], stamp, data)
    assert content(load(tmp_path / 'bag')) == expected(messages)


def test_folder_of_several_files(tmp_path):
    messages = sample_messages(30)
    names = ['b.mcap', 'a.mcap', 'c.mcap']
    for name, part in zip(names, (messages[:20], messages[20:45], messages[45:])):
        write_foreign(tmp_path / name, part)
    (tmp_path / 'metadata.yaml').write_text(yaml.safe_dump({'rosbag2_bagfile_information': {
        'version': 9, 'storage_identifier': 'mcap', 'relative_file_paths': names,
        'compression_format': '', 'compression_mode': ''}}))
    assert content(load(tmp_path)) == expected(messages)


@pytest.mark.parametrize('chunking', [True, False])
def test_disorder_and_several_channels_of_a_topic(tmp_path, chunking):
    messages = sample_messages(60)
    mixed = messages[70:90] + messages[::2] + messages[1::2][::-1]
    write_foreign(tmp_path / 'a.mcap', mixed,
                  [LATCHED.offered_qos_profiles(), Qos().offered_qos_profiles()],
                  use_chunking=chunking)
    assert content(load(tmp_path / 'a.mcap')) == expected(mixed)


def test_no_message_costs_python_calls(tmp_path):
    counts = []
    for number, count in enumerate((100, 100, 2000)):
        path = tmp_path / f'{number}.mcap'
        write_sample(path, count)
        calls = 0

        def profile(_, event, _argument):
            nonlocal calls
            calls += event in ('call', 'c_call')

        sys.setprofile(profile)
        try:
            run = load(path)
        finally:
            sys.setprofile(None)
        assert len(run['pose']) == count
        counts.append(calls)
    # The first one loads what was compiled. The last one has more messages, by 3800, and chunks.
    assert counts[2] - counts[1] < 380


def test_what_is_asked_for(tmp_path):
    messages = write_sample(tmp_path / 'a.mcap', chunk_size=3000)
    run = load(tmp_path / 'a.mcap', topics=['/sample/p*', 'twist'], start=0.1, end=0.2)
    assert content(run) == expected(message for message in messages if message[0] in (
        '/sample/pose', '/sample/twist') and 100_000_000 <= message[1] <= 200_000_000)
    with pytest.raises(KeyError, match='is no array of messages: they were not asked for'):
        run['epoch']
    assert list(load(tmp_path / 'a.mcap', topics='pose')) == ['/sample/pose']
    late = load(tmp_path / 'a.mcap', start=0.5)
    with pytest.raises(KeyError, match='is no array of messages: there are none'):
        late['epoch']
    assert np.array_equal(late.time('pose'), np.arange(50, 100) / 100)


def test_times_of_others_begin_with_their_first_message(tmp_path):
    begin = 1_700_000_000_123_456_789
    write_foreign(tmp_path / 'a.mcap', [
        (topic, stamp + begin, data) for topic, stamp, data in sample_messages(30)])
    run = load(tmp_path / 'a.mcap', start=0.1)
    assert np.array_equal(run.time('pose'), np.arange(10, 30) / 100)
    assert run.time_ns('pose')[0] == begin + 100_000_000


def test_every_cut_gives_what_lies_before_it(tmp_path):
    path = tmp_path / 'cut.mcap'
    write_sample(path, chunk_size=3000)
    whole = path.read_bytes()
    for end in [*range(8, len(whole), 1999), len(whole) - 9, len(whole) - 8]:
        path.write_bytes(whole[:end])
        with open_bag(path) as bag:
            messages = list(bag.messages())
            problem = bag.problem
        run = load(path)
        assert content(run) == expected(messages)
        assert run.problem == problem
        # the last eight bytes say that it is whole: where they alone lack, nothing does
        assert (problem is not None) == (end < len(whole) - 8)


def test_a_damaged_chunk_is_left_out(tmp_path):
    path = tmp_path / 'a.mcap'
    write_sample(path, chunk_size=3000)
    whole = path.read_bytes()
    middle = whole.find(b'zstd', whole.find(b'zstd') + 1) + 60
    path.write_bytes(whole[:middle] + bytes(8) + whole[middle + 8:])
    with open_bag(path) as bag:
        messages = list(bag.messages())
        problem = bag.problem
    run = load(path)
    assert content(run) == expected(messages) and 0 < len(run['pose']) < 100
    assert run.problem == problem


@pytest.mark.parametrize('size', [1, 30])
def test_records_that_do_not_fit_their_chunk(tmp_path, size):
    path = tmp_path / 'a.mcap'
    messages = sample_messages(2)[:2]
    write_foreign(path, messages, compression=CompressionType.NONE, enable_crcs=False,
                  chunk_size=10 ** 6)
    whole = path.read_bytes()
    pose = whole.find(messages[1][2]) - 30
    path.write_bytes(whole[:pose] + size.to_bytes(8, 'little') + whole[pose + 8:])
    run = load(path)
    assert content(run) == expected(messages[:1])
    assert run.problem == ('the chunk at byte 138 is damaged (its records do not fit): not all '
                           'messages could be read')


def test_names_that_are_not_there(tmp_path):
    write_sample(tmp_path / 'a.mcap')
    run = load(tmp_path / 'a.mcap')
    assert 'pose' in run and 'puse' not in run and len(run) == 3
    with pytest.raises(KeyError) as caught:
        run['/sample/puse']
    assert str(caught.value) == (f"no topic '/sample/puse' in {run.path}; did you mean "
                                 "'/sample/pose'?")
    with pytest.raises(BagError, match=r"no topic '/a\*' in .*: it has /sample/epoch, "):
        load(tmp_path / 'a.mcap', topics=['/a*'])
    with pytest.raises(BagError, match='No such file'):
        load(tmp_path / 'b.mcap')
    write_foreign(tmp_path / 'foreign.mcap', sample_messages(1))
    with pytest.raises(BagError, match='holds no scene'):
        _ = load(tmp_path / 'foreign.mcap').scene
