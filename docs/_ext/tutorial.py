"""Sphinx extension that runs the tutorials while the site is built and warns about differences."""

import tempfile
from pathlib import Path
from typing import Any

import page_commands
from sphinx.application import Sphinx
from sphinx.util import logging

log = logging.getLogger(__name__)


def run(app: Sphinx, name: str, source: list[str]) -> None:
    """Run the commands of a marked page in an empty home folder.

    Args:
        app: The running Sphinx application.
        name: Name of the page.
        source: List whose only element is the text of the page.
    """
    if page_commands.MARK not in source[0]:
        return
    with tempfile.TemporaryDirectory() as home:
        for line, message in page_commands.failures(source[0], Path(home)):
            log.warning(message, location=(name, line))


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the extension."""
    app.connect("source-read", run)
    return {"parallel_read_safe": True}
