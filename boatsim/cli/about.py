"""What `boatsim show` prints of an effect, controller, measure, sensor, vessel or scenario."""

from collections.abc import Iterator, Sequence
from dataclasses import fields
from inspect import getdoc
from math import isnan
from pathlib import Path
from typing import Any

from boatsim.errors import BadInput, unknown_name
from boatsim.files import read_toml, tables
from boatsim.physics import content, vessel
from boatsim.physics.base import Channel, Effect, Param
from boatsim.physics.vessel import CommandChannel, Vessel
from boatsim.simulate import cases

CLASSES = ("effect", "controller", "measure", "sensor")
PASTED = {  # how each stands in a file
    "effect": "[[effect]]",
    "controller": "[controller]",
    "measure": "[measure]",
    "sensor": "[[sensor]]",
}


def about(name: str) -> list[str]:
    """Lines about everything of that name, or the vessel of a folder. Raises BadInput."""
    if not name:
        raise BadInput("the name is empty; boatsim list names all there is")
    if name.endswith(".py"):
        return _class("effect", name)
    path = Path(name)
    if name.endswith(".toml"):
        return _vessel(name) if "freedoms" in read_toml(path) else _scenario(name)
    found = [(k, _class(k, name)) for k in CLASSES if name in content.known(k)]
    if name in content.known("vessel") or (path / "vessel.toml").is_file():
        found.append(("vessel", _vessel(name)))
    known = content.known("scenario")
    if name in known or any(n.rpartition("/")[2] == name for n in known):
        found.append(("scenario", _scenario(name)))
    if not found:
        there = [n for k in (*CLASSES, "vessel", "scenario") for n in content.known(k)]
        raise BadInput(unknown_name("name", name, set(there)))
    return [line for i, (_, lines) in enumerate(found) for line in ([""] if i else []) + lines]


def _class(kind: str, name: str) -> list[str]:
    """An effect, controller, measure or sensor."""
    made = content.load_class(kind, name, named=True)
    called = Path(name).stem
    params: dict[str, Param] = made.params() if hasattr(made, "params") else {}
    lines = [f"{called}: {kind}", f"  {made.words}"]
    if (doc := getdoc(made)) and doc.partition("\n")[0].rstrip(".") != made.words:
        lines += [f"  {line}".rstrip() for line in doc.splitlines()]
    lines += [f"  {what}: {text}" for what, text in _said(made)]
    lines += _numbers(made, params)
    return [*lines, "to paste:", *(f"  {line}" for line in _paste(kind, called, made, params))]


def _said(made: type[Any]) -> Iterator[tuple[str, str]]:
    """What its class says of itself beside numbers."""
    if text := getattr(made, "source", ""):
        yield "source", text
    if issubclass(made, Effect):
        if made.shown_by:
            yield "shows in", made.shown_by
        for role, said in made.roles.items():
            yield (
                f"on.{role}",
                f"{said.words} [{said.unit}]{'' if said.fixed is None else f'; {said.fixed:g} if left out'}",
            )
        if issubclass(made, Channel) and made.acts_on:
            yield "acts on", f"commands of {made.acts_on.replace('|', ' or ')}"
        if made.rides:
            yield "rides on", made.rides
    units = getattr(made, "units", None)
    if units:
        yield "norms", ", ".join(f"{n} [{u}]" if u else n for n, u in units.items())
    if goals := getattr(made, "goals", ()):
        yield "goals", ", ".join(goals)


def _numbers(made: type[Any], params: dict[str, Param]) -> list[str]:
    """A line for each parameter: default, unit, bounds, words."""
    rows = []
    nominal = {f.name: f.default for f in fields(made)} if params else {}
    for name, p in params.items():
        if p.low == -1e9 and not p.unit and not p.fit:  # a number by which a program knows a word
            continue
        rows.append((name, f"{_default(nominal[name], p)} {p.unit}".rstrip(), f"{p.low:g} to {p.high:g}", p.words))
    if not rows:
        return []
    head = ("parameter", "default", "allowed", "what")
    wide = [max(len(row[i]) for row in (head, *rows)) for i in range(3)]
    return [f"  {a:{wide[0]}}  {b:{wide[1]}}  {c:{wide[2]}}  {d}".rstrip() for a, b, c, d in (head, *rows)]


def _default(value: Any, p: Param) -> str:
    if isinstance(value, int | float) and not isnan(value):
        return f"{value:g}"
    return f"= {p.follows.removesuffix('?')}" if p.follows else "by rule or 0"


def _paste(kind: str, name: str, made: type[Any], params: dict[str, Param]) -> Iterator[str]:
    """The table as it stands in a file."""
    yield PASTED[kind]
    yield f'use = "{name}"'
    if issubclass(made, Effect) and made.roles:
        bound = ", ".join(f'{role} = "CHANNEL"' for role, said in made.roles.items() if said.fixed is None)
        yield f"on = {{ {bound} }}"
    nominal = {f.name: f.default for f in fields(made)} if params else {}
    fitted = [n for n, p in params.items() if p.fit or p.calibrates] or list(params)
    for n in fitted[:6]:
        value = nominal[n]
        if isinstance(value, int | float) and not isnan(value):
            unit = params[n].unit
            yield f"{n} = {value!r}{f'  # [{unit}]' if unit else ''}"


def _vessel(name: str) -> list[str]:
    """A vessel, of the library or of a user's folder."""
    boat = vessel.load(name)
    b, free = boat.body, ", ".join(boat.freedoms)
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
        f"    {e.name}{'' if e.name == type(e).idea() else f' ({type(e).idea()})'}: {_values(e)}" for e in boat.effects
    ]
    if boat.loads:
        lines.append(f"  loads: {', '.join(boat.loads)}")
    if sd := boat.diagnosis.coefficient_uncertainty:
        lines.append(f"  uncertainty: {', '.join(f'{k} {100 * x:g} %' for k, x in sd.items())}")
    own = content.vessel_address(boat.file).endswith(".toml")
    given = name if own else boat.name
    file = f"{name}/vessel.toml" if own and not name.endswith(".toml") else given
    return [*lines, "to paste:", f'  vessel = "{file}"', f"  boatsim diagnose RUN.csv --vessel {given}"]


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
    lines = [f"{place.name}: scenario", f"  {said.get('about', '')}".rstrip(), f"  file: {place.path}"]
    for key in ("vessel", "load", "duration", "step", "seed"):
        if key in said:
            unit = " s" if key in ("duration", "step") else ""
            value = said[key]
            lines.append(f"  {key}: {', '.join(map(str, value)) if isinstance(value, list) else value}{unit}")
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
