# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
simulation_interfaces, which PyPI lacks, built of its definitions by ROS's own generators.

Of the package in test/interfaces/ come the same classes, and the same bytes on the wire, as of an
installed one, if its definitions say the same; nothing here is a stand-in but these texts.
"""

import functools
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
import shutil
import subprocess
import sysconfig

from ament_index_python import get_package_prefix
import numpy
from tree import ROOT

PACKAGE = 'simulation_interfaces'
DEFINITIONS = ROOT / 'test' / 'interfaces' / PACKAGE
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


def build(folder):
    """Return a folder, made within another one, that holds the package."""
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
    return folder / 'py'


def _generate(folder):
    """Let rosidl write the sources; each definition is parsed once, not once by each generator."""
    parser = import_module('rosidl_parser.parser')
    parser.get_ast_from_idl_string = functools.cache(parser.get_ast_from_idl_string)
    translate = import_module('rosidl_cli.command.translate.api').translate
    shares = [str(Path(get_package_prefix(name), 'share', name)) for name in USED]
    idl = translate(
        package_name=PACKAGE, output_format='idl', output_path=folder / 'idl' / PACKAGE,
        interface_files=[f'{DEFINITIONS}:{path.relative_to(DEFINITIONS)}'
                         for path in sorted(DEFINITIONS.glob('*/*'))])
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

    sources = [path for path in folder.rglob('*.c')]
    # These have the same names in them.
    alone = [path for path in sources if path.name.endswith('__description.c')]
    python = [path for path in sources if path.is_relative_to(folder / 'py')]
    rest = [path for path in sources if path not in alone and path not in python]
    return [*alone, one('python.c', python), one('functions.c', rest),
            one('support.cpp', folder.rglob('*.cpp'))]


def _prefixes():
    """Return where ROS is."""
    return {Path(get_package_prefix(name)) for name in (*USED, 'rosidl_typesupport_fastrtps_c')}


def _includes(folder):
    places = [prefix / 'include' for prefix in _prefixes()]
    return [folder / 'c', folder / 'c' / PACKAGE, sysconfig.get_path('include'),
            numpy.get_include(), *places, *(one for place in places for one in place.iterdir())]
