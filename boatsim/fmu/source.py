"""C source of a vessel's FMU: its translated program, and tables of its variables and sizes.

The functions of FMI, which call it, are the files of `boatsim/fmu/c`.
"""

import sys
from collections.abc import Iterable, Sequence
from math import inf
from pathlib import Path
from typing import NamedTuple

from boatsim.errors import BadInput
from boatsim.fmu.sensors import SensorSuite, sensor_source, sensor_tables
from boatsim.fmu.variables import Variable
from boatsim.physics.commands import input_vector
from boatsim.physics.kernel.records import FleetArrays
from boatsim.physics.kinds.motion_memory import effects_with_motion_memory
from boatsim.physics.native.entries import RECORDS
from boatsim.physics.native.kinds import MATRIX, REAL, ROWS, VECTOR, WHOLE, Kind
from boatsim.physics.native.translate import Translation
from boatsim.physics.program import Program

HEADER = "vessel_program.h"  # the generated file
KINDS = (
    "TIME",
    "INPUT",
    "EXTERNAL_FORCE",
    "BODY",
    "PARAMETER",
    "MOTION",
    "ACTUATOR",
    "FORCE",
    "READING",
    "DERIVATIVE",
    "SENSED",
    "SENSOR_PARAMETER",
    "SEED",
)
STATE_ARGUMENTS = (REAL, VECTOR, VECTOR, WHOLE, VECTOR, VECTOR)  # t, s, act, at, p, on


class Function(NamedTuple):
    """A function of a program that the C source of the FMU calls."""

    macro: str  # name in the C source
    name: str  # name in the program
    module: str  # module of the program's package
    arguments: tuple[Kind, ...]
    result: str = ""  # name of the C type of its result, if that is a struct


FUNCTIONS = (
    Function("COMPUTE_MASS_CONSTANTS", "compute_mass_constants", "inertia", (VECTOR,) * 4),
    Function("SETTLE_ACTUATORS", "settle_actuators", "run", (VECTOR,) * 5),
    Function(
        "ADVANCE_ACTUATORS",
        "advance_actuators",
        "run",
        (VECTOR, VECTOR, REAL, VECTOR, VECTOR, VECTOR),
    ),
    Function(
        "SUBSTEP_LENGTH",
        "substep_length",
        "run",
        (VECTOR, VECTOR, REAL, REAL, VECTOR, VECTOR),
    ),
    Function("MINIMUM_SUBSTEP", "minimum_substep", "run", (REAL, REAL, REAL)),
    Function("JACOBIAN", "jacobian", "motion", (VECTOR, MATRIX)),
    Function("POSE_AND_VELOCITIES", "pose_and_velocities", "motion", (VECTOR,), "motion_t"),
    Function("TOTAL_BODY_FORCE", "total_body_force", "motion", STATE_ARGUMENTS, "force_t"),
    Function(
        "ACCELERATIONS",
        "accelerations",
        "motion",
        (*STATE_ARGUMENTS, VECTOR, VECTOR),
        "accelerations_t",
    ),
    Function(
        "INSTRUMENTS",
        "instrument_readings",
        "motion",
        (*STATE_ARGUMENTS, VECTOR, VECTOR),
        "readings_t",
    ),
)


def interface_source(name: str) -> str:
    """Return the text of a file of `boatsim/fmu/c`.

    Args:
        name: Its name, such as "fmi3.c".
    """
    return (Path(__file__).parent / "c" / name).read_text(encoding="utf-8")


def program_source(
    program: Program,
    variables: Sequence[Variable],
    step: float,
    token: str,
    sensors: SensorSuite | None = None,
) -> str:
    """Return the generated C source of a vessel's FMU.

    Args:
        program: The compiled program of the vessel.
        variables: The variables of the FMU in the order of their value references.
        step: Integration step [s].
        token: Instantiation token of the FMU.
        sensors: Sensors with errors; None for none.

    Raises:
        NotTranslatable: A law has no C form.
        BadInput: An effect has a memory of the motion.
    """
    if program.module.HAS_ADVANCE_MOTION_MEMORY:
        raise BadInput(
            f"{program.vessel.name}: an FMU takes no effect with a memory of the motion: "
            f"{effects_with_motion_memory(program.vessel.effects)}"
        )
    parts = [
        "/* The equations of motion of a vessel, translated by boatsim; not meant to be edited. */",
        translated_functions(program),
        *_sizes(program, variables, step),
        f"#define INSTANTIATION_TOKEN {c_text(token)}",
        *_start_values(program),
        *_sensors(sensors),
        *_variable_table(variables),
        "",
    ]
    return "\n".join(parts)


