"""The index page of a folder: its runs, diagnoses and sweeps with links to their pages."""

import os
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple
from urllib.parse import quote

from boatsim.errors import BadInput
from boatsim.files import replace_file
from boatsim.view.html_page import TEMPLATES, render_template
from boatsim.view.index_entries import KINDS, IndexEntry, find_entries

NAME = "index.html"
TEMPLATE = TEMPLATES / "index.html.j2"
MARK = '<meta name="generator" content="boatsim open">'  # distinguishes our pages from others
HEAD = 2000  # characters at the beginning of a page that contain the mark


class Row(NamedTuple):
    """An entry as the page shows it, with a link relative to the page."""

    entry: IndexEntry
    link: str
    folder: str


def write_index(folders: Sequence[Path], path: Path) -> list[IndexEntry]:
    """Write the index page of some folders.

    Args:
        folders: The folders.
        path: The page.

    Returns:
        The entries of the page, the newest first.

    Raises:
        BadInput: There is another file of this name, which is not replaced.
        OSError: The file cannot be written.
    """
    entries: dict[Path, IndexEntry] = {}
    for folder in folders:
        for entry in find_entries(folder):
            entries.setdefault(entry.folder.resolve(), entry)
    found = sorted(entries.values(), key=lambda entry: -entry.written)
    if path.exists() and not _is_ours(path):
        raise BadInput(f"{path}: is no index page of boatsim and is kept; use --out FILE")
    page = index_html(found, ", ".join(folder.resolve().name for folder in folders), path.parent)
    with replace_file(path) as temporary:
        temporary.write_text(page, encoding="utf-8", errors="replace")
    return found


def _is_ours(path: Path) -> bool:
    """Return whether a file is an index page that this module has written."""
    if not path.is_file():
        return False
    with path.open(encoding="utf-8", errors="replace") as file:
        return MARK in file.read(HEAD)


def index_html(entries: Sequence[IndexEntry], title: str, base: Path) -> str:
    """Return the index page of some runs, diagnoses and sweeps.

    Args:
        entries: The entries in the order of the page.
        title: Names of the folders.
        base: Folder of the page, to which its links are relative.
    """
    counts = Counter(entry.kind for entry in entries)
    summary = []
    for kind in KINDS:
        if counts[kind]:
            summary.append(f"{counts[kind]} {_plural(kind, counts[kind])}")
    rows = [Row(entry, _link(entry, base), _relative(entry.folder, base)) for entry in entries]
    return render_template(TEMPLATE, title=title, summary=", ".join(summary), rows=rows)


def _plural(kind: str, number: int) -> str:
    plurals = {"diagnosis": "diagnoses", "diagnoses": "sets of diagnoses"}
    if number == 1:
        return {"diagnoses": "set of diagnoses"}.get(kind, kind)
    return plurals.get(kind, f"{kind}s")


def _link(entry: IndexEntry, base: Path) -> str:
    """Return the link to the page of an entry, or to its folder."""
    if entry.page is not None:
        return quote(_relative(entry.page, base))
    return quote(f"{_relative(entry.folder, base)}/")


def _relative(path: Path, base: Path) -> str:
    return Path(os.path.relpath(path.resolve(), base.resolve())).as_posix()
