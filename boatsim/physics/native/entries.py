"""The functions of a program that its C libraries offer to Python, with kinds of arguments."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from boatsim.physics.kernel import records
from boatsim.physics.native.kinds import CUBE, MATRIX, REAL, ROWS, TRUTH, VECTOR, WHOLE, Kind
from boatsim.physics.signals import OscillatingForce


class Entry(NamedTuple):
    """A function of a library: its arguments, and what makes its result of its numbers.

    The result is `float` for one number, and None if the function returns nothing.
    """

    arguments: Sequence[Any]  # kinds, and types of named tuples
    result: Callable[..., Any] | None = None


def tuple_of_numbers(*x: float) -> tuple[float, ...]:
    """Return the numbers of a C function's result as a tuple."""
    return x


# Kinds of the entries of named tuples of `kernel.records`
RECORDS: Mapping[Any, Sequence[Kind]] = {
    records.VesselNumbers: (VECTOR, VECTOR, VECTOR),
    records.VesselState: (VECTOR, VECTOR, VECTOR, VECTOR),
    records.FleetArrays: (VECTOR, *[MATRIX] * 5, VECTOR, MATRIX, VECTOR),
    records.StepRecord: (ROWS, ROWS, ROWS, *[MATRIX] * 5),
    records.Inputs: (VECTOR, VECTOR, MATRIX),
    records.Measurements: (MATRIX, ROWS, VECTOR),
    records.LatentForce: (VECTOR, REAL, VECTOR),
    records.InitialState: (VECTOR, MATRIX, VECTOR),
    records.PassOptions: (REAL, TRUTH, TRUTH, TRUTH),
    records.PassArrays: (CUBE, VECTOR, CUBE, MATRIX, MATRIX),
    records.FilterHistory: (MATRIX, CUBE, CUBE, MATRIX),
}
# What simulations and the filter call alike
COMMON: Mapping[str, Entry] = {
    "compute_mass_constants": Entry((VECTOR, VECTOR, VECTOR, VECTOR)),
    "advance_actuators": Entry((VECTOR, VECTOR, REAL, VECTOR, VECTOR, VECTOR)),
    "advance_memory_of_motion": Entry((REAL, VECTOR, REAL, VECTOR, VECTOR, VECTOR, VECTOR)),
    "settle_actuators": Entry((VECTOR, VECTOR, VECTOR, VECTOR, VECTOR)),
    "total_body_force": Entry((REAL, VECTOR, VECTOR, WHOLE, VECTOR, VECTOR), tuple_of_numbers),
    "water_displacement": Entry((REAL, VECTOR, VECTOR), tuple_of_numbers),
    "water_velocity": Entry((REAL, REAL, REAL, VECTOR, VECTOR, VECTOR, WHOLE), tuple_of_numbers),
}
FLEET = records.FleetArrays
SIMULATION: Mapping[str, Entry] = {
    **COMMON,
    "substep_length": Entry((VECTOR, VECTOR, REAL, REAL, VECTOR, VECTOR), float),
    "step_in_place": Entry((REAL, VECTOR, REAL, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR)),
    "steps": Entry((REAL, VECTOR, REAL, WHOLE, VECTOR, VECTOR, VECTOR, VECTOR)),
    "rollout": Entry(
        (records.VesselNumbers, records.VesselState, MATRIX, REAL, REAL, WHOLE, MATRIX)
    ),
    "compute_mass_constants_of_boats": Entry((ROWS, MATRIX, MATRIX, VECTOR, MATRIX)),
    "settle_actuators_of_boats": Entry((ROWS, FLEET)),
    "advance_boats": Entry((ROWS, FLEET, REAL, WHOLE)),
    "read_instruments_of_boats": Entry((ROWS, FLEET, MATRIX)),
}
# A library of its own: without a record of steps or of forces of the air it is not needed
RECORDING: Mapping[str, Entry] = {
    "air_body_force": Entry((REAL, VECTOR, VECTOR, WHOLE, VECTOR, VECTOR), tuple_of_numbers),
    "record_steps": Entry((FLEET, REAL, records.StepRecord)),
}
# Only of programs without candidate effects: MuJoCo's callback knows no switches
ON_MUJOCO: Mapping[str, Entry] = {
    "add_passive_forces_in_place": Entry((REAL, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR)),
}
ESTIMATION: Mapping[str, Entry] = {
    **COMMON,
    "oscillating_force": Entry((VECTOR, VECTOR), OscillatingForce),
    "mean_actuator_signals": Entry((VECTOR, MATRIX, VECTOR, VECTOR, VECTOR, MATRIX)),
    "total_body_forces": Entry((MATRIX, MATRIX, VECTOR, VECTOR, MATRIX)),
    "acceleration_jacobian": Entry(
        (REAL, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR, MATRIX),
    ),
    "kalman_filter": Entry(
        (
            records.Inputs,
            records.Measurements,
            records.VesselNumbers,
            records.LatentForce,
            records.InitialState,
            records.PassOptions,
            records.PassArrays,
            records.FilterHistory,
        ),
        float,
    ),
    "remove_position_errors": Entry((VECTOR, REAL, VECTOR, VECTOR)),
    "smooth_states": Entry(
        (records.FilterHistory, CUBE, VECTOR, records.LatentForce, VECTOR, VECTOR)
    ),
    "simulate_intervals": Entry(
        (records.Inputs, REAL, records.VesselNumbers, ROWS, ROWS, MATRIX, CUBE), float
    ),
}
LIBRARIES = ("simulation", "recording", "estimation")


def library_functions(module: Any, library: str) -> Mapping[str, Entry]:
    """Return the functions of a program that one of its C libraries has, by name.

    Each library is compiled when one of its functions is first needed.

    Args:
        module: The program's package.
        library: One of `LIBRARIES`.
    """
    if library == "estimation":
        return ESTIMATION
    if library == "recording":
        return RECORDING
    if module.CANDIDATES:
        return SIMULATION
    return {**SIMULATION, **ON_MUJOCO}
