"""What a dotted key means in a scenario: `fan_wind.speed`, `load`, `controller.use`, `start.x`, `goal.2.u_mps`.

A key is looked up among the scenario's own tables, then its [[effect]]s, then the effects of its vessel, by name or all
of one idea, then the library, whose effect is added with its defaults.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Literal, NamedTuple, TypeAlias, get_args

from boatsim.errors import BadInput, unknown_name
from boatsim.files import tables
from boatsim.physics import vessel as vessels
from boatsim.physics.content import all_names, find, load_class, names
from boatsim.physics.kinds.effect import Effect
from boatsim.simulate.cases import Place
from boatsim.simulate.scenario import Scenario, ScenarioFile, from_table

Value: TypeAlias = "bool | int | float | str"
Said: TypeAlias = Mapping[str, object]  # all that a scenario says
Steps: TypeAlias = "tuple[str | int, ...]"  # from the top of a scenario to one of its values
How = Literal["", "+", "*"]  # in place of what is stated, on top of it, times it

OF_VESSEL = ("body", "geometry")  # tables of a vessel's file, which [set.body] changes
NONE = "none"  # the value of a table that is left out
NOT_VARIED = ("about", "norms", "noise_widens_guards", "check")


class Slot(NamedTuple):
    """One value of a scenario, and what is stated there."""

    steps: Steps
    stated: float = 0.0  # where a change adds to it or multiplies it


@dataclass(frozen=True)
class Target:
    """What one axis or one draw changes: one key, or several that take the same number."""

    keys: tuple[str, ...]
    how: How = ""

    @property
    def name(self) -> str:
        """The column it has in the table."""
        return f"{','.join(self.keys)}{self.how}"


def target(text: str) -> Target:
    """`fan_wind.speed`, `port.x,starboard.x+` (added to what is stated) or `body.mass*` (times it). Raises BadInput."""
    how: How = next((sign for sign in get_args(How) if sign and text.endswith(sign)), "")
    keys = tuple(key.strip() for key in text.removesuffix(how).split(","))
    if wrong := next((key for key in keys if not all(key.split("."))), None):
        raise BadInput(
            f"key {wrong!r}; allowed are names with dots between them, such as fan_wind.speed"
        )
    if "" in keys:
        raise BadInput(f"key {text!r} is empty; say what is changed, such as fan_wind.speed")
    return Target(keys, how)


def slots(said: Said, place: Place, wanted: Target) -> tuple[Said, list[Slot]]:
    """The scenario with the effects that the keys add, and where the values stand. Raises BadInput."""
    found: list[Slot] = []
    for key in wanted.keys:
        said, many = _found(said, place, key)
        here = from_table(said, place) if wanted.how else None
        found += [Slot(steps, _stated(here, steps, key) if here else 0.0) for steps in many]
    return said, found


def laid(said: Said, place: Place, at: Sequence[Slot], how: How, value: Value) -> Said:
    """The scenario with a value at its places. Raises BadInput."""
    for steps, stated in at:
        if how and (isinstance(value, bool) or not isinstance(value, int | float)):
            raise BadInput(
                f"{value!r} is no number that can be {'added' if how == '+' else 'multiplied'}"
            )
        new = (
            stated + float(value) if how == "+" else stated * float(value) if how == "*" else value
        )
        if steps == ("load",):
            said = {**said, "load": _loads(said, place, str(value))}
        elif steps == ("controller", "use"):
            said = {**said, "controller": _controller(said, str(value))}
        elif value == NONE and len(steps) == 1:
            said = {key: rest for key, rest in said.items() if key != steps[0]}
        else:
            said = _with(said, steps, new)
    return said


def _found(said: Said, place: Place, key: str) -> tuple[Said, list[Steps]]:
    head, *rest = key.split(".")
    if head in ("controller", "load") and not rest:
        return said, [("controller", "use") if head == "controller" else ("load",)]
    if head == "goal":
        return said, [_goal(said, rest)]
    if head == "sensor":
        return said, [("sensor", _listed(said, "sensor", rest[:1], key), *rest[1:])]
    if head == "effect":
        return _effect(said, place, rest, key)
    if head == "measure" and isinstance(said.get("measure"), str) and rest:
        return {**said, "measure": {"use": said["measure"]}}, [(head, *rest)]
    if head in ScenarioFile.model_fields and head not in NOT_VARIED:
        return said, [(head, *rest)]
    if head in OF_VESSEL:
        return said, [("set", head, *rest)]
    return _effect(said, place, [head, *rest], key)


def _effect(said: Said, place: Place, rest: Sequence[str], key: str) -> tuple[Said, list[Steps]]:
    """Values of the scenario's effects, of the vessel's, or of one that is added from the library."""
    name = rest[0] if rest else ""
    if len(rest) == 1 and name in names("effect"):
        kind: type[Effect] = load_class("effect", name)
        raise BadInput(f"{key} is an effect; say which of its values: {', '.join(kind.params())}")
    extra = [str(table.get("name", table.get("use"))) for table in tables(said.get("effect"))]
    if name in extra:
        return said, [("effect", extra.index(name), *rest[1:])]
    own = from_table(said, place).vessel.names_of(name)
    if own:
        return said, [("set", one, *rest[1:]) for one in own]
    if name in all_names("effect"):
        return {**said, "effect": [*tables(said.get("effect")), {"use": name}]}, [
            ("effect", len(extra), *rest[1:])
        ]
    mine = [e.name for e in from_table(said, place).vessel.effects]
    keys = [k for k in ScenarioFile.model_fields if k not in NOT_VARIED]
    raise BadInput(
        unknown_name("key", name, {*keys, *OF_VESSEL, *extra, *mine, *all_names("effect")})
    )


def _goal(said: Said, rest: Sequence[str]) -> Steps:
    """`goal.u_mps` is the only [[goal]] that says it, `goal.2.u_mps` that of the second."""
    goals = tables(said.get("goal"))
    if rest and rest[0].isdigit():
        number = int(rest[0])
        if not 1 <= number <= len(goals):
            raise BadInput(
                f"goal.{number}: there is no such [[goal]]; there are {len(goals)}, counted from 1"
            )
        return ("goal", number - 1, *rest[1:])
    key = rest[0] if rest else ""
    saying = [i for i, goal in enumerate(goals) if key in goal]
    if not key or not goals or len(saying) > 1 or (not saying and len(goals) > 1):
        there = [
            f"goal.{i + 1}.{k}"
            for i, goal in enumerate(goals)
            for k in goal
            if k in (key or k, "from")
        ]
        raise BadInput(f"goal.{key}: say of which [[goal]]; there are {', '.join(there) or 'none'}")
    return ("goal", saying[0] if saying else 0, *rest)


def _listed(said: Said, what: str, name: Sequence[str], key: str) -> int:
    """Number of the [[sensor]] that is meant."""
    there = [str(table.get("use")) for table in tables(said.get(what))]
    if not name or name[0] not in there:
        raise BadInput(unknown_name(f"{key}: {what}", name[0] if name else "", there))
    return there.index(name[0])


def _stated(scenario: Scenario, steps: Steps, key: str) -> float:
    """The number that stands there now, a default too. Raises BadInput where there is none."""
    head, *rest = steps
    found = _of_effect(scenario, steps) if head in ("set", "effect") else None
    if head == "controller":
        found = getattr(scenario.controller, str(rest[-1]), None)
    elif head not in ("set", "effect"):
        found = _within(scenario.file.model_dump(), steps)
    if isinstance(found, bool) or not isinstance(found, int | float) or not isfinite(found):
        raise BadInput(
            f"{key}: no number is stated there that could be changed; say what it is to be"
        )
    return float(found)


def _of_effect(scenario: Scenario, steps: Steps) -> object:
    """A value of an effect, or of the vessel's body."""
    vessel, owner, last = scenario.vessel, steps[1], str(steps[-1])
    if isinstance(owner, int):
        table = scenario.file.effect[owner]
        effect = vessel.effect(str(table.get("name", table["use"])))
        # one that has changed the vessel's numbers, and is not there any more, has its defaults
        return (
            getattr(effect, last, None)
            if effect
            else table.get(last, getattr(_kind(table), last, None))
        )
    here = getattr(vessel, owner) if owner in OF_VESSEL else vessel.effect(owner)
    return here.get(last) if isinstance(here, dict) else getattr(here, last, None)


