# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Rules that every source file keeps."""

import re

import pytest
from tree import imported_modules, python_files, ROOT, source_files

# each room imports from itself and from those after it
ROOMS = ['cli', 'view', 'ros', 'bag', 'messages', 'simulation', 'integrators', 'physics', 'scene']
HEADER = ('# Copyright 2026 the dynsim_ros authors\n'
          '# SPDX-License-Identifier: Apache-2.0\n')


def room_of(path):
    parts = path.relative_to(ROOT / 'dynsim_ros').parts
    return parts[0] if len(parts) > 1 else None


def package_files():
    return [path for path in python_files() if ROOT / 'dynsim_ros' in path.parents]


def test_licence_header():
    without = [path for path in python_files()
               if not path.read_text(encoding='utf-8').startswith(HEADER)]
    assert without == []


def test_every_room_is_known():
    assert {room_of(path) for path in package_files()} - {None} <= set(ROOMS)


@pytest.mark.parametrize('room', ROOMS)
def test_imports_go_only_downward(room):
    allowed = ROOMS[ROOMS.index(room):]
    for path in package_files():
        if room_of(path) != room:
            continue
        for module in imported_modules(path):
            parts = module.split('.')
            if parts[0] == 'dynsim_ros' and parts[1:2] and parts[1] in ROOMS:
                assert parts[1] in allowed, f'{path} imports {module}'


def test_what_every_room_uses_imports_none_of_them():
    for path in package_files():
        if room_of(path) is None:
            assert not any(module.startswith('dynsim_ros.') for module in imported_modules(path))


def test_only_the_rooms_for_it_know_ros():
    for path in package_files():
        if room_of(path) not in ('cli', 'ros'):
            imported = {module.split('.')[0] for module in imported_modules(path)}
            assert 'rclpy' not in imported, path


def test_no_file_names_a_folder_of_one_machine():
    folder = re.compile(r'(?<![\w.<}\])])/(?:home|root|Users|work|mnt)/\w')
    for path in source_files():
        if path.suffix not in ('.mcap', '.png', '.gif', '.jpg', '.webp', '.svg'):
            found = folder.search(path.read_text(encoding='utf-8'))
            assert found is None, f'{path}: {found.group(0)}'
