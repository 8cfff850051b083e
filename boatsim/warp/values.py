"""What values of a compiled law are for Warp, and how each is written there."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite
from typing import TypeAlias

REAL, WHOLE, BITS, TRUTH, ROW, NOTHING = "T", "int", "wp.uint64", "bool", "wp.array(dtype=T)", ""


@dataclass(frozen=True)
class Record:
    """A named tuple of floats, a struct there; known by its name in the text."""

    name: str
    fields: tuple[str, ...]


# a tuple is no value of Warp's: its parts go their own ways
Kind: TypeAlias = "str | Record | tuple[Kind, ...]"


@dataclass(frozen=True)
class Value:
    """An expression: its kind, and its text or, of a tuple, its parts."""

    kind: Kind
    text: str = ""
    parts: tuple["Value", ...] = ()
    fixed: object = None  # the Python number of a constant


NONE = Value(NOTHING)


def tuple_of(parts: Sequence[Value]) -> Value:
    """Values beside one another; none at all are nothing."""
    return Value(tuple(p.kind for p in parts), parts=tuple(parts)) if parts else NONE


def flat(value: Value) -> list[Value]:
    """All parts of a value that Warp knows: of nothing there are none."""
    if value.kind == NOTHING:
        return []
    return (
        [leaf for part in value.parts for leaf in flat(part)]
        if isinstance(value.kind, tuple)
        else [value]
    )


def named(kind: Kind, name: str) -> Value:
    """A variable of this kind; the parts of a tuple are numbered."""
    if isinstance(kind, tuple):
        return tuple_of([named(k, f"{name}_{i}") for i, k in enumerate(kind)])
    return Value(kind, name) if kind != NOTHING else NONE


def constant(number: object) -> Value:
    """A number as it is written there."""
    if isinstance(number, bool):
        return Value(TRUTH, str(number), fixed=number)
    if isinstance(number, int):
        return Value(WHOLE, str(number), fixed=number)
    assert isinstance(number, float)
    text = f"T({number!r})" if isfinite(number) else ("T(wp.inf)" if number > 0.0 else "-T(wp.inf)")
    return Value(REAL, text, fixed=number)


def real(value: Value) -> Value:
    """A number as a float."""
    if value.kind == REAL:
        return value
    if isinstance(value.fixed, bool | int):
        return constant(float(value.fixed))
    return Value(
        REAL,
        f"wp.where({value.text}, T(1.0), T(0.0))" if value.kind == TRUTH else f"T({value.text})",
    )


def truth(value: Value) -> Value:
    """A number as whether it is not zero."""
    if value.kind == TRUTH:
        return value
    if value.fixed is not None:
        return constant(bool(value.fixed))
    return Value(TRUTH, f"({value.text} != {'T(0.0)' if value.kind == REAL else '0'})")


def written(kind: Kind) -> str:
    """A kind as the annotation of an argument."""
    assert not isinstance(kind, tuple)
    return kind.name if isinstance(kind, Record) else kind
