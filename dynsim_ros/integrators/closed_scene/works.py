# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The work done since the beginning of a motion in closed form.

That of a constant force is exact. The anchors' follows from the impulse of their springs, which
is what the momentum of the body that they hold has gained and what nothing else gave to it. What
is missing from the energy is then the work of air and damper. Where both act, a body moves along
its spring, and both follow from one integral of the square of the spring's rate.
"""

from ...physics.energies import energies, general_energies, round_energies
from ...physics.jit import formula
from ...physics.state import velocity_at, work_at
from ...physics.vector import add, at, dot, scale, subtract


@formula
def work_of_pushes(pushes, bodies, start, y):
    """Return the work of the commanded forces [J]; pushes: laid out as the state, or None."""
    total = 0.0
    if pushes is not None:
        for i in range(3 * bodies):
            total += pushes[velocity_at(bodies) + i] * (y[i] - start[i])
    return total


@formula
def anchor_work(holding, t, start, y):
    """Return the work of the anchors [J]: (force on the body that they hold) . (their way)."""
    way = subtract(at(y, 0), at(start, 0))
    gained = scale(holding.mass, subtract(at(y, 3), at(start, 3)))
    dragged = scale(holding.drag, subtract(way, scale(t, holding.wind)))
    impulse = subtract(add(gained, dragged), scale(t, holding.force))
    return dot(holding.velocity, impulse) + t * (holding.linear + t * holding.quadratic)


@formula
def damper_work(holding, t, start, y, lost):
    """
    Return the work of the damper [J].

    lost: that of damper and linear drag together. Along the spring the velocity is that of the
    anchor, V, and the rate L': the drag does -b (integral of L'^2 + V^2 + 2 V L' - wind . v).
    """
    way = subtract(at(y, 0), at(start, 0))
    anchor = holding.velocity
    steady = dot(subtract(holding.wind, scale(2.0, anchor)), way) + t * dot(anchor, anchor)
    square = (holding.drag * steady - lost) / (holding.damping + holding.drag)
    return -holding.damping * square


@formula
def spin_energy(model, bodies, rigid, y):
    """Return the kinetic energy of all rotations [J]."""
    return (round_energies(bodies, rigid, model.round_body, model.round_inertia, y)
            + general_energies(bodies, rigid, model.general_body, model.inertia, y))


@formula
def losses(balance, holding, t, bodies, rigid, start, torque_work, lost, y):
    """Return the works of damper and air [J]; lost: both together."""
    if holding is not None:
        if holding.damping > 0.0:
            spun = 0.0
            if balance.whirls:
                spun = (spin_energy(balance.model, bodies, rigid, y)
                        - balance.spin_energy) - torque_work
            damper = damper_work(holding, t, start, y, lost - spun)
            return damper, (lost - damper if balance.resists else 0.0)
    return 0.0, (lost if balance.resists else 0.0)


@formula
def holding_work(holding, t, start, y):
    """Return the work of the anchors, or nothing where there are none that could do work [J]."""
    if holding is not None:
        return anchor_work(holding, t, start, y)
    return 0.0


@formula
def count_works(balance, t, bodies, rigid, start, torque_work, y):
    """Add the works since the beginning to those in y, if works are counted."""
    if balance is not None:
        push = work_of_pushes(balance.pushes, bodies, start, y) + torque_work
        anchor = holding_work(balance.holding, t, start, y)
        kinetic, gravitational, spring = energies(balance.model, balance.anchors, t, y)
        gained = kinetic + gravitational + spring - balance.energy
        damper, air = losses(balance, balance.holding, t, bodies, rigid, start, torque_work,
                             gained - push - anchor, y)
        work = work_at(bodies, rigid)
        y[work] += damper
        y[work + 1] += air
        y[work + 2] += anchor
        y[work + 3] += push
