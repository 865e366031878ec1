# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Loops over tuples whose members have types of their own, written out.

numba has no loop for them that formulas could use. Functions that call themselves with the rest of
the tuple, as is usual, take long to be compiled: the last members are in the code of each call.
"""


def each(parameters, expression, count, **names):
    """
    Return the function that returns a tuple with an expression for each number i below a count.

    parameters: names of the function's arguments, with commas; expression: Python, in which {i}
    is the number; names: what the expression needs besides the parameters.
    """
    members = ''.join(f'{expression.format(i=i)}, ' for i in range(count))
    exec(f'def written_out({parameters}):\n    return ({members})', names)
    return names['written_out']
