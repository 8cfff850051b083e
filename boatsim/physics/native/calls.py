"""Calls of C functions from Python: arrays, numbers and tuples of these as words of 8 bytes."""

import ctypes
import struct
from collections.abc import Callable, Sequence
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from boatsim.physics.native.entries import RECORDS, Entry
from boatsim.physics.native.kinds import (
    REAL,
    WHOLE,
    ArrayKind,
    Kind,
    Record,
    RecordArray,
    Scalar,
    Struct,
    record_kind,
    scalar_and_array_kinds,
)
from boatsim.physics.native.translate import Translation

MOST_RESULTS = 16  # numbers that a function returns
ITEMS = {REAL: np.dtype(np.float64), WHOLE: np.dtype(np.int64)}


def argument_kinds(program: Translation, entry: Entry) -> list[Kind]:
    """Return the kinds of a C function's arguments, with structs for its named tuples.

    Args:
        program: The program to which the structs belong.
        entry: The function.
    """
    kinds: list[Kind] = []
    for kind in entry.arguments:
        if kind in RECORDS:
            kinds.append(program.declare_struct(kind, RECORDS[kind]))
        else:
            kinds.append(kind)
    return kinds


class PackedRecord(NamedTuple):
    """A named tuple of arrays whose addresses and sizes have been looked up."""

    words: Sequence[Any]
    record: Any  # its arrays must live as long as the addresses are used


class PackedArgument(NamedTuple):
    """An argument of a function and its words, which are looked up once."""

    words: bytes  # empty where no C library is used
    value: Any  # its arrays must live as long as the words are used


class NativeFunction:
    """A function of a C library as a Python function."""

    def __init__(self, function: Any, entry: Entry) -> None:
        """Declare the function.

        Args:
            function: The function, as ctypes loads it.
            entry: Its arguments and result.
        """
        function.argtypes, function.restype = [ctypes.c_char_p, ctypes.c_void_p], ctypes.c_double
        self.function, self._result = function, entry.result
        self._kinds = argument_kinds(Translation(), entry)
        every = chain.from_iterable(map(scalar_and_array_kinds, self._kinds))
        self._pack = struct.Struct("=" + "".join(map(_format, every))).pack

    @property
    def argument_kinds(self) -> Sequence[Kind]:
        """Kinds of the arguments."""
        return self._kinds

    @property
    def address(self) -> int:
        """Address of the C function."""
        return int(ctypes.cast(self.function, ctypes.c_void_p).value or 0)

    def __call__(self, *given: Any) -> Any:
        """Call the function.

        Args:
            *given: Its arguments, as those of the compiled function of the program.

        Raises:
            TypeError: An array is not contiguous, or has another type or number of dimensions.
        """
        return self.call_with_words(self.pack_arguments(*given))

    def pack_arguments(self, *given: Any) -> bytes:
        """Return arguments as words. The arrays among them must live as long as these are used."""
        flat: list[Any] = []
        for kind, value in zip(self._kinds, given, strict=True):
            _flatten(kind, value, flat)
        return self._pack(*flat)

    def partial(self, *given: Any) -> Callable[..., Any]:
        """Bind arguments; return a function of the floats left open as `...`.

        A call costs a fraction of an ordinary one. The function must not be called by two threads
        at the same time.

        Args:
            *given: Arguments; their arrays are changed and read by each call.
        """
        flat, free = list[Any](), list[int]()
        for kind, value in zip(self._kinds, given, strict=True):
            if value is ...:
                free.append(len(flat))
                flat.append(0.0)
            else:
                _flatten(kind, value, flat)
        words = np.frombuffer(self._pack(*flat), dtype=np.float64).copy()
        floats: Any = words.data  # quicker to write to than the array
        address = ctypes.cast(words.ctypes.data, ctypes.c_char_p)
        function, result = self.function, self._result
        several = result not in (None, float)
        results = np.empty(MOST_RESULTS)
        out = results.ctypes.data

        def call_function(*numbers: float) -> Any:
            for place, number in zip(free, numbers, strict=True):
                floats[place] = number
            if result is None or not several:
                return function(address, None)
            found = int(function(address, out))
            return result(*results[:found].tolist())

        call_function.__dict__["arrays"] = given  # they must live as long as the addresses are used
        return call_function

    def call_with_words(self, words: Any) -> Any:
        """Call the function with packed arguments.

        Args:
            words: The arguments, as `pack_arguments` returns them, or the address of such words.
        """
        if self._result is None:
            self.function(words, None)
            return None
        if self._result is float:
            return self.function(words, None)
        results = np.empty(MOST_RESULTS)
        found = int(self.function(words, results.ctypes.data))
        return self._result(*results[:found].tolist())


def _format(leaf: Scalar | ArrayKind | Record | RecordArray) -> str:
    """Letters of `struct` for a number, or for an array's address and sizes."""
    if isinstance(leaf, ArrayKind):
        return "Q" + "q" * leaf.dimensions
    if isinstance(leaf, Record | RecordArray):
        return "Q"
    if leaf == REAL:
        return "d"
    return "q"


