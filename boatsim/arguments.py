"""Checks of arguments of the Python interface: an error names the argument.

A value of a wrong type is a TypeError; a value of the right type that is not allowed is a BadInput.
"""

from collections.abc import Iterable, Mapping, Sequence
from math import inf, isfinite
from os import PathLike, fspath
from types import UnionType
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BadInput, unknown_name_message

T = TypeVar("T")
LONGEST = 80  # characters of a value in a message
LARGEST_WHOLE = (1 << 63) - 1  # integers of numpy


def short_repr(value: object) -> str:
    """Return a value as an error message contains it: in one line, cut if it is long."""
    try:
        text = " ".join(repr(value).split())
    except Exception:  # a class of the user, or an integer of more digits than Python prints
        text = f"<{type(value).__name__}>"
    if len(text) > LONGEST:
        return f"{text[:LONGEST]}..."
    return text


def type_error(argument: str, value: object, allowed: str) -> TypeError:
    """Return the exception for an argument of a wrong type.

    Args:
        argument: Name of the argument.
        value: Its value.
        allowed: What is allowed.
    """
    return TypeError(f"{argument} = {short_repr(value)}; allowed is {allowed}")


def check_instance(argument: str, value: object, kind: type | UnionType, allowed: str) -> None:
    """Check the type of an argument.

    Args:
        argument: Name of the argument.
        value: Its value.
        kind: Allowed type or types.
        allowed: What is allowed, in words.

    Raises:
        TypeError: The value has another type.
    """
    if not isinstance(value, kind):
        raise type_error(argument, value, allowed)


def checked_name(argument: str, value: object) -> str:
    """Return an argument that is a name or a path as text.

    Raises:
        TypeError: It is neither.
        BadInput: It contains a null character.
    """
    if not isinstance(value, str | PathLike):
        raise type_error(argument, value, "a name or a path")
    name = fspath(value)
    if not isinstance(name, str):
        raise type_error(argument, value, "a name or a path as text")
    if "\0" in name:
        raise BadInput(f"{argument} = {short_repr(name)}; a null character is not allowed")
    try:
        name.encode()
    except UnicodeEncodeError:
        raise BadInput(f"{argument} = {short_repr(name)}; allowed is Unicode text") from None
    return name


def optional_name(argument: str, value: object) -> str | None:
    """Return a name or a path as text, and None as None; see `checked_name`."""
    if value is None:
        return None
    return checked_name(argument, value)


def checked_names(argument: str, value: object) -> list[str]:
    """Return an argument that is a name or several names as a list of texts.

    Raises:
        TypeError: It is something else.
        BadInput: A name contains a null character.
    """
    if isinstance(value, str | PathLike):
        return [checked_name(argument, value)]
    if not isinstance(value, Iterable) or isinstance(value, bytes | Mapping):
        raise type_error(argument, value, "a name or a list of names")
    names = []
    for one in value:
        names.append(checked_name(argument, one))
    return names


def checked_mapping(argument: str, value: object) -> Mapping[str, object]:
    """Return an argument that is a mapping with texts as keys.

    Raises:
        TypeError: It is something else.
    """
    if not isinstance(value, Mapping):
        raise type_error(argument, value, "a mapping")
    for key in value:
        check_instance(f"key of {argument}", key, str, "a text")
    return value


def checked_number(
    argument: str, value: object, low: float = -inf, high: float = inf, unit: str = ""
) -> float:
    """Return an argument that is a finite number from `low` to `high` as a float.

    Args:
        argument: Name of the argument.
        value: Its value.
        low: Smallest allowed value.
        high: Largest allowed value.
        unit: Unit in the message.

    Raises:
        TypeError: It is no number.
        BadInput: It is not finite or not allowed.
    """
    if isinstance(value, bool | np.bool_) or not isinstance(value, int | float | np.number):
        raise type_error(argument, value, "a number")
    if isinstance(value, complex | np.complexfloating):
        raise type_error(argument, value, "a real number")
    try:
        number = float(value)
    except OverflowError:
        number = inf
    if not isfinite(number) or not low <= number <= high:
        allowed = f"{low:g} to {high:g} {unit}".rstrip()
        raise BadInput(f"{argument} = {short_repr(value)}; allowed {allowed}")
    return number


def checked_integer(argument: str, value: object, low: int = 0, high: int = LARGEST_WHOLE) -> int:
    """Return an argument that is a whole number from `low` to `high` as an int.

    Raises:
        TypeError: It is no whole number.
        BadInput: It is not allowed.
    """
    if isinstance(value, bool | np.bool_) or not isinstance(value, int | np.integer):
        raise type_error(argument, value, "a whole number")
    if not low <= value <= high:
        raise BadInput(f"{argument} = {short_repr(value)}; allowed {low} to {high:g}")
    return int(value)


def checked_choice(argument: str, value: object, allowed: Sequence[str]) -> str:
    """Return an argument that is one of some words.

    Raises:
        TypeError: It is no text.
        BadInput: It is another word.
    """
    if not isinstance(value, str):
        raise type_error(argument, value, " or ".join(map(repr, allowed)))
    if value not in allowed:
        raise BadInput(unknown_name_message(argument, value, allowed))
    return value


def float_array(argument: str, value: object) -> NDArray[np.float64]:
    """Return an argument that is a number or an array of numbers as an array of floats.

    Raises:
        BadInput: It is something else, such as a list of rows of different lengths.
    """
    try:
        given = np.asarray(value)
        if given.dtype.kind in "biuf":
            return given.astype(float)
        if given.dtype == object or not given.size:
            return np.asarray(value, dtype=float)
    except (TypeError, ValueError, OverflowError):
        pass
    allowed = "is a number"
    if isinstance(value, Iterable) and not isinstance(value, str | bytes):
        allowed = "are numbers"
    raise BadInput(f"{argument} = {short_repr(value)}; allowed {allowed}")


def integer_array(argument: str, value: object) -> NDArray[np.int64]:
    """Return an argument that is a whole number or an array of them as an array.

    Raises:
        BadInput: It is something else.
    """
    try:
        whole = np.asarray(value)
    except (TypeError, ValueError):
        raise BadInput(f"{argument} = {short_repr(value)}; allowed are whole numbers") from None
    if whole.dtype.kind in "iu" and (not whole.size or whole.max() <= LARGEST_WHOLE):
        return whole.astype(np.int64)
    given = float_array(argument, value)
    largest = float(1 << 53)  # floats represent all smaller integers
    if not np.isfinite(given).all() or (given != np.round(given)).any():
        raise BadInput(f"{argument} = {short_repr(value)}; allowed are whole numbers")
    if (np.abs(given) > largest).any():
        raise BadInput(f"{argument} = {short_repr(value)}; allowed are numbers of 53 bits")
    return given.astype(np.int64)
