# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The style of ROS 2, by flake8 set up as ament_flake8 is, and by ruff where it is installed."""

import hashlib
import importlib.util
import subprocess
import sys

import pytest
from tree import python_files, ROOT

# Where pytest keeps, between runs, what flake8 has found nothing in.
KEPT = 'dynsim_ros/clean'


def lint(*command):
    """Run a linter in the tree; return what it wrote if all is well, else fail with it."""
    done = subprocess.run(
        [sys.executable, '-m', *command], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope='module')
def version():
    """Return what flake8 tells of itself, of its plugins and of the Python."""
    return lint('flake8', '--version')


@pytest.fixture
def digest(version):
    """Return a function of a file: all that what flake8 says of it depends on, as a digest."""
    rules = version.encode() + (ROOT / '.flake8').read_bytes()
    return lambda path: hashlib.sha256(rules + path.read_bytes()).hexdigest()


def test_flake8(digest, pytestconfig):
    """It takes half a minute for all files; those that it has liked as they are wait."""
    kept = getattr(pytestconfig, 'cache', None)
    clean = set(kept.get(KEPT, [])) if kept else set()
    digests = {path: digest(path) for path in python_files()}
    changed = [path for path, found in digests.items() if found not in clean]
    if changed:
        lint('flake8', *map(str, changed))
    if kept:
        kept.set(KEPT, sorted(digests.values()))


@pytest.mark.skipif(not importlib.util.find_spec('ruff'), reason='ruff is not installed')
def test_ruff():
    lint('ruff', 'check', '--no-cache', '--quiet')


def test_flake8_has_the_plugins_of_ament(version):
    for plugin in ('builtins', 'comprehensions', 'docstrings', 'import-order', 'quotes'):
        assert plugin in version.replace('_', '-'), plugin
