# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Runs of a scene: time, commands, snapshots."""

from .commands import CommandError, MoveAnchor, PlaceBody, PushBody, SetValues
from .propagator import Propagator
from .settings import Settings
from .simulator import DivergenceError, Simulator
from .snapshot import Energy, Snapshot
from .trajectory import Trajectory

__all__ = ['CommandError', 'DivergenceError', 'Energy', 'MoveAnchor', 'PlaceBody', 'Propagator',
           'PushBody', 'SetValues', 'Settings', 'Simulator', 'Snapshot', 'Trajectory']
