# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the pictures in docs/ have in common: style, springs, trails, bodies that turn; PNG."""

from dynsim_ros.physics.rotation import rotate, rotation_matrix
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
import numpy as np
from PIL import Image

# Background and ink are both part of the picture, so that the page may be light or dark.
PAPER, INK, PALE = '#fbfbf8', '#2b2f36', '#c9ccd2'
AXES = ('#c9342b', '#2c8a3d', '#2456c4')
TRAIL = '#3d6fb6'
DARK, BRIGHT = to_rgb('#3f7fd0'), to_rgb('#dfe9f7')
LIGHT = np.array([0.45, -0.55, 0.70]) / np.linalg.norm([0.45, -0.55, 0.70])
ELEVATION, AZIMUTH = 16, -62
STYLE = {'font.size': 10, 'text.color': INK, 'axes.labelcolor': INK, 'axes.edgecolor': PALE,
         'xtick.color': INK, 'ytick.color': INK, 'axes.facecolor': PAPER, 'grid.color': PALE,
         'axes.spines.top': False, 'axes.spines.right': False, 'grid.linewidth': 0.5,
         'figure.facecolor': PAPER, 'font.family': 'DejaVu Sans'}


def viewing_direction():
    """Return the direction from the scene to the eye."""
    elevation, azimuth = np.radians([ELEVATION, AZIMUTH])
    return np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth),
                     np.sin(elevation)])


def end_of_spring(snapshot, name, offset):
    """Return where a spring is attached to an anchor or body: (3,) in world [m]."""
    if name in snapshot.layout.anchors:
        return snapshot.anchor_position(name)
    place, q = snapshot.position(name), snapshot.orientation(name)
    if q is None:
        return place
    offset = snapshot.scene.ends[name].default_offset if offset is None else offset
    return place + rotate.py_func(q.tolist(), offset)


def helix(p, q, turns=9, radius=0.03):
    """Return (n, 3) points of a coil with straight ends from p to q."""
    along, share = q - p, np.linspace(0, 1, 400)
    first = np.cross(along, np.eye(3)[np.argmin(np.abs(along))])
    first /= np.linalg.norm(first)
    second = np.cross(along / np.linalg.norm(along), first)
    angle = 2 * np.pi * turns * share
    width = radius * np.minimum(1.0, np.minimum(share, 1 - share) / 0.06) ** 2
    return (p + np.outer(share, along) + np.outer(width * np.cos(angle), first)
            + np.outer(width * np.sin(angle), second))


def draw_spring(view, p, q, zorder, **coil):
    """Draw a spring from p to q, set off against what is behind it."""
    spring = helix(p, q, **coil)
    view.plot(*spring.T, color=PAPER, lw=3.4, zorder=zorder)
    view.plot(*spring.T, color='#5c626d', lw=1.5, zorder=zorder + 1, solid_joinstyle='round')


def draw_trail(view, path, floor):
    """Draw where something was, (n, 3), and the projection onto the floor, paler with age."""
    for i in range(len(path) - 1):
        age = i / len(path)
        x, y, z = path[i:i + 2].T
        view.plot(x, y, [floor, floor], color=INK, lw=1.0, alpha=0.02 + 0.25 * age, zorder=2,
                  solid_capstyle='butt')
        view.plot(x, y, z, color=TRAIL, lw=0.8 + 1.4 * age, alpha=0.1 + 0.8 * age, zorder=3,
                  solid_capstyle='butt')


def draw_sphere(view, centre, q, radius, zorder=5):
    """Draw a sphere with a pattern that turns with it, and its axes; q: (w, x, y, z)."""
    rotation = matrix(q)
    longitude, latitude = np.meshgrid(np.linspace(0, 2 * np.pi, 97), np.linspace(0, np.pi, 49))
    fixed = np.stack([np.sin(latitude) * np.cos(longitude), np.sin(latitude) * np.sin(longitude),
                      np.cos(latitude)], axis=-1)
    turned = fixed @ rotation.T
    dark = (np.floor(longitude / (np.pi / 4)) + np.floor(latitude / (np.pi / 4))) % 2 > 0
    draw_surface(view, centre + radius * turned, np.where(dark[..., None], DARK, BRIGHT), turned,
                 zorder)
    draw_axes(view, centre, rotation, 3 * [radius], zorder)


def draw_box(view, centre, q, size, zorder=5):
    """Draw a box, each pair of its faces in a tint of its own, and its axes."""
    rotation, tints = matrix(q), (BRIGHT, 0.5 * (np.array(DARK) + BRIGHT), DARK)
    towards = viewing_direction()
    for axis in range(3):
        side = 1.0 if rotation[:, axis] @ towards > 0 else -1.0
        first, second = [np.linspace(-0.5, 0.5, 25) * size[(axis + i) % 3] for i in (1, 2)]
        face = np.zeros((25, 25, 3))
        face[..., axis] = side * 0.5 * size[axis]
        face[..., (axis + 1) % 3], face[..., (axis + 2) % 3] = np.meshgrid(first, second)
        normal = np.broadcast_to(side * rotation[:, axis], face.shape)
        draw_surface(view, centre + face @ rotation.T,
                     np.broadcast_to(tints[axis], face.shape), normal, zorder)
    draw_axes(view, centre, rotation, 0.5 * np.array(size), zorder)


def draw_surface(view, points, tint, normals, zorder):
    """Draw a surface, (n, m, 3) each, lit from a fixed side."""
    colours = np.clip(tint * (0.55 + 0.5 * np.clip(normals @ LIGHT, 0, 1))[..., None], 0, 1)
    view.plot_surface(*np.moveaxis(points, -1, 0), facecolors=colours, rstride=1, cstride=1,
                      linewidth=0, antialiased=False, shade=False, zorder=zorder)


def draw_axes(view, centre, rotation, reach, zorder):
    """Draw the axes of a body, in part hidden by it; reach: from its centre to its surface."""
    towards = viewing_direction()
    for axis, colour, length in zip(rotation.T, AXES, reach):
        is_near = axis @ towards > 0
        ends = centre + np.outer((1.0 if is_near else 0.0, 1.75), length * axis)
        view.plot(*ends.T, color=colour, lw=2.4, zorder=zorder + 2 if is_near else zorder - 1)


def matrix(q):
    """Return a quaternion (w, x, y, z) as a rotation matrix, (3, 3)."""
    return np.array(rotation_matrix.py_func(q.tolist()))


def save(figure, path, colours=256):
    """Save the figure as a PNG with a palette of so many colours."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())[..., :3]
    image = Image.fromarray(np.ascontiguousarray(pixels))
    image.quantize(colours, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE).save(
        path, optimize=True)
    print(f'{path}: {image.width} x {image.height}, {path.stat().st_size / 1000:.0f} kB')
