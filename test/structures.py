# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Small scenes with all kinds of bodies, ends of springs and offsets; one that is too large."""

from dataclasses import replace

from dynsim_ros.physics.structure import MOST_BODIES
from dynsim_ros.scene import parse_scene

SEVERAL = parse_scene("""
gravity: 9.81
air: {linear_drag: 0.3, rotational_drag: 0.02, velocity: [1, 2, -1]}
anchors: {hand: {position: [0, 0, 2], velocity: [0.1, 0, 0.2]}, wall: {position: [1, 0, 0]}}
bodies:
  dot: {shape: particle, mass: 0.7}
  crate: {shape: box, mass: 2, size: [0.3, 0.5, 0.9]}
  ball: {shape: sphere, mass: 1.3, radius: 0.2}
  die: {shape: box, mass: 0.5, size: [0.4, 0.4, 0.4]}
springs:
  above: {from: hand, to: ball, stiffness: 100, damping: 0.5, natural_length: 0.5}
  along_y: {from: ball, from_offset: [0, -0.2, 0], to: crate, to_offset: [0.15, 0, 0],
            stiffness: 50, damping: 0.1, natural_length: 0.2}
  oblique: {from: ball, from_offset: [0.1, 0, 0.1], to: crate, stiffness: 40, damping: 0.2,
            natural_length: 0.1}
  below: {from: crate, from_offset: [0, 0, -0.45], to: dot, stiffness: 20, natural_length: 0.3}
  aside: {from: dot, to: die, to_offset: [-0.2, 0, 0], stiffness: 30, natural_length: 0.1}
  held: {from: wall, to: die, to_offset: [0, 0.2, 0], stiffness: 60, damping: 0.3,
         natural_length: 0}
""")
SINGLE = replace(SEVERAL, bodies=[body for body in SEVERAL.bodies if body.name == 'die'],
                 springs=[replace(spring, name=name, from_=anchor, to='die')
                          for spring in SEVERAL.springs if spring.name == 'held'
                          for name, anchor in (('held', 'wall'), ('led', 'hand'))])
MANY = replace(SEVERAL, springs=(), bodies=[replace(SEVERAL.bodies[0], name=f'dot{i}')
                                            for i in range(MOST_BODIES + 1)])
