"""A finding about a log in diagnosis.json and as text, with the lines for recording.toml."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from boatsim.diagnosis.answer.schema import LogEntry
from boatsim.diagnosis.checks.finding import (
    LOG_NOT_BOAT,
    Finding,
    alternative_lines,
    recording_toml_lines,
)
from boatsim.physics.vessel import Vessel
from boatsim.recordings.expression import Expression
from boatsim.recordings.table import read_unchecked

COLUMNS_TABLE = "[columns]"


def column_sources(path: str, vessel: Vessel) -> Mapping[str, Expression]:
    """Return, for each column of a recording, the expression that computes it from the raw file.

    Args:
        path: File of the recording.
        vessel: The vessel with its names of columns.

    Returns:
        Expression per column; empty if there is no such file.
    """
    if not Path(path).is_file():
        return {}
    return read_unchecked(Path(path), vessel.columns)[1]


def finding_entry(finding: Finding, sources: Mapping[str, Expression]) -> LogEntry:
    """Return a finding about a recording in the form in which diagnosis.json contains it.

    Args:
        finding: The finding.
        sources: Expressions of the columns of its file, see `column_sources`.

    Returns:
        The entry, with the lines to write into recording.toml.
    """
    entry: LogEntry = {
        "run": finding.run,
        "name": finding.name,
        "kind": finding.kind,
        "evidence": finding.evidence,
        "sure": round(finding.probability, 3),
        "spans_s": list(map(list, finding.spans)),
        "lines": recording_toml_lines(finding, sources),
        "alternatives": [
            {"words": words, "lines": _without_header(alternative_lines(finding, changes, sources))}
            for words, changes in finding.alternatives
        ],
    }
    if finding.remedy:
        entry["remedy"] = finding.remedy
    if finding.kind == "fault":
        entry["words"] = LOG_NOT_BOAT
    if finding.kind == "unchecked":
        entry["words"] = "not checked"
    return entry


def _without_header(lines: list[str]) -> list[str]:
    """Lines without the header of the table `[columns]`, to which they belong by default."""
    if lines[:1] == [COLUMNS_TABLE]:
        return lines[1:]
    return lines


def alternative_correction_lines(lines: Sequence[str]) -> list[str]:
    """Return the lines of an alternative correction with the header of their table.

    Args:
        lines: Lines of an alternative in the form of diagnosis.json.
    """
    if lines and lines[0].startswith("["):
        return list(lines)
    return [COLUMNS_TABLE, *lines]


def finding_lines(entry: LogEntry) -> list[str]:
    """Return the lines that a command prints for one finding about a recording.

    Args:
        entry: The finding in the form of diagnosis.json.
    """
    name = entry["name"].replace("_", " ")
    percent = 100.0 * min(entry["sure"], 0.999)
    lines = [f"{name} (probability {percent:.3g} %): {entry['evidence']}"]
    if entry["spans_s"]:
        spans = ", ".join(_interval(begin, end) for begin, end in entry["spans_s"])
        lines.append(f"  at {spans}")
    if entry["lines"]:
        lines.append(f"  write into recording.toml: {join_toml_lines(entry['lines'])}")
    for other in entry["alternatives"]:
        toml = join_toml_lines(alternative_correction_lines(other["lines"]))
        lines.append(f"  or, if {other['words']}: {toml}")
    if "remedy" in entry:
        lines.append(f"  {entry['remedy']}")
    return lines


def _interval(begin: float, end: float) -> str:
    """Return an interval, or its only time where both ends are printed alike."""
    if f"{begin:g}" == f"{end:g}":
        return f"{begin:g} s"
    return f"{begin:g} to {end:g} s"


def join_toml_lines(lines: Sequence[str]) -> str:
    """Return several lines of TOML joined to one line of text."""
    return " / ".join(lines)
