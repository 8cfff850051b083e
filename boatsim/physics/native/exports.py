"""Functions of a C library that Python and numba can call.

All of them have one C signature: `double NAME(const word_t *a, double *results)`. The arguments
are words of 8 bytes one after another: numbers, and for each array its address and its sizes; a
tuple is passed entry by entry. A function that returns one number returns it; one that returns
several writes them to `results` and returns how many they are.
"""

from collections.abc import Iterator, Sequence
from itertools import count
from typing import Any

from boatsim.physics.native.kinds import (
    NOTHING,
    REAL,
    TRUTH,
    ArrayKind,
    Kind,
    Record,
    RecordArray,
    Scalar,
    Struct,
)
from boatsim.physics.native.translate import Translation


def argument_expression(kind: Kind, word: Iterator[int]) -> str:
    """Return the C expression that builds an argument from the words of a call.

    Args:
        kind: Kind of the argument.
        word: Numbers of the next words.
    """
    if isinstance(kind, Struct):
        parts = [argument_expression(part, word) for part in kind.kinds]
        return f"(({kind.c}){{{', '.join(parts)}}})"
    if isinstance(kind, ArrayKind):
        address = f"({kind.item.c} *)a[{next(word)}].at"
        sizes = [f"a[{next(word)}].whole" for _ in range(kind.dimensions)]
        return f"(({kind.c}){{{', '.join([address, *sizes])}}})"
    if isinstance(kind, Record | RecordArray):
        return f"(double *)a[{next(word)}].at"
    if kind == REAL:
        return f"a[{next(word)}].real"
    if kind == TRUTH:
        return f"(a[{next(word)}].whole != 0)"
    return f"a[{next(word)}].whole"


def export_function(program: Translation, name: str, function: Any, kinds: Sequence[Kind]) -> None:
    """Add a C function to the program that Python can call.

    Args:
        program: The program.
        name: Name in the library.
        function: The Python function.
        kinds: Kinds of its arguments.
    """
    inner, returned = program.translate_function(function, kinds)
    word = count()
    given = ", ".join([argument_expression(kind, word) for kind in kinds])
    call = f"{inner}({given})"
    if returned == NOTHING:
        lines = [f"    {call};", "    return 0.0;"]
    elif isinstance(returned, Scalar):
        lines = [f"    return (double){call};"]
    else:
        lines = [f"    {returned.c} found = {call};"]
        paths = _paths(returned, "found")
        lines += [f"    results[{i}] = (double){path};" for i, path in enumerate(paths)]
        lines.append(f"    return {len(paths)}.0;")
    head = f"double {name}(const word_t *a, double *results)"
    program.functions.append("\n".join([head, "{", *lines, "}", ""]))


def _paths(kind: Kind, name: str) -> list[str]:
    """C expressions of all numbers in a result."""
    if isinstance(kind, Struct):
        found = []
        for field, part in zip(kind.fields, kind.kinds, strict=True):
            found += _paths(part, f"{name}.{field}")
        return found
    return [name]
