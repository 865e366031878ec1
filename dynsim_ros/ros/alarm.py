# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How a thread that sleeps in compiled code, without the interpreter, is woken."""

import ctypes

import numpy as np

# So many numbers hold a semaphore of the C library, whatever the system.
_ROOM = 8


class Alarm:
    """
    A semaphore, and a flag that says whether it was rung.

    flag: (1,) int64, not 0 from a ring until the next hush; semaphore: its address; functions:
    addresses of sem_clockwait, by which to sleep until an instant or a ring, and of clock_gettime,
    None where the system has not got them: it rings all the same, but wakes nobody.
    """

    def __init__(self):
        self.flag = np.zeros(1, np.int64)
        self._memory = np.zeros(_ROOM, np.int64)
        self.semaphore = self._memory.ctypes.data
        # PyDLL: these take no time, in which somebody else could have the interpreter.
        library = ctypes.PyDLL(None)
        self.functions = _addresses(library)
        if self.functions is not None:
            self._post, self._take = library.sem_post, library.sem_trywait
            for function in (self._post, self._take):
                function.argtypes = [ctypes.c_void_p]
            library.sem_init(ctypes.c_void_p(self.semaphore), 0, 0)

    def ring(self):
        """Wake who sleeps now or, unless it is hushed before, next."""
        if not self.flag[0]:
            self.flag[0] = 1
            if self.functions is not None:
                self._post(self.semaphore)

    def hush(self):
        """Let it not ring any longer."""
        self.flag[0] = 0
        if self.functions is not None:
            self._take(self.semaphore)


def _addresses(library):
    try:
        return tuple(ctypes.cast(function, ctypes.c_void_p).value
                     for function in (library.sem_clockwait, library.clock_gettime))
    except AttributeError:
        return None
