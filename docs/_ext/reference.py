"""Sphinx extension that writes the reference pages from the library.

Sphinx is imported only when the extension is set up, so that tests can read the pages without it.
"""

from collections.abc import Iterator, Mapping
from dataclasses import fields
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import effect_pages
from page_markup import bullet_list, escaped, row, sentence, table_rows

from boatsim.cli import app as program
from boatsim.cli.catalogue import item_descriptions
from boatsim.cli.entry import CLASSES, class_description
from boatsim.diagnosis.config import DEFAULT
from boatsim.physics import content

if TYPE_CHECKING:
    from sphinx.application import Sphinx

EFFECTS = """Each page describes one effect of physics or measurement in `boatsim/physics/effects/`.

A diagnosis fits the parameters marked *fitted: yes* when it tests the effect as a candidate.
Parameters *fitted as damping, thrust, added mass, restoring* or *wind* are coefficients of the
vessel that are never known exactly; a diagnosis refits them within their specified uncertainty."""
SETTINGS = """Thresholds, priors, tolerances and limits that influence a diagnosis are settings.

`boatsim diagnose --set GROUP.NAME=VALUE` and the argument `settings` of `boatsim.diagnose` change
one; `diagnosis.json` records the values used under `config`."""
SECTIONS = {  # folder of pages -> heading and introduction of its index
    "commands": ("Commands", "Each page is the output of `--help`."),
    "effects": ("Effects", EFFECTS),
    "controllers": ("Controllers", "One controller a file, in `controllers/`."),
    "measures": ("Metrics", "One set of metrics a file, in `boatsim/metrics/`."),
    "sensors": (
        "Sensors",
        "Sensors in addition to those of `[sensors]`; one a file, in `boatsim/simulate/sensors/`.",
    ),
    "vessels": ("Vessels", "One folder each, in `models/`."),
    "scenarios": ("Scenarios", "In `scenarios/`, one folder for each vessel."),
    "settings": ("Settings of a diagnosis", SETTINGS),
}


@cache
def pages() -> Mapping[str, str]:
    """Return all pages: path below `reference/` without the suffix -> text."""
    texts = dict(_command_pages())
    for kind in CLASSES:
        for name in content.shipped_content_names(kind):
            texts[f"{kind}s/{name}"] = _entry_page(kind, name)
    for name in content.shipped_content_names("vessel"):
        texts[f"vessels/{name}"] = _vessel_page(name)
    texts |= dict(_scenario_pages())
    texts |= dict(_setting_pages())
    for section in SECTIONS:
        texts[f"{section}/index"] = _index(section, texts)
    return texts


def _entry_page(kind: str, name: str) -> str:
    """Return the page of an effect, controller, set of metrics or sensor."""
    if kind == "effect":
        return effect_pages.page(name)
    entry = class_description(kind, name)
    lines = [f"# {name}", "", f"{sentence(entry.words)}.", ""]
    if entry.doc:
        lines += [*map(escaped, entry.doc), ""]
    if entry.facts:
        lines += [*bullet_list(entry.facts), ""]
    if entry.parameters:
        lines += [*table_rows(entry.parameters), ""]
    return "\n".join([*lines, "```toml", *entry.example, "```", ""])


def _vessel_page(name: str) -> str:
    """Return what `boatsim show` prints of a vessel, without the path of its file."""
    lines = item_descriptions(name)
    lines = lines[lines.index(f"{name}: vessel") + 1 :]
    if "" in lines:
        lines = lines[: lines.index("")]
    words, *details = lines
    page = [f"# {name}", "", f"{sentence(words.strip()).rstrip('.')}.", "", "```text"]
    for line in details:
        if not line.startswith("  file: "):
            page.append(line)
    return "\n".join([*page, "```", ""])


def _scenario_pages() -> Iterator[tuple[str, str]]:
    """Yield a page for each folder of scenarios."""
    folders: dict[str, list[str]] = {}
    for name in content.shipped_content_names("scenario"):
        folders.setdefault(name.partition("/")[0], []).append(name)
    for folder, names in folders.items():
        lines = [f"# {folder}", "", "| `boatsim run` | purpose |", "| --- | --- |"]
        for name in names:
            about = str(effect_pages.scenario_table(name).get("about", ""))
            lines.append(row((f"`{name}`", escaped(about))))
        yield f"scenarios/{folder}", "\n".join([*lines, ""])


def _command_pages() -> Iterator[tuple[str, str]]:
    """Yield a page for each command: its help."""
    import typer

    group: Any = typer.main.get_command(program)
    with group.make_context("boatsim", [], resilient_parsing=True) as above:
        for name in group.list_commands(above):
            command = group.get_command(above, name)
            context = command.make_context(
                name, [], parent=above, resilient_parsing=True, terminal_width=100
            )
            help_lines = command.get_help(context).splitlines()
            page = [f"# boatsim {name}", "", "```text", *help_lines, "```", ""]
            for inner, part in getattr(command, "commands", {}).items():
                below = part.make_context(
                    inner, [], parent=context, resilient_parsing=True, terminal_width=100
                )
                help_lines = part.get_help(below).splitlines()
                page += [f"## {name} {inner}", "", "```text", *help_lines, "```", ""]
            yield f"commands/{name}", "\n".join(page)


def _setting_pages() -> Iterator[tuple[str, str]]:
    """Yield a page for each group of settings of a diagnosis."""
    for group in fields(DEFAULT):
        settings = getattr(DEFAULT, group.name)
        summary = (type(settings).__doc__ or "").splitlines()[0]
        lines = [f"# {group.name}", "", escaped(summary), ""]
        lines += [
            "| setting | default | unit | range | reason |",
            "| --- | --- | --- | --- | --- |",
        ]
        for field in fields(settings):
            about = field.metadata
            limits = f"{about['low']:g} to {about['high']:g}"
            name = f"`{group.name}.{field.name}`"
            cells = (f"{field.default}", about["unit"], limits, about["reason"])
            lines.append(row((name, *map(escaped, cells))))
        yield f"settings/{group.name}", "\n".join([*lines, ""])


def _index(section: str, texts: Mapping[str, str]) -> str:
    """Return the index of a section: each name with the first sentence of its page."""
    title, introduction = SECTIONS[section]
    lines = [f"# {title}", "", introduction, ""]
    names = []
    for path in texts:
        folder, _, name = path.partition("/")
        if folder != section:
            continue
        names.append(name)
        sentence = texts[path].splitlines()[2].rstrip(".")
        if sentence.startswith(("|", "```")):
            lines.append(f"- [{name}]({name}.md)")
        else:
            lines.append(f"- [{name}]({name}.md): {sentence}")
    return "\n".join([*lines, "", "```{toctree}", ":hidden:", "", *names, "```", ""])


def write(app: "Sphinx") -> None:
    """Write all pages that have changed, and remove those that no longer exist."""
    folder = Path(app.srcdir) / "reference"
    texts = {}
    for name, text in pages().items():
        if name.startswith("effects/"):
            text = effect_pages.with_plot(name.removeprefix("effects/"), text)
        texts[folder / f"{name}.md"] = text
    for file in folder.glob("*/*.md"):
        if file not in texts:
            file.unlink()
    for file, text in texts.items():
        file.parent.mkdir(exist_ok=True)
        if not file.is_file() or file.read_text(encoding="utf-8") != text:
            file.write_text(text, encoding="utf-8")


def setup(app: "Sphinx") -> dict[str, Any]:
    """Register the extension: the pages are written before Sphinx searches for pages."""
    app.connect("builder-inited", write)
    return {"parallel_read_safe": True}
