"""Text of the recording.toml of a converted log."""

from collections.abc import Sequence
from pathlib import Path

from boatsim.recordings.importing.mapping import Map


def position_fix_type(map: Map) -> str | None:
    """Return how positions were measured: "gnss" if the columns are latitudes, else None."""
    if map.position:
        return "gnss"
    return None


def recording_notes_text(
    path: Path, vessel: str, fix: str | None, use: Sequence[tuple[float, float]] = ()
) -> str:
    """Return the text of a recording.toml.

    Args:
        path: File of the recording.
        vessel: Name or path of the vessel.
        fix: The fact `position_fix_type`, None if unknown.
        use: Parts of the recording that are used [s]; () for all of it.
    """
    key = path.stem
    if not (key.replace("_", "").replace("-", "").isalnum() and key.isascii()):
        key = f'"{_quote(key)}"'
    lines = [f"[runs.{key}]", f'vessel = "{_quote(vessel)}"']
    if use:
        lines.append(use_entry_line(use))
    if fix:
        lines.append(f'facts.position_fix = "{fix}"')
    return "\n".join(lines) + "\n"


def use_entry_line(use: Sequence[tuple[float, float]]) -> str:
    """Return the line `use = [...]` of a recording.toml, which selects parts of a recording."""
    return f"use = {list(map(list, use))}"


def _quote(text: str) -> str:
    quoted = ""
    for c in text:
        if ord(c) >= 0x10000:
            continue
        if c.isprintable() and c not in '"\\':
            quoted += c
        else:
            quoted += f"\\u{ord(c):04x}"
    return quoted
