# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The node's parameters: all quantities of the scene, the settings of the run, its own."""

from rcl_interfaces.msg import (FloatingPointRange, ParameterDescriptor, ParameterType,
                                SetParametersResult)
from rclpy.parameter import Parameter

from .own_parameters import check_own, OWN
from .publish_rates import check_publish_rates, PUBLISH_RATES
from ..scene import (did_you_mean, get_value, get_values, load_scene, scene_quantities,
                     SceneError)
from ..simulation import Settings
from ..simulation.changes import changed
from ..simulation.settings import (CHOICES, setting_description, SETTING_NAMES,
                                   setting_quantities)

# Declared and checked by rclpy itself.
_OF_RCLPY = ('use_sim_time', 'start_type_description_service')
_QOS = 'qos_overrides.'


class Parameters:
    """
    Declares all parameters of a node from what was given at its start, and checks changes.

    The node was made with automatically_declare_parameters_from_overrides. scene, settings:
    what the run begins with. Raises SceneError for an unknown or wrong override.
    """

    def __init__(self, node):
        self._node = node
        given = {name: parameter.value for name, parameter
                 in node.get_parameters_by_prefix('').items()
                 if name not in _OF_RCLPY and not name.startswith(_QOS)}
        for name in _OF_RCLPY:
            value = node.get_parameter_or(name, Parameter(name, value=False)).value
            if not isinstance(value, bool):
                raise SceneError(f'{name}: {value!r} is not true or false')
        for name in given:
            node.undeclare_parameter(name)
        self.own = {name: check_own(name, given.pop(name, own.default))
                    for name, own in OWN.items()}
        scene = load_scene(self.own['scene'])
        self.quantities = scene_quantities(scene)
        for name in given:
            if name not in self.known:
                raise SceneError(self._unknown(name))
        self.scene, self.settings = changed(scene, Settings(), given, at_start=True)
        check_publish_rates(self.settings.rate, self.own)
        self._publish_rates = {name: self.own[name] for name in PUBLISH_RATES}
        for name, value in self._values(self.scene, self.settings).items():
            node.declare_parameter(name, value, self._descriptor(name), ignore_override=True)

    @property
    def known(self):
        """Return the names of all parameters but those of rclpy."""
        return [*OWN, *SETTING_NAMES, *self.quantities]

    def check_qos_overrides(self):
        """Raise SceneError for an override of the quality of service of no topic of the node."""
        node = self._node
        known = [f'{_QOS}{end.topic_name}.{kind}.{policy}'
                 for kind, ends in (('publisher', node.publishers),
                                    ('subscription', node.subscriptions))
                 for end in ends for policy in ('depth', 'history', 'reliability')]
        for name in node.get_parameters_by_prefix(''):
            if name.startswith(_QOS) and name not in known:
                raise SceneError(f"parameter '{name}' is not known; " + did_you_mean(name, known))

    def checked(self, parameters, simulator):
        """
        Return a group of parameters with their values as they will be in force.

        Raises SceneError if they cannot be set; changes nothing.
        """
        for parameter in parameters:
            self._check_kind(parameter)
        self._node_values(parameters)
        scene, _ = simulator.changed_by(self.run_values(parameters))
        return [Parameter(parameter.name, value=get_value(scene, parameter.name))
                if parameter.name in self.quantities else parameter for parameter in parameters]

    def run_values(self, parameters):
        """Return {name: value} of those that are quantities of the scene or settings."""
        return {parameter.name: _plain(parameter.value) for parameter in parameters
                if parameter.name in self.quantities or parameter.name in SETTING_NAMES}

    def accept(self, parameters):
        """Take over those that are the node's own."""
        self.own.update(self._node_values(parameters))

    def check_publish_rates(self, parameters, settings):
        """Raise SceneError if a group of parameters would leave a rate that is not possible."""
        values = {parameter.name: parameter.value for parameter in parameters}
        check_publish_rates(values.get('rate', settings.rate), {**self.own, **values})

    def reset(self):
        """Take back the publish rates of the start, which go with the rate of the start."""
        self.own.update(self._publish_rates)

    def restored(self, simulator):
        """Return Parameters that say what the simulator now has."""
        values = self._values(simulator.scene, simulator.settings)
        return [Parameter(name, value=value) for name, value in values.items()
                if (name not in OWN or name in PUBLISH_RATES)
                and _plain(self._node.get_parameter(name).value) != value]

    def converted(self, parameter):
        """Return a parameter with an int (or ints) turned into a double where one is meant."""
        name, value = parameter.name, parameter.value
        if name in self.known and self._is_number(name):
            if parameter.type_ == Parameter.Type.INTEGER:
                return Parameter(name, value=float(value))
            if parameter.type_ == Parameter.Type.INTEGER_ARRAY:
                return Parameter(name, value=[float(a) for a in value])
        return parameter

    def _unknown(self, name):
        return f"parameter '{name}' is not known; " + did_you_mean(name, self.known)

    def _check_kind(self, parameter):
        """Raise SceneError for a name that is not known, or a text where a number is meant."""
        name, value = parameter.name, parameter.value
        if not self._node.has_parameter(name):
            raise SceneError(self._unknown(name))
        if name in self.known and self._is_number(name) and isinstance(value, str):
            raise SceneError(f'{name}: {value!r} is a text; give a number')

    def _is_number(self, name):
        if name in OWN:
            return OWN[name].quantity is not None
        return name not in CHOICES

    def _node_values(self, parameters):
        return {parameter.name: check_own(parameter.name, parameter.value)
                for parameter in parameters if parameter.name in OWN}

    def _values(self, scene, settings):
        return {**self.own, **{name: getattr(settings, name) for name in SETTING_NAMES},
                **get_values(scene)}

    def _descriptor(self, name):
        if name in OWN:
            own = OWN[name]
            return _described(own.description, own.quantity, own.read_only)
        if name in CHOICES:
            return ParameterDescriptor(description=setting_description(name))
        if name in SETTING_NAMES:
            return _described(setting_description(name), setting_quantities()[name])
        quantity = self.quantities[name]
        unit = f' [{quantity.unit}]' if quantity.unit else ''
        suffix = '; given at the start' if quantity.initial else ''
        return _described(f'{quantity.description}{unit}{suffix}', quantity, quantity.initial)


def _described(description, quantity=None, read_only=False):
    descriptor = ParameterDescriptor(description=description, read_only=read_only)
    if quantity is not None and quantity.kind == 'number':
        descriptor.type = ParameterType.PARAMETER_DOUBLE
        descriptor.floating_point_range = [FloatingPointRange(
            from_value=quantity.minimum, to_value=quantity.maximum, step=0.0)]
    elif quantity is not None and quantity.kind != 'inertia':
        descriptor.additional_constraints = (
            f'{4 if quantity.kind == "orientation" else 3} numbers, each '
            f'{quantity.bounds}')
    return descriptor


def _plain(value):
    """Return an array parameter's value as a list."""
    return list(value) if hasattr(value, '__len__') and not isinstance(value, str) else value


def refused(reason):
    """Return the result of a parameter service that was refused."""
    return SetParametersResult(successful=False, reason=reason)
