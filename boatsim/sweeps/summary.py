"""Statistics of a sweep: spread of each metric, and controllers compared on the same samples."""

from collections.abc import Sequence
from math import nan, sqrt
from typing import NamedTuple

import numpy as np

from boatsim.physics.signals import Array
from boatsim.sweeps.keys import Value
from boatsim.sweeps.results import Results

CONTROLLER = "controller.use"
# Standard errors on either side of a mean that hold 95 % of a normal distribution.
TWO_SIDED_95 = 1.96


class Spread(NamedTuple):
    """Mean and quantiles of one metric over the runs at one grid point of a sweep.

    Attributes:
        point: Values of the grid point.
        norm: Name of the metric.
        unit: Its unit.
        runs: Number of runs.
        failed: Number of runs that failed.
        reached: Number of runs in which the metric has a value.
        mean: Mean of the values.
        p5: 5 % quantile.
        p50: Median.
        p95: 95 % quantile.
    """

    point: tuple[Value, ...]
    norm: str
    unit: str
    runs: int
    failed: int
    reached: int
    mean: float
    p5: float
    p50: float
    p95: float


class Pair(NamedTuple):
    """Comparison of one metric of two controllers on the same random samples of a sweep.

    Only runs in which both controllers have a value count.

    Attributes:
        point: Values of the grid point, without the controller.
        norm: Name of the metric, |name| if it takes both signs and its absolute value is compared.
        unit: Its unit.
        first: First controller.
        second: Second controller.
        pairs: Number of pairs of runs.
        of_first: Mean of the first controller.
        of_second: Mean of the second controller.
        difference: Mean of second minus first.
        sure: Half-width of the 95 % confidence interval of the difference.
        first_lower: Share of the pairs in which the first controller has the lower value.
        second_lower: Share of the pairs in which the second controller has the lower value.
    """

    point: tuple[Value, ...]
    norm: str
    unit: str
    first: str
    second: str
    pairs: int
    of_first: float
    of_second: float
    difference: float
    sure: float
    first_lower: float
    second_lower: float


def metric_statistics(results: Results) -> list[Spread]:
    """Return mean and quantiles of every metric at every grid point of a sweep where it has values.

    Args:
        results: Results of a sweep.
    """
    found: list[Spread] = []
    for point, rows in _points_with_runs(results):
        failed = int(results.failed_mask[rows].sum())
        runs = int(rows.sum())
        for name in results.displayed_metrics:
            values = results.metrics[name][rows]
            values = values[np.isfinite(values)]
            if len(values):
                quantiles = np.quantile(values, (0.05, 0.5, 0.95)).tolist()
                counts = (runs, failed, len(values))
                mean = float(values.mean())
                found.append(Spread(point, name, results.units[name], *counts, mean, *quantiles))
    return found


def compare_controllers(results: Results) -> list[Pair]:
    """Compare the metrics of each controller of a sweep with those of the first, sample by sample.

    Args:
        results: Results of a sweep.

    Returns:
        The comparisons; none if the controller was not varied.
    """
    names = results.plan.differing_columns
    if CONTROLLER not in names:
        return []
    column = names.index(CONTROLLER)
    rows_of = dict(_points_with_runs(results))
    controllers = list(dict.fromkeys(point[column] for point in rows_of))
    found: list[Pair] = []
    for point, rows in rows_of.items():
        if point[column] != controllers[0]:
            continue
        before, after = point[:column], point[column + 1 :]
        for other in controllers[1:]:
            other_rows = rows_of.get((*before, other, *after))
            if other_rows is not None:
                steered = (str(controllers[0]), str(other))
                found += _compare_pair(results, (rows, other_rows), steered, (*before, *after))
    return found


def _compare_pair(
    results: Results, rows: tuple[Array, Array], names: tuple[str, str], point: tuple[Value, ...]
) -> list[Pair]:
    """Comparison of every metric that both controllers have."""
    found: list[Pair] = []
    samples = results.sample_numbers[rows[0]], results.sample_numbers[rows[1]]
    _, first_index, second_index = np.intersect1d(*samples, return_indices=True)
    for name in results.displayed_metrics:
        values = results.metrics[name]
        first = values[rows[0]][first_index]
        second = values[rows[1]][second_index]
        both = np.isfinite(first) & np.isfinite(second)
        if not both.any():
            continue
        first, second = first[both], second[both]
        label = name
        if np.any(first < 0.0) or np.any(second < 0.0):
            first, second = np.abs(first), np.abs(second)
            label = f"|{name}|"
        difference = second - first
        count = len(difference)
        half_width = nan
        if count > 1:
            half_width = TWO_SIDED_95 * float(difference.std(ddof=1)) / sqrt(count)
        pair = Pair(
            point,
            label,
            results.units[name],
            *names,
            pairs=count,
            of_first=float(first.mean()),
            of_second=float(second.mean()),
            difference=float(difference.mean()),
            sure=half_width,
            first_lower=float((first < second).mean()),
            second_lower=float((second < first).mean()),
        )
        found.append(pair)
    return found


def _points_with_runs(results: Results) -> Sequence[tuple[tuple[Value, ...], Array]]:
    """Grid points that have runs, each with the mask (R,) of its runs."""
    found = []
    for number in range(len(results.plan.points)):
        rows = results.point_numbers == number
        if rows.any():
            found.append((results.plan.point_values(number), rows))
    return found
