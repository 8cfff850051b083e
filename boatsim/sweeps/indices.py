"""Which drawn quantity makes a norm spread: Sobol indices from Saltelli's design, with a bootstrap spread.

First order (Saltelli et al. 2010): the share of a norm's variance that goes with one quantity alone; total (Jansen
1999): the share that would be left if all the others were known.
"""

from typing import NamedTuple

import numpy as np

from boatsim.physics.signals import Array
from boatsim.sweeps.keys import Value
from boatsim.sweeps.results import Results

RESAMPLES = 400
LOW, HIGH = 0.025, 0.975  # of the bootstrap


class Index(NamedTuple):
    """One quantity's part in the variance of one norm at one grid point."""

    point: tuple[Value, ...]
    norm: str
    quantity: str
    rows: int  # of the design, of those in which all runs have the norm
    first: float
    first_low: float  # 95 % interval
    first_high: float
    total: float
    total_low: float
    total_high: float


def sobol(blocks: Array) -> tuple[Array, Array]:
    """First-order and total indices (D,) of values (D + 2, N) in the order of the design: A, B, then A with B's column.

    nan where the values do not vary.
    """
    a, b, mixed = blocks[0], blocks[1], blocks[2:]
    with np.errstate(invalid="ignore", divide="ignore"):
        middle, variance = blocks[:2].mean(), blocks[:2].var()
        first = ((b - middle) * (mixed - a)).mean(axis=1) / variance
        total = 0.5 * ((a - mixed) ** 2).mean(axis=1) / variance
    return first, total


def bootstrap(blocks: Array, seed: int) -> tuple[Array, Array]:
    """(2, D) each: 95 % intervals of first-order and of total indices, rows of the design drawn anew."""
    rng, rows = np.random.default_rng(seed), blocks.shape[1]
    drawn = [sobol(blocks[:, rng.integers(0, rows, rows)]) for _ in range(RESAMPLES)]
    first, total = (
        np.quantile(np.array(part), (LOW, HIGH), axis=0) for part in zip(*drawn, strict=True)
    )
    return first, total


def indices(results: Results) -> list[Index]:
    """Of every norm at every grid point, as far as its runs are done; nothing of another design than Saltelli's."""
    plan = results.plan
    if plan.kind != "sobol" or len(results.numbers) < plan.count:
        return []
    names, found = [draw.target.name for draw in plan.draws], list[Index]()
    for number in range(len(plan.points)):
        point = plan.point(number)
        for norm in results.told:
            blocks = results.norm[norm][results.point == number].reshape(len(names) + 2, plan.runs)
            whole = blocks[:, np.isfinite(blocks).all(axis=0)]
            if whole.shape[1] < 2 or np.ptp(whole) == 0.0:
                continue
            first, total = sobol(whole)
            of_first, of_total = bootstrap(whole, plan.seed)
            for k, name in enumerate(names):
                ends = first[k], *of_first[:, k], total[k], *of_total[:, k]
                found.append(Index(point, norm, name, whole.shape[1], *map(float, ends)))
    return found
