"""How the program ends: one exit code, and one line for what went wrong."""

import sys
from enum import IntEnum

from boatsim.errors import BoatsimError


class Exit(IntEnum):
    """Exit codes; of several runs the highest counts."""

    MET = 0  # done, all bars met
    MISSED = 1  # a bar missed
    BAD_INPUT = 2
    INTERRUPTED = 130  # 128 + SIGINT, as shells have it


FAULTS = (BoatsimError, OSError)  # what a user can put right; anything else is a defect and keeps its traceback


def words(error: BaseException) -> str:
    """What one of FAULTS says, in one line."""
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename}: {error.strerror}" if error.filename else error.strerror
    return " ".join(str(error).split())


def complain(message: str) -> None:
    """One line to stderr."""
    print(f"boatsim: {message}", file=sys.stderr)
