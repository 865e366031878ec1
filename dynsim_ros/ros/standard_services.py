# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The standard services of simulation_interfaces, where that package is installed."""

from .standard_entities import StandardEntities
from .standard_results import FAILED, fill_in, must_succeed, OK, Refusal, UNSUPPORTED
from .. import __version__
try:
    from simulation_interfaces import msg, srv
except ImportError:
    # ROS on PyPI lacks it.
    msg = srv = None

# {service: (its type, what the standard calls that which it offers)}
SERVICES = {
    'get_simulator_features': ('GetSimulatorFeatures', ()),
    'get_simulation_state': ('GetSimulationState', ('SIMULATION_STATE_GETTING',)),
    'set_simulation_state': ('SetSimulationState', (
        'SIMULATION_STATE_SETTING', 'SIMULATION_STATE_PAUSE')),
    'step_simulation': ('StepSimulation', ('STEP_SIMULATION_SINGLE', 'STEP_SIMULATION_MULTIPLE')),
    'reset_simulation': ('ResetSimulation', (
        'SIMULATION_RESET', 'SIMULATION_RESET_TIME', 'SIMULATION_RESET_STATE')),
    'get_entities': ('GetEntities', ('ENTITY_TAGS', 'ENTITY_CATEGORIES')),
    'get_entities_states': ('GetEntitiesStates', ('ENTITY_STATE_GETTING',)),
    'get_entity_state': ('GetEntityState', ('ENTITY_STATE_GETTING',)),
    'get_entity_info': ('GetEntityInfo', ('ENTITY_INFO_GETTING',)),
    'set_entity_state': ('SetEntityState', ('ENTITY_STATE_SETTING',)),
}


def offer_standard_services(node, run, ask, services, states, **hooks):
    """
    Offer SERVICES, relative to the node, or nothing where their types are not installed.

    services: Services; states: States; ask: Mailbox.ask; hooks: see StandardEntities.
    """
    if srv is None:
        return
    entities = StandardEntities(run, ask, msg, **hooks)
    control = _Control(run, ask, services, states, entities)
    for name, (type_name, _) in SERVICES.items():
        answer = getattr(control if hasattr(control, name) else entities, name)
        node.create_service(getattr(srv, type_name), f'~/{name}', _callback(answer))


def _callback(answer):
    """Return the callback of a service: answer, and the code that tells what came of it."""
    def callback(request, response):
        code, text = OK, ''
        try:
            answer(request, response)
        except Refusal as refusal:
            code, text = refusal.code, str(refusal)
        if hasattr(response, 'result'):
            fill_in(response, code, text)
        return response

    return callback


class _Control:
    """Answers the services about the simulation as a whole, through those of the node's own."""

    def __init__(self, run, ask, services, states, entities):
        self._run, self._ask = run, ask
        self._services, self._states, self._entities = services, states, entities
        # In which epoch it was stopped.
        self._stopped = None
        state = msg.SimulationState
        self._changes = {
            state.STATE_STOPPED: self._stop, state.STATE_PAUSED: self._pause,
            state.STATE_PLAYING: lambda: services.pause(False), state.STATE_QUITTING: self._quit}

    def get_simulator_features(self, _, response):
        """List what is offered."""
        names = {name for _, names in SERVICES.values() for name in names}
        response.features.features = sorted(
            getattr(msg.SimulatorFeatures, name) for name in names)
        response.features.custom_info = (f'dynsim_ros {__version__}: entities are the bodies and '
                                         'anchors of its scene; see docs/node.md')

    def get_simulation_state(self, _, response):
        """Tell whether it is stopped, playing or paused."""
        response.state.state = self._state()

    def _state(self):
        return self._ask(self._state_there)

    def _state_there(self):
        state, simulator = msg.SimulationState, self._run.simulator
        if not self._run.paused:
            return state.STATE_PLAYING
        is_stopped = simulator.epoch == self._stopped and simulator.tick == 0
        return state.STATE_STOPPED if is_stopped else state.STATE_PAUSED

    def set_simulation_state(self, request, _):
        """Stop, play, pause or quit."""
        wanted = request.state.state
        if wanted not in self._changes:
            raise Refusal(UNSUPPORTED, f'state: {wanted} cannot be set; give STATE_STOPPED (0), '
                                       'STATE_PLAYING (1), STATE_PAUSED (2) or STATE_QUITTING (3)')
        if wanted == self._state():
            raise Refusal('ALREADY_IN_TARGET_STATE', f'already so, at {self._run.now()}')
        must_succeed(self._changes[wanted](), 'STATE_TRANSITION_ERROR')

    def _pause(self):
        self._stopped = None
        return self._services.pause(True)

    def _stop(self):
        answer = self._services.reset(pauses=True)
        self._stopped = self._run.simulator.epoch
        return answer

    def _quit(self):
        # What would be recorded after that is the beginning of another epoch, and no more.
        self._ask(self._run.detach_bag)
        answer = self._stop()
        self._run.is_over = True
        return answer

    def step_simulation(self, request, _):
        """Take so many ticks; they are over when this is answered."""
        state = msg.SimulationState
        if self._state() != state.STATE_PAUSED:
            raise Refusal(FAILED, 'not paused: set the simulation state STATE_PAUSED '
                                  f'({state.STATE_PAUSED}) first')
        must_succeed(self._services.step(request.steps), FAILED)

    def reset_simulation(self, request, _):
        """Begin anew with all, or with the time or the state alone."""
        scopes = type(request)
        scope = request.scope or scopes.SCOPE_ALL
        time, state = scope & scopes.SCOPE_TIME, scope & scopes.SCOPE_STATE
        if not time and not state:
            raise Refusal(UNSUPPORTED, f'scope: {scope} is not supported, as nothing is spawned '
                                       'here; give SCOPE_TIME (1), SCOPE_STATE (2) or both')
        if not time:
            self._entities.reset_states()
            return
        was_stopped = self._state() == msg.SimulationState.STATE_STOPPED
        answer = self._services.reset() if state else self._states.restart_time()
        if was_stopped:
            self._stopped = self._run.simulator.epoch
        must_succeed(answer, FAILED)
