# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which plots there are of a run."""

from __future__ import annotations

from dataclasses import dataclass

from ..scene import Rigid

XYZ = ('x', 'y', 'z')
ENERGY = 'energy'
# Places in ~/energy.
_ENERGIES = ('kinetic', 'gravitational', 'spring', 'total')
_WORKS = ('damper', 'air', 'anchor', 'push')
IMBALANCE = 8
# What a wrench topic can be called, in the order in which they are shown.
WRENCHES = ('spring', 'damper', 'air', 'gravity', 'net')


@dataclass(frozen=True)
class Plot:
    """
    Some of the numbers of a topic against time.

    topic: relative to the node; columns: places of the numbers in a row; labels: one for each.
    """

    title: str
    unit: str
    topic: str
    columns: tuple
    labels: tuple


def catalogue(scene, topics):
    """Return {name of a group: [Plot]} of a scene whose run has some topics."""
    groups = {}
    for member in (*scene.bodies, *scene.anchors):
        for name, plots in _of_member(member, scene).items():
            groups[f'{member.name}: {name}'] = plots
    groups['energy'] = _of_energy()
    first = groups[f'{scene.bodies[0].name}: motion']
    groups = {'overview': [*first[:2], *groups['energy'][::2]], **groups}
    found = {name: [plot for plot in plots if plot.topic in topics]
             for name, plots in groups.items()}
    return {name: plots for name, plots in found.items() if plots}


def _of_member(member, scene):
    """Return {group: [Plot]} of a body or an anchor."""
    name = member.name
    pose, twist = f'{name}/pose', f'{name}/twist'
    motion = [Plot(f'{name}: position', 'm', pose, (0, 1, 2), XYZ)]
    if member in scene.anchors:
        return {'motion': motion}
    motion.append(Plot(f'{name}: velocity', 'm/s', twist, (0, 1, 2), XYZ))
    groups = {'motion': motion, 'forces': [
        Plot(f'{name}: force of {kind}' if kind != 'net' else f'{name}: net force', 'N',
             f'{name}/wrench/{kind}', (0, 1, 2), XYZ) for kind in WRENCHES]}
    if isinstance(member, Rigid):
        motion += [Plot(f'{name}: orientation', '', pose, (3, 4, 5, 6), (*XYZ, 'w')),
                   Plot(f'{name}: angular velocity', 'rad/s', twist, (3, 4, 5), XYZ)]
        groups['torques'] = [
            Plot(f'{name}: torque of {kind}' if kind != 'net' else f'{name}: net torque', 'N m',
                 f'{name}/wrench/{kind}', (3, 4, 5), XYZ) for kind in WRENCHES]
    return groups


def _of_energy():
    return [Plot('energies', 'J', ENERGY, (0, 1, 2, 3), _ENERGIES),
            Plot('work since the start', 'J', ENERGY, (4, 5, 6, 7), _WORKS),
            Plot('drift of the energy', 'J', ENERGY, (IMBALANCE,), ('drift',))]
