# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Kernels made ready ahead: where and when changes no bit of a run, and nothing waits for it."""

import json
from pathlib import Path
import sys
import threading

from dynsim_ros.integrators.entry import entry
from dynsim_ros.messages.scene_channels import scene_channels
from dynsim_ros.messages.tick_rows import TickRows
from dynsim_ros.physics.energies import energies
from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import SetValues, Simulator
from dynsim_ros.simulation.rehearsal import Rehearsal
from numba.core.compiler_lock import global_compiler_lock
import numpy as np
from plain import environment
import pytest
from tree import output_of

SCRIPT = Path(__file__).with_name('rehearse.py')
SCENE = load_scene('sphere_on_spring')


def over(rehearsal):
    assert rehearsal.is_over(120.0)
    return rehearsal.error


def ticks(simulator, count):
    for _ in range(count):
        simulator.advance_tick()
    return simulator.snapshot()


@pytest.mark.parametrize('method', ['auto', 'rk4'])
def test_a_rehearsal_changes_no_bit(method):
    found = []
    for rehearses in (False, True):
        simulator = Simulator(SCENE, integrator=method, tolerance=1e-6)
        ticks(simulator, 5)
        if rehearses:
            assert over(Rehearsal(simulator, {}, ahead=True)) is None
            assert over(Rehearsal(simulator, {'gravity': 3.0, 'hand.position': [1, 0, 2]})) is None
        ticks(simulator, 5)
        simulator.apply(SetValues({'gravity': 2.0}))
        found.append(ticks(simulator, 5))
    assert found[0].state.tobytes() == found[1].state.tobytes()
    assert found[0].scene == found[1].scene and found[0].energy == found[1].energy


def test_a_copy_goes_its_own_way():
    simulator = Simulator(SCENE, integrator='rk4')
    before = ticks(simulator, 3)
    copy = simulator.copy()
    copy.apply(SetValues({'hand.velocity': [1.0, 0.0, 0.0], 'gravity': 0.0}))
    ticks(copy, 3)
    after = simulator.snapshot()
    assert after.state.tobytes() == before.state.tobytes()
    np.testing.assert_array_equal(after.anchors, before.anchors)
    assert (simulator.tick, simulator.scene) == (3, SCENE)
    same = simulator.copy()
    assert ticks(same, 3).state.tobytes() == ticks(simulator, 3).state.tobytes()


def test_what_it_fails_of_is_kept():
    error = over(Rehearsal(Simulator(SCENE, integrator='rk4'), {'gravity': -1.0}))
    assert 'gravity: -1 m/s^2 is out of range' in str(error)


@pytest.mark.parametrize('values, same', [
    ({}, True), ({'gravity': 1.0, 'spring.stiffness': 7.0, 'sphere.mass': 2.0}, True),
    ({'hand.velocity': [0.0, 1.0, 0.0], 'rate': 50.0}, True),
    ({'gravity': 0.0}, False), ({'air.linear_drag': 0.0}, False), ({'spring.damping': 0.0}, False),
    ({'integrator': 'leapfrog'}, False), ({'tolerance': 1e-3}, True)])
def test_which_changes_need_other_kernels(values, same):
    simulator = Simulator(SCENE)
    assert (simulator.kernel_kind(values) == simulator.kernel_kind({})) is same
    assert simulator.scene == SCENE


@pytest.mark.parametrize('offset, same', [
    ([0.0, 0.0, 0.03], True), ([0.0, 0.0, -0.03], True), ([0.0, 0.0, 0.0], True),
    ([0.0, 0.05, 0.0], False), ([0.0, 0.05, 0.05], False)])
def test_another_axis_needs_other_kernels_where_the_structure_is_known(offset, same):
    simulator = Simulator(load_scene('double_pendulum_of_spheres'))
    values = {'lower_spring.from_offset': offset}
    assert (simulator.kernel_kind(values) == simulator.kernel_kind({})) is same


@pytest.mark.parametrize('tolerance, same', [(1e-6, True), (2e-8, True), (1e-9, False)])
def test_small_tolerances_need_other_kernels_where_bodies_hang_on_each_other(tolerance, same):
    """They keep the reaches of springs."""
    simulator = Simulator(load_scene('double_pendulum_of_spheres'), tolerance=1e-5)
    assert (simulator.kernel_kind({'tolerance': tolerance}) == simulator.kernel_kind({})) is same


def test_a_run_does_not_wait_for_another_thread_that_compiles():
    simulator = Simulator(SCENE, integrator='rk4')
    simulator.prepare()
    model, found = simulator.snapshot().model, []

    def run():
        now = ticks(simulator, 3)
        state = np.zeros_like(now.state)
        found.append(entry(energies, model, now.anchors, 0.0, state)(model, now.anchors, 0.0,
                                                                     state))
        simulator.apply(SetValues({'gravity': 1.0}))
        ticks(simulator, 3)
        rows = TickRows(scene_channels(SCENE, simulator.layout), simulator.layout)
        rows.fill(simulator.instant(), 0, rows.of())
        found.append(rows)

    with global_compiler_lock:
        thread = threading.Thread(target=run, daemon=True)
        thread.start()
        thread.join(30.0)
        assert not thread.is_alive() and len(found) == 2


def test_what_is_not_on_disk_is_compiled_by_another_process(tmp_path):
    found = json.loads(output_of([sys.executable, SCRIPT],
                                 env=environment(XDG_CACHE_HOME=str(tmp_path))))
    assert found == {'explicit_euler': 1, 'energies': 1, 'fill_rows': 1}
