# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Regular expressions as POSIX defines the extended ones, by those of the C library."""

import ctypes

_EXTENDED = 1
# Of the C library's compiled expression and of its messages, with much to spare [bytes].
_SIZE = 512


class _Match(ctypes.Structure):
    _fields_ = [('begin', ctypes.c_int), ('end', ctypes.c_int)]


class PosixPattern:
    """An extended regular expression; raises ValueError, which says why, for what is none."""

    def __init__(self, text):
        """Compile it."""
        self._library = ctypes.CDLL(None)
        self._compiled = (ctypes.c_longlong * (_SIZE // 8))()
        code = self._library.regcomp(self._compiled, _bytes(text), _EXTENDED)
        if code:
            message = ctypes.create_string_buffer(_SIZE)
            self._library.regerror(code, self._compiled, message, ctypes.c_size_t(_SIZE))
            self._library = None
            raise ValueError(message.value.decode())

    def __del__(self):
        if self._library is not None:
            self._library.regfree(self._compiled)

    def matches(self, text):
        """Tell whether a text matches from its beginning to its end."""
        text, match = _bytes(text), _Match()
        found = self._library.regexec(self._compiled, text, ctypes.c_size_t(1),
                                      ctypes.byref(match), 0) == 0
        # POSIX takes the longest of the matches that begin first.
        return found and (match.begin, match.end) == (0, len(text))


def _bytes(text):
    if '\0' in text:
        raise ValueError('a character of it is zero')
    return text.encode()
