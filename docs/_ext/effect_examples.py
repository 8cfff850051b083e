"""Examples of the effects' reference pages: a program for each effect, and what it prints.

`python docs/_ext/effect_examples.py` runs all of them and writes their output to
`effect_outputs.toml`; `--check` compares their output with the stored one, for all effects or the
named ones, as slow and long tests do; the names of effects alone show and run single examples.
Nothing is compiled for these short runs (`BOATSIM_DEBUG`).
"""

import contextlib
import io
import json
import os
import sys
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

if __name__ == "__main__":  # an import must not change how the program that imports this one runs
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
from page_commands import first_difference  # noqa: E402

from boatsim.physics import content  # noqa: E402

OUTPUTS = Path(__file__).with_name("effect_outputs.toml")
SPECIAL_LINES = {  # last lines of examples of effects that change the time or add noise
    "clock_offset": (
        "latency = kind.motion_latency(error.values())",
        'print(f"the pose of 10 s is stamped {10.0 + latency:.1f} s")',
    ),
    "position_wander": (
        "drift = kind.instrument_drift(error.values())",
        'print(f"rms error of a position: without 0 m, with {drift.position:.4g} m")',
    ),
}
LONGEST_LINE = 92  # characters of a line of a program
LONGEST_TABLE = 56  # characters of a table that is written in one line


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
    arguments = json.dumps(case.get("vessel", VESSEL))
    if "load" in case:
        arguments += f", {json.dumps(case['load'])}"
    lines = [f"boat = boatsim.load_vessel({arguments})"]
    for channel, neutral in case.get("measured", {}).items():
        lines.append(f'measured = {{"{channel}": MeasuredChannel(neutral={neutral!r})}}')
        lines.append("boat = dataclasses.replace(boat, measured=measured)")
    if "set" in case:
        lines.append(f"boat = boat.with_parameters({_table(case['set'])})")
    if "add" in case:
        table = {"use": name, **case["add"]}
        return [*lines, f"changed = boat.with_effect({_table(table)})"]
    table = {case.get("change_of", name): case.get("change", {})}
    return [*lines, f"changed = boat.with_parameters({_table(table)})"]


def _table(table: Mapping[str, object]) -> str:
    """Return a table as Python text, in several lines if it is long."""
    text = json.dumps(table)
    if len(text) < LONGEST_TABLE:
        return text
    lines = ["{"]
    for key, value in table.items():
        inner = json.dumps(value)
        if isinstance(value, Mapping):
            inner = _table(value).replace("\n", "\n    ")
        lines.append(f"    {json.dumps(key)}: {inner},")
    return "\n".join([*lines, "}"])


def _goal_text(goal: Mapping[str, object] | list[Mapping[str, object]]) -> str:
    """Return the line with one goal, or the lines with several goals in time."""
    if isinstance(goal, Mapping):
        return f"goal = [{_table(goal)}]"
    rows = [f"    {json.dumps(one)}," for one in goal]
    return "\n".join(["goal = [", *rows, "]"])


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
        keys += f", start={json.dumps(STARTS[vessel])}"
    lines = ["import boatsim", "", *_vessel_lines(name, case)]
    if "measured" in case:
        schema = "from boatsim.physics.vessel.schema import MeasuredChannel"
        lines = ["import dataclasses", "", "import boatsim", schema, *lines[1:]]
    if goal:
        lines.append(_goal_text(goal))
        keys += ", goal=goal"
    before, after = _labels(case)
    lines += [
        f'for label, vessel in (("{before}", boat), ("{after}", changed)):',
        *_call_lines(
            "    scenario = boatsim.load_scenario", f'"{scenario}", vessel=vessel, {keys}'
        ),
        f'    last = boatsim.run(scenario).recording["{column}"][-1]',
        f'    print(f"{{label}}: {column} = {{last:.4g}}")',
    ]
    return "\n".join([*lines, ""])


