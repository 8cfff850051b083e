"""Implementation of `boatsim list` and `boatsim show`: names and descriptions of all content."""

from collections.abc import Sequence
from dataclasses import fields
from fnmatch import fnmatchcase
from functools import partial
from itertools import starmap
from math import degrees, isnan
from pathlib import Path

from boatsim.cli.entry import CLASSES, class_description
from boatsim.errors import BadInput, unknown_name_message
from boatsim.files import array_of_tables, read_toml
from boatsim.physics import content, vessel
from boatsim.physics.base import Effect
from boatsim.physics.vessel import CommandChannel, Vessel
from boatsim.simulate import cases

LISTED_KINDS = ("vessels", "controllers", "effects", "sensors", "measures", "scenarios")


def list_content(kind: str | None, like: str | None = None) -> list[str]:
    """Return the output of `boatsim list`: names and descriptions of vessels, effects and so on.

    Each kind has a heading.

    Args:
        kind: One of LISTED_KINDS; None for all of them.
        like: Text that a name contains, or a pattern that it matches; None for all names.

    Raises:
        BadInput: No name is like `like`.
    """
    kinds: tuple[str, ...] = LISTED_KINDS
    what = "name"
    if kind is not None:
        kinds = (kind,)
        what = kind.removesuffix("s")
    lines: list[str] = []
    every_name: list[str] = []
    for plural in kinds:
        one = plural.removesuffix("s")
        names = content.all_content_names(one)
        every_name += names
        if like is not None:
            names = list(filter(partial(_is_similar, like=like), names))
            if not names:
                continue
        if lines:
            lines.append("")
        lines.append(f"{plural}:")
        width = max(map(len, names), default=0)
        for name in names:
            lines.append(f"  {name:{width}}  {_summarise_item(one, name)}")
    if like is not None and not lines:
        raise BadInput(unknown_name_message(what, like, every_name))
    return lines


def _is_similar(name: str, like: str) -> bool:
    if not set("*?[").isdisjoint(like):
        return fnmatchcase(name, like)
    return like in name


def _summarise_item(kind: str, name: str) -> str:
    """One line about an item."""
    if kind == "scenario":
        return str(cases.read_scenario(name)[0].get("about", ""))
    if kind == "vessel":
        return str(read_toml(content.find_content_file(kind, name)).get("about", ""))
    return str(content.load_class(kind, name).words)


def item_descriptions(name: str) -> list[str]:
    """Return the output of `boatsim show`: the description of each item of a name, file or folder.

    Args:
        name: Name of an item, a .py or .toml file, or the folder of a vessel.

    Raises:
        BadInput: There is no such item.
    """
    if not name:
        raise BadInput("the name is empty; boatsim list prints all names")
    if name.endswith(".py"):
        return _class_lines("effect", name)
    if name.endswith(".toml"):
        if "freedoms" in read_toml(Path(name)):
            return _vessel_lines(name)
        return _scenario_lines(name)
    found = []
    for kind in CLASSES:
        if name in content.all_content_names(kind):
            found.append(_class_lines(kind, name))
    if name in content.all_content_names("vessel") or (Path(name) / "vessel.toml").is_file():
        found.append(_vessel_lines(name))
    scenarios = content.all_content_names("scenario")
    if name in scenarios or any(one.rpartition("/")[2] == name for one in scenarios):
        found.append(_scenario_lines(name))
    if not found:
        every_name = set(scenarios).union(
            content.all_content_names("vessel"), *map(content.all_content_names, CLASSES)
        )
        raise BadInput(unknown_name_message("name", name, every_name))
    lines = found[0]
    for more in found[1:]:
        lines += ["", *more]
    return lines


def _class_lines(kind: str, name: str) -> list[str]:
    """Description of an effect, controller, measure or sensor."""
    item = class_description(kind, name)
    lines = [f"{item.name}: {kind}", f"  {item.words}"]
    lines += map(str.rstrip, map("  {}".format, item.doc))
    lines += starmap("  {}: {}".format, item.facts)
    lines += _align_columns(item.parameters, "  ")
    return [*lines, "example:", *map("  {}".format, item.example)]


