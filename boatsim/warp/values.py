"""Kinds of values in Warp, and the text with which each is written."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain
from math import isfinite
from typing import TypeAlias

REAL, WHOLE, BITS, TRUTH, ROW, NOTHING = "T", "int", "wp.uint64", "bool", "wp.array(dtype=T)", ""


@dataclass(frozen=True)
class Record:
    """Warp type of a named tuple of floats, which is translated to a struct."""

    name: str
    fields: tuple[str, ...]


# Warp has no tuples: each part is a value of its own
Kind: TypeAlias = "str | Record | tuple[Kind, ...]"


@dataclass(frozen=True)
class Value:
    """Translated expression in Warp: its type, and its source text or, for a tuple, its parts."""

    kind: Kind
    text: str = ""
    parts: tuple["Value", ...] = ()
    fixed: object = None  # the Python number of a constant


NONE = Value(NOTHING)


def make_tuple(parts: Sequence[Value]) -> Value:
    """Combine translated values to the value of a tuple; no values give the value of nothing.

    Args:
        parts: The values.
    """
    if not parts:
        return NONE
    return Value(tuple(p.kind for p in parts), parts=tuple(parts))


def flatten_tuple(value: Value) -> list[Value]:
    """Return the parts of a translated, possibly nested tuple value that are no tuples.

    The list is empty for the value of nothing.

    Args:
        value: The value.
    """
    if value.kind == NOTHING:
        return []
    if not isinstance(value.kind, tuple):
        return [value]
    return list(chain.from_iterable(map(flatten_tuple, value.parts)))


def make_variable(kind: Kind, name: str) -> Value:
    """Return the translated value of a variable of a Warp type, for use in Warp source.

    Args:
        kind: Its kind.
        name: Its name; those of the parts of a tuple are numbered.
    """
    if isinstance(kind, tuple):
        return make_tuple([make_variable(k, f"{name}_{i}") for i, k in enumerate(kind)])
    if kind == NOTHING:
        return NONE
    return Value(kind, name)


def make_constant(number: object) -> Value:
    """Return the translated value of a Python number, for use in Warp source.

    Args:
        number: A bool, int or float.
    """
    if isinstance(number, bool):
        return Value(TRUTH, str(number), fixed=number)
    if isinstance(number, int):
        return Value(WHOLE, str(number), fixed=number)
    assert isinstance(number, float)
    text = f"T({number!r})"
    if not isfinite(number):
        text = "T(wp.inf)" if number > 0.0 else "-T(wp.inf)"
    return Value(REAL, text, fixed=number)


def convert_to_float(value: Value) -> Value:
    """Convert a translated value to a float in Warp source.

    Args:
        value: A number.
    """
    if value.kind == REAL:
        return value
    if isinstance(value.fixed, bool | int):
        return make_constant(float(value.fixed))
    if value.kind == TRUTH:
        return Value(REAL, f"wp.where({value.text}, T(1.0), T(0.0))")
    return Value(REAL, f"T({value.text})")


def convert_to_bool(value: Value) -> Value:
    """Convert a translated value to a bool in Warp source: whether it is not zero.

    Args:
        value: A number.
    """
    if value.kind == TRUTH:
        return value
    if value.fixed is not None:
        return make_constant(bool(value.fixed))
    zero = "T(0.0)" if value.kind == REAL else "0"
    return Value(TRUTH, f"({value.text} != {zero})")


def annotation_of(kind: Kind) -> str:
    """Return the type annotation of a function argument in Warp source."""
    assert not isinstance(kind, tuple)
    if isinstance(kind, Record):
        return kind.name
    return kind
