# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recorded runs as arrays, beside the same run in memory and what mcap-ros2-support decodes."""

import subprocess
import sys

from dynsim_ros.bag import load
from dynsim_ros.bag.reader import BagError
from dynsim_ros.cli.simulate import main
from dynsim_ros.scene import load_scene, with_values
from dynsim_ros.simulation import MoveAnchor, PlaceBody, PushBody, SetValues, Simulator
from loaded import plain
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
import numpy as np
import pandas
import pytest
from recorded import record, TICK

COMMANDS = """
- {time: 0.1, anchor: hand, position: [0.2, 0, 2]}
- {time: 0.2, body: sphere, force: [0, 5, 0], torque: [0, 0, 0.1]}
- {time: 0.3, set: {spring.stiffness: 200, gravity: 1.62}}
- {time: 0.3, anchor: hand, position: [0.1, 0, 2]}
- {time: 0.3, set: {down: [0, 0, -1], integrator: rk4}}
"""
OF_VARYING_SIZE = {'/dynsim/parameter_command'}
MADE = [(100_000_000, MoveAnchor('hand', (0.2, 0.0, 2.0))),
        (200_000_000, PushBody('sphere', (0.0, 5.0, 0.0), (0.0, 0.0, 0.1))),
        (300_000_000, SetValues({'spring.stiffness': 200.0, 'gravity': 1.62})),
        (300_000_000, MoveAnchor('hand', (0.1, 0.0, 2.0))),
        (300_000_000, SetValues({'down': [0.0, 0.0, -1.0], 'integrator': 'rk4'}))]


@pytest.fixture(scope='module')
def path(tmp_path_factory):
    folder = tmp_path_factory.mktemp('bag')
    (folder / 'commands.yaml').write_text(COMMANDS)
    path = folder / 'run.mcap'
    assert main(['sphere_on_spring', '-d', '0.5', '-o', str(path), '-q', '--set', 'sphere.mass=2',
                 '-c', str(folder / 'commands.yaml')]) == 0
    return path


@pytest.fixture(scope='module')
def run(path):
    return load(path)


def as_dict(message):
    """Return a message of mcap-ros2-support as plain() has it."""
    if hasattr(message, '__slots__'):
        return {name: as_dict(getattr(message, name)) for name in message.__slots__}
    return [as_dict(part) for part in message] if isinstance(message, list) else message


def test_every_message(run, path):
    decoded = {}
    with open(path, 'rb') as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        for _, channel, message, found in reader.iter_decoded_messages():
            decoded.setdefault(channel.topic, []).append((message.log_time, as_dict(found)))
    assert set(decoded) == {*run, *OF_VARYING_SIZE} and run.problem is None
    for topic, values in run.items():
        found = zip(run.time_ns(topic).tolist(), map(plain, values), strict=True)
        for row, message in zip(found, decoded[topic], strict=True):
            assert as_lists(row) == as_lists(message)


def as_lists(value):
    """Return a value with bytes as lists of numbers: the two readers differ there."""
    if isinstance(value, dict):
        return {name: as_lists(part) for name, part in value.items()}
    return [as_lists(part) for part in value] if isinstance(value, (list, tuple, bytes)) else value


def test_views_of_a_run(run, path):
    simulator = Simulator(with_values(load_scene('sphere_on_spring'), {'sphere.mass': 2.0}))
    first = simulator.run(0.1)
    part = load(path, end=0.09)
    n = len(part.time('sphere/pose'))
    assert n == 10 and np.array_equal(part.time('sphere/pose'), first.time[:n])
    assert np.array_equal(part.position('sphere'), first.position('sphere')[:n])
    assert np.array_equal(part.velocity('sphere'), first.velocity('sphere')[:n])
    assert np.array_equal(part.quaternion('sphere'),
                          np.roll(first.orientation('sphere')[:n], -1, axis=1))
    assert np.array_equal(part.angular_velocity('sphere'), first.angular_velocity('sphere')[:n])
    assert np.array_equal(part.energy(), first.energy()[:n])
    assert np.array_equal(part.energy('imbalance'), first.imbalance()[:n])
    for kind in ('spring', 'damper', 'air', 'gravity', 'net'):
        forces, torques = zip(*(snapshot.wrench(kind, 'sphere')
                                for snapshot in first.snapshots[:n]))
        assert np.array_equal(part.force('sphere', kind), forces)
        assert np.array_equal(part.torque('sphere', kind), torques)
    assert np.array_equal(run.position('hand')[[10, 11, 30, 31], 0], [0.0, 0.2, 0.2, 0.1])
    assert np.diff(run.force('sphere')[20:22, 1])[0] == pytest.approx(5.0, abs=0.5)


