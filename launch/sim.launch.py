# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Start the simulator, and RViz beside it if wanted.

ros2 launch dynsim_ros sim.launch.py scene:=spinning_box rviz:=true
"""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

SHARE = Path(get_package_share_directory('dynsim_ros'))
UNSET = ''  # an argument left so is not handed on: the parameter file, then the node, decide
SWITCH = ['true', 'false', UNSET]


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument(
            'scene', default_value=UNSET,
            description='Name of a scene that comes with the package, or path of a YAML file; '
                        'empty: as in params_file'),
        DeclareLaunchArgument(
            'params_file', default_value=str(SHARE / 'config' / 'dynsim.yaml'),
            description='YAML file with parameters for the node'),
        DeclareLaunchArgument(
            'namespace', default_value='',
            description='Namespace of the node and of its topics and services'),
        DeclareLaunchArgument(
            'use_sim_time', default_value=UNSET, choices=SWITCH,
            description='Follow /clock from another publisher; empty: as in params_file'),
        DeclareLaunchArgument(
            'record', default_value=UNSET, choices=SWITCH,
            description='Record an MCAP bag from the start; empty: as in params_file'),
        DeclareLaunchArgument(
            'rviz', default_value='false', choices=['true', 'false'],
            description='Start RViz with a view of the scene'),
        OpaqueFunction(function=launch_nodes),
    ])


def launch_nodes(context):
    """Return the nodes to start, with the launch arguments' values put in."""
    values = {name: LaunchConfiguration(name).perform(context) for name in (
        'scene', 'params_file', 'namespace', 'use_sim_time', 'record', 'rviz')}
    clock = switches(use_sim_time=values['use_sim_time'])
    given = {**clock, **switches(**{'record.enable': values['record']})}
    if values['scene'] != UNSET:
        given['scene'] = values['scene']
    nodes = [Node(
        package='dynsim_ros', executable='sim_node', name='dynsim',
        namespace=values['namespace'],
        parameters=[values['params_file'], *([given] if given else [])],
        output='screen', emulate_tty=True)]
    if values['rviz'] == 'true':
        nodes.append(rviz(values['namespace'], clock))
    return nodes


def switches(**values):
    """Return the switches that were given, as bool parameters."""
    return {name: value == 'true' for name, value in values.items() if value != UNSET}


def rviz(namespace, clock):
    """Return RViz; its topics, absolute in the file, are moved into the namespace."""
    topics = ('dynsim/markers', 'dynsim/sphere/pose', 'dynsim/sphere/twist',
              'dynsim/sphere/wrench/net', 'dynsim/hand/command', 'dynsim/handles/update',
              'dynsim/handles/feedback', 'dynsim/handles/get_interactive_markers')
    return Node(
        package='rviz2', executable='rviz2', name='rviz2', namespace=namespace,
        arguments=['-d', str(SHARE / 'config' / 'sim.rviz')],
        parameters=[clock] if clock else [],
        remappings=[(f'/{topic}', topic) for topic in topics], output='screen')
