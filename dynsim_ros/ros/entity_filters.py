# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which entities the filters of simulation_interfaces let pass: by name, category, tag, place."""

import math
from typing import NamedTuple

import numpy as np

from .posix_pattern import PosixPattern
from .standard_results import FAILED, Refusal, UNSUPPORTED
from ..physics.rotation import rotation_matrix
from ..scene import Anchor, Box, Particle, RigidBody, Sphere

_KINDS = {Particle: 'particle', Sphere: 'sphere', Box: 'box', RigidBody: 'rigid',
          Anchor: 'anchor'}


class Entity(NamedTuple):
    """A member of a scene as the standard sees it; category: name of a constant of its own."""

    member: object
    category: str
    tags: tuple

    @property
    def name(self):
        """Return its name."""
        return self.member.name

    @property
    def description(self):
        """Return what it is, in a few words."""
        kind = _KINDS[type(self.member)]
        return kind if isinstance(self.member, Anchor) else f'{kind}, {self.member.mass:.9g} kg'


def entities_of(scene):
    """Return [Entity] of all bodies, then of all anchors: these move as they are told to."""
    bodies = [Entity(body, 'CATEGORY_DYNAMIC_OBJECT', ('body', _KINDS[type(body)]))
              for body in scene.bodies]
    return bodies + [Entity(anchor, 'CATEGORY_OBJECT', ('anchor',)) for anchor in scene.anchors]


def selected(filters, snapshot, categories, tag_modes, bounds_types):
    """
    Return the [Entity] of a Snapshot that pass EntityFilters; raise Refusal for what is no filter.

    categories: the class EntityCategory; tag_modes: TagsFilter; bounds_types: Bounds.
    """
    tests = [*_by_name(filters.filter), *_by_category(filters.categories, categories),
             *_by_tags(filters.tags, tag_modes), *_by_bounds(filters.bounds, bounds_types,
                                                             snapshot)]
    return [entity for entity in entities_of(snapshot.scene)
            if all(test(entity) for test in tests)]


def _by_name(text):
    if text:
        try:
            pattern = PosixPattern(text)
        except ValueError as error:
            raise Refusal(FAILED, f"filter: '{text}' is no POSIX extended regular expression: "
                                  f'{error}') from None
        yield lambda entity: pattern.matches(entity.name)


def _by_category(wanted, categories):
    if wanted:
        numbers = {one.category for one in wanted}
        yield lambda entity: getattr(categories, entity.category) in numbers


def _by_tags(wanted, modes):
    known = {modes.FILTER_MODE_ANY: any, modes.FILTER_MODE_ALL: all}
    if wanted.filter_mode not in known:
        raise Refusal(FAILED, f'tags.filter_mode: {wanted.filter_mode} is no mode; give '
                              'FILTER_MODE_ANY (0) or FILTER_MODE_ALL (1)')
    if wanted.tags:
        found = known[wanted.filter_mode]
        yield lambda entity: found(tag in entity.tags for tag in wanted.tags)


def _by_bounds(bounds, types, snapshot):
    if not bounds.points:
        return
    if bounds.type != types.TYPE_SPHERE:
        raise Refusal(UNSUPPORTED, f'bounds.type: {bounds.type} is not supported; give '
                                   f'TYPE_SPHERE ({types.TYPE_SPHERE})')
    numbers = [(point.x, point.y, point.z) for point in bounds.points]
    if len(numbers) != 2 or not np.isfinite(numbers).all() or numbers[1][0] < 0.0:
        raise Refusal(FAILED, 'bounds.points: a sphere has two, its centre [m] and (radius, 0, 0) '
                              '[m], all finite, the radius 0 at least')
    centre, radius = np.array(numbers[0]), numbers[1][0]
    yield lambda entity: _distance(entity.member, centre, snapshot) <= radius


def _distance(member, point, snapshot):
    """Return how far a point is from a body or anchor, 0 within it [m]."""
    if isinstance(member, Anchor):
        return math.dist(point, snapshot.anchor_position(member.name))
    arm = point - snapshot.position(member.name)
    if isinstance(member, Box):
        arm = np.array(rotation_matrix(snapshot.orientation(member.name))).T @ arm
        arm = np.maximum(np.abs(arm) - 0.5 * np.array(member.size), 0.0)
    radius = member.radius if isinstance(member, Sphere) else 0.0
    return max(math.hypot(*arm) - radius, 0.0)
