# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The package as pip installs it, from a source distribution that is built first."""

import sys
import sysconfig

from dynsim_ros.scene import Particle, Scene
import pytest
from recorded import record
from tree import copy_tree, output_of, outside_environment, ROOT


@pytest.fixture(scope='module')
def prefix(tmp_path_factory):
    """Return the folder that the package was installed to."""
    folder = tmp_path_factory.mktemp('pip')
    tree = copy_tree(folder / 'tree')
    build = 'import setuptools.build_meta as b; b.build_sdist("../dist")'
    output_of([sys.executable, '-c', build], cwd=tree, env=outside_environment())
    (archive,) = (folder / 'dist').iterdir()
    output_of(
        [sys.executable, '-m', 'pip', 'install', '--quiet', '--no-deps', '--no-build-isolation',
         '--ignore-installed', '--no-index', '--prefix', folder / 'prefix', archive],
        cwd=folder, env=outside_environment())
    return folder / 'prefix'


@pytest.fixture
def environment(prefix):
    site = sysconfig.get_path('purelib', vars={'base': str(prefix), 'platbase': str(prefix)})
    others = outside_environment().get('PYTHONPATH', '')
    return outside_environment(PYTHONPATH=f'{site}:{others}' if others else site)


def test_shares_are_installed_whole(prefix):
    share = prefix / 'share' / 'dynsim_ros'
    assert (share / 'package.xml').is_file()
    for folder in ('config', 'launch', 'scenes'):
        expected = {path.name for path in (ROOT / folder).iterdir() if path.is_file()}
        installed = {path.name for path in (share / folder).iterdir() if path.is_file()}
        assert installed == expected != set()


def test_ament_marker_is_installed(prefix):
    index = prefix / 'share' / 'ament_index' / 'resource_index' / 'packages'
    assert (index / 'dynsim_ros').is_file()


@pytest.mark.parametrize('name', ['export', 'plot', 'replay', 'rerun', 'sim_node', 'simulate',
                                  'view'])
def test_executables_are_in_bin_and_start(prefix, environment, name):
    help_text = output_of([prefix / 'bin' / name, '--help'], cwd='/', env=environment)
    assert help_text.startswith(f'usage: {name}')
    assert not (prefix / 'lib' / 'dynsim_ros').exists()


def test_a_run_is_lived_again_by_another_installation(prefix, environment, tmp_path):
    """From the bag alone, with kernels that this installation compiles for itself."""
    scene = Scene(gravity=9.81, bodies=(Particle(name='stone', mass=2.0, velocity=(1, 2, 3)),))
    record(tmp_path / 'run.mcap', scene, 50, integrator='explicit_euler')
    caches = tmp_path / 'caches'
    caches.mkdir()
    said = output_of([prefix / 'bin' / 'rerun', 'run.mcap'], cwd=tmp_path,
                     env=environment | {'XDG_CACHE_HOME': str(caches)})
    assert said.startswith('identical, 51 states ')
    assert [*(caches / 'dynsim_ros' / 'kernels').rglob('*.nbi')]


def test_finds_its_scenes(prefix, environment):
    ask = 'from dynsim_ros.share import share_directory; print(share_directory())'
    found = output_of([sys.executable, '-c', ask], cwd='/', env=environment).strip()
    assert found == str(prefix / 'share' / 'dynsim_ros')


def test_tests_are_not_installed(prefix):
    tops = {path.parent.name for path in prefix.rglob('__init__.py')}
    assert 'dynsim_ros' in tops
    assert not {'test', 'package'} & tops


def test_definitions_that_ros_on_pypi_lacks_are_installed(environment):
    ask = ('from dynsim_ros.messages.definitions import definition; '
           'print(definition("tf2_msgs/msg/TFMessage").type_hash)')
    assert output_of([sys.executable, '-c', ask], cwd='/', env=environment).startswith('RIHS01_')
