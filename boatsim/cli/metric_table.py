"""Tables on the terminal: the metrics of a run with their bands, and plain tables of text."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from boatsim.errors import escape_for_terminal
from boatsim.view.content_names import plain_name

if TYPE_CHECKING:
    from rich.table import Table

    from boatsim.simulate.evaluation import MetricEntry, RunEntry

UNLIMITED_WIDTH = 10_000  # [columns] more than any table needs


def print_metrics(run: "RunEntry", folder: Path) -> None:
    """Print a table of a run's metrics, the meaning of their names, and why some have no value.

    Args:
        run: Content of norms.json.
        folder: Output folder of the run.
    """
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    from boatsim.view.run_sentence import explain_name_endings

    words = f"{run['scenario']}, {plain_name(run['controller'])}, seed {run['seed']}"
    if not run["complete"]:
        words += ", interrupted"
    title = Text(escape_for_terminal(words))
    metrics = run["norms"]
    table = Table(title=title, pad_edge=False, show_edge=False)
    for heading, justify in _column_alignments(metrics.values()).items():
        table.add_column(heading, justify=justify, no_wrap=True)
    for name, metric in metrics.items():
        cells = {"metric": escape_for_terminal(name), **_format_cells(metric)}
        table.add_row(*(cells[str(column.header)] for column in table.columns))
    console = Console()
    console.print(table if metrics else title)
    for line in [
        *explain_name_endings(metrics),
        *explain_missing_values(metrics),
        f"written to {folder}",
    ]:
        console.print(Text(escape_for_terminal(line)), soft_wrap=True)


def _column_alignments(metrics: Iterable["MetricEntry"]) -> dict[str, Literal["left", "right"]]:
    """Headings with their alignment; a column of bands only if one of the metrics has one."""
    columns: dict[str, Literal["left", "right"]] = {"metric": "left", "value": "right"}
    metrics = list(metrics)
    if any(metric["published"] is not None for metric in metrics):
        columns |= {"published": "right", "verdict": "left"}
    if any(metric["guard"] for metric in metrics):
        columns |= {"band": "left", "met": "left"}
    return columns


def _format_cells(metric: "MetricEntry") -> dict[str, str]:
    """Text of each cell of a metric's row, by heading."""
    from boatsim.simulate.evaluation import MISSED, NO_TOLERANCE, REPRODUCED

    # Short words, so that the table fits into 80 columns.
    verdicts = {REPRODUCED: "same", MISSED: "[bold]differs[/]", NO_TOLERANCE: "unstated"}
    met = {None: "", True: "[green]yes[/]", False: "[bold red]no[/]"}
    published_text = ""
    if metric["published"] is not None:
        published_text = f"{metric['published']:.4g}"
    return {
        "value": format_value(metric),
        "published": published_text,
        "verdict": verdicts.get(metric["verdict"] or "", ""),
        "band": _format_band(metric["guard"], metric["unit"]),
        "met": met[metric["ok"]],
    }


def format_value(metric: "MetricEntry") -> str:
    """Return the value of a metric with its unit as text, or in two words why it has none.

    Args:
        metric: Entry of norms.json.
    """
    value = metric["value"]
    if value is None:
        return (metric["lacking"] or "not reached").partition(":")[0]
    return f"{value:.4g} {metric['unit']}".rstrip()


def explain_missing_values(metrics: Mapping[str, "MetricEntry"]) -> list[str]:
    """Return the reasons why metrics of a run have no value, one line each.

    Args:
        metrics: Entries of norms.json by name.
    """
    names: dict[str, list[str]] = {}
    for name, metric in metrics.items():
        if metric["lacking"] and ":" in metric["lacking"]:
            names.setdefault(metric["lacking"], []).append(name)
    return [f"{', '.join(affected)} {reason}" for reason, affected in names.items()]


def _format_band(band: Sequence[float | None] | None, unit: str) -> str:
    low, high = band or (None, None)
    if low is not None and high is not None:
        return f"{low:.4g} to {high:.4g} {unit}".strip()
    if low is not None:
        return f"at least {low:.4g} {unit}".strip()
    if high is not None:
        return f"at most {high:.4g} {unit}".strip()
    return ""


def print_text_table(
    title: str, head: Sequence[str], rows: Sequence[Sequence[str]], left: int
) -> None:
    """Print a table of text on the terminal.

    Args:
        title: Title above the table.
        head: Headings of the columns.
        rows: Cells of each row.
        left: Number of columns, from the first, that are aligned to the left.
    """
    from rich.table import Table
    from rich.text import Text

    table = Table(title=Text(escape_for_terminal(title)), pad_edge=False)
    for index, heading in enumerate(head):
        side: Literal["left", "right"] = "left" if index < left else "right"
        table.add_column(Text(escape_for_terminal(heading)), justify=side, no_wrap=True)
    for row in rows:
        table.add_row(*map(Text, map(escape_for_terminal, row)))
    print_rich_table(table)


def print_rich_table(table: "Table") -> None:
    """Print a table of the library rich; in a file no cell is cut, however wide the table is.

    Args:
        table: Table of rich.
    """
    from rich.console import Console

    console = Console()
    if not console.is_terminal:
        options = console.options.update(max_width=UNLIMITED_WIDTH)
        width = console.measure(table, options=options).maximum
        console = Console(width=max(console.width, width))
    console.print(table)
