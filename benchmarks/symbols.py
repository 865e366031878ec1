# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Source code from equations: straight-line, in scalars, every common part computed once.

That is the fastest form of a right-hand side for numba and for C; numbers of the scene stand in it
as constants.
"""

from functools import lru_cache

from algebra import Numbers
from equations import rates
import numba
from states import Places


class Symbol:
    """A number of a Program: its text is a variable, a constant or one operation on two."""

    def __init__(self, program, text):
        self.program, self.text = program, text

    def __add__(self, other):
        return self.program.operation('+', self, other)

    def __sub__(self, other):
        return self.program.operation('-', self, other)

    def __mul__(self, other):
        return self.program.operation('*', self, other)

    def __truediv__(self, other):
        return self.program.operation('/', self, other)

    def __neg__(self):
        return self.program.line(f'-{self.text}')


class Program:
    """
    The right-hand side of a scene as lines `name = expression`.

    constant: turns a float into source; inverse_sqrt: text of 1 / sqrt({}).
    """

    def __init__(self, scene, constant=repr, inverse_sqrt='1.0 / math.sqrt({})'):
        self.lines, self._known = [], {}
        size = Places(scene).size
        numbers = Numbers(lambda value: Symbol(self, f'({constant(value)})'),
                          lambda a: self.line(inverse_sqrt.format(a.text)))
        y = [Symbol(self, f'y{i}') for i in range(size)]
        self.results = [a.text for a in rates(scene, numbers, Symbol(self, 't'), y)]

    def operation(self, sign, a, b):
        return self.line(f'{a.text} {sign} {b.text}')

    def line(self, text):
        if text not in self._known:
            self._known[text] = Symbol(self, f'a{len(self.lines)}')
            self.lines.append((self._known[text].text, text))
        return self._known[text]


def python_function(scene, arguments, result='y', out='out'):
    """Return a plain function (t, y, out[, more]) that numba can compile."""
    program = Program(scene)
    lines = [f'def f({arguments}):']
    lines += [f'    y{i} = {result}[{i}]' for i in range(len(program.results))]
    lines += [f'    {name} = {text}' for name, text in program.lines]
    lines += [f'    {out}[{i}] = {text}' for i, text in enumerate(program.results)]
    space = {}
    exec('import math\n' + '\n'.join(lines), space)  # the text was made right here
    return space['f']


@lru_cache
def compiled(scene):
    """Return f(t, y, out), compiled by numba."""
    return numba.njit(error_model='numpy', fastmath=True)(python_function(scene, 't, y, out'))
