# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What of a loaded bag is drawn: curves against time, in panels, body by body."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from dataclasses import dataclass, replace
import re

import numpy as np

from ..bag.load_columns import element_names, vectors
from ..bag.load_run import LoadedRun
from ..scene import Anchor, Particle, Rigid

# By type of message: what it tells, with its unit, and where that stands.
_QUANTITIES = {
    'geometry_msgs/msg/PoseStamped': (
        ('position', 'm', 'pose', 'position'), ('orientation', '', 'pose', 'orientation')),
    'geometry_msgs/msg/TwistStamped': (
        ('velocity', 'm/s', 'twist', 'linear'),
        ('angular velocity', 'rad/s', 'twist', 'angular')),
    'geometry_msgs/msg/WrenchStamped': (
        ('{} force', 'N', 'wrench', 'force'), ('{} torque', 'N m', 'wrench', 'torque')),
}
_WORK, _COMMAND = 'work_', 'wrench_command'
_MOST_COLUMNS = 4


@dataclass
class Panel:
    """
    Curves of one quantity: (n,) each, by name, over one time (n,) [s].

    unit: '' for a quaternion. hides_zeros: whether a curve that is zero throughout is left out.
    other: the same of a run to compare with, or None.
    """

    label: str
    unit: str
    time: np.ndarray
    curves: dict[str, np.ndarray]
    hides_zeros: bool = False
    other: Panel | None = None

    @property
    def shown(self) -> list[str]:
        """Return the names of the curves that are drawn, of this run and of the other one."""
        runs = [self, self.other] if self.other else [self]
        names = dict.fromkeys(name for run in runs for name in run.curves)
        return [name for name in names if not self.hides_zeros or any(
            run.curves[name].any() for run in runs if name in run.curves)]

    @property
    def has_key(self) -> bool:
        """Tell whether its curves are named in a key of its own: x to w have one for all."""
        return not set(self.shown) <= {*'xyzw', self.label}


@dataclass
class Block:
    """Rows of panels under one heading."""

    heading: str
    rows: list[list[Panel]]

    @property
    def columns(self) -> int:
        """Return how many panels lie side by side."""
        return max(map(len, self.rows))


def moving_anchors(run: LoadedRun) -> set[str]:
    """Return the names of the anchors that are not always in one place."""
    return {name for name, member in _members(run).items() if isinstance(member, Anchor)
            and f'{name}/pose' in run and np.ptp(run.position(name), axis=0).any()}


def bands(run: LoadedRun, anchors: Container[str] | None = None) -> list[list[Block]]:
    """
    Return what a bag has, as blocks that go side by side.

    That is a block for each body, or for each group of topics of another bag, one of anchors and
    one of energies. anchors: names of those that are wanted, None for all.
    """
    members = _members(run)
    bodies: dict[str, Block] = {}
    held, energies = [], []
    for topic in run:
        name = run.short(topic)
        owner = re.sub(r'/(pose|twist|wrench/\w+)$', '', name)
        if element_names(run[topic]):
            energies.append(Block(name, [_energies(run, topic)]))
        elif isinstance(members.get(owner), Anchor):
            if anchors is None or owner in anchors:
                held += [replace(panel, label=f'{owner} {panel.label}')
                         for panel in _motion(run, topic)[:1]]
        elif not name.endswith(_COMMAND):
            row = _motion(run, topic)
            if owner in members and not isinstance(members[owner], Rigid):
                # What its messages have room for, but a particle has not.
                row = row[:1]
            if row:
                bodies.setdefault(owner, Block(owner, [])).rows.append(row)
    if held:
        energies.insert(0, Block('anchors', [held[i:i + 3] for i in range(0, len(held), 3)]))
    return [*_side_by_side(bodies.values()), *([block] for block in energies)]


def _members(run: LoadedRun) -> Mapping[str, Particle | Anchor]:
    """Return bodies and anchors of a run by name, none where the bag has no scene."""
    return run.scene.ends if run.has_scene else {}


def _side_by_side(blocks: Iterable[Block]) -> list[list[Block]]:
    """Return blocks in bands of so many columns as go on a page."""
    found: list[list[Block]] = []
    for block in blocks:
        if not found or sum(part.columns for part in found[-1]) + block.columns > _MOST_COLUMNS:
            found.append([])
        found[-1].append(block)
    return found


def _motion(run: LoadedRun, topic: str) -> list[Panel]:
    """Return the panels of a pose, a twist or a wrench, none of other messages."""
    quantities = _QUANTITIES.get(run.channels[topic].type_name, ())
    kind = topic.rpartition('/')[2]
    found = []
    for label, unit, message, field in quantities:
        values = run[topic][message][field]
        parts = vectors(values, ''.join(values.dtype.names))
        if not unit:
            parts = _continuous(parts)
        found.append(Panel(label.format(kind), unit, run.time(topic),
                           dict(zip(values.dtype.names, parts.T))))
    return found


def _continuous(q: np.ndarray) -> np.ndarray:
    """Return quaternions (n, 4), each with the one of its two signs that is next to the last."""
    flips = np.where(np.sum(q[1:] * q[:-1], axis=1) < 0.0, -1.0, 1.0)
    return q * np.concatenate([[1.0], np.cumprod(flips)])[:, None]


def _energies(run: LoadedRun, topic: str) -> list[Panel]:
    """Return the panels of energies, of work that is done, and of what is missing of the two."""
    time, curves = run.time(topic), run.columns(topic)
    groups = {'energy': {}, 'work done': {}, 'imbalance': {}}
    for name, curve in curves.items():
        label = 'work done' if name.startswith(_WORK) else name
        groups.get(label, groups['energy'])[name.removeprefix(_WORK)] = curve
    panels = [Panel(label, 'J', time, group, hides_zeros=label == 'work done')
              for label, group in groups.items()]
    return [panel for panel in panels if panel.shown]
