# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a wrong scene, value or name raises; also the search for the name that was meant."""

import difflib
import reprlib


# What a user gave may be of any size, or contain itself (a YAML file has aliases).
_SHOWN = reprlib.Repr()
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
    return _SHOWN.repr(value)


def did_you_mean(name, known):
    """
    Return a hint that names the nearest known name, or all of them.

    name: what was given; known: iterable of the names that exist. The hint is a clause that
    follows a semicolon.
    """
    known = sorted(known)
    near = difflib.get_close_matches(str(name)[:99], known, n=1, cutoff=0.5)
    if near:
        return f"did you mean '{near[0]}'?"
    return 'known are: ' + ', '.join(known) if known else 'there are none'
