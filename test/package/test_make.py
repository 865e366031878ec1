# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The Makefile on machines that lack what it needs."""

import os
from pathlib import Path
import shutil
import subprocess

import pytest
from tree import ROOT


@pytest.fixture
def machine(tmp_path):
    """Return a function that runs make in a bare tree, on a PATH with chosen Pythons."""
    tree, programs = tmp_path / 'a tree', tmp_path / 'bin'
    (tree / 'tools').mkdir(parents=True)
    programs.mkdir()
    shutil.copy(ROOT / 'Makefile', tree)
    for name in ('setup.py', 'setup.cfg', 'pyproject.toml', 'tools/set_up', 'tools/in_venv'):
        shutil.copy(ROOT / name, tree / name)
    # the system's own Python must not come to the rescue
    set_up = tree / 'tools' / 'set_up'
    set_up.write_text(set_up.read_text().replace(' /usr/bin/python3', ''))
    for name in ('cat', 'dirname', 'echo', 'make', 'rm', 'sh', 'touch'):
        (programs / name).symlink_to(shutil.which(name))

    def run(*arguments, pythons=None, **variables):
        for name, script in (pythons or {}).items():
            Path(programs, name).write_text(f'#!/bin/sh\n{script}\n')
            Path(programs, name).chmod(0o755)
        return subprocess.run(
            ['make', *arguments], cwd=tree, capture_output=True, text=True, check=False,
            timeout=60, env={'PATH': str(programs), 'HOME': str(tmp_path), **variables})

    return run


def python_that_says(version, lacks='nothing'):
    """Return a script that answers what set_up asks of a python, by what its question contains."""
    major, minor, _ = version.split('.')
    fits = (3, 10) <= (int(major), int(minor)) <= (3, 13)
    return (f'case "$2" in *{lacks}*) exit 1 ;; *python_version*) echo {version} ;;'
            f' *implementation*) exit {int(not fits)} ;;'
            f' *-venv*) echo python{major}.{minor}-venv ;; *rclpy*) exit 1 ;; esac')


def error_of(done):
    """Return the one line of explanation; the line after it is make's own."""
    assert done.returncode == 2
    lines = done.stderr.splitlines()
    assert len(lines) == 2, done.stderr
    assert lines[0].startswith('error: ')
    return lines[0]


@pytest.mark.parametrize('version', ['3.9.18', '3.14.0', '2.7.18'])
def test_unfit_python_is_named(machine, version):
    error = error_of(machine('run', pythons={'python3': python_that_says(version)}))
    assert f'python3 is {version}, but Python 3.10 to 3.13 (CPython) is needed' in error
    assert 'make PYTHON=' in error


def test_no_python(machine):
    assert 'python3 was not found' in error_of(machine('run'))


def test_python_that_was_chosen_is_not_there(machine):
    assert '/no/python was not found' in error_of(machine('run', 'PYTHON=/no/python'))


def test_missing_ensurepip_has_its_remedy(machine):
    done = machine('run', pythons={'python3': python_that_says('3.12.3', lacks='ensurepip')})
    assert 'apt install python3.12-venv' in error_of(done)


def test_another_python_is_tried_where_python3_does_not_fit(machine):
    fitting = python_that_says('3.12.3') + '\n[ "$2" != venv ] || { echo chosen; exit 1; }'
    done = machine('run', pythons={
        'python3': python_that_says('3.9.18'), 'python3.12': fitting})
    assert 'Python 3.12.3' in done.stdout
    assert 'chosen' in done.stdout
    assert 'could not make .venv with python3.12' in error_of(done)


def test_sourced_ros_that_python_cannot_import_is_told(machine):
    done = machine('run', ROS_DISTRO='jazzy')
    assert 'python3 cannot import its rclpy: using the packages from PyPI' in done.stdout


def test_help_is_the_default_and_sets_nothing_up(machine):
    done = machine()
    assert done.returncode == 0
    for target in ('run', 'view', 'live', 'test', 'test-browser', 'test-readers', 'lint', 'clean'):
        assert f'make {target} ' in done.stdout


PROFILE = 'a tree/config/fastdds_one_machine.xml'


@pytest.mark.parametrize('variables, file', [
    ({}, PROFILE), ({'FASTRTPS_DEFAULT_PROFILES_FILE': ''}, PROFILE),
    ({'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST'}, PROFILE),
    ({'FASTRTPS_DEFAULT_PROFILES_FILE': '/own.xml'}, '/own.xml'),
    ({'FASTDDS_DEFAULT_PROFILES_FILE': '/own.xml'}, ''),
    ({'ROS_AUTOMATIC_DISCOVERY_RANGE': 'SUBNET'}, ''), ({'ROS_STATIC_PEERS': '192.0.2.7'}, '')])
def test_profile_for_one_machine_unless_something_else_is_wanted(machine, variables, file):
    show = '--eval=show: ; @echo "=$$FASTRTPS_DEFAULT_PROFILES_FILE"'
    shown = machine(show, 'show', **variables).stdout.strip()
    assert shown.startswith('=') and shown.endswith(file), shown
    assert (shown == '=') == (file == '')


def test_in_venv_without_one(tmp_path):
    (tmp_path / 'tools').mkdir()
    shutil.copy(ROOT / 'tools' / 'in_venv', tmp_path / 'tools')
    done = subprocess.run(
        [tmp_path / 'tools' / 'in_venv', 'true'], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert done.stderr == 'error: there is no .venv yet: `make run` or `make test` makes it\n'


def test_scripts_are_executable():
    for name in ('tools/set_up', 'tools/set_up_readers', 'tools/in_venv', '.ci/run'):
        assert os.access(ROOT / name, os.X_OK), name


CONTAMINATED = {
    '_ROS_WHEELS_BOOTSTRAP_COMPLETE': '1', 'LD_LIBRARY_PATH': '/other/lib', 'PYTHONPATH': '/other',
    'RMW_IMPLEMENTATION': 'rmw_other_cpp', 'AMENT_PREFIX_PATH': '/other', 'PATH': os.defpath}


@pytest.fixture
def variables_in_venv(tmp_path):
    """Return a function that tells what a program in .venv sees, with a given kind of ROS."""
    (tmp_path / 'tools').mkdir()
    (tmp_path / '.venv').mkdir()
    shutil.copy(ROOT / 'tools' / 'in_venv', tmp_path / 'tools')

    def variables(ros):
        (tmp_path / '.venv' / 'ros').write_text(ros)
        done = subprocess.run(
            [tmp_path / 'tools' / 'in_venv', 'env'], capture_output=True, text=True, check=True,
            env=CONTAMINATED)
        return dict(line.split('=', 1) for line in done.stdout.splitlines())

    return variables


def test_wheels_are_kept_apart_from_any_other_ros(variables_in_venv, tmp_path):
    seen = variables_in_venv('wheels')
    assert seen['AMENT_PREFIX_PATH'] == str(tmp_path / '.venv')
    assert seen['PATH'].startswith(f'{tmp_path}/.venv/bin:')
    for name in ('_ROS_WHEELS_BOOTSTRAP_COMPLETE', 'LD_LIBRARY_PATH', 'PYTHONPATH',
                 'RMW_IMPLEMENTATION'):
        assert name not in seen


def test_sourced_ros_is_left_as_it_is(variables_in_venv, tmp_path):
    seen = variables_in_venv('sourced')
    for name in ('LD_LIBRARY_PATH', 'RMW_IMPLEMENTATION', 'AMENT_PREFIX_PATH'):
        assert seen[name] == CONTAMINATED[name]
    assert seen['PYTHONPATH'] == f'{tmp_path}:/other'
