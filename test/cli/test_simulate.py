# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `simulate`: the bag that it writes, its options, its errors."""

import signal
import subprocess
import sys

from dynsim_ros.cli.simulate import main
from dynsim_ros.scene import load_scene, scene_names, with_values
from dynsim_ros.scene.yaml_file import parse_scene
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
import pytest

COMMANDS = """
- {time: 0.1, anchor: hand, position: [0.2, 0, 2]}
- {time: 0.2, body: sphere, force: [0, 5, 0]}
- {time: 0.3, set: {spring.stiffness: '2e2', gravity: 1.62}}
"""


def bag(path):
    """Return {topic: [(log time, decoded message)]} and {name: attachment}, as mcap reads them."""
    with open(path, 'rb') as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        found = {}
        for _, channel, message, decoded in reader.iter_decoded_messages():
            assert message.log_time == message.publish_time
            found.setdefault(channel.topic, []).append((message.log_time, decoded))
        return found, {item.name: item.data for item in reader.iter_attachments()}


@pytest.mark.parametrize('scene', scene_names())
def test_every_scene(tmp_path, scene):
    path = tmp_path / 'run.mcap'
    assert main([scene, '--duration', '0.5', '-o', str(path), '--quiet']) == 0
    found, attachments = bag(path)
    body = load_scene(scene).bodies[0].name
    assert [time for time, _ in found[f'/dynsim/{body}/pose']] == list(
        range(0, 500_000_001, 10_000_000))
    assert parse_scene(attachments['scene.yaml'].decode()) == load_scene(scene)


def test_commands_and_values(tmp_path):
    path, commands = tmp_path / 'run.mcap', tmp_path / 'commands.yaml'
    commands.write_text(COMMANDS)
    assert main(['sphere_on_spring', '-d', '0.5', '-o', str(path), '-c', str(commands), '-q',
                 '--set', 'rate=1000', 'sphere.position=[0.1,0,1.2]', '--set', 'gravity=9.8']) == 0
    found, attachments = bag(path)
    assert len(found['/dynsim/sphere/pose']) == 501
    first = found['/dynsim/sphere/pose'][0][1].pose.position
    assert (first.x, first.y, first.z) == (0.1, 0.0, 1.2)
    assert parse_scene(attachments['scene.yaml'].decode()) == with_values(
        load_scene('sphere_on_spring'), {'sphere.position': (0.1, 0, 1.2), 'gravity': 9.8})
    ((time, moved),) = found['/dynsim/hand/command']
    assert (time, moved.point.x) == (100_000_000, 0.2)
    ((time, pushed),) = found['/dynsim/sphere/wrench_command']
    assert (time, pushed.wrench.force.y) == (200_000_000, 5.0)
    # a number that YAML takes for a text is recorded as the number that it means
    assert [(time, change.name, change.value.type, change.value.double_value)
            for time, change in found['/dynsim/parameter_command']] == [
        (300_000_000, 'spring.stiffness', 3, 200.0), (300_000_000, 'gravity', 3, 1.62)]
    weight = {time: message.wrench.force.z
              for time, message in found['/dynsim/sphere/wrench/gravity']}
    assert weight[300_000_000] == -9.8 and weight[301_000_000] == -1.62


def test_commands_behind_the_end_are_told(tmp_path, capsys):
    commands = tmp_path / 'commands.yaml'
    commands.write_text('- {time: 7, anchor: hand, position: [0, 0, 2]}')
    assert main(['sphere_on_spring', '-d', '0.1', '-o', str(tmp_path / 'run.mcap'), '-c',
                 str(commands)]) == 0
    assert '1 commands lie at the end or behind it' in capsys.readouterr().out


def test_never_overwrites(tmp_path, capsys):
    path = tmp_path / 'run.mcap'
    path.write_text('mine')
    assert main(['spinning_box', '-o', str(path), '-q']) == 2
    assert capsys.readouterr().err == f'error: {path}: File exists; choose another --output\n'
    assert path.read_text() == 'mine'


@pytest.mark.parametrize(('arguments', 'said'), [
    (['sphere'], "scene 'sphere' is not known; did you mean 'sphere_on_spring'?"),
    (['nowhere/x.yaml'], 'nowhere/x.yaml: cannot be read: No such file or directory'),
    (['spinning_box', '--set', 'box.mas=1'], "did you mean 'box.mass'?"),
    (['spinning_box', '--set', 'box.mass=-1'],
     'box.mass: -1 kg is out of range: 1e-09 to 1e+06 kg'),
    (['spinning_box', '--set', 'box.mass'], "'box.mass' is not of the form NAME=VALUE"),
    (['spinning_box', '--set', 'box.mass=!!timestamp x'],
     'box.mass=!!timestamp x: is not valid YAML'),
    (['spinning_box', '--set', 'box.mass=[1'], 'is not valid YAML'),
    (['spinning_box', '--set', 'box.mass=1', 'box.mass=2'], 'box.mass is set twice'),
    (['spinning_box', '--set', 'box.orientation=[0.5, 0, 0, 0]'],
     'box.orientation: x, y, z, w [0.5, 0.0, 0.0, 0.0] is no orientation: its norm is 0.5'),
    (['spinning_box', '--set', 'rate=0'], 'rate: 0 Hz is out of range'),
    (['spinning_box', '-c', 'nowhere.yaml'], 'nowhere.yaml: cannot be read'),
    (['spinning_box', '-o', '/dev/null/x.mcap'],
     '/dev/null: File exists; choose another --output')])
