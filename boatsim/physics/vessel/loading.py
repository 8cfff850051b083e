"""Loading of vessel files: content by name, load conditions, settings and further effects."""

import dataclasses
from collections.abc import Mapping, Sequence
from pathlib import Path

from boatsim.errors import BadInput
from boatsim.files import read_toml, validate_table
from boatsim.physics.content import find_content_file
from boatsim.physics.particulars import check_slenderness
from boatsim.physics.vessel import loads as load_conditions
from boatsim.physics.vessel.effect_tables import effect_from_table, effect_name
from boatsim.physics.vessel.estimated import check_estimated_table
from boatsim.physics.vessel.model import FILE_NAME, Vessel
from boatsim.physics.vessel.schema import VesselFile


def load_vessel(
    name: str,
    loads: Sequence[str] = (),
    settings: Mapping[str, Mapping[str, object]] | None = None,
    extra: Sequence[Mapping[str, object]] = (),
    base_folder: Path | None = None,
) -> Vessel:
    """Load a vessel by name or path, in given load conditions and with changed numbers.

    Args:
        name: Name of a shipped vessel, or path of a vessel.toml or of its folder.
        loads: Load conditions in force.
        settings: Values that replace those of the file: name of an effect or "body" -> key ->
            value.
        extra: Tables of further effects, as [[effect]] of a scenario.
        base_folder: Folder of the file that names the vessel; relative paths start there.

    Raises:
        BadInput: For names, keys and values that do not exist or are out of bounds: one line with
            file, key, value found, what is allowed and the nearest valid name.
    """
    path = find_content_file("vessel", name, base_folder)
    vessel_name = path.stem
    if path.name == FILE_NAME:
        vessel_name = path.parent.name
    label = _label(path)
    raw: Mapping[str, object] = read_toml(path)
    conditions = validate_table(VesselFile, raw, label).loads
    load_conditions.check_loads_exist(loads, conditions, label)
    load_conditions.check_loads_compatible(loads, conditions, label)
    for one in dict.fromkeys(loads):
        raw = load_conditions.apply_load_values(raw, conditions[one], label)
    raw = load_conditions.apply_load_values(raw, dict(settings or {}), label)
    content = validate_table(VesselFile, raw, label)
    content.check_channels(label)
    try:
        check_slenderness(content.length, content.body.mass)
    except BadInput as error:
        raise BadInput(f"{label}: {error}") from None
    _check_new_names(extra, content, vessel_name)
    folder = _hull_folder(content.based_on, path, label)
    vessel = Vessel.from_file(content, vessel_name, path, folder)
    vessel = dataclasses.replace(vessel, load=tuple(loads))
    vessel = with_effect_tables(vessel, content.effect, folder, label)
    vessel = with_effect_tables(vessel, extra, base_folder or folder, label)
    vessel.check(label)
    check_estimated_table(vessel.estimated, vessel, label)
    return vessel


def merge_load_conditions(
    name: str, loads: Sequence[str], more: Sequence[str], base_folder: Path | None = None
) -> list[str]:
    """Return a vessel's load conditions with others added.

    Load conditions that exclude one of the added ones are removed.

    Args:
        name: Name or path of the vessel.
        loads: Load conditions in force.
        more: Load conditions to add.
        base_folder: Folder of the file that names the vessel; relative paths start there.

    Raises:
        BadInput: For a load condition that does not exist.
    """
    path = find_content_file("vessel", name, base_folder)
    label = _label(path)
    conditions = validate_table(VesselFile, read_toml(path), label).loads
    load_conditions.check_loads_exist(more, conditions, label)
    merged: list[str] = []
    for one in loads:
        excluded = one not in conditions or any(
            load_conditions.conflicting_values(conditions[one], conditions[new]) for new in more
        )
        if not excluded:
            merged.append(one)
    return list(dict.fromkeys((*merged, *more)))


def with_effect_tables(
    vessel: Vessel, tables: Sequence[Mapping[str, object]], folder: Path, label: str
) -> Vessel:
    """Return a copy of a vessel with the effects of [[effect]] tables added in their order.

    Args:
        vessel: The vessel.
        tables: The [[effect]] tables.
        folder: Folder from which relative paths of effect files start.
        label: Name of the file in messages.

    Raises:
        BadInput: For an unknown effect or parameter, or a value out of bounds.
    """
    for table in tables:
        vessel = vessel.with_completed_effect(effect_from_table(table, label, folder))
    return vessel


def _label(path: Path) -> str:
    """Name of a vessel file in messages: folder and file."""
    return f"{path.parent.name}/{path.name}"


def _check_new_names(
    extra: Sequence[Mapping[str, object]], content: VesselFile, vessel_name: str
) -> None:
    own = list(map(effect_name, content.effect))
    for name in map(effect_name, extra):
        if name in own:
            raise BadInput(
                f"{name} is one of {vessel_name}'s own effects; change its values in [set.{name}], "
                "or give the second one another name"
            )


def _hull_folder(based_on: str, path: Path, label: str) -> Path:
    """Folder of the hull and of the vessel's own effect files."""
    if not based_on:
        return path.parent
    try:
        return find_content_file("vessel", based_on, path.parent).parent
    except BadInput as error:
        raise BadInput(f"{label}: based_on: {error}") from None
