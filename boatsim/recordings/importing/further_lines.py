"""Lines of a proposed map for measured states of the drives and the pilot's sticks."""

import re
from collections.abc import Mapping, Sequence
from itertools import filterfalse

from boatsim.files import toml_key, toml_value
from boatsim.recordings.importing.signal_classification import Classification
from boatsim.recordings.importing.signal_text import expression_of, is_constant, unique_names


def further_lines(best: Mapping[str, list[Classification]]) -> list[str]:
    """Return lines for measured states of the drives and the pilot's sticks.

    No effect needs them; each kind has a heading.

    Args:
        best: Column -> classified signals, the most probable first.
    """
    lines: list[str] = []
    for kind, about in (
        ("actual", "measured state of the drives"),
        ("stick", "the pilot's sticks, recorded with the commands"),
    ):
        moving = list(filterfalse(is_constant, best.get(kind, [])))
        if moving:
            further = _lines_of_kind(kind, sorted(moving, key=lambda g: g.name))
            lines += ["", f"# {about}", *further]
    return lines


def _lines_of_kind(kind: str, found: Sequence[Classification]) -> list[str]:
    """Lines of further columns, named by kind and signal."""
    names = []
    for g in found:
        plain = re.sub(r"[^a-z0-9]+", "_", g.name.lower()).strip("_")
        names.append(f"{kind}_{plain}")
    lines = []
    for name, g in zip(unique_names(names), found, strict=True):
        expression = expression_of(g)
        if g.word == "us":
            expression = g.name
        lines.append(f"{toml_key(name)} = {toml_value(expression)}")
    return lines