def test_scene_parameters_and_commands(run, path):
    assert run.scene == with_values(load_scene('sphere_on_spring'), {'sphere.mass': 2.0})
    assert run.parameters['sphere.mass'] == 2.0 and run.parameters['integrator'] == 'auto'
    assert run.info['node'] == '/dynsim'
    assert run.commands == MADE
    assert load(path, end=0.2).commands == MADE[:2]
    assert run.left_out.keys() == OF_VARYING_SIZE
    assert run.left_out['/dynsim/parameter_command'] == (
        'they have 64 to 88 bytes, get them one by one by messages()')


def test_bodies_that_were_put_elsewhere(tmp_path):
    """At one tick with what was set, and with each other: each is a command of its own."""
    made = [(2 * TICK, command) for command in (
        PlaceBody('upper', {'position': [0.1, 0.0, 1.5], 'orientation': [0.0, 0.6, 0.0, 0.8]}),
        PlaceBody('lower', {'velocity': [0.0, 0.2, 0.0]}), SetValues({'gravity': 1.62}))]
    record(tmp_path / 'run.mcap', 'double_pendulum_of_spheres', 5, made, integrator='rk4')
    assert load(tmp_path / 'run.mcap').commands == made


def test_what_has_no_orientation(tmp_path, run):
    path = tmp_path / 'particle.mcap'
    assert main(['particle_on_spring', '-d', '0.1', '-o', str(path), '-q']) == 0
    of_particle = load(path)
    assert of_particle.velocity('particle').shape == (11, 3)
    for bag, name, what in ((of_particle, 'particle', 'a particle'), (run, 'hand', 'an anchor')):
        for ask in (bag.quaternion, bag.angular_velocity, bag.torque):
            with pytest.raises(BagError, match=f"^'{name}' is {what}: it has no orientation"):
                ask(name)


@pytest.mark.parametrize(('ask', 'said'), [
    (lambda run: run.position('spere'), "no topic 'spere/pose' in {}; did you mean "),
    (lambda run: run.force('sphere', 'wind'), "no topic 'sphere/wrench/wind' in {}; did you mean"),
    (lambda run: run.energy('kinetc'), "no energy 'kinetc' in {}; did you mean 'kinetic'?"),
    (lambda run: run['pose'],
     "'pose' is ambiguous in {}: /dynsim/sphere/pose, /dynsim/hand/pose")])
def test_wrong_names(run, ask, said):
    with pytest.raises(BagError) as caught:
        ask(run)
    assert str(caught.value).startswith(said.format(run.path))


def test_pandas(run, monkeypatch):
    table = run.to_pandas('sphere/pose')
    assert np.array_equal(table['pose.position.x'], run.position('sphere')[:, 0])
    assert np.array_equal(table.index, run.time('sphere/pose')) and table.index.name == 'time'
    assert (table['header.frame_id'] == 'world').all()
    assert isinstance(table, pandas.DataFrame)
    assert np.array_equal(run.to_pandas('energy')['spring'], run.energy('spring'))
    monkeypatch.setitem(sys.modules, 'pandas', None)
    with pytest.raises(ImportError, match='^to_pandas needs pandas: pip install pandas$'):
        run.to_pandas('sphere/pose')


def test_needs_no_ros_process(path):
    script = ('import sys; sys.modules["rclpy"] = sys.modules["geometry_msgs"] = None\n'
              'from dynsim_ros.bag import load\n'
              f'run = load({str(path)!r})\n'
              'print(run.position("sphere").shape, len(run.commands))')
    done = subprocess.run([sys.executable, '-c', script], capture_output=True, text=True,
                          check=True, timeout=100)
    assert done.stdout == '(51, 3) 5\n'
