"""Types of values in translated C source: numbers, arrays, and structs for tuples."""

from dataclasses import dataclass
from itertools import chain
from typing import Any

import numpy as np

WORD = 8  # bytes of a number


@dataclass(frozen=True)
class Scalar:
    """A number."""

    c: str  # name of the C type


@dataclass(frozen=True)
class ArrayKind:
    """A contiguous array of numbers with row-major order."""

    item: Scalar
    dimensions: int

    @property
    def c(self) -> str:
        """Name of the C struct of the array: a pointer and the sizes."""
        return f"{'array' if self.item == REAL else 'rows'}{self.dimensions}_t"


@dataclass(frozen=True)
class Struct:
    """A tuple or named tuple."""

    c: str  # name of the C struct
    fields: tuple[str, ...]
    kinds: tuple["Kind", ...]

    def field_kind(self, name: str) -> "Kind":
        """Return the kind of a field of the struct."""
        return self.kinds[self.fields.index(name)]

    @property
    def common_field_kind(self) -> "Kind | None":
        """Kind that all fields have, or None if the fields differ."""
        if len(set(self.kinds)) == 1:
            return self.kinds[0]
        return None


@dataclass(frozen=True)
class Record:
    """A record of a NumPy structured array, all of whose numbers are floats, in place in memory."""

    names: tuple[str, ...]
    places: tuple[int, ...]  # [words] of each field from the begin of the record
    kinds: tuple["Kind", ...]  # numbers, records, and vectors and matrices of numbers
    sizes: tuple[tuple[int, ...], ...]  # of each vector or matrix; () of the others
    words: int  # length of the record

    @property
    def c(self) -> str:
        """Name of the C type: a pointer to the first number."""
        return "double *"


@dataclass(frozen=True)
class RecordArray:
    """A contiguous array of records."""

    item: Record

    @property
    def c(self) -> str:
        """Name of the C type: a pointer to the first number of the first record."""
        return "double *"


Kind = Scalar | ArrayKind | Struct | Record | RecordArray

REAL = Scalar("double")
WHOLE = Scalar("int64_t")
BITS = Scalar("uint64_t")
TRUTH = Scalar("bool")
NOTHING = Scalar("void")
VECTOR, MATRIX, CUBE = ArrayKind(REAL, 1), ArrayKind(REAL, 2), ArrayKind(REAL, 3)
ROWS = ArrayKind(WHOLE, 1)


@dataclass(frozen=True)
class Value:
    """A translated expression: its kind and C source, and its number if it is a constant."""

    kind: Kind
    text: str
    fixed: object = None  # bool, int, float or a tuple of these


def record_kind(dtype: Any) -> Record:
    """Return the kind of the records of a NumPy structured array.

    Args:
        dtype: Type of the records.

    Raises:
        TypeError: A number of the record is no float, or an array has more than two dimensions.
    """
    names, places, kinds, sizes = [], [], list[Kind](), []
    for name, (field, offset, *_) in (dtype.fields or {}).items():
        names.append(name)
        places.append(offset // WORD)
        sizes.append(field.shape)
        if field.names:
            kinds.append(record_kind(field))
        elif field.base != np.float64 or len(field.shape) > MATRIX.dimensions:
            raise TypeError(f"field {name} of a record is of {field}")
        elif field.shape:
            kinds.append(ArrayKind(REAL, len(field.shape)))
        else:
            kinds.append(REAL)
    words = dtype.itemsize // WORD
    return Record(tuple(names), tuple(places), tuple(kinds), tuple(sizes), words)


def scalar_and_array_kinds(kind: Kind) -> list[Scalar | ArrayKind | Record | RecordArray]:
    """Return the kinds of all numbers and arrays in a possibly nested struct, in order.

    Args:
        kind: Any kind.
    """
    if isinstance(kind, Struct):
        return list(chain.from_iterable(map(scalar_and_array_kinds, kind.kinds)))
    return [kind]


def number_value(number: object) -> Value:
    """Return a Python number as a translated constant, with its C source.

    Args:
        number: A bool, int or float.
    """
    if isinstance(number, bool):
        return Value(TRUTH, "true" if number else "false", number)
    if isinstance(number, int):
        return Value(
            WHOLE, f"INT64_C({number})" if number >= 0 else f"(-INT64_C({-number}))", number
        )
    assert isinstance(number, float)
    if number != number:
        return Value(REAL, "((double)NAN)", number)
    if number in (float("inf"), float("-inf")):
        return Value(REAL, "((double)INFINITY)" if number > 0 else "(-(double)INFINITY)", number)
    text = number.hex()  # without loss of digits
    return Value(REAL, text if number >= 0.0 and not text.startswith("-") else f"({text})", number)


def convert_to_double(value: Value) -> Value:
    """Convert a translated number to a double.

    Args:
        value: A number.
    """
    if value.kind == REAL:
        return value
    if isinstance(value.fixed, bool | int):
        return number_value(float(value.fixed))
    return Value(REAL, f"((double){value.text})")


def convert_to_bool(value: Value) -> Value:
    """Convert a translated number to a bool: whether it is not zero.

    Args:
        value: A number.
    """
    if value.kind == TRUTH:
        return value
    if isinstance(value.fixed, int | float):
        return number_value(bool(value.fixed))
    return Value(TRUTH, f"({value.text} != 0)")
