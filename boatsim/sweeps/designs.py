"""Sampling designs: random, Latin hypercube, and Saltelli's design for sensitivity indices.

A design is an array (N, D) of probabilities between 0 and 1, a row for each run of a grid point and
a column for each sampled quantity. Random and Latin columns depend only on the seed and on the name
of their quantity, so that a further quantity leaves the other columns unchanged.
"""

from collections.abc import Sequence
from typing import Literal
from zlib import crc32

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.signals import Array

Design = Literal["random", "latin", "sobol"]


def sampling_design(design: Design, names: Sequence[str], runs: int, seed: int) -> Array:
    """Return the sampling design of a sweep: probabilities (N, D) for N samples of D quantities.

    A value of a quantity is the quantile of its distribution at such a probability.

    Args:
        design: Sampling design.
        names: Names of the D quantities.
        runs: Number of samples; of Saltelli's design rows of one block.
        seed: Random seed.

    Returns:
        Array (N, D); N is `runs`, or `runs` (D + 2) of Saltelli's design.

    Raises:
        BadInput: Saltelli's design does not allow these numbers of runs or quantities.
    """
    if design == "sobol":
        return _saltelli(len(names), runs, seed)
    if not names:
        return np.empty((runs, 0))
    return np.column_stack([_probability_column(design, name, runs, seed) for name in names])


def _probability_column(design: Design, name: str, runs: int, seed: int) -> Array:
    rng = np.random.default_rng([seed, crc32(name.encode())])
    if design == "random":
        return rng.random(runs)
    from scipy.stats import qmc

    column: Array = qmc.LatinHypercube(1, rng=rng).random(runs)[:, 0]
    return column


def _saltelli(count: int, runs: int, seed: int) -> Array:
    """Rows of A, of B, and for each quantity of A with its column from B (Saltelli et al. 2010)."""
    if count < 2:
        raise BadInput(f"--sobol needs two sampled quantities (--draw) or more, not {count}")
    if runs < 2 or runs & (runs - 1):
        below = 1 << max(runs.bit_length() - 1, 1)
        raise BadInput(
            f"--sobol --runs {runs}: allowed are powers of two, such as {below} or {2 * below}"
        )
    from scipy.stats import qmc

    both = qmc.Sobol(2 * count, rng=np.random.default_rng([seed, count])).random(runs)
    first, second = both[:, :count], both[:, count:]
    mixed = [np.where(np.arange(count) == k, second, first) for k in range(count)]
    return np.concatenate([first, second, *mixed])


def noise_seed(design: Design, seed: int, number: int) -> int:
    """Return the seed of the sensor noise of a run of a sweep; it is the same at every grid point.

    It differs between samples, except in Saltelli's design, which compares runs that differ in one
    quantity only.

    Args:
        design: Sampling design.
        seed: Random seed of the sweep.
        number: Number of the sample.
    """
    if design == "sobol":
        number = 0
    return int(np.random.SeedSequence([seed, number]).generate_state(1)[0])
