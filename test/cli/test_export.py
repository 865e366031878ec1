# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `export`: its files as other programs read them, its options, its errors."""

import csv
import json

from bag_samples import sample_messages, write_foreign
from dynsim_ros.bag import load
from dynsim_ros.cli import export, simulate
from dynsim_ros.messages.definitions import definition
from dynsim_ros.scene import read_scene
from mcap.reader import make_reader
from mcap.writer import Writer
from mcap_ros2.decoder import DecoderFactory
import numpy as np
import pytest
import yaml

ENERGIES = ['kinetic', 'gravitational', 'spring', 'total', 'work_damper', 'work_air',
            'work_anchor', 'work_push', 'imbalance']


@pytest.fixture(scope='module')
def bag(tmp_path_factory):
    folder = tmp_path_factory.mktemp('bag')
    (folder / 'commands.yaml').write_text("""
- {time: 0.1, anchor: hand, position: [0.2, 0, 2]}
- {time: 0.2, set: {spring.stiffness: 200, down: [0, 0.1, -1]}}
""")
    path = folder / 'run.mcap'
    assert simulate.main(['sphere_on_spring', '-d', '0.5', '-o', str(path), '-q',
                          '-c', str(folder / 'commands.yaml')]) == 0
    return path


@pytest.fixture(scope='module')
def folder(bag):
    folder = bag.parent / 'tables'
    assert export.main([str(bag), '-o', str(folder), '-q']) == 0
    return folder


def rows(path):
    with path.open(encoding='utf-8', newline='') as file:
        return list(csv.DictReader(file))


def test_a_file_for_each_topic_with_messages(folder):
    wrenches = {f'sphere_wrench_{kind}.csv' for kind in ('spring', 'damper', 'air', 'gravity',
                                                         'net')}
    assert {path.name for path in folder.iterdir()} == {
        'sphere_pose.csv', 'sphere_twist.csv', *wrenches, 'hand_pose.csv', 'energy.csv',
        'epoch.csv', 'hand_command.csv', 'tf.csv', 'state_hash.csv',
        'parameter_group.csv', 'markers.jsonl', 'parameter_command.jsonl',
        'scene.yaml', 'parameters.yaml'}


def test_every_number_reads_back_to_the_same_bits(bag, folder):
    table = rows(folder / 'sphere_pose.csv')
    with open(bag, 'rb') as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        decoded = [(message.log_time, pose) for _, _, message, pose
                   in reader.iter_decoded_messages(topics=['/dynsim/sphere/pose'])]
    for row, (log_ns, message) in zip(table, decoded, strict=True):
        assert round(float(row['time']) * 1e9) == log_ns
        assert (row['header.frame_id'], int(row['header.stamp.nanosec'])) == ('world', log_ns)
        for axis in 'xyz':
            assert float(row[f'pose.position.{axis}']) == getattr(message.pose.position, axis)
        for axis in 'xyzw':
            assert float(row[f'pose.orientation.{axis}']) == getattr(
                message.pose.orientation, axis)
    assert list(table[0])[:5] == ['time', 'header.stamp.sec', 'header.stamp.nanosec',
                                  'header.frame_id', 'pose.position.x']


def test_energies_by_name_as_numpy_reads_them(bag, folder):
    table = np.genfromtxt(folder / 'energy.csv', delimiter=',', names=True)
    run = load(bag)
    assert list(table.dtype.names) == ['time', *ENERGIES]
    assert np.array_equal(table['time'], run.time('energy'))
    for name in ENERGIES:
        assert np.array_equal(table[name], run.energy(name))


def test_what_is_no_table(bag, folder):
    lines = (folder / 'parameter_command.jsonl').read_text(encoding='utf-8').splitlines()
    changed = [json.loads(line) for line in lines]
    assert [(line['time'], line['name']) for line in changed] == [
        (0.2, 'spring.stiffness'), (0.2, 'down')]
    assert changed[0]['value']['double_value'] == 200.0
    run = load(bag)
    assert read_scene(folder / 'scene.yaml') == run.scene
    parameters = yaml.safe_load((folder / 'parameters.yaml').read_text(encoding='utf-8'))
    assert parameters == run.parameters


def test_arrays(bag, tmp_path, capsys):
    assert export.main([str(bag), '-o', str(tmp_path / 'deep' / 'run.npz'), '-q']) == 0
    assert capsys.readouterr() == (
        '', "warning: left out: /dynsim/parameter_command (the length of 'name' varies, "
        'get them one by one by messages())\n')
    arrays, run = np.load(tmp_path / 'deep' / 'run.npz'), load(bag)
    names = [topic.removeprefix('/dynsim/').lstrip('/') for topic in run]
    assert sorted(arrays) == sorted([*names, *(f'{name}/time' for name in names)])
    assert np.array_equal(arrays['sphere/pose/time'], run.time('sphere/pose'))
    assert np.array_equal(arrays['sphere/pose']['pose']['position']['x'],
                          run.position('sphere')[:, 0])
    assert np.array_equal(arrays['energy']['data'][:, 3], run.energy('total'))


