# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The viewer's pages in a headless Chromium; where there is none, these tests are not there."""

from chromium import chromium
from live_fixtures import connect, discovery, start
import pytest
from seen import read_news
from view_fixtures import bag, view

__all__ = ['bag', 'connect', 'discovery', 'start', 'view']
collect_ignore_glob = [] if chromium() else ['test_*.py']

# Of viser's gizmo while it is dragged: that the page will not be scrolled it has ensured before.
HARMLESS = 'Unable to preventDefault inside passive event listener invocation.'


@pytest.fixture(scope='session')
def browser():
    """Give a Chromium that draws without a graphics card."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=chromium(), args=[
                '--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'])
        yield browser
        browser.close()


@pytest.fixture(scope='module')
def open_page(browser):
    """Give a function that opens a page of a URL, which may neither complain nor fetch a thing."""
    pages, complaints, fetched = [], [], []

    def open_page(url, size):
        # without a graphics card each pixel costs time
        page = browser.new_page(viewport=size, device_scale_factor=0.5)
        page.set_default_timeout(30_000)
        pages.append(page)
        page.on('console', lambda message: complaints.append(message.text)
                if message.type == 'error' else None)
        page.on('pageerror', lambda error: complaints.append(str(error)))
        for event in ('request', 'websocket'):
            page.on(event, lambda request: fetched.append(request.url))
        page.goto(url)
        read_news(page)
        return page

    yield open_page
    own = tuple(scheme + page.url.partition('://')[2].rstrip('/') for page in pages
                for scheme in ('http://', 'ws://', 'file://'))
    for page in pages:
        page.close()
    assert set(complaints) <= {HARMLESS}
    assert [url for url in fetched if not url.startswith((*own, 'blob:', 'data:'))] == []