def translated_functions(program: Program) -> str:
    """Return the C source of the functions of a program that an FMU calls, with their names.

    Args:
        program: The compiled program of the vessel.

    Raises:
        NotTranslatable: A law has no C form.
    """
    package = program.module.__name__
    translation = Translation()
    fleet = translation.declare_struct(FleetArrays, RECORDS[FleetArrays])
    advance = sys.modules[f"{package}.batch"].advance_boats
    name, _ = translation.translate_function(advance, (ROWS, fleet, REAL, WHOLE))
    names = [f"typedef {fleet.c} fleet_t;", f"#define ADVANCE_BOATS {name}"]
    for function in FUNCTIONS:
        python = getattr(sys.modules[f"{package}.{function.module}"], function.name)
        name, result = translation.translate_function(python, function.arguments)
        names.append(f"#define {function.macro} {name}")
        if function.result:
            names.append(f"typedef {result.c} {function.result};")
    return "\n".join([translation.source_text, *names])


def _sizes(program: Program, variables: Sequence[Variable], step: float) -> list[str]:
    """Definitions of sizes; no array is empty."""
    code = program.module
    sizes = {
        "NQ": code.NQ,
        "MASSES": code.K,
        "HELD": code.HELD,
        "MEMORY": program.memory_size,
        "INPUTS": max(len(program.vessel.inputs), 1),
        "PARAMETERS": max(len(program.values()), 1),
        "VARIABLES": len(variables),
        "ACTUATORS_HAVE_STATES": int(program.composition.memory_size > 0),
    }
    numbers = {"STEP": step, "SHORTEST": code.SHORTEST, "ENOUGH": code.ENOUGH}
    found = [f"#define {name} {size}" for name, size in sizes.items()]
    return found + [f"#define {name} {c_number(x)} /* [s] */" for name, x in numbers.items()]


def _start_values(program: Program) -> list[str]:
    """Constant arrays: axes, switches, limits of inputs, and values at the start."""
    low, high = [], []
    for least, most in program.vessel.limits().values():
        low.append(least)
        high.append(most)
    integers = {"FREE_AXES": program.module.FREE, "SIGNALS": program.module.SHOWS}
    found = []
    for name, whole in integers.items():
        found.append(f"static const int {name}[] = {{{', '.join(map(str, whole))}}};")
    arrays = {
        "SWITCHES": program.effect_switches().tolist(),
        "INPUT_LOW": low,
        "INPUT_HIGH": high,
        "START_INPUTS": input_vector(program.vessel, {}).tolist(),
        "START_BODY": program.body.tolist(),
        "START_PARAMETERS": program.values().tolist(),
    }
    return found + [_array(name, values) for name, values in arrays.items()]


def _sensors(sensors: SensorSuite | None) -> list[str]:
    """Definitions of the sensors and of their random numbers."""
    if sensors is None:
        return ["#define SENSORS 0"]
    found = ["#define SENSORS 1", sensor_tables()]
    found += [f"#define {name} {value}" for name, value in sensor_source(sensors).items()]
    found.append(f"#define START_SEED {c_number(sensors.seed)}")
    return [*found, _array("START_SENSORS", sensors.parameters().values())]


def _array(name: str, values: Iterable[float]) -> str:
    """Definition of a constant array, with one zero in place of no numbers."""
    texts = list(map(c_number, values)) or ["0.0"]
    return f"static const double {name}[] = {{{', '.join(texts)}}};"


def _variable_table(variables: Sequence[Variable]) -> list[str]:
    """Table of the variables by value reference."""
    found = [
        f"enum {{ {', '.join(KINDS)} }};",
        "static const struct { int kind, index; double low, high; const char *name; } VARIABLE[] ="
        " {",
    ]
    for one in variables:
        bounds = f"{c_number(one.low)}, {c_number(one.high)}"
        found.append(f"    {{{one.kind}, {one.index}, {bounds}, {c_text(one.name)}}},")
    return [*found, "};"]


def c_number(value: float) -> str:
    """Return a number as C text without loss of digits."""
    if value in (inf, -inf):
        return "INFINITY" if value > 0.0 else "-INFINITY"
    return float(value).hex()


def c_text(text: str) -> str:
    """Return a string as a C literal; other characters than letters, digits and a few are octal."""
    plain = []
    for byte in text.encode():
        character = chr(byte)
        if character.isascii() and (character.isalnum() or character in " _-.,()[]"):
            plain.append(character)
        else:
            plain.append(f"\\{byte:03o}")
    return f'"{"".join(plain)}"'
