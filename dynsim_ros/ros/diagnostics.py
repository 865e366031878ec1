# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The state of the run and its recorder, once a second, on /diagnostics."""

import time

from .message_types import message_class
from .qos import profile
from .run import DIAGNOSTICS
from ..messages.cdr import encode
from ..messages.channel import header

_OK, _WARN, _ERROR = 0, 1, 2


class Diagnostics:
    """Publishes a DiagnosticArray; real_time_factor and rate are those since the last one."""

    def __init__(self, node, run, ticker, pacer, audience):
        self._run = run
        self._ticker = ticker
        self._began = time.monotonic_ns()
        self._drift = 0.0
        self._pacer = pacer
        self._name = node.get_name()
        self._audience = audience
        self._publisher = audience.of(lambda events: node.create_publisher(
            message_class(DIAGNOSTICS.type_name), DIAGNOSTICS.topic, profile(DIAGNOSTICS.qos),
            event_callbacks=events))
        # Not known yet.
        self.real_time_factor = self.rate = None
        self.begin()

    def begin(self):
        """Begin to measure the rate here."""
        simulator = self._run.simulator
        self._since = (time.monotonic(), simulator.time_ns, simulator.tick)

    def measure(self):
        """Bring real_time_factor and rate up to date: what was achieved since the last call."""
        wall, time_ns, tick = self._since
        elapsed = time.monotonic() - wall
        if elapsed > 0.1:
            simulator = self._run.simulator
            self.real_time_factor = (simulator.time_ns - time_ns) * 1e-9 / elapsed
            self.rate = (simulator.tick - tick) / elapsed
            self.begin()

    def publish(self):
        """Publish and record one array, if anybody listens or it is recorded."""
        self.measure()
        is_heard = self._audience.hears(self._publisher)
        if not is_heard and self._run.bag is None:
            return
        statuses = [self._run_status(), self._timing_status(), self._energy_status(),
                    self._recorder_status()]
        data = encode(DIAGNOSTICS.type_name,
                      {'header': header(self._run.stamp_ns), 'status': statuses})
        if is_heard:
            self._publisher.publish(data)
        self._run.record({DIAGNOSTICS.topic: data})

    def _run_status(self):
        run, simulator = self._run, self._run.simulator
        if simulator.failure is not None:
            level, message = _ERROR, simulator.failure
        else:
            level = _OK
            message = ('paused' if run.paused else 'waiting for /clock' if run.waiting
                       else 'running')
        return self._status('run', level, message, {
            'simulated time [s]': f'{simulator.time:.9f}', 'tick': simulator.tick,
            'epoch': simulator.epoch, 'rate achieved [Hz]': _shown(self.rate, 1),
            'real-time factor': _shown(self.real_time_factor, 3),
            'missed ticks': self._pacer.missed, 'late ticks': self._pacer.late,
            'integrator': simulator.settings.integrator,
            'messages not built (nobody listened)': run.topics.skipped,
            'commands refused': run.refused})

    def _timing_status(self):
        run, lateness = self._run, self._ticker.lateness
        late = {f'p{percent}': lateness.percentile(percent) for percent in (50, 99)}
        late['max'] = lateness.longest
        elapsed = time.monotonic_ns() - self._began
        steps, rejected = run.simulator.counts
        return self._status('timing', _OK, 'of the whole run', {
            **{f'lateness of ticks {name} [us]': _shown(ns and ns * 1e-3, 1)
               for name, ns in late.items()},
            **{f'share of {name} [%]': f'{100.0 * spent / elapsed:.3f}'
               for name, spent in run.work.items()},
            'share of the process [%]': f'{100.0 * time.process_time_ns() / elapsed:.3f}',
            'steps of the integrator': steps, 'rejected steps': rejected})

    def _energy_status(self):
        energy = self._run.simulator.snapshot().energy
        self._drift = max(self._drift, abs(energy.imbalance))
        return self._status('energy', _OK, f'{energy.total:.9g} J', {
            'kinetic [J]': f'{energy.kinetic:.9g}',
            'gravitational [J]': f'{energy.gravitational:.9g}',
            'spring [J]': f'{energy.spring:.9g}', 'total [J]': f'{energy.total:.9g}',
            **{f'work of {name} [J]': f'{work:.9g}' for name, work in energy.work.items()},
            'imbalance [J]': f'{energy.imbalance:.3g}',
            'largest imbalance [J]': f'{self._drift:.3g}',
            'removed by normalising orientations':
                f'{self._run.simulator.normalisation_removed:.3g}'})

    def _recorder_status(self):
        bag = self._run.bag
        if bag is None:
            return self._status('recorder', _OK, 'not recording', {'lost before': self._run.lost})
        recorder = bag.recorder
        level = _ERROR if recorder.is_failing else _WARN if recorder.lost else _OK
        message = recorder.error if recorder.is_failing else 'recording'
        return self._status('recorder', level, message, {
            'file': bag.path, 'messages': recorder.messages, 'waiting': recorder.waiting,
            'may wait': recorder.capacity, 'lost': recorder.lost, 'lost before': self._run.lost})

    def _status(self, task, level, message, values):
        return {'level': level, 'name': f'{self._name}: {task}', 'message': message,
                'hardware_id': self._run.simulator.scene.name,
                'values': [{'key': key, 'value': str(value)} for key, value in values.items()]}


def _shown(number, digits):
    return 'not known yet' if number is None else f'{number:.{digits}f}'
