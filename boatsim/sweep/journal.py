"""The runs that are done, a line each, appended as they end: what a killed campaign goes on from.

The first line is what the campaign is. A last line that is not whole, of a process that was killed while it wrote, does
not count and is written over.
"""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Self

from boatsim.errors import BadInput
from boatsim.files import Growing

NAME = "journal.jsonl"
Entry = Mapping[str, Any]  # what became of a run, as JSON has it


class Journal:
    """Of one folder; `done` is what became of each run so far, by its number."""

    def __init__(self, folder: Path, about: Mapping[str, Any]) -> None:
        """Raises BadInput where the folder has the journal of something else."""
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / NAME
        self.done: dict[int, Entry] = {}
        whole = _lines(path)
        if whole:
            _check(folder, whole[0], about)
            for line in whole[1:]:
                entry = json.loads(line)
                self.done[entry["run"]] = entry
        file = path.open("r+b" if whole else "wb", buffering=0)
        kept = sum(len(line) for line in whole)
        file.truncate(kept)
        self._growing = Growing(file, path, kept)
        if not whole:
            self._growing.add(_line(about))

    def add(self, number: int, entry: Entry) -> None:
        """A run that is over; on the disk when this returns, whatever becomes of this process. Raises OSError."""
        self.done[number] = {"run": number, **entry}
        self._growing.add(_line(self.done[number]))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._growing.close()


def _line(content: Mapping[str, Any]) -> bytes:
    return (json.dumps(content, ensure_ascii=False, allow_nan=False) + "\n").encode()


def _lines(path: Path) -> list[bytes]:
    """The whole lines of a journal, none where there is none."""
    if not path.is_file():
        return []
    text = path.read_bytes()
    return text[: text.rfind(b"\n") + 1].splitlines(keepends=True)


def _check(folder: Path, first: bytes, about: Mapping[str, Any]) -> None:
    """Raises BadInput for the first thing in which two campaigns differ."""
    try:
        there = json.loads(first)
    except ValueError:
        raise BadInput(f"{folder / NAME}: is not a journal of boatsim; choose another --out") from None
    was, now = _flat(there), _flat(json.loads(_line(about)))
    for key in dict.fromkeys((*now, *was)):
        if was.get(key) != now.get(key):
            told = f"its {key} is {was.get(key, 'not there')}, not {now.get(key, 'there')}"
            raise BadInput(f"{folder} holds another campaign: {told}; choose another --out")


def _flat(about: Mapping[str, Any]) -> dict[str, str]:
    """`vary load` and such, each with its value in words."""
    inner = {k: v for k, v in about.items() if isinstance(v, dict)}
    flat = {k: json.dumps(v, ensure_ascii=False) for k, v in about.items() if k not in inner}
    return flat | {f"{k} {name}": json.dumps(v, ensure_ascii=False) for k, t in inner.items() for name, v in t.items()}