def _kind(table: Mapping[str, object]) -> type[Effect]:
    found: type[Effect] = load_class("effect", str(table["use"]))
    return found


def _within(table: object, steps: Steps) -> object:
    """What stands at some steps into tables and lists."""
    for step in steps:
        known_as = table.get(step) if isinstance(table, dict) else None
        table = table[step] if isinstance(table, list) and isinstance(step, int) else known_as
    return table


def _loads(said: Said, place: Place, value: str) -> list[str]:
    """Loads of the scenario with others, `heavy` or `heavy+wide`, in place of those that exclude them."""
    stated = said.get("load", [])
    before = [str(one) for one in stated] if isinstance(stated, list) else []
    more = [one.strip() for one in value.split("+") if one.strip()]
    return vessels.merged_loads(str(said.get("vessel")), before, more, place.path.parent)


def _controller(said: Said, value: str) -> Mapping[str, object]:
    """Another controller, with its defaults; where it is the scenario's own, its settings stay."""
    load_class("controller", value, named=True)
    use = value if value in names("controller") else str(find("controller", value))
    own = said.get("controller")
    return own if isinstance(own, dict) and own.get("use") == use else {"use": use}


def _with(table: object, steps: Steps, value: object) -> dict[str, object]:
    """A copy of a table with one value changed."""
    head, *rest = steps
    mine = dict(table) if isinstance(table, Mapping) else {}
    if not rest:
        return {**mine, str(head): value}
    inner = mine.get(str(head))
    if isinstance(rest[0], int):
        items = list(inner) if isinstance(inner, list) else []
        at = rest[0]
        items[at] = _with(items[at], tuple(rest[1:]), value) if rest[1:] else value
        return {**mine, str(head): items}
    return {**mine, str(head): _with(inner, tuple(rest), value)}
