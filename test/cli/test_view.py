# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `view`: what it refuses, and what it warns of."""

import os
import socket

from bag_samples import write_sample
from dynsim_ros.bag.run_sink import RunSink
from dynsim_ros.bag.writer import BagWriter
from dynsim_ros.cli.simulate import main as simulate
from dynsim_ros.cli.view import main, warning_of
from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import Simulator
from dynsim_ros.simulation.offline import OfflineRun
from dynsim_ros.view.recorded_run import check_run, read_run
import numpy as np
import pytest


def error_of(capsys, *arguments):
    """Run the program, which has to refuse; return the one line it gives as the error."""
    assert main(list(map(str, arguments))) == 2
    captured = capsys.readouterr()
    (line,) = captured.err.splitlines()
    assert line.startswith('error: ') and captured.out == ''
    return line


@pytest.mark.parametrize('arguments, reason', [
    ([], 'give FILE, the bag of a recorded run, or --newest or --live'),
    (['run.mcap', '--newest'], '--newest: goes with neither FILE nor --live'),
    (['run.mcap', '--live'], 'FILE and --live: a live run is not a recorded one'),
    (['--live', '-o', 'run.html'], '--output and --live'),
    (['run.mcap', '--simulate'], '--simulate: goes with --live only'),
    (['run.mcap', '--ros-args', '-p', 'rate:=10.0'], '--ros-args: goes with --live only'),
    (['run.mcap', '--scene', 'no_such_scene'], 'no_such_scene')])
def test_options_that_do_not_go_together(capsys, arguments, reason):
    assert reason in error_of(capsys, *arguments)


@pytest.mark.parametrize('name', ['', '/', '/dynsim/', '/9x', '/a b', '/a//b', '~/x', '{x}'])
def test_what_is_no_name_of_a_node(capsys, name):
    assert main(['--live', '--node', name]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("error: --node: '/")
    assert "' is no full name of a node, such as /dynsim: Invalid" in line


def test_what_is_no_bag(capsys, tmp_path):
    path = tmp_path / 'run.mcap'
    assert str(path) in error_of(capsys, path)
    path.write_bytes(b'not a bag')
    assert str(path) in error_of(capsys, path)


def test_bag_of_something_else(capsys, tmp_path):
    path = tmp_path / 'run.mcap'
    with BagWriter(path):
        pass
    assert 'give the scene of the run with --scene' in error_of(capsys, path)
    write_sample(tmp_path / 'other.mcap')
    error = error_of(capsys, tmp_path / 'other.mcap', '--scene', 'sphere_on_spring')
    assert 'holds no pose of sphere' in error


def test_newest_bag(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert 'runs/ holds no bag' in error_of(capsys, '--newest')
    (tmp_path / 'runs').mkdir()
    for number, name in enumerate(('b', 'c', 'a')):
        path = tmp_path / 'runs' / f'{name}.mcap'
        path.write_bytes(b'not a bag')
        os.utime(path, (number, number))
    assert 'runs/a.mcap' in error_of(capsys, '--newest')


def test_port_that_is_taken(capsys, tmp_path):
    path = tmp_path / 'run.mcap'
    path.write_bytes(b'')
    with socket.create_server(('127.0.0.1', 0)) as taken:
        port = taken.getsockname()[1]
        error = error_of(capsys, path, '--host', '127.0.0.1', '--port', port)
    assert f'port {port} of 127.0.0.1 cannot be listened on' in error


def test_host_that_is_not_this_machine(capsys, tmp_path):
    path = tmp_path / 'run.mcap'
    path.write_bytes(b'')
    error = error_of(capsys, path, '--host', '192.0.2.1')
    assert "--host: '192.0.2.1' is no address of this machine" in error


@pytest.mark.parametrize('port', ['0', '65536', 'web', '-1'])
def test_what_is_no_port(capsys, port):
    with pytest.raises(SystemExit) as stopped:
        main(['run.mcap', f'--port={port}'])
    assert stopped.value.code == 2
    assert f"'{port}' is no port: 1 to 65535" in capsys.readouterr().err


@pytest.mark.parametrize('host', ['localhost', '127.0.0.1', '::1', '127.0.0.2'])
def test_this_machine_alone_needs_no_warning(host):
    assert warning_of(host, live=True) is None


@pytest.mark.parametrize('host', ['0.0.0.0', '::', '192.0.2.1', 'lab-pc'])
def test_others_who_can_see_it_are_told_of(host):
    seen, steered = warning_of(host, live=False), warning_of(host, live=True)
    assert f'listening on {host}' in seen and 'no password and no encryption' in seen
    assert 'steer' in steered and 'steer' not in seen


def test_bag_that_is_cut_off_is_shown_as_far_as_it_goes(tmp_path):
    path = tmp_path / 'run.mcap'
    assert simulate(['sphere_on_spring', '-d', '5', '-o', str(path), '-q']) == 0
    path.write_bytes(path.read_bytes()[:path.stat().st_size // 2])
    run = read_run(path, None)
    assert 0.5 < run.end < 4.5
    assert 'the file ends in the middle' in run.problem


def test_topics_under_other_names_are_found(tmp_path):
    simulator = Simulator(load_scene('sphere_on_spring'))
    bag = RunSink(tmp_path / 'run.mcap', simulator, resolve=lambda topic: {
        'sphere/pose': '/robot/pose'}.get(topic, f'/dynsim/{topic}'))
    OfflineRun(simulator, [], bag).run(0.1)
    bag.close()
    check_run(tmp_path / 'run.mcap')
    tables = read_run(tmp_path / 'run.mcap').tables
    assert {'sphere/twist', 'sphere/wrench/net', 'energy'} < tables.keys()
    table = tables['sphere/pose']
    np.testing.assert_array_equal(table.values[-1, :3], simulator.snapshot().position('sphere'))
