"""Corrections that the checks of a log offer, accepted as an owner would who has no other knowledge.

`accept_corrections` writes the offered lines into the recording.toml next to the recordings.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path

from boatsim.diagnosis.log_check import check_files
from boatsim.files import toml_key

COLUMNS, LATENCY = "[columns]", "[latency]"


def accept_corrections(files: Sequence[Path], vessel: str) -> list[str]:
    """Check recordings of one folder and write all corrections that the checks offer.

    Args:
        files: Recordings in one folder, which has no recording.toml yet.
        vessel: Name or path of the vessel.

    Returns:
        One line for each kind of finding with a correction: its name, runs and lines.
    """
    entries, _ = check_files(files, vessel)
    tables = list[str]()
    offered: dict[str, list[str]] = {}
    for file, found in entries.items():
        lines = list[str]()
        for entry in found:
            if entry["lines"]:
                lines += entry["lines"]
                offered.setdefault(entry["name"], []).append(file.stem)
        tables += _run_tables(file.stem, lines)
    folder = files[0].parent
    (folder / "recording.toml").write_text("\n".join(tables) + "\n", encoding="utf-8")
    return _summaries(offered)


def _run_tables(run: str, lines: Sequence[str]) -> list[str]:
    """Tables of one run: its own keys first, then columns and latency, each key once."""
    tables: dict[str, dict[str, str]] = {"": {}, COLUMNS: {}, LATENCY: {}}
    table = ""
    for line in lines:
        if line.startswith("["):
            table = line
        else:
            key, _, value = line.partition(" = ")
            tables[table].setdefault(key, value)
        if line.startswith(("use", "clock")):
            table = ""
    written = list[str]()
    for name, keys in tables.items():
        if keys:
            inner = f".{name[1:-1]}" if name else ""
            written.append(f"[runs.{toml_key(run)}{inner}]")
            written += [f"{key} = {value}" for key, value in keys.items()]
    return written


def _summaries(offered: Mapping[str, Sequence[str]]) -> list[str]:
    """The offered corrections by finding."""
    return [f"{name}: {len(runs)} runs ({', '.join(runs)})" for name, runs in offered.items()]
