"""Wind, waves and current that the command line adds to the surroundings of a vessel."""

from dataclasses import dataclass
from math import cos, isfinite, nan, pi, radians, sin

from boatsim.control.base import wrap
from boatsim.errors import BadInput
from boatsim.files import Value
from boatsim.physics.estimate.wind_areas import frontal_drag_area, lateral_drag_area
from boatsim.physics.kinds.effect import Effect
from boatsim.physics.kinds.force import Force
from boatsim.physics.vessel import Vessel

LEVEL = {"heave", "roll", "pitch"}  # degrees of freedom without which a hull stays level
SEAS = ("irregular_sea", "strip_wave_loads", "panel_wave_loads", "hull_buoyancy")
Settings = dict[str, dict[str, float]]  # name of an effect -> parameter -> value
EffectTable = dict[str, Value]


@dataclass(frozen=True)
class Surroundings:
    """Wind, waves and current as the options of the command line give them; None for none.

    Attributes:
        wind: Speed [m/s] and the direction it comes from [deg].
        waves: Significant height [m], period of the peak of the spectrum [s] and the direction they
            come from [deg].
        current: Speed [m/s] and the direction it flows to [deg].
    """

    wind: tuple[float, ...] | None = None
    waves: tuple[float, ...] | None = None
    current: tuple[float, ...] | None = None


def parse_numbers(
    option: str, text: str | None, names: tuple[str, ...]
) -> tuple[float, ...] | None:
    """Return the numbers of an option such as `--wind 5,270`.

    Args:
        option: Name of the option, for messages.
        text: Its value; None if it was not given.
        names: What the numbers mean, in their order.

    Raises:
        BadInput: There are more or fewer numbers, or one is not finite or negative before the last.
    """
    if text is None:
        return None
    numbers = []
    for part in text.split(","):
        try:
            numbers.append(float(part))
        except ValueError:
            numbers.append(nan)
    if len(numbers) != len(names) or not all(map(isfinite, numbers)) or min(numbers[:-1]) < 0.0:
        raise BadInput(f"{option} {text}: write {','.join(names)}, numbers of 0 and more")
    return tuple(numbers)


def surroundings_tables(vessel: Vessel, given: Surroundings) -> tuple[Settings, list[EffectTable]]:
    """Return the changes of a scenario that give a vessel its wind, waves and current.

    An effect of the vessel or the scenario gets the values; where there is none, one is added.

    Args:
        vessel: The vessel with the effects of its scenario.
        given: Wind, waves and current.

    Returns:
        The table [set] by name of the effect or "measured", and further tables [[effect]].

    Raises:
        BadInput: The vessel has several effects of a kind, or one that has no such values.
    """
    settings: Settings = {}
    added: list[EffectTable] = []
    if given.current:
        speed, toward = given.current
        values = {"north": speed * cos(radians(toward)), "east": speed * sin(radians(toward))}
        _set_or_add(vessel, ("current",), "current", values, settings, added)
    if given.waves:
        height, period, comes_from = given.waves
        values = {
            "significant_height": height,
            "modal_period": period,
            "toward": _opposite(comes_from),
        }
        use = "irregular_sea"
        if set(vessel.dof) >= LEVEL:
            use = "strip_wave_loads"
        _set_or_add(vessel, SEAS, use, values, settings, added)
    if given.wind:
        _set_wind(vessel, given.wind, settings, added)
    return settings, added


def _opposite(comes_from: float) -> float:
    """Direction to which wind or waves move [rad], from that they come from [deg]."""
    return wrap(radians(comes_from) + pi)


def _set_or_add(
    vessel: Vessel,
    uses: tuple[str, ...],
    use: str,
    values: dict[str, float],
    settings: Settings,
    added: list[EffectTable],
) -> None:
    """Give the vessel's only effect of some types its values, or add one of them."""
    present = [effect for effect in vessel.effects if type(effect).type_name() in uses]
    if not present:
        added.append({"use": use, **values})
        return
    settings[_only(vessel, present).name] = values


def _only(vessel: Vessel, present: list[Effect]) -> Effect:
    if len(present) > 1:
        names = ", ".join(effect.name for effect in present)
        raise BadInput(f"{vessel.name} has several: {names}; set them in a scenario")
    return present[0]


def _set_wind(
    vessel: Vessel,
    wind: tuple[float, ...],
    settings: Settings,
    added: list[EffectTable],
) -> None:
    """Give the vessel's effect of the wind its speed and direction, or add one."""
    speed, comes_from = wind
    values = {"speed": speed, "toward": _opposite(comes_from)}
    present = [effect for effect in vessel.effects if isinstance(effect, Force) and effect.of_air]
    if not present:
        areas = {
            "front": frontal_drag_area(vessel.beam),
            "side": lateral_drag_area(vessel.length, vessel.beam),
            "arm": 0.0,
        }
        added.append({"use": "fan_wind", **values, **areas})
        return
    effect = _only(vessel, list(present))
    if set(values) <= set(type(effect).params()):
        settings[effect.name] = values
        return
    bound = vessel.bindings(effect)
    channels = bound.get("speed"), bound.get("comes_from")
    if not all(isinstance(channel, str) for channel in channels):
        raise BadInput(
            f"{vessel.name}: --wind does not apply to {effect.name}, which has no speed; "
            "set it in a scenario"
        )
    settings["measured"] = {
        str(channels[0]): speed,
        str(channels[1]): wrap(radians(comes_from)),
    }
