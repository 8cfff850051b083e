"""Journal of a campaign: one line for each finished task, from which a campaign continues.

The first line holds the definition of the campaign. An incomplete last line, from a process that
was killed while it wrote, is ignored and overwritten.
"""

import json
import os
from collections.abc import Mapping, Sequence
from fcntl import LOCK_EX, LOCK_NB, flock
from pathlib import Path
from typing import IO, Any, Self

from boatsim.errors import BadInput
from boatsim.files import AppendedFile, validate_table
from boatsim.sweeps.entries import AnyEntry

NAME = "journal.jsonl"
Entry = Mapping[str, Any]  # result of a task, as JSON holds it


class Journal:
    """File of a campaign to which the result of each finished task is appended.

    An interrupted campaign continues from it.

    Attributes:
        done: Result of each finished task, by its number.
    """

    def __init__(
        self,
        folder: Path,
        about: Mapping[str, Any],
        form: type[AnyEntry] = AnyEntry,
        count: int | None = None,
    ) -> None:
        """Open or create the journal of a folder.

        Args:
            folder: Folder of the campaign.
            about: Definition of the campaign.
            form: Form of the results.
            count: Number of tasks; None if it is unknown.

        Raises:
            BadInput: The folder belongs to another campaign, another process uses it, or a result
                is damaged.
        """
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / NAME
        if path.exists() and not path.is_file():
            raise BadInput(f"{path} is no regular file; choose another --out")
        file = os.fdopen(os.open(path, os.O_RDWR | os.O_CREAT, 0o666), "r+b", buffering=0)
        self.done: dict[int, Entry] = {}
        try:
            _lock_journal(file, folder)
            first, entries, size = _read_journal(file)
            if size:
                _check_same(folder, first, about)
            self.done = _checked_entries(path, entries, form, count)
        except BaseException:
            file.close()
            raise
        file.truncate(size)
        self._growing = AppendedFile(file, path, size)
        if not size:
            self._growing.append(_encode_line(about))

    def append_result(self, number: int, entry: Entry) -> None:
        """Append the result of a task to the journal; it is on the disk when this returns.

        Args:
            number: Number of the task.
            entry: Its result.

        Raises:
            OSError: The file cannot be written.
        """
        line = _encode_line({"run": number, **entry})
        self._growing.append(line)
        self.done[number] = json.loads(line)  # the same values as after a restart

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._growing.close()


def _encode_line(content: Mapping[str, Any]) -> bytes:
    return (json.dumps(content, ensure_ascii=False, allow_nan=False) + "\n").encode()


def _lock_journal(file: IO[bytes], folder: Path) -> None:
    """Lock the journal for this process; raises BadInput if another process uses it."""
    try:
        flock(file, LOCK_EX | LOCK_NB)
    except BlockingIOError:
        raise BadInput(
            f"{folder}: another command uses this folder; choose another --out"
        ) from None


def _read_journal(file: IO[bytes]) -> tuple[bytes, list[Entry], int]:
    """First line, results of tasks, and the number of bytes in complete lines."""
    first, entries, size = b"", list[Entry](), 0
    for line in file.read().splitlines(keepends=True):
        if not line.endswith(b"\n"):
            break
        if size:
            try:
                entries.append(json.loads(line))
            except (ValueError, RecursionError):  # written while the machine lost its power
                break
        else:
            first = line
        size += len(line)
    return first, entries, size


def _checked_entries(
    path: Path, entries: Sequence[Entry], form: type[AnyEntry], count: int | None
) -> dict[int, Entry]:
    """Results by the number of their task; raises BadInput for the first with a mistake."""
    checked: dict[int, Entry] = {}
    for number, entry in enumerate(entries, 2):  # the first line is the definition
        try:
            found = validate_table(form, entry, f"{path}, line {number}")
            if count is not None and found.run >= count:
                raise BadInput(f"{path}, line {number}: run = {found.run}; there are {count}")
        except BadInput as error:
            raise BadInput(f"{error}; delete the line to compute it again") from None
        checked[found.run] = found.model_dump(mode="json", exclude_unset=True)
    return checked


def _check_same(folder: Path, first: bytes, about: Mapping[str, Any]) -> None:
    """Raise BadInput for the first difference between two campaigns."""
    try:
        stored = json.loads(first)
    except (ValueError, RecursionError):
        stored = None
    if not isinstance(stored, dict):
        raise BadInput(f"{folder / NAME} is not a journal of boatsim; choose another --out")
    old = _flatten(stored)
    new = _flatten(json.loads(_encode_line(about)))
    for key in new | old:
        if old.get(key) != new.get(key):
            difference = f"its {key} is {old.get(key, 'missing')}, not {new.get(key, 'missing')}"
            raise BadInput(f"{folder} holds another campaign: {difference}; choose another --out")


def _flatten(about: Mapping[str, Any]) -> dict[str, str]:
    """Definition of a campaign with keys such as `vary load`; keys without a table come first."""
    flat: dict[str, str] = {}
    inner: dict[str, str] = {}
    for key, value in about.items():
        if isinstance(value, dict):
            for name, one in value.items():
                inner[f"{key} {name}"] = json.dumps(one, ensure_ascii=False)
        else:
            flat[key] = json.dumps(value, ensure_ascii=False)
    return flat | inner
