"""Sobol sensitivity indices of metrics, from Saltelli's design, with bootstrap intervals.

The first-order index (Saltelli et al. 2010) is the share of a metric's variance that one quantity
explains alone. The total index (Jansen 1999) is the share that would remain if all other quantities
were known. The estimators are those of `scipy.stats.sobol_indices`, which however accepts only a
power of two of rows and so cannot be used where rows with a missing metric are left out, nor on the
bootstrap samples with the random numbers that published intervals are based on.
"""

from typing import NamedTuple

import numpy as np

from boatsim.physics.signals import Array
from boatsim.sweeps.keys import Value
from boatsim.sweeps.results import Results

RESAMPLES = 400  # of the bootstrap; the ends of a 95 % interval then vary by a few per cent
LOW, HIGH = 0.025, 0.975  # quantiles of the bootstrap that bound the 95 % interval


class Index(NamedTuple):
    """Sobol sensitivity indices of one metric to one sampled quantity at one grid point of a sweep.

    Attributes:
        point: Values of the grid point.
        norm: Name of the metric.
        quantity: Key of the sampled quantity.
        rows: Rows of the design in which all runs have the metric.
        first: First-order index.
        first_low: Lower end of its 95 % interval.
        first_high: Upper end of its 95 % interval.
        total: Total index.
        total_low: Lower end of its 95 % interval.
        total_high: Upper end of its 95 % interval.
    """

    point: tuple[Value, ...]
    norm: str
    quantity: str
    rows: int
    first: float
    first_low: float
    first_high: float
    total: float
    total_low: float
    total_high: float


def sobol_indices(blocks: Array) -> tuple[Array, Array]:
    """Return the Sobol indices of a metric, first-order and total, (D,) each.

    They are nan where the values do not vary.

    Args:
        blocks: Values (D + 2, N) of a metric in the order of the design: A, B, then for each
            quantity A with its column from B.
    """
    a, b, mixed = blocks[0], blocks[1], blocks[2:]
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = blocks[:2].mean()
        variance = blocks[:2].var()
        first = ((b - mean) * (mixed - a)).mean(axis=1) / variance
        total = 0.5 * ((a - mixed) ** 2).mean(axis=1) / variance
    return first, total


def bootstrap_intervals(blocks: Array, seed: int) -> tuple[Array, Array]:
    """Return 95 % bootstrap intervals (2, D) of first-order and of total Sobol indices.

    Args:
        blocks: Values (D + 2, N), as of `sobol_indices`; rows of the design are resampled.
        seed: Random seed.
    """
    rng = np.random.default_rng(seed)
    rows = blocks.shape[1]
    samples = [sobol_indices(blocks[:, rng.integers(0, rows, rows)]) for _ in range(RESAMPLES)]
    first, total = np.quantile(np.array(samples), (LOW, HIGH), axis=0).transpose(1, 0, 2)
    return first, total


def sensitivity_indices(results: Results) -> list[Index]:
    """Return the Sobol indices of every metric at every grid point of a sweep.

    Args:
        results: Results of a sweep.

    Returns:
        The indices; none if the sweep is not complete or not of Saltelli's design.
    """
    plan = results.plan
    if plan.design != "sobol" or len(results.run_numbers) < plan.run_count:
        return []
    names = [sampled.target.name for sampled in plan.sampled]
    found: list[Index] = []
    for number in range(len(plan.points)):
        point = plan.point_values(number)
        rows = results.point_numbers == number
        for metric in results.displayed_metrics:
            blocks = results.metrics[metric][rows].reshape(len(names) + 2, plan.runs)
            blocks = blocks[:, np.isfinite(blocks).all(axis=0)]
            count = blocks.shape[1]
            if count < 2 or np.ptp(blocks) == 0.0:
                continue
            first, total = sobol_indices(blocks)
            first_ends, total_ends = bootstrap_intervals(blocks, plan.seed)
            table = np.stack([first, *first_ends, total, *total_ends], axis=1)
            for name, row in zip(names, table.tolist(), strict=True):
                found.append(Index(point, metric, name, count, *row))
    return found