def test_what_is_asked_for(bag, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert export.main([str(bag), '--topics', 'sphere/p*', 'energy', '--start', '0.2', '--end',
                        '0.3']) == 0
    assert capsys.readouterr().out == (
        'run: energy.csv, parameters.yaml, scene.yaml, sphere_pose.csv\n')
    assert [float(row['time']) for row in rows(tmp_path / 'run' / 'sphere_pose.csv')] == [
        0.2, 0.21, 0.22, 0.23, 0.24, 0.25, 0.26, 0.27, 0.28, 0.29, 0.3]


def test_a_file_that_is_cut_off(bag, tmp_path, capsys):
    whole = bag.read_bytes()
    (tmp_path / 'cut.mcap').write_bytes(whole[:-400])
    assert export.main([str(tmp_path / 'cut.mcap'), '-o', str(tmp_path / 'out'), '-q']) == 0
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith('warning: the file ends in the middle of a record: ')
    assert len(rows(tmp_path / 'out' / 'sphere_pose.csv')) == 51


def test_names_of_foreign_topics_become_names_of_files(tmp_path):
    topics = ['/a/b', '/a_b', '/../c d', 'ü', '/', '-5']
    with open(tmp_path / 'foreign.mcap', 'wb') as stream:
        writer = Writer(stream)
        writer.start('ros2')
        schema = writer.register_schema('std_msgs/msg/String', 'ros2msg',
                                        definition('std_msgs/msg/String').text.encode())
        for topic in topics:
            channel = writer.register_channel(topic, 'cdr', schema)
            writer.add_message(channel, 0, b'\0\1\0\0\6\0\0\0a,"\nb\0', 0)
        writer.finish()
    assert export.main([str(tmp_path / 'foreign.mcap'), '-o', str(tmp_path / 'out'), '-q']) == 0
    assert sorted(path.name for path in (tmp_path / 'out').iterdir()) == [
        '-5.csv', 'a_b.csv', 'a_b_2.csv', 'c_d.csv', 'topic.csv', 'ü.csv']
    assert rows(tmp_path / 'out' / 'a_b.csv') == [{'time': '0.0', 'data': 'a,"\nb'}]


def test_never_overwrites(bag, tmp_path, capsys):
    for name in ('out', 'run.npz'):
        path = tmp_path / name
        (path / 'mine' if name == 'out' else path).parent.mkdir(exist_ok=True)
        (path / 'mine' if name == 'out' else path).write_text('mine')
        assert export.main([str(bag), '-o', str(path), '-q']) == 2
        assert capsys.readouterr().err.splitlines()[-1] == (
            f'error: {path}: File exists; choose another --output')
    assert (tmp_path / 'out' / 'mine').read_text() == (tmp_path / 'run.npz').read_text() == 'mine'


@pytest.mark.parametrize(('arguments', 'said'), [
    (['nothing.mcap'], 'nothing.mcap: No such file or directory'),
    (['--topics', 'sphere/puse'], "no topic 'sphere/puse' in "),
    (['--start', '2', '--end', '1'], '--start 2 s lies behind --end 1 s'),
    (['--start', '7'], 'holds no message that could be written'),
    (['-o', '/dev/null/x'], '/dev/null/x: Not a directory; choose another --output')])
def test_wrong_arguments(bag, tmp_path, monkeypatch, capsys, arguments, said):
    monkeypatch.chdir(tmp_path)
    given = arguments if arguments[0] == 'nothing.mcap' else [str(bag), *arguments]
    assert export.main(given) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith('error: ') and said in line
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize('value', ['x', 'nan', 'inf', '1e10'])
def test_times_that_are_no_numbers(bag, capsys, value):
    with pytest.raises(SystemExit) as caught:
        export.main([str(bag), '--start', value])
    assert caught.value.code == 2
    assert capsys.readouterr().err == (
        f"error: argument --start: '{value}' is not a number of seconds up to 1e9; "
        'export --help tells what there is\n')


def test_a_bag_of_others(tmp_path):
    write_foreign(tmp_path / 'a.mcap', sample_messages(5))
    assert export.main([str(tmp_path / 'a.mcap'), '-o', str(tmp_path / 'out'), '-q']) == 0
    assert sorted(path.name for path in (tmp_path / 'out').iterdir()) == [
        'sample_epoch.csv', 'sample_pose.csv', 'sample_twist.csv']
