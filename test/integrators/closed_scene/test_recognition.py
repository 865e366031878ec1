# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which scenes are recognised as having a closed form, and which must not be."""

from integrators.closed_scene.recognised import recognised
import pytest
from references import all_scenes

CLOSED = {
    'free_flight': {'flights'}, 'free_flight_of_box': {'flights', 'tops'},
    'free_spin': {'flights', 'spins', 'tops'}, 'fast_spin': {'flights', 'tops'},
    'at_rest': set(), 'up_and_down': {'line', 'slowed'}, 'no_natural_length': {'centred'},
    'falling_in_wind': {'flights', 'whirls'}, 'spinning_box': {'flights', 'tops'}}


@pytest.mark.parametrize('name', all_scenes())
def test_scenes_that_have_a_reference(name):
    assert recognised(all_scenes()[name]) == CLOSED.get(name)


def ball(more, air='{}'):
    return (f'air: {air}\nbodies: {{ball: {{shape: sphere, mass: 1, radius: 0.5, {more}}}}}')


DRAG = '{rotational_drag: 0.01, angular_velocity: [0, 0, 2]}'


@pytest.mark.parametrize('text, torque, kinds', [
    (ball('angular_velocity: [1, 2, 3]'), None, {'flights', 'spins'}),
    (ball('angular_velocity: [1, 2, 3]'), (-2, -4, -6), {'flights', 'spins'}),
    (ball('angular_velocity: [1, 2, 3]'), (0, 0, 1), None),
    (ball('angular_velocity: [0, 0, 0]'), (1, 2, 3), {'flights', 'spins'}),
    (ball('angular_velocity: [0, 0, -9]', DRAG), (0, 0, 1), {'flights', 'slowed'}),
    (ball('angular_velocity: [0, 0, -9]', DRAG), (0, 1e-9, 1), None),
    (ball('angular_velocity: [0.1, 0, 2]', DRAG), (1e-5, 0, 0), {'flights', 'whirls'}),
    (ball('angular_velocity: [9, 0, 0]', DRAG), None, None)])
def test_spin_of_a_ball(text, torque, kinds):
    assert recognised(text, torque=torque) == kinds


def box(spin, air='{}'):
    return (f'air: {air}\nbodies: {{box: {{shape: box, mass: 1, size: [0.1, 0.2, 0.4], '
            f'angular_velocity: {spin}}}}}')


@pytest.mark.parametrize('text, torque, kinds', [
    (box([0, 0, 5]), (0, 0, 1), {'flights', 'spins'}), (box([0, 0, 5]), (0, 1, 0), None),
    (box([0, 0, 5], DRAG), None, {'flights', 'slowed'}),
    (box([0, 1e-9, 5], DRAG), None, None), (box([0, 5, 0], DRAG), None, None),
    (box([1, 2, 5], '{rotational_drag: 0}'), None, {'flights', 'tops'}),
    (box([0, 0, 0], '{rotational_drag: 0.1}'), None, set())])
def test_spin_of_a_box(text, torque, kinds):
    assert recognised(text, torque=torque) == kinds


def dot(more, spring='stiffness: 100, natural_length: 0.5', head='gravity: 9.81', anchor=''):
    return (f'{head}\nanchors: {{hand: {{position: [0, 0, 2]{anchor}}}}}\n'
            f'bodies: {{dot: {{shape: particle, mass: 1, {more}}}}}\n'
            f'springs: {{spring: {{from: hand, to: dot, {spring}}}}}')


BELOW, LONG = 'position: [0, 0, 1.2]', 'stiffness: 100, natural_length: 6'
AWAY = 'position: [3, 4, 7], velocity: [1, 0, 0]'
WIND = 'gravity: 9.81\nair: {linear_drag: 0.1, velocity: %s}'


@pytest.mark.parametrize('text, force, kinds', [
    (dot(BELOW), None, {'line'}), (dot(BELOW), (0, 0, 3), {'line'}),
    (dot(BELOW), (1e-9, 0, 3), None), (dot('position: [1e-9, 0, 1.2]'), None, None),
    (dot('position: [0, 0, 1.2], velocity: [0, 1e-9, 0]'), None, None),
    (dot(BELOW, head=WIND % [0, 0, 5]), None, {'line'}),
    (dot(BELOW, head=WIND % [1, 0, 5]), None, None),
    (dot(BELOW, anchor=', velocity: [0, 0, 0.3]'), None, {'line'}),
    (dot(BELOW, anchor=', velocity: [0.3, 0, 0]'), None, None),
    (dot(BELOW + ', velocity: [0.3, 0, 0]', anchor=', velocity: [0.3, 0, 0]'), None, {'line'}),
    (dot(BELOW + ', velocity: [0, 0, 7]'), None, None),
    (dot(BELOW, 'stiffness: 100, natural_length: 0.5, damping: 2'), None, {'line'}),
    (dot('position: [0, 0, 2]'), None, None),
    (dot('position: [3, 4, 7]', head=''), None, None),
    (dot('position: [3, 4, 7]', LONG, ''), None, {'line'}),
    (dot('position: [3, 4, 7], velocity: [0.75, 1, 1.25]', LONG, ''), None, {'line'}),
    (dot('position: [3, 4, 7], velocity: [0.75, 1, 1.26]', LONG, ''), None, None),
    (dot(AWAY, 'stiffness: 5, natural_length: 0'), (1, 2, 3), {'centred'}),
    (dot(AWAY, 'stiffness: 5, natural_length: 0, damping: 1'), None, None),
    (dot(AWAY, 'stiffness: 0, natural_length: 1'), None, {'flights'})])
def test_a_particle_on_a_spring(text, force, kinds):
    assert recognised(text, force) == kinds


def hung(more, anchor=', velocity: [0, 0, 0.1]'):
    return (f'gravity: 9.81\nanchors: {{hand: {{position: [0, 0, 2]{anchor}}}}}\n'
            f'bodies: {{body: {{mass: 1, position: [0, 0, 1.2], {more}}}}}\n'
            'springs: {spring: {from: hand, to: body, stiffness: 100, natural_length: 0.5}}')


@pytest.mark.parametrize('more, kinds', [
    ('shape: sphere, radius: 0.1, angular_velocity: [0, 0, 7]', {'line', 'spins'}),
    ('shape: sphere, radius: 0.1, angular_velocity: [0, 1e-9, 7]', None),
    ('shape: sphere, radius: 0.1, orientation: {axis: [1, 0, 0], angle: 1e-9}', None),
    ('shape: box, size: [0.1, 0.2, 0.3]', {'line', 'tops'}),
    ('shape: box, size: [0.1, 0.2, 0.3], angular_velocity: [0, 0, 7]', None),
    ('shape: rigid, inertia: [1, 2, 2.5], angular_velocity: [3, 2, 1]', {'line', 'tops'})])
def test_a_body_below_its_anchor(more, kinds):
    assert recognised(hung(more)) == kinds


def test_several_bodies_on_springs_are_left_to_integration():
    assert recognised("""
anchors: {hand: {position: [0, 0, 2]}}
bodies:
  first: {shape: particle, mass: 1, position: [0, 0, 1]}
  second: {shape: particle, mass: 1, position: [5, 0, 1]}
springs: {spring: {from: hand, to: first, stiffness: 100, natural_length: 0.5}}""") is None
