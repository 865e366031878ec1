# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The stages of a collocation method: states at instants of a step, side by side in Lanes.

Of each number of the state those of all stages lie in a row, in the memory.
"""

import math

from .memory import DENSE_SIZE, STAGES
from .radau_tableau import A, LAGRANGE, NODES
from ..physics.jit import formula
from ..physics.lanes import COUNT, lanes_at, put_lanes, spread, total
from ..physics.motion import rates
from ..physics.rotation import quaternion_rate_world
from ..physics.state import omega_at, quaternion_at, velocity_at


@formula
def stages_of(memory, place, i, batch):
    """Return component i of a row of stages: stages 0 to 3, or 4 to 7, as Lanes."""
    return lanes_at(memory, place + STAGES * i + COUNT * batch)


@formula
def mix(table, columns, memory, place, batch):
    """Return the product of a matrix of the table with the stages at a place, as Lanes."""
    sum_ = lanes_at(table, columns + COUNT * batch) * memory[place]
    for j in range(1, STAGES):
        sum_ = sum_ + lanes_at(table, columns + STAGES * j + COUNT * batch) * memory[place + j]
    return sum_


@formula
def guess(bodies, rigid, size, table, h, y, rate, memory, here):
    """Write a guess of the stages: constant accelerations."""
    for batch in range(2):
        way = h * lanes_at(table, NODES + COUNT * batch)
        for i in range(size):
            value = y[i] + way * rate[i]
            if i < velocity_at(bodies):
                value = value + (0.5 * way) * (way * rate[velocity_at(bodies) + i])
            put_lanes(memory, here + STAGES * i + COUNT * batch, value)


@formula
def extrapolate(size, table, ratio, y, kept, memory, here, weights):
    """
    Write a guess of the stages: the polynomial through those of the step before, farther on.

    ratio: of the length of this step to that of the one before, whose last stage is y; kept: see
    keep; weights: a place for STAGES * STAGES numbers.
    """
    for batch in range(2):
        at_ = 1.0 + ratio * lanes_at(table, NODES + COUNT * batch)
        product = spread(1.0)
        for j in range(STAGES):
            product = product * (at_ - table[NODES + j])
        for j in range(STAGES - 1):
            put_lanes(memory, weights + STAGES * j + COUNT * batch,
                      table[LAGRANGE + j] * product / (at_ - table[NODES + j]))
    for i in range(size):
        first, second = spread(y[i]), spread(y[i])
        for j in range(STAGES - 1):
            way = kept[DENSE_SIZE * size + STAGES * i + j] - y[i]
            first = first + lanes_at(memory, weights + STAGES * j) * way
            second = second + lanes_at(memory, weights + STAGES * j + COUNT) * way
        put_lanes(memory, here + STAGES * i, first)
        put_lanes(memory, here + STAGES * i + COUNT, second)


@formula
def keep(size, memory, here, kept):
    """Copy the stages of a step to behind the polynomial of the last step."""
    for i in range(0, STAGES * size, COUNT):
        put_lanes(kept, DENSE_SIZE * size + i, lanes_at(memory, here + i))


@formula
def stage_rates(model, drive, table, size, t, h, memory, here, out, y, f):
    """Write the rates of all stages at `here` to `out`; y, f: Cells to use."""
    for batch in range(2):
        for i in range(size):
            y[i] = stages_of(memory, here, i, batch)
        rates(model, drive, t + h * lanes_at(table, NODES + COUNT * batch), y, f)
        for i in range(size):
            put_lanes(memory, out + STAGES * i + COUNT * batch, f[i])


@formula
def integrate(table, first, last, h, y, memory, rate, out):
    """Write to `out` the stages y + h A rate of the components `first` to `last` - 1."""
    for i in range(first, last):
        for batch in range(2):
            put_lanes(memory, out + STAGES * i + COUNT * batch,
                      y[i] + h * mix(table, A, memory, rate + STAGES * i, batch))


@formula
def quaternion_stages(bodies, rigid, memory, here, new, rate):
    """Write the rates of the orientations `here` with the angular velocities `new`."""
    for i in range(rigid):
        q, w = quaternion_at(bodies) + 4 * i, omega_at(bodies, rigid) + 3 * i
        for batch in range(2):
            change = quaternion_rate_world(
                (stages_of(memory, here, q, batch), stages_of(memory, here, q + 1, batch),
                 stages_of(memory, here, q + 2, batch), stages_of(memory, here, q + 3, batch)),
                (stages_of(memory, new, w, batch), stages_of(memory, new, w + 1, batch),
                 stages_of(memory, new, w + 2, batch)))
            for k in range(4):
                put_lanes(memory, rate + STAGES * (q + k) + COUNT * batch, change[k])


@formula
def integrate_all(bodies, rigid, size, table, h, y, memory, here, rate, new):
    """Write new stages: velocities from the rates, then positions and orientations from these."""
    integrate(table, velocity_at(bodies), quaternion_at(bodies), h, y, memory, rate, new)
    integrate(table, omega_at(bodies, rigid), size, h, y, memory, rate, new)
    for i in range(3 * bodies):
        for batch in range(2):
            put_lanes(memory, new + STAGES * i + COUNT * batch, y[i] + h * mix(
                table, A, memory, new + STAGES * (velocity_at(bodies) + i), batch))
    quaternion_stages(bodies, rigid, memory, here, new, rate)
    integrate(table, quaternion_at(bodies), omega_at(bodies, rigid), h, y, memory, rate, new)


@formula
def replace_stages(size, y, memory, here, new):
    """
    Copy the new stages; return the largest change of a component over max(1, size at the start).

    Of all its stages together, as the root of the sum of squares.
    """
    largest = 0.0
    for i in range(size):
        square = spread(0.0)
        for batch in range(2):
            there = stages_of(memory, new, i, batch)
            way = there - stages_of(memory, here, i, batch)
            square = square + way * way
            put_lanes(memory, here + STAGES * i + COUNT * batch, there)
        change = total(square) / max(1.0, y[i] * y[i])
        if not change <= largest:
            largest = change
    return math.sqrt(largest)
