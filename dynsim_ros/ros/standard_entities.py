# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bodies and anchors as the entities of simulation_interfaces: listed, asked for, set."""

from .commands import check_frame, numbers
from .entity_filters import entities_of, selected
from .standard_results import FAILED, NOT_FOUND, Refusal
from ..messages.channel import stamp, WORLD
from ..scene import Anchor, did_you_mean, Rigid, scene_quantities, SceneError
from ..scene.orientation import to_ros
from ..simulation import PlaceBody, PushBody, SetValues
from ..simulation.commands import checked, PLACED

_NO_TURN = (0.0, 0.0, 0.0, 1.0)


class StandardEntities:
    """
    Answers the services about entities; each method takes a request and fills in a response.

    msg: simulation_interfaces.msg; ask: Mailbox.ask; prepare(simulator): returns when the kernels
    for a Simulator are ready; follow_up: to be called, here, after an anchor was set.
    """

    def __init__(self, run, ask, msg, *, prepare, follow_up):
        self._run, self._ask, self._msg = run, ask, msg
        self._prepare, self._follow_up = prepare, follow_up

    def get_entities(self, request, response):
        """Name those that pass the filters."""
        chosen, _, _ = self._selected(request.filters)
        response.entities = [entity.name for entity in chosen]

    def get_entities_states(self, request, response):
        """Name them, with the state of each at one instant."""
        chosen, snapshot, stamp_ns = self._selected(request.filters)
        response.entities = [entity.name for entity in chosen]
        response.states = [self._state(entity.member, snapshot, stamp_ns) for entity in chosen]

    def get_entity_state(self, request, response):
        """Tell where one is, how it moves and is accelerated."""
        member = self._known(request.entity).member
        response.state = self._state(member, *self._ask(self._instant))

    def get_entity_info(self, request, response):
        """Tell what one is."""
        entity = self._known(request.entity)
        response.info.category.category = getattr(self._msg.EntityCategory, entity.category)
        response.info.description, response.info.tags = entity.description, [*entity.tags]

    def set_entity_state(self, request, _):
        """Put one where it is to be, moving as it is to move; its acceleration follows."""
        member, state = self._known(request.entity).member, request.state
        try:
            check_frame(state.header.frame_id)
        except SceneError as error:
            raise Refusal(FAILED, str(error)) from None
        # Later versions of the standard tell which parts are meant.
        pose, twist = {}, {}
        if getattr(request, 'set_pose', True):
            q = state.pose.orientation
            pose = {'position': numbers(state.pose.position), 'orientation': (q.x, q.y, q.z, q.w)}
        if getattr(request, 'set_twist', True):
            twist = {'velocity': numbers(state.twist.linear),
                     'angular_velocity': numbers(state.twist.angular)}
        values = {**self._checked(member, pose, 'INVALID_POSE'),
                  **self._checked(member, twist, FAILED)}
        if values:
            self._carry_out([_command(member, values)])

    def reset_states(self):
        """Put all back to where they were at the start, by commands; nothing pushes them then."""
        scene = self._run.simulator.initial_scene
        commands = [_command(anchor, {'position': anchor.position, 'velocity': anchor.velocity})
                    for anchor in scene.anchors]
        for body in scene.bodies:
            values = {part: getattr(body, part) for part in PLACED if hasattr(body, part)}
            if 'orientation' in values:
                values['orientation'] = to_ros(values['orientation'])
            commands += [PushBody(body.name, (0.0, 0.0, 0.0)), PlaceBody(body.name, values)]
        self._carry_out(commands)

    def _known(self, name):
        """Return the Entity of a name: which names there are never changes."""
        known = {entity.name: entity for entity in entities_of(self._run.simulator.scene)}
        if name not in known:
            raise Refusal(NOT_FOUND, f"entity: '{name}' is no body or anchor of this scene; "
                                     + did_you_mean(name, known))
        return known[name]

    def _instant(self):
        return self._run.simulator.snapshot(), self._run.stamp_ns

    def _selected(self, filters):
        snapshot, stamp_ns = self._ask(self._instant)
        msg = self._msg
        chosen = selected(filters, snapshot, msg.EntityCategory, msg.TagsFilter, msg.Bounds)
        return chosen, snapshot, stamp_ns

    def _state(self, member, snapshot, stamp_ns):
        """Return an EntityState; what a point has no part of is identity and zero."""
        state, name = self._msg.EntityState(), member.name
        state.header.frame_id = WORLD
        state.header.stamp.sec, state.header.stamp.nanosec = stamp(stamp_ns)
        if isinstance(member, Anchor):
            _put(state.pose.position, snapshot.anchor_position(name))
            _put(state.twist.linear, snapshot.anchor_velocity(name))
            return state
        layout, accelerations = snapshot.layout, snapshot.accelerations
        _put(state.pose.position, snapshot.position(name))
        _put(state.twist.linear, snapshot.velocity(name))
        _put(state.acceleration.linear, accelerations[layout.velocity(name)])
        if isinstance(member, Rigid):
            _put(state.pose.orientation, to_ros(snapshot.orientation(name)), 'xyzw')
            _put(state.twist.angular, snapshot.angular_velocity(name))
            _put(state.acceleration.angular, accelerations[layout.angular_velocity(name)])
        return state

    def _checked(self, member, values, code):
        """Return values of a state as they are to be set; raise a Refusal with a code."""
        kind = 'an anchor' if isinstance(member, Anchor) else 'a particle'
        try:
            if not isinstance(member, Rigid):
                for part, rest in (('orientation', _NO_TURN), ('angular_velocity', _NO_TURN[:3])):
                    given = values.pop(part, rest)
                    if given != rest:
                        raise SceneError(f'{member.name}: {part} {list(given)} cannot be that of '
                                         f'{kind}, which does not turn; give {list(rest)}')
            if not isinstance(member, Anchor):
                return checked(PlaceBody(member.name, values), self._run.simulator.scene).values
            quantities = scene_quantities(self._run.simulator.scene)
            return {part: quantities[f'{member.name}.{part}'].check(f'{member.name}.{part}', value)
                    for part, value in values.items()}
        except SceneError as error:
            raise Refusal(code, str(error)) from None

    def _carry_out(self, commands):
        """Carry out commands in one tick, all or none, when what they need is compiled."""
        def apply():
            if self._run.simulator.failure is not None:
                raise SceneError(f'{self._run.simulator.failure}; then call ~/reset')
            for command in commands:
                self._run.command(command)

        rehearsed = self._ask(self._run.simulator.copy)
        try:
            for command in commands:
                rehearsed.apply(command)
            self._prepare(rehearsed)
            self._ask(apply)
        except SceneError as error:
            raise Refusal(FAILED, str(error)) from None
        if any(isinstance(command, SetValues) for command in commands):
            self._follow_up()


def _command(member, values):
    """Return the command that gives a body or an anchor values of its state."""
    if isinstance(member, Anchor):
        return SetValues({f'{member.name}.{part}': list(value) for part, value in values.items()})
    return PlaceBody(member.name, values)


def _put(to, values, letters='xyz'):
    """Write numbers to the fields of a message."""
    for letter, value in zip(letters, values):
        setattr(to, letter, float(value))
