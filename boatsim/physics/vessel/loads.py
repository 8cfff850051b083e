"""Load conditions of a vessel file: tables of values that replace those of the file."""

from collections.abc import Mapping, Sequence
from itertools import combinations

from boatsim.errors import BadInput, unknown_name_message
from boatsim.files import array_of_tables
from boatsim.physics.vessel.effect_tables import effect_name

INNER_TABLES = ("body", "geometry", "manoeuvring", "diagnosis")
NUMBERS = ("length", "beam", "draught")

Loads = Mapping[str, Mapping[str, object]]


def check_loads_exist(names: Sequence[str], loads: Loads, label: str) -> None:
    """Check that a vessel file defines all load conditions with given names.

    Raises:
        BadInput: A load condition does not exist.
    """
    for name in names:
        if name not in loads:
            raise BadInput(unknown_name_message(f"{label}: load", name, loads))


def check_loads_compatible(names: Sequence[str], loads: Loads, label: str) -> None:
    """Check that no two of a vessel's load conditions set one number to different values.

    Raises:
        BadInput: With the two load conditions and the value.
    """
    for first, second in combinations(dict.fromkeys(names), 2):
        for key, (one, other) in conflicting_values(loads[first], loads[second]).items():
            raise BadInput(
                f"{label}: loads {first} ({key} = {one}) and {second} ({key} = {other}) exclude "
                "each other"
            )


def conflicting_values(
    first: Mapping[str, object], second: Mapping[str, object]
) -> dict[str, tuple[object, object]]:
    """Return the numbers that two load conditions set differently, with both values.

    The keys have the form "body.mass".
    """
    flat_first, flat_second = _dotted_keys(first), _dotted_keys(second)
    different: dict[str, tuple[object, object]] = {}
    for key, value in flat_first.items():
        if key in flat_second and value != flat_second[key]:
            different[key] = (value, flat_second[key])
    return different


def _dotted_keys(table: Mapping[str, object]) -> dict[str, object]:
    """Values of a load condition by dotted key: `length`, `body.mass`."""
    values: dict[str, object] = {}
    inner: dict[str, object] = {}
    for key, value in table.items():
        if isinstance(value, Mapping):
            for name, inner_value in value.items():
                inner[f"{key}.{name}"] = inner_value
        else:
            values[key] = value
    return values | inner


def apply_load_values(
    raw: Mapping[str, object], changes: Mapping[str, object], label: str
) -> dict[str, object]:
    """Return the content of a vessel file with some numbers replaced.

    The new values are those of a load condition or of the table [set] of a scenario.

    Args:
        raw: Content of the vessel file.
        changes: Name of an effect, "body", "geometry", "manoeuvring" or "diagnosis" -> values;
            "length", "beam" or "draught" -> number.
        label: Name of the file in messages.

    Raises:
        BadInput: For an effect or a table that does not exist.
    """
    changed = dict(raw)
    effects: list[dict[str, object]] = list(map(dict, array_of_tables(raw.get("effect"))))
    by_name: dict[str, dict[str, object]] = {}
    for table in effects:
        by_name.setdefault(effect_name(table), table)
    for key, value in changes.items():
        if key in by_name:
            if not isinstance(value, Mapping):
                raise BadInput(f"{label}: {key} = {value!r}; allowed is a table of its values")
            by_name[key].update(value)
        elif isinstance(value, dict) and key in INNER_TABLES:
            own = raw.get(key)
            if isinstance(own, Mapping):
                value = {**own, **value}
            changed[key] = value
        elif key in NUMBERS:
            changed[key] = value
        else:
            names = [*by_name, *INNER_TABLES, *NUMBERS]
            raise BadInput(unknown_name_message(f"{label}: table to change", key, names))
    changed["effect"] = effects
    return changed
