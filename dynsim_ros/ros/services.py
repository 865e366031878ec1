# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Services: pause, step, reset, record, and those for states."""

from std_srvs.srv import SetBool, Trigger

from ..scene import SceneError


class Services:
    """
    Offers ~/pause, ~/step, ~/step_until, ~/reset, ~/record, ~/save_state, ~/load_state, ~/rewind.

    ask: Mailbox.ask, through which all but files is done; stepping: Stepping; states: States;
    options: dict of the node's own parameters, always up to date; resumed, was_reset: called,
    without arguments, there, after the run went on or was reset; follow_up: after a reset, here.
    """

    def __init__(self, node, run, ask, stepping, states, options, *, resumed, was_reset,
                 follow_up):
        self._run, self._ask = run, ask
        self._stepping, self._states, self._options = stepping, states, options
        self._resumed, self._was_reset, self._follow_up = resumed, was_reset, follow_up
        for name, kind, answer in (
                ('pause', SetBool, lambda request: self.pause(request.data)),
                ('step', Trigger, lambda _: self.step(int(options['step_count']))),
                ('step_until', Trigger, lambda _: self._step_until()),
                ('reset', Trigger, lambda _: self.reset()),
                ('record', SetBool, lambda request: self._record(request.data)),
                ('save_state', Trigger, lambda _: states.save(options['state.file'])),
                ('load_state', Trigger, lambda _: states.load(
                    options['state.file'], options['state.time'])),
                ('rewind', Trigger, lambda _: states.rewind(options['state.time']))):
            def callback(request, response, answer=answer):
                response.success, response.message = answer(request)
                return response

            node.create_service(kind, f'~/{name}', callback)

    def _in_time(self, answer):
        """Have answer() given at a tick boundary; return (success, message)."""
        def answer_there():
            failure = self._run.simulator.failure
            success, message = answer()
            if failure is not None and failure not in message:
                message += f' (the run had stopped: {failure})'
            return success, message

        return self._ask(answer_there)

    def pause(self, pauses):
        """Hold the time, or let it go on; return (success, message)."""
        return self._in_time(lambda: self._pause(pauses))

    def _pause(self, pauses):
        run = self._run
        if not pauses and run.simulator.failure is not None:
            return False, f'{run.simulator.failure}; then call ~/reset'
        resumes = run.paused and not pauses
        run.paused = pauses
        if resumes:
            self._resumed()
        return True, f'{"paused" if pauses else "running"} at {run.now()}'

    def step(self, ticks):
        """Let a paused run go on by so many ticks; return (success, message)."""
        return self._in_time(lambda: self._stepping.by(ticks))

    def _step_until(self):
        return self._in_time(lambda: self._stepping.until(self._options['step_until']))

    def reset(self, pauses=False):
        """Begin a new epoch, paused if it is to be or was; return (success, message)."""
        answer = self._in_time(lambda: self._begin_anew(pauses))
        self._follow_up()
        return answer

    def _begin_anew(self, pauses):
        failed = self._run.simulator.failure is not None
        problem = self._run.reset()
        self._run.paused = pauses or self._run.paused and not failed
        self._was_reset()
        return True, self._run.epoch(problem)

    def _record(self, begins):
        answer = self._in_time(self._begin_bag if begins else self._end_bag)
        if begins or not answer[0]:
            return answer
        return True, self._run.finish_bags() + answer[1]

    def _begin_bag(self):
        try:
            path = self._run.start_recording()
        except SceneError as error:
            return False, str(error)
        self._run.publish()
        return True, str(path)

    def _end_bag(self):
        return (True, '') if self._run.detach_bag() else (False, 'not recording')
