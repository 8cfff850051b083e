"""Facts of a run for its page: vessel, water, wind, waves and current, controller, seed."""

from collections.abc import Mapping, Sequence

from boatsim.physics.kinds.effect import Effect
from boatsim.simulate.evaluation import RunEntry
from boatsim.simulate.scenario import Scenario
from boatsim.version import version
from boatsim.view.content_names import plain_name
from boatsim.view.formatting import (
    capitalize,
    format_quantity,
    join_words,
    name_and_unit,
    name_in_words,
)

ENVIRONMENT = {  # heading -> effects of the library that belong to it
    "Wind": ("wind", "fan_wind", "gusty_wind", "measured_wind", "measured_relative_wind"),
    "Waves": (
        "irregular_sea",
        "strip_wave_loads",
        "panel_wave_loads",
        "filtered_sea",
        "wave_forcing",
        "yaw_rate_waves",
    ),
    "Current": ("current", "current_table"),
}
Settings = Mapping[str, object]


def run_facts(scenario: Scenario, result: RunEntry) -> list[tuple[str, str]]:
    """Return vessel, controller, water, seed and so on of a run, as pairs of label and text.

    Args:
        scenario: The scenario.
        result: Content of norms.json.
    """
    file = scenario.file
    vessel = scenario.vessel.name
    if scenario.vessel.load:
        vessel += f" ({join_words(map(name_in_words, scenario.vessel.load))})"
    facts = [
        ("Vessel", vessel),
        ("Controller", plain_name(result["controller"])),
        ("Water", _water(scenario)),
        *environment_facts(scenario),
        ("Seed of noise and random effects", str(result["seed"])),
        ("Time step", f"{1e3 * file.step:.4g} ms, control every {_period(scenario)}"),
        ("Version", f"boatsim {version()}"),
    ]
    return facts


def _period(scenario: Scenario) -> str:
    return f"{1e3 * scenario.controller.period:.4g} ms"


def _water(scenario: Scenario) -> str:
    tank = scenario.file.tank
    if tank is None:
        return "open water, without walls"
    return f"basin of {tank.length:.4g} m × {tank.width:.4g} m, {tank.depth:.4g} m deep"


def environment_facts(scenario: Scenario) -> list[tuple[str, str]]:
    """Return wind, waves and current of a scenario and the other effects that it adds.

    Args:
        scenario: The scenario.
    """
    file = scenario.file
    found: dict[str, list[str]] = {heading: [] for heading in ENVIRONMENT}
    added = []
    for effect in scenario.vessel.effects:
        heading = _heading_of(effect)
        settings = _settings_of(effect, file.effect, file.set)
        if heading and (settings or _is_active(effect)):
            found[heading].append(_described(effect, settings))
        elif not heading and _is_added(effect, file.effect):
            added.append(_described(effect, settings))
    present = [f"{heading}: {'; '.join(texts)}" for heading, texts in found.items() if texts]
    absent = [f"no {heading.lower()}" for heading, texts in found.items() if not texts]
    facts = [("Wind, waves and current", capitalize("; ".join([*present, *absent])))]
    measured = []
    for channel, value in file.measured.items():
        name, unit = name_and_unit(channel)
        measured.append(f"{name} {format_quantity(value, unit)}")
    if measured:
        facts.append(("Measured values", "; ".join(measured)))
    if added:
        facts.append(("Effects that the scenario adds", capitalize("; ".join(added))))
    return facts


def _heading_of(effect: Effect) -> str:
    for heading, names in ENVIRONMENT.items():
        if type(effect).type_name() in names:
            return heading
    if effect.wave_field() is not None:  # such as buoyancy, which also acts on still water
        return "Waves"
    return ""


def _is_added(effect: Effect, tables: Sequence[Settings]) -> bool:
    """Return whether an effect of the vessel comes from a table [[effect]] of the scenario."""
    return any(effect.name in (table.get("name"), table.get("use")) for table in tables)


def _is_active(effect: Effect) -> bool:
    """Return whether a number that sets the strength of an effect differs from zero."""
    params = type(effect).params()
    keys = type(effect).strength or tuple(key for key, one in params.items() if one.fit)
    return any(getattr(effect, key) != params[key].inactive_value for key in keys)


def _settings_of(
    effect: Effect, tables: Sequence[Settings], changes: Mapping[str, Settings]
) -> dict[str, object]:
    """Return the numbers that the scenario gives an effect."""
    settings: dict[str, object] = {}
    for table in tables:
        if effect.name in (table.get("name"), table.get("use")):
            settings |= table
    settings |= changes.get(effect.name, {})
    return {key: value for key, value in settings.items() if key in type(effect).params()}


def _described(effect: Effect, settings: Settings) -> str:
    """Return an effect with the numbers that the scenario gives it: weak reverse (factor 0.7)."""
    numbers = []
    for key, value in settings.items():
        if isinstance(value, int | float) and not isinstance(value, bool):
            unit = type(effect).params()[key].unit
            numbers.append(f"{name_in_words(key)} {format_quantity(float(value), unit)}")
    name = name_in_words(effect.name)
    if not numbers:
        return name
    return f"{name} ({', '.join(numbers)})"
