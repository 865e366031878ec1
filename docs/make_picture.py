# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Draw the picture in README.md: a scene at one instant beside its run, computed without ROS.

    python docs/make_picture.py [--duration 10] [--instant 2.8] [--output FILE]

Needs matplotlib and Pillow besides dynsim_ros. The view suits scenes/sphere_on_spring.yaml.
"""

import argparse
from pathlib import Path

from drawing import (AXES, AZIMUTH, draw_sphere, draw_spring, draw_trail, ELEVATION, end_of_spring,
                     INK, PALE, PAPER, save, STYLE)
from dynsim_ros.scene import load_scene
from dynsim_ros.simulation import Simulator
from matplotlib import rc_context
from matplotlib.figure import Figure
import numpy as np

ENERGIES = {'kinetic': '#d9822b', 'gravitational': '#7a5aa6', 'spring': '#2a9d9d'}
TRAIL_SECONDS = 2.5
FLOOR, GRID = 0.95, 0.1         # m: height of the floor, width of its squares


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
    body, anchor, spring = scene.bodies[0], scene.anchors[0], scene.springs[0]
    snapshot = run.snapshots[now]
    centre, hand = snapshot.position(body.name), snapshot.anchor_position(anchor.name)
    hook = end_of_spring(snapshot, body.name, spring.to_offset)
    draw_floor(view)
    first = int(np.searchsorted(run.time, run.time[now] - TRAIL_SECONDS))
    draw_trail(view, run.position(body.name)[first:now + 1], FLOOR)
    view.plot(*np.array([hand, (hand[0], hand[1], FLOOR)]).T, ':', color=PALE, zorder=2)
    draw_sphere(view, centre, snapshot.orientation(body.name), body.radius)
    draw_spring(view, hand, hook, 8)
    view.scatter(*hook, color=INK, s=14, zorder=10, depthshade=False)
    view.scatter(*hand, color='#c9342b', marker='s', s=70, zorder=10, depthshade=False)
    view.text(*(hand + (0.05, 0, 0.0)), 'anchor', zorder=11, va='center')
    label = f'{spring.stiffness:g} N/m, {spring.damping:g} N s/m'
    view.text(*(0.5 * (hand + hook) + (0.09, 0, 0.05)), label, zorder=11)
    view.set(xlim=(-0.5, 0.5), ylim=(-0.5, 0.5), zlim=(FLOOR, 2.0))
    view.set_box_aspect((1.0, 1.0, 2.0 - FLOOR), zoom=1.09)
    view.view_init(elev=ELEVATION, azim=AZIMUTH)
    view.set_axis_off()


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


if __name__ == '__main__':
    main()
