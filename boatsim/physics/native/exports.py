"""Functions of a C library that Python can call."""

from collections.abc import Sequence
from typing import Any

from boatsim.physics.native.kinds import NOTHING, ArrayKind, Kind, Struct
from boatsim.physics.native.translate import Translation


def flat_parameters(kind: Kind, name: str) -> tuple[list[str], str]:
    """Return the C parameters of an argument of a library function, and how it is built from them.

    Arrays are passed as an address and sizes, tuples entry by entry.

    Args:
        kind: Kind of the argument.
        name: Prefix of the names of the parameters.
    """
    if isinstance(kind, Struct):
        parameters, built = list[str](), []
        for i, part in enumerate(kind.kinds):
            more, text = flat_parameters(part, f"{name}_{i}")
            parameters += more
            built.append(text)
        return parameters, f"(({kind.c}){{{', '.join(built)}}})"
    if isinstance(kind, ArrayKind):
        sizes = [f"{name}_n{i}" for i in range(kind.dimensions)]
        pointer = f"{kind.item.c} *{name}"
        return (
            [pointer, *(f"int64_t {s}" for s in sizes)],
            f"(({kind.c}){{{', '.join([name, *sizes])}}})",
        )
    return [f"{kind.c} {name}"], name


def export_function(program: Translation, name: str, function: Any, kinds: Sequence[Kind]) -> None:
    """Add a function that Python can call: it writes its results and returns how many they are.

    Args:
        program: The program.
        name: Name in the library.
        function: The Python function.
        kinds: Kinds of its arguments.
    """
    inner, returned = program.function(function, kinds)
    parameters, built = list[str](), []
    for i, kind in enumerate(kinds):
        more, text = flat_parameters(kind, f"a{i}")
        parameters += more
        built.append(text)
    call = f"{inner}({', '.join(built)})"
    lines = [f"    {call};", "    return 0;"]
    if returned != NOTHING:
        lines = [f"    {returned.c} found = {call};"]
        paths = _paths(returned, "found")
        lines += [f"    result[{i}] = (double){path};" for i, path in enumerate(paths)]
        lines.append(f"    return {len(paths)};")
    head = f"int {name}({', '.join([*parameters, 'double *result'])})"
    program.functions.append("\n".join([head, "{", *lines, "}", ""]))


def _paths(kind: Kind, name: str) -> list[str]:
    """C expressions of all numbers in a result."""
    if isinstance(kind, Struct):
        found = []
        for field, part in zip(kind.fields, kind.kinds, strict=True):
            found += _paths(part, f"{name}.{field}")
        return found
    return [name]
