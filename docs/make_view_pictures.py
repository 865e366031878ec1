# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Take the pictures of docs/viewing.md: the viewer's pages in a headless Chromium.

Needs playwright and a Chromium: docs/make_view_pictures.py PATH_OF_CHROMIUM
"""

from contextlib import contextmanager
from pathlib import Path
import re
import subprocess
import sys
import tempfile

from playwright.sync_api import sync_playwright

DOCS = Path(__file__).resolve().parent
DESKTOP, PHONE = {'width': 1280, 'height': 760}, {'width': 390, 'height': 844}


@contextmanager
def viewer(*arguments):
    """Run the viewer; give the URL of its page."""
    process = subprocess.Popen([sys.executable, '-m', 'dynsim_ros.cli.view', *arguments],
                               stdout=subprocess.PIPE, text=True)
    try:
        yield re.search('open ([^ ]+)', process.stdout.readline()).group(1)
    finally:
        process.terminate()
        process.wait()


def take(browser, url, size, name, prepare):
    """Take a picture of a page after prepare(page)."""
    page = browser.new_page(viewport=size)
    page.set_default_timeout(60_000)
    page.goto(url)
    # The notice that there is no graphics card.
    page.get_by_role('alert').get_by_role('button').click()
    prepare(page)
    page.wait_for_timeout(6000)
    page.screenshot(path=DOCS / f'{name}.png')
    page.close()


def at(time):
    """Return what shows the instant of a time [s] and holds it."""
    def prepare(page):
        if page.get_by_role('button', name='Pause').is_visible():
            page.keyboard.press('Space')
        page.get_by_role('button', name='Play').wait_for()
        box = page.get_by_role('textbox').first
        box.fill(str(time))
        box.press('Enter')
    return prepare


def steered(page):
    """Show the parameters of the spring, after some seconds."""
    page.get_by_text('real-time factor').wait_for()
    menu = page.get_by_role('combobox', name='parameters')
    menu.fill('spring')
    menu.press('ArrowDown')
    menu.press('Enter')
    page.wait_for_timeout(8000)


def main(chromium):
    """Take all pictures."""
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        browser = playwright.chromium.launch(
            executable_path=chromium,
            args=['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'])
        bag = Path(folder, 'sphere_on_spring.mcap')
        subprocess.run([sys.executable, '-m', 'dynsim_ros.cli.simulate', 'sphere_on_spring', '-q',
                        '--duration', '10', '--output', bag], check=True)
        with viewer(str(bag)) as url:
            take(browser, url, DESKTOP, 'view_recorded', at(2.2))
            take(browser, url, PHONE, 'view_phone', at(2.2))
        with viewer('--live', '--simulate') as url:
            take(browser, url, DESKTOP, 'view_live', steered)
        browser.close()


if __name__ == '__main__':
    main(*sys.argv[1:])
