"""Groups of recordings in words, and the keys with which entries of an answer state them."""

from collections.abc import Sequence

from boatsim.diagnosis.answer.schema import InGroup
from boatsim.diagnosis.problem import Problem
from boatsim.physics.groups import group_of
from boatsim.view.formatting import join_words


def group_entry(problem: Problem, name: str) -> InGroup:
    """Return the keys of an entry on the group of an effect; none if it acts in all recordings.

    Args:
        problem: The estimation problem.
        name: Name of the effect among the candidates.
    """
    group = group_of(name)
    if not group:
        return {}
    entry: InGroup = {"group": group}
    if others := problem.same_recordings.get(group):
        entry["same_recordings"] = list(others)
    return entry


def group_in_words(entry: InGroup) -> str:
    """Return "in group yellow" for an entry on an effect; "" if it acts in all recordings.

    Groups of the same recordings follow: "in group crew_a (the same recordings as hull_new)".

    Args:
        entry: Entry on an effect, or its keys on the group.
    """
    if "group" not in entry:
        return ""
    words = f"in group {entry['group']}"
    if others := entry.get("same_recordings"):
        words = f"{words} (the same recordings as {join_words(others)})"
    return words


def groups_in_words(groups: Sequence[str]) -> str:
    """Return "group monday", or "groups monday and tuesday"."""
    return f"group{'s' if len(groups) > 1 else ''} {join_words(groups)}"