def _vessel_lines(name: str) -> list[str]:
    """Description of a vessel of the library or of a user's folder."""
    boat = vessel.load_vessel(name)
    body = boat.body
    inertia = f"inertia in roll {body.roll_inertia:g} and yaw {body.yaw_inertia:g} kg m^2"
    lines = [
        f"{boat.name}: vessel",
        f"  {boat.about}",
        f"  source: {boat.source}",
        f"  file: {boat.file}",
        f"  length {boat.length:g} m, beam {boat.beam:g} m, draught {boat.draught:g} m; "
        f"degrees of freedom: {', '.join(boat.dof)}",
        f"  mass {body.mass:g} kg, {inertia}",
    ]
    if boat.commands:
        lines.append("  channels:")
        lines += _align_columns(
            [_channel_row(boat, n, c) for n, c in boat.commands.items()], "    "
        )
    if boat.measured:
        lines.append("  measured:")
        lines += _align_columns([(n, "", m.about) for n, m in boat.measured.items()], "    ")
    lines.append("  effects:")
    for effect in boat.effects:
        lines.append(_effect_line(boat, effect))
    if boat.loads:
        lines.append(f"  loads: {', '.join(boat.loads)}")
    if uncertainty := boat.diagnosis.coefficient_uncertainty:
        shares = []
        for key, share in uncertainty.items():
            shares.append(f"{key} {100 * share:g} %")
        lines.append(f"  uncertainty: {', '.join(shares)}")
    address = boat.name
    file = boat.name
    if content.vessel_reference(boat.file).endswith(".toml"):  # the vessel of a user
        address = name
        file = name
        if not name.endswith(".toml"):
            file = f"{name}/vessel.toml"
    example = [f'  vessel = "{file}"', f"  boatsim diagnose RUN.csv --vessel {address}"]
    return [*lines, "example:", *example]


def _channel_row(boat: Vessel, name: str, channel: CommandChannel) -> tuple[str, str, str]:
    """Name, range with unit, and description of a command channel."""
    span = f"{channel.low:g} to {channel.high:g} {boat.unit(name)}".rstrip()
    return name, span, channel.about


def _align_columns(rows: Sequence[Sequence[str]], indent: str) -> list[str]:
    """Lines of a table whose columns are as wide as their longest cell."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = []
    for row in rows:
        cells = map(str.ljust, row, widths)
        lines.append(f"{indent}{'  '.join(cells)}".rstrip())
    return lines


def _effect_line(boat: Vessel, effect: Effect) -> str:
    """Name of an effect, its direction, and parameters that differ from their defaults."""
    kind = type(effect)
    name = effect.name
    if name != kind.type_name():
        name = f"{name} ({kind.type_name()})"
    default = {field.name: field.default for field in fields(effect)}
    cells = []
    for key, param in kind.params().items():
        value = getattr(effect, key)
        if value != default[key] and not isnan(value):
            cells.append(f"{key} = {value:.4g} {param.unit}".rstrip())
    cells += _thrust_direction(boat, effect)
    return f"    {name}: {', '.join(cells) or 'default values'}"


def _thrust_direction(boat: Vessel, effect: Effect) -> list[str]:
    """The direction of the thrust of a drive in words; [] for another effect."""
    roles = type(effect).roles
    drives = {"thrust", "shaft"} & set(roles)
    if not drives or "angle" not in roles or roles["angle"].fixed is None:
        return []
    bound = boat.bindings(effect)
    angle = bound.get("angle", roles["angle"].fixed)
    if isinstance(angle, str):
        direction = f"turned by {angle}"
    elif angle == 0.0:
        direction = "pushes ahead"
    else:
        side = "starboard" if angle > 0.0 else "port"
        direction = f"pushes {abs(degrees(angle)):.3g} deg to {side}"
    commands = [str(bound[role]) for role in sorted(drives) if role in bound]
    return [direction, f"driven by {', '.join(commands)}"]


def _scenario_lines(name: str) -> list[str]:
    """Description of a scenario, with the values of the files it builds on."""
    if name.endswith(".toml") and cases.case_names(content.find_content_file("scenario", name)):
        return [f"{Path(name).name}: scenarios", *map("  {}".format, cases.find_scenarios(name))]
    table, place = cases.read_scenario(name)
    lines = [
        f"{place.name}: scenario",
        f"  {table.get('about', '')}".rstrip(),
        f"  file: {place.path}",
    ]
    units = {"vessel": "", "load": "", "duration": " s", "step": " s", "seed": ""}
    for key, unit in units.items():
        if key in table:
            value = table[key]
            if isinstance(value, list):
                value = ", ".join(map(str, value))
            lines.append(f"  {key}: {value}{unit}")
    for key in ("controller", "measure"):
        inner = table.get(key)
        if isinstance(inner, dict):
            values = ", ".join(f"{k} = {v}" for k, v in inner.items() if k != "use")
            line = f"  {key}: {inner.get('use', '')}"
            if values:
                line += f" ({values})"
            lines.append(line)
    if effects := [str(effect.get("use")) for effect in array_of_tables(table.get("effect"))]:
        lines.append(f"  effects: {', '.join(effects)}")
    metrics = table.get("norms")
    if isinstance(metrics, dict) and metrics:
        lines.append(f"  metrics: {', '.join(metrics)}")
    address = place.name
    if name.endswith(".toml"):
        address = name
    return [*lines, "example:", f"  boatsim run {address}", f'  base = "{address}"']
