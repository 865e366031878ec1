# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a node is told when it starts: parameters that it takes, and those that it refuses."""

from live_node import start_refused, with_parameters
import pytest
from scene_topics import SPHERE

FILE = """\
/**:
  ros__parameters:
    gravity: 3
    sphere: {mass: 2, position: [1.0, 0.0, 1.5], orientation: [0.0, 0.0, 0.0, 1.0],
             angular_velocity: [0.0, 0.0, 5.0]}
    rate: 50
"""


def test_parameters_and_initial_conditions(start, connect, tmp_path):
    (tmp_path / 'given.yaml').write_text(FILE)
    # what is given later on the command line counts
    client = connect(start('--params-file', 'given.yaml', '-p', 'sphere.velocity:=[0,2,0]',
                           '-p', 'gravity:=4', folder=tmp_path))
    client.listen(SPHERE)
    client.more('sphere/pose')
    client.pause()
    client.reset()
    client.drain()
    pose, twist = client.last('sphere/pose'), client.last('sphere/twist')
    assert (pose.header.stamp.sec, pose.header.stamp.nanosec) == (0, 0)
    p, q, v, w = (pose.pose.position, pose.pose.orientation, twist.twist.linear,
                  twist.twist.angular)
    assert (p.x, p.y, p.z, q.x, q.y, q.z, q.w) == (1.0, 0.0, 1.5, 0.0, 0.0, 0.0, 1.0)
    assert (v.x, v.y, v.z, w.x, w.y, w.z) == (0.0, 2.0, 0.0, 0.0, 0.0, 5.0)
    assert client.last('sphere/wrench/gravity').wrench.force.z == -8.0
    assert client.get('gravity', 'sphere.mass', 'rate') == [4.0, 2.0, 50.0]
    assert [list(value) for value in client.get('sphere.position', 'sphere.velocity')] == [
        [1.0, 0.0, 1.5], [0.0, 2.0, 0.0]]


@pytest.mark.parametrize(('name', 'value', 'reason'), [
    ('sphere.mas', '1.0', "parameter 'sphere.mas' is not known; did you mean 'sphere.mass'?"),
    ('sphere.mass', 'heavy', "sphere.mass: 'heavy' is not a number; give a number in kg"),
    ('sphere.mass', '-1', 'sphere.mass: -1 kg is out of range: 1e-09 to 1e+06 kg'),
    ('spring.stiffness', '.nan', 'spring.stiffness: nan is not finite; give a number in N/m'),
    ('hand.position', '[0, 0]', 'hand.position: [0, 0] is not a list of 3 numbers in m'),
    ('sphere.mass', '[]', 'no value, such as an empty list'),
    ('scene', 'sphere_on_sprin', "did you mean 'sphere_on_spring'?"),
    ('record.enable', '1', 'record.enable: 1 is not true or false'),
])
def test_wrong_parameter(discovery, tmp_path, name, value, reason):
    assert reason in start_refused(tmp_path, *with_parameters({name: value}))


@pytest.mark.parametrize(('given', 'reason'), [
    ({'use_sim_time': 'true', 'publish_clock': 'true'},
     'cannot follow /clock (use_sim_time) and publish it'),
    ({'record.enable': 'true', 'record.directory': '/dev/null/runs'},
     'record.directory: /dev/null/runs cannot be written to: Not a directory'),
    ({'qos_overrides./dynsim/sphere/pose.publisher.deph': '3'},
     "did you mean 'qos_overrides./dynsim/sphere/pose.publisher.depth'?"),
])
def test_wrong_together(discovery, tmp_path, given, reason):
    assert reason in start_refused(tmp_path, *with_parameters(given))


def test_wrong_parameter_in_a_file(discovery, tmp_path):
    (tmp_path / 'wrong.yaml').write_text(FILE.replace('mass', 'mess'))
    assert "'sphere.mess' is not known; did you mean 'sphere.mass'?" in start_refused(
        tmp_path, '--params-file', 'wrong.yaml')
