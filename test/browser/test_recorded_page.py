# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded run in a browser, at the size of a desk and of a phone."""

from accessibility import faults
from bag_numbers import row
from dynsim_ros.view.recorded import RecordedPage
from dynsim_ros.view.recorded_run import read_run
from dynsim_ros.view.server import serving
import numpy as np
import pytest
from seen import body, DESKTOP, is_blue, PHONE, picture


@pytest.fixture(scope='module')
def process(view, bag):
    return view(bag)


@pytest.fixture(scope='module', params=[DESKTOP, PHONE], ids=['desktop', 'phone'])
def page(request, open_page, process):
    return open_page(process.url, request.param)


def is_paused(page):
    play = page.get_by_role('button', name='Play')
    page.get_by_role('button', name='Pause').or_(play).wait_for()
    return play.is_visible()


def shown_time(page):
    return float(page.get_by_role('slider').first.get_attribute('aria-valuenow'))


def legend(page):
    """Return {label: (value, half of what its last digit is worth)} of the first plot."""
    found = {}
    for line in page.locator('.u-legend').first.locator('tr').all():
        label, value = line.locator('.u-label').inner_text(), line.locator('.u-value').inner_text()
        found[label] = float(value), 0.5 * 10.0 ** -len(value.partition('.')[2]) + 1e-9
    return found


def pause(page):
    if not is_paused(page):
        page.keyboard.press('Space')
        page.get_by_role('button', name='Play').wait_for()


def wait_for_instant(page, bag, time):
    """Wait for the energies of a time [s]."""
    energy = row(bag, 'energy', time)
    page.get_by_text(f'energy {energy[3]:.6g} J, drift {energy[8]:.2g} J').wait_for()


def test_everything_can_be_reached_by_its_name(page):
    for name in ('start', '- tick', '+ tick'):
        assert page.get_by_role('button', name=name).is_visible()
    for role, name in (('combobox', 'speed'), ('checkbox', 'loop')):
        assert page.get_by_role(role, name=name).is_visible()
    if page.viewport_size == PHONE:
        page.get_by_role('button', name='Expand panel 3-D view').click()
    page.get_by_role('checkbox', name='force: spring').wait_for()
    for label in ('time [s]', 'section [s]', 'trail [s]', 'follow'):
        assert page.get_by_text(label, exact=True).first.is_visible()
    if page.viewport_size == PHONE:
        page.get_by_role('button', name='Collapse panel 3-D view').click()


def test_names_and_contrasts(page):
    for scheme in ('dark', 'light'):
        page.evaluate(f'document.documentElement.dataset.mantineColorScheme = "{scheme}"')
        assert faults(page) == []


def test_the_controls_of_a_phone_hide_nothing_of_the_body(open_page, process):
    page = open_page(process.url, PHONE)
    pause(page)
    wait_for_picture(page)
    seen = picture(page)
    title = page.get_by_text('run.mcap').bounding_box()['y'] * len(seen) / PHONE['height']
    rows, _ = np.nonzero(is_blue(seen[:int(title)]))
    assert 10 < len(rows) and rows.max() < 0.95 * title


def test_plays_and_obeys_the_keyboard(page):
    changed = ('from => document.querySelector("[role=slider]").getAttribute("aria-valuenow")'
               ' != from')
    if is_paused(page):
        page.keyboard.press('Space')
        page.get_by_role('button', name='Pause').wait_for()
    page.wait_for_function(changed, arg=shown_time(page))
    page.keyboard.press('Space')
    page.get_by_role('button', name='Play').wait_for()
    before = shown_time(page)
    page.keyboard.press('ArrowRight')
    page.wait_for_function(changed, arg=before)
    assert shown_time(page) - before == pytest.approx(0.005, abs=2e-4)
    for key, time in (('End', 2.0), ('Shift+ArrowLeft', 1.9), ('Home', 0.0),
                      ('Shift+ArrowRight', 0.1)):
        before = shown_time(page)
        page.keyboard.press(key)
        page.wait_for_function(changed, arg=before)
        assert shown_time(page) == pytest.approx(time, abs=2e-4)
    # A section that begins here, and ends up to five hundredths of it on.
    for key, after, time in (('I', 'Home', 0.1), ('Shift+ArrowRight', 'O', 0.195),
                             ('End', 'W', 0.195), ('End', 'End', 2.0)):
        for pressed in (key, after):
            page.keyboard.press(pressed)
        page.wait_for_function(
            'time => Math.abs(document.querySelector("[role=slider]").getAttribute('
            '"aria-valuenow") - time) < 1e-3', arg=time)


