# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The kernel that writes the numbers of ticks to where a table says, in rows of bytes."""

from typing import NamedTuple

import numpy as np

from .tick_numbers import NumberArrays
from .unaligned import put_number
from ...integrators.entry import entry
from ...physics.energies import energies
from ...physics.jit import formula, kernel
from ...physics.state import counts, work_at
from ...physics.wrenches import wrenches

# What a row begins with, as a record does in an MCAP file: whether there is a message, how long
# the record is, channel and sequence number, then the time twice, then the message.
PRESENT = 5
LOG_TIME, PUBLISH_TIME, HEAD_SIZE = 15, 23, 31
_SECOND = 1_000_000_000


class RowTable(NamedTuple):
    """
    Where the rows of a block are, and what they hold.

    start: (rows,) first byte of each; stamp: (rows, 2) where seconds and nanoseconds go, -1 where
    a message has none; first: (rows + 1,) the numbers of row r are entries first[r] to
    first[r + 1] of place and number; place: where a number goes, number: which one, see Numbers.
    """

    start: np.ndarray
    stamp: np.ndarray
    first: np.ndarray
    place: np.ndarray
    number: np.ndarray


class Instants(NamedTuple):
    """
    Evenly spaced instants of a run without a change among them, nothing copied.

    model: Model; anchors: (n, 6) as in Drive; since_ns: time at the first instant since the
    anchors were so; pushes: laid out as the state; reference_energy: [J], see Energy; states:
    (instants, size); period_ns: from one to the next.
    """

    model: tuple
    anchors: np.ndarray
    since_ns: int
    pushes: np.ndarray
    reference_energy: float
    states: np.ndarray
    period_ns: int


# For their types alone: those of every scene are the same.
_NONE = np.zeros(0, np.int64)
_TABLE = RowTable(_NONE, np.zeros((0, 2), np.int64), _NONE, _NONE, _NONE)
_NUMBERS = NumberArrays(np.zeros(0), np.zeros((5, 0)), np.zeros((0, 6)), np.zeros(0))


@formula
def compute_forces(model, pushes, y, numbers):
    """Write forces and torques by kind, and their sum with the pushes, to NumberArrays."""
    forces = numbers.forces
    for i in range(forces.shape[0] - 1):
        for j in range(forces.shape[1]):
            forces[i, j] = 0.0
    wrenches(model, numbers.anchors, 0.0, y, forces[:4])
    for j in range(forces.shape[1]):
        forces[4, j] = forces[0, j] + forces[1, j] + forces[2, j] + forces[3, j] + pushes[j]


@formula
def compute_energies(model, reference_energy, y, numbers):
    """Write energies and works to NumberArrays."""
    out = numbers.energies
    out[0], out[1], out[2] = energies(model, numbers.anchors, 0.0, y)
    out[3] = out[0] + out[1] + out[2]
    bodies, rigid = counts(model)
    work = work_at(bodies, rigid)
    for i in range(4):
        out[4 + i] = y[work + i]
    out[8] = out[3] - reference_energy - (out[4] + out[5] + out[6] + out[7])


@formula
def compute_numbers(instants, k, with_forces, with_energies, numbers):
    """Write what is wanted of instant k to NumberArrays."""
    y, motion = instants.states[k], instants.anchors
    for i in range(y.shape[0]):
        numbers.values[i] = y[i]
    time = (instants.since_ns + k * instants.period_ns) * 1e-9
    for i in range(motion.shape[0]):
        for j in range(3):
            numbers.anchors[i, j] = motion[i, j] + motion[i, j + 3] * time
            numbers.anchors[i, j + 3] = motion[i, j + 3]
    if with_forces:
        compute_forces(instants.model, instants.pushes, y, numbers)
    if with_energies:
        compute_energies(instants.model, instants.reference_energy, y, numbers)


@formula
def write_row(table, r, stamp_ns, values, block):
    """Write one message to its row of a block."""
    start = table.start[r]
    block[start] = PRESENT
    put_number(block, start + LOG_TIME, np.int64(stamp_ns))
    put_number(block, start + PUBLISH_TIME, np.int64(stamp_ns))
    if table.stamp[r, 0] >= 0:
        put_number(block, table.stamp[r, 0], np.int32(stamp_ns // _SECOND))
        put_number(block, table.stamp[r, 1], np.int32(stamp_ns % _SECOND))
    for i in range(table.first[r], table.first[r + 1]):
        put_number(block, table.place[i], np.float64(values[table.number[i]]))


@kernel
def fill_rows(instants, stamp_ns, wanted, with_forces, with_energies, table, numbers, blocks):
    """
    Write the wanted messages of every instant to its block; the other rows are marked as absent.

    stamp_ns: of the first instant; wanted: (rows,) bool; with_forces, with_energies: whether a
    wanted row needs them; table: RowTable; numbers: NumberArrays, to work with; blocks: (instants
    at least, bytes of a block) uint8, which hold already what never changes.
    """
    for k in range(instants.states.shape[0]):
        compute_numbers(instants, k, with_forces, with_energies, numbers)
        for r in range(wanted.shape[0]):
            if wanted[r]:
                write_row(table, r, stamp_ns + k * instants.period_ns, numbers.values, blocks[k])
            else:
                blocks[k, table.start[r]] = 0


def prepare_rows(instants):
    """Compile, or load from the disk cache, what fill_rows needs for a kind of model."""
    return entry(fill_rows, instants, 0, np.zeros(0, bool), False, False, _TABLE, _NUMBERS,
                 np.zeros((1, 0), np.uint8))
