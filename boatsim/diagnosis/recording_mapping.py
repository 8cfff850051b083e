"""Maps recordings to the compiled program of a vessel, so that the Kalman filter can run over them.

The columns of a recording become measured channels and commands, its notes parameters and noise.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from boatsim.diagnosis.config import DEFAULT, DiagnosisConfig
from boatsim.diagnosis.filter import (
    MappedRecording,
    command_changes,
    dof_in_state_order,
    rates_of_change,
)
from boatsim.diagnosis.input_noise import (
    input_noise_density,
    interpolate_measured_inputs,
    measured_input_indices,
)
from boatsim.diagnosis.prior_noise import specified_noise
from boatsim.errors import BadInput
from boatsim.physics.base import RandomForce
from boatsim.physics.commands import clipped_recorded_commands
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.program import Program
from boatsim.physics.signals import NOISE, Array, Signal, motion_signals
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import FEWEST_ROWS, Recording

# rows: the shortest recording allowed is split into thirds
FEWEST_IN_PART = FEWEST_ROWS // 3


def map_recording(
    recording: Recording,
    program: Program,
    shared_noise: Mapping[str, float] | None = None,
    noise_ratio: Mapping[str, float] | None = None,
    config: DiagnosisConfig = DEFAULT,
) -> MappedRecording:
    """Map a recording to a compiled vessel program, so that the Kalman filter can be run over it.

    Its columns become measured channels and commands of the vessel, and its notes set parameters
    and noise levels.

    Args:
        recording: Measured signals and commands.
        program: Compiled effects of the vessel.
        shared_noise: Sensor noise (sd by family) that all recordings share; None: this one's own.
        noise_ratio: Noise of this recording in shared levels, by family, where it is not specified.
        config: Settings of the diagnosis.

    Raises:
        BadInput: A column is missing that the vessel needs, or too few rows remain.
    """
    vessel = program.vessel
    axes = dof_in_state_order(vessel)
    where = recording.origin
    found, families, codes = list[Signal](), list[str](), list[int]()
    for signal in motion_signals(vessel.dof):
        if signal.column in recording.signals:
            found.append(signal)
            families.append(signal.noise)
            codes.append(axes.index(signal.axis) + signal.rate * len(axes))
    columns = tuple(signal.column for signal in found)
    _check_columns(recording, vessel, found)
    if len(recording) < FEWEST_IN_PART:
        raise BadInput(
            f"{where}: {recording.name} has {len(recording)} rows to use; at least "
            f"{FEWEST_IN_PART} are needed"
        )
    measured = np.column_stack(list(map(recording.signals.__getitem__, columns)))
    own = specified_noise(recording)
    shared = shared_noise or NOISE | own
    scale = {family: own.get(family, sd) / sd for family, sd in shared.items()}
    commands = np.zeros((len(recording), 1))
    if vessel.inputs:
        signals = _with_leading_samples(recording.t, recording.signals, vessel)
        commands = clipped_recorded_commands(vessel, signals, len(recording))
        if recording.orders is None:
            commands = interpolate_measured_inputs(commands, measured_input_indices(vessel))
    facts = merged_facts(vessel, recording)
    command_times, command_values = _commands_at_own_times(recording, vessel)
    mapped = MappedRecording(
        name=recording.name,
        program=program,
        times=np.ascontiguousarray(recording.t),
        measured=np.ascontiguousarray(measured),
        families=tuple(families),
        signals=columns,
        codes=np.array(codes),
        commands=np.ascontiguousarray(commands),
        values=parameter_values(program, facts),
        noise_scale=scale | dict(noise_ratio or {}),
        facts=facts,
        command_times=command_times,
        command_values=command_values,
        input_noise=input_noise_density(vessel, recording, axes, config.load),
        groups=recording.notes.groups,
        config=config.filter,
    )
    if "surge" in axes:
        speed = _speed_of_share(mapped, config.load.fast_share)
        if speed > config.load.fastest_froude * np.sqrt(GRAVITY * vessel.length):
            raise BadInput(
                f"{where}: x_m, y_m move at {speed:.3g} m/s, far beyond a hull of "
                f"{vessel.length:g} m; are they in m?"
            )
    return mapped


def _speed_of_share(mapped: MappedRecording, share: float) -> float:
    """Speed [m/s] along x or y that a share of the rows exceeds; rms of recorded velocities."""
    axes = dof_in_state_order(mapped.program.vessel)
    speeds = []
    for c, code in enumerate(mapped.codes.tolist()):
        recorded = np.isfinite(mapped.measured[:, c])
        if code < len(axes) and axes[code] in ("surge", "sway") and recorded.any():
            rates = rates_of_change(
                mapped.times[recorded], mapped.measured[recorded, c], mapped.config
            )
            if len(rates):
                speeds.append(float(np.quantile(np.abs(rates), 1.0 - share)))
    if speeds:
        return max(speeds)
    return float(np.sqrt(mapped.initial_state_prior.covariance[len(axes), len(axes)]))


def _check_columns(recording: Recording, vessel: Vessel, found: Sequence[Signal]) -> None:
    """Raise BadInput for a column that is missing."""
    missing = []
    if "yaw" in vessel.dof and "psi_rad" not in recording.signals:
        missing = ["psi_rad"]
    missing = missing or _missing_inputs(recording, vessel)
    if not missing and all(s.rate for s in found):
        missing = [motion_signals(vessel.dof)[0].column]
    if missing:
        raise BadInput(
            f"{recording.origin}: column {missing[0]} is missing, without which "
            f"{vessel.name} cannot be followed"
        )


def _commands_at_own_times(recording: Recording, vessel: Vessel) -> tuple[Array, Array]:
    """Commands at their own times where a recording has them more often than rows, else empty."""
    if recording.orders is None or not vessel.inputs:
        return np.zeros(0), np.zeros((0, 0))
    t = recording.orders.t
    signals = _with_leading_samples(t, recording.orders.signals, vessel)
    commands = clipped_recorded_commands(vessel, signals, len(t))
    return command_changes(t, interpolate_measured_inputs(commands, measured_input_indices(vessel)))


def _with_leading_samples(
    t: Array, signals: Mapping[str, Array], vessel: Vessel
) -> dict[str, Array]:
    """Signals in which those that a law filters lead by the filter's delay and by one row.

    The law moves to a new sample within the time of one row, so that it reaches it at its own time.
    """
    moved = dict(signals)
    if len(t) > 1:
        following = np.append(t[1:], 2.0 * t[-1] - t[-2])
        for name, lead in vessel.filtered_readings.items():
            if name in signals:
                moved[name] = np.interp(following + lead, t, signals[name])
    return moved


def parameter_values(program: Program, facts: Mapping[str, Any]) -> Array:
    """Return all parameter values of a vessel program as an array, with facts of a run put in.

    The parameters of all effects come first, then mass, mass centre and inertias of the hull.
    Stochastic forces have no fixed realisation here: the filter estimates it, a free run omits it.

    Args:
        program: Compiled effects of the vessel.
        facts: Facts of the run by name (`Effect.facts`).
    """
    values = np.append(program.values(), program.body)
    for effect in program.effects:
        if isinstance(effect, RandomForce):
            values[program.parameter_index(effect.name, "realisation")] = 0.0
        for fact, names in type(effect).facts.items():
            for name, x in zip(names, facts.get(fact, ()), strict=False):
                values[program.parameter_index(effect.name, name)] = x
    return values


def _missing_inputs(recording: Recording, vessel: Vessel) -> list[str]:
    """Readings that are not recorded, and actuators whose command is not (PWM drives thrust).

    An actuator is stated by all columns of which one is needed.
    """
    missing = []
    for actuator in vessel.actuators:
        commands = [name for name in vessel.commands if _drives(vessel, name, actuator)]
        columns = list(dict.fromkeys((*commands, actuator)))
        if not any(name in recording.signals for name in columns):
            missing.append(" or ".join(columns))
    measured = dict.fromkeys((*vessel.readings, *vessel.feeding_measurements))
    return missing + [name for name in measured if name not in recording.signals]


def _drives(vessel: Vessel, command: str, actuator: str) -> bool:
    """Whether a channel effect of the vessel converts this command into that actuator."""
    return any(
        vessel.command_for_actuator(effect, actuator) == command for effect in vessel.effects
    )


def merged_facts(vessel: Vessel, recording: Recording) -> dict[str, Any]:
    """Return the facts known about a recording: those of the vessel file, overridden by its notes.

    Facts are for example the forward speed, or the walls of the tank.
    """
    return {**vessel.diagnosis.facts, **recording.notes.facts}
