"""Check for commands in per cent, degrees, revolutions per minute or servo pulses."""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from boatsim.diagnosis.checks.finding import Finding, scaling_corrections
from boatsim.diagnosis.config import ChecksConfig
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.expression import UNITS
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import ROUNDING, Recording

PULSE_HALF_RANGE = 500.0  # [us] from the neutral pulse to a full command
PULSE_NEUTRAL = 1500.0  # [us]
PER_CENT = "per cent of full"
PULSES = "pulses in us"
FULL_TURN = 2.0 * math.pi  # [rad]
FULL_RANGE = 1.0 + 5.0 * ROUNDING  # largest share of the limit, rounding in the file included


class Conversion(NamedTuple):
    """Factor and offset that convert a recorded command to the vessel's unit.

    For example, from a servo pulse in microseconds to a share of the full command.
    """

    unit: str  # of the recorded command, in words
    factor: float
    offset: float = 0.0


def check_command_unit(recording: Recording, vessel: Vessel, config: ChecksConfig) -> list[Finding]:
    """Find recorded commands in a wrong unit, such as per cent, degrees or servo pulses.

    Two independent signs are needed: a command exceeds the vessel's limits and would not do so in
    the other unit, and either it exceeds them by more than any drive can, or its numbers are those
    of the other unit (per cent of full command with one decimal, servo pulses). A command that
    exceeds its limits without the second sign is a finding "command_range".

    Args:
        recording: The recording as written in the file.
        vessel: The vessel with its command limits.
        config: Thresholds of the quality checks.

    Returns:
        One finding "command_unit" per conversion, with all channels that it concerns.
    """
    groups: dict[Conversion, list[str]] = {}
    for name, conversion in _conversions(recording, vessel, config).items():
        groups.setdefault(conversion, []).append(name)
    found = []
    for conversion, names in groups.items():
        found.append(_finding(recording, vessel, conversion, names, config))
    return found


def _finding(
    recording: Recording,
    vessel: Vessel,
    conversion: Conversion,
    names: list[str],
    config: ChecksConfig,
) -> Finding:
    evidence = []
    for name in names:
        low = np.nanmin(recording[name])
        high = np.nanmax(recording[name])
        command = vessel.commands[name]
        allowed = f"{command.low:g} to {command.high:g} {unit_of(name)}".rstrip()
        evidence.append(
            f"{name} ranges from {low:.4g} to {high:.4g}, but {vessel.name} accepts {allowed}"
        )
    channels = [*names, *_same_range(recording, vessel, names)]
    return Finding(
        "command_unit",
        f"{'; '.join(evidence)}. The unit is {conversion.unit}",
        probability=config.probability_strong,
        changes=scaling_corrections(channels, conversion.factor, conversion.offset),
    )


def _conversions(
    recording: Recording, vessel: Vessel, config: ChecksConfig
) -> Mapping[str, Conversion]:
    """Conversions of the channels that exceed their limits."""
    found = {}
    for name, command in vessel.commands.items():
        limit = max(abs(command.low), abs(command.high))
        if name not in recording.signals or not math.isfinite(limit):
            continue
        values = recording[name][np.isfinite(recording[name])]
        if name in vessel.full_turns:
            if direction_in_degrees(recording.t, recording[name], config):
                found[name] = Conversion("degrees", UNITS["deg"])
            continue
        if not len(values) or float(np.abs(values).max()) <= config.command_excess * limit:
            continue
        conversion = _conversion(values, name, limit, config)
        if conversion is not None and _has_second_sign(conversion, values, limit, config):
            found[name] = conversion
    return found


def _has_second_sign(
    conversion: Conversion, values: Array, limit: float, config: ChecksConfig
) -> bool:
    """Whether commands (N,) that exceed their limit show another unit by a second sign."""
    largest = float(np.abs(values).max())
    if conversion.unit == PULSES or largest > config.command_certain_excess * limit:
        return True
    if conversion.unit != PER_CENT or largest > 100.0 * FULL_RANGE:
        return False
    tenths = 10.0 * values
    is_rounded = bool(np.all(np.abs(tenths - np.round(tenths)) < 1e-6))
    return is_rounded or largest >= config.command_full_per_cent


def direction_in_degrees(t: Array, values: Array, config: ChecksConfig) -> bool:
    """Return whether the direction of a drive is in degrees: it spans many turns, at high rates.

    The range alone shows nothing, because the turns of a drive may be counted on.

    Args:
        t: Times (N,) [s].
        values: Directions (N,) [rad] as the name of the column states.
        config: Thresholds of the quality checks.
    """
    known = np.isfinite(values)
    steps = np.abs(np.diff(values[known]))
    times = np.diff(t[known])
    turning = (times > 0.0) & (steps > 0.0)
    if not turning.any() or float(np.ptp(values[known])) <= config.direction_turns * FULL_TURN:
        return False
    # neither a wrapped angle in radians nor one that is counted on moves by a turn in a row
    leaps = bool((steps > config.direction_leap * FULL_TURN).any())
    rate = float(np.quantile(steps[turning] / times[turning], config.direction_rate_quantile))
    return leaps or rate > config.direction_rate


def _conversion(values: Array, name: str, limit: float, config: ChecksConfig) -> Conversion | None:
    """Conversion by which values (N,) come within a limit and use a fair part of it."""
    low = float(values.min())
    high = float(values.max())
    shortest, longest = config.servo_pulse_range
    if shortest <= low and high <= longest:
        return Conversion(
            PULSES, limit / PULSE_HALF_RANGE, -PULSE_NEUTRAL / PULSE_HALF_RANGE * limit
        )
    percent = Conversion(PER_CENT, limit / 100.0)
    units = {
        "rad": [Conversion("degrees", UNITS["deg"]), percent],
        "rad/s": [Conversion("revolutions a minute", UNITS["rpm"]), percent],
        "N": [percent, Conversion("thousandths", 1e-3)],
    }
    largest = max(abs(low), abs(high))
    for conversion in units.get(unit_of(name), [percent]):
        converted = largest * conversion.factor
        if config.command_min_range * limit <= converted <= FULL_RANGE * limit:
            return conversion
    return None


def _same_range(recording: Recording, vessel: Vessel, names: list[str]) -> list[str]:
    """Other channels with the same unit and limits, which the same logger wrote."""

    def unit_and_range(name: str) -> tuple[str, float, float]:
        return unit_of(name), vessel.commands[name].low, vessel.commands[name].high

    ranges = set(map(unit_and_range, names))
    others = []
    for name in vessel.commands:
        if name in recording.signals and name not in names and unit_and_range(name) in ranges:
            others.append(name)
    return others