def test_wrong_arguments(tmp_path, monkeypatch, capsys, arguments, said):
    monkeypatch.chdir(tmp_path)
    assert main([*arguments, '-q']) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith('error: ') and said in line
    assert not list(tmp_path.rglob('*.mcap'))


def test_a_wrong_command_is_told_before_the_run(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    commands = tmp_path / 'commands.yaml'
    commands.write_text('- {time: 0.1, set: {gravity: 1}}\n- {time: 0.2, set: {gravty: 1}}')
    assert main(['sphere_on_spring', '-c', 'commands.yaml', '-q']) == 2
    assert capsys.readouterr().err == (
        "error: commands.yaml: command 2: 'gravty' is no quantity of this scene and no setting; "
        "did you mean 'gravity'?\n")
    assert not list(tmp_path.rglob('*.mcap'))


def test_a_name_that_is_no_file_name_stays_in_the_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'odd.yaml').write_text(
        "name: '../../over there'\nbodies: {p: {shape: particle, mass: 1}}")
    assert main(['./odd.yaml', '-d', '0.1', '-q', '--set', 'integrator=rk4']) == 0
    (path,) = tmp_path.rglob('*.mcap')
    assert path.parent == tmp_path / 'runs' and path.name.startswith('_over_there_')


def test_divergence(tmp_path, capsys):
    path = tmp_path / 'run.mcap'
    assert main(['sphere_on_spring', '-o', str(path), '-q', '--set', 'integrator=explicit_euler',
                 'step=0.5', 'spring.stiffness=1e8']) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("error: the motion of 'sphere' is no longer finite between")
    found, _ = bag(path)
    assert found['/dynsim/sphere/pose']


def begun(path, *options):
    """Return a process that simulates for very long, once its bag grows."""
    process = subprocess.Popen(
        [sys.executable, '-m', 'dynsim_ros.cli.simulate', 'spinning_box', '-d', '1e6', '-o', path,
         *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while not (path.exists() and path.stat().st_size > 100_000):
        assert process.poll() is None
    return process


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_signals_leave_a_finished_bag(tmp_path, number):
    path = tmp_path / 'run.mcap'
    process = begun(path)
    # however often one asks
    while process.poll() is None:
        process.send_signal(number)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, err) == (130, '')
    assert 'messages in' in out.splitlines()[-1]
    found, _ = bag(path)
    assert found['/dynsim/box/pose']


def test_a_signal_at_the_start_ends_it_quietly(tmp_path):
    for milliseconds in (100, 200, 300, 400):
        with pytest.raises(subprocess.TimeoutExpired):
            process = subprocess.Popen(
                [sys.executable, '-m', 'dynsim_ros.cli.simulate', 'spinning_box', '-d', '1e6',
                 '-q', '-o', tmp_path / f'{milliseconds}.mcap'], stderr=subprocess.PIPE, text=True)
            process.communicate(timeout=milliseconds / 1000)
        process.terminate()
        _, err = process.communicate(timeout=60)
        assert (process.returncode in (130, -signal.SIGTERM), err) == (True, '')


def test_nobody_looks_any_more(tmp_path):
    path = tmp_path / 'run.mcap'
    process = subprocess.Popen(
        [sys.executable, '-m', 'dynsim_ros.cli.simulate', 'spinning_box', '-d', '1', '-o', path],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    process.stdout.close()
    assert (process.stderr.read(), process.wait(60)) == ('', 0)
    found, _ = bag(path)
    assert len(found['/dynsim/box/pose']) == 101


def test_estimated_error_is_told_also_quietly(tmp_path, capsys):
    path = str(tmp_path / 'run.mcap')
    assert main(['particle_on_spring', '-d', '1', '-o', path, '-q', '-e']) == 0
    assert capsys.readouterr().out.startswith('error at the end, estimated: position ')


def test_no_error_can_be_estimated_of_the_shortest_steps(tmp_path, capsys):
    assert main(['particle_on_spring', '-d', '1e-3', '-o', str(tmp_path / 'run.mcap'), '-q', '-e',
                 '--set', 'integrator=rk4', 'step=1e-7', 'rate=1000']) == 2
    assert capsys.readouterr().err == (
        'error: --error: nothing more exact to compare the run with: half of the step 1e-07 s '
        'would be below 1e-07 s, the shortest one\n')
