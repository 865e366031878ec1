# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded run as its page has it: the 3-D view and the plots against the bag."""

import re
import socket
from time import monotonic
from urllib.parse import urlsplit
from urllib.request import urlopen

from bag_numbers import row, rows
from dynsim_ros.scene import load_scene
import numpy as np
from page_client import PageClient
import pytest
from scipy.spatial.transform import Rotation

SCENE = load_scene('sphere_on_spring')


@pytest.fixture(scope='module')
def process(view, bag):
    return view(bag)


@pytest.fixture
def open_page(process):
    """Give a function that opens the page once more."""
    opened = []

    def open_page():
        opened.append(PageClient(process.url))
        return opened[-1]

    yield open_page
    for page in opened:
        page.close()


@pytest.fixture
def page(open_page):
    return open_page()


def pause(page):
    if 'Pause' in page.controls:
        page.enter('Pause', True)
        page.wait(lambda: 'Play' in page.controls)


def shown_at(page, bag, time):
    """Show an instant; wait for it."""
    pause(page)
    page.enter('time [s]', time)
    place = row(bag, 'sphere/pose', time)[:3]
    page.wait(lambda: np.array_equal(page.nodes['/world/sphere']['position'], place))


def charts(page, group, first):
    """Show a group of plots, which has one of this title; return {title: data}."""
    def visible():
        return {title: [np.asarray(column) for column in props['data']]
                for title, props in page.controls.items()
                if props['type'] == 'GuiUplotMessage' and props['visible']}

    page.enter('plots', group)
    page.wait(lambda: any(title.startswith(first) for title in visible()))
    return visible()


def test_page_is_served_whole(process):
    with urlopen(process.url) as response:
        content = response.read().decode()
    assert response.status == 200
    # scripts and styles are in it, so that nothing has to be fetched
    assert '<html' in content
    assert '<script src=' not in content and 'rel="stylesheet"' not in content


def test_listens_on_this_machine_alone(process):
    port = urlsplit(process.url).port
    # what listens on all addresses listens on this one, too
    with pytest.raises(ConnectionRefusedError):
        socket.create_connection(('127.0.0.2', port), timeout=10.0)


def test_everything_in_the_scene_is_drawn(page):
    kinds = {name: node['type'] for name, node in page.nodes.items()}
    assert kinds['/world/floor'] == 'GridMessage'
    assert [kinds[f'/world/axes{axis}'] for axis in ('', '/x', '/y', '/z')] == [
        'FrameMessage', *['LabelMessage'] * 3]
    assert kinds['/world/sphere/light'] == kinds['/world/sphere/dark'] == 'MeshMessage'
    assert kinds['/world/hand'] == 'BoxMessage'
    assert kinds['/world/spring'] == 'MeshMessage'
    assert kinds['/world/sphere_trail'] == 'LineSegmentsMessage'
    for kind in ('spring', 'damper', 'air', 'gravity', 'net'):
        assert kinds[f'/world/forces/sphere/{kind}'] == 'ArrowMessage'


def test_marking_covers_half_of_the_body(page):
    """Both colours together are the whole sphere: their areas are equal, their sum its surface."""
    areas = []
    for part in ('light', 'dark'):
        node = page.nodes[f'/world/sphere/{part}']
        assert node['scale'] == [SCENE.bodies[0].radius] * 3
        corners = node['vertices'].reshape(-1, 3)[node['faces'].reshape(-1, 3)]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        assert (np.sum(normals * corners.mean(axis=1), axis=1) > 0.0).all()
        areas.append(0.5 * np.linalg.norm(normals, axis=1).sum())
    assert areas[0] == pytest.approx(areas[1])
    assert sum(areas) == pytest.approx(4.0 * np.pi, rel=0.01)


@pytest.mark.parametrize('time', [0.5, 1.25])
def test_instant_that_was_chosen(page, bag, time):
    shown_at(page, bag, time)
    x, y, z, w = row(bag, 'sphere/pose', time)[3:]
    page.wait(lambda: np.allclose(page.nodes['/world/sphere']['wxyz'], (w, x, y, z)))


def test_spring_reaches_from_anchor_to_body_in_the_colour_of_its_force(page, bag):
    found = {}
    for time in (0.0, 0.15, 1.0):
        shown_at(page, bag, time)
        pose = row(bag, 'sphere/pose', time)
        end = pose[:3] + Rotation.from_quat(pose[3:]).apply(SCENE.bodies[0].default_offset)
        along = end - row(bag, 'hand/pose', time)[:3]
        spring = page.nodes['/world/spring']
        page.wait(lambda spring=spring, along=along: np.allclose(
            spring['scale'], (1.0, 1.0, np.linalg.norm(along))))
        assert np.allclose(spring['position'], (0.0, 0.0, 2.0))
        direction = Rotation.from_quat(np.roll(spring['wxyz'], -1)).apply((0.0, 0.0, 1.0))
        assert np.allclose(direction, along / np.linalg.norm(along))
        pull = row(bag, 'sphere/wrench/spring', time)[:3] @ -along
        found[pull] = spring['color'][0] - spring['color'][2]
    forces = sorted(found)
    assert forces[0] < forces[-1]
    assert found[forces[0]] < found[forces[-1]]  # the more it pulls the redder it is


