"""What is to be said of an effect, controller, measure or sensor: for `boatsim show` and for the pages of the site."""

from collections.abc import Iterator
from dataclasses import dataclass, fields
from inspect import getdoc
from math import isnan
from pathlib import Path
from typing import Any

from boatsim.physics import content
from boatsim.physics.base import Channel, Effect, Param

CLASSES = ("effect", "controller", "measure", "sensor")
PASTED = {  # how each stands in a file
    "effect": "[[effect]]",
    "controller": "[controller]",
    "measure": "[measure]",
    "sensor": "[[sensor]]",
}


@dataclass(frozen=True)
class Entry:
    """One of them, in words."""

    name: str
    words: str
    doc: tuple[str, ...]  # lines of its docstring, where that says more than the words
    said: tuple[tuple[str, str], ...]  # what, and the text of it: source, norms, what rules it out
    numbers: tuple[
        tuple[str, ...], ...
    ]  # parameter, default, allowed, of effects fitted, what; the head first
    paste: tuple[str, ...]  # the table as it stands in a file


def entry(kind: str, name: str) -> Entry:
    """What there is to say of one, by its name or the path of its file. Raises BadInput."""
    made = content.load_class(kind, name, named=True)
    called = Path(name).stem
    params: dict[str, Param] = made.params() if hasattr(made, "params") else {}
    doc = getdoc(made) or ""
    told = doc.splitlines() if doc.partition("\n")[0].rstrip(".") != made.words else []
    return Entry(
        called,
        made.words,
        tuple(told),
        tuple(_said(made)),
        tuple(_numbers(made, params)),
        tuple(_paste(kind, called, made, params)),
    )


def _said(made: type[Any]) -> Iterator[tuple[str, str]]:
    """What its class says of itself beside numbers."""
    if text := getattr(made, "source", ""):
        yield "source", text
    if issubclass(made, Effect):
        yield from _said_of_effect(made)
    units = getattr(made, "units", None)
    if units:
        yield "norms", ", ".join(f"{n} [{u}]" if u else n for n, u in units.items())
    if goals := getattr(made, "goals", ()):
        yield "goals", ", ".join(goals)


def _said_of_effect(made: type[Effect]) -> Iterator[tuple[str, str]]:
    """How it shows, what it acts on, and what keeps it from acting."""
    if made.shown_by:
        yield "shows in", made.shown_by
    for role, said in made.roles.items():
        left_out = "" if said.fixed is None else f"; {said.fixed:g} if left out"
        yield f"on.{role}", f"{said.words} [{said.unit}]{left_out}"
    if issubclass(made, Channel) and made.acts_on:
        yield "acts on", f"commands of {made.acts_on.replace('|', ' or ')}"
    if made.per_instance_of:
        yield "acts on each", made.per_instance_of
    if made.needs:
        yield "needs", f"{' and '.join(made.needs)} free"
    if made.ruled_out_by:
        facts = (
            f"{fact} = {_toml(value)}"
            for fact, values in made.ruled_out_by.items()
            for value in values
        )
        yield "ruled out by", " or ".join(facts)
    if made.facts:
        yield "needs the facts", ", ".join(made.facts)
    if made.confounded_with:
        yield "only on request", f"looks the same as {' or '.join(made.confounded_with)}"


def _toml(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else f'"{value}"'


def _numbers(made: type[Any], params: dict[str, Param]) -> Iterator[tuple[str, ...]]:
    """A row for each parameter, and the head before the first."""
    nominal = {f.name: f.default for f in fields(made)} if params else {}
    shown = {
        n: p for n, p in params.items() if p.low != -1e9 or p.unit or p.fit
    }  # else it stands for a word
    fits = issubclass(made, Effect)
    if shown:
        yield "parameter", "default", "allowed", *(["fitted"] if fits else []), "what"
    for name, p in shown.items():
        default = f"{_default(nominal[name], p)} {p.unit}".rstrip()
        yield name, default, f"{p.low:g} to {p.high:g}", *([_fitted(p)] if fits else []), p.words


def _fitted(p: Param) -> str:
    """Whether a diagnosis fits a parameter: as what is missing, or as a coefficient that is never known exactly."""
    return "yes" if p.fit else f"as {p.calibrates}" if p.calibrates else ""


def _default(value: Any, p: Param) -> str:
    if isinstance(value, int | float) and not isnan(value):
        return f"{value:g}"
    return f"= {p.follows.removesuffix('?')}" if p.follows else "by rule or 0"


def _paste(kind: str, name: str, made: type[Any], params: dict[str, Param]) -> Iterator[str]:
    """The table as it stands in a file."""
    yield PASTED[kind]
    yield f'use = "{name}"'
    if issubclass(made, Effect) and made.roles:
        bound = ", ".join(
            f'{role} = "CHANNEL"' for role, said in made.roles.items() if said.fixed is None
        )
        yield f"on = {{ {bound} }}"
    nominal = {f.name: f.default for f in fields(made)} if params else {}
    fitted = [n for n, p in params.items() if p.fit or p.calibrates] or list(params)
    for n in fitted[:6]:
        value = nominal[n]
        if isinstance(value, int | float) and not isnan(value):
            unit = params[n].unit
            yield f"{n} = {value!r}{f'  # [{unit}]' if unit else ''}"
