"""The error family: everything a user can get wrong ends in one clear line and exit code 2."""

from collections.abc import Iterable
from difflib import get_close_matches

GAP = " ... "  # in place of the middle of a line that is too long


class BoatsimError(Exception):
    """Base of all errors raised on purpose by boatsim; the command line prints its message as one line."""


class BadInput(BoatsimError):
    """Something a user wrote (a file, a key, a value, a name) can not be used; the message says what would be right."""


class BadPhysics(BoatsimError):
    """A model that can not be stepped: a mass matrix that is not positive definite, a state that is not finite."""


MANY, FEW = 12, 5  # names beyond which only the nearest are told, and how many


def unknown_name(what: str, found: str, allowed: Iterable[str]) -> str:
    """Line for a name that does not exist: the nearest valid one, then all of them, or of many the nearest few."""
    names = sorted(allowed)
    ends = {
        name.rpartition("/")[2]: name for name in reversed(names)
    }  # a case stands for vessel/case too
    near = get_close_matches(found, names, n=1, cutoff=0.5) or get_close_matches(
        found, ends, n=1, cutoff=0.5
    )
    near = [ends.get(n, n) for n in near]
    hint = f"; did you mean {near[0]!r}?" if near else ""
    if len(names) <= MANY:
        return f"{what} {found!r} does not exist{hint} (there are: {', '.join(names) or 'none'})"
    alike = [n for n in names if found and found in n][:FEW] or get_close_matches(
        found, names, n=FEW, cutoff=0.4
    )
    others = [n for n in alike if n not in near]
    return f"{what} {found!r} does not exist{hint} ({len(names)} do{', such as ' + ', '.join(others) if others else ''})"


def shown(text: str, longest: int | None = None) -> str:
    """Text of others as a terminal may show it: what steers one, or turns the way of reading, is written as an escape.

    What is longer than `longest` characters loses its middle: the file stands in front, what is wrong with it behind.
    """
    plain = "".join(
        c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text
    )
    if longest is None or len(plain) <= longest:
        return plain
    tail = longest // 2
    return f"{plain[: longest - tail - len(GAP)]}{GAP}{plain[-tail:]}"
