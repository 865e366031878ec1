# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Quality of service of a topic, as ROS publishers offer it and as bags keep it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import yaml

_RELIABILITY = {0: 'system_default', 1: 'reliable', 2: 'best_effort'}
_DURABILITY = {0: 'system_default', 1: 'transient_local', 2: 'volatile'}
_KEEP_LAST = (1, 'keep_last')

# What rmw calls an infinite duration: 2^63 - 1 ns.
_INFINITE = '{sec: 9223372036, nsec: 854775807}'

# All nine keys, named as Jazzy names them: rosbag2 opens no file that lacks one.
_PROFILE = """\
- history: keep_last
  depth: {depth}
  reliability: {reliability}
  durability: {durability}
  deadline: {infinite}
  lifespan: {infinite}
  liveliness: automatic
  liveliness_lease_duration: {infinite}
  avoid_ros_namespace_conventions: false
"""


@dataclass(frozen=True)
class Qos:
    """
    What a publisher offers: history is always "keep last".

    reliability: 'reliable' or 'best_effort'; durability: 'volatile' or 'transient_local';
    depth: number of messages kept, at least 1.
    """

    reliability: str = 'reliable'
    durability: str = 'volatile'
    depth: int = 10

    def __post_init__(self):
        """Refuse what no publisher can offer."""
        if self.reliability not in ('reliable', 'best_effort'):
            raise ValueError(
                f"reliability '{self.reliability}' is neither 'reliable' nor 'best_effort'")
        if self.durability not in ('volatile', 'transient_local'):
            raise ValueError(
                f"durability '{self.durability}' is neither 'volatile' nor 'transient_local'")
        if self.depth < 1:
            raise ValueError(f'depth {self.depth} is less than 1 message')

    def offered_qos_profiles(self) -> str:
        """Return the YAML text that rosbag2 (Jazzy) keeps with a channel."""
        return _PROFILE.format(
            depth=self.depth, reliability=self.reliability, durability=self.durability,
            infinite=_INFINITE)


STATE = Qos()
LATCHED = Qos(durability='transient_local', depth=1)
COMMAND = Qos()
# How many messages of a topic are kept for who has to ask for them again, and of all together.
_MOST_OF_ONE, _MOST_OF_ALL = 1000, 20_000


def every_tick(topics: int) -> Qos:
    """
    Return what is offered of topics that have a message at every tick; topics: how many.

    What a subscriber lacks that was away for a second at 1 kHz is there for it; memory for one
    that never answers stays bounded.
    """
    return Qos(depth=max(STATE.depth, min(_MOST_OF_ONE, _MOST_OF_ALL // max(topics, 1))))


@cache
def offered(text: str) -> Qos | None:
    """
    Return the quality of service that an `offered_qos_profiles` text describes.

    Names (Jazzy) and numbers (older) are understood. Several profiles that differ become one
    that every reliable or best-effort subscriber matches. None where nothing can be read.
    """
    try:
        profiles = [_parse(profile) for profile in yaml.safe_load(text) or ()]
    except (yaml.YAMLError, TypeError, ValueError, KeyError, AttributeError):
        return None
    if not profiles:
        return None
    first = profiles[0]
    for other in profiles[1:]:
        if (other.reliability, other.durability) != (first.reliability, first.durability):
            return Qos(depth=max(profile.depth for profile in profiles))
    return first


def _parse(profile: dict) -> Qos:
    """Return one profile; 'system default', 'unknown' and the like become the ROS default."""
    reliability = _RELIABILITY.get(profile['reliability'], profile['reliability'])
    durability = _DURABILITY.get(profile['durability'], profile['durability'])
    depth = profile['depth'] if profile['history'] in _KEEP_LAST else 0
    return Qos(
        'best_effort' if reliability == 'best_effort' else 'reliable',
        'transient_local' if durability == 'transient_local' else 'volatile',
        int(depth) if depth > 0 else Qos.depth)
