"""Description of an effect, controller, measure or sensor, for `boatsim show` and for the site."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from inspect import getdoc
from math import isnan
from pathlib import Path
from typing import Any

from boatsim.physics import content
from boatsim.physics.base import ChannelEffect, Effect, Param

# Kinds of content that are classes, with the table in which each is used.
TABLES = {
    "effect": "[[effect]]",
    "controller": "[controller]",
    "measure": "[measure]",
    "sensor": "[[sensor]]",
}
CLASSES = tuple(TABLES)
MOST_IN_EXAMPLE = 6  # parameters of an example; more would hide the ones that matter
OPEN_ENDED = -1e9  # lower bound of a parameter whose range has no lower limit


@dataclass(frozen=True)
class Entry:
    """Description of one effect, controller, measure or sensor, for `boatsim show`.

    Attributes:
        name: Name by which files refer to it.
        words: One line of description.
        doc: Lines of its docstring, if it holds more than `words`.
        facts: Label and text of further facts: source, metrics, channels, what excludes it.
        parameters: Rows of a table: parameter, default, range, whether it is fitted (of an effect),
            description; the first row holds the headings.
        example: Lines of its table in a file.
    """

    name: str
    words: str
    doc: tuple[str, ...]
    facts: tuple[tuple[str, str], ...]
    parameters: tuple[tuple[str, ...], ...]
    example: tuple[str, ...]


def class_description(kind: str, name: str) -> Entry:
    """Return the description of an effect, controller, measure or sensor for `boatsim show`.

    Args:
        kind: One of CLASSES.
        name: Its name, or the path of its file.

    Raises:
        BadInput: There is none of that name.
    """
    cls = content.load_class(kind, name, named=True)
    own_name = Path(name).stem
    params: dict[str, Param] = {}
    defaults: dict[str, Any] = {}
    if hasattr(cls, "params"):
        params = cls.params()
    if params:
        defaults = {field.name: field.default for field in fields(cls)}
    ending = getattr(cls, "use_ending", "")
    doc = (getdoc(cls) or "").splitlines()
    if doc and doc[0].rstrip(".") == cls.words:
        doc = []
    return Entry(
        own_name,
        cls.words,
        tuple(doc),
        tuple(_class_facts(cls)),
        tuple(_parameter_rows(cls, params, defaults)),
        tuple(_example_lines(TABLES[kind], own_name + ending, cls, params, defaults)),
    )


def _class_facts(cls: type[Any]) -> Iterator[tuple[str, str]]:
    """Label and text of the facts that a class declares."""
    if text := getattr(cls, "source", ""):
        yield "source", text
    if issubclass(cls, Effect):
        yield from _effect_facts(cls)
    if units := getattr(cls, "units", None):
        metrics = []
        for metric, unit in units.items():
            metrics.append(f"{metric} [{unit}]" if unit else metric)
        yield "metrics", ", ".join(metrics)
    if goals := getattr(cls, "goals", ()):
        yield "goals", ", ".join(goals)
    if grades := getattr(cls, "grades", None):
        yield "grade", ", ".join(grades())


def _effect_facts(cls: type[Effect]) -> Iterator[tuple[str, str]]:
    """Signs of an effect in recordings, its channels, and what excludes it."""
    if cls.shown_by:
        yield "shows in", cls.shown_by
    for role, port in cls.roles.items():
        default = ""
        if port.fixed is not None:
            default = f"; {port.fixed:g} if omitted"
        yield f"on.{role}", f"{port.words} [{port.unit}]{default}"
    if issubclass(cls, ChannelEffect) and cls.acts_on:
        yield "acts on", f"commands of {cls.acts_on.replace('|', ' or ')}"
    if cls.per_instance_of:
        yield "acts on each", cls.per_instance_of
    if cls.needs:
        yield "needs", f"degrees of freedom {' and '.join(cls.needs)}"
    if cls.needs_one_of:
        yield "needs", f"a degree of freedom in {' or '.join(cls.needs_one_of)}"
    if cls.ruled_out_by:
        excluding: list[str] = []
        for fact, values in cls.ruled_out_by.items():
            excluding += map(f"{fact} = {{}}".format, map(_format_toml_value, values))
        yield "ruled out by", " or ".join(excluding)
    if cls.required_facts:
        yield "tested where", " and ".join(_requirements(cls.required_facts))
    if cls.facts:
        yield "needs the facts", ", ".join(cls.facts)
    if cls.confounded_with:
        yield (
            "tested last" if cls.tried_last else "only on request",
            f"recordings {'hardly' if cls.tried_last else 'cannot'} distinguish it from "
            f"{' or '.join(cls.confounded_with)}",
        )


def _requirements(by_fact: Mapping[str, object]) -> Iterator[str]:
    """Yield each fact with its value: "guided = true"."""
    for fact, value in by_fact.items():
        yield f"{fact} = {_format_toml_value(value)}"


def _format_toml_value(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"'


def _parameter_rows(
    cls: type[Any], params: dict[str, Param], defaults: dict[str, Any]
) -> Iterator[tuple[str, ...]]:
    """Headings, then a row for each parameter that is a number."""
    fits = issubclass(cls, Effect)
    numbers = {}
    for name, param in params.items():
        if param.low != OPEN_ENDED or param.unit or param.fit:
            numbers[name] = param
    if numbers:
        fitted = ("fitted",) if fits else ()
        yield "parameter", "default", "allowed", *fitted, "what"
    for name, param in numbers.items():
        default = f"{_format_default(defaults[name], param)} {param.unit}".rstrip()
        fitted = (_describe_fitting(param),) if fits else ()
        yield name, default, f"{param.low:g} to {param.high:g}", *fitted, param.words


def _describe_fitting(param: Param) -> str:
    """Whether a diagnosis fits a parameter: of a candidate effect, or of the nominal model."""
    if param.fit:
        return "yes"
    if param.calibrates:
        return f"as {param.calibrates}"
    return ""


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isnan(value)


def _format_default(value: Any, param: Param) -> str:
    if _is_number(value):
        return f"{value:g}"
    if param.follows:
        return f"= {param.follows.removesuffix('?')}"
    return "by rule or 0"


def _example_lines(
    table: str, name: str, cls: type[Any], params: dict[str, Param], defaults: dict[str, Any]
) -> Iterator[str]:
    """Lines of its table in a file."""
    yield table
    yield f'use = "{name}"'
    if issubclass(cls, Effect) and cls.roles:
        bound = []
        for role, port in cls.roles.items():
            if port.fixed is None:
                bound.append(f'{role} = "CHANNEL"')
        yield f"on = {{ {', '.join(bound)} }}"
    fitted = [key for key, param in params.items() if param.fit or param.calibrates]
    for key in (fitted or list(params))[:MOST_IN_EXAMPLE]:
        if _is_number(defaults[key]):
            line = f"{key} = {defaults[key]!r}"
            if params[key].unit:
                line += f"  # [{params[key].unit}]"
            yield line
