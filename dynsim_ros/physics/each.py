# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Loops over tuples whose members have types of their own, written out.

numba's literal_unroll leaves a loop with a branch for each type, of which LLVM does not know that
it can be written out. Functions that call themselves with the rest of the tuple, as is usual, take
long to be compiled: the last members are in the code of each call.
"""


def each(function, expression, count):
    """
    Return the function that returns a tuple with an expression for each number i below a count.

    function: the loop in Python; the one returned takes the same arguments, and the expression
    may use what its module has; expression: Python, in which {i} is the number.
    """
    code = function.__code__
    parameters = ', '.join(code.co_varnames[:code.co_argcount])
    members = ''.join(f'{expression.format(i=i)}, ' for i in range(count))
    names = dict(function.__globals__)
    exec(f'def written_out({parameters}):\n    return ({members})', names)
    return names['written_out']
