# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What RViz, Foxglove and PlotJuggler are told to show is there in the default scene."""

import json
import re
from xml.etree import ElementTree

from dynsim_ros.messages.commands import command_topics
from dynsim_ros.messages.definitions import definition
from dynsim_ros.messages.scene_channels import scene_channels
from dynsim_ros.scene import load_scene
from dynsim_ros.simulation.layout import Layout
import pytest
from tree import ROOT
import yaml

CONFIG = ROOT / 'config'
DIAGNOSTICS = 'diagnostic_msgs/msg/DiagnosticArray'


@pytest.fixture(scope='module')
def topics():
    """Return {full name: type name} of what the default scene publishes and takes."""
    scene = load_scene('sphere_on_spring')
    found = {channel.topic: channel.type_name for channel in scene_channels(scene, Layout(scene))}
    found |= command_topics(scene)
    return {'/diagnostics': DIAGNOSTICS} | {
        topic if topic[0] == '/' else f'/dynsim/{topic}': kind for topic, kind in found.items()}


def test_rviz(topics):
    text = (CONFIG / 'sim.rviz').read_text(encoding='utf-8')
    manager = yaml.safe_load(text)['Visualization Manager']
    kinds = {'Wrench': 'WrenchStamped', 'Pose': 'PoseStamped', 'PublishPoint': 'PointStamped'}
    for part in manager['Displays'] + manager['Tools']:
        if 'Topic' in part:
            kind = part['Class'].rpartition('/')[2]
            assert topics[part['Topic']['Value']].endswith(f'/{kinds.get(kind, kind)}')


def named(value, key):
    """Yield what stands under a key anywhere in nested dicts and lists."""
    if isinstance(value, dict):
        for name, part in value.items():
            if name == key:
                yield part
            yield from named(part, key)
    elif isinstance(value, list):
        for part in value:
            yield from named(part, key)


def panels(layout):
    """Return the panels in a layout of Foxglove, from first to last."""
    if isinstance(layout, str):
        return [layout]
    return panels(layout['first']) + panels(layout['second'])


def check_field(topics, topic, fields):
    """Fail unless messages of a topic have a field: ['pose', 'position', 'x'] or ['data[3]']."""
    kind = topics[topic]
    for name in fields:
        found = {field.name: field for field in definition(kind).fields}[name.partition('[')[0]]
        assert found.is_sequence == name.endswith(']'), name
        kind = found.type_name
    assert '/' not in kind, f'{topic} {fields} is no number'


def test_foxglove(topics):
    layout = json.loads((CONFIG / 'foxglove_layout.json').read_text(encoding='utf-8'))
    shown = panels(layout['layout'])
    assert sorted(shown) == sorted(layout['configById'])
    assert {'3D', 'Plot', 'DiagnosticSummary', 'DiagnosticStatusPanel'} == {
        panel.partition('!')[0] for panel in shown}
    (scene,) = [part for name, part in layout['configById'].items() if name.startswith('3D!')]
    assert scene['followTf'] == 'world' and scene['topics'].keys() <= topics.keys()
    assert {name.partition(':')[2] for name in scene['transforms']} == {
        'world', 'dynsim/sphere', 'dynsim/hand'}
    assert topics[scene['publish']['pointTopic']] == 'geometry_msgs/msg/PointStamped'
    assert {topics[topic] for topic in named(layout, 'topicToRender')} == {DIAGNOSTICS}
    values = list(named(layout, 'value'))
    assert len(values) > 10
    for value in values:
        topic, *fields = value.split('.')
        check_field(topics, topic, fields)


def test_plotjuggler(topics):
    root = ElementTree.parse(CONFIG / 'plotjuggler.xml').getroot()
    curves = [curve.get('name') for curve in root.iter('curve')]
    assert len(curves) > 20
    for curve in curves:
        topic = max((topic for topic in topics if curve.startswith(f'{topic}/')), key=len)
        check_field(topics, topic, curve.removeprefix(f'{topic}/').split('/'))
    for splitter in root.iter('DockSplitter'):
        sizes = splitter.get('sizes').split(';')
        assert len(splitter) == len(sizes) == int(splitter.get('count'))
        assert re.fullmatch(r'[\d.]+', sizes[0])
