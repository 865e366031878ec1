# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How often each group of topics is published: an integer divisor of the rate of the ticks."""

import math

from ..messages.scene_channels import WRENCH
from ..messages.transforms import TRANSFORMS
from ..scene import SceneError

# {parameter: what it is about}
PUBLISH_RATES = {'publish_rate.state': 'poses and twists', 'publish_rate.wrench': 'wrenches',
                 'publish_rate.energy': 'energies'}
_SWITCHES = {WRENCH: 'publish_wrenches', TRANSFORMS: 'publish_tf'}
# Of the rate, for divisors that are no short decimal numbers, such as 333.333.
_TOLERANCE = 1e-5


def check_publish_rates(rate, values):
    """Raise SceneError unless every publish rate, of {parameter: Hz}, divides a rate [Hz]."""
    for name in PUBLISH_RATES:
        _divisor(name, values[name], rate)


def every_of(channel, tick_ns, values):
    """
    Return how many ticks of a length [ns] it is from one message to the next, 0 for no message.

    values: {parameter: value} of PUBLISH_RATES, and of those that switch a type of message off.
    """
    switch = _SWITCHES.get(channel.type_name)
    if switch is not None and not values[switch]:
        return 0
    name = _group(channel)
    if name is None or values[name] == 0.0:
        return channel.every(tick_ns)
    return max(round(1e9 / (values[name] * tick_ns)), 1)


def _group(channel):
    """Return the parameter that sets a channel's rate, None where it has one of its own."""
    if channel.interval_ns:
        return None
    if channel.topic == 'energy':
        return 'publish_rate.energy'
    return 'publish_rate.wrench' if channel.type_name == WRENCH else 'publish_rate.state'


def _divisor(name, wanted, rate):
    if wanted == 0.0:
        return
    if wanted > rate * (1.0 + _TOLERANCE):
        raise SceneError(f'{name}: {wanted:g} Hz is more than the rate of the ticks, {rate:g} Hz; '
                         'give that at most, or raise rate')
    below = math.floor(rate / wanted * (1.0 + _TOLERANCE))
    if abs(rate / below - wanted) > _TOLERANCE * wanted:
        raise SceneError(f'{name}: {wanted:g} Hz is no integer divisor of rate, {rate:g} Hz; the '
                         f'nearest ones are {rate / below:.7g} and {rate / (below + 1):.7g} Hz')
