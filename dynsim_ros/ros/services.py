# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Services: pause, step, reset, record."""

from std_srvs.srv import SetBool, Trigger

from ..scene import SceneError


class Services:
    """
    Offers ~/pause, ~/step, ~/reset and ~/record.

    resumed, was_reset: called, without arguments, after the run went on or was reset.
    """

    def __init__(self, node, run, resumed, was_reset):
        self._run = run
        self._resumed = resumed
        self._was_reset = was_reset
        for name, kind, answer in (('pause', SetBool, self._pause), ('step', Trigger, self._step),
                                   ('reset', Trigger, self._reset),
                                   ('record', SetBool, self._record)):
            def callback(request, response, answer=answer):
                failure = run.simulator.failure
                response.success, response.message = answer(request)
                if failure is not None and failure not in response.message:
                    response.message += f' (the run had stopped: {failure})'
                return response

            node.create_service(kind, f'~/{name}', callback)

    def _now(self):
        simulator = self._run.simulator
        return f'tick {simulator.tick}, {simulator.time:.9g} s'

    def _failure(self):
        return f'{self._run.simulator.failure}; then call ~/reset'

    def _pause(self, request):
        if not request.data and self._run.simulator.failure is not None:
            return False, self._failure()
        resumes = self._run.paused and not request.data
        self._run.paused = request.data
        if resumes:
            self._resumed()
        return True, f'{"paused" if request.data else "running"} at {self._now()}'

    def _step(self, _):
        if not self._run.paused:
            return False, 'not paused: call ~/pause with data true first'
        if self._run.simulator.failure is None:
            self._run.tick()
        if self._run.simulator.failure is not None:
            return False, self._failure()
        return True, self._now()

    def _reset(self, _):
        failed = self._run.simulator.failure is not None
        problem = self._run.reset()
        if failed:
            self._run.paused = False
        self._was_reset()
        text = f'epoch {self._run.simulator.epoch}, {self._now()}'
        return True, f'{text}; no longer recording: {problem}' if problem else text

    def _record(self, request):
        if request.data:
            try:
                path = self._run.start_recording()
            except SceneError as error:
                return False, str(error)
            self._run.publish()
            return True, str(path)
        text = self._run.stop_recording()
        return text is not None, text or 'not recording'
