"""What the command line prints: the table of norms, the list of content."""

from collections.abc import Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING

from boatsim.errors import BadInput, shown, unknown_name
from boatsim.files import read_toml
from boatsim.physics import content
from boatsim.simulate import cases

if TYPE_CHECKING:
    from boatsim.simulate.norms import NormEntry, RunEntry


def norms(found: "RunEntry", folder: Path) -> None:
    """Table norm, value, published, whether it is the same, guard, met, from the content of norms.json."""
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    from boatsim.simulate.norms import MISSED, REPRODUCED, UNSTATED

    short = {REPRODUCED: "same", MISSED: "[bold]differs[/]", UNSTATED: "unstated"}  # in a table 80 columns wide
    state = "" if found["complete"] else ", interrupted"
    table = Table(
        title=Text(shown(f"{found['scenario']}, {found['controller']}, seed {found['seed']}{state}")), pad_edge=False
    )
    table.add_column("norm", no_wrap=True)
    for heading in ("value", "published"):
        table.add_column(heading, justify="right", no_wrap=True)
    for heading in ("verdict", "guard", "met"):
        table.add_column(heading, no_wrap=True)
    for name, norm in ((shown(n), norm) for n, norm in found["norms"].items()):
        published = "" if norm["published"] is None else f"{norm['published']:.4g}"
        verdict = short.get(norm["verdict"] or "", "")
        table.add_row(name, _value(norm), published, verdict, _guard(norm["guard"]), _met(norm["ok"]))
    console = Console()
    if found["norms"]:
        console.print(table)
    else:
        console.print(table.title)
    console.print(Text(shown(f"written to {folder}")), soft_wrap=True)


def _value(norm: "NormEntry") -> str:
    value = norm["value"]
    return norm["lacking"] or "not reached" if value is None else f"{value:.4g} {norm['unit']}".rstrip()


def _guard(guard: Sequence[float | None] | None) -> str:
    low, high = guard or (None, None)
    if low is not None and high is not None:
        return f"{low:.4g} to {high:.4g}"
    return f"at least {low:.4g}" if low is not None else f"at most {high:.4g}" if high is not None else ""


def _met(ok: bool | None) -> str:
    return "" if ok is None else "[green]yes[/]" if ok else "[bold red]no[/]"


def listing(only: str | None, like: str | None = None) -> list[str]:
    """Lines of `boatsim list`: a heading for each kind, then name and a line about each, if `like` a pattern.

    Raises BadInput where none is.
    """
    kinds = [only] if only else ["vessels", "controllers", "effects", "sensors", "measures", "scenarios"]
    lines: list[str] = []
    for kind in kinds:
        names = [n for n in content.known(kind.removesuffix("s")) if like is None or alike(n, like)]
        if not names and like is not None:
            continue
        width = max(map(len, names), default=0)
        lines += [*([""] if lines else []), f"{kind}:"]
        lines += [f"  {name:{width}}  {_about(kind.removesuffix('s'), name)}" for name in names]
    if like is not None and not lines:
        there = [n for kind in kinds for n in content.known(kind.removesuffix("s"))]
        raise BadInput(unknown_name(only.removesuffix("s") if only else "name", like, there))
    return lines


def alike(name: str, like: str) -> bool:
    """Whether a name has a word in it, or is like a pattern."""
    return fnmatchcase(name, like) if any(sign in like for sign in "*?[") else like in name


def _about(kind: str, name: str) -> str:
    if kind == "scenario":
        return str(cases.content(name)[0].get("about", ""))
    if kind == "vessel":
        return str(read_toml(content.find(kind, name)).get("about", ""))
    return str(content.load_class(kind, name).words)
