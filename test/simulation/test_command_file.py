# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Timed commands from a file, and the run that carries them out."""

from dynsim_ros.scene import load_scene, SceneError
from dynsim_ros.simulation import CommandError, MoveAnchor, PushBody, SetValues, Simulator
from dynsim_ros.simulation.command_file import read_commands
from dynsim_ros.simulation.offline import OfflineRun, simulator_with
import numpy as np
import pytest

SCENE = load_scene('sphere_on_spring')
GOOD = """
- {time: 0.205, set: {spring.stiffness: 200, rate: 50}}
- {time: 0.1, anchor: hand, position: [0.1, 0, 2]}
- {time: 0.1, body: sphere, force: [1, 0, 0], torque: [0, 0, 0.01]}
"""


class Sink:
    def __init__(self):
        self.snapshots, self.commands = [], []

    def tick(self, simulator):
        self.snapshots.append((simulator.time_ns, simulator.settings.tick_ns,
                               simulator.snapshot().state.tobytes()))

    def command(self, time_ns, command):
        self.commands.append((time_ns, command))


def read(tmp_path, text):
    path = tmp_path / 'commands.yaml'
    path.write_text(text, encoding='utf-8')
    return read_commands(path, SCENE)


def test_in_order_of_time(tmp_path):
    assert read(tmp_path, GOOD) == [
        (100_000_000, MoveAnchor('hand', (0.1, 0.0, 2.0))),
        (100_000_000, PushBody('sphere', (1.0, 0.0, 0.0), (0.0, 0.0, 0.01))),
        (205_000_000, SetValues({'spring.stiffness': 200, 'rate': 50}))]


@pytest.mark.parametrize('text, said', [
    ('anchor: hand', 'is not a list of commands, each beginning with "- time:"'),
    ('- hand', "command 1: 'hand' is not a mapping such as {time: 1, anchor: hand, position: [0, "
     '0, 2]}'),
    ('- {time: 1}', "command 1: {'time': 1} has no time, or none of anchor, body, set"),
    ('- {time: -1, anchor: hand, position: [0, 0, 2]}',
     'command 1: time: -1 s is out of range: 0 to 1e+09 s'),
    ('- {time: 1, anchor: hnd, position: [0, 0, 2]}',
     "command 1: 'hnd' is no anchor of this scene; did you mean 'hand'?"),
    ('- {time: 1, anchor: hand}', 'command 1: hand: position: None is not a list of 3 numbers in '
     'm'),
    ('- {time: 1, anchor: hand, positon: [0, 0, 2]}',
     "command 1: there is no field 'positon'; did you mean 'position'?"),
    ('- {time: 1, set: 5}', 'command 1: set: 5 is not a mapping of names to values'),
    ('- {time: 1, time: 2, set: {}}', "line 1: 'time' stands more than once"),
    ('- !!int x', "is not valid YAML: invalid literal for int() with base 10: 'x'"),
    ('[' * 5000, 'is nested too deeply')], ids=range(11))
def test_a_wrong_file_is_refused_with_one_line(tmp_path, text, said):
    with pytest.raises(CommandError) as caught:
        read(tmp_path, text)
    assert str(caught.value) == f'{tmp_path / "commands.yaml"}: {said}'


def test_commands_take_effect_at_the_first_tick_at_or_after_their_time(tmp_path):
    """The same as applying them by hand, to the bit."""
    sink = Sink()
    OfflineRun(Simulator(SCENE, rate=100), read(tmp_path, GOOD), sink).run(0.3)
    assert [time for time, _ in sink.commands] == [100_000_000, 100_000_000, 210_000_000]
    by_hand = Simulator(SCENE, rate=100)
    by_hand.run(0.1)
    by_hand.apply(MoveAnchor('hand', (0.1, 0, 2)))
    by_hand.apply(PushBody('sphere', (1, 0, 0), (0, 0, 0.01)))
    by_hand.run(0.11)
    by_hand.apply(SetValues({'spring.stiffness': 200, 'rate': 50}))
    by_hand.run(0.09)
    assert sink.snapshots[-1] == (310_000_000, 20_000_000, by_hand.snapshot().state.tobytes())
    assert len(sink.snapshots) == 1 + 21 + 5


def test_values_for_the_start_may_be_initial_conditions():
    simulator = simulator_with(SCENE, {'sphere.position': [1, 2, 3], 'rate': 50, 'gravity': 1})
    np.testing.assert_array_equal(simulator.snapshot().position('sphere'), (1, 2, 3))
    assert (simulator.settings.rate, simulator.scene.gravity) == (50.0, 1.0)
    with pytest.raises(SceneError, match="'rat' is no quantity .* did you mean 'rate'?"):
        simulator_with(SCENE, {'rat': 5})
