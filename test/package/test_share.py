# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
from pathlib import Path
import shutil
import subprocess
import sys

import dynsim_ros
from dynsim_ros.share import share_directory
import pytest
from tree import outside_environment, ROOT

PACKAGE = Path(dynsim_ros.__file__).parent
ASK = 'from dynsim_ros.share import share_directory; print(share_directory())'


def ask(package_folder, **variables):
    """Run share_directory() with the package found in a folder."""
    return subprocess.run(
        [sys.executable, '-c', ASK], capture_output=True, text=True, check=False, cwd='/',
        env=outside_environment(PYTHONPATH=package_folder, **variables))


def place(folder):
    """Put the two files that finding needs into a folder, as an installation would."""
    (folder / 'dynsim_ros').mkdir(parents=True)
    for name in ('__init__.py', 'share.py'):
        shutil.copy(PACKAGE / name, folder / 'dynsim_ros')
    return folder


def scenes(prefix):
    share = prefix / 'share' / 'dynsim_ros'
    (share / 'scenes').mkdir(parents=True)
    return share


def test_source_tree():
    assert share_directory() == ROOT
    assert (ROOT / 'scenes' / 'sphere_on_spring.yaml').is_file()


@pytest.mark.parametrize('site', ['lib/python3.12/site-packages', 'local/lib/dist-packages', '.'])
def test_prefix_above_the_package(tmp_path, site):
    share = scenes(tmp_path)
    assert ask(place(tmp_path / site)).stdout.strip() == str(share)


def test_symbolic_link_to_a_source_tree(tmp_path):
    (tmp_path / 'dynsim_ros').symlink_to(PACKAGE)
    assert ask(tmp_path).stdout.strip() == str(ROOT)


def test_ament_prefix_path(tmp_path):
    share = scenes(tmp_path / 'b')
    path = f'{tmp_path}/a:{tmp_path}/b'
    done = ask(place(tmp_path / 'elsewhere'), AMENT_PREFIX_PATH=path)
    assert done.stdout.strip() == str(share)


def test_missing_is_one_clear_error(tmp_path):
    done = ask(place(tmp_path / 'elsewhere'), AMENT_PREFIX_PATH='')
    assert done.returncode == 1
    error = done.stderr.strip().splitlines()[-1]
    assert error.startswith('dynsim_ros.share.ShareError: share/dynsim_ros with its scenes')
    assert str(tmp_path / 'elsewhere' / 'dynsim_ros') in error
    assert error.endswith('install the package again, or source its workspace')
