# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
Functions that are only linked into others: no machine code of their own is made.

numba translates every function that it compiles, also one that is inlined wherever it is used. Of
the time that a scene's kernels take to be compiled that was a sixth to a quarter.
"""

from llvmlite.binding import parse_assembly
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler

# How the names of numba's environments begin: one of each function, a global variable.
_ENVIRONMENT = '_ZN08NumbaEnv'


class _LinkedLibrary(JITCodeLibrary):
    """Keeps the code of a function for those that use it, and translates none."""

    def __init__(self, context, name):
        super().__init__(context.codegen(), name)
        self._context = context

    def _optimize_functions(self, ll_module):
        # They are later, when what they use is in them.
        ll_module.data_layout = self._codegen._data_layout

    def _finalize_final_module(self):
        self._finalize_dynamic_globals()
        self._finalized = True
        names = [variable.name for variable in self._final_module.global_variables
                 if variable.name.startswith(_ENVIRONMENT)]
        self._get_module_for_linking()
        rest = self._codegen._create_empty_module(self.name)
        for name in names:
            self._context.declare_env_global(rest, name)
        self._final_module = parse_assembly(str(rest))
        super()._finalize_final_module()


class LinkedCompiler(Compiler):
    """numba's compiler, for functions that are only linked into others."""

    def compile_extra(self, function):
        """Compile a function, see numba.core.compiler.CompilerBase."""
        self.state.library = _LinkedLibrary(self.state.targetctx, function.__qualname__)
        self.state.library.enable_object_caching()
        return super().compile_extra(function)
