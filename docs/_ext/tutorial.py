"""Sphinx extension that runs the tutorials while the site is built, with `-D run_tutorials=1`.

It warns about each difference between an output and its page. A slow block is only printed,
because `sphinx -W` turns every warning into an error.
"""

import sys
import tempfile
import warnings
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
    if not app.config.run_tutorials or page_commands.MARK not in source[0]:
        return
    with tempfile.TemporaryDirectory() as home, warnings.catch_warnings(record=True) as slow:
        warnings.simplefilter("always", UserWarning)
        for line, message in page_commands.failures(source[0], Path(home)):
            log.warning(message, location=(name, line))
    for warning in slow:
        print(f"{name}: {warning.message}", file=sys.stderr)


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the extension."""
    app.add_config_value("run_tutorials", False, "env", types=bool)
    app.connect("source-read", run)
    return {"parallel_read_safe": True}
