"""The patched vessel file: the original with comments, recalibrated, with the effects added."""

import os
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import tomlkit
from tomlkit.items import InlineTable, Table

from boatsim.diagnosis.answer.group_words import group_entry, group_in_words
from boatsim.diagnosis.output import spread_table
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.files import replace_file
from boatsim.physics.base import ChannelEffect, CoefficientChange, CoefficientRelease, Effect
from boatsim.physics.content import effect_reference, find_content_file, vessel_reference
from boatsim.physics.groups import group_of, name_in_group, without_group
from boatsim.physics.vessel import Body, Vessel, apply_load_values, effect_from_table

DIGITS = 10  # significant, so that the file reproduces the fitted motion
SAME = 1e-9  # relative difference below which two numbers are the same


def patched_vessel_text(
    problem: Problem,
    vessel: Vessel,
    found: Fit,
    path: Path,
    described: Mapping[str, Effect] | None = None,
) -> str:
    """Return the text of the patched vessel file, with refitted coefficients and added effects.

    The original file with its comments is edited.

    Args:
        problem: The estimation problem.
        vessel: The vessel of the original file.
        found: Fit of the vessel model.
        path: Where the file will be written; paths in it are relative to its folder.
        described: Terms of formulas that generalize, by the name of their placeholder. Other
            terms of the fit are events of recordings and are not written.
    """
    described = described or {}
    candidates: list[Effect] = []
    events = set()
    for effect in problem.program.candidates:
        if type(effect).described and effect.name not in described:
            events.add(effect.name)
        else:
            candidates.append(described.get(effect.name, effect))
    document = _document(vessel, path)
    added = []
    for effect in candidates:
        acting = effect.name in map(without_group, found.effects)
        if acting and not isinstance(effect, CoefficientRelease):
            added.append(effect.name)
    document["found"] = tomlkit.item(added)
    document["found"].comment("effects that the diagnosis added")
    settings: dict[str, dict[str, float]] = {name: {} for name in found.effects}
    for free, x in zip(found.free, found.theta, strict=True):
        if not free.relative:
            settings[free.effect][free.name] = float(x)
            continue
        if x == 1.0:  # it keeps the value of the vessel file
            continue
        for name in vessel.names_of(free.effect):
            change = CoefficientChange(free.name, name, free.name, "scales", 1.0)
            _change_number(document, vessel, change, float(x), f"retuned: x {x:.4f}")
    for effect in candidates:  # channels act in the order of the diagnosis
        if effect.name not in set(map(without_group, settings)):
            continue
        if not isinstance(effect, CoefficientRelease):
            own = settings.get(effect.name, _neutral_settings(effect))
            document["effect"].append(_effect_table(effect, vessel, own))
        elif effect.name in settings:
            _apply_release(document, vessel, effect, settings[effect.name])
    for effect in candidates:
        for group in problem.groups:
            if (name := name_in_group(effect.name, group)) in settings:
                _set_in_load(document, problem, vessel, problem.candidates[name], settings[name])
    _keep_fitted_defaults(document, problem, vessel, found)
    document.pop("spread", None)  # of an earlier diagnosis
    if (spread := spread_table.uncertainty_table(problem, found, events)) is not None:
        document["spread"] = spread
    return str(tomlkit.dumps(document))


def write_patched_vessel(
    problem: Problem,
    vessel: Vessel,
    found: Fit,
    path: Path,
    described: Mapping[str, Effect] | None = None,
) -> None:
    """Write the patched vessel file: the original with refitted coefficients and effects added.

    Args:
        problem: The estimation problem.
        vessel: The vessel of the original file.
        found: Fit of the vessel model.
        path: Path of the patched file.
        described: Terms of formulas that generalize, by the name of their placeholder.
    """
    with replace_file(path) as temporary:
        temporary.write_text(
            patched_vessel_text(problem, vessel, found, path, described), encoding="utf-8"
        )


def _document(vessel: Vessel, path: Path) -> tomlkit.TOMLDocument:
    """Return the original file with the keys of a patched one, above all tables."""
    text = vessel.file.read_text(encoding="utf-8-sig")
    original = tomlkit.parse(text)
    for key, empty in (("found", "[]"), ("based_on", '""')):
        if key not in original:
            text = f"{key} = {empty}\n{text}"
    document = tomlkit.parse(text)
    document["based_on"] = tomlkit.item(_based_on(vessel, original.get("based_on"), path))
    document["based_on"].comment("its folder contains the hull")
    document.setdefault("effect", tomlkit.aot())
    return document


def _based_on(vessel: Vessel, base: str | None, path: Path) -> str:
    """Return a shipped vessel by its name, another one by its path from the patched file."""
    file = find_content_file("vessel", base, vessel.file.parent) if base else vessel.file
    name = vessel_reference(file)
    if name.endswith(".toml"):
        return os.path.relpath(file.resolve(), path.resolve().parent)
    return name


def _effect_reference(kind: type[Effect], vessel: Vessel) -> str:
    """Return a shipped effect by its name, another one by its path from the vessel's folder."""
    name = effect_reference(kind)
    if name.endswith(".py"):
        return os.path.relpath(name, vessel.path)
    return name