def _call_lines(function: str, arguments: str) -> list[str]:
    """Return the lines of a call, with the arguments on a line of their own if they are long."""
    if len(function) + len(arguments) < LONGEST_LINE:
        return [f"{function}({arguments})"]
    indent = " " * (len(function) - len(function.lstrip()))
    return [f"{function}(", f"{indent}    {arguments}", f"{indent})"]


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
    if content.load_class("effect", own).sees_table:
        arguments += ", np.array(effect.table()), 0"
        lines = ["import numpy as np", "", *lines]
    if "vessel" in case:
        before, after = _labels(case)
        lines += _vessel_lines(name, case)
        pairs = f'(("{before}", boat), ("{after}", changed))'
        effect = f'vessel.effect("{own}")'
        header = [f"for label, vessel in {pairs}:", f"    effect = {effect}"]
        if "add" in case and own == name:  # the vessel has it only after the change
            header = [f'effect = changed.effect("{own}")']
    else:
        lines = ["from boatsim.physics import base, content", ""]
        header = [
            f'kind = content.load_class("effect", "{name}")',
            f"less = {_table(law.get('before', {}))}",
            f"more = {_table(case['add'])}",
            'for label, given in (("defaults", less), ("example", more)):',
            "    effect = kind(**given)",
        ]
    lines += [
        f"motion = base.make_motion({moves})",
        *header,
        *_call_lines("    wrench = type(effect).law", arguments),
        '    print(f"{label}: X = {wrench.X:.4g} N, Y = {wrench.Y:.4g} N, N = {wrench.N:.4g} N m")',
    ]
    return "\n".join([*lines, ""])


def _measuring_program(name: str, case: Case) -> str:
    """Return a program that applies a measurement error to a motion."""
    parameters = ", ".join(f"{key}={json.dumps(x)}" for key, x in case["measures"].items())
    lines = [
        "import boatsim",
        "from boatsim.physics.content import load_class",
        "from boatsim.physics.signals import MeasuredMotion",
        "",
        f'kind = load_class("effect", "{name}")',
        f"error = kind({parameters})",
        f'error = error.with_all_parameters(boatsim.load_vessel("{VESSEL}"))',
    ]
    if "motion" not in case:
        lines.remove("from boatsim.physics.signals import MeasuredMotion")
        return "\n".join([*lines, *SPECIAL_LINES[name], ""])
    moves = ", ".join(f"{key}={value!r}" for key, value in case["motion"].items())
    time = ""
    if case.get("plot", {}).get("shows") and _uses_time(name):
        time = "10.0, "  # [s]
    lines += [
        f"true = MeasuredMotion(*[0.0] * 12)._replace({moves})",
        f"recorded = kind.apply_measurement_error(true, {time}error.values())",
        f"for signal in {json.dumps(case['see'])}:",
        "    values = getattr(true, signal), getattr(recorded, signal)",
        '    print("{}: true {:.4g}, recorded {:.4g}".format(signal, *values))',
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


@contextlib.contextmanager
def equal_runs_once() -> Iterator[None]:
    """Run equal scenarios of the examples once within a `with` block.

    Many examples begin with the same vessel without their effect, and equal scenarios have equal
    runs.
    """
    import boatsim

    run, known = boatsim.run, []

    def run_once(scenario: boatsim.Scenario) -> boatsim.Run:
        for other, result in known:
            if other == scenario:
                return result
        known.append((scenario, run(scenario)))
        return known[-1][1]

    boatsim.run = run_once
    try:
        yield
    finally:
        boatsim.run = run


def stored_outputs() -> dict[str, str]:
    """Return the stored output of each example by the name of its effect."""
    return tomllib.loads(OUTPUTS.read_text(encoding="utf-8"))


def store_outputs() -> None:
    """Run all examples and store what they print."""
    text = "# What the examples of the effects print: python docs/_ext/effect_examples.py\n"
    with equal_runs_once():
        for name in sorted(all_cases()):
            text += f'{name} = """\n{output(name)}"""\n'
    OUTPUTS.write_text(text, encoding="utf-8")


def differences(names: Sequence[str]) -> list[str]:
    """Run examples and return a description of each that prints something else than stored."""
    found = []
    stored = stored_outputs()
    with equal_runs_once():
        outputs = {name: output(name) for name in sorted(names)}
    for name, text in outputs.items():
        shown, printed = stored.get(name, "").splitlines(), text.splitlines()
        if len(printed) != len(list(filter(None, shown))):
            found.append(f"{name} prints {printed}, stored is {shown}")
        elif message := first_difference(shown, printed):
            found.append(f"{name}: {message}")
    return found


def main(names: Sequence[str]) -> int:
    """Store the outputs, compare them (`--check`), or show single examples; return the exit code.

    Args:
        names: Names of effects, or `--check` and perhaps names, or nothing.
    """
    if not names:
        store_outputs()
    if names and names[0] == "--check":
        found = differences(names[1:] or all_cases())
        print("\n".join(found))
        return bool(found)
    for name in names:
        print(program(name))
        print(output(name))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
