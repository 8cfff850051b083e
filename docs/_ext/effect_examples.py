"""Examples of the effects' reference pages: a program for each effect, and what it prints.

`python docs/_ext/effect_examples.py` runs all of them and writes their output to
`effect_outputs.toml`; `python docs/_ext/effect_examples.py tether` runs one. A slow test compares
the stored output with that of today. Nothing is compiled for these short runs (`BOATSIM_DEBUG`).
"""

import contextlib
import io
import os
import sys
import tomllib
from collections.abc import Mapping
from pathlib import Path
from textwrap import wrap

os.environ.setdefault("BOATSIM_DEBUG", "1")

from effect_cases import (  # noqa: E402
    DURATION,
    GOALS,
    OPEN_LOOP,
    SCENARIOS,
    STARTS,
    VESSEL,
    Case,
    all_cases,
)

OUTPUTS = Path(__file__).with_name("effect_outputs.toml")
LINE = 96  # characters of a line of a program


def program(name: str) -> str:
    """Return the example of an effect as Python text.

    Args:
        name: Name of the effect.
    """
    case = all_cases()[name]
    if "measures" in case:
        return _measuring_program(name, case)
    if "law" in case:
        return _law_program(name, case)
    return _running_program(name, case)


def _vessel_lines(name: str, case: Case) -> list[str]:
    """Return the lines that load the vessel of a case, and change it by the effect."""
    load = f", {case['load']!r}" if "load" in case else ""
    lines = [f"boat = boatsim.load_vessel({case.get('vessel', VESSEL)!r}{load})"]
    if "set" in case:
        lines.append(f"boat = boat.with_parameters({case['set']!r})")
    if "add" in case:
        table = {"use": name, **case["add"]}
        return [*lines, f"changed = boat.with_effect({_table(table)})"]
    table = {case.get("change_of", name): case.get("change", {})}
    return [*lines, f"changed = boat.with_parameters({_table(table)})"]


def _table(table: Mapping[str, object]) -> str:
    """Return a table as Python text, in several lines if it is long."""
    text = repr(dict(table))
    if len(text) < LINE - 30:
        return text
    lines = wrap(text[1:-1], LINE - 4, break_long_words=False, break_on_hyphens=False)
    inside = "\n    ".join(lines)
    return f"{{\n    {inside}\n}}"


def _labels(case: Case) -> tuple[str, str]:
    """Return the words for the vessel before and after the change."""
    if "add" in case:
        return "without", "with"
    return "as specified", "changed"


def _running_program(name: str, case: Case) -> str:
    """Return a program that runs a vessel without and with the effect."""
    vessel, column = case.get("vessel", VESSEL), case["see"]
    scenario = case.get("scenario", SCENARIOS.get(vessel, OPEN_LOOP))
    goal = case.get("goal", GOALS.get(vessel))
    keys = f"duration={case.get('duration', DURATION)!r}"
    if vessel in STARTS:
        keys += f", start={STARTS[vessel]!r}"
    lines = ["import boatsim", "", *_vessel_lines(name, case)]
    if goal:
        lines.append(f"goal = [{_table(goal)}]")
        keys += ", goal=goal"
    before, after = _labels(case)
    lines += [
        f"for label, vessel in (({before!r}, boat), ({after!r}, changed)):",
        f"    scenario = boatsim.load_scenario({scenario!r}, vessel=vessel, {keys})",
        f"    last = boatsim.run(scenario).recording[{column!r}][-1]",
        f'    print(f"{{label}}: {column} = {{last:.4g}}")',
    ]
    return "\n".join([*lines, ""])


def _law_program(name: str, case: Case) -> str:
    """Return a program that evaluates the law of the effect."""
    law = case["law"]
    moves = ", ".join(f"{key}={value!r}" for key, value in law["motion"].items())
    signals = ", ".join(f"{key}={value!r}" for key, value in law.get("signals", {}).items())
    own = law.get("of", name)
    arguments = "motion, effect.values()"
    if signals:
        arguments += f", effect.signals({signals})"
    lines = ["import boatsim", "from boatsim.physics import base", ""]
    if "vessel" in case:
        before, after = _labels(case)
        lines += _vessel_lines(name, case)
        pairs = f"(({before!r}, boat), ({after!r}, changed))"
        effect = f"vessel.effect({own!r})"
        header = [f"for label, vessel in {pairs}:", f"    effect = {effect}"]
        if "add" in case and own == name:  # the vessel has it only after the change
            header = [f"effect = changed.effect({own!r})"]
    else:
        lines = ["from boatsim.physics import base, content", ""]
        header = [
            f"kind = content.load_class('effect', {name!r})",
            f"less = {_table(law.get('before', {}))}",
            f"more = {_table(case['add'])}",
            "for label, given in (('without', less), ('with', more)):",
            "    effect = kind(**given)",
        ]
    lines += [
        f"motion = base.motion({moves})",
        *header,
        f"    wrench = type(effect).law({arguments})",
        '    print(f"{label}: X = {wrench.X:.4g} N, Y = {wrench.Y:.4g} N, N = {wrench.N:.4g} N m")',
    ]
    return "\n".join([*lines, ""])


def _measuring_program(name: str, case: Case) -> str:
    """Return a program that applies a measurement error to a motion."""
    parameters = ", ".join(f"{key}={value!r}" for key, value in case["measures"].items())
    lines = [
        "import boatsim",
        "from boatsim.physics.content import load_class",
        "from boatsim.physics.signals import MeasuredMotion",
        "",
        f"kind = load_class('effect', {name!r})",
        f"error = kind({parameters}).with_all_parameters(boatsim.load_vessel({VESSEL!r}))",
    ]
    if "motion" not in case:
        lines.remove("from boatsim.physics.signals import MeasuredMotion")
        what = "motion_latency"
        if "position" in case["measures"]:
            what = "instrument_drift"
        return "\n".join([*lines, f"print(kind.{what}(error.values()))", ""])
    moves = ", ".join(f"{key}={value!r}" for key, value in case["motion"].items())
    time = ""
    if case.get("plot", {}).get("shows") and _uses_time(name):
        time = "10.0, "  # [s]
    lines += [
        f"true = MeasuredMotion(*[0.0] * 12)._replace({moves})",
        f"recorded = kind.apply_measurement_error(true, {time}error.values())",
        f"for signal in {tuple(case['see'])!r}:",
        '    print(f"{signal}: true {getattr(true, signal):.4g}, recorded {getattr(recorded, signal):.4g}")',
    ]
    return "\n".join([*lines, ""])


def _uses_time(name: str) -> bool:
    """Return whether the law of a measurement effect takes the time."""
    from boatsim.physics.content import load_class

    return bool(load_class("effect", name).uses_time)


def output(name: str) -> str:
    """Run the example of an effect and return what it prints.

    Args:
        name: Name of the effect.
    """
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(program(name), f"{name}.py", "exec"), {"__name__": "example"})
    return printed.getvalue()


def stored_outputs() -> dict[str, str]:
    """Return the stored output of each example by the name of its effect."""
    return tomllib.loads(OUTPUTS.read_text(encoding="utf-8"))


def store_outputs() -> None:
    """Run all examples and store what they print."""
    text = "# What the examples of the effects print: python docs/_ext/effect_examples.py\n"
    for name in sorted(all_cases()):
        text += f'{name} = """\n{output(name)}"""\n'
    OUTPUTS.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    if not sys.argv[1:]:
        store_outputs()
    for one in sys.argv[1:]:
        print(program(one))
        print(output(one))
