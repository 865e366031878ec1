# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Sliders and fields for the parameters of a simulation that runs."""

from __future__ import annotations

import math
import time

# How many times its value a quantity can have at the end of its slider.
_REACH = 4.0
# A slider that was left at its end gets longer after so long [s], not under the hand.
_HANDS_OFF = 1.0


class LiveParameters:
    """
    Controls for the quantities of a scene that can be set while it runs.

    page: Page; remote: RemoteSimulation; quantities: {name: Quantity}; refused: called with a
    line when a value was refused.
    """

    def __init__(self, page, remote, quantities, refused):
        self._page = page
        self._remote = remote
        self._refused = refused
        self._controls = {}
        # At most one request is on its way; what is set meanwhile waits, the newest of each.
        self._waiting = {}
        self._is_asking = False
        self._touched = 0.0
        groups = {}
        for name, unit in self._settable(quantities):
            groups.setdefault(name.rpartition('.')[0] or 'scene', []).append((name, unit))
        menu = page.gui.add_dropdown('parameters', tuple(groups), hint='which ones to set')
        self._groups = {}
        for label, members in groups.items():
            self._groups[label] = page.gui.add_folder(None, visible=label == menu.value)
            with self._groups[label]:
                for name, unit in members:
                    self._add(name, unit)
        page.when(menu, self._choose)

    @property
    def is_waiting(self):
        """Tell whether an answer is due."""
        return self._is_asking

    def show(self, values):
        """Show values that are in force: {name: value}."""
        for name in values.keys() & self._controls.keys():
            if name not in self._waiting:
                self._show(name, values[name])

    def settle(self):
        """Make sliders longer whose value is at their end or beyond it; to be called often."""
        if time.monotonic() < self._touched + _HANDS_OFF:
            return
        for name, control in self._controls.items():
            value = self._remote.values[name]
            if not isinstance(value, float) or control.min <= value < 0.999 * control.max:
                continue
            low, high, step = self._range(name, value)
            if (low, high) != (control.min, control.max):
                control.min, control.max, control.step = low, high, step
                control.precision = max(0, round(-math.log10(step)))
                self._show(name, value)

    def _choose(self, chosen):
        for label, group in self._groups.items():
            group.visible = label == chosen

    def _settable(self, quantities):
        """Yield (name, unit) of what has a control."""
        yield 'real_time_factor', ''
        for name, quantity in quantities.items():
            value = self._remote.values[name]
            is_place = name.endswith('.position')
            if not (quantity.initial or is_place) and (
                    isinstance(value, float) or len(value) == 3):
                yield name, quantity.unit

    def _add(self, name, unit):
        gui, value = self._page.gui, self._remote.values[name]
        descriptor = self._remote.descriptors[name]
        label = name.rpartition('.')[2] + (f' [{unit}]' if unit else '')
        if isinstance(value, float):
            low, high, step = self._range(name, value)
            control = gui.add_slider(label, low, high, step, min(max(value, low), high),
                                     hint=descriptor.description)
        else:
            control = gui.add_vector3(label, tuple(value), step=_step(max(map(abs, value)) or 1.0),
                                      hint=descriptor.description)
        self._controls[name] = control
        self._page.when(control, lambda value: self._set(name, value))

    def _range(self, name, value):
        """Return (lowest, highest, step) of a slider, within the range of the descriptor."""
        bounds = self._remote.descriptors[name].floating_point_range[0]
        high = min(_REACH * abs(value) or 1.0, bounds.to_value)
        step = _step(high)
        # A bound such as 1e-9 kg means above 0.
        low = step if bounds.from_value > 0.0 else max(bounds.from_value, -high)
        return low, max(high, low + step), step

    def _set(self, name, value):
        self._touched = time.monotonic()
        self._waiting[name] = list(value) if isinstance(value, tuple) else float(value)
        self._ask()

    def _ask(self):
        if self._is_asking or not self._waiting:
            return
        values, self._waiting = self._waiting, {}
        self._is_asking = True
        self._remote.set_values(values, lambda reason: self._answered(values, reason))

    def _answered(self, values, reason):
        self._is_asking = False
        if reason is not None:
            self._refused(reason)
            self.show({name: self._remote.values[name] for name in values})
        self._ask()

    def _show(self, name, value):
        control = self._controls[name]
        if isinstance(value, float):
            control.value = min(max(value, control.min), control.max)
        else:
            control.value = tuple(value)


def _step(largest):
    """Return a step for numbers up to a size: a power of ten."""
    return 10.0 ** (math.floor(math.log10(largest)) - 3)
