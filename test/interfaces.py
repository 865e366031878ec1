# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Packages of messages that PyPI lacks, built of their definitions by ROS's own generators.

The classes are those of an installed package of the same definitions, and so are the bytes on the
wire; nothing here stands in for anything but these texts.
"""

from contextlib import contextmanager
import functools
import hashlib
from importlib import import_module
from importlib.util import find_spec
import os
from pathlib import Path
import shutil
import subprocess
import sys
import sysconfig

import pytest
from tree import output_of, ROOT

STANDARD, TF2 = 'simulation_interfaces', 'tf2_msgs'
DEFINITIONS = {STANDARD: ROOT / 'test' / 'definitions' / STANDARD,
               TF2: ROOT / 'dynsim_ros' / 'messages' / 'shipped' / 'share' / TF2}
# Which package each file of tests needs, in test/ros.
NEEDED = {'test_standard_services.py': STANDARD, 'test_tf.py': TF2}
USED = ('builtin_interfaces', 'std_msgs', 'geometry_msgs', 'service_msgs')
SUPPORTS = ('rosidl_typesupport_introspection_c', 'rosidl_typesupport_fastrtps_c')
LIBRARIES = ('rosidl_generator_c', *SUPPORTS, 'rosidl_typesupport_c', 'rosidl_generator_py')
RUNTIME = ('rosidl_runtime_c', 'rcutils', 'fastcdr', *SUPPORTS, 'rosidl_typesupport_fastrtps_cpp',
           'rosidl_typesupport_c')
MISSING = ('no C and C++ compiler with the headers of Python was found: install them (Debian: apt '
           'install g++ python3-dev)')


def left_out():
    """Return the files of tests whose package is neither installed nor can be built."""
    headers = Path(sysconfig.get_path('include'), 'Python.h')
    if shutil.which('cc') and shutil.which('c++') and headers.exists():
        return []
    return [name for name, package in NEEDED.items() if find_spec(package) is None]


@pytest.fixture(scope='module')
def standard_types(tmp_path_factory):
    """Let this process and those it starts find simulation_interfaces."""
    with there(STANDARD, tmp_path_factory):
        yield


@pytest.fixture(scope='module')
def tf2_types(tmp_path_factory):
    """Let this process and those it starts find tf2_msgs."""
    with there(TF2, tmp_path_factory):
        yield


@contextmanager
def there(package, tmp_path_factory):
    """Let a package be found until the block is left; a .venv keeps what is built."""
    if find_spec(package) is not None:
        yield
        return
    digest = hashlib.sha256(b''.join(path.read_bytes() for path in [
        Path(__file__), *_texts(package)]))
    folder = tmp_path_factory.mktemp('interfaces')
    home = folder if sys.prefix == sys.base_prefix else Path(sys.prefix)
    kept = home / 'interfaces' / digest.hexdigest()[:16]
    if not kept.exists():
        output_of([sys.executable, __file__, package, folder])
        beside = kept.with_name(f'{kept.name}.{os.getpid()}')
        shutil.copytree(folder / 'py', beside)
        beside.rename(kept)
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(kept)
        patch.setenv('PYTHONPATH', f'{kept}{os.pathsep}{os.environ["PYTHONPATH"]}')
        yield


def _texts(package):
    return sorted(path for path in DEFINITIONS[package].glob('*/*')
                  if path.suffix in ('.msg', '.srv'))


def build(package, folder):
    """Build a package; in the end it is in folder/py."""
    _generate(package, folder)
    includes = [f'-I{path}' for path in _includes(package, folder)]
    parts = _units(folder)
    for source in parts:
        compiler = ['c++', '-std=c++17'] if source.suffix == '.cpp' else ['cc']
        subprocess.run([*compiler, '-O0', '-fPIC', '-w', *includes, '-c', source,
                        '-o', source.with_suffix('.o')], check=True)
    names = [*(f'{name}__{library}' for name in USED for library in LIBRARIES), *RUNTIME]
    libraries = [*(f'-L{prefix / "lib"}' for prefix in _prefixes()), *(f'-l{n}' for n in names)]
    objects = [part.with_suffix('.o') for part in parts]
    _link(folder / 'py' / package, package, objects, libraries)


def _link(folder, package, objects, libraries):
    """
    Make the module that Python loads, and what ROS looks for by name for each kind of support.

    All is in the first of these; it is found in the others, too, as they need it.
    """
    def link(name, parts):
        subprocess.run(['c++', '-shared', '-Wl,--no-as-needed,-rpath,$ORIGIN',
                        f'-Wl,-soname,{name}', '-o', folder / name, *parts], check=True)
        return folder / name

    first, *others = (f'lib{package}__{support}.so' for support in SUPPORTS)
    made = [link(first, [*objects, *libraries])]
    made += [link(name, made) for name in others]
    link(f'{package}_s__rosidl_typesupport_c.so', made)
    (folder / '__init__.py').touch()


def _generate(package, folder):
    """Let rosidl write the sources; each definition is parsed once, not once by each generator."""
    parser = import_module('rosidl_parser.parser')
    parser.get_ast_from_idl_string = functools.cache(parser.get_ast_from_idl_string)
    translate = import_module('rosidl_cli.command.translate.api').translate
    shares = [str(path) for prefix in _prefixes() for path in
              (prefix / 'share' / name for name in USED) if path.exists()]
    idl = translate(
        package_name=package, output_format='idl', output_path=folder / 'idl' / package,
        interface_files=[f'{DEFINITIONS[package]}:{path.relative_to(DEFINITIONS[package])}'
                         for path in _texts(package)])
    for module, generator, options, out in (
            ('rosidl_generator_c', 'GenerateC', {}, 'c'),
            ('rosidl_typesupport_fastrtps_c', 'GenerateFastRTPSCTypesupport', {}, 'c'),
            ('rosidl_typesupport_introspection_c', 'GenerateIntrospectionCTypesupport', {},
             'introspection'),
            ('rosidl_typesupport_c', 'GenerateCTypesupport',
             {'typesupport_implementations': list(SUPPORTS)}, 'c'),
            ('rosidl_generator_py', 'GeneratePython',
             {'typesupport_implementations': ['rosidl_typesupport_c']}, 'py')):
        kind = getattr(import_module(f'{module}.cli'), generator)
        kind(out, **options).generate(package, idl, shares, folder / out / package)


def _units(folder):
    """Return the paths of what is to be compiled: few files, as headers take most of the time."""
    def one(name, sources):
        path = folder / name
        path.write_text(''.join(f'#include "{source}"\n' for source in sorted(sources)))
        return path

    sources = list(folder.rglob('*.c'))
    # These have the same names in them.
    alone = [path for path in sources if path.name.endswith('__description.c')]
    python = [path for path in sources if path.is_relative_to(folder / 'py')]
    rest = [path for path in sources if path not in alone and path not in python]
    return [*alone, one('python.c', python), one('functions.c', rest),
            one('support.cpp', folder.rglob('*.cpp'))]


def _prefixes():
    """Return where ROS is."""
    # Not at the top: what imports this file has yet to set up what ROS reads from the environment.
    from ament_index_python import get_package_prefix

    return {Path(get_package_prefix(name)) for name in (*USED, 'rosidl_typesupport_fastrtps_c')}


def _includes(package, folder):
    places = [prefix / 'include' for prefix in _prefixes()]
    return [folder / 'c', folder / 'c' / package, folder / 'introspection',
            sysconfig.get_path('include'), import_module('numpy').get_include(), *places,
            *(one for place in places for one in place.iterdir())]


if __name__ == '__main__':
    build(sys.argv[1], Path(sys.argv[2]))
