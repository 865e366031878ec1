# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""When the choice between the explicit and the stiff method tries the stiff one."""

from by_hand import nothing_compiled
from dynsim_ros.integrators.adaptive import TRIAL
from dynsim_ros.integrators.stiffness import held_back_step
from dynsim_ros.physics.model import build_model
from dynsim_ros.simulation.propagator import Propagator
from references import load


def steps_of(name, duration, tolerance):
    """Return the AutoSteps that have taken a scene of the references some way."""
    with nothing_compiled():
        propagator = Propagator(load(name)[0], tolerance=tolerance)
        propagator.end_state(duration)
    return propagator._steps._steps


def test_not_where_a_long_step_turns_velocities_round():
    steps = steps_of('S2', 8.0, 1e-3)
    count = int(steps.explicit.counts[0])
    # Steps are long enough for a trial, and its time has come; but nothing speaks for it.
    assert 8.0 / count > held_back_step(build_model(load('S2')[0]), steps.explicit.method.reach)
    assert steps.explicit.clock[TRIAL] > 0 and steps.stiff is None


def test_where_stability_alone_keeps_steps_short():
    steps = steps_of('S3q', 0.03, 1e-2)
    assert steps.stiff is not None and steps.current is steps.stiff
