"""Plots of metrics against what varied: lines with bands over numbers, boxes over lists, points."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any, NamedTuple

import numpy as np

from boatsim.physics.signals import Array
from boatsim.sweeps.axes import Axis
from boatsim.sweeps.results import Results
from boatsim.sweeps.summary import CONTROLLER
from boatsim.sweeps.text_tables import format_values
from boatsim.view.svg_plots import SQUARE, Box, Line, Panel, axis_limits, figure, legend

STYLES = ("one", "two", "three", "four")  # classes of the style sheet, one for each controller
QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
ENDS = {0: "p5", 4: "p95"}  # indices of QUANTILES that are lines where several bands would overlap
MOST_SAMPLED = 6  # sampled quantities plotted against a metric: those with the highest correlation
LONGEST_LABEL = 14  # characters of a label below an axis
ONE_VALUE = 1e-4  # relative range below which the values of a metric are plotted as a constant
BOX_WIDTH = 0.7  # share of the distance between two values of a list


@dataclass(frozen=True)
class Group:
    """Runs of a sweep that are plotted in one style: those of one controller, or all.

    Attributes:
        name: Name of the controller; "" for all runs.
        style: Class of the style sheet.
        rows: Mask (R,) of the runs.
    """

    name: str
    style: str
    rows: Array


class _Metric(NamedTuple):
    """A metric to plot."""

    values: Array  # (R,)
    groups: Sequence[Group]
    limits: tuple[float, float]
    title: str


def group_by_controller(results: Results, rows: Array) -> list[Group]:
    """Divide the runs of a sweep into one group per controller, for plots.

    There is one group of all runs if the controller was not varied, and at most one group per
    style.

    Args:
        results: Results of a sweep.
        rows: Mask (R,) of the runs to use.
    """
    if CONTROLLER not in results.plan.columns:
        return [Group("", STYLES[0], rows)]
    used = np.array(list(map(str, results.column_values(CONTROLLER))))
    names = dict.fromkeys(used.tolist())
    found = []
    for name, style in zip(names, STYLES, strict=False):
        label = results.labels.get(name, name)
        found.append(Group(label, style, rows & (used == name)))
    return found


def controller_legend(found: Sequence[Group]) -> str:
    """Return the legend of a sweep's plots, which names the controllers, as SVG; "" for one group.

    Args:
        found: Groups of runs.
    """
    if len(found) < 2:
        return ""
    return legend({group.style: group.name for group in found})


def metric_plots(results: Results, name: str, rows: Array) -> list[str]:
    """Return plots of a metric of a sweep against axes and the most correlated sampled quantities.

    Args:
        results: Results of a sweep.
        name: Name of the metric.
        rows: Mask (R,) of the runs to use.

    Returns:
        SVG texts.
    """
    values, unit = results.metrics[name], results.units[name]
    finite = rows & np.isfinite(values)
    if not finite.any():
        return []
    title = name
    if unit:
        title = f"{name} [{unit}]"
    shown = values[finite]
    if np.ptp(shown) < ONE_VALUE * np.abs(shown).max():
        shown = shown[:1]
    y = axis_limits([shown], zero=False)
    metric = _Metric(values, group_by_controller(results, finite), y, title)
    plots = []
    for axis in results.plan.axes:
        # The styles distinguish the controllers; they need no axis where something else varies.
        by_style = axis.target.name == CONTROLLER and len(metric.groups) < 2
        if len(axis.values) > 1 and not by_style:
            plots.append(_plot_axis(results, axis, metric))
    for quantity, x, correlation in rank_correlations(results, values, finite):
        plots.append(_plot_sampled(quantity, x, correlation, metric))
    return plots


def _plot_axis(results: Results, axis: Axis, metric: _Metric) -> str:
    name = axis.target.name
    varied = results.column_values(name)
    title = metric.title
    if not axis.is_numeric:
        return figure([_box_plot(axis, varied, metric, results.labels)], f"{title} by {name}")
    x = np.array(sorted(map(float, axis.values)))
    numbers = np.array(varied, dtype=float)
    lines: list[Line] = []
    band = None
    for group in metric.groups:
        spread = _quantiles(x, numbers, metric.values, group.rows)
        lines.append(Line(group.style, x, spread[2], group.name or "median"))
        if len(metric.groups) == 1:
            band = (x, spread[0], spread[4])
            continue
        for k, label in ENDS.items():
            lines.append(Line(f"{group.style} end", x, spread[k], f"{group.name} {label}"))
    ends = (float(x[0]), float(x[-1]))
    panel = Panel(title, tuple(lines), ends, metric.limits, name, band, shape=2.0)
    return figure([panel], f"{title} over {name}")


def _quantiles(x: Array, numbers: Array, values: Array, rows: Array) -> Array:
    """QUANTILES (5, X) of a metric at each value of an axis, nan where no run has it."""
    spread = np.full((len(QUANTILES), len(x)), np.nan)
    for column, at in enumerate(x):
        here = values[rows & (numbers == at)]
        if len(here):
            spread[:, column] = np.quantile(here, QUANTILES)
    return spread


def _box_plot(
    axis: Axis, varied: Sequence[Any], metric: _Metric, shown: Mapping[str, str]
) -> Panel:
    """A box for each value of a list; those of several controllers stand side by side."""
    count = len(metric.groups)
    by_controller = axis.target.name == CONTROLLER
    used = np.array(list(map(str, varied)))
    width = BOX_WIDTH if by_controller else BOX_WIDTH / count
    boxes = []
    for (at, value), (k, group) in product(enumerate(axis.values), enumerate(metric.groups)):
        here = metric.values[group.rows & (used == str(value))]
        if len(here):
            offset = 0.0 if by_controller else width * (k - (count - 1) / 2)
            low, lower, middle, upper, high = np.quantile(here, QUANTILES).tolist()
            ends = (low, lower, middle, upper, high)
            boxes.append(Box(group.style, at + offset, 0.8 * width, ends))
    labels = tuple(map(_shorten, format_values(axis.values, shown)))
    across = (-0.6, len(axis.values) - 0.4)
    return Panel(
        metric.title,
        (),
        across,
        metric.limits,
        axis.target.name,
        shape=2.0,
        boxes=tuple(boxes),
        names=labels,
    )


def _shorten(label: str) -> str:
    if len(label) <= LONGEST_LABEL:
        return label
    return f"{label[: LONGEST_LABEL - 1]}…"


def rank_correlations(
    results: Results, values: Array, finite: Array
) -> list[tuple[str, Array, float]]:
    """Return sampled numbers with their rank correlation with a metric, the strongest first.

    Args:
        results: Results of a sweep.
        values: Values (R,) of the metric.
        finite: Mask (R,) of the runs to use.

    Returns:
        Name, values (R,) and rank correlation of each sampled quantity that is a number.
    """
    from scipy.stats import spearmanr

    found = []
    for sampled in results.plan.sampled:
        name = sampled.target.name
        varied = results.column_values(name)
        if finite.sum() < 3 or not all(isinstance(value, int | float) for value in varied):
            continue
        x = np.array(varied, dtype=float)
        correlation = 0.0
        if np.ptp(values[finite]) > 0.0:
            with np.errstate(invalid="ignore"):
                correlation = float(spearmanr(x[finite], values[finite]).statistic)
        found.append((name, x, correlation))
    return sorted(found, key=lambda one: -abs(one[2]))[:MOST_SAMPLED]


def _plot_sampled(name: str, x: Array, correlation: float, metric: _Metric) -> str:
    dots = []
    for group in metric.groups:
        dots.append(Line(group.style, x[group.rows], metric.values[group.rows], group.name))
    x_limits = axis_limits([x], zero=False)
    panel = Panel(metric.title, (), x_limits, metric.limits, name, shape=SQUARE, dots=tuple(dots))
    return figure([panel], f"{metric.title} over {name}, rank correlation {correlation:.2f}")
