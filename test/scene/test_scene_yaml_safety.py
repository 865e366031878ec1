# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Nothing in a scene file is executed, nothing in it makes anything but a SceneError."""

import random
import time

from dynsim_ros.scene import load_scene, parse_scene, scene_names, scene_to_yaml, SceneError
import pytest


@pytest.mark.parametrize('tag', [
    '!!python/object/apply:os.system ["touch {}"]', '!!python/object/new:os.system ["touch {}"]',
    '!!python/name:os.system ""', '!!python/module:os ""', '!!python/tuple [1, 2]', '!mine x'])
def test_tags_are_refused_and_do_nothing(tag, tmp_path):
    file = tmp_path / 'touched'
    with pytest.raises(SceneError, match='line 1: is not valid YAML: could not determine a cons'):
        parse_scene('gravity: ' + tag.format(file))
    assert not file.exists()


STRANGE = [
    '!!map foo', '!!seq foo', '!!int foo', '!!int ""', '!!float foo', '!!float ""', '!!bool foo',
    '!!timestamp foo', '!!binary "%"', '!!omap foo', '!!pairs {a: 1}', '!!set foo', '!!str [1]',
    '2001-13-45', '9999-99-99 99:99:99', '{? [a]: 1}', '{? {a: 1}: 1}', '&a [*a]', '&a {b: *a}',
    '*unknown', '"\\ud800"', '? ', '<<: 1', '{<<: [1]}', '1e400', '0b2', '"\\x00"', '\x00',
    '\ufeff', '%YAML 9.9\n---\na: 1', '--- 1\n--- 2', '\t', '@', '`', '{a: b: c}', '9' * 5000,
    '0x' + 'f' * 5000, '1:99:99', '-' * 1000, '=', '!!python', '!', '&', '|', '>9', 'a: |9\n b']


@pytest.mark.parametrize('text', STRANGE, ids=range(len(STRANGE)))
@pytest.mark.parametrize('place', ['{}', 'gravity: {}', 'name: {}', 'air: {}', 'bodies: {}',
                                   'bodies: {{p: {}}}', 'bodies: {{p: {{shape: {}}}}}'])
def test_strange_yaml_is_a_scene_error_of_one_line(text, place):
    with pytest.raises(SceneError) as caught:
        parse_scene(place.format(text))
    assert len(str(caught.value).splitlines()) == 1
    assert len(str(caught.value)) < 1000


def test_aliases_that_multiply_do_not_fill_the_memory():
    """Ten levels of ten aliases: ten thousand million numbers, were they written out."""
    levels = ['a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]']
    levels += [f'a{n}: &a{n} [' + ', '.join([f'*a{n - 1}'] * 10) + ']' for n in range(1, 10)]
    start = time.monotonic()
    levels_in_line = '{' + ', '.join(levels) + '}'
    for text in ('\n'.join([*levels, 'gravity: *a9']), 'gravity: ' + levels_in_line,
                 'bodies: {b: {x: ' + levels_in_line + ', shape: *a9}}',
                 'bodies: {p: {shape: particle, mass: ' + levels_in_line + '}}'):
        with pytest.raises(SceneError) as caught:
            parse_scene(text)
        assert len(str(caught.value)) < 1000
    assert time.monotonic() - start < 5


def test_a_key_that_comes_from_a_merge_is_no_repeated_key():
    scene = parse_scene("""
        bodies:
          a: &a {shape: sphere, mass: 1, radius: 0.1}
          b: &b {<<: *a, mass: 2}
          c: {<<: *b, mass: 3}""")
    assert [body.mass for body in scene.bodies] == [1.0, 2.0, 3.0]
    assert {body.radius for body in scene.bodies} == {0.1}


SNIPPETS = ['[', ']', '{', '}', ':', ',', '-', '&a', '*a', '!!int', '!!set', '!', '#', '|', '\n',
            '  ', '"', "'", 'null', 'true', '.nan', '.inf', '1e999', '-1', '0', '1e6', '[1, 2]',
            '{a: 1}', 'ball', 'sphere', '<<', '?', '\x00', '\u2028', '\U0001f600', '%', '@', '~',
            '2001-01-01', '0x', '99999999999999999999']


def mutated(text, chance):
    """Return a text with a few pieces removed, doubled, moved or replaced."""
    for _ in range(chance.randint(1, 4)):
        start = chance.randrange(len(text) + 1)
        end = min(len(text), start + chance.choice([0, 1, 1, 2, 5, 20]))
        piece = chance.choice([chance.choice(SNIPPETS), text[end:end + 10], '',
                               chance.choice(SNIPPETS) + text[start:end]])
        text = text[:start] + piece + text[end:]
    return text


def test_mutated_scenes_are_read_or_refused():
    chance = random.Random(20260)
    texts = [scene_to_yaml(load_scene(name)) for name in scene_names()]
    read = refused = 0
    for _ in range(1500):
        try:
            scene = parse_scene(mutated(chance.choice(texts), chance))
        except SceneError as error:
            assert len(str(error).splitlines()) == 1
            refused += 1
        else:
            assert parse_scene(scene_to_yaml(scene)) == scene
            read += 1
    assert read > 100
    assert refused > 500
