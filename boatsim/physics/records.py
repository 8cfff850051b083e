"""Lets compiled laws build a named tuple by the names of its fields, the others at their defaults.

Numba knows no defaults of named tuples, and a small compiled function in their place would be analysed anew at every
call. A constructor is therefore made known to numba by its signature alone.
"""

from collections.abc import Callable, Mapping, Sequence

from llvmlite import ir
from numba import types
from numba.core import utils
from numba.core.base import BaseContext
from numba.core.typing.templates import AbstractTemplate, Signature, infer_global, signature
from numba.extending import lower_builtin


def known_to_numba(constructor: Callable[..., object], record: type) -> None:
    """Compile calls of a Python function that fills the fields of a named tuple of floats, each 0 or 1 by default."""
    python = utils.pysignature(constructor)
    defaults = {name: float(about.default) for name, about in python.parameters.items()}

    class Constructor(AbstractTemplate):
        """Typing of one call: what is left out is its default."""

        def generic(self, args: Sequence[types.Type], kws: Mapping[str, types.Type]) -> Signature:
            given = python.bind(*args, **kws).arguments
            full = [given.get(name, types.Omitted(value)) for name, value in defaults.items()]
            made = types.BaseTuple.from_types([types.float64] * len(full), record)
            return signature(made, *full).replace(pysig=python)

    infer_global(constructor)(Constructor)

    @lower_builtin(constructor, types.VarArg(types.Any))
    def build(
        context: BaseContext, builder: ir.IRBuilder, call: Signature, args: Sequence[ir.Value]
    ) -> ir.Value:
        items = [
            context.get_constant(types.float64, float(kind.value))
            if isinstance(kind, types.Omitted)
            else context.cast(builder, value, kind, types.float64)
            for value, kind in zip(args, call.args, strict=True)
        ]
        return context.make_tuple(builder, call.return_type, items)
