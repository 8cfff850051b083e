"""Writes a fitted boat back as a vessel file: the original with comments, recalibrated, the effects found added."""

import os
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import tomlkit
from tomlkit.items import InlineTable, Table

from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.report import spread_table
from boatsim.files import replacing
from boatsim.physics.base import Change, Channel, Effect, Release
from boatsim.physics.content import address, find, vessel_address
from boatsim.physics.vessel import Body, Vessel, effect_from_table, overlaid

DIGITS = 10  # significant, so that the file gives the fitted motion back
SAME = 1e-9  # numbers this close, relative, are one


def patched(
    problem: Problem,
    vessel: Vessel,
    found: Fit,
    path: Path,
    described: Mapping[str, Effect] | None = None,
) -> str:
    """Text of the patched vessel file that is to lie at `path`; its own paths start there, so that folders can move.

    `described` are the laws that a diagnosis wrote down, by name; what else of that kind was fitted are events of runs.
    """
    events = {e.name for e in problem.program.candidates if type(e).described} - set(
        described or {}
    )
    candidates = [
        (described or {}).get(e.name, e) for e in problem.program.candidates if e.name not in events
    ]
    text = vessel.file.read_text(encoding="utf-8-sig")
    base = tomlkit.parse(text).get("based_on")
    for key, empty in (("found", "[]"), ("based_on", '""')):  # new keys go first, above the tables
        if key not in tomlkit.parse(text):
            text = f"{key} = {empty}\n{text}"
    document = tomlkit.parse(text)
    document["based_on"] = tomlkit.item(_based_on(vessel, base, path))
    document["based_on"].comment("its folder holds the hull")
    laws = [e.name for e in candidates if e.name in found.effects and not isinstance(e, Release)]
    document["found"] = tomlkit.item(laws)
    document["found"].comment("effects that were added to it; the others it had")
    document.setdefault("effect", tomlkit.aot())
    settings: dict[str, dict[str, float]] = {name: {} for name in found.effects}
    for free, x in zip(found.free, found.theta, strict=True):
        if free.relative:
            for one in vessel.names_of(free.effect):
                change = Change(free.name, one, free.name, "scales", 1.0)
                _alter(document, vessel, change, float(x), f"recalibrated x {x:.4f}")
        else:
            settings[free.effect][free.name] = float(x)
    for effect in candidates:  # channels act in the order of the diagnosis
        if effect.name in settings and isinstance(effect, Release):
            _release(document, vessel, effect, settings[effect.name])
        elif effect.name in settings:
            named = {} if effect.name == type(effect).idea() else {"name": effect.name}
            bound: dict[str, object] = {"on": list(effect.on)} if effect.on else {}
            if isinstance(effect, Channel) and effect.other_side:
                bound["other_side"] = True
            said = named | bound | effect.shape() | settings[effect.name]
            table = _effect_table(_address(type(effect), vessel), said)
            table.add(tomlkit.nl())
            document["effect"].append(table)
    _hold(document, problem, vessel, found)
    document.pop("spread", None)  # that of an earlier diagnosis
    if (spread := spread_table.spread(problem, found, events)) is not None:
        document["spread"] = spread
    return str(tomlkit.dumps(document))


def write(
    problem: Problem,
    vessel: Vessel,
    found: Fit,
    path: Path,
    described: Mapping[str, Effect] | None = None,
) -> None:
    """Write the patched vessel file."""
    with replacing(path) as temporary:
        temporary.write_text(patched(problem, vessel, found, path, described), encoding="utf-8")


def _based_on(vessel: Vessel, base: str | None, path: Path) -> str:
    """A shipped vessel by its name, one's own by its way from the patched file's folder."""
    file = find("vessel", base, vessel.file.parent) if base else vessel.file
    name = vessel_address(file)
    return (
        os.path.relpath(file.resolve(), path.resolve().parent) if name.endswith(".toml") else name
    )


def _address(kind: type[Effect], vessel: Vessel) -> str:
    """An effect on the shelf by its name, one's own by its way from the vessel's folder."""
    name = address(kind)
    return os.path.relpath(name, vessel.path) if name.endswith(".py") else name


def _release(
    document: tomlkit.TOMLDocument, vessel: Vessel, release: Release, values: Mapping[str, float]
) -> None:
    """Write the numbers that a release found to be off."""
    for change in release.changes(vessel):
        if change.parameter in values:
            x = values[change.parameter]
            _alter(document, vessel, change, x, f"{release.name}, {change.parameter} = {x:.4g}")


def _alter(
    document: tomlkit.TOMLDocument, vessel: Vessel, change: Change, x: float, why: str
) -> None:
    """Change a number wherever the file states it: in the vessel's own table, and in those of loads."""
    if change.owner == "body":
        own, nominal = document["body"], getattr(vessel.body, change.key)
    else:
        place = [e.name for e in vessel.effects].index(change.owner)
        own, nominal = document["effect"][place], getattr(vessel.effect(change.owner), change.key)
    loads = {
        n: t[change.owner]
        for n, t in document.get("loads", {}).items()
        if change.key in t.get(change.owner, {})
    }
    for table in loads.values():
        _state(table, change.key, change.of(float(table[change.key]), x), why)
    if change.key in own or not any(n in loads for n in vessel.load):
        _state(own, change.key, change.of(float(own.get(change.key, nominal)), x), why)


def _hold(document: tomlkit.TOMLDocument, problem: Problem, vessel: Vessel, found: Fit) -> None:
    """State what the file's own rules would now fill in otherwise than the fitted boat had it."""
    values = problem.values(problem.recordings[0], found.free, found.theta)
    raw = document.unwrap()
    for name in vessel.load:
        raw = overlaid(raw, raw["loads"][name], name)
    boat = replace(vessel, body=Body(**raw["body"]), effects=())
    for table, given in zip(document["effect"], raw["effect"], strict=True):
        effect = effect_from_table(given, vessel.name, vessel.path).completed(boat)
        fitted = {n: float(values[problem.place(effect.name, n)]) for n in sorted(effect.filled)}
        off = {
            n: _rounded(x) for n, x in fitted.items() if abs(x - getattr(effect, n)) > SAME * abs(x)
        }
        for name, x in off.items():
            _state(table, name, x, "as fitted")
        boat = boat.composed_with(effect.having(off))


def _state(table: Table | InlineTable, name: str, value: float, why: str) -> None:
    """Put a number into a table with a comment, which an inline table has no room for; reasons add up."""
    before = table[name].trivia.comment.removeprefix("# ") if name in table else ""
    table[name] = tomlkit.item(_rounded(value))
    if not isinstance(table, InlineTable):
        table[name].comment(f"{before}; {why}" if before else why)


def _effect_table(name: str, settings: Mapping[str, object]) -> Table:
    table = tomlkit.table()
    table["use"] = name
    table["use"].comment("found by the diagnosis")
    for key, value in settings.items():
        table[key] = _rounded(value) if isinstance(value, float) else value
    return table


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")
