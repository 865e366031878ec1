# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""package.xml, read by the parser that colcon and rosdep use, and what must agree with it."""

import re
import sys

from catkin_pkg.package import parse_package
import dynsim_ros
import pytest
from tree import imported_modules, python_files, ROOT

# modules that come with a package of another name in rosdep
KEYS = {'llvmlite': 'python3-numba', 'lz4': 'mcap-ros2-support', 'mcap': 'mcap-ros2-support',
        'matplotlib': 'python3-matplotlib', 'numba': 'python3-numba', 'numpy': 'python3-numpy',
        'yaml': 'python3-yaml', 'zstandard': 'mcap-ros2-support'}
# what says in one line that it is missing, or what nothing is missing without
OPTIONAL = {'isal', 'pandas', 'rich', 'simulation_interfaces', 'viser'}


@pytest.fixture(scope='module')
def package():
    return parse_package(str(ROOT))


def test_is_valid(package):
    warnings = []
    parse_package(str(ROOT), warnings=warnings)
    package.validate()
    assert warnings == []
    assert package.package_format == 3
    assert package.name == 'dynsim_ros'


def test_is_an_ament_python_package_under_apache_2(package):
    assert package.get_build_type() == 'ament_python'
    assert [str(name) for name in package.licenses] == ['Apache-2.0']
    assert 'Version 2.0, January 2004' in (ROOT / 'LICENSE').read_text(encoding='utf-8')


def test_maintainer_can_be_written_to(package):
    for person in package.maintainers:
        assert re.fullmatch(r'[\w.+-]+@[\w-]+(\.[\w-]+)+', person.email), person.email


def test_versions_agree(package):
    changelog = (ROOT / 'CHANGELOG.rst').read_text(encoding='utf-8')
    newest = re.search(r'^(\d+\.\d+\.\d+) \(\d{4}-\d{2}-\d{2}\)\n-+$', changelog, re.MULTILINE)
    assert package.version == dynsim_ros.__version__ == newest.group(1)


def test_changelog_has_the_form_that_catkin_tools_read(package):
    lines = (ROOT / 'CHANGELOG.rst').read_text(encoding='utf-8').splitlines()
    title = f'Changelog for package {package.name}'
    assert lines[:3] == ['^' * len(title), title, '^' * len(title)]


def test_declares_what_the_code_imports(package):
    declared = {dependency.name for dependency in package.exec_depends}
    for path in python_files():
        if path.relative_to(ROOT).parts[0] not in ('dynsim_ros', 'launch'):
            continue
        for module in imported_modules(path):
            top = module.split('.')[0]
            if top in sys.stdlib_module_names or top in {'dynsim_ros', *OPTIONAL}:
                continue
            assert KEYS.get(top, top) in declared, f'{path} imports {top}'


def test_declares_each_dependency_once(package):
    for kind in (package.exec_depends, package.test_depends):
        names = [dependency.name for dependency in kind]
        assert sorted(set(names)) == sorted(names)
