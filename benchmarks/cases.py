# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
The scenes that the benchmarks run, each with the time that it is run for.

S1, S2, S3q and S3q8 are the main ones. The others show the same methods with other parameters,
moving anchors, several bodies and several springs. All are well posed: a difference at the start
grows by a factor of a thousand at the most, so that an error of 1e-12 can be told from rounding.
"""

from dataclasses import dataclass
import math

from dynsim_ros.scene import Air, Anchor, Box, Particle, RigidBody, Scene, Sphere, Spring

GRAVITY = 9.81


@dataclass(frozen=True)
class Case:
    """A scene, its name in the tables, and how long it is run [s]; note: what it shows."""

    name: str
    scene: Scene
    duration: float
    note: str


def turned(axis, angle):
    """Return the quaternion (w, x, y, z) of a rotation; axis: (3,) unit; angle [rad]."""
    return (math.cos(angle / 2), *(math.sin(angle / 2) * a for a in axis))


def hung(body, *, stiffness, natural_length, damping=None, air=None, anchor=(0.0, 0.0, 2.0),
         anchor_velocity=(0.0, 0.0, 0.0)):
    """Return the scene of one body on one spring."""
    return Scene(
        bodies=[body], gravity=GRAVITY, air=air,
        anchors=[Anchor(name='hand', position=anchor, velocity=anchor_velocity)],
        springs=[Spring(name='spring', from_='hand', to=body.name, stiffness=stiffness,
                        natural_length=natural_length, damping=damping)])


def particle(mass=1.0, position=(0.3, 0.0, 1.2), velocity=(0.0, 0.5, 0.0)):
    return Particle(name='particle', mass=mass, position=position, velocity=velocity)


def sphere(mass=1.0, radius=0.1, position=(0.3, 0.0, 1.2), velocity=(0.0, 0.5, 0.0),
           orientation=None, angular_velocity=(1.0, 2.0, 3.0)):
    orientation = turned((1.0, 0.0, 0.0), 0.3) if orientation is None else orientation
    return Sphere(name='sphere', mass=mass, radius=radius, position=position, velocity=velocity,
                  orientation=orientation, angular_velocity=angular_velocity)


def stiff(stiffness, *, mass=0.1, damping=10.0, velocity=(0.0, 0.2, 0.0), spin=5.0):
    """
    Return the scene of S3q: a sphere on a stiff spring that is let go at its natural length.

    The centre is at x = 0.05 m, beside the anchor's vertical, and the orientation is identity,
    so that Q = (0.05, 0, z + r) and z = 2 - sqrt(0.5^2 - 0.05^2) - r gives |Q - P| = 0.5 m.
    """
    radius, length, x = 0.05, 0.5, 0.05
    z = 2.0 - math.sqrt(length ** 2 - x ** 2) - radius
    body = sphere(mass, radius, (x, 0.0, z), velocity, (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, spin))
    return hung(body, stiffness=stiffness, natural_length=length, damping=damping,
                air=Air(linear_drag=0.01, rotational_drag=1e-5))


def stiff_beside(stiffness):
    """
    Return the other reading of S3q: Q straight below the anchor, the sphere beside it.

    The centre is at (0.05, 0, 1.5) and the arm of 0.05 m lies along -x: Q = (0, 0, 1.5).
    """
    body = sphere(0.1, 0.05, (0.05, 0.0, 1.5), (0.0, 0.2, 0.0),
                  turned((0.0, 1.0, 0.0), -math.pi / 2), (0.0, 0.0, 5.0))
    return hung(body, stiffness=stiffness, natural_length=0.5, damping=10.0,
                air=Air(linear_drag=0.01, rotational_drag=1e-5))


def chain(count):
    """Return spheres, each hung from the underside of the one above; a third one is a particle."""
    bodies, springs, above = [], [], 'ceiling'
    for i in range(count):
        name, position = f'body{i + 1}', (0.15 * (i + 1), 0.05 * i, 1.55 - 0.5 * i)
        if i == count - 1 and count > 2:
            bodies.append(Particle(name=name, mass=0.3, position=position))
        else:
            bodies.append(Sphere(name=name, mass=1.0 / (i + 1), radius=0.1 - 0.02 * i,
                                 position=position))
        offset = (0.0, 0.0, -bodies[i - 1].radius) if i else None
        springs.append(Spring(name=f'spring{i + 1}', from_=above, from_offset=offset, to=name,
                              stiffness=300.0 - 50.0 * i, natural_length=0.4, damping=1.0))
        above = name
    return Scene(bodies=bodies, springs=springs, gravity=GRAVITY,
                 anchors=[Anchor(name='ceiling', position=(0.0, 0.0, 2.0))],
                 air=Air(linear_drag=0.02, rotational_drag=2e-4))


def web():
    """Return a sphere held by three springs at three points of its edge, one anchor moving."""
    ends = {'left': ((-0.8, 0.0, 1.0), (-0.1, 0.0, 0.0)),
            'right': ((0.8, 0.1, 1.0), (0.1, 0.0, 0.0)),
            'top': ((0.0, 0.0, 2.0), (0.0, 0.0, 0.1))}
    anchors = [Anchor(name=name, position=position,
                      velocity=(0.05, 0.0, 0.02) if name == 'top' else (0.0, 0.0, 0.0))
               for name, (position, _) in ends.items()]
    springs = [Spring(name=f'{name}_spring', from_=name, to='sphere', to_offset=offset,
                      stiffness=80.0 + 10.0 * i, natural_length=0.5, damping=0.3)
               for i, (name, (_, offset)) in enumerate(ends.items())]
    return Scene(bodies=[sphere(0.5, 0.1, (0.0, 0.1, 1.1), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0),
                                (5.0, 0.0, 0.0))],
                 anchors=anchors, springs=springs, gravity=GRAVITY,
                 air=Air(linear_drag=0.05, rotational_drag=5e-4))


def free(body, air=None, gravity=None):
    return Scene(bodies=[body], air=air, gravity=gravity)


_AIR = Air(linear_drag=0.1, rotational_drag=1e-3)
_WIND = Air(linear_drag=0.2, rotational_drag=5e-4, velocity=(3.0, 1.0, 0.0),
            angular_velocity=(0.0, 0.0, 2.0))
_SPIN = {'position': (0.0, 0.0, 1.0), 'angular_velocity': (0.3, 6.0, 0.1)}

CASES = {case.name: case for case in (
    Case('S1', hung(particle(), stiffness=100.0, natural_length=0.5), 10.0,
         'particle on a spring, no losses'),
    Case('S2', hung(sphere(), stiffness=100.0, natural_length=0.5, damping=0.5, air=_AIR), 10.0,
         'sphere on a spring-damper in air'),
    Case('S3q', stiff(1e6), 2.0, 'sphere on a stiff spring-damper'),
    Case('S3q8', stiff(1e8), 0.2, 'sphere on a stiffer spring-damper'),
    Case('S3b', stiff_beside(1e6), 2.0, 'S3q with the arm across the spring'),
    Case('S3b8', stiff_beside(1e8), 0.2, 'S3q8 with the arm across the spring'),
    Case('S1-damped', hung(particle(0.7, (0.4, 0.1, 1.1)), stiffness=60.0, natural_length=0.4,
                           damping=0.8, air=Air(linear_drag=0.05)), 10.0,
         'particle with damper and drag'),
    Case('S1-soft', hung(particle(2.0, (0.5, -0.2, 1.0), (0.3, 0.8, 0.0)), stiffness=40.0,
                         natural_length=0.0), 20.0,
         'particle on a spring without natural length: the motion is linear'),
    Case('S2-moving', hung(sphere(), stiffness=100.0, natural_length=0.5, damping=0.5, air=_AIR,
                           anchor_velocity=(0.2, -0.1, 0.05)), 10.0, 'S2, the anchor moving'),
    Case('S2-other', hung(sphere(0.4, 0.05, (0.2, 0.1, 1.55), (0.3, -0.2, 0.1),
                                 turned((0.0, 0.6, 0.8), 0.5), (2.0, -1.0, 6.0)),
                          stiffness=250.0, natural_length=0.3, damping=0.8, air=_WIND), 5.0,
         'S2 with other numbers and wind'),
    Case('S2-lossless', hung(sphere(), stiffness=100.0, natural_length=0.5), 10.0,
         'S2 without damper and air'),
    Case('S3-damped', hung(sphere(1.0, 0.1, (0.1, 0.0, 1.4), (0.0, 0.3, 0.0)), stiffness=1e5,
                           natural_length=0.5, damping=2e3, air=_AIR), 2.0,
         'sphere on a strong damper'),
    Case('chain2', chain(2), 5.0, 'two spheres in a chain'),
    Case('chain3', chain(3), 3.0, 'two spheres and a particle in a chain'),
    Case('web', web(), 5.0, 'sphere on three springs, one anchor moving'),
    Case('flight', free(sphere(0.2, 0.05, (0.0, 0.0, 1.0), (1.0, 0.0, 8.0),
                               angular_velocity=(20.0, 0.0, 0.0)), _WIND, GRAVITY), 10.0,
         'free flight with drag, wind and whirl'),
    Case('spin', free(sphere(angular_velocity=(1.0, 2.0, 30.0))), 10.0, 'free spin of a sphere'),
    Case('spin-top', free(RigidBody(name='top', mass=1.0, inertia=(0.02, 0.02, 0.03), **_SPIN)),
         10.0, 'free spin of a symmetric top'),
    Case('spin-box', free(Box(name='box', mass=1.0, size=(0.1, 0.2, 0.4), **_SPIN)), 10.0,
         'free spin of an asymmetric box'),
    Case('rest', hung(particle(1.0, (0.0, 0.0, 1.4019), (0.0, 0.0, 0.0)), stiffness=100.0,
                      natural_length=0.5), 10.0, 'a particle at rest on its spring'),
)}
