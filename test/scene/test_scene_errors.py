# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A wrong scene is refused with one line: file, field, value, unit, bound, nearest field."""

from dynsim_ros.scene import load_scene, Particle, read_scene, Scene, SceneError
import pytest

GOOD = """\
gravity: 9.81
down: [0, 0, -1]
air: {linear_drag: 0.1}
anchors:
  hand: {position: [0, 0, 2]}
bodies:
  ball: {shape: sphere, mass: 1, radius: 0.1, orientation: {axis: [1, 0, 0], angle: 0.3}}
  dot: {shape: particle, mass: 1}
springs:
  s: {from: hand, to: ball, stiffness: 100, natural_length: 0.5}
"""

# What is changed in the good scene, to what, and what is then said.
WRONG = [
    ('gravity: 9.81', 'gravity: -1', 'gravity: -1 m/s^2 is out of range: 0 to 1e+06 m/s^2'),
    ('gravity', 'gravty', "the scene: there is no field 'gravty'; did you mean 'gravity'?"),
    ('gravity: 9.81', 'gravity: [9.81]', 'gravity: [9.81] is not a number; give a number in '
     'm/s^2'),
    ('[0, 0, -1]', '[0, 0, 0]', 'down: [0.0, 0.0, 0.0] has no direction; give a vector that is '
     'not zero'),
    ('linear_drag', 'linear_drog', "air: there is no field 'linear_drog'; did you mean "
     "'linear_drag'?"),
    ('linear_drag: 0.1', 'linear_drag:', 'air.linear_drag: is missing; give it in N s/m'),
    ('{linear_drag: 0.1}', '5', 'air: 5 is not a mapping of names to values'),
    ('mass: 1,', 'mass: 0,', 'ball.mass: 0 kg is out of range: 1e-09 to 1e+06 kg'),
    ('mass: 1,', '', 'ball.mass: is missing; give it in kg'),
    ('mass: 1,', 'mas: 1,', "ball: there is no field 'mas'; did you mean 'mass'?"),
    ('radius: 0.1', 'radius: 1e5', 'ball.radius: 100000 m is out of range: 1e-09 to 10000 m'),
    ('sphere', 'spere', "ball.shape: 'spere' is no shape; did you mean 'sphere'?"),
    ('sphere', '[sphere]', "ball.shape: ['sphere'] is no shape; did you mean 'sphere'?"),
    ('shape: sphere, ', '', 'ball.shape: None is no shape; known are: particle, sphere, box, '
     'rigid'),
    ('[1, 0, 0], angle: 0.3', '[0, 0, 0], angle: 0.3', 'ball.orientation.axis: [0.0, 0.0, 0.0] '
     'has no direction; give a vector that is not zero'),
    ('angle: 0.3', 'angle: x', "ball.orientation.angle: 'x' is not a number; give a number in "
     'rad'),
    (', angle: 0.3', '', "ball.orientation: {'axis': [1, 0, 0]} is no orientation; give {axis: "
     '[x, y, z], angle: rad}, {w: , x: , y: , z: } or a list x, y, z, w'),
    ('from: hand', 'from: hnd', "s.from: 'hnd' is no anchor and no body; did you mean 'hand'?"),
    ('from: hand', 'from: [hand]', "s.from: ['hand'] is no name; give the name of an anchor or a "
     'body'),
    ('from: hand', 'from: ball', "s: both ends are at 'ball'; name two different ones"),
    ('from: hand, ', '', 's.from: is missing; give it'),
    ('to: ball', 'to: dot, to_offset: [0, 0, 1]', "s.to_offset: 'dot' is a point and has no "
     'attachment points; leave to_offset out'),
    ('to: ball', 'to: ball, from_offset: [0, 0, 1]', "s.from_offset: 'hand' is a point and has no "
     'attachment points; leave from_offset out'),
    ('stiffness: 100', 'stiffness: -1', 's.stiffness: -1 N/m is out of range: 0 to 1e+12 N/m'),
    ('0.5}', '0.5, damping: -1}', 's.damping: -1 N s/m is out of range: 0 to 1e+09 N s/m'),
    ('[0, 0, 2]', '[0, 0, x]', "hand.position[2]: 'x' is not a number; give a number in m"),
    ('  hand:', '  han d:', "name 'han d': a name begins with a letter and has letters, digits "
     'and single underscores within'),
    ('  hand:', '  5:', 'name 5: a name begins with a letter and has letters, digits and single '
     'underscores within'),
    ('  hand:', '  ball:', "name 'ball' is used more than once; bodies, anchors and springs need "
     'a name of their own each'),
    ('  dot:', '  air:', "name 'air' is taken by a parameter of the node; choose another"),
    ('  dot:', '  ball:', "line 8: 'ball' stands more than once"),
    ('down:', 'gravity:', "line 2: 'gravity' stands more than once"),
    ('mass: 1,', 'mass: 1, mass: 2,', "line 7: 'mass' stands more than once"),
    ('bodies:', 'bodies: [1, 2]\nx:', "the scene: there is no field 'x'; known are: air, anchors, "
     'bodies, description, down, gravity, name, springs'),
    ('anchors:\n  hand: {position: [0, 0, 2]}', 'anchors: [hand]',
     "anchors: ['hand'] is not a mapping of names to members"),
    ('gravity: 9.81', 'name: [a]', "name: ['a'] is not text; put it in quotes"),
    ('gravity: 9.81', 'description: 5', 'description: 5 is not text; put it in quotes'),
    ('gravity: 9.81', 'name: ""', "name: '' is no name of a scene; give 1 to 100 characters "
     'that can be printed'),
    ('gravity: 9.81', r'name: "a\0b"', r"name: 'a\x00b' is no name of a scene; give 1 to 100 "
     'characters that can be printed'),
    ('gravity: 9.81', r'description: "\ud800"', 'description: has half a character (a '
     'surrogate); leave it out'),
    ('gravity: 9.81', '"a\\nb": 1', r"the scene: there is no field 'a\nb'; known are: air, "
     'anchors, bodies, description, down, gravity, name, springs'),
    ('[0, 0, -1]', '[0, 0, -1', 'line 3: is not valid YAML: expected '
     "',' or ']', but got ':'"),
    (GOOD, '', 'the scene: None is not a mapping of names to values'),
    (GOOD, 'bodies: {}', 'bodies: there are none; give at least one'),
    (GOOD, '- 1', 'the scene: [1] is not a mapping of names to values'),
    (GOOD, '[' * 5000, 'is nested too deeply'),
]


