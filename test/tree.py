# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The source tree as tests see it: its files, copies of it, programs started outside of it."""

import ast
import os
from pathlib import Path
import shutil
import subprocess
import sys

ROOT = Path(__file__).resolve().parent.parent
MADE = {'build', 'dist', 'install', 'log', 'runs', '__pycache__', 'dynsim_ros.egg-info'}


def source_files():
    """Return the files that belong to the project, as paths, sorted."""
    found = []
    for folder, folders, files in os.walk(ROOT):
        folders[:] = [f for f in folders if f not in MADE and (f == '.ci' or f[0] != '.')]
        found += [Path(folder, file) for file in files if file != '.git']
    return sorted(found)


def python_files():
    """Return the Python files of the project, as paths, sorted."""
    return [path for path in source_files() if path.suffix == '.py']


def imported_modules(path):
    """Return the absolute names of the modules that a file of the package imports anywhere."""
    package = path.relative_to(ROOT).with_suffix('').parts[:-1]
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'), str(path))):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = package[:len(package) - node.level + 1] if node.level else ()
            module = '.'.join([*above, *filter(None, [node.module])])
            # what is imported may itself be a module: from . import rk4
            names.update(f'{module}.{alias.name}' for alias in node.names)
    return names


def copy_tree(target):
    """Copy the project's files to a folder, without anything that was made from them."""
    for path in source_files():
        copy = target / path.relative_to(ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(path, copy)
    return target


def outside_environment(**more):
    """Return environment variables for a program that must not see this source tree."""
    variables = dict(os.environ)
    paths = [p for p in variables.pop('PYTHONPATH', '').split(os.pathsep) if p and Path(p) != ROOT]
    if paths:
        variables['PYTHONPATH'] = os.pathsep.join(paths)
    if variables.pop('_ROS_WHEELS_BOOTSTRAP_COMPLETE', None):
        del variables['LD_LIBRARY_PATH']
    variables.setdefault('AMENT_PREFIX_PATH', sys.prefix)
    return variables | {name: str(value) for name, value in more.items()}


def output_of(command, **options):
    """Run a command that must succeed and return what it wrote; fail with all of it otherwise."""
    done = subprocess.run(
        [str(word) for word in command], capture_output=True, text=True, timeout=280,
        stdin=subprocess.DEVNULL, check=False, **options)
    assert done.returncode == 0, f'{command}\n{done.stdout}\n{done.stderr}'
    return done.stdout
