"""The side bar of the site is what furo alone would write."""

from pathlib import Path

import pytest

pytest.importorskip("sphinx")
pytest.importorskip("furo")

from sphinx.application import Sphinx

from tests.pages import ROOT

TREE = ".. toctree::\n   :hidden:\n{caption}\n{entries}\n"
CONF = """
import sys
sys.path.insert(0, {folder!r})
project, html_theme, extensions = "boats", "furo", {extensions!r}
"""
PAGES = {  # page -> title and the pages below it, in groups of the side bar
    "index": ("Boats", [("Start", ["first_steps"]), ("Reference", ["api", "kinds/index"])]),
    "first_steps": ("First & last <steps>", []),
    "api": ("API", []),
    "kinds/index": ("Kinds", [("", ["sail/index", "motor/index"])]),
    "kinds/sail/index": ("Sail", [("", ["sloop", "ketch"])]),
    "kinds/sail/sloop": ("Sloop", []),
    "kinds/sail/ketch": ("Ketch", []),
    "kinds/motor/index": ("Motor", [("", ["tug"])]),
    "kinds/motor/tug": ("Tug", []),
    "alone": ("A page in no tree", []),
}


def written_site(folder: Path, extensions: list[str]) -> dict[str, str]:
    """Build a small site; return the text of its pages."""
    source = folder / "source"
    for page, (title, groups) in PAGES.items():
        text = f"{title}\n{'=' * len(title)}\n\nA page.\n\n"
        for caption, entries in groups:
            lines = "\n".join(f"   {entry}" for entry in entries)
            option = f"   :caption: {caption}\n" if caption else ""
            text += TREE.format(caption=option, entries=lines)
        file = source / f"{page}.rst"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    conf = CONF.format(folder=str(ROOT / "docs" / "_ext"), extensions=extensions)
    (source / "conf.py").write_text(conf)
    out = folder / "out"
    Sphinx(source, source, out, folder / "doctrees", "html", status=None, warning=None).build()
    return {str(p.relative_to(out)): p.read_text() for p in sorted(out.rglob("*.html"))}


@pytest.mark.slow
def test_every_page_has_the_side_bar_that_furo_writes(tmp_path: Path) -> None:
    expected = written_site(tmp_path / "furo", [])
    found = written_site(tmp_path / "ours", ["navigation"])
    assert expected.keys() == found.keys() > {f"{page}.html" for page in PAGES}
    for page, text in expected.items():
        assert found[page] == text, page
    assert 'class="toctree-l3 current current-page"' in found["kinds/sail/ketch.html"]
    assert "current-page" not in found["alone.html"]
