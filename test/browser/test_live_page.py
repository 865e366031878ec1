# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A live run in a browser: what the mouse does there, the simulation answers."""

from accessibility import faults
from dynsim_ros.scene import load_scene
from dynsim_ros.view.space import Space
import numpy as np
import pytest
from scene_topics import forces, POSE, WRENCH, xyz
from seen import aspect, body, Camera, DESKTOP, PHONE, picture

HAND = np.array([0.0, 0.0, 2.0])
SPACE = Space.of_start(load_scene('sphere_on_spring'))

COUNT_NEW_CHARTS = """() => {
    window.made = 0;
    new MutationObserver(changes => { for (const change of changes)
        for (const node of change.addedNodes)
            if (node.classList && node.classList.contains('uplot')) window.made++;
    }).observe(document.body, {childList: true, subtree: true});
}"""


@pytest.fixture(scope='module')
def client(start, connect):
    client = connect(start('-p', 'rate:=100.0'))
    client.listen({'hand/pose': POSE, 'sphere/pose': POSE, 'sphere/wrench/net': WRENCH})
    return client


@pytest.fixture(scope='module')
def page(open_page, view, client):
    page = open_page(view('--live').url, DESKTOP)
    page.get_by_text('real-time factor').wait_for()
    return page


def hand(client):
    return xyz(client.last('hand/pose').pose.position)


def coloured(pixels):
    """Return how many pixels of a picture, (n, m, 3) uint8, have a colour."""
    return (np.ptp(pixels.astype(int), axis=2) > 60).sum()


def drag(page, start, end):
    page.mouse.move(*start)
    page.mouse.down()
    page.mouse.move(*end, steps=5)


def drag_until(page, client, take, is_answered):
    """
    Take hold of something and drag it, again where nothing answers, as a user would.

    take: does it; a browser that is too busy to have drawn it there yet has no hold of it.
    """
    try:
        for left in reversed(range(5)):
            take()
            try:
                return client.wait(is_answered, timeout=12.0)
            except AssertionError:
                if not left:
                    raise
                page.mouse.up()
    finally:
        page.mouse.up()


def test_plots_grow_and_are_not_made_anew(page, client):
    client.more('sphere/pose', 50)
    page.evaluate(COUNT_NEW_CHARTS)
    client.more('sphere/pose', 150)
    # a busy browser draws later than the node publishes
    client.wait(lambda: coloured(picture(page, '.uplot canvas')) > 15)
    assert page.evaluate('window.made') <= 2  # where a number outgrows its unit


@pytest.mark.parametrize('size, shift', [(DESKTOP, -0.1), (PHONE, 0.1)], ids=['desktop', 'phone'])
def test_dragging_the_gizmo_moves_the_anchor(page, client, size, shift):
    """By its upright arrow, along which the anchor goes then and nowhere else."""
    page.set_viewport_size(size)
    page.wait_for_timeout(1000)
    camera, place = Camera(), None

    def take():
        nonlocal place
        SPACE.look(camera, aspect(page))
        client.more('hand/pose')
        place = hand(client)
        grip = place + (0.0, 0.0, 0.18 * SPACE.size)
        drag(page, camera.on_page(page, grip), camera.on_page(page, grip + (0.0, 0.0, shift)))

    drag_until(page, client, take, lambda: abs(hand(client)[2] - place[2] - shift) < 0.02)
    np.testing.assert_allclose(hand(client)[:2], place[:2], atol=1e-6)


def test_pulling_the_body_pushes_it(page, client):
    page.set_viewport_size(DESKTOP)

    def take():
        client.pause()
        client.reset()
        page.get_by_role('button', name='Resume').wait_for()
        page.wait_for_timeout(1000)
        place = body(page)
        drag(page, place, place + (150.0, 0.0))
        client.pause(False)

    drag_until(page, client, take,
               lambda: forces(client.more('sphere/wrench/net'))[-1, 0] > 3.0)


def test_buttons_and_keys(page, client):
    # a page that is busy with what was just dragged tells late that the run goes on
    page.get_by_role('button', name='Pause').click(timeout=90_000)
    page.get_by_role('button', name='Resume').wait_for()
    page.get_by_text('paused').first.wait_for()
    client.drain()
    heard = len(client.heard['sphere/pose'])
    page.get_by_role('button', name='step').click()
    client.wait(lambda: len(client.heard['sphere/pose']) == heard + 1)
    page.keyboard.press('Space')
    client.more('sphere/pose')


def test_names_and_contrasts(page):
    assert faults(page) == []


def test_parameter_is_set_by_typing(page, client):
    menu = page.get_by_role('combobox', name='parameters')
    menu.fill('spring')
    menu.press('ArrowDown')
    menu.press('Enter')
    page.get_by_text('stiffness [N/m]').locator('visible=true').wait_for()
    row = page.get_by_text('stiffness [N/m]').locator('xpath=ancestor::*[.//input[@inputmode]][1]')
    box = row.get_by_role('textbox').first
    box.fill('150')
    box.press('Enter')
    client.wait(lambda: client.get('spring.stiffness') == [150.0])
