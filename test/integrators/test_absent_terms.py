# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
What a scene lacks is not computed: operations counted, calls listed, machine code looked at.

And anchors, pushes and works that could be there but are not change no bit.
"""

from dataclasses import replace
import re
import sys

from by_hand import ByHand
from dynsim_ros.physics.motion import rates
from dynsim_ros.scene import parse_scene
import numba
import numpy as np
import pytest
from references import load

EVERYTHING = parse_scene("""
gravity: 9.81
air: {linear_drag: 0.3, rotational_drag: 0.02, velocity: [1, 2, -1], angular_velocity: [3, 0, 1]}
anchors: {hand: {position: [0, 0, 2]}}
bodies:
  ball: {shape: sphere, mass: 1.3, radius: 0.2, position: [0.3, 0, 1.2], velocity: [0, 0.5, 0],
         orientation: {axis: [1, 0, 0], angle: 0.3}, angular_velocity: [1, 2, 3]}
springs: {spring: {from: hand, to: ball, stiffness: 100, damping: 0.5, natural_length: 0.5}}
""")
SPRING = EVERYTHING.springs[0]
BARE = replace(EVERYTHING, gravity=None, air=None, springs=())
PARTICLE = parse_scene('bodies: {dot: {shape: particle, mass: 2, velocity: [1, 0, 0]}}')
METHODS = ('gragg', 'dop853', 'stiff', 'radau', 'rk4', 'leapfrog')


class Counted:
    """A number that counts what is done with numbers like it."""

    __array_ufunc__ = None
    operations = 0

    def __init__(self, value):
        self.value = float(value)

    def __float__(self):
        # math.sqrt asks for it
        Counted.operations += 1
        return self.value


def counting(name):
    """Return the method of float that does something, counted."""
    def operate(self, *others):
        Counted.operations += 1
        return Counted(getattr(self.value, name)(*(
            float(getattr(other, 'value', other)) for other in others)))
    return operate


for _name in ('add', 'sub', 'mul', 'truediv'):
    setattr(Counted, f'__{_name}__', counting(f'__{_name}__'))
    setattr(Counted, f'__r{_name}__', counting(f'__r{_name}__'))
Counted.__neg__ = counting('__neg__')


def operations(scene, **drive):
    """Return how many operations on the state's numbers one evaluation takes."""
    hand = ByHand(scene, 'rk4', **drive)
    y, out = [Counted(value) for value in hand.start], [0.0] * len(hand.start)
    Counted.operations = 0
    rates(hand.model, hand.drive, Counted(0.0), y, out)
    if hand.drive.works is None:
        exact = hand.rates(0.0, hand.start)
        # these numbers round products that are else fused
        np.testing.assert_allclose([getattr(x, 'value', x) for x in out], exact, rtol=1e-14,
                                   atol=1e-14)
    return Counted.operations


def without(scene, *terms):
    """Return the scene without some terms."""
    for term in terms:
        if term == 'damper':
            scene = replace(scene, springs=(replace(scene.springs[0], damping=None),))
        else:
            scene = replace(scene, air=replace(scene.air, **{term.replace(' ', '_'): None}))
    return scene


# Products, sums, differences and signs of the formulas on the sheet; each force is added up.
FORMULAS = {'linear drag': 3 + 3 + 3, 'rotational drag': 3 + 3 + 3,
            'damper': (3 + 2) + (3 + 2) + 1 + 1 + 2}


def test_operations_without_any_term():
    # F / m is a constant, positions are copied
    assert operations(PARTICLE) == operations(replace(PARTICLE, gravity=9.81)) == 0
    # dq/dt = (0, omega) q / 2
    assert operations(BARE) == 3 + 12 + 8 + 6


@pytest.mark.parametrize('term', FORMULAS)
def test_operations_of_a_term(term):
    assert operations(EVERYTHING) - operations(without(EVERYTHING, term)) == FORMULAS[term]
    others = [other for other in FORMULAS if other != term]
    alone = without(EVERYTHING, *others)
    assert operations(alone) - operations(without(alone, term)) == FORMULAS[term]


def test_operations_of_what_comes_from_outside():
    plain = operations(EVERYTHING)
    # r + v t of the anchor, v . r
    assert operations(EVERYTHING, moving=True) == plain + 6 + 5
    # b (dL/dt)^2 and F v, M omega in air, each added
    assert operations(EVERYTHING, works=True) == plain + 4 + 9 + 9


