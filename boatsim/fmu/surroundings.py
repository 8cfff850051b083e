"""Current and wind of a vessel as inputs of its FMU."""

from boatsim.physics.kinds.force import Force
from boatsim.physics.vessel import Vessel
from boatsim.physics.vessel.schema import MeasuredChannel

PLANE = {"surge", "sway"}  # degrees of freedom on which current and wind act
WIND_CHANNELS = {
    "wind_mps": MeasuredChannel(about="speed of the wind over ground"),
    "wind_from_rad": MeasuredChannel(about="direction the wind comes from, clockwise from x"),
}


def has_wind(vessel: Vessel) -> bool:
    """Return whether an effect of the vessel is a force of the air."""
    return any(isinstance(e, Force) and type(e).of_air for e in vessel.effects)


def with_surroundings(vessel: Vessel) -> Vessel:
    """Return a vessel that has a current and a wind, which are zero if its file states none.

    An added wind has drag areas of zero, because no rule gives them: its inputs have no influence
    until the areas, which are parameters, are set. A vessel that cannot surge and sway, or that
    moves without water, gets neither.

    Args:
        vessel: The vessel.

    Returns:
        The vessel with the effects `current` and `measured_wind` where it had none of their kind.

    Raises:
        BadInput: A command of the vessel has the name of an added input of the wind.
    """
    if not set(vessel.dof) >= PLANE or vessel.diagnosis.facts.get("no_water") is True:
        return vessel
    found = vessel
    if not vessel.names_of("current"):
        found = found.with_effect({"use": "current"})
    if has_wind(vessel):
        return found
    found = found.replace(measured={**WIND_CHANNELS, **found.measured})
    bound = {"speed": "wind_mps", "comes_from": "wind_from_rad"}
    return found.with_effect({"use": "measured_wind", "on": bound, "front": 0.0, "side": 0.0})


def added_surroundings(vessel: Vessel) -> list[str]:
    """Return one sentence for each input of the surroundings that has no influence in a vessel.

    Args:
        vessel: The vessel, before its surroundings were added.
    """
    added = {effect.name for effect in with_surroundings(vessel).effects}
    added -= {effect.name for effect in vessel.effects}
    if "measured_wind" not in added:
        return []
    return [
        f"{vessel.name} has no wind effect: the inputs {' and '.join(WIND_CHANNELS)} act once the "
        "parameters measured_wind.front and measured_wind.side, drag areas in m^2, are set"
    ]
