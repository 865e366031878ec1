# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recorded states against those of a simulator, bit for bit."""

from __future__ import annotations

from dataclasses import dataclass
import math

from .run_bag import as_sent
from ..messages.cdr import decode
from ..messages.state_hash import decode_state_hash, STATE_HASH
from ..messages.tick_rows import TickRows
from ..simulation.state_hash import state_hash

# Of the last part but one of a number's name in a message, or the last one.
_UNITS = {'position': 'm', 'linear': 'm/s', 'angular': 'rad/s', 'force': 'N', 'torque': 'N m',
          'data': 'J', 'translation': 'm'}
# The hash is compared by what it says.
_NO_STATES = {'markers', STATE_HASH.topic}


@dataclass(frozen=True)
class Difference:
    """Where a run first differs from the recorded one; recorded, found: as texts."""

    tick: int
    time_ns: int
    quantity: str
    recorded: str
    found: str
    size: str = ''

    def __str__(self):
        return (f'tick {self.tick}, {self.time_ns * 1e-9:.9g} s: {self.quantity} is '
                f'{self.recorded} in the bag, {self.found} here{self.size}')


class Comparison:
    """
    Compares messages of states with what a simulator says of the same instant.

    channels: Channels of the scene; layout: Layout of its arrays. states, hashes: instants, and
    hashes, that were equal so far.
    """

    def __init__(self, channels, layout):
        """Prepare the messages of a scene."""
        self.states = self.hashes = 0
        self._rows = TickRows(channels, layout)
        self._numbers = {channel.topic: i for i, channel in enumerate(self._rows.channels)}
        self._others = {channel.topic: channel for channel in channels
                        if channel.row is None and channel.topic not in _NO_STATES}
        self._chosen: dict[tuple, tuple] = {}

    def difference(self, simulator, stamp_ns: int, messages) -> Difference | None:
        """
        Return the first difference between recorded messages of an instant and a simulator.

        messages: [(topic relative to the node, CDR bytes)]; markers, a drawing of the rest, are
        left out.
        """
        topics = tuple(topic for topic, _ in messages)
        if topics not in self._chosen:
            self._chosen[topics] = self._choose(topics)
        wanted, numbers = self._chosen[topics]
        if wanted.numbers:
            self._rows.fill(simulator.instant(), stamp_ns, wanted)
        for (topic, data), number in zip(messages, numbers):
            if topic == STATE_HASH.topic:
                found = _difference_of_hash(simulator, data)
                if found is not None:
                    return found
                self.hashes += 1
            elif number is not None and self._rows.message(number) != data:
                return _describe(simulator, self._rows.channels[number], data,
                                 self._rows.message(number))
            elif topic in self._others:
                channel = self._others[topic]
                message = as_sent(channel.encode(simulator.snapshot(), stamp_ns))
                if message != data:
                    return _describe(simulator, channel, data, message)
        self.states += bool(wanted.numbers) or not self._others.keys().isdisjoint(topics)
        return None

    def _choose(self, topics):
        """Return the Wanted rows, and the number of the row of each topic or None."""
        numbers = [self._numbers.get(topic) for topic in topics]
        channels = [self._rows.channels[number] for number in numbers if number is not None]
        return self._rows.of(channels), numbers


def _describe(simulator, channel, data, message):
    """Return the Difference of two messages of a Channel that are not equal, CDR bytes."""
    topic = channel.topic
    try:
        recorded = dict(_leaves(decode(channel.type_name, data)))
    except ValueError as error:
        return Difference(simulator.tick, simulator.time_ns, topic, f'unreadable ({error})',
                          'whole')
    found = dict(_leaves(decode(channel.type_name, message)))
    # Of equal numbers the texts may differ: there is a zero with a sign.
    leaf = next((leaf for leaf in found if repr(found[leaf]) != repr(recorded.get(leaf))), None)
    if leaf is None:
        return Difference(simulator.tick, simulator.time_ns, topic, f'{len(data)} bytes',
                          f'{len(message)} bytes of the same numbers')
    return _difference_of_number(simulator, f'{topic} {leaf}', recorded.get(leaf), found[leaf])


def _difference_of_hash(simulator, data):
    found = state_hash(simulator.snapshot())
    try:
        recorded = decode_state_hash(data)
    except ValueError as error:
        return Difference(simulator.tick, simulator.time_ns, STATE_HASH.topic,
                          f'unreadable ({error})', found)
    if recorded == (simulator.tick, simulator.time_ns, found):
        return None
    if recorded.digits == found:
        return Difference(simulator.tick, simulator.time_ns, 'the number or time of the tick',
                          f'{recorded.tick} ({recorded.time_ns} ns)',
                          f'{simulator.tick} ({simulator.time_ns} ns)')
    return Difference(simulator.tick, simulator.time_ns, 'the hash of the whole state',
                      f'{recorded.digits[:16]}…', f'{found[:16]}…')


def _difference_of_number(simulator, quantity, recorded, found):
    unit = next((f' {_UNITS[part]}' for part in quantity.replace(' ', '.').split('.')
                 if part in _UNITS), '')
    size = ''
    if isinstance(recorded, float) and math.isfinite(recorded):
        size = f', a difference of {abs(found - recorded):.2g}{unit}'
    return Difference(simulator.tick, simulator.time_ns, quantity, f'{recorded!r}{unit}',
                      f'{found!r}{unit}', size)


def _leaves(value, name=''):
    """Yield (dotted name, value) of all that is in a decoded message."""
    parts = value.items() if isinstance(value, dict) else (
        enumerate(value) if isinstance(value, list) else ())
    if not isinstance(value, (dict, list)):
        yield name, value
    for key, part in parts:
        yield from _leaves(part, f'{name}.{key}' if name else str(key))
