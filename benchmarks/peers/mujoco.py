# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
MuJoCo: the springs as spatial tendons with stiffness, damping and springlength.

Air resistance is the damping of the joints, for each axis, and a constant force for its own motion
(-b (v - v_air) = -b v + b v_air). There are no geoms, and all that is not needed is switched off.
All steps of a run are taken in one call.
"""

from dynsim_ros.scene import Rigid
import numpy as np
from quaternions import conjugate, rotated
from states import initial, moments_of_inertia, Places

from . import installed, Run, Setting, steps

INTEGRATORS = {'RK4': 'RK4', 'Euler': 'Euler', 'implicitfast': 'implicitfast',
               'implicit': 'implicit'}


def available():
    module, version = installed('mujoco')
    # Else it writes a file about every run that does not stay finite.
    module.set_mju_user_warning(lambda text: None)
    return version


def supports(case):
    if any(any(anchor.velocity) for anchor in case.scene.anchors):
        return 'its sites cannot be moved at a velocity that its dampers would know'
    return None


def settings(case):
    return [Setting(method, step) for method in INTEGRATORS
            for step in steps(case.duration, 0.1, 1e-6)]


def prepare(case, setting):
    import mujoco

    model = mujoco.MjModel.from_xml_string(xml(case.scene, setting))
    model.opt.timestep = setting.value
    data = mujoco.MjData(model)
    places = Places(case.scene)
    drag, whirl_drag = set_air(case.scene, places, model, data)
    model.dof_damping[:] = np.concatenate(
        [[drag] * 3 + [whirl_drag] * 3 * isinstance(body, Rigid) for body in places.bodies])
    position, velocity = to_mujoco(initial(case.scene), places)
    count = round(case.duration / setting.value)

    def run():
        data.qpos[:] = position
        data.qvel[:] = velocity
        data.time = 0.0
        mujoco.mj_step(model, data, nstep=count)
        return data

    return Run(run, lambda result: from_mujoco(result.qpos, result.qvel, places))


def xml(scene, setting):
    """Return MuJoCo's model of a scene."""
    def text(values):
        return ' '.join(map(repr, map(float, values)))

    def site(member, name, offset):
        return f'<site name="{name}" pos="{text(offset)}"/>'

    sites, tendons = {}, []
    for spring in scene.springs:
        ends = ((spring.from_, spring.from_offset, 'from'), (spring.to, spring.to_offset, 'to'))
        for end, offset, side in ends:
            member = scene.ends[end]
            default = getattr(member, 'default_offset', member.position) or (0.0, 0.0, 0.0)
            sites.setdefault(end, []).append(
                site(member, f'{spring.name}-{side}', default if offset is None else offset))
        tendons.append(
            f'<spatial stiffness="{spring.stiffness!r}" damping="{spring.damping or 0.0!r}" '
            f'springlength="{spring.natural_length!r}"><site site="{spring.name}-from"/>'
            f'<site site="{spring.name}-to"/></spatial>')
    world = [line for anchor in scene.anchors for line in sites.get(anchor.name, [])]
    bodies = [body_xml(body, sites.get(body.name, []), text) for body in Places(scene).bodies]
    gravity = [(scene.gravity or 0.0) * a for a in scene.down]
    return (f'<mujoco><option integrator="{INTEGRATORS[setting.method]}" '
            f'gravity="{text(gravity)}"><flag constraint="disable" contact="disable" '
            'equality="disable" frictionloss="disable" limit="disable" actuation="disable" '
            'warmstart="disable" sensor="disable" autoreset="disable"/></option>'
            '<compiler boundmass="0" boundinertia="0"/>'
            f'<worldbody>{"".join(world)}{"".join(bodies)}</worldbody>'
            f'<tendon>{"".join(tendons)}</tendon></mujoco>')


def body_xml(body, sites, text):
    if isinstance(body, Rigid):
        m = moments_of_inertia(body)
        joints = '<freejoint/>'
        inertia = (m[0, 0], m[1, 1], m[2, 2], m[0, 1], m[0, 2], m[1, 2])
    else:
        joints = ''.join(f'<joint type="slide" axis="{axis}"/>'
                         for axis in ('1 0 0', '0 1 0', '0 0 1'))
        inertia = (body.mass, body.mass, body.mass, 0.0, 0.0, 0.0)
    return (f'<body name="{body.name}">{joints}<inertial pos="0 0 0" mass="{body.mass!r}" '
            f'fullinertia="{text(inertia)}"/>{"".join(sites)}</body>')


def set_air(scene, places, model, data):
    """Let the air's own motion push the bodies; return its two resistances."""
    air = scene.air
    if air is None:
        return 0.0, 0.0
    drag, whirl_drag = air.linear_drag or 0.0, air.rotational_drag or 0.0
    for body in places.bodies:
        data.xfrc_applied[model.body(body.name).id] = [
            *(drag * a for a in air.velocity),
            *(whirl_drag * isinstance(body, Rigid) * a for a in air.angular_velocity)]
    return drag, whirl_drag


def to_mujoco(y, places):
    """Return qpos and qvel; the angular velocity of a free joint is in body axes."""
    position, velocity = [], []
    for i in range(len(places.bodies)):
        position.append(y[places.position(i)])
        velocity.append(y[places.velocity(i)])
        if i < places.rigid:
            q = y[places.orientation(i)]
            position.append(q)
            velocity.append(rotated(conjugate(q), y[places.angular_velocity(i)]))
    return np.concatenate(position), np.concatenate(velocity)


def from_mujoco(position, velocity, places):
    y, p, v = np.empty(places.size), 0, 0
    for i in range(len(places.bodies)):
        y[places.position(i)], y[places.velocity(i)] = position[p:p + 3], velocity[v:v + 3]
        p, v = p + 3, v + 3
        if i < places.rigid:
            q = np.array(position[p:p + 4])
            y[places.orientation(i)] = q
            y[places.angular_velocity(i)] = rotated(q, velocity[v:v + 3])
            p, v = p + 4, v + 3
    return y