@pytest.mark.parametrize('old, new, said', WRONG, ids=range(len(WRONG)))
def test_a_wrong_scene_is_refused_with_one_line(tmp_path, old, new, said):
    assert old in GOOD
    path = tmp_path / 'wrong.yaml'
    path.write_text(GOOD.replace(old, new, 1), encoding='utf-8')
    with pytest.raises(SceneError) as caught:
        read_scene(path)
    assert str(caught.value) == f'{path}: {said}'


def test_the_good_one_is_good(tmp_path):
    path = tmp_path / 'good.yaml'
    path.write_text(GOOD, encoding='utf-8')
    assert [member.name for member in read_scene(path).members] == ['ball', 'dot', 'hand', 's']


def test_both_ends_at_anchors(tmp_path):
    text = GOOD.replace('to: ball', 'to: foot').replace(
        'bodies:', '  foot: {position: [0, 0, 0]}\nbodies:')
    path = tmp_path / 'wrong.yaml'
    path.write_text(text, encoding='utf-8')
    with pytest.raises(SceneError, match='s: both ends are anchors; one end must be a body$'):
        read_scene(path)


def test_files_that_cannot_be_read(tmp_path):
    (tmp_path / 'binary.yaml').write_bytes(b'\xff\xfe\x00\x80')
    for path, words in ((tmp_path / 'none.yaml', 'cannot be read: No such file or directory'),
                        (tmp_path, 'cannot be read: Is a directory'),
                        (tmp_path / 'binary.yaml', 'is no text file')):
        with pytest.raises(SceneError) as caught:
            read_scene(path)
        assert str(caught.value) == f'{path}: {words}'


def test_an_unknown_name_of_a_scene():
    with pytest.raises(SceneError) as caught:
        load_scene('sphere_on_sprng')
    assert str(caught.value) == ("scene 'sphere_on_sprng' is not known; did you mean "
                                 "'sphere_on_spring'? (or give the path of a .yaml file)")


def test_what_must_be_there_cannot_be_none_in_python_either():
    with pytest.raises(SceneError, match='p.mass: None is not a number'):
        Particle(name='p', mass=None)
    with pytest.raises(SceneError, match='p.position: None is not a list of 3 numbers in m'):
        Scene(bodies=(Particle(name='p', mass=1, position=None),))
