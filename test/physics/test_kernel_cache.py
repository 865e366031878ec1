# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Compiled kernels are kept on disk between processes; where they cannot be, all works as well."""

import json
import os
from pathlib import Path
import shutil
import sys

from dynsim_ros.integrators import adaptive, METHODS
from dynsim_ros.physics.energies import energies
from dynsim_ros.physics.motion import rates
from dynsim_ros.physics.wrenches import wrenches
from plain import environment
import pytest
from tree import output_of, ROOT

SCRIPT = Path(__file__).with_name('use_kernels.py')
KERNELS = {name: method.advance for name, method in METHODS.items() if method.advance is not None}
KERNELS |= {'adaptive': adaptive.advance, 'energies': energies,
            'wrenches': wrenches, 'rates': rates}


def use_kernels(*arguments, script=SCRIPT, **variables):
    found = json.loads(output_of([sys.executable, script, *arguments],
                                 env=environment(**variables)))
    assert found.get('energy', 2.0) == 2.0
    return found


def everything_in(folder):
    return {path: path.stat().st_mtime_ns for path in folder.rglob('*')}


def test_a_second_process_compiles_nothing_and_writes_nothing(tmp_path):
    first = use_kernels(XDG_CACHE_HOME=str(tmp_path))
    assert first['cache'].startswith(str(tmp_path / 'dynsim_ros' / 'kernels'))
    assert (first['hits'], first['misses']) == (0, 1)
    assert list(tmp_path.rglob('*.nbc'))
    before = everything_in(Path(first['cache']))
    second = use_kernels(XDG_CACHE_HOME=str(tmp_path))
    assert (second['hits'], second['misses']) == (1, 0)
    assert everything_in(Path(first['cache'])) == before


def test_only_the_user_can_read_and_write_the_cache(tmp_path):
    cache = Path(use_kernels('import', XDG_CACHE_HOME=str(tmp_path))['cache'])
    for folder in (cache, cache.parent, cache.parent.parent):
        assert folder.stat().st_mode & 0o077 == 0


def test_caches_of_older_sources_are_forgotten(tmp_path):
    old = [tmp_path / 'dynsim_ros' / 'kernels' / f'{number}' for number in range(9)]
    for number, folder in enumerate(old):
        folder.mkdir(parents=True)
        os.utime(folder, (number, number))
    use_kernels('import', XDG_CACHE_HOME=str(tmp_path))
    assert [folder for folder in old if folder.exists()] == old[-3:]


@pytest.mark.parametrize('home', ['/proc/none', 'file', 'relative/home'])
def test_home_that_cannot_be_written_to_is_no_error(tmp_path, home):
    (tmp_path / 'file').touch()
    (tmp_path / 'tmp').mkdir()
    home = str(tmp_path / 'file') if home == 'file' else home
    found = use_kernels('import', XDG_CACHE_HOME=home, HOME=home, TMPDIR=str(tmp_path / 'tmp'))
    assert found['cache'].startswith(str(tmp_path / 'tmp' / 'dynsim_ros-'))
    assert not Path('relative').exists()


def test_no_place_to_write_at_all_is_no_error(tmp_path):
    """There is then no folder for temporary files either; what is compiled is not kept."""
    found = use_kernels('nowhere', XDG_CACHE_HOME=str(tmp_path), HOME=str(tmp_path))
    assert found['cache'] == 'None'
    assert not [path for path in tmp_path.rglob('*') if path.is_file()]


def test_read_only_installation_is_no_error_and_is_not_written_to(tmp_path):
    """Root can write anywhere: that it did not is seen from the folders' times."""
    site = tmp_path / 'site'
    shutil.copytree(ROOT / 'dynsim_ros', site / 'dynsim_ros',
                    ignore=shutil.ignore_patterns('__pycache__'))
    script = shutil.copy(SCRIPT, tmp_path)
    folders = [site, *(path for path in site.rglob('*') if path.is_dir())]
    for folder in folders:
        folder.chmod(0o555)
    before = everything_in(site)
    try:
        found = use_kernels(script=script, XDG_CACHE_HOME=str(tmp_path / 'cache'),
                            PYTHONPATH=str(site), PYTHONDONTWRITEBYTECODE='1')
        assert found['package'].startswith(str(site))
        assert found['cache'].startswith(str(tmp_path / 'cache'))
        assert everything_in(site) == before
    finally:
        for folder in folders:
            folder.chmod(0o755)


@pytest.mark.parametrize('name', KERNELS)
def test_fastmath_is_off(name):
    assert KERNELS[name].targetoptions['fastmath'] is False
