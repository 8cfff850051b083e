"""The runs that are done, a line each, appended as they end: what a killed campaign goes on from.

The first line is what the campaign is. A last line that is not whole, of a process that was killed while it wrote, does
not count and is written over.
"""

import json
import os
from collections.abc import Mapping
from fcntl import LOCK_EX, LOCK_NB, flock
from pathlib import Path
from typing import IO, Any, Self

from boatsim.errors import BadInput
from boatsim.files import AppendedFile

NAME = "journal.jsonl"
Entry = Mapping[str, Any]  # what became of a run, as JSON has it


class Journal:
    """Of one folder; `done` is what became of each run so far, by its number."""

    def __init__(self, folder: Path, about: Mapping[str, Any]) -> None:
        """Raises BadInput where the folder has the journal of something else, or somebody is at work in it."""
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / NAME
        file = os.fdopen(os.open(path, os.O_RDWR | os.O_CREAT, 0o666), "r+b", buffering=0)
        self.done: dict[int, Entry] = {}
        try:
            _take(file, folder)
            first, entries, whole = _read(file)
            if whole:
                _check(folder, first, about)
        except BaseException:
            file.close()
            raise
        self.done = {entry["run"]: entry for entry in entries}
        file.truncate(whole)
        self._growing = AppendedFile(file, path, whole)
        if not whole:
            self._growing.add(_line(about))

    def add(self, number: int, entry: Entry) -> None:
        """A run that is over; on the disk when this returns, whatever becomes of this process. Raises OSError."""
        line = _line({"run": number, **entry})
        self._growing.add(line)
        self.done[number] = json.loads(line)  # as whoever goes on finds it

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._growing.close()


def _line(content: Mapping[str, Any]) -> bytes:
    return (json.dumps(content, ensure_ascii=False, allow_nan=False) + "\n").encode()


def _take(file: IO[bytes], folder: Path) -> None:
    """Nobody else writes to it while this process lives. Raises BadInput where somebody does."""
    try:
        flock(file, LOCK_EX | LOCK_NB)
    except BlockingIOError:
        raise BadInput(
            f"{folder}: another command is at work in this folder; choose another --out"
        ) from None


def _read(file: IO[bytes]) -> tuple[bytes, list[Entry], int]:
    """First line, entries, and how many bytes are whole lines that say something."""
    first, entries, whole = b"", list[Entry](), 0
    for line in file.read().splitlines(keepends=True):
        if not line.endswith(b"\n"):
            break
        try:
            entries += [json.loads(line)] if whole else []
        except ValueError:  # of a machine that lost its power
            break
        first, whole = first or line, whole + len(line)
    return first, entries, whole


def _check(folder: Path, first: bytes, about: Mapping[str, Any]) -> None:
    """Raises BadInput for the first thing in which two campaigns differ."""
    try:
        there = json.loads(first)
    except ValueError:
        raise BadInput(
            f"{folder / NAME}: is not a journal of boatsim; choose another --out"
        ) from None
    was, now = _flat(there), _flat(json.loads(_line(about)))
    for key in dict.fromkeys((*now, *was)):
        if was.get(key) != now.get(key):
            told = f"its {key} is {was.get(key, 'not there')}, not {now.get(key, 'there')}"
            raise BadInput(f"{folder} holds another campaign: {told}; choose another --out")


def _flat(about: Mapping[str, Any]) -> dict[str, str]:
    """`vary load` and such, each with its value in words."""
    inner = {k: v for k, v in about.items() if isinstance(v, dict)}
    flat = {k: json.dumps(v, ensure_ascii=False) for k, v in about.items() if k not in inner}
    return flat | {
        f"{k} {name}": json.dumps(v, ensure_ascii=False)
        for k, t in inner.items()
        for name, v in t.items()
    }
