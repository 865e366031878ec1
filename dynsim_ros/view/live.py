# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The page of a run that goes on in a simulation node."""

from __future__ import annotations

import time

import numpy as np

from .catalogue import ENERGY, IMBALANCE
from .grip import Gizmos, Pulls
from .history import History
from .live_parameters import LiveParameters
from .page import Page
from .server import ViewError
from .space import Space
from .table import numbers, stamps
from ..scene import load_scene, scene_quantities, SceneError, with_values

# What is kept for plots, and how much of it is shown at first [s].
_KEPT, _SHOWN = 60.0, 20.0
_PLOT_RATE, _TEXT_RATE = 5.0, 3.0
_STEP, _RESET, _RECORD, _STOP = 'step', 'reset', 'record', 'stop recording'


class LivePage(Page):
    """
    Shows a run and steers it.

    remote: RemoteSimulation; scene: Scene with the values that are in force.
    """

    def __init__(self, server, remote, scene):
        super().__init__(server, scene, Space.of_start(scene), remote.topics)
        self._remote = remote
        self._time = None
        self._histories = {}
        self._seconds = _SHOWN
        self._next_plot = self._next_text = 0.0
        # Simulated and wall time at which the pace was looked at last.
        self._since = None
        self.pace = None
        self._is_recording = False
        self.gizmos = Gizmos(self, remote.move)
        self.pulls = Pulls(self, remote.push, _firmness(scene, self.stage.space))
        self._set_up()
        remote.changed = self._changed

        @server.on_client_disconnect
        async def _(client):
            self.later(lambda: self.gizmos.release(client.client_id))

    def frame(self, _):
        """Take in what has arrived, show it, and send what browsers do."""
        self._remote.listen(self._topics() if self.is_watched else ())
        if not self.is_watched:
            return
        if self._take():
            self._show()
        self.gizmos.act()
        self.pulls.act()
        now = time.monotonic()
        if now >= self._next_plot:
            self._next_plot = now + 1.0 / _PLOT_RATE
            self._draw_plots()
        if now >= self._next_text:
            self._next_text = now + 1.0 / _TEXT_RATE
            self._tell(now)
            self.parameters.settle()

    def plots_changed(self):
        """Draw other plots with the next frame."""
        self._next_plot = 0.0

    def _topics(self):
        """Return the topics that what is shown needs."""
        poses = {f'{name}/pose' for name in (*self.stage.bodies, *self.stage.anchors)}
        return (poses | {ENERGY} | self.plots.topics | self.stage.arrows.topics) & set(
            self._remote.topics)

    def _take(self):
        """Add to the histories what has arrived; tell whether anything has."""
        arrived = {topic: messages for topic in self._topics()
                   if (messages := self._remote.take(topic))}
        energies = arrived.pop(ENERGY, [])
        for topic, messages in sorted(arrived.items()):
            times = stamps(messages)
            if self._time is not None and times[0] < self._time - 1e-9 and topic.endswith('/pose'):
                self._watch_for_reset(topic, times[0])
            self._add(topic, times, messages)
            self._time = max(times[-1], self._time or times[-1])
        if energies and self._time is not None:
            # They have no stamp, but come one after each tick, the last one about now.
            rate = self._remote.values['publish_rate.energy'] or self._remote.values['rate']
            times = self._time - np.arange(len(energies))[::-1] / rate
            known = self._histories.get(ENERGY)
            if known is not None:
                times = np.maximum(times, known.table.time[-1])
            self._add(ENERGY, times, energies)
        return bool(arrived)

    def _watch_for_reset(self, topic, time):
        """Forget everything if a topic's time has gone back."""
        known = self._histories.get(topic)
        if known is not None and len(known.table.time) and time < known.table.time[-1]:
            self._histories.clear()
            self._time = self._since = None

    def _add(self, topic, times, messages):
        history = self._histories.setdefault(topic, History(_KEPT))
        history.add(times, numbers(self._remote.topics[topic], messages))

    def _show(self):
        tables = {topic: history.table for topic, history in self._histories.items()}
        self.stage.show({topic: table.values[-1] for topic, table in tables.items()})
        self.stage.draw_trails(tables, self._time)

    def _draw_plots(self):
        if self._time is not None:
            tables = {topic: history.table for topic, history in self._histories.items()}
            self.plots.draw(tables, self._time - self._seconds, self._time)

    def _tell(self, now):
        """Bring the line of text and the labels up to date."""
        self._measure(now)
        level, message, _ = self._remote.status.get('run', (0, '', {}))
        is_still = self.pace is not None and self.pace == 0.0
        state = ('gone' if not self._remote.is_there else message if level else
                 'waiting' if self.pace is None else 'paused' if is_still else 'running')
        self._is_paused = is_still or state == 'paused'
        self._pause.label = 'Resume' if self._is_paused else 'Pause'
        parts = [f'**{state}**']
        if self._time is not None:
            parts.append(f't = {self._time:.3f} s')
        if self.pace:
            rate = self.pace * self._remote.values['rate']
            parts += [f'{rate:.1f} Hz', f'real-time factor {self.pace:.2f}']
        energy = self._histories.get(ENERGY)
        if energy is not None and len(energy.table.time):
            row = energy.table.values[-1]
            parts.append(f'energy {row[3]:.6g} J, drift {row[IMBALANCE]:.2g} J')
        if self.parameters.is_waiting:
            parts.append('setting a parameter ...')
        self._text.content = ', '.join(parts)
        recorder = self._remote.status.get('recorder')
        if recorder is not None:
            self._show_recording(recorder[1] != 'not recording')

    def _measure(self, now):
        """Bring the pace up to date: simulated seconds per second in about the last one."""
        if self._time is None:
            self._since = self.pace = None
        elif self._since is None:
            self._since = (now, self._time)
        elif now - self._since[0] > 0.9:
            self.pace = (self._time - self._since[1]) / (now - self._since[0])
            self._since = (now, self._time)

    def _set_up(self):
        gui, remote = self.gui, self._remote
        self._is_paused = False
        self._text = gui.add_markdown('waiting for messages')
        self._pause = gui.add_button('Pause')
        self._buttons = gui.add_button_group('run', (_STEP, _RESET, _RECORD))
        self.when_pressed(self._pause, self._toggle_pause)
        actions = {_STEP: self._step, _RESET: self._reset, _RECORD: self._toggle_record,
                   _STOP: self._toggle_record}

        @self._buttons.on_click
        async def _(event):
            self.later(actions[event.target.value])

        for label, key, action in (('pause or resume', 'space', self._toggle_pause),
                                   ('one tick', 'arrowright', self._step),
                                   ('reset', 'home', self._reset)):
            self.on_key(label, key, action)
        seconds = gui.add_slider('plotted [s]', 1.0, _KEPT, 1.0, self._seconds)
        self.when(seconds, lambda value: setattr(self, '_seconds', value))
        firmness = self.pulls.stiffness
        pull = gui.add_slider('pull [N/m]', 0.0, 5.0 * firmness, 0.05 * firmness, firmness,
                              hint='drag a body: force per distance from the grabbed point')
        self.when(pull, lambda value: setattr(self.pulls, 'stiffness', value))
        self.parameters = LiveParameters(self, remote, scene_quantities(self.stage.scene),
                                         lambda reason: self._report(False, reason))
        self.add_looks()

    def _toggle_pause(self):
        self._remote.call('pause', not self._is_paused, self._paused)

    def _paused(self, success, message):
        if success:
            self._is_paused = message.startswith('paused')
            self.pace = 0.0 if self._is_paused else None
            self._since = None
            self._next_text = 0.0
        else:
            self._report(success, message)

    def _step(self):
        self._remote.call('step', None, self._report_failure)

    def _reset(self):
        self._remote.call('reset', None, self._report_failure)

    def _toggle_record(self):
        begins = not self._is_recording

        def answered(success, message):
            if success:
                self._show_recording(begins)
            self._report(success, f'recording to {message}' if begins and success else message)

        self._remote.call('record', begins, answered)

    def _show_recording(self, is_recording):
        self._is_recording = is_recording
        self._buttons.options = (_STEP, _RESET, _STOP if is_recording else _RECORD)

    def _report_failure(self, success, message):
        if not success:
            self._report(success, message)

    def _report(self, success, message):
        """Tell all browsers what became of something."""
        for client in self.server.get_clients().values():
            client.add_notification('done' if success else 'refused', message,
                                    color='green' if success else 'red', auto_close_seconds=8.0)

    def _changed(self, values):
        """Take over parameters that were set, by anybody."""
        self.parameters.show(values)
        known = {name: value for name, value in values.items()
                 if name in scene_quantities(self.stage.scene)}
        if known:
            try:
                self.stage.set_scene(with_values(self.stage.scene, known))
            except SceneError:
                return  # set back by the next event


def remote_scene(remote, name=None):
    """
    Return the Scene of a RemoteSimulation, with the values that are in force.

    name: of the scene or its file; None for what the node calls it. Raises ViewError.
    """
    called = remote.values['scene']
    try:
        scene = load_scene(name or called)
    except SceneError as error:
        if name:
            raise
        raise ViewError(f"the scene of {remote.name} is '{called}', but here: {error}; give it "
                        'with --scene') from None
    names = scene_quantities(scene)
    other = sorted(names.keys() - remote.values.keys())
    if other:
        raise ViewError(f"the scene of {remote.name} has no '{other[0]}', but '{name or called}' "
                        'has: give the scene of that node with --scene')
    return with_values(scene, {quantity: remote.values[quantity] for quantity in names})


def _firmness(scene, space):
    """Return how firmly bodies are pulled at [N/m]: a pull over all of the view is strong."""
    weight = max(body.mass for body in scene.bodies) * (scene.gravity or 9.81)
    return 4.0 * weight / space.size
