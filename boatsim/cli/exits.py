"""How the program ends: one exit code, and one line for what went wrong."""

import sys
from collections.abc import Iterable
from enum import IntEnum
from io import TextIOWrapper

from boatsim.errors import BoatsimError, printable
from boatsim.quiet import CODE

LONGEST = 300  # characters of a line of ours, its head and its end kept


class Exit(IntEnum):
    """Exit codes; of several runs the highest counts."""

    MET = 0  # done, all bars met
    MISSED = 1  # a bar missed
    BAD_INPUT = 2
    INTERRUPTED = CODE


FAULTS = (
    BoatsimError,
    OSError,
)  # what a user can put right; anything else is a defect and keeps its traceback


def words(error: BaseException) -> str:
    """What one of FAULTS says, in one line."""
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename}: {error.strerror}" if error.filename else error.strerror
    return " ".join(str(error).split())


def complain(message: str) -> None:
    """One line to stderr."""
    print(printable(f"boatsim: {message}", LONGEST), file=sys.stderr)


def remark(message: str) -> None:
    """One line to stderr about what was read and not used."""
    print(printable(f"note: {message}", LONGEST), file=sys.stderr)


def say(lines: Iterable[str]) -> None:
    """Lines of a result to stdout."""
    print("\n".join(printable(part) for line in lines for part in line.split("\n")))


def any_terminal() -> None:
    """Let stdout and stderr take any character, written as an escape where their encoding lacks it."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