def test_arrows_are_the_forces(page, bag):
    shown_at(page, bag, 1.0)
    scale = page.controls['arrows [m/N]']['value']
    for kind in ('spring', 'gravity'):
        force = row(bag, f'sphere/wrench/{kind}', 1.0)[:3]
        arrow = page.nodes[f'/world/forces/sphere/{kind}']
        page.wait(lambda arrow=arrow, force=force: np.allclose(
            arrow['points'].reshape(2, 3), (np.zeros(3), scale * force), atol=1e-6))
    assert not page.nodes['/world/forces/sphere/damper']['visible']
    page.enter('force: damper', True)
    page.wait(lambda: page.nodes['/world/forces/sphere/damper']['visible'])


def test_shadows_are_cast_if_wanted(page):
    assert not page.nodes['/sun']['cast_shadow']
    page.enter('shadows', True)
    page.wait(lambda: page.nodes['/sun']['cast_shadow'])


def test_trail_is_where_the_body_was(page, bag):
    shown_at(page, bag, 1.5)
    page.enter('trail [s]', 1.0)
    times, values = rows(bag, 'sphere/pose')
    path = values[(times > 0.49) & (times < 1.51), :3]

    def is_there():
        points = page.nodes['/world/sphere_trail']['points'].reshape(-1, 3)
        distances = np.linalg.norm(points[:, None] - path[None], axis=2)
        return distances.min(axis=1).max() < 1e-6 and distances[:, 0].min() < 0.05

    page.wait(is_there)


# group, title, unit, topic, first of the numbers in it
PLOTS = [('sphere: motion', 'sphere: position', 'm', 'sphere/pose', 0),
         ('sphere: motion', 'sphere: orientation', '', 'sphere/pose', 3),
         ('sphere: motion', 'sphere: velocity', 'm/s', 'sphere/twist', 0),
         ('sphere: motion', 'sphere: angular velocity', 'rad/s', 'sphere/twist', 3),
         ('sphere: forces', 'sphere: force of air', 'N', 'sphere/wrench/air', 0),
         ('sphere: forces', 'sphere: net force', 'N', 'sphere/wrench/net', 0),
         ('sphere: torques', 'sphere: torque of damper', 'N m', 'sphere/wrench/damper', 3),
         ('hand: motion', 'hand: position', 'm', 'hand/pose', 0),
         ('energy', 'energies', 'J', 'energy', 0),
         ('energy', 'work since the start', 'J', 'energy', 4),
         ('energy', 'drift of the energy', 'J', 'energy', 8)]
PREFIXES = {'f': 1e-15, 'p': 1e-12, 'n': 1e-9, 'µ': 1e-6, 'm': 1e-3, '': 1.0, 'k': 1e3}


@pytest.mark.parametrize('group, title, unit, topic, first', PLOTS)
def test_plots_hold_the_numbers_of_the_bag(page, bag, group, title, unit, topic, first):
    (prefix, data), = [(found.group(1), data) for text, data in charts(page, group, title).items()
                       if (found := re.fullmatch(rf'{title}(?: \[(.?){unit}\])?', text))]
    times, values = rows(bag, topic)
    assert np.allclose(data[0], times, rtol=0.0, atol=1e-9)
    for number, column in enumerate(data[1:], first):
        assert np.allclose(column * PREFIXES[prefix or ''], values[:, number],
                           rtol=1e-12, atol=0.0), number


def test_plots_are_there_for_every_force(page):
    plotted = charts(page, 'sphere: forces', 'sphere: force of air')
    assert [title.partition(' [')[0] for title in plotted] == [
        'sphere: force of spring', 'sphere: force of damper', 'sphere: force of air',
        'sphere: force of gravity', 'sphere: net force']


def test_what_one_browser_does_every_browser_shows(open_page, bag):
    first, second = open_page(), open_page()
    shown_at(first, bag, 0.75)
    place = row(bag, 'sphere/pose', 0.75)[:3]
    second.wait(lambda: np.array_equal(second.nodes['/world/sphere']['position'], place))
    second.enter('Play', True)
    first.wait(lambda: 'Pause' in first.controls)
    pause(second)


def test_cursor_of_the_plots_is_at_the_instant(page, bag):
    shown_at(page, bag, 0.5)
    page.wait(lambda: any('left:25.0000%' in props.get('content', '')
                          for props in page.controls.values()))


def test_nothing_is_sent_while_nothing_changes(page, bag):
    shown_at(page, bag, 0.5)
    last = [page.messages, monotonic()]

    def is_quiet():
        if page.messages != last[0]:
            last[:] = page.messages, monotonic()
        return monotonic() - last[1] > 1.0

    page.wait(is_quiet)


def test_ends_well(view, bag):
    """Also where a browser is there."""
    process = view(bag)
    page = PageClient(process.url)
    assert 'warning' not in process.stop()
    page.close()
