"""Exit codes of the program, and functions that print errors, notes and results."""

import sys
import warnings
from collections.abc import Iterable
from enum import IntEnum
from io import TextIOWrapper
from typing import TextIO

from boatsim.errors import BoatsimError, BoatsimWarning, escape_for_terminal
from boatsim.quiet import CODE

LONGEST = 300  # characters of a printed error; the middle of a longer one is cut
LONGEST_NOTE = 600  # the same for a note, such as a finding about a log with its reason


class Exit(IntEnum):
    """Exit codes of a command of boatsim; several runs exit with the highest of theirs."""

    MET = 0  # finished, all regression bands met
    MISSED = 1  # a metric lies outside its band, or a check found something
    BAD_INPUT = 2
    INTERRUPTED = CODE


# Errors that a user can correct. Any other exception is a defect and keeps its traceback.
FAULTS = (BoatsimError, OSError)


def one_line(error: BaseException) -> str:
    """Return the message of an exception in one line.

    Args:
        error: An instance of one of FAULTS.
    """
    if not isinstance(error, OSError) or not error.strerror:
        return " ".join(str(error).split())
    if error.filename:
        return f"{error.filename}: {error.strerror}"
    return error.strerror


def print_error(message: str) -> None:
    """Print the message of an error to the user in one line to stderr.

    Args:
        message: What is wrong.
    """
    print(escape_for_terminal(f"boatsim: {message}", LONGEST), file=sys.stderr)


def print_note(message: str) -> None:
    """Print a note to the user in one line to stderr, such as input that was ignored.

    Args:
        message: The note.
    """
    print(escape_for_terminal(f"note: {message}", LONGEST_NOTE), file=sys.stderr)


def print_notes(messages: Iterable[str]) -> None:
    """Print notes to the user on stderr, one line each.

    Args:
        messages: The notes.
    """
    for message in messages:
        print_note(message)


def print_warnings_as_notes() -> None:
    """Print warnings of boatsim as notes of one line from now on; others as Python does."""
    in_python = warnings.showwarning

    def show(
        message: Warning | str,
        category: type[Warning],
        filename: str,
        lineno: int,
        file: TextIO | None = None,
        line: str | None = None,
    ) -> None:
        if issubclass(category, BoatsimWarning):
            print_note(str(message))
        else:
            in_python(message, category, filename, lineno, file, line)

    warnings.showwarning = show


def print_lines(lines: Iterable[str]) -> None:
    """Print lines of a command's result to stdout.

    Args:
        lines: Lines, in which control characters are escaped.
    """
    text = "\n".join(lines)
    print("\n".join(map(escape_for_terminal, text.split("\n"))))


def escape_unencodable() -> None:
    """Make stdout and stderr print characters that their encoding lacks as escape sequences."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
