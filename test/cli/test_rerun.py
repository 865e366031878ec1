# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `rerun`: what it says, the bags that it writes, its options, its errors."""

import re
import sys

from dynsim_ros.cli.rerun import main
from dynsim_ros.messages.cdr import decode, encode
from dynsim_ros.scene import load_scene
import numpy as np
from plain import environment
import pytest
from recorded import messages, metadata, record, rewritten, script, TICK
from simulated import samples
from tree import output_of

SCENE = load_scene('sphere_on_spring')
POSE = '/dynsim/sphere/pose'
TICKS = 60
PULL = '- {time: 0.3, anchor: hand, position: [0.2, 0, 2]}\n'


@pytest.fixture(scope='module')
def bag(tmp_path_factory):
    """Return the path of a bag of a run with commands of every kind."""
    path = tmp_path_factory.mktemp('rerun') / 'run.mcap'
    record(path, SCENE, TICKS, script('everything', SCENE, TICKS), integrator='rk4', step=0.004)
    return path


def said(capsys, status, *arguments):
    """Run `rerun` and return what it wrote: lines on stdout, or one error on stderr."""
    assert main([str(word) for word in arguments]) == status
    output, errors = capsys.readouterr()
    if status == 2:
        assert output == ''
        (line,) = errors.splitlines()
        return line
    assert errors == ''
    return output.splitlines()


def test_identical(bag, capsys):
    (line,) = said(capsys, 0, bag)
    assert re.fullmatch(r'identical, 91 states \(2 hashes, 11 commands; 0\.6 s lived again in '
                        r'\d+\.\d\d s\)', line)
    assert said(capsys, 0, bag, '--quiet') == []
    (line,) = said(capsys, 0, bag, '--from', '0.1', '--until', '0.2')
    assert line.startswith('identical, 11 states (0 hashes, ')


def test_identical_in_a_process_of_its_own(bag):
    text = output_of([sys.executable, '-m', 'dynsim_ros.cli.rerun', bag], env=environment())
    assert text.startswith('identical, 91 states ')


def test_different(bag, tmp_path, capsys):
    def other(topic, stamp, data):
        if topic != POSE or stamp != 7 * TICK:
            return data
        values = decode('geometry_msgs/msg/PoseStamped', data)
        values['pose']['position']['y'] += 0.25
        return encode('geometry_msgs/msg/PoseStamped', values)

    (line,) = said(capsys, 1, rewritten(bag, tmp_path / 'run.mcap', other))
    assert line.startswith('different from tick 7, 0.07 s: sphere/pose pose.position.y is ')
    assert line.endswith(' m here, a difference of 0.25 m')


def test_a_bag_that_is_cut_off_is_compared_as_far_as_it_goes(bag, tmp_path, capsys):
    path = tmp_path / 'cut.mcap'
    path.write_bytes(bag.read_bytes()[:-700])
    assert main([str(path)]) in (0, 1)
    output, errors = capsys.readouterr()
    assert output.startswith('identical, ')
    assert errors.startswith('warning: ')


def test_a_branch_is_a_bag_that_names_its_parent_and_is_itself_a_run(bag, tmp_path, capsys):
    path = tmp_path / 'stiffer.mcap'
    (line,) = said(capsys, 0, bag, '--from', '0.2', '--until', '1.2', '-o', path, '--set',
                   'spring.stiffness=200', 'gravity=1.62')
    assert line.startswith('branch of run.mcap at tick 20, 0.2 s, until 1.2 s: ')
    assert line.endswith(f' messages in {path}')
    about = metadata(path)
    assert {name: about[name] for name in ('parent', 'parent_epoch', 'parent_tick', 'node')} == {
        'parent': 'run.mcap', 'parent_epoch': '0', 'parent_tick': '20', 'node': '/dynsim'}
    (line,) = said(capsys, 0, path)
    assert line.startswith('identical, ')
    before, after = messages(bag)[POSE], messages(path)[POSE]
    assert min(after) == 20 * TICK and max(after) == 120 * TICK
    assert after[20 * TICK] == before[20 * TICK] and after[22 * TICK] != before[22 * TICK]


def test_commands_of_a_file(bag, tmp_path, capsys):
    commands, paths = tmp_path / 'pull.yaml', [tmp_path / f'{i}.mcap' for i in range(2)]
    commands.write_text(PULL)
    said(capsys, 0, bag, '-c', commands, '-o', paths[0])
    said(capsys, 0, bag, '-c', commands, '--keep-commands', '-o', paths[1])
    given, both = (messages(path)['/dynsim/hand/command'] for path in paths)
    assert [*given] == [30 * TICK]
    assert [*both] == [0, 18 * TICK, 24 * TICK, 30 * TICK]


