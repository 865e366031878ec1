# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
How each body responds to a force and to a moment within a substep in which drag is implicit.

RESPONSE_SIZE numbers a body: 1 / (m + h b_1), then the inverse of I + h b_2: one number where no
body of the scene has an inertia matrix, else the symmetric matrix xx, xy, xz, yy, yz, zz in
world.
"""

from ..physics.jit import formula
from ..physics.motion import chosen, matrix_at, member
from ..physics.rotation import rotation_matrix
from ..physics.state import counts, quaternion, quaternion_at
from ..physics.vector import scale, transform

RESPONSE_SIZE = 7


@formula
def drag_of(drag):
    """Return a drag, 0 where it is absent."""
    if drag is not None:
        return drag
    return 0.0


@formula
def drags_of(air):
    """Return (linear, rotational) drag of the air."""
    if air is not None:
        return drag_of(air.linear_drag), drag_of(air.rotational_drag)
    return 0.0, 0.0


@formula
def fill_round(several, round_body, round_inertia, general_body, drag, h, responses):
    """Write the responses of the bodies with a scalar inertia."""
    if round_body is not None:
        for k in range(chosen(several, round_body)):
            i = RESPONSE_SIZE * member(several, round_body, k)
            response = 1.0 / (round_inertia[k] + h * drag)
            responses[i + 1] = response
            fill_matrix(general_body, i, response, responses)


@formula
def fill_matrix(general_body, i, response, responses):
    """Write a scalar response as a matrix, where other bodies need matrices."""
    if general_body is not None:
        nothing = response - response
        responses[i + 2] = nothing
        responses[i + 3] = nothing
        responses[i + 4] = response
        responses[i + 5] = nothing
        responses[i + 6] = response


@formula
def inverse_symmetric(xx, xy, xz, yy, yz, zz):
    """Return the inverse of a symmetric matrix, three rows."""
    a, b, c = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
    d = 1.0 / (xx * a + xy * b + xz * c)
    e, f, g = xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy
    return ((a * d, b * d, c * d), (b * d, e * d, f * d), (c * d, f * d, g * d))


@formula
def fill_general(several, bodies, general_body, inertia, drag, h, y, responses):
    """Write the responses of the bodies with an inertia matrix."""
    if general_body is not None:
        for k in range(chosen(several, general_body)):
            i = member(several, general_body, k)
            m = matrix_at(inertia, k)
            extra = h * drag
            inverse = inverse_symmetric(m[0][0] + extra, m[0][1] + 0.0 * extra,
                                        m[0][2] + 0.0 * extra, m[1][1] + extra,
                                        m[1][2] + 0.0 * extra, m[2][2] + extra)
            r = rotation_matrix(quaternion(y, quaternion_at(bodies) + 4 * i))
            x, y_, z = (transform(r, transform(inverse, r[0])),
                        transform(r, transform(inverse, r[1])),
                        transform(r, transform(inverse, r[2])))
            place = RESPONSE_SIZE * i
            responses[place + 1], responses[place + 2], responses[place + 3] = x[0], x[1], x[2]
            responses[place + 4], responses[place + 5] = y_[1], y_[2]
            responses[place + 6] = z[2]


@formula
def fill_responses(model, h, y, responses):
    """Write the responses of all bodies; h: Lanes; y: states; responses: Cells."""
    bodies, _ = counts(model)
    linear, rotational = drags_of(model.air)
    for i in range(bodies):
        responses[RESPONSE_SIZE * i] = 1.0 / (model.mass[i] + h * linear)
    fill_round(model.several, model.round_body, model.round_inertia, model.general_body,
               rotational, h, responses)
    fill_general(model.several, bodies, model.general_body, model.inertia, rotational, h, y,
                 responses)


@formula
def angular_response(general_body, responses, i, moment):
    """Return the angular acceleration of body i by a moment: (3,) in world."""
    place = RESPONSE_SIZE * i + 1
    if general_body is not None:
        xx, xy, xz = responses[place], responses[place + 1], responses[place + 2]
        yy, yz, zz = responses[place + 3], responses[place + 4], responses[place + 5]
        return transform(((xx, xy, xz), (xy, yy, yz), (xz, yz, zz)), moment)
    return scale(responses[place], moment)