def _apply_release(
    document: tomlkit.TOMLDocument,
    vessel: Vessel,
    release: CoefficientRelease,
    values: Mapping[str, float],
) -> None:
    """Write the numbers of the vessel that a release changes."""
    for change in release.changes(vessel):
        if change.parameter in values:
            x = values[change.parameter]
            _change_number(
                document, vessel, change, x, f"{release.name}, {change.parameter} = {x:.4g}"
            )


def _neutral_settings(effect: Effect) -> dict[str, float]:
    """Values of the fitted parameters of an effect that acts in no group but one."""
    return {name: getattr(effect, name) for name, p in type(effect).params().items() if p.fit}


def _set_in_load(
    document: tomlkit.TOMLDocument,
    problem: Problem,
    vessel: Vessel,
    effect: Effect,
    values: Mapping[str, float],
) -> None:
    """Write the numbers of an effect of one group into the load condition of the group's name."""
    loads = document.setdefault("loads", tomlkit.table(is_super_table=True))
    load = loads.setdefault(group_of(effect.name), tomlkit.table())
    where = group_in_words(group_entry(problem, effect.name))
    idea = without_group(effect.name)
    if not isinstance(effect, CoefficientRelease):
        own = load.setdefault(idea, tomlkit.table())
        if not isinstance(own, InlineTable):
            own.comment(f"{idea} {where}")
        for name, x in values.items():
            own[name] = _rounded(x)
        return
    for change in effect.changes(vessel):
        if change.parameter not in values:
            continue
        own = load.setdefault(change.owner, tomlkit.table())
        nominal = own.get(change.key, _number_in_file(document, vessel, change))
        new = change.changed_value(float(nominal), values[change.parameter])
        _set_number(own, change.key, new, f"{idea} {where}")


def _number_in_file(
    document: tomlkit.TOMLDocument, vessel: Vessel, change: CoefficientChange
) -> float:
    """Return a number of the vessel as the document specifies it, or else by its default rule."""
    if change.owner == "body":
        own, nominal = document["body"], getattr(vessel.body, change.key)
    else:
        place = [e.name for e in vessel.effects].index(change.owner)
        own, nominal = document["effect"][place], getattr(vessel.effect(change.owner), change.key)
    return float(own.get(change.key, nominal))


def _change_number(
    document: tomlkit.TOMLDocument, vessel: Vessel, change: CoefficientChange, x: float, reason: str
) -> None:
    """Change a number wherever the file specifies it: in its own table and in those of loads."""
    if change.owner == "body":
        own, nominal = document["body"], getattr(vessel.body, change.key)
    else:
        place = [e.name for e in vessel.effects].index(change.owner)
        own, nominal = document["effect"][place], getattr(vessel.effect(change.owner), change.key)
    loads = set()
    for name, tables in document.get("loads", {}).items():
        table = tables.get(change.owner, {})
        if change.key in table:
            loads.add(name)
            _set_number(
                table, change.key, change.changed_value(float(table[change.key]), x), reason
            )
    if change.key in own or loads.isdisjoint(vessel.load):
        _set_number(
            own, change.key, change.changed_value(float(own.get(change.key, nominal)), x), reason
        )


def _keep_fitted_defaults(
    document: tomlkit.TOMLDocument, problem: Problem, vessel: Vessel, found: Fit
) -> None:
    """Write the numbers that default rules would now compute differently than in the fit."""
    values = problem.parameter_vector(problem.recordings[0], found.free, found.theta)
    raw = document.unwrap()
    for name in vessel.load:
        raw = apply_load_values(raw, raw["loads"][name], name)
    boat = replace(vessel, body=Body(**raw["body"]), effects=())
    for table, given in zip(document["effect"], raw["effect"], strict=True):
        effect = effect_from_table(given, vessel.name, vessel.path).with_all_parameters(boat)
        changed = {}
        for name in sorted(effect.filled):
            fitted = float(values[problem.index_of_parameter(effect.name, name)])
            if abs(fitted - getattr(effect, name)) > SAME * abs(fitted):
                changed[name] = _rounded(fitted)
                _set_number(table, name, changed[name], "as fitted")
        boat = boat.with_completed_effect(effect.with_values(changed))


def _set_number(table: Table | InlineTable, name: str, value: float, reason: str) -> None:
    """Set a number of a table and add the reason to its comment; inline tables have none."""
    if name in table:
        before = table[name].trivia.comment.removeprefix("# ")
        if before:
            reason = f"{before}; {reason}"
    table[name] = tomlkit.item(_rounded(value))
    if not isinstance(table, InlineTable):
        table[name].comment(reason)


def _effect_table(effect: Effect, vessel: Vessel, settings: Mapping[str, float]) -> Table:
    """Return the table of an added effect."""
    table = tomlkit.table()
    table["use"] = _effect_reference(type(effect), vessel)
    table["use"].comment("found by the diagnosis")
    if effect.name != type(effect).type_name():
        table["name"] = effect.name
    if effect.on:
        table["on"] = list(effect.on)
    if isinstance(effect, ChannelEffect) and effect.other_side:
        table["other_side"] = True
    for key, value in (effect.fixed_settings() | dict(settings)).items():
        if isinstance(value, float):
            value = _rounded(value)
        table[key] = value
    table.add(tomlkit.nl())
    return table


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")
