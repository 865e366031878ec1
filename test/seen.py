# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is to be seen on a page of the viewer."""

import math

import imageio.v3
import numpy as np

DESKTOP, PHONE = {'width': 1100, 'height': 640}, {'width': 390, 'height': 844}


def read_news(page):
    """Close what a page says at its start: that there is no graphics card is no news."""
    news = page.get_by_role('alert')
    news.get_by_role('button').click()
    # what fades away is not for axe to judge
    news.wait_for(state='detached')


def picture(page, part='canvas[data-engine]'):
    """Return a part of a page, the 3-D view: (height, width, 3) numbers from 0 to 255."""
    box = page.locator(part).first.bounding_box()
    return imageio.v3.imread(page.screenshot(clip=box))[..., :3]


def aspect(page):
    """Return the width of the 3-D view over its height."""
    box = page.locator('canvas[data-engine]').bounding_box()
    return box['width'] / box['height']


def is_blue(picture):
    """Return where a picture (…, 3) is as blue as the body: (…) of bool."""
    red, green, blue = np.moveaxis(picture.astype(int), -1, 0)
    return (blue > red + 60) & (blue > green + 40)


def body(page):
    """Return the middle of the body, which is blue: (x, y) [pixels of the page], or None."""
    seen = is_blue(picture(page))
    rows, columns = np.nonzero(seen)
    if len(rows) < 10:
        return None
    box = page.locator('canvas[data-engine]').bounding_box()
    return np.array([box['x'], box['y']]) + box['width'] / seen.shape[1] * np.array(
        [np.median(columns), np.median(rows)])


class Camera:
    """
    Where places in the world are on a page.

    Its attributes are those of viser's cameras, so that a Space can set them.
    """

    def on_page(self, page, place):
        """Return (x, y) of a place (3,) [m] in pixels of a page."""
        box = page.locator('canvas[data-engine]').bounding_box()
        forward = np.subtract(self.look_at, self.position)
        forward /= np.linalg.norm(forward)
        right = np.cross(forward, (0.0, 0.0, 1.0))
        right /= np.linalg.norm(right)
        to = np.subtract(place, self.position)
        scale = 0.5 * box['height'] / math.tan(0.5 * self.fov) / (to @ forward)
        return (box['x'] + 0.5 * box['width'] + scale * (to @ right),
                box['y'] + 0.5 * box['height'] - scale * (to @ np.cross(right, forward)))
