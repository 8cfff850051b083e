"""Corrections of the signals of the motion by the heading and the track.

The changes of the heading and the speed of the track show units that a log does not state, and
which signals cannot be what their names suggest.
"""

from collections.abc import Mapping
from dataclasses import replace

from boatsim.physics.signals import RATES
from boatsim.recordings.importing.signal_classification import Classification
from boatsim.recordings.importing.signal_text import printable_name
from boatsim.recordings.importing.signal_units import has_stated_unit
from boatsim.recordings.importing.track import Track, reason_not_measured, speed_unit, unit_of_rate

BY_ITS_RANGE = "by its range"  # end of the note on a unit that the range only suggests
MOTION_COLUMNS = ("phi_rad", "theta_rad", *RATES)  # that a track may contradict


def with_rate_unit(
    best: Mapping[str, list[Classification]],
) -> dict[str, list[Classification]]:
    """Return classified signals, with the unit of a rate of turn by the changes of the heading.

    Args:
        best: Column -> classified signals, the most probable first.
    """
    if not best.get("psi_rad"):
        return dict(best)
    heading, rates = best["psi_rad"][0], []
    for g in best.get("r_radps", []):
        unit = unit_of_rate(g, heading) if g.why.endswith(BY_ITS_RANGE) else None
        if unit is not None:
            name = {"degps": "degrees", "": "radians", "degpmin": "degrees per minute"}[unit]
            g = replace(g, word=unit, why=f"{name} by the changes of the heading")
        rates.append(g)
    kept = dict(best)
    if rates:
        kept["r_radps"] = rates
    return kept


def with_speed_units(
    best: Mapping[str, list[Classification]], track: Track | None
) -> dict[str, list[Classification]]:
    """Return classified signals, with the units of speeds by the speed of the track.

    Args:
        best: Column -> classified signals, the most probable first.
        track: Motion by the positions; None if unknown.
    """
    kept = dict(best)
    heading = next(iter(best.get("psi_rad", [])), None)
    for column in ("u_mps", "v_mps"):
        speeds = []
        for g in best.get(column, []):
            unit = ""
            if not has_stated_unit(g.name, g.signal):
                unit = speed_unit(column, g, track, heading)
            if unit:
                g = replace(g, word=unit, why=f"CHECK: in {unit} by the speed of the track")
            speeds.append(g)
        if speeds:
            kept[column] = speeds
    return kept


def without_contradictions(
    best: Mapping[str, list[Classification]], track: Track | None
) -> tuple[dict[str, list[Classification]], list[str]]:
    """Return classified signals that the track does not contradict, and comments on others.

    Args:
        best: Column -> classified signals, the most probable first.
        track: Motion by the positions; None if unknown.
    """
    kept = dict(best)
    lines = []
    for column in ("psi_rad", *MOTION_COLUMNS):
        for g in best.get(column, []):
            heading = next(iter(kept.get("psi_rad", [])), None)
            if reason := reason_not_measured(column, g, track, heading):
                kept[column] = [other for other in kept[column] if other is not g]
                lines.append(f"# {column} is not {printable_name(g.name)}: {reason}")
        if column in kept and not kept[column]:
            del kept[column]
    return kept, lines
