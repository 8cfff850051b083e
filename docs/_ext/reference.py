"""Pages of the reference, made of what the library says of itself; a Sphinx extension that writes them.

Nothing here imports Sphinx before it is set up: the tests read the pages without it.
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from boatsim.cli import app as program
from boatsim.cli.catalogue import describe
from boatsim.cli.entry import CLASSES, class_entry
from boatsim.physics import content
from boatsim.simulate import cases

if TYPE_CHECKING:
    from sphinx.application import Sphinx

FITTED = """One idea of physics or of measurement each, in `boatsim/physics/effects/`.

*Fitted: yes* are the parameters that a diagnosis fits when it tries the effect as what is missing. Those fitted *as
damping, thrust, added mass, restoring* or *wind* are coefficients of the boat that are never known exactly: a diagnosis
refits them within their stated uncertainty."""
SHELVES = {  # folder of pages -> its heading and what stands below it
    "commands": ("Commands", "What each says to `--help`."),
    "effects": ("Effects", FITTED),
    "controllers": ("Controllers", "One a file, in `controllers/`."),
    "measures": ("Measures", "One measure of a run a file, in `boatsim/metrics/`."),
    "sensors": (
        "Sensors",
        "Beside the usual ones of `[sensors]`; one a file, in `boatsim/simulate/sensors/`.",
    ),
    "vessels": ("Vessels", "A folder each, in `models/`."),
    "scenarios": ("Scenarios", "In `scenarios/`, a folder for each vessel."),
}


def pages() -> dict[str, str]:
    """All pages: path below `reference/` without the suffix -> text."""
    found = dict(_commands())
    for kind in CLASSES:
        found |= {f"{kind}s/{name}": _entry_page(kind, name) for name in content.names(kind)}
    found |= {f"vessels/{name}": _vessel_page(name) for name in content.names("vessel")}
    found |= dict(_scenarios())
    return found | {f"{shelf}/index": _index(shelf, found) for shelf in SHELVES}


def _entry_page(kind: str, name: str) -> str:
    """An effect, controller, measure or sensor."""
    one = class_entry(kind, name)
    lines = [f"# {name}", "", f"{_sentence(one.words)}.", ""]
    lines += [_plain(line) for line in one.doc] + ([""] if one.doc else [])
    lines += [f"- **{what}**: {_plain(text)}" for what, text in one.facts] + (
        [""] if one.facts else []
    )
    if one.parameters:
        head, *rows = one.parameters
        lines += [
            _row(head),
            _row("---" for _ in head),
            *(_row(map(_plain, row)) for row in rows),
            "",
        ]
    return "\n".join([*lines, "```toml", *one.example, "```", ""])


def _vessel_page(name: str) -> str:
    """What `boatsim show` prints of a vessel, but for the path of its file on the machine that builds."""
    lines = describe(name)
    lines = lines[lines.index(f"{name}: vessel") + 1 :]
    words, *rest = lines[: lines.index("")] if "" in lines else lines
    rest = [line for line in rest if not line.startswith("  file: ")]
    return "\n".join(
        [
            f"# {name}",
            "",
            f"{_sentence(words.strip()).rstrip('.')}.",
            "",
            "```text",
            *rest,
            "```",
            "",
        ]
    )


def _scenarios() -> Iterator[tuple[str, str]]:
    """A page for each folder of scenarios: name, what it is, its controller."""
    folders: dict[str, list[str]] = {}
    for name in content.names("scenario"):
        folders.setdefault(name.partition("/")[0], []).append(name)
    for folder, names in folders.items():
        lines = [f"# {folder}", "", "| `boatsim run` | what |", "| --- | --- |"]
        lines += [
            _row((f"`{name}`", _plain(str(cases.content(name)[0].get("about", "")))))
            for name in names
        ]
        yield f"scenarios/{folder}", "\n".join([*lines, ""])


def _commands() -> Iterator[tuple[str, str]]:
    """A page for each command: its help."""
    import typer

    group: Any = typer.main.get_command(program)
    with group.make_context("boatsim", [], resilient_parsing=True) as above:
        for name in group.list_commands(above):
            command = group.get_command(above, name)
            inside = command.make_context(
                name, [], parent=above, resilient_parsing=True, terminal_width=100
            )
            text = command.get_help(inside)
            yield (
                f"commands/{name}",
                "\n".join([f"# boatsim {name}", "", "```text", *text.splitlines(), "```", ""]),
            )


def _index(shelf: str, found: Mapping[str, str]) -> str:
    """The list of a shelf: each name with the first sentence of its page, where it has one."""
    title, below = SHELVES[shelf]
    names = [n.partition("/")[2] for n in found if n.startswith(f"{shelf}/")]
    lines = [f"# {title}", "", below, ""]
    for name in names:
        words = found[f"{shelf}/{name}"].splitlines()[2].rstrip(".")
        lines.append(
            f"- [{name}]({name}.md){'' if words.startswith(('|', '```')) else f': {words}'}"
        )
    return "\n".join([*lines, "", "```{toctree}", ":hidden:", "", *names, "```", ""])


def _row(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _sentence(text: str) -> str:
    return _plain(text[:1].upper() + text[1:])


def _plain(text: str) -> str:
    """Text as it is, with no sign of it taken for Markdown, but for what stands in backticks."""
    parts = re.split(r"(`[^`]*`)", text)
    return "".join(
        p if p.startswith("`") else re.sub(r"([\\*_<>|\[\]$])", r"\\\1", p) for p in parts
    )


def write(app: "Sphinx") -> None:
    """Write all pages that are not as they should be, and take away those that should not be."""
    here = Path(app.srcdir) / "reference"
    made = {here / f"{name}.md": text for name, text in pages().items()}
    for file in here.glob("*/*.md"):
        if file not in made:
            file.unlink()
    for file, text in made.items():
        file.parent.mkdir(exist_ok=True)
        if not file.is_file() or file.read_text(encoding="utf-8") != text:
            file.write_text(text, encoding="utf-8")


def setup(app: "Sphinx") -> dict[str, Any]:
    """Write before the pages are looked for."""
    app.connect("builder-inited", write)
    return {"parallel_read_safe": True}