def _flatten(kind: Kind, value: Any, out: list[Any]) -> None:
    """Append a number, an array's address and sizes, or all of these of a tuple."""
    if isinstance(value, PackedRecord):
        out += value.words
    elif isinstance(kind, Struct):
        for part, one in zip(kind.kinds, value, strict=True):
            _flatten(part, one, out)
    elif isinstance(kind, ArrayKind):
        if (
            value.dtype != ITEMS[kind.item]
            or value.ndim != kind.dimensions
            or not value.flags.c_contiguous
        ):
            raise TypeError(
                f"an array of {value.dtype} with {value.ndim} dimensions; allowed is a contiguous "
                f"one of {ITEMS[kind.item]} with {kind.dimensions}"
            )
        out.append(_address(value))
        out += value.shape
    elif isinstance(kind, RecordArray):
        if record_kind(value.dtype) != kind.item or not value.flags.c_contiguous:
            raise TypeError(f"a record array of {value.dtype}, not of the kind of the function")
        out.append(int(value.ctypes.data))
    elif kind == REAL:
        out.append(value)
    else:
        out.append(int(value))


def _address(array: Any) -> int:
    """Address of an array's first entry; the quick way fails if it is read-only or empty."""
    try:
        return ctypes.addressof(ctypes.c_char.from_buffer(array))
    except (TypeError, ValueError):
        return int(array.ctypes.data)


def pack_named_tuple(code: Any, record: Any) -> Any:
    """Return a named tuple of arrays with their addresses looked up, for faster calls of C.

    Args:
        code: The program's functions, from C or from numba.
        record: The named tuple; its arrays are not replaced later.
    """
    if not isinstance(code.advance_actuators, NativeFunction):
        return record
    words: list[Any] = []
    _flatten(Translation().declare_struct(type(record), RECORDS[type(record)]), record, words)
    return PackedRecord(words, record)


def partial_call(code: Any, name: str, *given: Any) -> Callable[..., Any]:
    """Bind arguments of a program's function; return a function of the numbers left open as `...`.

    Args:
        code: The program's functions, from C or from numba.
        name: Name of the function.
        *given: Its arguments.
    """
    function = getattr(code, name)
    if isinstance(function, NativeFunction):
        return function.partial(*given)
    free = _places_of_numbers(given)

    def call_function(*numbers: float) -> Any:
        full = list(given)
        for place, number in zip(free, numbers, strict=True):
            full[place] = number
        return function(*full)

    return call_function


class BoundCall:
    """A call of a program's function that is repeated while few of its arguments change.

    Only the words of an argument that changes are written again, which takes a fraction of the time
    in which all arguments are packed. Two threads must not use it at the same time.
    """

    def __init__(self, code: Any, name: str, *given: Any) -> None:
        """Bind all arguments.

        Args:
            code: The program's functions, from C or from numba.
            name: Name of the function.
            *given: Its arguments, of which later calls may replace some.
        """
        function = getattr(code, name)
        self._given = list(given)
        self._function = function
        self._native = isinstance(function, NativeFunction)
        if self._native:
            self._kinds = function.argument_kinds
            self._packs, self._bytes = _packers(self._kinds)
            self._words = ctypes.create_string_buffer(function.pack_arguments(*given))
            self._memory = memoryview(self._words).cast("B")
            self._words_address = ctypes.cast(self._words, ctypes.c_char_p)

    def pack(self, place: int, value: Any) -> PackedArgument:
        """Return an argument with its words, to be replaced several times.

        Args:
            place: Place of the argument.
            value: Its value. Its arrays are not replaced later.
        """
        if not self._native:
            return PackedArgument(b"", value)
        flat: list[Any] = []
        _flatten(self._kinds[place], value, flat)
        return PackedArgument(self._packs[place](*flat), value)

    def replace(self, place: int, argument: PackedArgument) -> None:
        """Replace an argument in all later calls.

        Args:
            place: Place of the argument.
            argument: The argument, as `pack` returns it.
        """
        self._given[place] = argument.value
        if self._native:
            self._memory[self._bytes[place]] = argument.words

    def __call__(self) -> Any:
        """Call the function."""
        if self._native:
            return self._function.call_with_words(self._words_address)
        return self._function(*self._given)


def _packers(kinds: Sequence[Kind]) -> tuple[list[Callable[..., bytes]], list[slice]]:
    """Functions that pack each argument, and the bytes that each takes among all words."""
    packs: list[Callable[..., bytes]] = []
    places: list[slice] = []
    end = 0
    for kind in kinds:
        one = struct.Struct("=" + "".join(map(_format, scalar_and_array_kinds(kind))))
        packs.append(one.pack)
        places.append(slice(end, end + one.size))
        end += one.size
    return packs, places


def _places_of_numbers(given: Sequence[Any]) -> list[int]:
    """Places of the arguments that are left open."""
    places = []
    for i, value in enumerate(given):
        if value is ...:
            places.append(i)
    return places
