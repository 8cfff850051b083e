"""Structs and constants of translated C source, each declared before it is used."""

import re
from abc import ABC, abstractmethod
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.native.kinds import REAL, Kind, Struct, Value, convert_to_double, number_value

NUMBERS = bool | int | float


class NotTranslatable(BadInput):
    """Raised for Python code that has no form in C."""


@cache
def source_preamble() -> str:
    """Return the C source in front of every program: arrays and small functions."""
    return (Path(__file__).parent / "head.h").read_text(encoding="utf-8")


class Declarations(ABC):
    """C source of a program: structs, constants and functions, each before it is used."""

    def __init__(self, wrap_indices: bool) -> None:
        self.wrap_indices = wrap_indices
        self.structs: list[str] = []
        self.functions: list[str] = []
        self._structs: dict[tuple[Any, tuple[Kind, ...]], Struct] = {}
        self._constants: dict[Any, Value] = {}
        self._names: set[str] = set()

    @property
    def source_text(self) -> str:
        """C source of the whole program."""
        return "\n".join([source_preamble(), *self.structs, *self.functions])

    def unused_name(self, name: str) -> str:
        """Return a C name that no other function, struct or constant of the program has.

        Args:
            name: The wanted name.
        """
        wanted = re.sub(r"\W", "_", name)
        found, n = wanted, 1
        while found in self._names:
            found, n = f"{wanted}_{n}", n + 1
        self._names.add(found)
        return found

    def declare_struct(self, record: Any, kinds: Sequence[Kind]) -> Struct:
        """Declare the C struct of a named tuple, or of a tuple, once; return it.

        Args:
            record: Type of the named tuple; None for a tuple.
            kinds: Kinds of its entries.
        """
        key = (record, tuple(kinds))
        if key not in self._structs:
            if record is None:
                fields, name = tuple(f"f{i}" for i in range(len(kinds))), "tuple"
            else:
                fields, name = tuple(f"f_{f}" for f in record._fields), record.__name__
            found = Struct(self.unused_name(f"{name}_t"), fields, tuple(kinds))
            inside = " ".join(f"{k.c} {f};" for f, k in zip(fields, kinds, strict=True))
            self.structs.append(f"typedef struct {{ {inside} }} {found.c};")
            self._structs[key] = found
        return self._structs[key]

    def declare_constant_tuple(self, found: tuple[Any, ...]) -> Value:
        """Declare a Python tuple of numbers as a C constant, once; return its value.

        Args:
            found: The Python tuple.
        """
        parts = [self.constant_value(x) for x in found]
        if any(p.kind == REAL for p in parts):
            parts = [convert_to_double(p) for p in parts]
        kind = self.declare_struct(None, [p.kind for p in parts])
        key = (kind, found)
        if key not in self._constants:
            name = self.unused_name("constants")
            inside = ", ".join(_initial(p) for p in parts)
            self.structs.append(f"static const {kind.c} {name} = {{{inside}}};")
            self._constants[key] = Value(kind, name, found)
        return self._constants[key]

    def constant_value(self, found: Any) -> Value:
        """Return a Python number or tuple as a translated constant.

        Args:
            found: A Python object.

        Raises:
            TypeError: It is neither.
        """
        if isinstance(found, np.integer | np.floating | np.bool_):
            found = found.item()
        if isinstance(found, NUMBERS):
            return number_value(found)
        if isinstance(found, tuple):
            return self.declare_constant_tuple(found)
        raise TypeError(f"{type(found).__name__} is no constant")

    @abstractmethod
    def translate_function(self, function: Any, kinds: Sequence[Kind]) -> tuple[str, Kind]:
        """Translate a Python function to C; return its C name and the kind of its result.

        Args:
            function: A Python or compiled function.
            kinds: Kinds of its arguments.
        """


def _initial(value: Value) -> str:
    """Initialiser of a constant: a number, or the entries of a tuple."""
    if isinstance(value.fixed, tuple):
        inside = []
        assert isinstance(value.kind, Struct)
        for x, kind in zip(value.fixed, value.kind.kinds, strict=True):
            one = Value(kind, "", x) if isinstance(x, tuple) else number_value(x)
            inside.append(_initial(convert_to_double(one) if kind == REAL else one))
        return f"{{{', '.join(inside)}}}"
    return value.text
