# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What other threads want done to a run, handed over to the thread in which it ticks."""

from collections import deque
import threading

from .alarm import Alarm


class Mailbox:
    """
    Takes actions from any thread; one thread, the reader, carries them out in order of arrival.

    now: function that returns the time at which an action arrives [ns]. As long as there is no
    reader, actions are carried out where they are handed in. alarm: Alarm, for a reader that is in
    compiled code: it has something else to do when that rings.
    """

    def __init__(self, now):
        self._now = now
        self._letters = deque()
        # Locked while the reader has nothing to wake up for: waiting for it costs no more than
        # sleeping does, and can be cut short.
        self._bell = threading.Lock()
        self._bell.acquire()
        self.alarm = Alarm()
        self._is_read = False
        self._reader = None

    def begin(self, reader):
        """Let a thread be the reader, from its first turn on: threading.Thread."""
        self._is_read, self._reader = True, reader

    def end(self):
        """Carry out what is left; from here on there is no reader."""
        self._is_read = False
        while self._letters:
            self.next_letter().carry_out()

    def tell(self, action):
        """Have action() done as soon as possible; does not wait for it."""
        if self._is_read:
            self._letters.append(_Letter(self._now(), action))
            self.wake()
        else:
            action()

    def ask(self, action):
        """Have action() done as soon as possible; return what it returns, raise what it raises."""
        if not self._is_read or threading.current_thread() is self._reader:
            return action()
        letter = _Question(self._now(), action)
        self._letters.append(letter)
        self.wake()
        if not self._is_read:
            # The reader left meanwhile.
            self.end()
        return letter.answer()

    def wake(self):
        """Let the reader return from wait, now or when it waits next."""
        self.alarm.ring()
        try:
            self._bell.release()
        except RuntimeError:
            pass  # it rings already

    def hush(self):
        """Let a wake before now not count: what it was for is looked at now; for the reader."""
        self._bell.acquire(blocking=False)

    def wait(self, seconds):
        """Wait for so long, or until woken; for the reader."""
        self._bell.acquire(timeout=seconds)

    def is_quiet(self):
        """Tell whether the reader has nothing to do; the alarm is off then; for the reader."""
        self.alarm.hush()
        return not self._letters and self._bell.locked()

    def arrival(self):
        """Return when the oldest action arrived [ns], None if there is none."""
        return self._letters[0].arrival if self._letters else None

    def next_letter(self):
        """Take out the oldest action; its carry_out() does it."""
        return self._letters.popleft()


class _Letter:
    """An action and when it arrived [ns]; is_awaited: whether somebody waits for its outcome."""

    is_awaited = False

    def __init__(self, arrival, action):
        self.arrival = arrival
        self._action = action

    def carry_out(self):
        """Do it."""
        self._action()


class _Question(_Letter):
    """An action whose outcome somebody waits for."""

    is_awaited = True

    def __init__(self, arrival, action):
        super().__init__(arrival, action)
        self._is_open = threading.Lock()
        self._is_open.acquire()
        self._result = self._error = None

    def carry_out(self):
        """Do it and pass on what comes of it."""
        try:
            self._result = self._action()
        except BaseException as error:
            self._error = error
        finally:
            self._is_open.release()

    def answer(self):
        """Wait until it is done; return its result or raise its error."""
        self._is_open.acquire()
        if self._error is not None:
            raise self._error
        return self._result
