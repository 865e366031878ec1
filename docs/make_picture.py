# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Draw the picture in README.md: a scene at one instant beside its run, computed without ROS.

    python docs/make_picture.py [--duration 10] [--instant 2.8] [--output FILE]

Needs matplotlib and Pillow besides dynsim_ros. The view suits scenes/sphere_on_spring.yaml.
"""

import argparse
from pathlib import Path

from dynsim_ros.physics.rotation import rotate, rotation_matrix
from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import Simulator
from matplotlib import rc_context
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
import numpy as np
from PIL import Image

# Background and ink are both part of the picture, so that the page may be light or dark.
PAPER, INK, PALE = '#fbfbf8', '#2b2f36', '#c9ccd2'
AXES = ('#c9342b', '#2c8a3d', '#2456c4')
ENERGIES = {'kinetic': '#d9822b', 'gravitational': '#7a5aa6', 'spring': '#2a9d9d'}
TRAIL = '#3d6fb6'
TRAIL_SECONDS = 2.5
FLOOR, GRID = 0.95, 0.1         # m: height of the floor, width of its squares
LIGHT = np.array([0.45, -0.55, 0.70]) / np.linalg.norm([0.45, -0.55, 0.70])
STYLE = {'font.size': 10, 'text.color': INK, 'axes.labelcolor': INK, 'axes.edgecolor': PALE,
         'xtick.color': INK, 'ytick.color': INK, 'axes.facecolor': PAPER, 'grid.color': PALE,
         'axes.spines.top': False, 'axes.spines.right': False, 'grid.linewidth': 0.5,
         'figure.facecolor': PAPER, 'font.family': 'DejaVu Sans'}


def main():
    parser = argparse.ArgumentParser(description='Draw the picture in README.md.')
    parser.add_argument('--duration', type=float, default=10.0, help='simulated time [s]')
    parser.add_argument('--instant', type=float, default=2.8, help='time of the 3-D view [s]')
    parser.add_argument('--output', type=Path,
                        default=Path(__file__).with_name('sphere_on_spring.png'))
    options = parser.parse_args()
    scene = load_scene('sphere_on_spring')
    run = Simulator(scene).run(options.duration)
    with rc_context(STYLE):
        figure = Figure(figsize=(12, 6), dpi=150)
        view = figure.add_axes((-0.06, -0.075, 0.60, 1.16), projection='3d',
                               computed_zorder=False)
        draw_scene(view, scene, run, int(np.searchsorted(run.time, options.instant)))
        grid = figure.add_gridspec(3, 1, left=0.53, right=0.985, top=0.965, bottom=0.085,
                                   hspace=0.16)
        draw_plots([figure.add_subplot(row) for row in grid], run, options.instant)
        snapshot = f'{scene.name} at {options.instant:.2f} s'
        figure.text(0.02, 0.94, snapshot, weight='bold', fontsize=12)
        figure.text(0.02, 0.905, f'trail: {TRAIL_SECONDS:g} s; squares: {GRID:g} m', fontsize=9)
        save(figure, options.output)


def draw_scene(view, scene, run, now):
    """Draw floor, trail, sphere with body axes, spring and anchor at the instant `now`."""
    body, anchor = scene.bodies[0], scene.anchors[0]
    snapshot = run.snapshots[now]
    centre, hand = snapshot.position(body.name), snapshot.anchor_position(anchor.name)
    q = snapshot.orientation(body.name).tolist()
    hook = centre + rotate.py_func(q, body.default_offset)
    draw_floor(view)
    draw_trail(view, run, body.name, now)
    view.plot(*np.array([hand, (hand[0], hand[1], FLOOR)]).T, ':', color=PALE, zorder=2)
    draw_sphere(view, centre, np.array(rotation_matrix.py_func(q)), body.radius)
    spring = helix(hand, hook)
    view.plot(*spring.T, color=PAPER, lw=3.4, zorder=8)
    view.plot(*spring.T, color='#5c626d', lw=1.5, zorder=9, solid_joinstyle='round')
    view.scatter(*hook, color=INK, s=14, zorder=10, depthshade=False)
    view.scatter(*hand, color='#c9342b', marker='s', s=70, zorder=10, depthshade=False)
    view.text(*(hand + (0.05, 0, 0.0)), 'anchor', zorder=11, va='center')
    k, b = scene.springs[0].stiffness, scene.springs[0].damping
    view.text(*(0.5 * (hand + hook) + (0.09, 0, 0.05)), f'{k:g} N/m, {b:g} N s/m', zorder=11)
    view.set(xlim=(-0.5, 0.5), ylim=(-0.5, 0.5), zlim=(FLOOR, 2.0))
    view.set_box_aspect((1.0, 1.0, 2.0 - FLOOR), zoom=1.09)
    view.view_init(elev=16, azim=-62)
    view.set_axis_off()


def helix(p, q, turns=9, radius=0.03):
    """Return (n, 3) points of a coil with straight ends from p to q."""
    along, share = q - p, np.linspace(0, 1, 400)
    first = np.cross(along, (0.0, 1.0, 0.0))
    first /= np.linalg.norm(first)
    second = np.cross(along / np.linalg.norm(along), first)
    angle = 2 * np.pi * turns * share
    width = radius * np.minimum(1.0, np.minimum(share, 1 - share) / 0.06) ** 2
    return (p + np.outer(share, along) + np.outer(width * np.cos(angle), first)
            + np.outer(width * np.sin(angle), second))


def draw_floor(view):
    """Draw the grid on the floor and the directions of world x and y."""
    ends = np.array([-0.4, 0.4])
    for at in np.arange(-4, 5) * GRID:
        view.plot([at, at], ends, FLOOR, color=PALE, lw=0.7, zorder=0)
        view.plot(ends, [at, at], FLOOR, color=PALE, lw=0.7, zorder=0)
    for i, name in enumerate('xy'):
        end = [-0.4, -0.4]
        end[i] += 0.22
        view.plot([-0.4, end[0]], [-0.4, end[1]], [FLOOR, FLOOR], color=AXES[i], lw=2, zorder=1)
        view.text(end[0] + 0.02, end[1] - 0.02, FLOOR, name, color=AXES[i], zorder=1)
    view.plot([-0.4, -0.4], [-0.4, -0.4], [FLOOR, FLOOR + 0.22], color=AXES[2], lw=2, zorder=1)
    view.text(-0.4, -0.4, FLOOR + 0.24, 'z', color=AXES[2], zorder=1)


def draw_trail(view, run, name, now):
    """Draw where the centre of mass was, and its projection onto the floor, paler with age."""
    first = int(np.searchsorted(run.time, run.time[now] - TRAIL_SECONDS))
    path = run.position(name)[first:now + 1]
    for i in range(len(path) - 1):
        age = i / len(path)
        x, y, z = path[i:i + 2].T
        view.plot(x, y, [FLOOR, FLOOR], color=INK, lw=1.0, alpha=0.02 + 0.25 * age, zorder=2,
                  solid_capstyle='butt')
        view.plot(x, y, z, color=TRAIL, lw=0.8 + 1.4 * age, alpha=0.1 + 0.8 * age, zorder=3,
                  solid_capstyle='butt')


def draw_sphere(view, centre, rotation, radius):
    """Draw a sphere with a pattern that turns with it, lit from a fixed side, and its axes."""
    longitude, latitude = np.meshgrid(np.linspace(0, 2 * np.pi, 97), np.linspace(0, np.pi, 49))
    fixed = np.stack([np.sin(latitude) * np.cos(longitude), np.sin(latitude) * np.sin(longitude),
                      np.cos(latitude)], axis=-1)
    turned = fixed @ rotation.T
    surface = centre + radius * turned
    dark = (np.floor(longitude / (np.pi / 4)) + np.floor(latitude / (np.pi / 4))) % 2 > 0
    tint = np.where(dark[..., None], to_rgb('#3f7fd0'), to_rgb('#dfe9f7'))
    colours = np.clip(tint * (0.55 + 0.5 * np.clip(turned @ LIGHT, 0, 1))[..., None], 0, 1)
    view.plot_surface(*np.moveaxis(surface, -1, 0), facecolors=colours, rstride=1, cstride=1,
                      linewidth=0, antialiased=False, shade=False, zorder=5)
    towards = viewing_direction()
    for axis, colour in zip(rotation.T, AXES):
        ends = centre + np.outer((1.0 if axis @ towards > 0 else 0.0, 1.75), radius * axis)
        view.plot(*ends.T, color=colour, lw=2.4, zorder=7 if axis @ towards > 0 else 4)


def viewing_direction():
    """Return the direction from the scene to the eye, for view_init(elev=16, azim=-62)."""
    elevation, azimuth = np.radians([16, -62])
    return np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth),
                     np.sin(elevation)])


def draw_plots(plots, run, instant):
    """Plot position, angular velocity and energies against time."""
    place, turn, energy = plots
    for i, axis in enumerate('xyz'):
        place.plot(run.time, run.position('sphere')[:, i], color=AXES[i], lw=1.3, label=axis)
        turn.plot(run.time, run.angular_velocity('sphere')[:, i], color=AXES[i], lw=1.3,
                  label=f'$\\omega_{axis}$')
    energies = [snapshot.energy for snapshot in run.snapshots]
    lowest = min(e.gravitational for e in energies)
    for name, colour in ENERGIES.items():
        zero = lowest if name == 'gravitational' else 0.0
        energy.plot(run.time, [getattr(e, name) - zero for e in energies], color=colour, lw=1.3,
                    label=name + (' above its lowest' if zero else ''))
    total = np.array([e.total for e in energies]) - lowest
    work = np.array([sum(e.work.values()) for e in energies])
    energy.plot(run.time, total, color=INK, lw=2.2, label='total')
    energy.plot(run.time, total[0] + work, '--', color='#f2c14e', lw=1.2,
                label='total at 0 s + work of damper, air')
    place.set(ylabel='position [m]', ylim=(-0.35, 1.6))
    turn.set(ylabel='angular velocity [rad/s]')
    energy.set(ylabel='energy [J]', xlabel='simulated time [s]', ylim=(-0.1, 5.1))
    for plot, corner in zip(plots, ((1.0, 0.78), (1.0, 1.06), (1.0, 1.06))):
        plot.set_xlim(0, run.time[-1])
        plot.grid(True)
        plot.axvline(instant, color=INK, lw=0.8, ls=':')
        plot.tick_params(labelbottom=plot is energy, length=3)
        plot.legend(loc='upper right', bbox_to_anchor=corner, ncols=3, fontsize=8.5,
                    facecolor=PAPER, edgecolor='none', framealpha=1.0, borderpad=0.2,
                    handlelength=1.5, columnspacing=1.2)


def save(figure, path):
    """Save the figure as a PNG with a palette of 256 colours."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())[..., :3]
    image = Image.fromarray(np.ascontiguousarray(pixels))
    image.quantize(256, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE).save(
        path, optimize=True)
    print(f'{path}: {image.width} x {image.height}, {path.stat().st_size / 1000:.0f} kB')


if __name__ == '__main__':
    main()
