# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Fixtures: a recorded run, and viewers, which do not outlive the module that starts them."""

from dynsim_ros.cli.simulate import main as simulate
import pytest
from view_process import ViewProcess


@pytest.fixture(scope='session')
def bag(tmp_path_factory):
    """Return the path of a recorded run of 2 s at 200 Hz."""
    path = tmp_path_factory.mktemp('run') / 'run.mcap'
    assert simulate(['sphere_on_spring', '--duration', '2', '--set', 'rate=200', '--quiet',
                     '--output', str(path)]) == 0
    return path


@pytest.fixture(scope='module')
def view(tmp_path_factory):
    """Give a function that starts the viewer, which does not outlive the module."""
    started = []

    def view(*arguments):
        started.append(ViewProcess(tmp_path_factory.mktemp('view'), *arguments))
        return started[-1]

    yield view
    for process in started:
        process.kill()
