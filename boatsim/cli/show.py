"""What the command line prints: the table of norms, the list of content."""

from collections.abc import Iterable, Mapping, Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from boatsim.errors import BadInput, printable, unknown_name
from boatsim.files import read_toml
from boatsim.physics import content
from boatsim.simulate import cases

if TYPE_CHECKING:
    from boatsim.simulate.evaluation import MetricEntry, RunEntry

UNCUT = 10_000  # [columns] wider than any table


def norms(found: "RunEntry", folder: Path) -> None:
    """Table of norms from the content of norms.json, below it what their names mean and why some were not reached."""
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    state = "" if found["complete"] else ", interrupted"
    title = Text(
        printable(f"{found['scenario']}, {found['controller']}, seed {found['seed']}{state}")
    )
    table = Table(title=title, pad_edge=False)
    for heading, justify in _columns(found["norms"].values()).items():
        table.add_column(heading, justify=justify, no_wrap=True)
    for name, norm in found["norms"].items():
        cells = {"norm": printable(name), **_cells(norm)}
        table.add_row(*(cells[str(column.header)] for column in table.columns))
    console = Console()
    if found["norms"]:
        console.print(table)
    else:
        console.print(title)
    for line in [*meanings(found["norms"]), *reasons(found["norms"]), f"written to {folder}"]:
        console.print(Text(printable(line)), soft_wrap=True)


def _columns(norms: Iterable["MetricEntry"]) -> dict[str, Literal["left", "right"]]:
    """Headings with the side they keep to; those of bars only where one of the norms has any."""
    found: dict[str, Literal["left", "right"]] = {"norm": "left", "value": "right"}
    norms = list(norms)
    if any(n["published"] is not None for n in norms):
        found |= {"published": "right", "verdict": "left"}
    if any(n["guard"] for n in norms):
        found |= {"guard": "left", "met": "left"}
    return found


def _cells(norm: "MetricEntry") -> dict[str, str]:
    """What stands under each heading."""
    from boatsim.simulate.evaluation import MISSED, NO_TOLERANCE, REPRODUCED

    short = {
        REPRODUCED: "same",
        MISSED: "[bold]differs[/]",
        NO_TOLERANCE: "unstated",
    }  # in a table 80 columns wide
    return {
        "value": value(norm),
        "published": "" if norm["published"] is None else f"{norm['published']:.4g}",
        "verdict": short.get(norm["verdict"] or "", ""),
        "guard": _guard(norm["guard"]),
        "met": _met(norm["ok"]),
    }


def value(norm: "MetricEntry") -> str:
    """A norm with its unit, or in two words why it has no value."""
    found = norm["value"]
    if found is None:
        return (norm["lacking"] or "not reached").partition(":")[0]
    return f"{found:.4g} {norm['unit']}".rstrip()


def meanings(norms: Mapping[str, "MetricEntry"]) -> list[str]:
    """A line that says what the endings of these norms stand for, where the names do not say it themselves."""
    found: dict[str, str] = {}
    for name, norm in norms.items():
        ending = name.rpartition("_")[2]
        if norm["kind"] not in ("", ending):
            found.setdefault(norm["kind"], ending)
    return ["; ".join(f"{ending}: {kind}" for kind, ending in found.items())] if found else []


def reasons(norms: Mapping[str, "MetricEntry"]) -> list[str]:
    """A line for each reason why norms were not reached."""
    found: dict[str, list[str]] = {}
    for name, norm in norms.items():
        if norm["lacking"] and ":" in norm["lacking"]:
            found.setdefault(norm["lacking"], []).append(name)
    return [f"{', '.join(names)} {why}" for why, names in found.items()]


def _guard(guard: Sequence[float | None] | None) -> str:
    low, high = guard or (None, None)
    if low is not None and high is not None:
        return f"{low:.4g} to {high:.4g}"
    return (
        f"at least {low:.4g}"
        if low is not None
        else f"at most {high:.4g}"
        if high is not None
        else ""
    )


def _met(ok: bool | None) -> str:
    return "" if ok is None else "[green]yes[/]" if ok else "[bold red]no[/]"


def listing(only: str | None, like: str | None = None) -> list[str]:
    """Lines of `boatsim list`: a heading for each kind, then name and a line about each, if `like` a pattern.

    Raises BadInput where none is.
    """
    kinds = (
        [only]
        if only
        else ["vessels", "controllers", "effects", "sensors", "measures", "scenarios"]
    )
    lines: list[str] = []
    for kind in kinds:
        names = [
            n for n in content.all_names(kind.removesuffix("s")) if like is None or alike(n, like)
        ]
        if not names and like is not None:
            continue
        width = max(map(len, names), default=0)
        lines += [*([""] if lines else []), f"{kind}:"]
        lines += [f"  {name:{width}}  {_about(kind.removesuffix('s'), name)}" for name in names]
    if like is not None and not lines:
        there = [n for kind in kinds for n in content.all_names(kind.removesuffix("s"))]
        raise BadInput(unknown_name(only.removesuffix("s") if only else "name", like, there))
    return lines


def printed(title: str, head: Sequence[str], rows: Sequence[Sequence[str]], left: int) -> None:
    """A table, its first `left` columns to the left; in a file nothing of it is cut."""
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(title=Text(printable(title)), pad_edge=False)
    for number, heading in enumerate(head):
        side: Literal["left", "right"] = "left" if number < left else "right"
        table.add_column(Text(printable(heading)), justify=side, no_wrap=True)
    for row in rows:
        table.add_row(*(Text(printable(cell)) for cell in row))
    console = Console()
    if not console.is_terminal:
        wide = console.options.update(max_width=UNCUT)
        console = Console(width=max(console.width, console.measure(table, options=wide).maximum))
    console.print(table)


def alike(name: str, like: str) -> bool:
    """Whether a name has a word in it, or is like a pattern."""
    return fnmatchcase(name, like) if any(sign in like for sign in "*?[") else like in name


def _about(kind: str, name: str) -> str:
    if kind == "scenario":
        return str(cases.content(name)[0].get("about", ""))
    if kind == "vessel":
        return str(read_toml(content.find(kind, name)).get("about", ""))
    return str(content.load_class(kind, name).words)
