# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The launch file and the configuration files, as far as they can be read without RViz."""

import ast

import pytest
from tree import ROOT
import yaml

LAUNCH = ROOT / 'launch' / 'sim.launch.py'
HANDLES = 'Interactive Markers Namespace'


def calls(name):
    """Return the calls of a function in the launch file, as (arguments, keyword arguments)."""
    tree = ast.parse(LAUNCH.read_text(encoding='utf-8'))
    return [(node.args, {word.arg: word.value for word in node.keywords})
            for node in ast.walk(tree)
            if isinstance(node, ast.Call) and getattr(node.func, 'id', None) == name]


def test_launch_file_compiles_and_has_its_entry():
    code = compile(LAUNCH.read_text(encoding='utf-8'), str(LAUNCH), 'exec')
    assert 'generate_launch_description' in code.co_names


def test_launch_arguments_are_described_and_have_defaults():
    declared = {}
    for arguments, keywords in calls('DeclareLaunchArgument'):
        declared[ast.literal_eval(arguments[0])] = keywords
    assert set(declared) == {
        'scene', 'params_file', 'namespace', 'use_sim_time', 'record', 'rviz'}
    for name, keywords in declared.items():
        assert 'default_value' in keywords, name
        assert ast.literal_eval(keywords['description']), name


def test_launch_starts_the_node_by_the_name_its_topics_have():
    started = {}
    for _, keywords in calls('Node'):
        words = {name: value.value for name, value in keywords.items()
                 if isinstance(value, ast.Constant)}
        started[words['package']] = words
    assert started['dynsim_ros']['executable'] == 'sim_node'
    assert started['dynsim_ros']['name'] == 'dynsim'
    assert started['rviz2']['executable'] == 'rviz2'


@pytest.fixture
def rviz():
    return yaml.safe_load((ROOT / 'config' / 'sim.rviz').read_text(encoding='utf-8'))


def test_rviz_shows_the_scene_in_its_frame(rviz):
    manager = rviz['Visualization Manager']
    assert manager['Global Options']['Fixed Frame'] == 'world'
    shown = {display['Class'].rpartition('/')[2]: display.get('Topic', {}).get('Value')
             for display in manager['Displays'] if display['Enabled']}
    assert shown == {
        'Grid': None, 'Axes': None, 'MarkerArray': '/dynsim/markers', 'TF': None,
        'Pose': '/dynsim/sphere/pose', 'TwistStamped': '/dynsim/sphere/twist',
        'Wrench': '/dynsim/sphere/wrench/net', 'InteractiveMarkers': None}


def test_rviz_moves_the_hand(rviz):
    tools = {tool['Class']: tool for tool in rviz['Visualization Manager']['Tools']}
    point = tools['rviz_default_plugins/PublishPoint']
    assert point['Topic']['Value'] == '/dynsim/hand/command'


def test_launch_moves_all_of_rviz_topics_into_the_namespace(rviz):
    manager = rviz['Visualization Manager']
    parts = manager['Displays'] + manager['Tools']
    used = {part['Topic']['Value'].lstrip('/') for part in parts if 'Topic' in part}
    (handles,) = [part[HANDLES].lstrip('/') for part in parts if HANDLES in part]
    used |= {f'{handles}/{name}' for name in ('update', 'feedback', 'get_interactive_markers')}
    moved = next(node.value for node in ast.walk(ast.parse(LAUNCH.read_text(encoding='utf-8')))
                 if isinstance(node, ast.Assign) and node.targets[0].id == 'topics')
    assert set(ast.literal_eval(moved)) == used


def test_parameter_file_has_the_form_ros_reads():
    parameters = yaml.safe_load((ROOT / 'config' / 'dynsim.yaml').read_text(encoding='utf-8'))
    assert list(parameters) == ['/**']
    assert set(parameters['/**']['ros__parameters']) == {
        'scene', 'integrator', 'tolerance', 'rate', 'real_time_factor', 'duration',
        'publish_clock', 'record'}
