"""Dotted keys of a scenario: `fan_wind.speed`, `load`, `controller.use`, `start.x`, `goal.2.u_mps`.

A key is looked up first among the tables of the scenario, then among its [[effect]]s, then among
the effects of its vessel (by name, or all of one kind), and last in the library, whose effect is
then added with its defaults.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from operator import attrgetter
from typing import Literal, NamedTuple, TypeAlias

from boatsim.errors import BadInput, unknown_name_message
from boatsim.files import array_of_tables
from boatsim.physics import vessel as vessels
from boatsim.physics.content import all_content_names, load_class, shipped_content_names
from boatsim.physics.kinds.effect import Effect
from boatsim.simulate.cases import ScenarioLocation
from boatsim.simulate.controllers import controller_table
from boatsim.simulate.scenario import Scenario, ScenarioFile, from_table

Value: TypeAlias = "bool | int | float | str"
ScenarioTable: TypeAlias = Mapping[str, object]  # all keys of a scenario with their values
KeyPath: TypeAlias = "tuple[str | int, ...]"  # keys and indices that lead to a value of a scenario
Operation = Literal["", "+", "*"]  # replace the specified value, add to it, or multiply it

OF_VESSEL = ("body", "geometry")  # tables of a vessel's file, which [set.body] changes
MOST_DIGITS = 9  # of the number of a [[goal]] that are read; no scenario has so many
NONE = "none"  # value that removes a table
NOT_VARIED = ("about", "norms", "noise_widens_guards", "check")


class Slot(NamedTuple):
    """Place of one value in the table of a scenario, for a sweep that changes the value.

    Attributes:
        path: Keys and indices that lead to it.
        specified: Number that the scenario specifies, to which a change is added or applied.
    """

    path: KeyPath
    specified: float = 0.0


@dataclass(frozen=True)
class Target:
    """Scenario keys that one axis or one sampled quantity of a sweep changes, and how it does so.

    Attributes:
        keys: One key, or several that get the same value.
        operation: How the value is applied.
    """

    keys: tuple[str, ...]
    operation: Operation = ""

    @property
    def name(self) -> str:
        """Name of the changed scenario keys, as a column of the sweep's table."""
        return f"{','.join(self.keys)}{self.operation}"


def parse_target(text: str) -> Target:
    """Parse the text that names the scenario keys that a sweep changes.

    Args:
        text: `fan_wind.speed`, `port.x,starboard.x+` (value is added) or `body.mass*` (multiplied).

    Raises:
        BadInput: The text holds no key.
    """
    operation: Operation = ""
    if text.endswith("+"):
        operation = "+"
    elif text.endswith("*"):
        operation = "*"
    keys = tuple(map(str.strip, text.removesuffix(operation).split(",")))
    for key in keys:
        if not all(key.split(".")):
            raise BadInput(
                f"key {key!r}; allowed are names separated by dots, such as fan_wind.speed"
            )
    return Target(keys, operation)


def find_target_values(
    table: ScenarioTable, place: ScenarioLocation, target: Target
) -> tuple[ScenarioTable, list[Slot]]:
    """Find the values in a scenario's table that an axis or a sampled quantity of a sweep changes.

    Args:
        table: The scenario.
        place: Where it is stored.
        target: What is changed.

    Returns:
        The scenario with the effects that the target adds, and the values.

    Raises:
        BadInput: A key does not exist, or no number is specified to which a value can be added.
    """
    slots: list[Slot] = []
    for key in target.keys:
        table, paths = _find_key(table, place, key)
        if target.operation:
            scenario = from_table(table, place)
            slots += [Slot(path, _specified_number(scenario, path, key)) for path in paths]
        else:
            slots += map(Slot, paths)
    return table, slots


