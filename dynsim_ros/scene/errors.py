# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a wrong scene, value or name raises; also the search for the name that was meant."""

import difflib
import reprlib


class _Repr(reprlib.Repr):
    """Short text for what a user gave, of any size; it may contain itself by YAML's aliases."""

    def repr_int(self, x, level):
        """Return the number, or its size where Python refuses to write it."""
        try:
            return super().repr_int(x, level)
        except ValueError:
            return f'a number of {x.bit_length()} bits'


_SHOWN = _Repr()
_SHOWN.maxlevel = 3
_SHOWN.maxdict = _SHOWN.maxlist = _SHOWN.maxtuple = _SHOWN.maxset = 9
_SHOWN.maxstring = _SHOWN.maxother = _SHOWN.maxlong = 60


class SceneError(ValueError):
    """A scene, or a value for a quantity of it, that cannot be simulated; one line of text."""

    def __init__(self, text):
        # Names that are quoted in the text may contain line breaks.
        super().__init__(' '.join(str(text).splitlines()))


def shown(value):
    """Return what was given, as short text for an error."""
    text = _SHOWN.repr(value)
    return text if len(text) <= 200 else text[:197] + '...'


def did_you_mean(name, known):
    """
    Return a hint that names the nearest known name, or all of them.

    name: what was given; known: iterable of the names that exist. The hint is a clause that
    follows a semicolon.
    """
    known = sorted(known)
    name = name[:99] if isinstance(name, str) else shown(name)
    near = difflib.get_close_matches(name, known, n=1, cutoff=0.5)
    if near:
        return f"did you mean '{near[0]}'?"
    return 'known are: ' + ', '.join(known) if known else 'there are none'
