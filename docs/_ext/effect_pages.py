"""Reference pages of the effects: law, plot, parameters, scenario and example of each effect."""

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from typing import Any

from effect_cases import VESSEL, Case, all_cases
from effect_examples import program, stored_outputs
from page_markup import bullet_list, escaped, sentence, table_rows

from boatsim.cli.entry import Entry, class_description
from boatsim.files import array_of_tables
from boatsim.physics import content
from boatsim.physics.base import Effect
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.simulate import cases

PLOT = "<!-- plot of the law -->"  # place of the plot, which is drawn only for the site
UNITS_OF_MOTION = {"u": "m/s", "v": "m/s", "w": "m/s", "p": "rad/s", "q": "rad/s", "r": "rad/s"}
PLAIN = {  # kinds of plots that do not show a law over a motion, with their caption
    "delay": "A signal, and its recording with the example's offset of the clocks.",
    "wander": "One realisation of the error with the example's size and correlation time.",
    "payload": f"Surge acceleration of {VESSEL}, whose added mass does not change.",
}


def page(name: str) -> str:
    """Return the page of an effect, without its plot.

    Args:
        name: Name of the effect.
    """
    entry = class_description("effect", name)
    kind = content.load_class("effect", name)
    summary, *rest = _paragraphs(entry)
    lines = [f"# {name}", "", f"{sentence(entry.words)}.", ""]
    if summary:
        lines += [*map(escaped, summary), ""]
    lines += ["## Law", "", "$$", kind.formula, "$$", ""]
    if words := symbol_words(kind):
        lines += [words, ""]
    for paragraph in rest:
        lines += [*map(escaped, paragraph), ""]
    if name in all_cases():
        lines += [PLOT, "", escaped(caption(all_cases()[name])), ""]
    if entry.facts:
        lines += ["## Use and evidence", "", *bullet_list(entry.facts), ""]
    if entry.parameters:
        lines += ["## Parameters", "", *table_rows(entry.parameters), ""]
    lines += ["In a vessel or scenario file:", "", "```toml", *entry.example, "```", ""]
    return "\n".join([*lines, *_scenario_section(name), *_example_section(name)])


def _paragraphs(entry: Entry) -> Iterator[Sequence[str]]:
    """Yield the paragraphs of a docstring: the first one, then those that are no formulas.

    A formula stands on lines of its own and has no full stop; the page shows it in LaTeX.
    """
    paragraphs = "\n".join(entry.doc).split("\n\n")
    yield paragraphs[0].splitlines()
    for paragraph in paragraphs[1:]:
        if " = " in paragraph and not paragraph.endswith("."):
            continue
        yield paragraph.splitlines()


def symbol_words(kind: type[Effect]) -> str:
    """Return which parameter each symbol of the formula stands for; "" if there is none.

    Args:
        kind: Class of the effect.
    """
    parts = []
    for name, symbol in kind.symbols.items():
        if name in kind.params() and symbol.lstrip("-") in kind.formula:
            unit = kind.params()[name].unit
            parts.append(f"${symbol}$ = `{name}`{unit and f' [{escaped(unit)}]'}")
    if not parts:
        return ""
    return f"{', '.join(parts)}; motions and forces have their SNAME symbols."


def caption(case: Case) -> str:
    """Return the words below the plot of an effect: vessel, parameters and motion.

    Args:
        case: Case of the effect.
    """
    spec = case["plot"]
    if spec["over"] in PLAIN:
        return PLAIN[spec["over"]]
    parts = []
    if "measures" in case:
        parts.append(f"Recorded with {_values(case['measures'])}")
    elif "law" in case and "vessel" not in case:
        parts.append("With the parameters of the example")
    else:
        vessel = case.get("vessel", VESSEL)
        given = dict(case.get("add", case.get("change", {}))) | spec.get("set", {})
        parts.append(f"Vessel `{vessel}` with {_values(given)}")
    if spec.get("at"):
        parts.append(f"at {_values(spec['at'], UNITS_OF_MOTION)}")
    if spec.get("signals"):
        parts.append(f"with {_values(spec['signals'])}")
    return f"{', '.join(parts)} (SI units)."


def _values(given: Mapping[str, Any], units: Mapping[str, str] | None = None) -> str:
    """Return names and values as words."""
    words = []
    for name, value in given.items():
        unit = (units or {}).get(name, "")
        if isinstance(value, float | int):
            value = f"{value:g}"
        words.append(f"`{name} = {value}`{unit and f' {unit}'}")
    return ", ".join(words)


@cache
def scenario_table(name: str) -> Mapping[str, Any]:
    """Return the content of a scenario of the library, read once for all pages."""
    return cases.read_scenario(name)[0]


@cache
def scenarios_by_effect() -> dict[str, str]:
    """Return the scenario that shows each effect best, by the name of the effect.

    A scenario that has the effect in its own file comes before one that sets a parameter of it, and
    that before one whose vessel has it.
    """
    ranked: dict[str, tuple[int, int, str]] = {}
    for name in content.shipped_content_names("scenario"):
        table = scenario_table(name)
        vessel = scenario_vessel(str(table["vessel"]))
        settings: Any = table.get("set", {})
        own = {str(effect.get("use")) for effect in array_of_tables(table.get("effect"))}
        changed = {name_of for name_of in settings if vessel.effect(name_of)}
        for effect in own:
            _keep_best(ranked, effect, (0, len(name), name))
        for effect in vessel.effects:
            rank = 1 if effect.name in changed else 2
            _keep_best(ranked, type(effect).type_name(), (rank, len(name), name))
    return {effect: place[2] for effect, place in ranked.items()}


@cache
def scenario_vessel(name: str) -> Vessel:
    """Return a vessel of the library, read once for all scenarios."""
    return load_vessel(name)


def _keep_best(
    ranked: dict[str, tuple[int, int, str]], effect: str, place: tuple[int, int, str]
) -> None:
    """Keep a scenario of an effect if it shows it better than the one before."""
    ranked[effect] = min(place, ranked.get(effect, place))


def _scenario_section(name: str) -> list[str]:
    """Return the section about a scenario that contains the effect."""
    scenario = scenarios_by_effect().get(name)
    lines = ["## Scenario", ""]
    if scenario is None:
        return [*lines, "No shipped scenario contains this effect.", ""]
    about = str(scenario_table(scenario).get("about", "")).rstrip(".")
    folder = scenario.partition("/")[0]
    words = f"A scenario of [{folder}](../scenarios/{folder}.md) contains it: {escaped(about)}."
    return [*lines, words, "", "```sh", f"boatsim run {scenario}", "```", ""]


def _example_section(name: str) -> list[str]:
    """Return the section with a program that shows what the effect does, and its output."""
    lines = ["## Example", "", "```python", program(name).rstrip(), "```", ""]
    return [*lines, "```text", stored_outputs()[name].strip("\n"), "```", ""]


def with_plot(name: str, text: str) -> str:
    """Return the page of an effect with its plot.

    Args:
        name: Name of the effect.
        text: The page with the place of the plot.
    """
    from law_plots import plot  # evaluates laws, which tests of the pages need not do

    return re.sub(PLOT, lambda _: f'<figure class="law">{plot(name)}</figure>', text)
