# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The estimated error of a run is its error, as closed forms have it."""

from math import cos, sin

from dynsim_ros.scene import parse_scene
from dynsim_ros.simulation import SetValues, Simulator
from dynsim_ros.simulation.error_estimate import estimate_error
import pytest

OSCILLATOR = """
anchors: {origin: {position: [0, 0, 0]}}
bodies: {particle: {shape: particle, mass: 1, position: [1, 0, 0]}}
springs: {spring: {from: origin, to: particle, stiffness: 1, natural_length: 0}}"""
END = 10.0


def estimated_and_true(commands=(), **settings):
    """Return the estimated and the true errors of position [m] and velocity [m/s]."""
    simulator = Simulator(parse_scene(OSCILLATOR), **settings)
    for _, command in commands:
        simulator.apply(command)
    simulator.run(END)
    end, estimate = simulator.snapshot(), estimate_error(simulator, commands, END)
    return ((estimate.position, estimate.velocity),
            (abs(end.position('particle')[0] - cos(END)),
             abs(end.velocity('particle')[0] + sin(END))))


@pytest.mark.parametrize('settings', [
    {'integrator': 'explicit_euler', 'step': 1e-3}, {'integrator': 'leapfrog', 'step': 1e-2},
    {'integrator': 'rk4', 'step': 0.02}, {'integrator': 'dop853', 'tolerance': 1e-6}],
    ids=lambda settings: settings['integrator'])
@pytest.mark.parametrize('by_command', [False, True], ids=['from the start', 'by command'])
def test_is_the_error(settings, by_command):
    estimated, true = (estimated_and_true([(0, SetValues(settings))]) if by_command
                       else estimated_and_true(**settings))
    assert estimated == pytest.approx(true, rel=0.05)


def test_of_a_closed_form_it_is_rounding():
    simulator = Simulator(parse_scene(OSCILLATOR))
    assert str(estimate_error(simulator, [], END)).startswith('rounding alone')


@pytest.mark.parametrize('settings, reason', [
    ({'integrator': 'dop853', 'tolerance': 1e-14}, 'tolerance 1e-14 is the smallest one'),
    ({'integrator': 'rk4', 'step': 1.5e-7}, 'half of the step 1.5e-07 s would be below 1e-07 s')])
def test_none_where_no_run_is_more_exact(settings, reason):
    for simulator, commands in (
            (Simulator(parse_scene(OSCILLATOR), **settings), []),
            (Simulator(parse_scene(OSCILLATOR)), [(0, SetValues(settings))])):
        with pytest.raises(ValueError, match=reason):
            estimate_error(simulator, commands, 0.01)
