"""What `boatsim show` prints of an effect, controller, measure, sensor, vessel or scenario."""

from collections.abc import Sequence
from dataclasses import fields
from math import isnan
from pathlib import Path

from boatsim.cli.entry import CLASSES, entry
from boatsim.errors import BadInput, unknown_name
from boatsim.files import read_toml, tables
from boatsim.physics import content, vessel
from boatsim.physics.base import Effect
from boatsim.physics.vessel import CommandChannel, Vessel
from boatsim.simulate import cases


def about(name: str) -> list[str]:
    """Lines about everything of that name, or the vessel of a folder. Raises BadInput."""
    if not name:
        raise BadInput("the name is empty; boatsim list names all there is")
    if name.endswith(".py"):
        return _class("effect", name)
    path = Path(name)
    if name.endswith(".toml"):
        return _vessel(name) if "freedoms" in read_toml(path) else _scenario(name)
    found = [(k, _class(k, name)) for k in CLASSES if name in content.all_names(k)]
    if name in content.all_names("vessel") or (path / "vessel.toml").is_file():
        found.append(("vessel", _vessel(name)))
    known = content.all_names("scenario")
    if name in known or any(n.rpartition("/")[2] == name for n in known):
        found.append(("scenario", _scenario(name)))
    if not found:
        there = [n for k in (*CLASSES, "vessel", "scenario") for n in content.all_names(k)]
        raise BadInput(unknown_name("name", name, set(there)))
    return [line for i, (_, lines) in enumerate(found) for line in ([""] if i else []) + lines]


def _class(kind: str, name: str) -> list[str]:
    """An effect, controller, measure or sensor."""
    found = entry(kind, name)
    lines = [f"{found.name}: {kind}", f"  {found.words}"]
    lines += [f"  {line}".rstrip() for line in found.doc]
    lines += [f"  {what}: {text}" for what, text in found.said]
    wide = [max(map(len, column)) for column in zip(*found.numbers, strict=True)]
    for row in found.numbers:
        cells = (f"{cell:{width}}" for cell, width in zip(row, wide, strict=True))
        lines.append(f"  {'  '.join(cells)}".rstrip())
    return [*lines, "to paste:", *(f"  {line}" for line in found.paste)]


def _vessel(name: str) -> list[str]:
    """A vessel, of the library or of a user's folder."""
    boat = vessel.load(name)
    b, free = boat.body, ", ".join(boat.dof)
    lines = [
        f"{boat.name}: vessel",
        f"  {boat.about}",
        f"  source: {boat.source}",
        f"  file: {boat.file}",
        f"  length {boat.length:g} m, beam {boat.beam:g} m, draught {boat.draught:g} m; free in {free}",
        f"  mass {b.mass:g} kg, inertia in roll {b.roll_inertia:g} and yaw {b.yaw_inertia:g} kg m^2",
    ]
    if boat.commands:
        lines += ["  channels:", *_rows([_channel(boat, n, c) for n, c in boat.commands.items()])]
    if boat.measured:
        lines += ["  measured:", *_rows([(n, "", m.about) for n, m in boat.measured.items()])]
    lines += ["  effects:"]
    lines += [
        f"    {e.name}{'' if e.name == type(e).idea() else f' ({type(e).idea()})'}: {_values(e)}"
        for e in boat.effects
    ]
    if boat.loads:
        lines.append(f"  loads: {', '.join(boat.loads)}")
    if sd := boat.diagnosis.coefficient_uncertainty:
        lines.append(f"  uncertainty: {', '.join(f'{k} {100 * x:g} %' for k, x in sd.items())}")
    own = content.vessel_address(boat.file).endswith(".toml")
    given = name if own else boat.name
    file = f"{name}/vessel.toml" if own and not name.endswith(".toml") else given
    return [
        *lines,
        "to paste:",
        f'  vessel = "{file}"',
        f"  boatsim diagnose RUN.csv --vessel {given}",
    ]


def _channel(boat: Vessel, name: str, c: CommandChannel) -> tuple[str, str, str]:
    """Name, range with unit, words."""
    unit = boat.unit(name)
    return name, f"{c.low:g} to {c.high:g}{f' {unit}' if unit else ''}", c.about


def _rows(rows: Sequence[tuple[str, str, str]]) -> list[str]:
    wide = [max(len(row[i]) for row in rows) for i in range(2)]
    return [f"    {a:{wide[0]}}  {b:{wide[1]}}  {c}".rstrip() for a, b, c in rows]


def _values(effect: Effect) -> str:
    """Numbers of an effect that are not their defaults, with units."""
    default = {f.name: f.default for f in fields(effect)}
    cells = [
        f"{n} = {getattr(effect, n):.4g} {p.unit}".rstrip()
        for n, p in type(effect).params().items()
        if getattr(effect, n) != default[n] and not isnan(getattr(effect, n))
    ]
    return ", ".join(cells) or "as by default"


def _scenario(name: str) -> list[str]:
    """A scenario as its file and those it builds on say it."""
    if name.endswith(".toml") and cases.cases(content.find("scenario", name)):
        told = cases.meant(name)
        return [f"{Path(name).name}: scenarios", *(f"  {one}" for one in told)]
    said, place = cases.content(name)
    lines = [
        f"{place.name}: scenario",
        f"  {said.get('about', '')}".rstrip(),
        f"  file: {place.path}",
    ]
    for key in ("vessel", "load", "duration", "step", "seed"):
        if key in said:
            unit = " s" if key in ("duration", "step") else ""
            value = said[key]
            lines.append(
                f"  {key}: {', '.join(map(str, value)) if isinstance(value, list) else value}{unit}"
            )
    for key in ("controller", "measure"):
        table = said.get(key)
        if isinstance(table, dict):
            values = ", ".join(f"{k} = {v}" for k, v in table.items() if k != "use")
            lines.append(f"  {key}: {table.get('use', '')}{f' ({values})' if values else ''}")
    if effects := [str(t.get("use")) for t in tables(said.get("effect"))]:
        lines.append(f"  effects: {', '.join(effects)}")
    norms = said.get("norms")
    if isinstance(norms, dict) and norms:
        lines.append(f"  norms: {', '.join(norms)}")
    given = name if name.endswith(".toml") else place.name
    return [*lines, "to paste:", f"  boatsim run {given}", f'  base = "{given}"']
