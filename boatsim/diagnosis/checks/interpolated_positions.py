"""Check for positions that were interpolated over gaps: equal steps, which no instrument yields."""

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.checks.finding import MAX_LISTED, PLANAR_POSE, Finding
from boatsim.diagnosis.checks.last_digit import ROUNDED_DIGITS, decimal_step
from boatsim.diagnosis.config import ChecksConfig
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

# no log writes positions in metres with more decimals; others were computed and are not rounded
MOST_DECIMALS = 7
NOT_ROUNDED = 1e-8  # [m] resolution that then counts


def check_interpolated_positions(
    recording: Recording, _: Vessel, config: ChecksConfig
) -> list[Finding]:
    """Find positions of a recording that were interpolated over gaps of the measurement.

    They show as runs of rows with equal steps, which the noise of the other rows rules out.

    Args:
        recording: A prepared recording.
        config: Thresholds of the quality checks.

    Returns:
        At most one finding "bridged".
    """
    straight = interpolated_rows(recording, config)
    if not straight.any():
        return []
    begins, ends = _runs(straight)
    t = recording.t
    durations = t[ends] - t[begins]
    longest = np.argsort(durations)[::-1][:MAX_LISTED]
    longest = np.sort(longest)
    spans = tuple(zip(t[begins[longest]].tolist(), t[ends[longest]].tolist(), strict=True))
    evidence = (
        f"{int(straight.sum())} of {len(recording)} rows in {len(begins)} places lie on straight "
        f"lines with equal steps, exact to the last digit (longest {float(durations.max()):.3g} s)"
    )
    remedy = "these values were not measured; leave x_m, y_m and psi_rad empty in those rows"
    return [
        Finding(
            "bridged", evidence, probability=config.probability_strong, spans=spans, remedy=remedy
        )
    ]


def interpolated_rows(recording: Recording, config: ChecksConfig) -> NDArray[np.bool_]:
    """Return which rows of a recording are interpolated positions instead of measurements.

    Args:
        recording: A prepared recording.
        config: Thresholds of the quality checks.

    Returns:
        True (N,) for rows inside a run with equal steps in all noisy columns.
    """
    n = len(recording)
    rejected = np.zeros(n, dtype=np.bool_)
    columns = [recording[c] for c in PLANAR_POSE if c in recording.signals]
    complete = np.isfinite(columns).all()
    if n < config.interpolation_min_rows or len(columns) < 2 or not complete:
        return rejected
    exact, chance = _equal_steps(columns, config)
    straight = np.concatenate(([False], exact, [False]))
    for begin, end in zip(*_runs(straight), strict=True):
        rows = int(end - begin) + 1
        window = config.interpolation_window
        neighbours = np.concatenate(
            (straight[max(begin - window, 0) : begin], straight[end + 1 : end + 1 + window])
        )
        by_chance = n * chance**rows > config.interpolation_max_chance
        common = _rule_of_succession(neighbours) ** rows > config.interpolation_max_local_chance
        if rows < config.interpolation_min_run or by_chance or common:
            rejected[begin : end + 1] = True
    return straight & ~rejected


def _equal_steps(columns: list[Array], config: ChecksConfig) -> tuple[NDArray[np.bool_], float]:
    """Rows (N - 2,) with equal steps in all noisy columns, and their probability by chance.

    Columns without noise are ignored, because a smooth course has equal steps. Rows in which
    nothing changes are repeated, not interpolated.
    """
    n = len(columns[0])
    exact = np.ones(n - 2, dtype=np.bool_)
    chance = 1.0
    noisy = 0
    for values in columns:
        digit = _last_digit(values)
        if not _is_noisy(np.diff(values, 4), digit, config):
            continue
        equal = np.abs(np.diff(values, 2)) < ROUNDED_DIGITS * digit
        noisy += 1
        exact &= equal
        chance *= max(float(equal.mean()), 1.0 / n)
    if noisy < 2:
        return np.zeros(n - 2, dtype=np.bool_), chance
    moving = (np.diff(columns)[:, 1:] != 0.0).any(axis=0)
    return exact & moving, chance


def _rule_of_succession(rows: NDArray[np.bool_]) -> float:
    """Probability that a further row is true (Laplace's rule, with half a success added)."""
    return (float(rows.sum()) + 0.5) / (len(rows) + 1.0)


def _is_noisy(differences: Array, digit: float, config: ChecksConfig) -> bool:
    """Whether fourth differences (N,) are those of white noise and larger than rounding."""
    limits = np.quantile(differences, config.interpolation_noise_quantiles)
    inside = np.clip(differences, *limits)
    size = float(inside @ inside)
    if not size > 0.0:
        return False
    if not float(inside[1:] @ inside[:-1]) < config.interpolation_max_correlation * size:
        return False
    return float(np.median(np.abs(differences))) > config.interpolation_min_noise_digits * digit


def _last_digit(values: Array) -> float:
    """Resolution to which positions or headings (N,) are written."""
    return decimal_step(values, MOST_DECIMALS) or NOT_ROUNDED


def _runs(rows: NDArray[np.bool_]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """First and last rows of the runs of true rows."""
    edges = np.diff(np.concatenate(([0], rows.astype(np.int64), [0])))
    return np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1
