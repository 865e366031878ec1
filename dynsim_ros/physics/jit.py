# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Compile a function with numba and keep the machine code on disk between processes.

The cache lies in the user's cache folder, under a digest of the sources of all kernels: numba
itself notices a change only in the file of the function it compiles, not in what that calls.
"""

from contextlib import contextmanager
from functools import cache
import hashlib
import os
from pathlib import Path
import shutil
import tempfile
import threading
from types import FunctionType

import numba
from numba import extending
from numba.core import event
from numba.core.registry import CPUDispatcher

from .linked import LinkedCompiler

# The caches of older sources that are kept, for other installations of the package.
_CACHES_KEPT = 4


def _digest():
    package = Path(__file__).parent.parent
    sources = sorted(path for room in ('physics', 'integrators', 'simulation/rows')
                     for path in (package / room).rglob('*.py'))
    return hashlib.sha256(b''.join(path.read_bytes() for path in sources)).hexdigest()[:16]


def _cache_directory():
    """Return a folder that can be written to, or None."""
    digest = _digest()
    for root in _cache_roots():
        directory = root / 'kernels' / digest
        try:
            new = not directory.exists()
            # Machine code is loaded from here: each folder must be the user's own.
            for folder in (root, root / 'kernels', directory):
                folder.mkdir(parents=True, exist_ok=True, mode=0o700)
                if folder.stat().st_uid != os.getuid():
                    raise PermissionError(f'{folder} belongs to another user')
            # A folder that looks writable may be on a full disk.
            with tempfile.TemporaryFile(dir=directory, buffering=0) as probe:
                probe.write(bytes(4096))
            if new:
                _forget_oldest(directory.parent)
            return directory
        except OSError:
            continue
    return None


def _cache_roots():
    """Return where a cache may lie, best place first."""
    roots = [Path(os.environ.get('XDG_CACHE_HOME', ''), 'dynsim_ros'),
             Path(os.path.expanduser('~'), '.cache', 'dynsim_ros')]
    try:
        roots.append(Path(tempfile.gettempdir(), f'dynsim_ros-{os.getuid()}'))
    except FileNotFoundError:
        pass  # there is no folder for temporary files that can be written to
    # Relative: the variable is not set (or wrong), or the user has no home.
    return [root for root in roots if root.is_absolute()]


def _forget_oldest(parent):
    caches = sorted(parent.iterdir(), key=lambda path: path.stat().st_mtime, reverse=True)
    for old in caches[_CACHES_KEPT:]:
        shutil.rmtree(old, ignore_errors=True)


_DIRECTORY = _cache_directory()


@contextmanager
def _our_cache():
    """Let numba choose our folder for what is decorated meanwhile, and nothing else."""
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(_DIRECTORY)
    try:
        yield
    finally:
        numba.config.CACHE_DIR = before


def kernels_are_kept():
    """Return whether what is compiled is kept on disk, for other processes."""
    return _DIRECTORY is not None and not numba.config.DISABLE_JIT


class NotKeptError(Exception):
    """A kernel is not on disk: it has to be compiled."""


class _Refusal(event.Listener):
    """Told by numba that it is about to compile, raises NotKeptError in one thread."""

    def __init__(self):
        self._thread = threading.get_ident()

    def on_start(self, event):
        if threading.get_ident() == self._thread:
            raise NotKeptError

    def on_end(self, event):
        pass


@contextmanager
def only_loading():
    """Let this thread load kernels from the disk, and raise NotKeptError before it compiles."""
    with event.install_listener('numba:compile', _Refusal()):
        yield


# Without reference counting (_nrt): the kernels allocate nothing, and counting the arrays of
# a model at every step took three quarters of the time of a step.
_OPTIONS = {'error_model': 'numpy', 'nogil': True, 'fastmath': False, '_nrt': False}
_LINKED = {'forceinline': True, 'no_cpython_wrapper': True, 'no_cfunc_wrapper': True,
           'pipeline_class': LinkedCompiler}


def _compiled(function, **more):
    options = {**_OPTIONS, **more}
    if numba.config.DISABLE_JIT:
        function.py_func = function
        return function
    if _DIRECTORY is None:
        return numba.njit(**options)(function)
    with _our_cache():
        return numba.njit(cache=True, **options)(function)


def kernel(function):
    """
    Compile a function that is called from Python; it must not allocate.

    Division by zero gives infinity, as in C; fastmath is off, so that the same scene gives the
    same bits in every run. The plain function stays as the attribute py_func; with numba's
    environment variable NUMBA_DISABLE_JIT=1 it is what is returned.
    """
    # Nobody calls it from C; a wrapper for that unpacks the whole Model, and is slow to compile.
    return _compiled(function, no_cfunc_wrapper=True)


class _Formula(CPUDispatcher):
    """A compiled function that compiled functions call; from Python it runs as plain Python."""

    def __call__(self, *arguments):
        return self.py_func(*arguments)


def formula(function):
    """
    Compile a function as kernel does, to be inlined wherever it is used.

    Without what only calls from Python need, which halves the time that it takes to compile.
    """
    compiled = _compiled(function, **_LINKED)
    if not numba.config.DISABLE_JIT:
        compiled.__class__ = _Formula
    return compiled


def overload(function, **options):
    """Decorate what returns formulas to be compiled in place of a function, by their types."""
    return extending.overload(function, jit_options={**_OPTIONS, **_LINKED}, **options)


def plain(function, **instead):
    """
    Return a formula, or a function that calls some, as Python that is Python all the way down.

    In about half the time: nothing goes by way of what could be compiled. instead: functions that
    are called instead of those of the same names, such as EXACTLY and QUICKLY in fused.
    """
    @cache
    def translated(function):
        function = getattr(function, 'py_func', function)
        names = {name: translated(value) for name, value in function.__globals__.items()
                 if name in function.__code__.co_names and _is_ours(value)}
        return FunctionType(function.__code__, function.__globals__ | names | instead,
                            function.__name__, function.__defaults__, function.__closure__)

    return translated(function)


def _is_ours(value):
    return isinstance(value, (_Formula, FunctionType)) and value.__module__.startswith(__package__)


def part(function):
    """
    Let a function be written into those that use it, before these are compiled.

    For large functions: each is then compiled once, and not again within every one that uses it.
    It cannot have branches on None of its own arguments' parts.
    """
    if numba.config.DISABLE_JIT:
        function.py_func = function
        return function
    inlined = numba.njit(inline='always', **_OPTIONS)(function)
    inlined.__class__ = _Formula
    return inlined
