"""The variables of a vessel's FMU: channels, surroundings, parameters, motion, forces."""

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, fields
from math import inf

from boatsim.errors import BadInput
from boatsim.fmu.units import unit_of_channel
from boatsim.physics.program import Program
from boatsim.physics.signals import AXES, COMPONENTS, STATE, motion_signals

IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
# Characters that a quoted name of FMI may have
QUOTABLE = re.compile(r"[^A-Za-z0-9_!#$%&()*+,\-./:;<>=?@\[\]^{}|~ ]")
# Rigid body, in the order of `Program.body`: name, unit, lower bound, description
BODY = (
    ("mass", "kg", 1e-9, "mass of the rigid body"),
    ("centre[1]", "m", -inf, "mass centre ahead of the origin of motion"),
    ("centre[2]", "m", -inf, "mass centre below the origin of motion"),
    ("roll_inertia", "kg m^2", 1e-9, "roll inertia of the rigid body"),
    ("pitch_inertia", "kg m^2", 1e-9, "pitch inertia of the rigid body"),
    ("yaw_inertia", "kg m^2", 1e-9, "yaw inertia of the rigid body"),
)
PLANE_AXES = {"surge", "sway"}  # degrees of freedom of which accelerations are outputs
ACCELERATIONS = {
    "sensed_ax_mps2": "acceleration of the origin over ground along body x, without noise",
    "sensed_ay_mps2": "acceleration of the origin over ground along body y, without noise",
}
COORDINATE_WORDS = {
    "x": "position north of the start",
    "y": "position east of the start",
    "z": "position down",
    "phi": "roll angle, positive starboard down",
    "theta": "pitch angle, positive bow up",
    "psi": "heading, clockwise from the x axis",
    "u": "surge velocity over ground",
    "v": "sway velocity over ground, positive to starboard",
    "w": "heave velocity over ground, positive down",
    "p": "roll rate",
    "q": "pitch rate",
    "r": "yaw rate, positive clockwise seen from above",
}


@dataclass(frozen=True)
class Variable:
    """One variable of an FMU; its place in the list of all is its value reference.

    Attributes:
        name: Name, in the structured convention of FMI.
        kind: Kind of number in the C source, such as "PARAMETER".
        index: Place among the numbers of this kind.
        unit: Unit, "" for a ratio.
        words: Description.
        causality: "independent", "input", "parameter", "output" or "local".
        variability: "continuous", "discrete", "tunable" or "fixed".
        initial: "exact", "calculated", or "" where FMI allows none.
        start: Start value, None for a calculated one.
        low: Lower bound of a value that is set.
        high: Upper bound.
        derivative_of: Name of the variable of which it is the derivative, "" for none.
        state: Whether it is a continuous state.
    """

    name: str
    kind: str
    index: int
    unit: str
    words: str
    causality: str
    variability: str = "continuous"
    initial: str = ""
    start: float | None = None
    low: float = -inf
    high: float = inf
    derivative_of: str = ""
    state: bool = False


def quoted_name(name: str) -> str:
    """Return a name as part of a structured name of FMI, in quotation marks where it needs them."""
    if IDENTIFIER.fullmatch(name):
        return name
    return f"'{QUOTABLE.sub('_', name) or '_'}'"


def vessel_variables(program: Program, further: Iterable[Variable] = ()) -> list[Variable]:
    """Return all variables of a vessel's FMU in the order of their value references.

    Args:
        program: The compiled program of the vessel, with its surroundings.
        further: Variables of its sensors, which replace outputs of the same name.

    Returns:
        Time, inputs, parameters, outputs, and derivatives of the states.

    Raises:
        BadInput: Two variables have the same name.
    """
    found = [Variable("time", "TIME", 0, "s", "simulated time", "independent")]
    found += _inputs(program)
    found += _parameters(program)
    sensors = list(further)
    replaced = {variable.name for variable in sensors}
    found += [variable for variable in _outputs(program) if variable.name not in replaced]
    found += sensors
    found += _derivatives(program)
    for name, count in Counter(variable.name for variable in found).items():
        if count > 1:
            raise BadInput(
                f"{program.vessel.name}: {count} variables of the FMU have the name {name}; "
                "rename the channel or the effect"
            )
    return found


