# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The tables of README.md and of the pages in docs/ against the program."""

import ast
from dataclasses import fields, MISSING
import json
import re
import sys

from dynsim_ros.integrators import METHODS
from dynsim_ros.messages.scene_channels import ENERGIES
from dynsim_ros.ros.own_parameters import OWN
from dynsim_ros.scene import (Air, Anchor, Box, load_scene, Particle, Rigid, RigidBody, Scene,
                              scene_names, Sphere, Spring)
from dynsim_ros.simulation import Settings, Simulator
import pytest
from readme import blocks, column, PAGES, PROGRAMS, quoted, tables
from tree import output_of, ROOT
import yaml

NODE, SCENES, INTEGRATORS = 'docs/node.md', 'docs/scenes.md', 'docs/integrators.md'
OPTIONS_OF_OTHERS = {'--ros-args', '--params-file', '--once', '--from-paths', '--ignore-src'}
OWNERS = {Scene: '', Air: 'air.', Anchor: '<anchor>.', Particle: '<body>.', Sphere: '<body>.',
          Box: '<body>.', RigidBody: '<body>.', Spring: '<spring>.'}
ONLY = {Sphere: ' (sphere)', Box: ' (box)', RigidBody: ' (rigid)', Rigid: ' (no particle)'}
OPTION = r'(?<![\w-])--?[a-z][a-z-]*'


def test_parameters_and_their_defaults():
    defaults = {**{name: own.default for name, own in OWN.items()},
                **{field.name: field.default for field in fields(Settings)}}
    shown = {name: f'`{str(value).lower() if isinstance(value, bool) else value}`'
             for name, value in defaults.items()}
    (table,) = tables('parameter', NODE)
    assert column(table) == shown
    for table in tables('parameter'):
        assert column(table).items() <= shown.items()


def expected_quantities():
    """Return {name: [unit, range, default, when it can be set]}, from the scene's classes."""
    rows = {}
    for owner, prefix in OWNERS.items():
        for field in fields(owner):
            quantity = field.metadata.get('quantity')
            if quantity is None:
                continue
            defining = next(cls for cls in reversed(owner.__mro__)
                            if field.name in getattr(cls, '__annotations__', {}))
            low, high = quantity.minimum, quantity.maximum
            limits = {'direction': 'direction', 'orientation': 'unit quaternion'}.get(
                quantity.kind, f'{low:g} to {high:g}')
            rows[f'`{prefix}{field.name}`{ONLY.get(defining, "")}'] = [
                quantity.unit, limits, shown_default(quantity, field.default),
                'at the start' if quantity.initial else 'any time']
    return rows


def shown_default(quantity, default):
    if default is MISSING or default is None:
        return 'required' if default is MISSING else 'absent'
    if quantity.kind == 'orientation':
        return 'identity'
    return '[' + ', '.join(f'{number:g}' for number in default) + ']'


def test_quantities_with_unit_range_and_default():
    (table,) = tables('quantity', SCENES)
    assert {row[0]: row[1:] for row in table} == expected_quantities()


def test_scenes_and_what_is_in_them():
    (table,) = tables('scene', SCENES)
    described = {quoted(row[0])[0]: quoted(row[1]) for row in table}
    assert sorted(described) == scene_names()
    for name, members in described.items():
        assert set(members) == {member.name for member in load_scene(name).members}, name


def test_every_scene_has_its_picture():
    shown = re.findall(r'\(docs/gallery/(\w+)\.png\)', PAGES['README.md'])
    assert sorted(shown) == scene_names()
    headings = [name for row in PAGES['README.md'].splitlines() if row.startswith('| `')
                for name in quoted(row) if name in scene_names()]
    assert headings == shown


def test_integrators_with_order():
    (table,) = tables('integrator', INTEGRATORS)
    assert column(table) == {
        name: '–' if method.order is None else str(method.order)
        for name, method in METHODS.items()}


# The others are for stiff scenes, or to compare with; each would take seconds to compile.
STATED = [name for name, method in METHODS.items()
          if method.advance is not None or name in ('auto', 'extrapolation')]
ERRORS = column(tables('integrator', INTEGRATORS)[0], 2)


