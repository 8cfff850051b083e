"""Values of a column of a recording by its entry in the map."""

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.recordings.conversion import Allocation, Curve, Range
from boatsim.recordings.importing.conversion_state import ConversionState, signal_of
from boatsim.recordings.importing.resample import clean_samples
from boatsim.recordings.importing.waves import WaveProbes, wave_at
from boatsim.recordings.table import FEWEST_ROWS

UNEQUAL = 0.1  # share of a step by which the steps of wave probes may differ


def column_values(
    work: ConversionState, name: str, what: str | Range | Curve | Allocation
) -> tuple[Array, Array]:
    """Return times (N,) [s] and values (N,) of a column.

    Args:
        work: State of the conversion, which gets remarks.
        name: Name of the column.
        what: Its entry in the map.

    Raises:
        BadInput: An expression is wrong, or the log has no such signal.
    """
    if isinstance(what, Allocation):
        t, values = _sum_of_terms(work, name, what)
    else:
        t, values = _term(work, name, f"columns.{name}", what)
    if isinstance(what, Allocation):
        _remark_limits(work, f"{name}: the sum of its terms", "samples", values, what)
        return t, what.convert(values)
    return t, values


def wave_values(work: ConversionState, name: str, given: WaveProbes) -> tuple[Array, Array]:
    """Return times (N,) [s] and elevation (N,) [m] of the wave at the hull.

    Args:
        work: State of the conversion.
        name: Name of the column.
        given: Probes of the wave.

    Raises:
        BadInput: The probes have different times or unequal steps.
    """
    where = f"waves.{name}.probes"
    signals = [signal_of(work, where, text) for text in given.probes]
    t = signals[0][0].t
    measured = np.isfinite(t)
    elevations = []
    for signal, how in signals:
        if not np.array_equal(signal.t, t, equal_nan=True):
            raise BadInput(f"{work.file}: {where}: allowed are probes with the same times")
        elevations.append(how.convert(signal.values))
        measured &= np.isfinite(elevations[-1])
    t = t[measured]
    steps = np.diff(t)
    if len(t) < FEWEST_ROWS or not np.ptp(steps) < UNEQUAL * float(np.median(steps)):
        raise BadInput(
            f"{work.file}: {where}: allowed are at least {FEWEST_ROWS} samples at equal steps of "
            "time"
        )
    step = float(np.median(steps))
    return t, wave_at(step, [values[measured] for values in elevations], given)


def _term(
    work: ConversionState, name: str, key: str, what: str | Range | Curve
) -> tuple[Array, Array]:
    """Times (N,) [s] and values (N,) of one signal and its conversion."""
    if isinstance(what, str):
        signal, how = signal_of(work, key, what)
        return signal.t, how.convert(signal.values)
    signal, how = signal_of(work, f"{key}.signal", what.signal)
    values = how.convert(signal.values)
    _remark_limits(work, name, f"samples of {what.signal}", values, what)
    return signal.t, what.convert(values)


def _remark_limits(
    work: ConversionState, name: str, samples: str, values: Array, what: Range | Curve | Allocation
) -> None:
    lowest, highest = what.unclipped_range
    if beyond := int(np.sum((values < lowest) | (values > highest))):
        work.remark(
            f"{name}: {beyond} of {len(values)} {samples} are outside {lowest:g} to {highest:g}, "
            "where the map ends, and are set to the limit"
        )


def _sum_of_terms(work: ConversionState, name: str, what: Allocation) -> tuple[Array, Array]:
    """Times (N,) [s] and the sum (N,) of terms; each holds its value until its next sample."""
    terms = []
    for i, term in enumerate(what.sum):
        terms.append(_term(work, name, f"columns.{name}.sum[{i}]", term))
    t = terms[0][0]
    if all(len(other) == len(t) and np.array_equal(other, t, equal_nan=True) for other, _ in terms):
        return t, np.asarray(np.sum([values for _, values in terms], axis=0))
    samples = [clean_samples(*term) for term in terms]
    rows = np.unique(np.concatenate([one.t for one in samples]))
    total = np.zeros(len(rows))
    for one in samples:
        last = np.searchsorted(one.t, rows, side="right") - 1
        total += np.where(last >= 0, one.values[last], np.nan)
    return rows, total
