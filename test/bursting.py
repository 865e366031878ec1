# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A run and the Bursts that tick it, as if all of its topics were listened to."""

from all_listen import AllListen
from dynsim_ros.messages.tick_rows import TickRows
from dynsim_ros.ros.bursts import Bursts
from dynsim_ros.ros.clock import ClockPublisher
from dynsim_ros.ros.histogram import Histogram
from dynsim_ros.ros.inbox import Mailbox
from dynsim_ros.ros.own_parameters import OWN
from dynsim_ros.ros.pacing import Pacer
from dynsim_ros.ros.run import Run
from dynsim_ros.ros.topics import Topics
from dynsim_ros.simulation.simulator import MOST_AHEAD


class Bursting:
    """
    What a node ticks with, in the thread that asks for it.

    channels: that are published; speed: how many times as fast as real time it runs.
    """

    def __init__(self, node, simulator, channels, speed=1.0):
        options = {name: own.default for name, own in OWN.items()}
        topics = Topics(node, channels, TickRows(channels, simulator.layout, reserve=MOST_AHEAD),
                        AllListen(), options)
        self.run = Run(simulator, topics, ClockPublisher(node, AllListen()), options, node)
        self.pacer = Pacer(speed)
        self.mailbox = Mailbox(self.pacer.now)
        self.lateness = Histogram()
        self._bursts = Bursts(self.run, self.pacer, self.mailbox, self.lateness, 0.0)

    def go(self, late_ns=0):
        """Run the ticks that are due where time is late by so much; return how many were run."""
        before = self.run.simulator.tick
        self.pacer.restart(self.run.simulator.time_ns + late_ns)
        ticks = self._bursts.go()
        assert self.run.simulator.tick == before + ticks
        return ticks