def set_values(
    table: ScenarioTable,
    place: ScenarioLocation,
    slots: Sequence[Slot],
    operation: Operation,
    value: Value,
) -> ScenarioTable:
    """Return the table of a scenario in which a sweep's value is set at some places.

    The value replaces the specified one, is added to it, or multiplies it.

    Args:
        table: The scenario.
        place: Where it is stored.
        slots: Values to change.
        operation: How the value is applied.
        value: The value.

    Raises:
        BadInput: The value cannot be applied.
    """
    for path, specified in slots:
        new = _apply_operation(operation, specified, value)
        if path == ("load",):
            table = {**table, "load": _resolve_loads(table, place, str(value))}
        elif path == ("controller", "use"):
            table = {**table, "controller": controller_table(str(value), table.get("controller"))}
        elif value == NONE and len(path) == 1:
            table = dict(table)
            table.pop(str(path[0]), None)
        else:
            table = _replace_value(table, path, new)
    return table


def _apply_operation(operation: Operation, specified: float, value: Value) -> Value:
    """Replace, increase or multiply the specified number."""
    if not operation:
        return value
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise BadInput(f"{value!r} is not a number and cannot be applied with {operation}")
    if operation == "+":
        return specified + float(value)
    return specified * float(value)


def _find_key(
    table: ScenarioTable, place: ScenarioLocation, key: str
) -> tuple[ScenarioTable, list[KeyPath]]:
    head, *rest = key.split(".")
    if head == "controller" and not rest:
        return table, [("controller", "use")]
    if head == "load" and not rest:
        return table, [("load",)]
    if head == "goal":
        return table, [_find_goal(table, rest)]
    if head == "sensor":
        return table, [("sensor", _sensor_index(table, rest[:1], key), *rest[1:])]
    if head == "effect":
        return _find_effect(table, place, rest, key)
    if head == "measure" and isinstance(table.get("measure"), str) and rest:
        return {**table, "measure": {"use": table["measure"]}}, [(head, *rest)]
    if head in ScenarioFile.model_fields and head not in NOT_VARIED:
        return table, [(head, *rest)]
    if head in OF_VESSEL:
        return table, [("set", head, *rest)]
    return _find_effect(table, place, [head, *rest], key)


def _find_effect(
    table: ScenarioTable, place: ScenarioLocation, rest: Sequence[str], key: str
) -> tuple[ScenarioTable, list[KeyPath]]:
    """Values of effects of the scenario, of the vessel, or of one added from the library."""
    name = rest[0] if rest else ""
    if len(rest) == 1 and name in shipped_content_names("effect"):
        kind: type[Effect] = load_class("effect", name)
        raise BadInput(f"{key} is an effect; add one of its parameters: {', '.join(kind.params())}")
    effects = array_of_tables(table.get("effect"))
    scenario_effects = [str(effect.get("name", effect.get("use"))) for effect in effects]
    if name in scenario_effects:
        return table, [("effect", scenario_effects.index(name), *rest[1:])]
    vessel = from_table(table, place).vessel
    own = vessel.names_of(name)
    if own:
        return table, [("set", one, *rest[1:]) for one in own]
    library = all_content_names("effect")
    if name in library:
        added = {**table, "effect": [*effects, {"use": name}]}
        return added, [("effect", len(scenario_effects), *rest[1:])]
    allowed = set(ScenarioFile.model_fields).difference(NOT_VARIED)
    allowed |= {*OF_VESSEL, *scenario_effects, *library}
    allowed.update(map(attrgetter("name"), vessel.effects))
    raise BadInput(unknown_name_message("key", name, allowed))


