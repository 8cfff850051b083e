"""How numba compiles the functions of a program.

A program has many compiled functions, of which Python calls few. numba by itself gives
each of them machine code and a wrapper for calls from Python, and optimises it again within each
of its callers. Here a function has two forms:

1. The inner form is what compiled functions call: LLVM code that is linked into the caller, without
   machine code of its own (`InnerLowering`).
2. The outer form is what Python calls: a wrapper around the inner form, with machine code. It is
   made at the first call from Python, and kept on disk (`compiler_internals.keep_on_disk`).

The types of operators are looked up once for each combination of arguments
(`RememberingContext`), because numba tries many overloads for every product of two floats.

This module and `compiler_internals` are the only ones that rely on undocumented parts of numba;
`tests/physics/test_function_compiler.py` checks what this one assumes.
"""

from collections.abc import Callable, Mapping
from copy import copy
from functools import cache
from typing import Any

from numba import _dynfunc, njit, types
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, CompileResult, DefaultPassBuilder
from numba.core.compiler_machinery import register_pass
from numba.core.environment import Environment
from numba.core.registry import CPUDispatcher
from numba.core.typed_passes import NativeLowering
from numba.core.typing import Context

# Types whose operators always have the same result for the same types
PLAIN_TYPES = (types.Number, types.Boolean, types.Array, types.StringLiteral, types.SliceType)


# Type inference
# ------------------------------------------------------------------------------------------------


class RememberingContext(Context):
    """numba's typing context with a cache for result types of operators and builtin functions."""

    __slots__ = ("_resolved",)

    def __init__(self, context: Context) -> None:
        """Share all state with `context`; its own initialisation must not run again."""
        object.__setattr__(self, "__dict__", context.__dict__)
        self._resolved: dict[Any, Any] = {}

    def resolve_function_type(self, func: Any, args: Any, kws: Any) -> Any:
        """Return the type signature of a call during numba's type inference.

        It is taken from a cache if all arguments are numbers, arrays or tuples of these.
        """
        if kws or isinstance(func, types.Dispatcher) or not all(map(is_plain_type, args)):
            return super().resolve_function_type(func, args, kws)
        key = (func, tuple(args))
        if key not in self._resolved:
            found = super().resolve_function_type(func, args, kws)
            if found is None:
                return None
            self._resolved[key] = found
        return self._resolved[key]


def is_plain_type(kind: Any) -> bool:
    """Return whether a numba type is a number, an array, or a tuple of these."""
    if isinstance(kind, types.BaseTuple):
        return all(map(is_plain_type, kind))
    return isinstance(kind, PLAIN_TYPES)


@cache
def caching_typing_context(context: Context) -> RememberingContext:
    """Return numba's typing context extended by a cache; one extension per original context."""
    return RememberingContext(context)


# Inner functions
# ------------------------------------------------------------------------------------------------


class InnerLibrary(JITCodeLibrary):
    """LLVM code of one compiled function for linking into its callers.

    It has no machine code of its own.
    """

    def _optimize_final_module(self) -> None:
        """Run the inexpensive passes only; the callers are optimised with what they call."""
        passes, builder = self._codegen._module_pass_manager(
            loop_vectorize=False,
            slp_vectorize=False,
            opt=self._codegen._opt_level,
            cost="cheap",
        )
        passes.run(self._final_module, builder)

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True


@register_pass(mutates_CFG=True, analysis_only=False)
class InnerLowering(NativeLowering):
    """Compiler pass that translates a function to LLVM code for linking into its callers."""

    _name = "inner_native_lowering"

    def run_pass(self, state: Any) -> bool:
        """Translate a function to LLVM code and register it for calls from compiled code."""
        state.library = state.targetctx.codegen().create_library(state.func_id.func_qualname)
        state.library.__class__ = InnerLibrary
        state.flags.no_compile = True
        super().run_pass(state)
        state.library.finalize()
        lowered = state["cr"]
        about = lowered.fndesc
        # numba identifies the function by this object. Its address is 0: nothing may call it.
        handle = _dynfunc.make_function(
            about.lookup_module(), about.qualname.split(".")[-1], "", 0, lowered.env, ()
        )
        state.targetctx.insert_user_function(handle, about, [state.library])
        state["cr"] = lowered._replace(cfunc=handle)
        return True


