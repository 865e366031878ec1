# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
simulation_interfaces, which PyPI lacks, built of its definitions by ROS's own generators.

From test/definitions/ come the same classes, and the same bytes on the wire, as from an installed
package of the same definitions; nothing here stands in for anything but these texts.
"""

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

PACKAGE = 'simulation_interfaces'
DEFINITIONS = ROOT / 'test' / 'definitions' / PACKAGE
USED = ('builtin_interfaces', 'std_msgs', 'geometry_msgs', 'service_msgs')
LIBRARIES = ('rosidl_generator_c', 'rosidl_typesupport_fastrtps_c', 'rosidl_typesupport_c',
             'rosidl_generator_py')
RUNTIME = ('rosidl_runtime_c', 'rcutils', 'fastcdr', 'rosidl_typesupport_fastrtps_c',
           'rosidl_typesupport_fastrtps_cpp', 'rosidl_typesupport_c')
MISSING = ('no C and C++ compiler with the headers of Python was found: install them (Debian: apt '
           'install g++ python3-dev)')


def can_be_had():
    """Tell whether the package is installed or can be built."""
    headers = Path(sysconfig.get_path('include'), 'Python.h')
    return find_spec(PACKAGE) is not None or (
        shutil.which('cc') and shutil.which('c++') and headers.exists())


@pytest.fixture(scope='module')
def standard_types(tmp_path_factory):
    """Let this process and those it starts find the package; a .venv keeps what is built."""
    if find_spec(PACKAGE) is not None:
        yield
        return
    digest = hashlib.sha256(b''.join(path.read_bytes() for path in [Path(__file__), *_texts()]))
    folder = tmp_path_factory.mktemp('interfaces')
    home = folder if sys.prefix == sys.base_prefix else Path(sys.prefix)
    kept = home / 'interfaces' / digest.hexdigest()[:16]
    if not kept.exists():
        output_of([sys.executable, __file__, folder])
        beside = kept.with_name(f'{kept.name}.{os.getpid()}')
        shutil.copytree(folder / 'py', beside)
        beside.rename(kept)
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(kept)
        patch.setenv('PYTHONPATH', f'{kept}{os.pathsep}{os.environ["PYTHONPATH"]}')
        yield


def _texts():
    return sorted(DEFINITIONS.glob('*/*'))


def build(folder):
    """Build the package; in the end it is in folder/py."""
    _generate(folder)
    includes = [f'-I{path}' for path in _includes(folder)]
    parts = _units(folder)
    for source in parts:
        compiler = ['c++', '-std=c++17'] if source.suffix == '.cpp' else ['cc']
        subprocess.run([*compiler, '-O0', '-fPIC', '-w', *includes, '-c', source,
                        '-o', source.with_suffix('.o')], check=True)
    library = folder / 'py' / PACKAGE / f'{PACKAGE}_s__rosidl_typesupport_c.so'
    names = [*(f'{name}__{library}' for name in USED for library in LIBRARIES), *RUNTIME]
    subprocess.run(['c++', '-shared', '-o', library, *(part.with_suffix('.o') for part in parts),
                    *(f'-L{prefix / "lib"}' for prefix in _prefixes()),
                    *(f'-l{name}' for name in names)], check=True)
    (library.parent / '__init__.py').touch()


def _generate(folder):
    """Let rosidl write the sources; each definition is parsed once, not once by each generator."""
    parser = import_module('rosidl_parser.parser')
    parser.get_ast_from_idl_string = functools.cache(parser.get_ast_from_idl_string)
    translate = import_module('rosidl_cli.command.translate.api').translate
    shares = [str(path) for prefix in _prefixes() for path in
              (prefix / 'share' / name for name in USED) if path.exists()]
    idl = translate(
        package_name=PACKAGE, output_format='idl', output_path=folder / 'idl' / PACKAGE,
        interface_files=[f'{DEFINITIONS}:{path.relative_to(DEFINITIONS)}'
                         for path in _texts()])
    for module, generator, options, out in (
            ('rosidl_generator_c', 'GenerateC', {}, 'c'),
            ('rosidl_typesupport_fastrtps_c', 'GenerateFastRTPSCTypesupport', {}, 'c'),
            ('rosidl_typesupport_c', 'GenerateCTypesupport',
             {'typesupport_implementations': ['rosidl_typesupport_fastrtps_c']}, 'c'),
            ('rosidl_generator_py', 'GeneratePython',
             {'typesupport_implementations': ['rosidl_typesupport_c']}, 'py')):
        kind = getattr(import_module(f'{module}.cli'), generator)
        kind(out, **options).generate(PACKAGE, idl, shares, folder / out / PACKAGE)


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


def _includes(folder):
    places = [prefix / 'include' for prefix in _prefixes()]
    return [folder / 'c', folder / 'c' / PACKAGE, sysconfig.get_path('include'),
            import_module('numpy').get_include(), *places,
            *(one for place in places for one in place.iterdir())]


if __name__ == '__main__':
    build(Path(sys.argv[1]))