# What is called for a term, by a method that has the rates, or by a linearly implicit one; behind
# an arrow where others call it, too.
NAMES = {'linear drag': {'with_linear_drag > with_drag'},
         'rotational drag': {'with_rotational_drag > with_drag'},
         'damper': {'damper_tension'}, 'spring': {'spring_ends', 'end_place'},
         'works': {'power'}, 'inertia matrix': {'angular_acceleration', 'rotation_matrix'},
         'orientation': {'quaternion_rate_world', 'turned', 'attachment_arm'}}


def called(scene, method, **drive):
    """Return the names of the package's functions that a step calls, alone and with callers."""
    hand, names = ByHand(scene, method, **drive), set()

    def profile(frame, event, _):
        if event == 'call' and 'dynsim_ros' in frame.f_code.co_filename:
            name, caller = frame.f_code.co_name, frame.f_back
            # what can be compiled is called by way of this
            if caller.f_code.co_name == '__call__':
                caller = caller.f_back
            names.update({name, f'{caller.f_code.co_name} > {name}'})
    sys.setprofile(profile)
    try:
        hand.run(0.01, 1)
    finally:
        sys.setprofile(None)
    return names


@pytest.mark.parametrize('method', METHODS)
def test_what_a_step_calls(method):
    own = {'stiff': {'damper_tension'}}.get(method, set())
    everything = called(EVERYTHING, method)
    for term in ('linear drag', 'rotational drag', 'damper'):
        assert everything >= NAMES[term] - own
        assert not called(without(EVERYTHING, term), method) & NAMES[term]
    assert everything & NAMES['spring']
    assert everything & NAMES['orientation']
    assert not everything & (NAMES['works'] | NAMES['inertia matrix'])
    bare = called(PARTICLE, method)
    for names in NAMES.values():
        assert not bare & names
    if method != 'stiff':
        assert called(EVERYTHING, method, works=True) >= NAMES['works']


def machine_code(scene):
    """Return how often the compiled rates of a scene do what: {instruction: count}."""
    hand = ByHand(scene, 'rk4')
    compiled = numba.njit(lambda model, drive, t, y, out: rates(model, drive, t, y, out),
                          error_model='numpy', _nrt=False)
    compiled(hand.model, hand.drive, 0.0, hand.start, np.zeros_like(hand.start))
    code, = compiled.inspect_llvm().values()
    return {name: len(re.findall(pattern, code)) for name, pattern in (
        ('sum', ' f(?:add|sub) '), ('product', ' fmul '), ('division', ' fdiv '),
        ('root', 'call .*sqrt'), ('fused', 'call .*fma'))}


def test_compiled_code_of_a_free_particle():
    # 1 / m times nothing
    assert machine_code(PARTICLE) == {'sum': 0, 'product': 1, 'division': 0, 'root': 0,
                                      'fused': 0}


def test_compiled_code_of_a_free_sphere():
    found = machine_code(replace(BARE, gravity=9.81))
    assert found['root'] == 0
    # dq/dt, and three numbers each of F / m, M / I and the weight
    assert found['fused'] == 8
    assert found['sum'] <= 3
    assert found['product'] <= 3 + 4 + 3 + 3
    everything = machine_code(EVERYTHING)
    assert everything['root'] == 1
    assert everything['sum'] + everything['fused'] > found['sum'] + found['fused'] + 40


BOX = load('box_by_its_corner')[0]


@pytest.mark.parametrize('method', METHODS)
@pytest.mark.parametrize('scene', [EVERYTHING, BOX], ids=['sphere', 'box'])
def test_a_still_drive_changes_no_bit_against_none(method, scene):
    undamped = replace(scene, springs=(replace(scene.springs[0], damping=None),), gravity=None,
                       air=None)
    exact = ByHand(undamped, method).run(0.03, 2)
    for drive in ({'moving': True}, {'pushes': np.zeros(len(exact[0]))}, {'works': True},
                  {'moving': True, 'pushes': np.zeros(len(exact[0])), 'works': True}):
        found = ByHand(undamped, method, **drive).run(0.03, 2)
        np.testing.assert_array_equal(found[:, :-4], exact[:, :-4])


@pytest.mark.parametrize('drive', [{'moving': True}, {'pushes': np.zeros(10)}, {'works': True}],
                         ids=lambda drive: next(iter(drive)))
def test_a_still_drive_changes_no_bit_of_a_particle(drive):
    scene = load('S1')[0]
    exact = ByHand(scene, 'stormer').run(0.2, 3)
    found = ByHand(scene, 'stormer', **drive).run(0.2, 3)
    np.testing.assert_array_equal(found[:, :-4], exact[:, :-4])
