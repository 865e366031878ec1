# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""From a motion in closed form to its states, at any instants."""

from .tops import find_constants, top_from
from .works import count_works
from ..closed_form import (along_spring, constant_of_whirl, flight, free_spin, on_centred_springs,
                           seconds, spin_down, spin_up, torque_free, turn_and_spin, whirl_series,
                           whirled)
from ...physics.jit import formula, kernel
from ...physics.state import (omega_at, put_quaternion, quaternion, quaternion_at, velocity_at)
from ...physics.vector import at, dot, put, subtract


@formula
def fly(mass, acceleration, drag, wind, t, bodies, start, y):
    """Write positions and velocities of bodies in free flight to y."""
    for i in range(bodies):
        v = velocity_at(bodies) + 3 * i
        position, velocity = flight(t, at(start, 3 * i), at(start, v), at(acceleration[i], 0),
                                    mass[i], drag, wind)
        put(y, 3 * i, position)
        put(y, v, velocity)


@formula
def move_centres(flights, centred, line, t, left, bodies, start, y):
    """Write positions and velocities to y; without any of the three they stay."""
    if flights is not None:
        fly(flights.mass, flights.acceleration, flights.drag, flights.wind, t, bodies, start, y)
    if centred is not None:
        position, velocity = on_centred_springs(
            t, at(start, 0), at(start, 3), centred.mass, centred.stiffness, centred.centre,
            centred.centre_velocity, centred.acceleration, centred.drag, centred.wind, left)
        put(y, 0, position)
        put(y, 3, velocity)
    if line is not None:
        position, velocity = along_spring(line.spring, t, left)
        put(y, 0, subtract(position, line.arm))
        put(y, 3, velocity)


@formula
def spin_freely(spins, t, left, bodies, rigid, start, y):
    """Write the rotations without resistance to y; return the work of commanded torques."""
    work = 0.0
    for k in range(spins.body.shape[0]):
        i = quaternion_at(bodies) + 4 * spins.body[k]
        j = omega_at(bodies, rigid) + 3 * spins.body[k]
        q, omega, acceleration = quaternion(start, i), at(start, j), at(spins.acceleration[k], 0)
        if dot(acceleration, acceleration) == 0.0:
            q, omega = free_spin(t, q, omega, left)
        else:
            q, omega, turn = spin_up(t, q, omega, acceleration)
            work += spins.inertia[k] * dot(acceleration, turn)
        put_quaternion(y, i, q)
        put(y, j, omega)
    return work


@formula
def slow_down(slowed, t, left, bodies, rigid, start, y):
    """Write the rotations about fixed axes with resistance to y; return the same."""
    work = 0.0
    for k in range(slowed.body.shape[0]):
        i = quaternion_at(bodies) + 4 * slowed.body[k]
        j = omega_at(bodies, rigid) + 3 * slowed.body[k]
        acceleration = at(slowed.acceleration[k], 0)
        q, omega, turn = spin_down(t, quaternion(start, i), at(start, j), slowed.inertia[k],
                                   slowed.drag, slowed.whirl, acceleration, left)
        put_quaternion(y, i, q)
        put(y, j, omega)
        work += slowed.inertia[k] * dot(acceleration, turn)
    return work


@formula
def find_series(whirls, bodies, rigid, start):
    """Write series and constants of all Whirls, from the state at the start, unless known."""
    if whirls.known[0]:
        return
    for k in range(whirls.body.shape[0]):
        i = whirls.body[k]
        whirl_series(at(start, omega_at(bodies, rigid) + 3 * i), at(whirls.final[k], 0),
                     whirls.decay[k], whirls.series[k])
        put_quaternion(whirls.constant[k], 0, constant_of_whirl(
            whirls.series[k], quaternion(start, quaternion_at(bodies) + 4 * i)))
    whirls.known[0] = True


@formula
def turn_with_air(whirls, t, left, bodies, rigid, start, y):
    """Write the rotations that the air takes along to y; return the work of commanded torques."""
    work = 0.0
    find_series(whirls, bodies, rigid, start)
    for k in range(whirls.body.shape[0]):
        j = omega_at(bodies, rigid) + 3 * whirls.body[k]
        acceleration = at(whirls.acceleration[k], 0)
        turn, omega = turn_and_spin(t, at(start, j), whirls.inertia[k], whirls.drag, whirls.whirl,
                                    acceleration)
        put_quaternion(y, quaternion_at(bodies) + 4 * whirls.body[k], whirled(
            t, whirls.series[k], whirls.constant[k], at(whirls.final[k], 0), whirls.decay[k],
            left))
        put(y, j, omega)
        work += whirls.inertia[k] * dot(acceleration, turn)
    return work


@formula
def turn_tops(tops, t, left, bodies, rigid, start, y):
    """Write the rotations without moments to y."""
    find_constants(tops, bodies, rigid, start)
    for k in range(tops.body.shape[0]):
        orientation, omega = torque_free(top_from(tops.constants[k]), t, left)
        put_quaternion(y, quaternion_at(bodies) + 4 * tops.body[k], orientation)
        put(y, omega_at(bodies, rigid) + 3 * tops.body[k], omega)


@formula
def turn_bodies(spins, slowed, whirls, tops, t, left, bodies, rigid, start, y):
    """Write orientations and angular velocities to y; return the work of commanded torques."""
    work = 0.0
    if spins is not None:
        work += spin_freely(spins, t, left, bodies, rigid, start, y)
    if slowed is not None:
        work += slow_down(slowed, t, left, bodies, rigid, start, y)
    if whirls is not None:
        work += turn_with_air(whirls, t, left, bodies, rigid, start, y)
    if tops is not None:
        turn_tops(tops, t, left, bodies, rigid, start, y)
    return work


@formula
def write_state(flights, centred, line, spins, slowed, whirls, tops, balance, bodies, rigid,
                start, time_ns, y):
    """Write the state at a time to y."""
    for i in range(start.shape[0]):
        y[i] = start[i]
    # The state at time 0 is the start to the last bit.
    if time_ns != 0:
        t, left = seconds(time_ns)
        move_centres(flights, centred, line, t, left, bodies, start, y)
        torque_work = turn_bodies(spins, slowed, whirls, tops, t, left, bodies, rigid, start, y)
        count_works(balance, t, bodies, rigid, start, torque_work, y)


@kernel
def evaluate(scene, first_ns, period_ns, states):
    """
    Write the states at instants that are evenly spaced to states: (n, size).

    scene: ClosedScene; first_ns, period_ns: integers [ns] since the beginning of the motion.
    """
    for i in range(states.shape[0]):
        write_state(scene.flights, scene.centred, scene.line, scene.spins, scene.slowed,
                    scene.whirls, scene.tops, scene.balance, scene.bodies, scene.rigid,
                    scene.start, first_ns + i * period_ns, states[i])
