"""Which draws are made: at random, as a Latin hypercube, or as Saltelli's design for sensitivity indices.

A design is (N, D) shares between 0 and 1, a row for each run of a grid point, a column for each quantity. Random and
Latin columns depend on the seed and on their own name alone, so that a further quantity leaves the others as they were.
"""

from collections.abc import Sequence
from typing import Literal
from zlib import crc32

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.signals import Array

Kind = Literal["random", "latin", "sobol"]


def shares(kind: Kind, names: Sequence[str], runs: int, seed: int) -> Array:
    """(N, D), N = runs, or runs (D + 2) of Saltelli's design. Raises BadInput."""
    if kind == "sobol":
        return _saltelli(len(names), runs, seed)
    columns = [
        _column(kind, np.random.default_rng([seed, crc32(name.encode())]), runs) for name in names
    ]
    return np.column_stack(columns) if columns else np.empty((runs, 0))


def _column(kind: Kind, rng: np.random.Generator, runs: int) -> Array:
    if kind == "random":
        return rng.random(runs)
    from scipy.stats import qmc

    found: Array = qmc.LatinHypercube(1, rng=rng).random(runs)[:, 0]
    return found


def _saltelli(count: int, runs: int, seed: int) -> Array:
    """Rows of A, then of B, then for each quantity those of A with its column from B (Saltelli et al. 2010)."""
    if count < 2:
        raise BadInput(
            f"--sobol tells apart drawn quantities; it needs two --draw or more, not {count}"
        )
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


def seed_of(kind: Kind, seed: int, number: int) -> int:
    """Seed of a run's noise: the same at every grid point, another for each draw.

    Saltelli's design compares runs that differ in one quantity: there all have the same noise.
    """
    return int(
        np.random.SeedSequence([seed, 0 if kind == "sobol" else number]).generate_state(1)[0]
    )