def test_scrubbing_moves_the_body(page, bag):
    pause(page)
    places = []
    for share in (0.2, 0.8):
        track = page.locator('.mantine-Slider-track').first.bounding_box()
        thumb = page.get_by_role('slider').first.bounding_box()
        page.mouse.move(thumb['x'] + 0.5 * thumb['width'], thumb['y'] + 0.5 * thumb['height'])
        page.mouse.down()
        page.mouse.move(track['x'] + share * track['width'], thumb['y'] + 5, steps=4)
        page.mouse.up()
        time = shown_time(page)
        assert abs(time - 2.0 * share) < 0.2
        wait_for_instant(page, bag, time)
        places.append(wait_for_picture(page))
    assert np.linalg.norm(places[0] - places[1]) > 5.0


def wait_for_picture(page):
    """Wait until the body stays where it is in the picture; return that place [pixels]."""
    place = None
    for _ in range(100):
        before, place = place, body(page)
        if before is not None and place is not None and np.abs(before - place).max() < 1.0:
            return place
    raise AssertionError('the picture does not come to rest')


def test_values_under_the_mouse_are_those_of_the_bag(page, bag):
    pause(page)
    box = page.get_by_role('textbox').first
    box.fill('1.0')
    box.press('Enter')
    wait_for_instant(page, bag, 1.0)
    if page.viewport_size == PHONE:
        page.get_by_role('button', name='Expand panel plots').click()
    page.get_by_role('combobox', name='plots').wait_for()
    over = page.locator('.u-over').first
    over.wait_for()
    box = over.bounding_box()
    over.hover(position={'x': 0.25 * box['width'], 'y': 0.5 * box['height']})
    page.wait_for_function('() => document.querySelector(".u-value").innerText != "--"')
    shown = legend(page)
    time, _ = shown.pop('t [s]')
    assert abs(time - 0.5) < 0.02
    # rows are 0.005 s apart, and their times are shown rounded
    rows = [row(bag, 'sphere/pose', time + shift)[:3] for shift in (-0.005, 0.0, 0.005)]
    assert any(all(abs(shown[axis][0] - value) <= shown[axis][1]
                   for axis, value in zip('xyz', values)) for values in rows), (shown, rows)


def is_lower(camera, server):
    """Return whether a camera looks at what is on a phone: the controls cover the lower part."""
    return camera.look_at[2] < server.initial_camera.look_at[2] - 0.1


def soon(page, condition):
    """Return whether condition() is true, waiting for it up to ten seconds."""
    for _ in range(100):
        if condition():
            return True
        page.wait_for_timeout(100)
    return False


@pytest.fixture
def newcomer(open_page):
    """Give a function that opens a page of a server, and returns it and its camera."""
    pages = []

    def newcomer(server, size):
        known = set(server.get_clients())
        page = open_page(f'http://localhost:{server.get_port()}', size)
        pages.append(page)
        assert soon(page, lambda: set(server.get_clients()) > known)
        (new,) = set(server.get_clients()) - known
        return page, server.get_clients()[new].camera

    yield newcomer
    # else they would look for the next server at this port
    for page in pages:
        page.close()


@pytest.mark.parametrize('size', [DESKTOP, PHONE], ids=['desktop', 'phone'])
def test_who_is_there_before_the_run_is_read_sees_the_same(newcomer, bag, size):
    with serving('localhost', None, 'run') as server:
        early, first = newcomer(server, size)
        with server.atomic():
            RecordedPage(server, read_run(bag))
        early.get_by_role('button', name='Pause').wait_for()
        late, second = newcomer(server, size)
        assert soon(late, lambda: np.allclose(first.position, second.position, atol=1e-3)
                    and np.allclose(first.look_at, second.look_at, atol=1e-3))
        assert soon(late, lambda: is_lower(second, server) == (size == PHONE))


def test_view_goes_with_the_page_until_it_is_turned(newcomer, bag):
    with serving('localhost', None, 'run') as server:
        with server.atomic():
            RecordedPage(server, read_run(bag))
        page, camera = newcomer(server, DESKTOP)
        for size in (PHONE, DESKTOP):
            page.set_viewport_size(size)
            assert soon(page, lambda size=size: is_lower(camera, server) == (size == PHONE))
        before = camera.position
        box = page.locator('canvas[data-engine]').bounding_box()
        x, y = box['x'] + 0.2 * box['width'], box['y'] + 0.1 * box['height']
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x + 100.0, y, steps=3)
        page.mouse.up()
        assert soon(page, lambda: not np.allclose(camera.position, before, atol=0.1))
        page.set_viewport_size(PHONE)
        assert soon(page, lambda: camera.aspect < 0.5)
        # for as long as it takes to answer
        page.wait_for_timeout(500)
        assert not is_lower(camera, server)
