# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Drake: a MultibodyPlant in continuous time with LinearSpringDamper elements.

Every body hangs on a QuaternionFloatingJoint whose damping, which acts on velocities in world, is
the air resistance; the air's own motion is a constant force (-b (v - v_air) = -b v + b v_air).
Nothing calls back into Python. A particle is a sphere that has no reason to turn.
"""

from dynsim_ros.scene import Rigid
import numpy as np
from states import initial, moments_of_inertia, Places

from . import installed, Run, Setting, steps, tolerances

ADAPTIVE = {'RK5': 'runge_kutta5', 'RK3': 'runge_kutta3', 'radau3': 'radau3',
            'implicit Euler': 'implicit_euler'}
FIXED_STEP = {'explicit Euler': 'explicit_euler', 'semi-explicit Euler': 'semi_explicit_euler'}
# Beyond these the implicit methods take minutes.
FINEST = {'RK5': -13, 'RK3': -12, 'radau3': -9, 'implicit Euler': -6}


def available():
    installed('pydrake.multibody.plant', 'drake')
    return installed('pydrake', 'drake')[1]


def supports(case):
    if any(any(anchor.velocity) for anchor in case.scene.anchors):
        return 'its force elements know no moving points of the world'
    if any(spring.natural_length == 0.0 for spring in case.scene.springs):
        return 'LinearSpringDamper needs a natural length above 0'
    return None


def settings(case):
    return ([Setting(method, accuracy) for method in ADAPTIVE
             for accuracy in tolerances(-1, FINEST[method])]
            + [Setting(method, step) for method in FIXED_STEP
               for step in steps(case.duration, 0.1, 1e-6)])


def prepare(case, setting):
    from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator

    plant = plant_of(case.scene)
    context = plant.CreateDefaultContext()
    set_air(case.scene, plant, context)
    simulator = Simulator(plant, context)
    scheme = (ADAPTIVE | FIXED_STEP)[setting.method]
    if setting.method in ADAPTIVE:
        # A longer first step can spoil the state so that the run never ends.
        integrator = ResetIntegratorFromFlags(simulator, scheme, case.duration / 20)
        integrator.set_fixed_step_mode(False)
        integrator.set_target_accuracy(setting.value)
        integrator.set_requested_minimum_step_size(case.duration * 1e-9)
    else:
        integrator = ResetIntegratorFromFlags(simulator, scheme, setting.value)
    places = Places(case.scene)
    y0, duration = to_drake(initial(case.scene), places), case.duration

    def run():
        context.SetTime(0.0)
        context.SetContinuousState(y0)
        simulator.Initialize()
        simulator.AdvanceTo(duration)
        return context

    return Run(run, lambda result: from_drake(
        result.get_continuous_state_vector().CopyToVector(), places))


def plant_of(scene):
    """Return Drake's model of a scene, in the order of the bodies of states.py."""
    from pydrake.multibody.plant import MultibodyPlant
    from pydrake.multibody.tree import LinearSpringDamper, QuaternionFloatingJoint

    plant = MultibodyPlant(time_step=0.0)
    drag, whirl_drag = drags(scene)
    for body in Places(scene).bodies:
        link = plant.AddRigidBody(body.name, spatial_inertia(body))
        plant.AddJoint(QuaternionFloatingJoint(f'{body.name}_joint', plant.world_frame(),
                                               link.body_frame(), whirl_drag, drag))
    for spring in scene.springs:
        ends = []
        for name, offset in ((spring.from_, spring.from_offset), (spring.to, spring.to_offset)):
            member = scene.ends[name]
            if any(body.name == name for body in scene.bodies):
                default = member.default_offset or (0.0, 0.0, 0.0)
                ends += [plant.GetBodyByName(name), default if offset is None else offset]
            else:
                ends += [plant.world_body(), member.position]
        plant.AddForceElement(LinearSpringDamper(
            *ends, free_length=spring.natural_length, stiffness=spring.stiffness,
            damping=spring.damping or 0.0))
    gravity = np.array(scene.down) * (scene.gravity or 0.0)
    plant.mutable_gravity_field().set_gravity_vector(gravity)
    plant.Finalize()
    return plant


def spatial_inertia(body):
    from pydrake.multibody.tree import SpatialInertia, UnitInertia

    m = (moments_of_inertia(body) / body.mass if isinstance(body, Rigid) else np.eye(3))
    return SpatialInertia(mass=body.mass, p_PScm_E=np.zeros(3), G_SP_E=UnitInertia(
        m[0, 0], m[1, 1], m[2, 2], m[0, 1], m[0, 2], m[1, 2]))


def drags(scene):
    air = scene.air
    return (air.linear_drag or 0.0, air.rotational_drag or 0.0) if air else (0.0, 0.0)


def set_air(scene, plant, context):
    """Let the air's own motion push the bodies."""
    from pydrake.multibody.math import SpatialForce
    from pydrake.multibody.plant import ExternallyAppliedSpatialForce

    if scene.air is None or not any((*scene.air.velocity, *scene.air.angular_velocity)):
        return
    drag, whirl_drag = drags(scene)
    forces = []
    for body in scene.bodies:
        force = ExternallyAppliedSpatialForce()
        force.body_index = plant.GetBodyByName(body.name).index()
        force.F_Bq_W = SpatialForce(
            tau=whirl_drag * isinstance(body, Rigid) * np.array(scene.air.angular_velocity),
            f=drag * np.array(scene.air.velocity))
        forces.append(force)
    plant.get_applied_spatial_force_input_port().FixValue(context, forces)


def to_drake(y, places):
    """Return quaternion and position of all bodies, then angular and linear velocities."""
    positions, velocities = [], []
    for i in range(len(places.bodies)):
        rigid = i < places.rigid
        positions += [y[places.orientation(i)] if rigid else (1.0, 0.0, 0.0, 0.0),
                      y[places.position(i)]]
        velocities += [y[places.angular_velocity(i)] if rigid else (0.0, 0.0, 0.0),
                       y[places.velocity(i)]]
    return np.concatenate(positions + velocities)


def from_drake(state, places):
    y, count = np.empty(places.size), len(places.bodies)
    positions, velocities = state[:7 * count].reshape(-1, 7), state[7 * count:].reshape(-1, 6)
    for i, (position, velocity) in enumerate(zip(positions, velocities)):
        y[places.position(i)], y[places.velocity(i)] = position[4:], velocity[3:]
        if i < places.rigid:
            y[places.orientation(i)] = position[:4]
            y[places.angular_velocity(i)] = velocity[:3]
    return y
