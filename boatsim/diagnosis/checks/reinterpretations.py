"""What a log may have been meant to say: other axes, another sense of the heading, exchanged or reversed drives."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import degrees, pi

import numpy as np

from boatsim.diagnosis.checks import course_over_ground
from boatsim.diagnosis.checks.finding import Change, applied
from boatsim.diagnosis.priors import froude_time
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording

LITTLE_USED = 0.12  # of its range, which a command in a right unit would pass
FEW_PERCENT, SOME = (
    0.5,
    20.0,
)  # of the range, that 100 is no more than; per cent that some order is, at least
ASIDE, ALIKE = 0.3, 0.7  # [rad] and likeness of the way, from which a bow points aside
BETTER = 0.2  # likeness by which a heading counted the other way points better
TURNED = 0.2  # [rad] from which a heading is turned, and not a compass that is off
MIRRORED_Y = (Change("y_m", "y_m", -1.0),)
MIRRORED_HEADING = (Change("psi_rad", "psi_rad", -1.0), Change("r_radps", "r_radps", -1.0))
MIRRORED = (*MIRRORED_Y, *MIRRORED_HEADING, Change("v_mps", "v_mps", -1.0))
EXCHANGED = (Change("x_m", "y_m"), Change("y_m", "x_m"))
FROM_EAST = (Change("psi_rad", "psi_rad", -1.0, pi / 2.0), Change("r_radps", "r_radps", -1.0))
ENU = (*EXCHANGED, *FROM_EAST, Change("v_mps", "v_mps", -1.0))


@dataclass(frozen=True)
class Meaning:
    """A log that may have been meant: its fault, what is off in words, and the columns that put it right."""

    name: str
    words: str
    changes: tuple[Change, ...]
    alternatives: tuple[tuple[str, tuple[Change, ...]], ...] = ()  # that no boat could tell from it


def meanings(recordings: Sequence[Recording], vessel: Vessel) -> list[Meaning]:
    """What is tried on a vessel, with the columns that are there. The world has no north: what only turns it is one."""
    there = {c for r in recordings for c in r.signals}
    found = [*_axes(recordings, vessel), *_drives(recordings, vessel)]
    kept = []
    for m in found:
        changes = tuple(c for c in m.changes if c.of in there)
        others = tuple((n, tuple(c for c in cs if c.of in there)) for n, cs in m.alternatives)
        kept.append(Meaning(m.name, m.words, changes, others))
    return kept


def _axes(recordings: Sequence[Recording], vessel: Vessel) -> Iterator[Meaning]:
    if not {"surge", "sway", "yaw"} <= set(vessel.dof):
        return
    if any(n not in r.signals for r in recordings for n in ("x_m", "y_m", "psi_rad")):
        return
    yield Meaning(
        "mirrored",
        "y and the heading are counted to port",
        MIRRORED,
        (("x east, y north (ENU)", ENU),),
    )
    yield Meaning("y_to_port", "y is to port, the heading clockwise", MIRRORED_Y)
    yield Meaning("heading_counterclockwise", "the heading is counted to port", MIRRORED_HEADING)
    yield Meaning(
        "axes_exchanged", "x is east and y north, the heading clockwise from north", EXCHANGED
    )
    yield Meaning("heading_from_east", "the heading is counted from y to x", FROM_EAST)
    for angle in _turned(recordings, vessel):
        yield turned_by(angle)


def turned_by(angle: float) -> Meaning:
    """A heading that lacks an angle [rad]."""
    words = f"the heading is turned by {-degrees(angle):.0f} deg"
    return Meaning("heading_turned", words, (Change("psi_rad", "psi_rad", 1.0, angle),))


def points_aside(recordings: Sequence[Recording], vessel: Vessel) -> bool:
    """Whether boats go all along where their bows do not point, or where these would point if counted the other way."""
    if not {"surge", "sway", "yaw"} <= set(vessel.dof):
        return False
    if any(n not in r.signals for r in recordings for n in ("x_m", "y_m", "psi_rad")):
        return False
    angle, alike = _aside(recordings, vessel)
    _, mirrored = _aside([applied(r, MIRRORED_HEADING) for r in recordings], vessel)
    straight = course_over_ground.aside(recordings, vessel)
    if straight is not None and abs(straight) > ASIDE:
        return True
    return (abs(angle) > ASIDE and alike > ALIKE) or (
        mirrored > ALIKE and mirrored > alike + BETTER
    )


def _turned(recordings: Sequence[Recording], vessel: Vessel) -> list[float]:
    """Quarter turns [rad], and the angle by which bows must be turned to point where boats go, ahead."""
    quarters = [pi / 2.0, pi, -pi / 2.0]
    straight = course_over_ground.aside(recordings, vessel)
    if straight is not None:
        return [*quarters, straight] if abs(straight) > TURNED else quarters
    angle, alike = _aside(recordings, vessel)
    return [*quarters, angle] if abs(angle) > TURNED and alike > ALIKE else quarters


def _aside(recordings: Sequence[Recording], vessel: Vessel) -> tuple[float, float]:
    """Mean angle [rad] from the bow to where the boat goes, to starboard, and how alike it is all along, 0 to 1."""
    total, way = 0.0 + 0.0j, 0.0
    for r in recordings:
        there = np.isfinite(r["x_m"]) & np.isfinite(r["y_m"]) & np.isfinite(r["psi_rad"])
        t, z, psi = r.t[there], r["x_m"][there] + 1j * r["y_m"][there], r["psi_rad"][there]
        after = np.searchsorted(t, t + froude_time(vessel)).clip(max=len(t) - 1)
        middle = (np.arange(len(t)) + after) // 2
        total += complex(np.sum((z[after] - z) * np.exp(-1j * psi[middle])))
        way += float(np.sum(np.abs(z[after] - z)))
    return float(np.angle(total)), abs(total) / max(way, 1e-12)


def _drives(recordings: Sequence[Recording], vessel: Vessel) -> Iterator[Meaning]:
    channels = [n for n in vessel.commands if all(n in r.signals for r in recordings)]
    if exchanged := _other_side(channels, vessel):
        words = f"{' and '.join(sorted({c.ours for c in exchanged}))} are exchanged"
        yield Meaning("thrusters_exchanged", words, exchanged)
    for unit in dict.fromkeys(unit_of(n) for n in channels):
        alike = [
            n
            for n in channels
            if unit_of(n) == unit and vessel.commands[n].low < 0.0 < vessel.commands[n].high
        ]
        if alike:
            name = "rudder_reversed" if unit == "rad" else "thrust_reversed"
            words = f"{', '.join(alike)} count the other way"
            yield Meaning(name, words, tuple(Change(n, n, -1.0) for n in alike))
        for words, factor in _shares(recordings, vessel, alike):
            changes = tuple(Change(n, n, factor) for n in alike)
            verb = "are" if len(alike) > 1 else "is"
            yield Meaning(
                "command_unit", f"{', '.join(alike)} {verb} {words} of full command", changes
            )


def _other_side(channels: list[str], vessel: Vessel) -> tuple[Change, ...]:
    """Channels of either side exchanged, by the name of the side."""
    found = []
    for name in channels:
        for side, other in (
            ("port", "starboard"),
            ("starboard", "port"),
            ("left", "right"),
            ("right", "left"),
        ):
            parts = name.split("_")
            if (
                side in parts
                and (twin := "_".join(other if p == side else p for p in parts)) in channels
            ):
                found.append(Change(name, twin))
    return tuple(found)


def _shares(
    recordings: Sequence[Recording], vessel: Vessel, channels: list[str]
) -> Iterator[tuple[str, float]]:
    """Shares of full command that channels may be, and the factor that undoes it, where the vessel takes far more.

    How far orders reach says little, as a boat may be driven gently: the vessel says whether so little drives it so.
    """
    if not channels or len({vessel.commands[n].high for n in channels}) > 1:
        return
    limit = vessel.commands[channels[0]].high
    if not np.isfinite(limit):
        return
    values: Array = np.concatenate([r[n][np.isfinite(r[n])] for r in recordings for n in channels])
    largest = float(np.abs(values).max(initial=0.0))
    if 0.2 < largest <= 1.0 < LITTLE_USED * limit:
        yield "shares", float(limit)
    if SOME <= largest <= 100.0 < FEW_PERCENT * limit:
        yield "per cent", float(limit) / 100.0
