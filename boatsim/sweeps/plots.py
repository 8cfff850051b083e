"""Norms against what varied: lines with a band over ranges, boxes over lists, points over draws."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from boatsim.diagnosis.report.svg_plots import SQUARE, Box, Line, Panel, figure, legend, limits
from boatsim.physics.signals import Array
from boatsim.sweeps.axes import Axis
from boatsim.sweeps.results import Results
from boatsim.sweeps.summary import CONTROLLER

LOOKS = ("one", "two", "three", "four")
BELOW = (0.05, 0.25, 0.5, 0.75, 0.95)
ENDS = {0: "p5", 4: "p95"}  # those of BELOW that are lines where there are several bands
MOST = 6  # drawn quantities that a norm is shown against, those that go with it most
LETTERS = 14  # of a name below an axis


@dataclass(frozen=True)
class Group:
    """Runs of one controller, or all of them."""

    name: str
    look: str
    rows: Array  # (R,) which


def groups(results: Results, among: Array) -> list[Group]:
    """Runs by controller where several were varied, at most as many as there are looks."""
    if CONTROLLER not in results.plan.columns:
        return [Group("", LOOKS[0], among)]
    used = np.array([str(value) for value in results.varied(CONTROLLER)])
    names = list(dict.fromkeys(used.tolist()))[: len(LOOKS)]
    return [Group(n, look, among & (used == n)) for n, look in zip(names, LOOKS, strict=False)]


def legend_of(found: Sequence[Group]) -> str:
    """Which look is which controller."""
    return legend({group.look: group.name for group in found}) if len(found) > 1 else ""


def pictures(results: Results, norm: str, among: Array) -> list[str]:
    """One norm of some of the runs (R,), against every axis, and the draws that go with it most."""
    values, unit = results.norm[norm], results.units[norm]
    seen = among & np.isfinite(values)
    if not seen.any():
        return []
    y, title = limits([values[seen]], zero=False), f"{norm} [{unit}]" if unit else norm
    there = groups(results, seen)
    made = [
        _of_axis(results, axis, values, there, y, title)
        for axis in results.plan.axes
        if _told(axis, there)
    ]
    return made + [
        _of_draw(name, x, rank, values, there, y, title)
        for name, x, rank in _draws(results, values, seen)
    ]


def _told(axis: Axis, there: Sequence[Group]) -> bool:
    """Whether an axis is worth a picture: controllers are told by their looks, unless nothing else is there."""
    return len(axis.values) > 1 and (axis.target.name != CONTROLLER or len(there) > 1)


def _of_axis(
    results: Results,
    axis: Axis,
    values: Array,
    there: Sequence[Group],
    y: tuple[float, float],
    title: str,
) -> str:
    name = axis.target.name
    taken = results.varied(name)
    if not axis.ranged:
        return figure([_boxes(axis, taken, values, there, y, title)], f"{title} by {name}")
    lines: list[Line] = []
    band = None
    for group in there:
        x, spread = _along(axis, taken, values, group.rows)
        ends = [
            Line(f"{group.look} end", x, spread[k], f"{group.name} {ENDS[k]}")
            for k in ENDS
            if len(there) > 1
        ]
        lines += [Line(group.look, x, spread[2], group.name or "median"), *ends]
        band = (x, spread[0], spread[4]) if len(there) == 1 else None
    across = float(min(axis.values)), float(max(axis.values))
    return figure(
        [Panel(title, tuple(lines), across, y, name, band, shape=2.0)], f"{title} over {name}"
    )


def _along(axis: Axis, taken: Sequence[Any], values: Array, rows: Array) -> tuple[Array, Array]:
    """Values of an axis, and (5, X) what 5, 25, 50, 75 and 95 % of the runs there lie below."""
    numbers = np.array(taken, dtype=float)
    x = np.array(sorted(float(v) for v in axis.values))
    spread = [
        np.quantile(v, BELOW) if len(v := values[rows & (numbers == at)]) else np.full(5, np.nan)
        for at in x
    ]
    return x, np.array(spread).T


def _boxes(
    axis: Axis,
    taken: Sequence[Any],
    values: Array,
    there: Sequence[Group],
    y: tuple[float, float],
    title: str,
) -> Panel:
    """A box for each value of a list, of several controllers side by side."""
    own = axis.target.name == CONTROLLER
    used, width = np.array([str(v) for v in taken]), 0.7 if own else 0.7 / len(there)
    made = []
    for at, value in enumerate(axis.values):
        for k, group in enumerate(there):
            rows = values[group.rows & (used == str(value))]
            if len(rows):
                place = at if own else at + width * (k - (len(there) - 1) / 2)
                low, lower, half, upper, high = np.quantile(rows, BELOW).tolist()
                made.append(Box(group.look, place, 0.8 * width, (low, lower, half, upper, high)))
    names = tuple(
        str(v) if len(str(v)) <= LETTERS else f"{str(v)[: LETTERS - 1]}…" for v in axis.values
    )
    across = (-0.6, len(axis.values) - 0.4)
    return Panel(title, (), across, y, axis.target.name, shape=2.0, boxes=tuple(made), names=names)


def _draws(results: Results, values: Array, seen: Array) -> list[tuple[str, Array, float]]:
    """Drawn numbers (R,) with their rank correlation with a norm, the strongest first."""
    from scipy.stats import spearmanr

    found = []
    for draw in results.plan.draws:
        taken = results.varied(draw.target.name)
        if all(isinstance(v, int | float) for v in taken) and seen.sum() > 2:
            x = np.array(taken, dtype=float)
            with np.errstate(invalid="ignore"):
                rank = (
                    0.0
                    if np.ptp(values[seen]) == 0.0
                    else float(spearmanr(x[seen], values[seen]).statistic)
                )
            found.append((draw.target.name, x, rank))
    return sorted(found, key=lambda one: -abs(one[2]))[:MOST]


def _of_draw(
    name: str,
    x: Array,
    rank: float,
    values: Array,
    there: Sequence[Group],
    y: tuple[float, float],
    title: str,
) -> str:
    dots = tuple(Line(group.look, x[group.rows], values[group.rows], group.name) for group in there)
    panel = Panel(title, (), limits([x], zero=False), y, name, shape=SQUARE, dots=dots)
    return figure([panel], f"{title} over {name}, rank correlation {rank:.2f}")
