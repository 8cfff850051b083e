"""Charts at the head of the page of results, drawn from the tables of that page.

`python docs/_ext/results_charts.py` writes them to `docs/charts/`, where a reader of the repository
sees them; `tests/docs/test_site_charts.py` compares these files with the tables. The Sphinx
extension draws them into the page, where they follow its light or dark theme.
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import charts
import numpy as np

if TYPE_CHECKING:
    from sphinx.application import Sphinx

DOCS = Path(__file__).parents[1]
FOLDER = DOCS / "charts"
COUNT = re.compile(r"([\d,]+) of ([\d,]+)")
NUMBER = re.compile(r"\d+(?:\.\d+)?")
IMAGE = re.compile(r"!\[[^\]]*\]\(charts/(\w+)\.svg\)")
NORMAL = 1.96  # standard deviations of a normal distribution that hold 95 % of it
HALF = 0.5  # a rate with a goal below it must not exceed the goal, otherwise reach it
LARGEST_POINT = 8.0  # radius of the point with the most names, in units of the drawing


class Rate(NamedTuple):
    """A rate of a table: cases of a kind among all cases, with its goal."""

    label: str
    cases: int
    of: int
    goal: float | None


def table_below(page: str, heading: str, head: str) -> Iterator[list[str]]:
    """Yield the cells of each row of a table.

    Args:
        page: Text of the page of results.
        heading: Heading of the section that contains the table.
        head: Begin of the table's first line.
    """
    section = page.split(f"\n{heading}\n", 1)[1]
    lines = section[section.index(f"\n{head}") + 1 :].splitlines()
    for line in lines[2:]:
        if not line.startswith("|"):
            return
        yield [cell.strip() for cell in line.strip("|").split(" | ")]


def rates(page: str, heading: str) -> list[Rate]:
    """Return the rates of a table of figures that have a goal, one for each count.

    Args:
        page: Text of the page of results.
        heading: Heading of the section that contains the table.
    """
    found = []
    for label, here, goal in table_below(page, heading, "| figure | here | goal |"):
        counts = COUNT.findall(here)
        labels = label.split(" / ")
        goals = goal.split(" / ")
        if not goal or not counts:
            continue
        for index, (cases, of) in enumerate(counts):
            words = labels[0]
            if index:
                words = f"… {labels[index]}"
            aim = 0.0
            if goals[min(index, len(goals) - 1)] != "none":
                aim = float(goals[min(index, len(goals) - 1)])
            rate = Rate(words, int(cases.replace(",", "")), int(of.replace(",", "")), aim)
            found.append(rate)
    return found


def wilson_interval(cases: int, of: int) -> tuple[float, float]:
    """Return the 95 % interval of a rate by Wilson's formula, as in the tables.

    Args:
        cases: Number of cases of the kind.
        of: Number of all cases.
    """
    share, spread = cases / of, NORMAL**2 / of
    middle = share + spread / 2
    half = NORMAL * np.sqrt(share * (1 - share) / of + spread / (4 * of))
    return float((middle - half) / (1 + spread)), float((middle + half) / (1 + spread))


def rate_bar(rate: Rate) -> charts.Bar:
    """Return the bar of a rate; a goal below one half is an upper limit."""
    share = rate.cases / rate.of
    met = None
    if rate.goal is not None:
        met = share >= rate.goal
        if rate.goal < HALF:
            met = share <= rate.goal
    note = f"{rate.cases} of {rate.of}"
    interval = wilson_interval(rate.cases, rate.of)
    return charts.Bar(rate.label, note, share, interval, rate.goal, met)


def draw_rates(page: str, heading: str, in_file: bool) -> str:
    """Return the chart of the rates of one table, with their goals."""
    bars = list(map(rate_bar, rates(page, heading)))
    about = f"{heading.lstrip('# ')}: rates with 95 % intervals and goals"
    return charts.bar_chart(bars, (0.0, 1.0), "share of all cases", about, in_file)


def draw_calibration(page: str, in_file: bool) -> str:
    """Return the chart of how often names of each stated probability are right."""
    whole = np.array([0.0, 1.0])
    curves = []
    for heading, name in (
        ("## Calibration of the stated probabilities", "weights in use, seed 17"),
        ("### 1,000 logs with other weights", "other weights, seed 8"),
    ):
        rows = list(table_below(page, heading, "| stated probability | names |"))
        numbers = np.array([list(map(float, row[1:])) for row in rows])
        sizes = LARGEST_POINT * np.sqrt(numbers[:, 0] / numbers[:, 0].max())
        curves.append(
            charts.Curve(name, numbers[:, 1], numbers[:, 2], sizes=sizes.clip(2.0).tolist())
        )
    perfect = charts.Curve("perfect", whole, whole, "reference")
    axes = charts.Axes("share of names that are right", [*curves, perfect], (0.0, 1.03))
    about = (
        "Share of names that are right over the stated probability, which a diagonal would equal"
    )
    return charts.line_chart([axes], "mean stated probability", about, 300, in_file)


def real_bars(page: str) -> list[charts.Bar]:
    """Return the error ratios on real recordings: patched over recalibrated, with their goals."""
    bars, name = [], ""
    for row in table_below(page, "## Real recordings", "| NAME | judged on |"):
        if found := re.search(r"`(\w+)`", row[0]):
            name = found[1]
        recalibrated, ratio = float(NUMBER.findall(row[2])[0]), float(row[4])
        goal, met = None, None
        if row[5]:
            goal = float(NUMBER.findall(row[5])[0])
            if not row[5].endswith(str(NUMBER.findall(row[5])[0])):  # has a unit: an error
                goal /= recalibrated
            met = ratio <= goal
        label = f"… {row[1]}"
        if row[0]:
            label = f"{name}: {row[1]}"
        bars.append(charts.Bar(label, row[4], ratio, None, goal, met))
    return bars


def draw_real(page: str, in_file: bool) -> str:
    """Return the chart of the error ratios on real recordings."""
    about = "Error of the corrected vessel over that of the retuned one, on real recordings"
    label = "error of the corrected vessel / error of the retuned vessel"
    return charts.bar_chart(real_bars(page), (0.0, 1.25), label, about, in_file)


def draw_all(page: str, in_file: bool) -> dict[str, str]:
    """Return all charts of the page of results: name -> SVG.

    Args:
        page: Text of the page of results.
        in_file: Whether the charts are files of their own.
    """
    found = {"calibration": draw_calibration(page, in_file), "real": draw_real(page, in_file)}
    for name, heading in (
        ("rates", "## Calibration of the stated probabilities"),
        ("rates_other_weights", "### 1,000 logs with other weights"),
        ("trial_boat", "## Trial boat with concealed effects"),
        ("five_vessels", "## Five other vessels"),
    ):
        found[name] = draw_rates(page, heading, in_file)
    return found


def draw_into_page(app: "Sphinx", name: str, source: list[str]) -> None:
    """Replace the images of charts on the page of results by drawings of its tables.

    Args:
        app: The running Sphinx application.
        name: Name of the page.
        source: List whose only element is the text of the page.
    """
    if name == "results":
        drawings = draw_all(source[0], in_file=False)
        source[0] = IMAGE.sub(lambda found: f"<div>{drawings[found[1]]}</div>", source[0])


def setup(app: "Sphinx") -> dict[str, Any]:
    """Register the extension."""
    app.connect("source-read", draw_into_page)
    return {"parallel_read_safe": True}


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    text = (DOCS / "results.md").read_text(encoding="utf-8")
    for chart, svg in draw_all(text, in_file=True).items():
        (FOLDER / f"{chart}.svg").write_text(f"{svg}\n", encoding="utf-8")
