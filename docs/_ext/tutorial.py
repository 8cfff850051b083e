"""Sphinx extension: pages with the mark of `shown` are run when they are built; what is not as shown is a warning."""

import tempfile
from pathlib import Path
from typing import Any

import shown
from sphinx.application import Sphinx
from sphinx.util import logging

log = logging.getLogger(__name__)


def run(app: Sphinx, name: str, source: list[str]) -> None:
    """Run a page's commands in an empty home."""
    if shown.MARK not in source[0]:
        return
    with tempfile.TemporaryDirectory() as home:
        for line, said in shown.wrong(source[0], Path(home)):
            log.warning(said, location=(name, line))


def setup(app: Sphinx) -> dict[str, Any]:
    """Listen to pages as they are read."""
    app.connect("source-read", run)
    return {"parallel_read_safe": True}
