# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Services: pause, step, reset, record."""

from std_srvs.srv import SetBool, Trigger

from ..scene import SceneError


class Services:
    """
    Offers ~/pause, ~/step, ~/reset and ~/record.

    ask: Mailbox.ask, through which all but the end of a bag is done; resumed, was_reset: called,
    without arguments, there, after the run went on or was reset; follow_up: after a reset, here.
    """

    def __init__(self, node, run, ask, *, resumed, was_reset, follow_up):
        self._run = run
        self._ask = ask
        self._resumed = resumed
        self._was_reset = was_reset
        self._follow_up = follow_up
        for name, kind, answer in (('pause', SetBool, self._in_time(self._pause)),
                                   ('step', Trigger, self._in_time(self._step)),
                                   ('reset', Trigger, self._reset),
                                   ('record', SetBool, self._record)):
            def callback(request, response, answer=answer):
                response.success, response.message = answer(request)
                return response

            node.create_service(kind, f'~/{name}', callback)

    def _in_time(self, answer):
        """Return a function that has answer(request) given at a tick boundary."""
        def answer_there(request):
            failure = self._run.simulator.failure
            success, message = answer(request)
            if failure is not None and failure not in message:
                message += f' (the run had stopped: {failure})'
            return success, message

        return lambda request: self._ask(lambda: answer_there(request))

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
            self._run.step()
        if self._run.simulator.failure is not None:
            return False, self._failure()
        return True, self._now()

    def _reset(self, request):
        answer = self._in_time(self._begin_anew)(request)
        self._follow_up()
        return answer

    def _begin_anew(self, _):
        failed = self._run.simulator.failure is not None
        problem = self._run.reset()
        if failed:
            self._run.paused = False
        self._was_reset()
        text = f'epoch {self._run.simulator.epoch}, {self._now()}'
        return True, f'{text}; no longer recording: {problem}' if problem else text

    def _record(self, request):
        answer = self._in_time(self._begin_bag if request.data else self._end_bag)(request)
        if request.data or not answer[0]:
            return answer
        return True, self._run.finish_bags() + answer[1]

    def _begin_bag(self, _):
        try:
            path = self._run.start_recording()
        except SceneError as error:
            return False, str(error)
        self._run.publish()
        return True, str(path)

    def _end_bag(self, _):
        return (True, '') if self._run.detach_bag() else (False, 'not recording')