def _find_goal(table: ScenarioTable, rest: Sequence[str]) -> KeyPath:
    """Path of `goal.u_mps`, the only [[goal]] with that key, or of `goal.2.u_mps`, the second."""
    goals = array_of_tables(table.get("goal"))
    if rest and rest[0].isdecimal():
        number = int(rest[0][:MOST_DIGITS])
        if not 1 <= number <= len(goals):
            raise BadInput(
                f"goal.{number}: there is no such [[goal]]; the scenario has {len(goals)}, "
                "counted from 1"
            )
        return ("goal", number - 1, *rest[1:])
    key = rest[0] if rest else ""
    having = [index for index, goal in enumerate(goals) if key in goal]
    if key and len(having) == 1:
        return ("goal", having[0], *rest)
    if key and len(goals) == 1:
        return ("goal", 0, *rest)
    choices = []
    for number, goal in enumerate(goals, 1):
        choices += [f"goal.{number}.{k}" for k in goal if k in (key or k, "from")]
    raise BadInput(
        f"goal.{key}: name one [[goal]]; the scenario has {', '.join(choices) or 'none'}"
    )


def _sensor_index(table: ScenarioTable, name: Sequence[str], key: str) -> int:
    """Index of a [[sensor]]."""
    sensors = [str(sensor.get("use")) for sensor in array_of_tables(table.get("sensor"))]
    if not name or name[0] not in sensors:
        raise BadInput(unknown_name_message(f"{key}: sensor", name[0] if name else "", sensors))
    return sensors.index(name[0])


def _specified_number(scenario: Scenario, path: KeyPath, key: str) -> float:
    """The number specified for a value, or its default; raises BadInput if it is not a number."""
    head, *rest = path
    found: object
    if head == "controller":
        found = getattr(scenario.controller, str(rest[-1]), None)
    elif head in ("set", "effect"):
        found = _effect_value(scenario, path)
    else:
        found = _value_at(scenario.file.model_dump(), path)
    if isinstance(found, bool) or not isinstance(found, int | float) or not isfinite(found):
        raise BadInput(f"{key}: no number is specified that could be changed; give a new value")
    return float(found)


def _effect_value(scenario: Scenario, path: KeyPath) -> object:
    """A parameter of an effect, or of the vessel's body."""
    vessel = scenario.vessel
    owner = path[1]
    name = str(path[-1])
    if isinstance(owner, int):
        table = scenario.file.effect[owner]
        effect = vessel.effect(str(table.get("name", table["use"])))
        if effect:
            return getattr(effect, name, None)
        # An effect that has changed the vessel's parameters is not among its effects any more.
        kind: type[Effect] = load_class("effect", str(table["use"]))
        return table.get(name, getattr(kind, name, None))
    part = vessel.effect(owner)
    if owner in OF_VESSEL:
        part = getattr(vessel, owner)
    if isinstance(part, dict):
        return part.get(name)
    return getattr(part, name, None)


def _value_at(table: object, path: KeyPath) -> object:
    """The value at a path into tables and lists."""
    for step in path:
        if isinstance(table, list) and isinstance(step, int):
            table = table[step]
        else:
            if not isinstance(table, dict):
                return None
            table = table.get(step)
    return table


def _resolve_loads(table: ScenarioTable, place: ScenarioLocation, value: str) -> list[str]:
    """Loads of the scenario; `heavy` or `heavy+wide` replace those that they exclude."""
    specified = table.get("load", [])
    before = []
    if isinstance(specified, list):
        before = list(map(str, specified))
    more = list(filter(None, map(str.strip, value.split("+"))))
    return vessels.merge_load_conditions(str(table.get("vessel")), before, more, place.path.parent)


def _replace_value(table: object, path: KeyPath, value: object) -> dict[str, object]:
    """A copy of a table with one value changed."""
    head, *rest = path
    copy = dict(table) if isinstance(table, Mapping) else {}
    inner = copy.get(str(head))
    if not rest:
        copy[str(head)] = value
    elif isinstance(rest[0], int):
        items = list(inner) if isinstance(inner, list) else []
        index = rest[0]
        if rest[1:]:
            value = _replace_value(items[index], tuple(rest[1:]), value)
        items[index] = value
        copy[str(head)] = items
    else:
        copy[str(head)] = _replace_value(inner, tuple(rest), value)
    return copy