def _inputs(program: Program) -> Iterator[Variable]:
    """Channels, surroundings, and an external force."""
    vessel = program.vessel
    for i, (name, command) in enumerate(vessel.commands.items()):
        low, high = vessel.limits()[name]
        words = f"{command.about or 'command'}; limited to {low:g} to {high:g}"
        yield _channel(name, i, words, command.neutral)
    for i, (name, measured) in enumerate(vessel.measured.items(), len(vessel.commands)):
        yield _channel(name, i, measured.about or "measured quantity", measured.neutral)
    for variable in _effect_parameters(program):
        if variable.causality == "input":
            yield variable
    for i, axis in enumerate(_free_axes(program)):
        component = COMPONENTS[axis]
        words = f"external force or moment in body axes, {axis}"
        unit = unit_of_channel(component)
        yield Variable(
            f"external.{component}", "EXTERNAL_FORCE", i, unit, words, "input", start=0.0
        )


def _channel(name: str, index: int, words: str, start: float) -> Variable:
    """A command or a measured quantity of the surroundings."""
    unit = unit_of_channel(name)
    return Variable(quoted_name(name), "INPUT", index, unit, words, "input", start=start)


def _parameters(program: Program) -> Iterator[Variable]:
    """Rigid body and parameters of all effects."""
    for i, (name, unit, low, words) in enumerate(BODY):
        yield Variable(
            name=f"body.{name}",
            kind="BODY",
            index=i,
            unit=unit,
            words=words,
            causality="parameter",
            variability="tunable",
            start=float(program.body[i]),
            low=low,
        )
    for variable in _effect_parameters(program):
        if variable.causality == "parameter":
            yield variable


def _effect_parameters(program: Program) -> Iterator[Variable]:
    """Parameters of effects; those of the surroundings are inputs.

    Numbers that stand for names, which no file sets, are left out.
    """
    values = program.values()
    for effect, first in zip(program.effects, program.offsets, strict=True):
        own = internal_parameters(type(effect))
        for place, (name, about) in enumerate(type(effect).params().items(), first):
            if name in own:
                continue
            value = float(values[place])
            exogenous = name in type(effect).exogenous
            yield Variable(
                name=f"{quoted_name(effect.name)}.{name}",
                kind="PARAMETER",
                index=place,
                unit=about.unit,
                words=about.words,
                causality="input" if exogenous else "parameter",
                variability="continuous" if exogenous else "tunable",
                start=value,
                low=min(about.low, value),  # a parameter without a value is 0
                high=max(about.high, value),
            )


def internal_parameters(effect: type) -> set[str]:
    """Return the names of an effect's parameters that stand for names and that no file sets."""
    return {one.name for one in fields(effect) if "ours" in one.metadata}


def _free_axes(program: Program) -> list[str]:
    return [AXES[i] for i in program.module.FREE]


def _outputs(program: Program) -> Iterator[Variable]:
    """Motion, actuators, forces and accelerations."""
    count = program.module.NQ
    for i, signal in enumerate(motion_signals(program.vessel.dof)):
        yield Variable(
            name=signal.column,
            kind="MOTION",
            index=i,
            unit=unit_of_channel(signal.column),
            words=COORDINATE_WORDS[signal.symbol],
            causality="output",
            initial="exact",
            start=0.0,
            state=i < count,
        )
    for i, name in enumerate(program.vessel.actuators):
        yield _calculated(
            quoted_name(f"actual_{name}"), "ACTUATOR", i, f"position of the actuator {name}"
        )
    for i, axis in enumerate(_free_axes(program)):
        name = f"force_{COMPONENTS[axis]}"
        yield _calculated(name, "FORCE", i, f"sum of all effects in body axes, {axis}")
    if PLANE_AXES <= set(program.vessel.dof):
        for i, (name, words) in enumerate(ACCELERATIONS.items()):
            yield _calculated(name, "READING", i, words)


def _calculated(name: str, kind: str, index: int, words: str) -> Variable:
    """An output that follows from states, inputs and parameters."""
    unit = unit_of_channel(name.strip("'"))
    return Variable(name, kind, index, unit, words, "output", initial="calculated")


def _derivatives(program: Program) -> Iterator[Variable]:
    """First and second derivatives of the coordinates; the first ones are states too."""
    columns = []
    for signal in STATE[: len(AXES)]:
        if signal.axis in program.vessel.dof:
            columns.append(signal.column)
    for i, column in enumerate(columns):
        unit = f"{unit_of_channel(column)}/s"
        yield _derivative(f"der({column})", i, unit, column, state=True)
    for i, column in enumerate(columns, len(columns)):
        unit = f"{unit_of_channel(column)}/s^2"
        yield _derivative(f"der({column},2)", i, unit, f"der({column})", state=False)


def _derivative(name: str, index: int, unit: str, of: str, state: bool) -> Variable:
    return Variable(
        name=name,
        kind="DERIVATIVE",
        index=index,
        unit=unit,
        words=f"time derivative of {of}",
        causality="local",
        initial="calculated",
        derivative_of=of,
        state=state,
    )
