"""Implementation of `boatsim open`: the page of a result, or an index page of many."""

import os
import webbrowser
from collections.abc import Sequence
from pathlib import Path

from boatsim.cli.exits import Exit, print_lines
from boatsim.errors import BadInput
from boatsim.view import index_page
from boatsim.view.index_entries import PAGE
from boatsim.view.viewer import has_display


def open_results(folders: Sequence[Path], out: Path | None, browser: bool | None) -> int:
    """Open the page of a run, diagnosis or sweep, or write and open an index page of folders.

    Args:
        folders: Folder of a result, or folders that contain results.
        out: The index page; None for index.html in the folder that contains all of them.
        browser: Whether to open the page in a browser; None to open it if there is a display.

    Returns:
        Exit code.

    Raises:
        BadInput: A folder does not exist, or another file would be replaced.
        OSError: The index page cannot be written.
    """
    for folder in folders:
        if folder.is_file():
            raise BadInput(f"{folder}: is a file; allowed is a folder with results")
        if not folder.is_dir():
            raise BadInput(f"{folder}: no such folder; boatsim run and diagnose write to out/")
    page = folders[0] / PAGE
    if len(folders) > 1 or out is not None or not page.is_file():
        page = out or _common_folder(folders) / index_page.NAME
        entries = index_page.write_index(folders, page)
        ending = "" if len(entries) == 1 else "s"
        print_lines([f"{len(entries)} result{ending} in {', '.join(map(str, folders))}"])
    print_lines([str(page)])
    if browser or (browser is None and has_display()):
        webbrowser.open(page.resolve().as_uri())
    return Exit.MET


def _common_folder(folders: Sequence[Path]) -> Path:
    """Return the folder itself, or the folder that contains all of several."""
    if len(folders) == 1:
        return folders[0]
    return Path(os.path.commonpath([folder.resolve() for folder in folders]))
