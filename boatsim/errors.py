"""Exceptions and warnings of boatsim, each with a message of one line.

Every mistake of a user ends in such a message and exit code 2.
"""

from collections.abc import Iterable
from difflib import get_close_matches

GAP = " ... "  # replaces the middle of a line that is too long
MAX_LISTED = 12  # with more names than this a message lists the nearest ones only
NEAREST_LISTED = 5  # number of nearest names that are listed then
# Words of users for things that have another name here
SYNONYMS = {
    "heading": ("psi_rad",),
    "yaw": ("psi_rad", "r_radps"),
    "yaw_rate": ("r_radps", "yaw_radps"),
    "course": ("psi_rad",),
    "roll": ("phi_rad",),
    "pitch": ("theta_rad",),
    "speed": ("surge_mps", "u_mps"),
    "surge": ("surge_mps", "u_mps"),
    "north": ("x_m",),
    "east": ("y_m",),
    "simulate": ("run",),
    "simulation": ("run",),
    "start": ("run",),
    "identify": ("diagnose",),
    "fit": ("diagnose",),
    "analyse": ("diagnose",),
    "convert": ("import",),
    "validate": ("check",),
    "create": ("new",),
    "vessels": ("list",),
    "help": ("show",),
}


class BoatsimError(Exception):
    """Base class of all exceptions that boatsim raises.

    The command line prints the message as one line.
    """


class BadInput(BoatsimError):
    """Raised for input of a user that cannot be used: a file, key, value or name.

    The message states what is allowed.
    """


class BadPhysics(BoatsimError):
    """Raised for a model that cannot be simulated: its mass matrix or its state is not valid."""


class BoatsimWarning(UserWarning):
    """Base class of the warnings of boatsim, about what works but not as well as it could.

    The command line prints the message as one line.
    """


def unknown_name_message(what: str, found: str, allowed: Iterable[str]) -> str:
    """Return the error message for a name that does not exist, with the nearest valid name.

    Args:
        what: Kind of name, such as "vessel".
        found: The name.
        allowed: All valid names; of many the message lists the nearest few. "vessel/case" is
            matched by "case" too.
    """
    names = sorted(allowed)
    nearest = _nearest(found, names)
    hint = ""
    if nearest:
        hint = f"; did you mean {nearest!r}?"
    if len(names) <= MAX_LISTED:
        return f"{what} {found!r} does not exist{hint} (there are: {', '.join(names) or 'none'})"
    similar = [name for name in names if found and found in name][:NEAREST_LISTED]
    if not similar:
        similar = get_close_matches(found, names, n=NEAREST_LISTED, cutoff=0.4)
    if nearest in similar:
        similar.remove(nearest)
    examples = ""
    if similar:
        examples = f", such as {', '.join(similar)}"
    return f"{what} {found!r} does not exist{hint} (there are {len(names)}{examples})"


def _nearest(found: str, names: list[str]) -> str | None:
    """The name for a user's word, the most similar name, or the one with the most similar end."""
    for name in SYNONYMS.get(found.lower(), ()):
        if name in names:
            return name
    if near := get_close_matches(found, names, n=1, cutoff=0.5):
        return near[0]
    last_parts = {name.rpartition("/")[2]: name for name in reversed(names)}
    if near := get_close_matches(found, last_parts, n=1, cutoff=0.5):
        return last_parts[near[0]]
    return None


def nearest_hint(found: str, allowed: Iterable[str]) -> str:
    """Return the end of an error message, "; did you mean NAME?", with the most similar valid name.

    The result is "" if no valid name is similar.
    """
    near = _nearest(found, sorted(allowed))
    return f"; did you mean {near!r}?" if near else ""


def escape_for_terminal(text: str, longest: int | None = None) -> str:
    """Return a text for a terminal, with control and direction characters written as escapes.

    Args:
        text: Text from files of others.
        longest: Longest result; the middle of a longer one is cut out, since the file's name is at
            the beginning and the reason at the end.
    """
    characters = []
    for c in text:
        if not c.isprintable():
            c = c.encode("unicode_escape").decode("ascii")
        characters.append(c)
    plain = "".join(characters)
    if longest is None or len(plain) <= longest:
        return plain
    tail = longest // 2
    return f"{plain[: longest - tail - len(GAP)]}{GAP}{plain[-tail:]}"
