"""Implementation of `boatsim linearise`: the linear model of a vessel about a steady motion."""

from collections.abc import Mapping, Sequence
from math import isfinite
from pathlib import Path

from boatsim.api import linearise
from boatsim.cli.exits import print_lines
from boatsim.cli.metric_table import print_text_table
from boatsim.control.linear_model import (
    SUFFIXES,
    LinearModel,
    Variable,
    describe_decay,
    describe_period,
)
from boatsim.errors import BadInput


def print_linear_model(
    vessel: str,
    loads: Sequence[str],
    speed: float | None,
    commands: Sequence[str],
    choice: tuple[Sequence[str], bool, float | None],
    out: Path | None,
) -> None:
    """Linearise a vessel, print the steady motion and the modes, and write the model.

    Args:
        vessel: Name or path of a vessel.
        loads: Load conditions.
        speed: Speed in surge [m/s]; None for the motion under the commands.
        commands: Commands as NAME=VALUE.
        choice: Names of the outputs, whether the position is a state, sample time [s] or None.
        out: File to write; None for none.

    Raises:
        BadInput: An argument is wrong, or there is no steady motion.
    """
    if out is not None and out.suffix not in SUFFIXES:
        raise BadInput(f"--out {out}: allowed are names that end in {' or '.join(SUFFIXES)}")
    outputs, position, discrete = choice
    given = parse_commands(commands)
    model = linearise(vessel, speed, given, loads, outputs, position, discrete)
    if out is not None:
        model.write(out)
    _print_variables(model)
    _print_modes(model)
    n = len(model.states)
    lines = [
        f"{model.controllable_states} of {n} states controllable, {model.observable_states} of "
        f"{n} observable from {', '.join(one.name for one in model.outputs)}",
        "change of the frequency response with half the differences: "
        f"{max(model.accuracy, 1e-12):.1g}",
    ]
    if model.delay:
        lines.append(f"dead time of the inputs, not in the matrices: {model.delay:g} s")
    if model.dt:
        lines.append(f"discrete model, sample time {model.dt:g} s, inputs held")
    lines += model.remarks
    if out is not None:
        lines.append(f"written to {out}")
    print_lines(lines)


def parse_commands(texts: Sequence[str]) -> Mapping[str, float]:
    """Return commands by channel from texts NAME=VALUE.

    Args:
        texts: The texts.

    Raises:
        BadInput: A text has another form, or a command is given twice.
    """
    commands: dict[str, float] = {}
    for text in texts:
        name, equals, number = (part.strip() for part in text.partition("="))
        try:
            value = float(number)
        except ValueError:
            equals = ""
        if not equals or not name or not isfinite(value):
            raise BadInput(f"--command {text}: allowed is NAME=VALUE with a finite number")
        if name in commands:
            raise BadInput(f"--command {text}: {name} is given twice")
        commands[name] = value
    return commands


def _print_variables(model: LinearModel) -> None:
    """Print a table of states and inputs with their values in the steady motion."""
    rows = []
    for kind, variables in (("state", model.states), ("input", model.inputs)):
        for one in variables:
            rows.append([kind, one.name, _value_text(one), one.unit])
    title = ", ".join((model.vessel, *model.load))
    print_text_table(f"{title}: steady motion", ["", "name", "value", "unit"], rows, 2)


def _value_text(variable: Variable) -> str:
    """Value in the steady motion, 0 for rounding errors."""
    if abs(variable.value) < 1e-9 * variable.scale:
        return "0"
    return f"{variable.value:.4g}"


def _print_modes(model: LinearModel) -> None:
    """Print a table of the modes."""
    rows = []
    for mode in model.modes:
        value = mode.eigenvalue
        text = f"{value.real + 0.0:.4g}"
        damping = "-"
        if value.imag:
            text += f" +- {value.imag:.4g}j"
            damping = f"{mode.damping_ratio:.3g}"
        lacks = []
        if not mode.controllable:
            lacks.append("not controllable")
        if not mode.observable:
            lacks.append("not observable")
        decay, period = describe_decay(mode), describe_period(mode)
        rows.append([mode.name, text, decay, period, damping, ", ".join(lacks)])
    head = ["mode", "eigenvalue 1/s", "time constant s", "period s", "damping", "remark"]
    if not any(row[-1] for row in rows):
        head.pop()
        for row in rows:
            row.pop()
    print_text_table("modes, the slowest first", head, rows, 1)
