"""Reinterpretations of a log: other axes, another sense of the heading, exchanged drives.

A reinterpretation is a change of columns that a user may have forgotten.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import degrees, pi
from operator import itemgetter

import numpy as np

from boatsim.diagnosis.checks.course_over_ground import heading_offset
from boatsim.diagnosis.checks.finding import (
    PLANAR_POSE,
    Change,
    apply_corrections_to_all,
    corrected_columns,
    scaling_corrections,
)
from boatsim.diagnosis.config import ChecksConfig
from boatsim.diagnosis.priors import froude_time_scale
from boatsim.physics.base import Array, Effect
from boatsim.physics.signals import PLANAR_DOF
from boatsim.physics.vessel import Vessel
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording

QUARTER_TURNS = (pi / 2.0, pi, -pi / 2.0)
MIRRORED_Y = (Change("y_m", "y_m", -1.0),)
MIRRORED_HEADING = (Change("psi_rad", "psi_rad", -1.0), Change("r_radps", "r_radps", -1.0))
MIRRORED = (*MIRRORED_Y, *MIRRORED_HEADING, Change("v_mps", "v_mps", -1.0))
MIRRORED_WORDS = "y and the heading are counted to port"
EXCHANGED = (Change("x_m", "y_m"), Change("y_m", "x_m"))
FROM_EAST = (Change("psi_rad", "psi_rad", -1.0, pi / 2.0), Change("r_radps", "r_radps", -1.0))
ENU = (*EXCHANGED, *FROM_EAST, Change("v_mps", "v_mps", -1.0))
OTHER_SIDE = {"port": "starboard", "starboard": "port", "left": "right", "right": "left"}


@dataclass(frozen=True)
class Reinterpretation:
    """A possible fault in the meaning of a recording's columns, and the changes that correct it.

    For example, other axes, a heading of opposite sense, or exchanged drives.

    Attributes:
        name: Name of the finding in diagnosis.json.
        words: Description of the fault in a clause.
        changes: Changes of columns that correct it.
        alternatives: Further explanations, with their words, that no data can distinguish from it.
    """

    name: str
    words: str
    changes: tuple[Change, ...]
    alternatives: tuple[tuple[str, tuple[Change, ...]], ...] = ()

    @property
    def moves_positions(self) -> bool:
        """Whether the correction changes positions, which satellite receivers do not confuse."""
        return bool(corrected_columns(self.changes) & {"x_m", "y_m"})


def reinterpretations(
    recordings: Sequence[Recording], vessel: Vessel, config: ChecksConfig
) -> list[Reinterpretation]:
    """Return the possible faults in the meaning of recorded columns that are to be compared.

    The vessel model is later fitted to each corrected version. Corrections that differ only by a
    rotation of the earth frame are treated as identical.

    Args:
        recordings: Prepared recordings.
        vessel: The vessel that they are recordings of.
        config: Thresholds of the quality checks.

    Returns:
        Reinterpretations; their changes concern columns that the recordings have.
    """
    columns = set[str]().union(*(r.signals for r in recordings))

    def changes_of_recorded_columns(changes: Sequence[Change]) -> tuple[Change, ...]:
        return tuple(c for c in changes if c.source in columns)

    found = []
    for each in (*_axes(recordings, vessel, config), *_drives(recordings, vessel, config)):
        others = tuple(
            (words, changes_of_recorded_columns(changes)) for words, changes in each.alternatives
        )
        found.append(
            Reinterpretation(
                each.name, each.words, changes_of_recorded_columns(each.changes), others
            )
        )
    return found


def heading_offset_hypothesis(angle: float) -> Reinterpretation:
    """Return the possible fault that the recorded heading is off by a constant angle [rad].

    Its correction adds the angle.
    """
    words = f"the heading is turned by {-degrees(angle):.0f} deg"
    return Reinterpretation("heading_turned", words, (Change("psi_rad", "psi_rad", 1.0, angle),))


def heading_disagrees_with_course(
    recordings: Sequence[Recording], vessel: Vessel, config: ChecksConfig
) -> bool:
    """Return whether a boat clearly does not move in the direction of its recorded heading.

    Also true if its motion agrees clearly better with the mirrored heading.

    Args:
        recordings: Prepared recordings.
        vessel: The vessel that they are recordings of.
        config: Thresholds of the quality checks.
    """
    if not _have_planar_poses(recordings, vessel):
        return False
    offset = heading_offset(recordings, vessel, config)
    if offset is not None and abs(offset) > config.heading_min_offset:
        return True
    angle, agreement = _mean_drift_angle(recordings, vessel)
    if abs(angle) > config.heading_min_offset and agreement > config.heading_min_agreement:
        return True
    mirrored = apply_corrections_to_all(recordings, MIRRORED_HEADING)
    _, mirrored_agreement = _mean_drift_angle(mirrored, vessel)
    better = mirrored_agreement > agreement + config.heading_min_improvement
    return better and mirrored_agreement > config.heading_min_agreement


def _have_planar_poses(recordings: Sequence[Recording], vessel: Vessel) -> bool:
    if not set(vessel.dof) >= PLANAR_DOF:
        return False
    return all(set(PLANAR_POSE) <= r.signals.keys() for r in recordings)


def _axes(
    recordings: Sequence[Recording], vessel: Vessel, config: ChecksConfig
) -> Iterator[Reinterpretation]:
    if not _have_planar_poses(recordings, vessel):
        return
    enu = ("x east, y north (ENU)", ENU)
    yield Reinterpretation("mirrored", MIRRORED_WORDS, MIRRORED, (enu,))
    yield Reinterpretation("y_to_port", "y is to port, the heading clockwise", MIRRORED_Y)
    yield Reinterpretation(
        "heading_counterclockwise", "the heading is counted to port", MIRRORED_HEADING
    )
    yield Reinterpretation(
        "axes_exchanged", "x is east and y north, the heading clockwise from north", EXCHANGED
    )
    yield Reinterpretation("heading_from_east", "the heading is counted from y to x", FROM_EAST)
    yield from map(heading_offset_hypothesis, _heading_rotations(recordings, vessel, config))


def _heading_rotations(
    recordings: Sequence[Recording], vessel: Vessel, config: ChecksConfig
) -> list[float]:
    """Quarter turns [rad], and the rotation by which the bow points along the course."""
    rotations = list(QUARTER_TURNS)
    angle = heading_offset(recordings, vessel, config)
    if angle is None:
        angle, agreement = _mean_drift_angle(recordings, vessel)
        if not agreement > config.heading_min_agreement:
            return rotations
    if abs(angle) > config.heading_min_rotation:
        rotations.append(angle)
    return rotations


def _mean_drift_angle(recordings: Sequence[Recording], vessel: Vessel) -> tuple[float, float]:
    """Mean angle [rad] from the bow to the course, to starboard, and its agreement, 0 to 1.

    The agreement is the length of the mean of the unit vectors, weighted by the distance.
    """
    total = 0.0 + 0.0j
    distance = 0.0
    for recording in recordings:
        x, y, psi = itemgetter(*PLANAR_POSE)(recording.signals)
        known = np.isfinite(x) & np.isfinite(y) & np.isfinite(psi)
        t = recording.t[known]
        z = x[known] + 1j * y[known]
        after = np.searchsorted(t, t + froude_time_scale(vessel)).clip(max=len(t) - 1)
        middle = (np.arange(len(t)) + after) // 2
        total += complex(np.sum((z[after] - z) * np.exp(-1j * psi[known][middle])))
        distance += float(np.sum(np.abs(z[after] - z)))
    return float(np.angle(total)), abs(total) / max(distance, 1e-12)


def _drives(
    recordings: Sequence[Recording], vessel: Vessel, config: ChecksConfig
) -> Iterator[Reinterpretation]:
    channels = _common_commands(recordings, vessel)
    for exchanged in _exchanges(vessel, channels):
        names = " and ".join(sorted(corrected_columns(exchanged)))
        yield Reinterpretation("thrusters_exchanged", f"{names} are exchanged", exchanged)
    reversible = [n for n in channels if vessel.commands[n].low < 0.0 < vessel.commands[n].high]
    for unit in dict.fromkeys(map(unit_of, channels)):
        same_unit = [n for n in reversible if unit_of(n) == unit]
        if not same_unit:
            continue
        names = ", ".join(same_unit)
        reversed_name = "rudder_reversed" if unit == "rad" else "thrust_reversed"
        for reversed_channels in _sets_of_reversed(same_unit):
            yield Reinterpretation(
                reversed_name,
                f"the sign of {', '.join(reversed_channels)} is reversed",
                scaling_corrections(reversed_channels, -1.0),
            )
        verb = "are" if len(same_unit) > 1 else "is"
        for words, factor in _command_shares(recordings, vessel, same_unit, config):
            yield Reinterpretation(
                "command_unit",
                f"{names} {verb} in {words} of full command",
                scaling_corrections(same_unit, factor),
            )


def _common_commands(recordings: Sequence[Recording], vessel: Vessel) -> list[str]:
    """Commands that all recordings have."""
    common = list(vessel.commands)
    for recording in recordings:
        common = [name for name in common if name in recording.signals]
    return common


def _sets_of_reversed(channels: list[str]) -> list[list[str]]:
    """Channels of one unit whose signs may be reversed: all of them, and each one alone."""
    if len(channels) < 2:
        return [channels]
    return [channels, *([name] for name in channels)]


def _exchanges(vessel: Vessel, channels: list[str]) -> list[tuple[Change, ...]]:
    """Exchanges of the two sides: of all drives, of the channels of one unit, of a pair of drives.

    The sides are known by the names of the channels, or by the places of the drives on the vessel.
    """
    pairs = _mirrored_drives(vessel, channels)
    everything = _exchanged_sides(channels)
    if not everything:
        everything = tuple(change for pair in pairs for change in pair)
    found = [everything] if everything else []
    for unit in dict.fromkeys(map(unit_of, channels)):
        found.append(tuple(c for c in everything if unit_of(c.column) == unit))
    found += pairs
    different = {frozenset(changes): changes for changes in found if changes}
    return list(different.values())


def _mirrored_drives(vessel: Vessel, channels: list[str]) -> list[tuple[Change, ...]]:
    """Changes that exchange the channels of two drives, for each pair of mirrored drives.

    Two drives are mirrored if they are of one kind and lie at the same distance from the
    centreline, on its two sides and equally far ahead.
    """
    drives = []
    for effect in vessel.effects:
        inputs = {}
        for role, channel in vessel.specified_inputs(effect).items():
            source = _recorded_command(vessel, channel)
            if source in channels:
                inputs[role] = source
        if inputs and float(getattr(effect, "y", 0.0)) != 0.0:
            drives.append((effect, inputs))
    pairs = []
    for i, (one, inputs) in enumerate(drives):
        for other, counterparts in drives[i + 1 :]:
            if _are_mirrored(one, other) and inputs.keys() == counterparts.keys():
                pairs.append(_exchange(inputs, counterparts))
    return [pair for pair in pairs if pair]


def _recorded_command(vessel: Vessel, channel: str | float) -> str:
    """The command that a log has for a channel: the raw command that feeds it, or itself."""
    if not isinstance(channel, str):
        return ""
    for effect in vessel.effects:
        if channel in vessel.target_actuators(effect):
            source = vessel.command_for_actuator(effect, channel)
            if source:
                return source
    return channel


def _are_mirrored(one: Effect, other: Effect) -> bool:
    """Whether two drives of one kind lie opposite each other."""
    if type(one) is not type(other):
        return False
    ahead = [float(getattr(effect, "x", 0.0)) for effect in (one, other)]
    aside = [float(getattr(effect, "y", 0.0)) for effect in (one, other)]
    return bool(np.isclose(ahead[0], ahead[1]) and np.isclose(aside[0], -aside[1]))


def _exchange(inputs: Mapping[str, str], counterparts: Mapping[str, str]) -> tuple[Change, ...]:
    """Changes that exchange the channels of two drives, by role."""
    changes = []
    for role, name in inputs.items():
        counterpart = counterparts[role]
        if name != counterpart:
            changes += [Change(name, counterpart), Change(counterpart, name)]
    return tuple(changes)


def _exchanged_sides(channels: list[str]) -> tuple[Change, ...]:
    """Changes that exchange the channels of the two sides, identified by their names."""
    changes = []
    for name in channels:
        parts = name.split("_")
        for side, other in OTHER_SIDE.items():
            counterpart = "_".join(other if p == side else p for p in parts)
            if side in parts and counterpart in channels:
                changes.append(Change(name, counterpart))
    return tuple(changes)


def _command_shares(
    recordings: Sequence[Recording], vessel: Vessel, channels: list[str], config: ChecksConfig
) -> Iterator[tuple[str, float]]:
    """Shares in which commands may be recorded, in words, and the factors that undo them.

    Small commands alone prove little, because a boat may be driven gently. The comparison on the
    vessel shows whether they suffice for its motion.
    """
    if not channels or len({vessel.commands[n].high for n in channels}) > 1:
        return
    limit = float(vessel.commands[channels[0]].high)
    if not np.isfinite(limit):
        return
    values: Array = np.concatenate([r[n][np.isfinite(r[n])] for r in recordings for n in channels])
    largest = float(np.abs(values).max(initial=0.0))
    if config.share_min_command < largest <= 1.0 < config.share_max_range * limit:
        yield "shares", limit
    if config.percent_min_command <= largest <= 100.0 < config.percent_max_range * limit:
        yield "per cent", limit / 100.0
