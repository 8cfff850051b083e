"""Values that a logger interpolated between the samples of slower sensors.

A log on a common clock is often resampled by linear interpolation. The values between two samples
lie on a straight line and are no measurements of their own. If they were used, the noise would seem
far smaller than it is, and the vessel would seem to accelerate in steps.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.checks.last_digit import ROUNDED_DIGITS, decimal_step
from boatsim.diagnosis.checks.repeated_values import FIXES
from boatsim.diagnosis.config import DEFAULT, ChecksConfig
from boatsim.physics.base import Array
from boatsim.physics.recorded_channels import INSTRUMENT_CHANNELS
from boatsim.recordings.table import Recording
from boatsim.recordings.units import DEGREES

# phrase in the remark, by which the finding recognizes it
INTERPOLATED = "lie on straight lines between samples"
COMPUTED = 1e-9  # relative resolution of values that were converted, such as degrees to metres
MOST_DECIMALS = 9  # down to that resolution, for values of about 1


def drop_interpolated_samples(
    recording: Recording, config: ChecksConfig = DEFAULT.checks
) -> Recording:
    """Return a recording in which values that were interpolated between samples are nan.

    Args:
        recording: A prepared recording.
        config: Thresholds of the quality checks.

    Returns:
        The recording; a remark counts the values that are not used.
    """
    signals = dict(recording.signals)
    words = list[str]()
    for names in _sensors():
        present = [name for name in names if name in signals]
        if not present or not all(np.isfinite(signals[name]).any() for name in present):
            continue
        rows = interpolated_rows([signals[name] for name in present], config)
        if rows.any():
            signals |= {name: np.where(rows, np.nan, signals[name]) for name in present}
            words.append(f"{', '.join(present)} in {int(rows.sum())}")
    if not words:
        return recording
    remark = (
        f"{recording.origin}: values {INTERPOLATED}, exact to the last digit, and "
        f"are not used: {'; '.join(words)} of {len(recording)} rows"
    )
    return replace(recording, signals=signals, remarks=(*recording.remarks, remark))


def _sensors() -> list[tuple[str, ...]]:
    """Columns that one sensor measures together."""
    found = list(FIXES)
    taken = {name for names in FIXES for name in names}
    for channel in INSTRUMENT_CHANNELS:
        if channel.column not in taken:
            found.append((channel.column,))
    return found


def interpolated_rows(columns: list[Array], config: ChecksConfig) -> NDArray[np.bool_]:
    """Return the rows whose values were interpolated linearly between samples of one sensor.

    A series counts as interpolated if a large share of its rows lies exactly on the straight line
    between its neighbours, in many short runs, although the rows between these runs deviate from
    such lines by many digits. Where a line breaks between two rows, one of them counts as a sample.

    Args:
        columns: Values (N,) of the sensor; nan where it was not measured.
        config: Thresholds of the quality checks.

    Returns:
        True (N,) for interpolated rows.
    """
    count = len(columns[0])
    rows = np.zeros(count, dtype=np.bool_)
    known = np.flatnonzero(np.isfinite(columns).all(axis=0))
    if len(known) < config.interpolation_min_rows:
        return rows
    straight = np.ones(len(known) - 2, dtype=np.bool_)
    still = straight.copy()
    for values in columns:
        exact, is_sharp = _on_straight_lines(values[known], config)
        if not is_sharp:
            return rows
        straight &= exact
        still &= np.diff(values[known], 2) == 0.0
        still &= np.diff(values[known])[1:] == 0.0
    adjacent = np.diff(known) == 1  # no line leads across a gap
    straight &= adjacent[1:] & adjacent[:-1]
    lengths = _run_lengths(straight & ~still)
    enough = lengths.sum() >= config.interpolation_min_share * len(straight)
    if len(lengths) < config.interpolation_min_runs or not enough:
        return rows
    if lengths.max() > config.interpolation_max_run_ratio * np.median(lengths):
        return rows
    rows[known[1:-1][straight | _second_of_two(straight)]] = True
    return rows


def _on_straight_lines(values: Array, config: ChecksConfig) -> tuple[NDArray[np.bool_], bool]:
    """Inner rows (N - 2,) on the line between their neighbours, and whether chance is excluded."""
    digit = _last_digit(values)
    bend = np.abs(np.diff(values, 2))
    exact = bend < ROUNDED_DIGITS * digit
    if exact.all():
        return exact, False
    is_sharp = float(np.median(bend[~exact])) > config.interpolation_min_bend * digit
    return exact, is_sharp


def _last_digit(values: Array) -> float:
    """Resolution to which values (N,) are written; angles may be written in degrees, or wrapped."""
    largest = float(np.abs(values).max())
    coarsest = COMPUTED * max(largest, 1e-3)
    for scale in (1.0, DEGREES):
        for begin in (None, 0.0, -np.pi):
            shown = values
            if begin is not None:
                shown = np.remainder(values - begin, 2.0 * np.pi) + begin
            coarsest = max(coarsest, decimal_step(scale * shown, MOST_DECIMALS) / scale)
    return coarsest


def _run_lengths(rows: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Lengths of the runs of true rows."""
    edges = np.diff(np.concatenate(([0], rows.astype(np.int64), [0])))
    return np.flatnonzero(edges == -1) - np.flatnonzero(edges == 1)


def _second_of_two(straight: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return every second one of neighbouring rows at which lines break; both are of one sample."""
    second = np.zeros(len(straight), dtype=np.bool_)
    for k in np.flatnonzero(~straight).tolist():
        second[k] = k > 0 and not straight[k - 1] and not second[k - 1]
    return second
