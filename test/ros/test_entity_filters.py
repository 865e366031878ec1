# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Entities by the filters of simulation_interfaces, without its types: what has their names."""

from types import SimpleNamespace

from dynsim_ros.ros.entity_filters import entities_of, selected
from dynsim_ros.ros.posix_pattern import PosixPattern
from dynsim_ros.ros.standard_results import Refusal
from dynsim_ros.scene import parse_scene
from dynsim_ros.simulation import Simulator
import pytest

SCENE = parse_scene("""
anchors: {hook: {position: [0, 0, 5]}}
bodies:
  ball: {shape: sphere, mass: 1, radius: 0.5, position: [2, 0, 0]}
  brick:
    {shape: box, mass: 2, size: [2, 1, 1], position: [0, 4, 0],
     orientation: {axis: [0, 0, 1], angle: 0.7853981633974483}}
  speck: {shape: particle, mass: 0.25, position: [0, 0, -3]}
""")
SNAPSHOT = Simulator(SCENE).snapshot()
CATEGORIES = SimpleNamespace(CATEGORY_OBJECT=0, CATEGORY_DYNAMIC_OBJECT=4)
MODES = SimpleNamespace(FILTER_MODE_ANY=0, FILTER_MODE_ALL=1)
BOUNDS = SimpleNamespace(TYPE_BOX=0, TYPE_SPHERE=2)
ALL = ['ball', 'brick', 'speck', 'hook']


def names(name='', categories=(), tags=(), mode=0, kind=2, points=()):
    """Return the names of the entities that pass."""
    filters = SimpleNamespace(
        filter=name, categories=[SimpleNamespace(category=number) for number in categories],
        tags=SimpleNamespace(tags=list(tags), filter_mode=mode),
        bounds=SimpleNamespace(type=kind, points=[SimpleNamespace(x=x, y=y, z=z)
                                                  for x, y, z in points]))
    return [entity.name for entity in selected(filters, SNAPSHOT, CATEGORIES, MODES, BOUNDS)]


def test_no_filter_lets_all_pass():
    assert names() == ALL


def test_what_they_are():
    found = entities_of(SCENE)
    assert [(entity.category, entity.tags, entity.description) for entity in found] == [
        ('CATEGORY_DYNAMIC_OBJECT', ('body', 'sphere'), 'sphere, 1 kg'),
        ('CATEGORY_DYNAMIC_OBJECT', ('body', 'box'), 'box, 2 kg'),
        ('CATEGORY_DYNAMIC_OBJECT', ('body', 'particle'), 'particle, 0.25 kg'),
        ('CATEGORY_OBJECT', ('anchor',), 'anchor')]


@pytest.mark.parametrize('pattern, found', [
    ('ball', ['ball']), ('b.*', ['ball', 'brick']), ('al', []), ('ball|hook', ['ball', 'hook']),
    ('b(a|al|all)', ['ball']), ('[[:alpha:]]{5}', ['brick', 'speck']), ('^ball$', ['ball'])])
def test_a_name_matches_as_a_whole(pattern, found):
    assert names(pattern) == found


def test_the_expressions_are_those_of_posix():
    # brackets take a backslash as it is, and there is a class for every kind of character
    assert PosixPattern(r'[\d]+').matches(r'd\d') and not PosixPattern(r'[\d]').matches('7')
    assert PosixPattern('[[:digit:][:space:]]+').matches('7 7')


@pytest.mark.parametrize('pattern, words', [
    ('(ball', 'Unmatched'), ('[b', 'Unmatched'), ('b{2,1}', 'nvalid'), ('a\0b', 'is zero')])
def test_what_is_no_expression(pattern, words):
    with pytest.raises(Refusal, match=rf'^filter: .* regular expression: .*{words}') as error:
        names(pattern)
    assert error.value.code == 'RESULT_OPERATION_FAILED'


def test_categories_and_tags():
    assert names(categories=[4]) == ALL[:3]
    assert names(categories=[0, 2]) == ['hook']
    assert names(categories=[5]) == []
    assert names(tags=['box', 'anchor']) == ['brick', 'hook']
    assert names(tags=['body', 'particle'], mode=1) == ['speck']
    assert names(tags=['box', 'anchor'], mode=1) == []
    assert names('b.*', [4], ['box']) == ['brick']
    with pytest.raises(Refusal, match='tags.filter_mode: 2 is no mode; give FILTER_MODE_ANY'):
        names(mode=2)


@pytest.mark.parametrize('centre, radius, found', [
    ((0, 0, 0), 1.49, []), ((0, 0, 0), 1.51, ['ball']), ((2, 0, 0), 0.0, ['ball']),
    ((0, 0, 5), 0.0, ['hook']), ((0, 0, -3), 0.0, ['speck']), ((0, 0, -2), 0.99, []),
    # along its edge the brick, turned by 45 degrees, reaches 1 m; across it 0.5 m
    ((1, 5, 0), 0.42, ['brick']), ((1, 5, 0), 0.41, []), ((-1, 5, 0), 0.92, ['brick']),
    ((-1, 5, 0), 0.91, []), ((0, 0, 0), 100.0, ALL)])
def test_what_overlaps_a_sphere(centre, radius, found):
    assert names(points=[centre, (radius, 0, 0)]) == found


@pytest.mark.parametrize('kind, points, code', [
    (0, [(0, 0, 0), (1, 1, 1)], 'RESULT_FEATURE_UNSUPPORTED'),
    (2, [(0, 0, 0)], 'RESULT_OPERATION_FAILED'),
    (2, [(0, 0, 0), (-1, 0, 0)], 'RESULT_OPERATION_FAILED'),
    (2, [(0, float('nan'), 0), (1, 0, 0)], 'RESULT_OPERATION_FAILED')])
def test_bounds_that_are_none(kind, points, code):
    with pytest.raises(Refusal, match='^bounds.') as error:
        names(kind=kind, points=points)
    assert error.value.code == code
