"""Tables of a sweep as text, for the terminal and for report.html."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter

from boatsim.sweeps import indices, summary
from boatsim.sweeps.keys import Value
from boatsim.sweeps.results import Results


@dataclass(frozen=True)
class TextTable:
    """A table of text with the results of a sweep, for the terminal and for report.html.

    Attributes:
        key: Identifier of its section in the report.
        title: Title.
        head: Headings of the columns.
        rows: Cells of each row.
        left: Number of columns, from the first, that hold words and not numbers.
    """

    key: str
    title: str
    head: list[str]
    rows: list[list[str]]
    left: int


def result_tables(results: Results) -> list[TextTable]:
    """Return the tables with the results of a sweep; tables without rows are omitted.

    They hold the spread of metrics, comparisons of controllers, and Sobol indices.

    Args:
        results: Results of a sweep.
    """
    names = results.plan.differing_columns
    others = [name for name in names if name != summary.CONTROLLER]
    every_table = [
        _spread_table(names, results),
        *_pair_tables(others, summary.compare_controllers(results), results.labels),
        _index_table(names, indices.sensitivity_indices(results), results.labels),
    ]
    return list(filter(attrgetter("rows"), every_table))


def _spread_table(names: Sequence[str], results: Results) -> TextTable:
    single = len(results.plan.samples) == 1
    title, columns = "All runs", ["mean", "p5", "p50", "p95", "reached"]
    if single:
        title, columns = "One run at each point", ["value"]
    rows = []
    labels = results.labels
    for s in summary.metric_statistics(results):
        numbers = [format_number(s.mean)]
        if not single:
            numbers += map(format_number, (s.p5, s.p50, s.p95))
            numbers.append(f"{s.reached} of {s.runs}")
        rows.append([*format_values(s.point, labels), _with_unit(s.norm, s.unit), *numbers])
    return TextTable("runs", title, [*names, "metric", *columns], rows, len(names) + 1)


def _pair_tables(
    names: Sequence[str], pairs: Sequence[summary.Pair], labels: Mapping[str, str]
) -> list[TextTable]:
    """A table for each pair of controllers."""
    rows: dict[tuple[str, str], list[list[str]]] = {}
    for p in pairs:
        row = [
            *format_values(p.point, labels),
            _with_unit(p.norm, p.unit),
            format_number(p.of_first),
            format_number(p.of_second),
            f"{p.difference:+.3g} ± {p.sure:.2g}",
            f"{100 * p.first_lower:.0f} %",
            f"{100 * p.second_lower:.0f} %",
            str(p.pairs),
        ]
        pair = labels.get(p.first, p.first), labels.get(p.second, p.second)
        rows.setdefault(pair, []).append(row)
    found: list[TextTable] = []
    for number, (first, second) in enumerate(rows, 1):
        lower = [f"{first} lower", f"{second} lower"]
        head = [*names, "metric", first, second, "difference", *lower, "pairs"]
        title = f"{second} compared with {first}, on the same samples"
        own = rows[first, second]
        found.append(TextTable(f"pairs-{number}", title, head, own, len(names) + 1))
    return found


def _index_table(
    names: Sequence[str], found: Sequence[indices.Index], labels: Mapping[str, str]
) -> TextTable:
    rows = []
    for i in found:
        first = f"{i.first:.2f} ({i.first_low:.2f} to {i.first_high:.2f})"
        total = f"{i.total:.2f} ({i.total_low:.2f} to {i.total_high:.2f})"
        rows.append([*format_values(i.point, labels), i.norm, i.quantity, first, total])
    head = [*names, "metric", "quantity", "first order", "total"]
    return TextTable("sobol", "Sobol indices (95 % interval)", head, rows, len(names) + 2)


def blank_repeats(table: TextTable) -> list[list[str]]:
    """Return the rows of a table of text, with words that repeat the row above left blank.

    Args:
        table: The table.
    """
    left = table.left - 1
    previous: list[str] | None = None
    found = []
    for row in table.rows:
        words = row[:left]
        shown = words
        if words == previous:
            shown = [""] * left
        found.append([*shown, *row[left:]])
        previous = words
    return found


def format_number(value: float) -> str:
    """Return a number as text, in the format of all tables of a sweep.

    Args:
        value: The number.
    """
    return f"{value:.4g}"


def format_values(values: Sequence[Value], labels: Mapping[str, str] | None = None) -> list[str]:
    """Return the values of varied scenario keys as texts.

    Args:
        values: Numbers, texts or truth values.
        labels: What is shown in place of a text, such as the name of a file in place of its path.
    """
    texts = []
    for value in values:
        text = f"{value:.6g}" if isinstance(value, float) else str(value)
        texts.append((labels or {}).get(text, text))
    return texts


def _with_unit(metric: str, unit: str) -> str:
    if not unit:
        return metric
    return f"{metric} [{unit}]"
