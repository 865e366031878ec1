# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The style of ROS 2, by flake8 set up as ament_flake8 is, and by ruff where it is installed."""

import importlib.util
import subprocess
import sys

import pytest
from tree import ROOT

LINTERS = [name for name in ('flake8', 'ruff') if importlib.util.find_spec(name)]


@pytest.mark.parametrize('linter', LINTERS)
def test_style(linter):
    command = {'flake8': ['flake8'], 'ruff': ['ruff', 'check', '--no-cache', '--quiet']}[linter]
    done = subprocess.run(
        [sys.executable, '-m', *command], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_flake8_has_the_plugins_of_ament():
    done = subprocess.run(
        [sys.executable, '-m', 'flake8', '--version'], capture_output=True, text=True, check=True)
    for plugin in ('builtins', 'comprehensions', 'docstrings', 'import-order', 'quotes'):
        assert plugin in done.stdout.replace('_', '-'), plugin
