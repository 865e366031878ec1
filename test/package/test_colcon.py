# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The package in a colcon workspace, built in each of colcon's three ways."""

import os
import sys

import pytest
from tree import copy_tree, output_of, outside_environment, ROOT

WAYS = {'isolated': [], 'merged': ['--merge-install'], 'symlinked': ['--symlink-install']}


@pytest.fixture(scope='module', params=WAYS)
def workspace(request, tmp_path_factory):
    """Return a built workspace and the package's prefix in it."""
    folder = tmp_path_factory.mktemp(request.param)
    copy_tree(folder / 'src' / 'dynsim_ros')
    output_of(['colcon', 'build', *WAYS[request.param]], cwd=folder, env=outside_environment())
    merged = request.param == 'merged'
    return folder, folder / 'install' if merged else folder / 'install' / 'dynsim_ros'


def sourced(workspace, command):
    """Run a command in a shell that has sourced the workspace; return what it wrote."""
    script = f'. "{workspace[0]}/install/setup.bash" && {command}'
    # the shell scripts of colcon cannot start a Python that lies in a folder with a space
    variables = outside_environment(COLCON_PYTHON_EXECUTABLE=os.path.realpath(sys.executable))
    return output_of(['bash', '-c', script], cwd='/', env=variables)


def test_is_built_as_an_ament_package(workspace):
    folder, prefix = workspace
    index = prefix / 'share' / 'ament_index' / 'resource_index' / 'packages'
    assert (index / 'dynsim_ros').is_file()
    assert (prefix / 'share' / 'dynsim_ros' / 'package.xml').is_file()
    # colcon takes a package whose package.xml is wrong for plain Python, which has no such hook
    assert list((prefix / 'share' / 'dynsim_ros').rglob('ament_prefix_path.*'))


def test_shares_are_installed_whole(workspace):
    for folder in ('config', 'launch', 'scenes'):
        expected = {path.name for path in (ROOT / folder).iterdir() if path.is_file()}
        installed = workspace[1] / 'share' / 'dynsim_ros' / folder
        assert {path.name for path in installed.iterdir()} == expected != set()


@pytest.mark.parametrize('name', ['sim_node', 'simulate', 'replay', 'view'])
def test_executables_are_where_ros2_run_looks(workspace, name):
    executable = workspace[1] / 'lib' / 'dynsim_ros' / name
    assert os.access(executable, os.X_OK)
    # nor can an executable's own first line, so that it is python3 that starts it here
    help_text = sourced(workspace, f'python3 "{executable}" --help')
    assert help_text.startswith(f'usage: {name}')


def test_finds_its_scenes_in_the_workspace(workspace):
    ask = 'from dynsim_ros.share import share_directory as s; print(s() / "scenes")'
    found = sourced(workspace, f"python3 -c '{ask}'").strip()
    assert found.startswith(str(workspace[0]))