def test_another_scene(bag, tmp_path, capsys):
    path, none = tmp_path / 'run.mcap', tmp_path / 'none.yaml'
    none.write_text('[]')
    said(capsys, 0, bag, '--from', '0.2', '--scene', 'sphere_on_spring', '-c', none, '-o', path)
    before, after = messages(bag)[POSE], messages(path)[POSE]
    assert after[20 * TICK] == before[20 * TICK] and max(after) == TICKS * TICK


def test_an_error_bar(tmp_path, capsys):
    """The largest differences are those between two runs that are computed here."""
    path, coarse = tmp_path / 'run.mcap', {'integrator': 'rk4', 'step': 0.02}
    record(path, SCENE, TICKS, **coarse)
    lines = said(capsys, 0, path, '--integrator', 'extrapolation', '--tolerance', '1e-10')
    assert lines[0] == ('integrator extrapolation, tolerance 1e-10: largest differences from the '
                        'recorded run in 0.6 s from tick 0 on')
    fine = samples(SCENE, TICKS * 0.01, 100.0, integrator='extrapolation', tolerance=1e-10)[0]
    rough = samples(SCENE, TICKS * 0.01, 100.0, **coarse)[0]
    for quantity, unit, place in (('position', 'm', slice(0, 3)), ('velocity', 'm/s', None)):
        (line,) = [line for line in lines if line.startswith(f'  sphere {quantity} ')]
        size, found_unit, _, when, _ = line.split()[2:]
        assert found_unit == unit
        if place is not None:
            distances = np.linalg.norm((fine - rough)[:, place], axis=1)
            assert float(size) == pytest.approx(distances.max(), rel=0.05)
            assert float(when) == pytest.approx(0.01 * distances.argmax())
    (line,) = [line for line in lines if line.startswith('  energy ')]
    assert 0.0 < float(line.split()[1]) < 0.1
    # of itself there is none
    lines = said(capsys, 0, path, '--step', '0.02')
    assert all(float(line.split()[-5]) == 0.0 for line in lines[1:])
    assert '--tolerance: means nothing to rk4' in said(capsys, 2, path, '--tolerance', '1e-12')


def test_never_overwrites(bag, tmp_path, capsys):
    path = tmp_path / 'mine.mcap'
    path.write_text('mine')
    assert said(capsys, 2, bag, '-o', path) == (
        f'error: {path}: File exists; choose another --output')
    assert path.read_text() == 'mine'


@pytest.mark.parametrize(('arguments', 'error'), [
    (['--from', '7'], 'holds 0 s to 0.6 s of its run, not 7 s'),
    (['--until', '7'], 'holds 0 s to 0.6 s of its run, not 7 s'),
    (['--from', '0.5', '--until', '0.2'], '--until: 0.2 s is not after the beginning'),
    (['--set', 'gravity=1', '--integrator', 'rk4'], '--integrator: tells how far another method'),
    (['--keep-commands'], '--keep-commands: goes with --commands only'),
    (['--set', 'gravity'], "'gravity' is not of the form NAME=VALUE"),
    (['--set', 'gravty=1'], "did you mean 'gravity'?"),
    (['--integrator', 'rk5'], "integrator: 'rk5' is not known; did you mean 'rk4'?"),
    (['--tolerance', '2'], 'tolerance: 2 is out of range'),
    (['--integrator', 'auto', '--step', '0.01'],
     '--step: means nothing to auto, which goes by its tolerance; give --tolerance'),
    (['--from', '0.005', '--until', '0.006'], 'holds no state from 0.005 s to 0.006 s'),
    (['--scene', 'sphere'], "did you mean 'sphere_on_spring'?"),
    (['-c', 'nowhere.yaml'], 'nowhere.yaml: cannot be read'),
    (['--from', '0.6', '--set', 'gravity=1'], '--from: nothing follows 0.6 s')])
def test_what_is_wrong_is_one_line(bag, capsys, arguments, error):
    assert error in said(capsys, 2, bag, *arguments)


def test_files_that_hold_no_run(bag, tmp_path, capsys):
    assert 'No such file' in said(capsys, 2, tmp_path / 'nowhere.mcap')
    text = tmp_path / 'text.mcap'
    text.write_text('text')
    assert str(text) in said(capsys, 2, text)
    other = rewritten(bag, tmp_path / 'other.mcap', without=('dynsim_ros',))
    assert 'holds no run' in said(capsys, 2, other)
