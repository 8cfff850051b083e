"""Effects of [[effect]] tables, and the tables of effects."""

from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path

from boatsim.errors import BadInput
from boatsim.physics.content import effect_reference, load_class
from boatsim.physics.kinds.effect import Effect


def effect_from_table(table: Mapping[str, object], label: str, folder: Path) -> Effect:
    """Return the effect that an [[effect]] table of a vessel or scenario file describes.

    Args:
        table: The table; `use` names the type of the effect.
        label: Name of the file in messages.
        folder: Folder from which a relative path in `use` starts.

    Raises:
        BadInput: For an unknown type or parameter, or a value out of bounds.
    """
    use = table.get("use")
    if not isinstance(use, str):
        raise BadInput(f"{label}: an [[effect]] needs use = its name")
    settings = dict(table)
    del settings["use"]
    try:
        kind: type[Effect] = load_class("effect", use, folder)
        return kind.from_settings(with_absolute_paths(kind, settings, folder))
    except BadInput as error:
        raise BadInput(f"{label}: {error}") from None


def with_absolute_paths(
    kind: type[Effect], settings: Mapping[str, object], folder: Path
) -> dict[str, object]:
    """Return the settings of an effect in which all paths are absolute.

    Args:
        kind: Class of the effect.
        settings: The settings.
        folder: Folder from which a relative path starts.
    """
    found = dict(settings)
    for name in kind.paths:
        value = found.get(name)
        if isinstance(value, str) and value:
            found[name] = str((folder / value).resolve())
    return found


def effect_name(table: Mapping[str, object]) -> str:
    """Return the instance name of the effect that an [[effect]] table of a file describes."""
    return str(table.get("name", table.get("use")))


def effect_table(effect: Effect) -> dict[str, object]:
    """Return the [[effect]] table that describes an effect in a vessel file.

    It contains the effect's type and all values that are not defaults. Parameters in
    `effect.filled` are left out: a rule computes them when the vessel is loaded.
    """
    table: dict[str, object] = {"use": effect_reference(type(effect))}
    if effect.name != type(effect).type_name():
        table["name"] = effect.name
    for field in fields(effect):
        if "ours" in field.metadata or field.name == "name" or field.name in effect.filled:
            continue
        value = getattr(effect, field.name)
        is_default = value == field.default
        if "param" in field.metadata:
            is_default = is_default or not effect.has_value(field.name)
        if not is_default:
            table[field.name] = _toml_value(value)
    return table


def _toml_value(value: object) -> object:
    if isinstance(value, Mapping):
        return dict(value)
    if isinstance(value, tuple):
        return list(map(_toml_value, value))
    return value
