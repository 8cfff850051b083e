"""The functions of a program that its C library offers to Python, with kinds of arguments."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from boatsim.physics.kernel import records
from boatsim.physics.native.kinds import CUBE, MATRIX, REAL, ROWS, TRUTH, VECTOR, WHOLE, Kind
from boatsim.physics.signals import OscillatingForce


class Entry(NamedTuple):
    """A function of the library: its arguments, and what makes its result of its numbers."""

    arguments: Sequence[Any]  # kinds, and types of named tuples
    result: Callable[..., Any] | None = None


def number(x: float) -> float:
    """Return the only number of a result."""
    return x


def numbers(*x: float) -> tuple[float, ...]:
    """Return the numbers of a result as a tuple."""
    return x


# Kinds of the entries of named tuples of `kernel.records`
RECORDS: Mapping[Any, Sequence[Kind]] = {
    records.VesselNumbers: (VECTOR, VECTOR, VECTOR),
    records.Inputs: (VECTOR, VECTOR, MATRIX),
    records.Measurements: (MATRIX, ROWS, VECTOR),
    records.LatentForce: (VECTOR, REAL, VECTOR),
    records.FilterStart: (VECTOR, MATRIX, VECTOR),
    records.PassOptions: (REAL, TRUTH, TRUTH, TRUTH),
    records.PassArrays: (CUBE, VECTOR, CUBE, MATRIX, MATRIX),
    records.FilterHistory: (MATRIX, CUBE, CUBE, MATRIX),
}
ENTRIES: Mapping[str, Entry] = {
    "compute_mass_constants": Entry((VECTOR, VECTOR, VECTOR, VECTOR)),
    "advance_actuators": Entry((VECTOR, VECTOR, REAL, VECTOR, VECTOR, VECTOR)),
    "settle_actuators": Entry((VECTOR, VECTOR, VECTOR, VECTOR, VECTOR)),
    "water_velocity": Entry((VECTOR, VECTOR), numbers),
    "oscillating_force": Entry((VECTOR, VECTOR), OscillatingForce),
    "total_body_force": Entry((REAL, VECTOR, VECTOR, WHOLE, VECTOR, VECTOR), numbers),
    "acceleration_jacobian": Entry(
        (REAL, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR, MATRIX),
    ),
    "kalman_filter": Entry(
        (
            records.Inputs,
            records.Measurements,
            records.VesselNumbers,
            records.LatentForce,
            records.FilterStart,
            records.PassOptions,
            records.PassArrays,
            records.FilterHistory,
        ),
        number,
    ),
    "smooth_states": Entry(
        (records.FilterHistory, CUBE, VECTOR, records.LatentForce, VECTOR, VECTOR)
    ),
    "simulate_intervals": Entry(
        (records.Inputs, REAL, records.VesselNumbers, ROWS, ROWS, MATRIX, CUBE)
    ),
}
