"""Sphinx extension that shows the repository's CONTRIBUTING.md as a page of the site."""

import re
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

FILE = Path(__file__).parents[2] / "CONTRIBUTING.md"
LINK = re.compile(r"\[([^\]]*)\]\((?!https?:)([^)]*)\)")


def on_the_site(text: str) -> str:
    """Return the text of a page of the repository with links that lead somewhere on the site.

    Args:
        text: Markdown with links relative to the root of the repository.
    """
    return LINK.sub(_link, text)


def _link(match: re.Match[str]) -> str:
    """Return a link to a page in `docs/` relative to it, and any other link as its words only."""
    words, target = match.groups()
    if target.startswith("docs/"):
        return f"[{words}]({target.removeprefix('docs/')})"
    return f"`{words}`"


def replace(app: Sphinx, name: str, source: list[str]) -> None:
    """Replace the text of the page `contributing` by that of CONTRIBUTING.md.

    Args:
        app: The running Sphinx application.
        name: Name of the page.
        source: List whose only element is the text of the page.
    """
    if name == "contributing":
        source[0] = on_the_site(FILE.read_text(encoding="utf-8"))


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the extension."""
    app.connect("source-read", replace)
    return {"parallel_read_safe": True}
