"""Runs, diagnoses and sweeps below a folder, each with its result in one line."""

import json
import os
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from boatsim.atomic_folder import PART
from boatsim.view.content_names import plain_name
from boatsim.view.formatting import capitalize, first_sentence, join_words, name_in_words
from boatsim.view.run_sentence import run_sentence, run_verdict

METRICS, DIAGNOSIS, JOURNAL, LOG = "norms.json", "diagnosis.json", "journal.jsonl", "recording.csv"
PAGE = "report.html"
LARGEST_FILE = 20_000_000  # [bytes] of a file that is read for its result; larger ones are not ours
LONGEST_LINE = 240  # characters of a result
MOST_FOLDERS = 20_000  # that are searched: a home folder given by mistake must not take minutes
KINDS = ("run", "driven run", "diagnosis", "sweep", "diagnoses")
NOT_OURS = (OSError, ValueError, KeyError, TypeError, AttributeError, IndexError, RecursionError)


@dataclass(frozen=True)
class IndexEntry:
    """A run, diagnosis or sweep in a folder.

    Attributes:
        kind: One of `KINDS`.
        name: Name of the scenario, or of the folder.
        folder: The folder.
        page: Its page; None if it has none.
        written: Time at which its result was written [s since 1970].
        result: The result in one line.
        mark: "met", "missed", "unfinished" or "", for the style of the page.
    """

    kind: str
    name: str
    folder: Path
    page: Path | None
    written: float
    result: str
    mark: str = ""

    @property
    def date(self) -> str:
        """Local date and time at which the result was written."""
        return time.strftime("%Y-%m-%d %H:%M", time.localtime(self.written))


def find_entries(folder: Path) -> list[IndexEntry]:
    """Return the runs, diagnoses and sweeps in a folder and below it, the newest first.

    Links are not followed, hidden folders are not searched, and files that cannot be read are
    entries that say so.

    Args:
        folder: The folder.
    """
    found = []
    for number, place in enumerate(_folders_below(folder)):
        if number >= MOST_FOLDERS:
            break
        if entry := _entry_of(place):
            found.append(entry)
    return sorted(found, key=lambda entry: (-entry.written, str(entry.folder)))


def _folders_below(folder: Path) -> Iterator[Path]:
    """Yield a folder and all folders below it."""
    for place, names, _ in os.walk(folder, followlinks=False):
        names[:] = sorted(name for name in names if not name.startswith("."))
        yield Path(place)


def _entry_of(folder: Path) -> IndexEntry | None:
    """Return what a folder holds; None if it holds nothing of boatsim."""
    readers = {DIAGNOSIS: _diagnosis_entry, JOURNAL: _campaign_entry, METRICS: _run_entry}
    for name, read in readers.items():
        file = folder / name
        if _is_plain_file(file):
            try:
                return read(folder, file)
            except NOT_OURS:
                # another program's file of this name, or one cut short: it must not stop the index
                return _entry(folder, file, KINDS[0], f"{name} cannot be read", "unfinished")
    if PART in folder.name and _is_plain_file(folder / LOG):
        reason = "Killed while it ran; recording.csv holds the log until then."
        return _entry(folder, folder / LOG, "run", reason, "unfinished")
    return None


def _is_plain_file(path: Path) -> bool:
    try:
        return path.is_file() and not path.is_symlink()
    except OSError:
        return False


def _entry(
    folder: Path, file: Path, kind: str, result: str, mark: str = "", name: str = ""
) -> IndexEntry:
    """Return an entry; its name is that of the folder unless another one is given."""
    page = folder / PAGE
    return IndexEntry(
        kind,
        name or folder.resolve().name,
        folder,
        page if _is_plain_file(page) else None,
        file.stat().st_mtime,
        _shortened(result),
        mark,
    )


def _shortened(text: str) -> str:
    text = " ".join(text.split())
    if len(text) <= LONGEST_LINE:
        return text
    return f"{text[: LONGEST_LINE - 1]}…"


def _read_text(file: Path) -> str:
    """Return the text of a file. Raises ValueError for one that is too large."""
    if file.stat().st_size > LARGEST_FILE:
        raise ValueError("too large")
    return file.read_text(encoding="utf-8")


def _run_entry(folder: Path, file: Path) -> IndexEntry:
    """Return the entry of a run."""
    result = json.loads(_read_text(file))
    marks = {"All bands met": "met", "Outside a band": "missed", "Interrupted": "unfinished"}
    mark = marks.get(run_verdict(result), "")
    sentence = run_sentence(result)
    name = plain_name(str(result["scenario"]))
    if PART in folder.name:
        sentence, mark = f"Killed while it ran, preliminary metrics. {sentence}", "unfinished"
    kind = "run"
    if (folder / "scenario.toml").is_file() and name.endswith("/drive"):
        kind, name = "driven run", name.removesuffix("/drive")
    return _entry(folder, file, kind, sentence, mark, name)


def _diagnosis_entry(folder: Path, file: Path) -> IndexEntry:
    """Return the entry of a diagnosis."""
    return _entry(folder, file, "diagnosis", _diagnosis_result(json.loads(_read_text(file))))


def _diagnosis_result(answer: Mapping[str, Any]) -> str:
    """Return the result of a diagnosis in one line, from diagnosis.json."""
    physics = [e["name"] for e in answer["effects"] if e["kind"] == "physics"]
    errors = [e["name"] for e in answer["effects"] if e["kind"] != "physics"]
    parts = []
    for names, what in ((physics, "effect missing"), (errors, "measurement error")):
        if names:
            ending = "s" if len(names) > 1 else ""
            counted = what.replace("effect", f"effect{ending}").replace("error", f"error{ending}")
            parts.append(f"{len(names)} {counted}: {join_words(map(name_in_words, names))}")
    if parts:
        return capitalize(f"{'; '.join(parts)}.")
    return first_sentence(str(answer["sentence"]))


def _campaign_entry(folder: Path, file: Path) -> IndexEntry:
    """Return the entry of a sweep, or of separate diagnoses of many recordings."""
    first, *lines = _read_text(file).splitlines()
    about = json.loads(first)
    done = [json.loads(line) for line in lines if line.endswith("}")]
    failed = sum(entry.get("failure") is not None for entry in done)
    ending = f", {failed} failed" if failed else ""
    if "scenarios" not in about:
        return _entry(folder, file, "diagnoses", f"{len(done)} separate diagnoses{ending}.")
    parts = [f"{len(done)} runs{ending}"]
    for key, words in (("vary", "varied"), ("draw", "sampled")):
        if about[key]:
            keys = [name_in_words(name).replace(".", " ") for name in about[key]]
            parts.append(f"{words}: {', '.join(keys)}")
    names = [plain_name(name) for name in about["scenarios"]]
    name = names[0] if len(names) == 1 else f"{names[0]} and {len(names) - 1} more"
    return _entry(folder, file, "sweep", f"{'; '.join(parts)}.", name=name)
