# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What scenes that come with the package publish, and the forces in the default one."""

import numpy as np

POSE = 'geometry_msgs/msg/PoseStamped'
TWIST = 'geometry_msgs/msg/TwistStamped'
WRENCH = 'geometry_msgs/msg/WrenchStamped'
NUMBERS = 'std_msgs/msg/Float64MultiArray'
MARKERS = 'visualization_msgs/msg/MarkerArray'
DIAGNOSTICS = 'diagnostic_msgs/msg/DiagnosticArray'
EPOCH = 'std_msgs/msg/UInt64'
HASH = 'std_msgs/msg/String'


def body(name, *wrenches):
    """Return {topic: type name} of a body on which these kinds of wrench and 'net' act."""
    return {f'{name}/pose': POSE, f'{name}/twist': TWIST,
            **{f'{name}/wrench/{kind}': WRENCH for kind in (*wrenches, 'net')}}


SPHERE = {**body('sphere', 'spring', 'damper', 'air', 'gravity'), 'hand/pose': POSE,
          'energy': NUMBERS, 'markers': MARKERS}
PARTICLE = {**body('particle', 'spring', 'gravity'), 'hand/pose': POSE, 'energy': NUMBERS,
            'markers': MARKERS}
BOX = {**body('box'), 'energy': NUMBERS, 'markers': MARKERS}

# The numbers of scenes/sphere_on_spring.yaml: kg, m, kg m^2, N/m, N s/m, m, N s/m, N m s/rad.
MASS, RADIUS, GRAVITY = 1.0, 0.1, 9.81
INERTIA = 0.4 * MASS * RADIUS ** 2
STIFFNESS, DAMPING, NATURAL_LENGTH = 100.0, 0.5, 0.5
LINEAR_DRAG, ROTATIONAL_DRAG = 0.1, 0.001


def xyz(vector):
    """Return a message with x, y, z as an array: (3,)."""
    return np.array([vector.x, vector.y, vector.z])


def forces(messages):
    """Return the forces of WrenchStamped messages: (n, 3) [N]."""
    return np.array([xyz(message.wrench.force) for message in messages])


def torques(messages):
    """Return the torques of WrenchStamped messages: (n, 3) [N m]."""
    return np.array([xyz(message.wrench.torque) for message in messages])


def positions(messages):
    """Return the positions of PoseStamped messages: (n, 3) [m]."""
    return np.array([xyz(message.pose.position) for message in messages])


def velocities(messages):
    """Return the velocities of TwistStamped messages: (n, 3) [m/s]."""
    return np.array([xyz(message.twist.linear) for message in messages])


def angular_velocities(messages):
    """Return the angular velocities of TwistStamped messages: (n, 3) [rad/s]."""
    return np.array([xyz(message.twist.angular) for message in messages])
