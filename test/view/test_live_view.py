# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A run shown and steered from a page: viewer, simulation and client are three processes."""

import re
import time

import numpy as np
from page_client import PageClient
import pytest
from scene_topics import forces, POSE, WRENCH, xyz

NODE = '/lab/dynsim'


@pytest.fixture(scope='module')
def node(start):
    return start('-r', '__ns:=/lab', '-p', 'rate:=200.0', name=NODE)


@pytest.fixture(scope='module')
def client(node, connect):
    client = connect(node)
    client.listen({'sphere/pose': POSE, 'hand/pose': POSE, 'sphere/wrench/net': WRENCH})
    return client


@pytest.fixture(scope='module')
def process(view, client):
    return view('--live', '--node', NODE)


@pytest.fixture(scope='module')
def open_page(process):
    """Give a function that opens the page once more."""
    opened = []

    def open_page():
        opened.append(PageClient(process.url))
        return opened[-1]

    yield open_page
    for page in opened:
        page.close()


@pytest.fixture(scope='module')
def page(open_page):
    return open_page()


def place(page, name='sphere'):
    return tuple(page.nodes[f'/world/{name}']['position'])


def press(page, label, value=True):
    page.enter(label, value)


def pause(page, client):
    """Pause from the page; return the place of the sphere when all is still."""
    if 'Pause' in page.controls:
        press(page, 'Pause')
        page.wait(lambda: 'Resume' in page.controls)
    client.drain()
    return xyz(client.last('sphere/pose').pose.position)


def resume(page):
    if 'Resume' in page.controls:
        press(page, 'Resume')
        page.wait(lambda: 'Pause' in page.controls)


def test_moves_with_the_simulation(page, client):
    first = place(page)
    page.wait(lambda: place(page) != first)
    still = pause(page, client)
    page.wait(lambda: np.array_equal(place(page), still))
    resume(page)


def test_one_tick_at_a_time(page, client):
    still = pause(page, client)
    heard = len(client.heard['sphere/pose'])
    press(page, 'run', 'step')
    client.wait(lambda: len(client.heard['sphere/pose']) > heard)
    after = pause(page, client)
    assert len(client.heard['sphere/pose']) == heard + 1
    assert not np.array_equal(after, still)
    page.wait(lambda: np.array_equal(place(page), after))
    resume(page)


def test_reset_from_the_page(page, client):
    pause(page, client)
    press(page, 'run', 'reset')
    page.wait(lambda: np.allclose(place(page), (0.3, 0.0, 1.2), atol=1e-12))
    resume(page)


def test_dragged_anchor_is_commanded(page, client):
    resume(page)
    page.drag('/world/hand_gizmo', (0.0, 0.0, 2.0), 'Start')
    for x in (0.1, 0.2, 0.3):
        page.drag('/world/hand_gizmo', (x, 0.0, 2.1))
    page.drag('/world/hand_gizmo', (), 'End')
    client.wait(lambda: np.allclose(xyz(client.last('hand/pose').pose.position), (0.3, 0.0, 2.1)))
    page.wait(lambda: np.allclose(place(page, 'hand'), (0.3, 0.0, 2.1)))


def grab(page, phase, end):
    start = place(page)
    page.send('SceneNodeDragMessage', phase=phase, name='/world/sphere/dark', instance_index=None,
              start_position=start, start_screen_pos=(0.5, 0.5), end_position=end,
              end_screen_pos=(0.5, 0.5), button='left', modifier=None, owner='')


def test_pulled_body_feels_a_force(page, client):
    resume(page)
    end = (2.0, 0.0, 1.5)
    grab(page, 'start', end)
    client.wait(lambda: forces(client.more('sphere/wrench/net'))[-1, 0] > 20.0)
    client.listen({'sphere/wrench_command': WRENCH})
    client.wait(lambda: forces(client.more('sphere/wrench_command'))[-1, 0] > 10.0)
    grab(page, 'end', end)
    client.wait(lambda: not forces(client.more('sphere/wrench_command'))[-1].any())