class InnerCompiler(CompilerBase):
    """numba compiler of functions in the form that other compiled functions call.

    The result is LLVM code that is linked into the callers.
    """

    def __init__(self, typingctx: Context, *args: Any) -> None:
        """Take the arguments of numba's compiler, and cache the types of operators."""
        super().__init__(caching_typing_context(typingctx), *args)

    def define_pipelines(self) -> list[Any]:
        """Return numba's compiler passes, of which the last one translates to linkable LLVM code.

        Functions so compiled are linked into their callers.
        """
        manager = DefaultPassBuilder.define_nopython_pipeline(self.state)
        for place, (one, about) in enumerate(manager.passes):
            if one is NativeLowering:
                manager.passes[place] = (InnerLowering, about)
        manager._finalized = False
        manager.finalize()
        return [manager]


# Functions with both forms
# ------------------------------------------------------------------------------------------------


class OuterCompiler:
    """Compiler of the wrapper by which Python calls a function that exists as LLVM code."""

    def __init__(self, inner: CPUDispatcher, releases_gil: bool) -> None:
        """Take the dispatcher of the inner form.

        Args:
            inner: The dispatcher.
            releases_gil: Whether other threads of Python may run during a call.
        """
        self._inner = inner
        self._releases_gil = releases_gil
        self.fold_argument_types = inner._compiler.fold_argument_types

    def compile(self, args: Any, return_type: Any) -> CompileResult:
        """Compile the wrappers of a function for calls from Python and for calls by address.

        Args:
            args: Types of the arguments.
            return_type: Type of the result; None: as inferred.
        """
        self._inner.compile(tuple(args))
        inner = self._inner.overloads[tuple(args)]
        context, about = inner.target_context, copy(inner.fndesc)
        # The constants of the wrapper, such as the type of an array that it returns, have a place
        # of their own: those of the inner form stay as they were when a caller was cached.
        about.env_name += "Wrapper"
        constants = Environment.from_fndesc(about)
        library = context.codegen().create_library(about.qualname)
        library.enable_object_caching()
        library.add_linking_library(inner.library)
        parts = (library, about, constants, inner.call_helper)
        context.create_cpython_wrapper(*parts, release_gil=self._releases_gil)
        context.create_cfunc_wrapper(*parts)
        called = context.get_executable(library, about, constants)
        context.insert_user_function(called, about, [library])
        # numba enters its timings of each form.
        notes = {name: value for name, value in inner.metadata.items() if name != "timers"}
        return inner._replace(
            entry_point=called,
            library=library,
            metadata=notes,
            fndesc=about,
            environment=constants,
        )


class TwoFormFunction(CPUDispatcher):
    """A compiled function in two forms: LLVM code for compiled callers, a wrapper for Python."""

    inner: CPUDispatcher

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Return numba's typing information for a call of this function from compiled code."""
        return self.inner.get_call_template(args, kws)

    def get_overload(self, sig: Any) -> Any:
        """Return the key of the LLVM code that compiled callers with a given signature link."""
        return self.inner.get_overload(sig)


def compile_both_forms(function: Callable[..., Any], options: Mapping[str, Any]) -> Any:
    """Compile a Python function in two forms: LLVM code for compiled callers, a wrapper for Python.

    Args:
        function: The Python function.
        options: Options of numba's `njit`.
    """
    outer = njit(**options)(function)
    if not isinstance(outer, CPUDispatcher):  # compiling is switched off
        return outer
    outer.__class__ = TwoFormFunction
    outer.inner = njit(
        pipeline_class=InnerCompiler, no_cpython_wrapper=True, no_cfunc_wrapper=True, **options
    )(function)
    outer._compiler = OuterCompiler(outer.inner, bool(options.get("nogil")))
    return outer
