"""Lines of a proposed map for the inputs of a vessel that are measured, not commanded."""

from collections.abc import Collection, Mapping, Sequence

from boatsim.physics.effects.measured_current import MeasuredCurrent
from boatsim.physics.effects.measured_relative_wind import MeasuredRelativeWind
from boatsim.physics.effects.measured_wind import MeasuredWind
from boatsim.physics.vessel import Vessel
from boatsim.recordings.importing.log import Log
from boatsim.recordings.importing.mapping_proposal import track_and_heading
from boatsim.recordings.importing.signal_classification import Body
from boatsim.recordings.importing.supply_currents import supply_current_lines
from boatsim.recordings.importing.unnamed_inputs import supply_inputs, unnamed_input_lines
from boatsim.recordings.importing.voltages import voltage_lines
from boatsim.recordings.importing.water_speeds import (
    current_table,
    unnamed_current,
    water_speeds_of_log,
)
from boatsim.recordings.importing.wind_evidence import APPARENT, TRUE
from boatsim.recordings.importing.wind_inputs import USUAL, WindRole, unnamed_wind, wind_lines
from boatsim.recordings.importing.winds import Wind, winds_of_log
from boatsim.recordings.notes import unit_of


def measured_text(boat: Vessel, log: Log, body: Body) -> str:
    """Return lines at the end of a proposed map: measured inputs, and those that the vessel lacks.

    Args:
        boat: The vessel.
        log: The log.
        body: Facts about the vessel that help to classify its signals.
    """
    roles = _wind_roles(boat)
    motion = track_and_heading(log, body)
    winds = winds_of_log(log, *motion)
    speeds = water_speeds_of_log(log, *motion)
    current = _current_columns(boat)
    made = set(current.values()) if speeds else set[str]()
    text = _measured_lines(boat, log, roles, winds, made)
    new = [*supply_inputs(boat.measured, log), *unnamed_wind(roles, winds)]
    text += unnamed_input_lines([*new, *unnamed_current(current, speeds)], log)
    return text + current_table(current, speeds, bool(current))


def _wind_roles(boat: Vessel) -> dict[str, WindRole]:
    """Measured quantities of a vessel that are of a wind, by its effects or their usual names."""
    roles = {name: role for name, role in USUAL.items() if name in boat.measured}
    for effect in boat.effects:
        if not isinstance(effect, MeasuredWind):
            continue
        frame = APPARENT if isinstance(effect, MeasuredRelativeWind) else TRUE
        for role, channel in boat.bindings(effect).items():
            if channel in boat.measured:
                roles[str(channel)] = WindRole(frame, role)
    return roles


def _current_columns(boat: Vessel) -> dict[str, str]:
    """Measured columns of a current of a vessel, by "north" and "east"; empty without them."""
    for effect in boat.effects:
        if isinstance(effect, MeasuredCurrent):
            bound = boat.bindings(effect)
            return {role: str(name) for role, name in bound.items() if name in boat.measured}
    usual = {role: str(name) for role, name in MeasuredCurrent.recorded_as.items()}
    return usual if set(usual.values()) <= set(boat.measured) else {}


def _measured_lines(
    boat: Vessel,
    log: Log,
    roles: Mapping[str, WindRole],
    winds: Sequence[Wind],
    made: Collection[str],
) -> str:
    """Lines of a proposed map for the measured inputs of a vessel, at the end of its columns.

    The inputs `made` are columns of a current that a table of the map makes.
    """
    lines = ""
    for name, about in boat.measured.items():
        if name in made:
            continue
        if name in log.signals:
            lines += f'{name} = "{name}"\n'
            continue
        words = about.about or "measured, not commanded"
        if unit_of(name) == "V":
            lines += voltage_lines(name, words, about.neutral, log)
            continue
        if unit_of(name) == "A":
            lines += supply_current_lines(name, words, about.neutral, log)
            continue
        if name in roles:
            lines += wind_lines(name, words, roles, winds)
            continue
        lines += f'# {name} = "..."  # CHECK: {words}\n'
        if name.endswith("_m"):
            lines += (
                f"# or [waves.{name}] with probes that stand elsewhere, at the end of the file\n"
            )
    return lines