def test_slider_sets_a_parameter(page, client):
    press(page, 'stiffness [N/m]', 137.0)
    client.wait(lambda: client.get('spring.stiffness') == [137.0])
    client.configure({'spring.stiffness': 150.0})
    page.wait(lambda: page.controls['stiffness [N/m]']['value'] == 150.0)


def test_sliders_stay_within_the_ranges_of_the_descriptors(page, client):
    names = {'stiffness [N/m]': 'spring.stiffness', 'damping [N s/m]': 'spring.damping',
             'mass [kg]': 'sphere.mass', 'radius [m]': 'sphere.radius',
             'gravity [m/s^2]': 'gravity', 'real_time_factor': 'real_time_factor'}
    for (label, _), descriptor in zip(names.items(), client.describe(*names.values())):
        slider, bounds = page.controls[label], descriptor.floating_point_range[0]
        assert bounds.from_value <= slider['min'] < slider['max'] <= bounds.to_value, label
        assert slider['hint'] == descriptor.description


def test_what_the_simulation_refuses_is_told_and_undone(page, client):
    press(page, 'gravity [m/s^2]', -3.0)
    page.wait(lambda: any('gravity' in note for note in page.notes))
    page.wait(lambda: page.controls['gravity [m/s^2]']['value'] == 9.81)
    assert client.get('gravity') == [9.81]


def test_records(page, client, node):
    press(page, 'run', 'record')
    page.wait(lambda: 'stop recording' in page.controls['run']['options'])
    page.wait(lambda: any('recording to' in note for note in page.notes))
    (bag,) = node.bags
    press(page, 'run', 'stop recording')
    page.wait(lambda: 'record' in page.controls['run']['options'])
    assert bag.stat().st_size > 1000


def test_line_tells_how_the_run_fares(page):
    resume(page)
    found = page.wait(lambda: re.fullmatch(
        r'\*\*running\*\*, t = ([\d.]+) s, ([\d.]+) Hz, real-time factor ([\d.]+), '
        r'energy (\S+) J, drift (\S+) J', page.text))
    time_, rate, factor, _, drift = map(float, found.groups())
    assert time_ > 0.0 and rate == pytest.approx(200.0 * factor, abs=2.0)
    assert abs(drift) < 1e-6


def test_plots_are_fed(page):
    def newest():
        return max((props['data'][0][-1] for props in page.controls.values()
                    if props['type'] == 'GuiUplotMessage' and props['visible']), default=0.0)

    first = page.wait(newest)
    page.wait(lambda: newest() > first + 0.3)


def test_browser_that_does_not_keep_up_holds_nobody_up(page, client, process):
    def now():
        seconds = float(client.pause().message.split()[4])
        client.pause(False)
        return seconds

    def pace():
        """Return simulated seconds a second while this page takes in so many messages."""
        started, begun, count = time.monotonic(), now(), page.messages
        page.wait(lambda: page.messages > count + 600)
        return (now() - begun) / (time.monotonic() - started)

    usual = pace()
    lazy = PageClient(process.url, receive_buffer=4096)  # it reads nothing from here on
    assert pace() > 0.5 * usual
    lazy.close()


def test_a_page_that_was_closed_lets_go(open_page, client, page):
    """The anchor can be dragged by others when the browser that held it is gone."""
    resume(page)
    other = open_page()
    other.drag('/world/hand_gizmo', (0.3, 0.0, 2.1), 'Start')
    other.drag('/world/hand_gizmo', (0.2, 0.2, 2.0))
    client.wait(lambda: np.allclose(xyz(client.last('hand/pose').pose.position), (0.2, 0.2, 2.0)))
    other.close()
    page.drag('/world/hand_gizmo', (0.0, 0.0, 2.0), 'Start')
    page.drag('/world/hand_gizmo', (0.0, 0.0, 2.0))
    page.drag('/world/hand_gizmo', (), 'End')
    client.wait(lambda: np.allclose(xyz(client.last('hand/pose').pose.position), (0.0, 0.0, 2.0)))


def test_simulation_that_goes_is_missed(page, node, process):
    node.stop()
    page.wait(lambda: '**gone**' in page.text)
    assert 'Traceback' not in process.stop()
