"""A finding on a log as diagnosis.json and the commands say it, with the lines to write into a recording.toml."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from boatsim.diagnosis.checks.finding import PROBABLY, Finding, lines, to_write
from boatsim.diagnosis.report.schema import LogEntry
from boatsim.physics.vessel import Vessel
from boatsim.recordings.expression import Expression
from boatsim.recordings.table import as_written


def sources_of(finding: Finding, path: str, vessel: Vessel) -> Mapping[str, Expression]:
    """What the columns of a finding's file are made of so far; nothing where it is no file that says so."""
    return as_written(Path(path), vessel.columns)[1] if Path(path).is_file() else {}


def entry(finding: Finding, sources: Mapping[str, Expression]) -> LogEntry:
    """As diagnosis.json has it."""
    found: LogEntry = {
        "run": finding.run,
        "name": finding.name,
        "kind": finding.kind,
        "evidence": finding.evidence,
        "sure": round(finding.sure, 3),
        "spans_s": [list(span) for span in finding.spans],
        "lines": to_write(finding, sources),
        "alternatives": [
            {"words": words, "lines": lines(changes, sources)}
            for words, changes in finding.alternatives
        ],
    }
    if finding.remedy:
        found["remedy"] = finding.remedy
    if finding.kind == "fault":
        found["words"] = PROBABLY
    return found


def in_words(found: LogEntry) -> list[str]:
    """Lines that a command prints of a finding."""
    name = found["name"].replace("_", " ")
    out = [f"{name} (sure to {100.0 * min(found['sure'], 0.999):.3g} %): {found['evidence']}"]
    if found["spans_s"]:
        out.append("  at " + ", ".join(f"{a:g} to {b:g} s" for a, b in found["spans_s"]))
    if found["lines"]:
        out.append(f"  write into recording.toml: {joined(found['lines'])}")
    for other in found["alternatives"]:
        out.append(f"  or, if {other['words']}: {joined(['[columns]', *other['lines']])}")
    if "remedy" in found:
        out.append(f"  {found['remedy']}")
    return out


def joined(text: Sequence[str]) -> str:
    """Lines of TOML on one line."""
    return " / ".join(text)
