# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Another scene, or another time, that goes on from where a run stands."""

from .changes import changed
from .simulator import Simulator
from ..scene import Rigid
from ..scene.orientation import to_ros


def begun_anew(simulator):
    """
    Return a Simulator of the same state, scene and settings, but at time 0.

    Forces act, and anchors are on their way, for as long as they would have been.
    """
    now, memory = simulator.time_ns, simulator.copy().memory()
    anchors = memory['anchors']
    memory |= {
        'time_ns': 0, 'tick': 0, 'counted': [0, 0],
        'push_ends_ns': {body: end - now for body, end in memory['push_ends_ns'].items()},
        'anchors': {**anchors, 'since_ns': anchors['since_ns'] - now, 'under_way': [
            (target and (target[0] - now, target[1]),
             None if commanded is None else commanded - now)
            for target, commanded in anchors['under_way']]}}
    other = Simulator(simulator.scene, simulator.settings)
    other.recall(memory)
    return other


def carried_over(simulator, scene):
    """
    Return a Simulator of another scene, at the instant and tick of a Simulator.

    Bodies and anchors of the same name go on from where they are, bodies with their velocities;
    all else is as the scene says. Commanded wrenches, and anchors on their way, are dropped.
    """
    snapshot, values = simulator.snapshot(), {}
    for body in scene.bodies:
        if body.name not in snapshot.layout.bodies:
            continue
        values[f'{body.name}.position'] = snapshot.position(body.name)
        values[f'{body.name}.velocity'] = snapshot.velocity(body.name)
        orientation = snapshot.orientation(body.name)
        if orientation is not None and isinstance(body, Rigid):
            values[f'{body.name}.orientation'] = to_ros(orientation)
            values[f'{body.name}.angular_velocity'] = snapshot.angular_velocity(body.name)
    for anchor in scene.anchors:
        if anchor.name in snapshot.layout.anchors:
            values[f'{anchor.name}.position'] = snapshot.anchor_position(anchor.name)
    values = {name: [float(number) for number in value] for name, value in values.items()}
    other = Simulator(*changed(scene, simulator.settings, values, at_start=True))
    memory = other.memory()
    memory |= {'time_ns': simulator.time_ns, 'tick': simulator.tick}
    memory['anchors']['since_ns'] = simulator.time_ns
    other.recall(memory)
    other.epoch = simulator.epoch
    return other