def test_energy_errors_that_are_stated():
    assert [name for name, error in ERRORS.items() if error != '–'] == STATED


@pytest.mark.parametrize('name', STATED)
def test_energy_error_of_an_integrator(name):
    run = Simulator(load_scene('sphere_on_spring'), integrator=name).run(10.0)
    error = f'{float(f"{abs(run.imbalance()).max():.0e}"):g} J'
    assert ERRORS[name] == error


def test_energies_in_order():
    text = PAGES[NODE].split('\n`energy` holds', 1)[1].split('\n##', 1)[0]
    assert [name for name in quoted(text) if name in ENERGIES] == list(ENERGIES)


@pytest.fixture(scope='module')
def described_options():
    """Return {program: {option with its short form: its help}} as the programs tell it."""
    found = {}
    for program in PROGRAMS:
        text = output_of([sys.executable, '-m', f'dynsim_ros.cli.{program}', '--help'])
        text = text.split('\noptions:\n', 1)[1].split('\n\n', 1)[0]
        entries = re.split(r'\n  (?=-)', f'\n{text}')[1:]
        found[program] = {
            tuple(re.findall(OPTION, re.split(r'  |\n', entry, maxsplit=1)[0])):
            ' '.join(entry.split()) for entry in entries if not entry.startswith('-h')}
    return found


@pytest.mark.parametrize('program', PROGRAMS)
def test_options_and_their_defaults(program, described_options):
    rows = {tuple(quoted(row[0])): row for table in tables(f'option of `{program}`')
            for row in table if row[0].startswith('`-')}
    assert set(rows) == set(described_options[program])
    for names, (_, default, _) in rows.items():
        given = re.search(r'default:? (.*)', described_options[program][names])
        if default:
            assert given.group(1).startswith(default.strip('`')), names
        else:
            assert given is None or given.group(1) == 'none)', names


def test_no_other_option_is_named(described_options):
    known = OPTIONS_OF_OTHERS.union(*(names for options in described_options.values()
                                      for names in options))
    for page, text in PAGES.items():
        assert set(re.findall(r'(?<![\w-])--[a-z][a-z-]*', text)) <= known, page


def test_launch_arguments():
    tree = ast.parse((ROOT / 'launch' / 'sim.launch.py').read_text(encoding='utf-8'))
    declared = [node.args[0].value for node in ast.walk(tree) if isinstance(node, ast.Call)
                and getattr(node.func, 'id', None) == 'DeclareLaunchArgument']
    (table,) = tables('launch argument', NODE)
    assert list(column(table)) == declared


def test_what_the_front_page_sums_up():
    names = {}
    for kind, heading in (('topic', 'topic'), ('service', 'service')):
        for table in tables(heading, NODE):
            names.update({f'{kind} `{name}`': type_name
                          for name, type_name in column(table).items()})
    (table,) = tables('to', 'README.md')
    for _, name, type_name in table:
        assert names[name.partition(',')[0]] == type_name
    ratios, (every,) = tables('scene', 'README.md')[0], tables('scene', 'docs/performance.md')
    assert ratios and all(row in every for row in ratios)


def test_example_scene_has_every_field():
    text = next(text for _, name, text in blocks(SCENES) if name == 'my_scene.yaml')
    example = yaml.safe_load(text)
    members = {section: set().union(*example[section].values())
               for section in ('bodies', 'anchors', 'springs')}
    names = {'bodies': (Particle, Sphere, Box, RigidBody), 'anchors': (Anchor,),
             'springs': (Spring,)}
    for section, classes in names.items():
        every = {field.name.rstrip('_') for cls in classes for field in fields(cls)} - {'name'}
        assert members[section] - {'shape'} == every, section
    assert set(example['air']) == {field.name for field in fields(Air)}
    assert set(example) == {field.name for field in fields(Scene)}


def test_versions_of_other_readers():
    folder = ROOT / 'test' / 'readers'
    versions = json.loads((folder / 'package.json').read_text('utf-8'))['dependencies']
    versions |= [(folder / 'requirements.txt').read_text('utf-8').strip().split('==')]
    told = dict(re.findall(r'`([^`]+)` (\d+\.\d+\.\d+)', PAGES['docs/recording.md']))
    assert versions.items() <= told.items()
