"""What the runs of a sweep say together: spread of each norm at each grid point, and controllers compared in pairs."""

from collections.abc import Sequence
from math import sqrt
from typing import NamedTuple

import numpy as np

from boatsim.physics.signals import Array
from boatsim.sweeps.keys import Value
from boatsim.sweeps.results import Results

CONTROLLER = "controller.use"
SURE = 1.96  # standard errors about a mean within which 95 % lie


class Spread(NamedTuple):
    """One norm at one grid point."""

    point: tuple[Value, ...]
    norm: str
    unit: str
    runs: int
    failed: int  # of these
    reached: int  # runs in which it has a value
    mean: float
    p5: float
    p50: float
    p95: float


class Pair(NamedTuple):
    """One norm of two controllers on the same boats, runs in which both have a value."""

    point: tuple[Value, ...]  # all that was varied beside the controller
    norm: str  # |norm| where it takes either sign: its size counts
    unit: str
    first: str
    second: str
    pairs: int
    of_first: float  # mean
    of_second: float
    difference: float  # mean of second minus first
    sure: (
        float  # half the width of the interval about it that holds the true mean in 95 % of sweeps
    )
    first_lower: float  # share of the pairs
    second_lower: float


def spreads(results: Results) -> list[Spread]:
    """Every norm at every grid point, those that no run of the point has left out."""
    found: list[Spread] = []
    norms = {name: results.norm[name] for name in results.told}
    for point, rows in _points(results):
        failed = int(results.failed[rows].sum())
        for name, values in norms.items():
            there = values[rows][np.isfinite(values[rows])]
            if len(there):
                low, middle, high = np.quantile(there, (0.05, 0.5, 0.95)).tolist()
                counts = (int(rows.sum()), failed, len(there))
                found.append(
                    Spread(
                        point,
                        name,
                        results.units[name],
                        *counts,
                        float(there.mean()),
                        low,
                        middle,
                        high,
                    )
                )
    return found


def pairs(results: Results) -> list[Pair]:
    """Controllers against the first one that was named, where several were varied, draw by draw."""
    names = results.plan.differ
    if CONTROLLER not in names:
        return []
    at = names.index(CONTROLLER)
    rows_of = dict(_points(results))
    steered = list(dict.fromkeys(point[at] for point in rows_of))
    found: list[Pair] = []
    for point, rows in rows_of.items():
        if point[at] != steered[0]:
            continue
        for other in steered[1:]:
            beside = rows_of.get((*point[:at], other, *point[at + 1 :]))
            if beside is not None:
                found += _paired(
                    results,
                    (rows, beside),
                    (str(steered[0]), str(other)),
                    (*point[:at], *point[at + 1 :]),
                )
    return found


def _paired(
    results: Results, rows: tuple[Array, Array], names: tuple[str, str], point: tuple[Value, ...]
) -> list[Pair]:
    """Every norm that both have."""
    found: list[Pair] = []
    common, one, other = np.intersect1d(*(results.draw[r] for r in rows), return_indices=True)
    for name in results.told:
        unit, values = results.units[name], results.norm[name]
        first, second = values[rows[0]][one], values[rows[1]][other]
        both = np.isfinite(first) & np.isfinite(second)
        if not both.any():
            continue
        first, second = first[both], second[both]
        signed = bool((np.concatenate([first, second]) < 0.0).any())
        if signed:
            first, second = np.abs(first), np.abs(second)
        off = second - first
        sure = SURE * float(off.std(ddof=1)) / sqrt(len(off)) if len(off) > 1 else float("nan")
        shares = float((first < second).mean()), float((second < first).mean())
        means = float(first.mean()), float(second.mean()), float(off.mean())
        told = f"|{name}|" if signed else name
        found.append(Pair(point, told, unit, *names, len(off), *means, sure, *shares))
    return found


def _points(results: Results) -> Sequence[tuple[tuple[Value, ...], Array]]:
    """Grid points that have runs, and which runs (R,) are theirs."""
    found = []
    for number in range(len(results.plan.points)):
        rows = results.point == number
        if rows.any():
            found.append((results.plan.point(number), rows))
    return found
