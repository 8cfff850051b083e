"""Corrections that the checks of a log offer, accepted without other knowledge of the log.

`accept_corrections` writes the offered lines into the recording.toml next to the recordings.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path

from boatsim.diagnosis import loading
from boatsim.diagnosis.answer.log_entry import column_sources
from boatsim.diagnosis.checks.finding import recording_toml_lines
from boatsim.files import toml_key

COLUMNS, LATENCY = "[columns]", "[latency]"


def accept_corrections(files: Sequence[Path], vessel: str) -> list[str]:
    """Check recordings of one folder and write all corrections that the checks offer.

    These are the checks with which a diagnosis begins, without the comparison with the vessel.

    Args:
        files: Recordings in one folder, which has no recording.toml yet.
        vessel: Name or path of the vessel.

    Returns:
        One line for each kind of finding with a correction: its name and runs.
    """
    loaded = loading.load_recordings(loading.Request(files, vessel=vessel))
    by_run: dict[str, list[str]] = {}
    offered: dict[str, list[str]] = {}
    for finding in loaded.findings:
        lines = recording_toml_lines(finding, column_sources(finding.run, loaded.vessel))
        run = Path(finding.run).stem
        if lines:
            by_run.setdefault(run, []).extend(lines)
            offered.setdefault(finding.name, []).append(run)
    tables = list[str]()
    for run, lines in by_run.items():
        tables += tables_of_run(run, lines)
    folder = files[0].parent
    (folder / "recording.toml").write_text("\n".join(tables) + "\n", encoding="utf-8")
    return _summaries(offered)


def tables_of_run(run: str, lines: Sequence[str]) -> list[str]:
    """Return the tables of one run: its own keys first, then columns and latency, each key once.

    Args:
        run: Name of the run.
        lines: Lines that checks offer, with headers of tables for all runs or for this one.
    """
    tables: dict[str, dict[str, str]] = {"": {}, COLUMNS: {}, LATENCY: {}}
    table = ""
    for line in lines:
        if line.startswith("["):
            table = _table_of_run(run, line)
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


def _table_of_run(run: str, header: str) -> str:
    """Return "[columns]" for the header "[runs.NAME.columns]", and "" for "[runs.NAME]"."""
    own = f"[runs.{toml_key(run)}"
    if not header.startswith(own):
        return header
    inner = header.removeprefix(own).strip("].")
    return f"[{inner}]" if inner else ""


def _summaries(offered: Mapping[str, Sequence[str]]) -> list[str]:
    """The offered corrections by finding."""
    return [f"{name}: {len(runs)} runs ({', '.join(runs)})" for name, runs in offered.items()]
