"""The parts of a vessel's program that a page runs, as C source and as WebAssembly."""

from collections.abc import Mapping
from pathlib import Path

from boatsim.physics.kernel.records import FleetArrays, Inputs, VesselNumbers
from boatsim.physics.native.calls import argument_kinds
from boatsim.physics.native.entries import ESTIMATION, RECORDS, SIMULATION
from boatsim.physics.native.kinds import REAL, Kind
from boatsim.physics.native.translate import Translation
from boatsim.physics.program import Program
from boatsim.webassembly.compiler import WasmCompiler, compile_to_wasm

REPLAY = "simulate_intervals"  # of the kernel, which a diagnosis calls for its free runs
STEP = (  # of the kernel, which an engine calls in each step
    "substep_length",
    "advance_actuators",
    "step_in_place",
)
MEMORY_OF_MOTION = "advance_memory_of_motion"
FOLDER = Path(__file__).parent / "c"


def program_source(program: Program) -> str:
    """Return the C source of a program that simulates intervals of a recording.

    Args:
        program: The compiled program of a vessel, with its candidate effects.

    Raises:
        NotTranslatable: A law has no C form.
    """
    translation = Translation()
    names = _translated(translation, program, REPLAY)
    names |= _record_types(translation, {"inputs_t": Inputs, "vessel_t": VesselNumbers})
    sizes = {
        "NQ": program.module.NQ,
        "INPUTS": len(program.vessel.inputs),
        "VALUES": len(program.values()) + len(program.body),
        "BODY_NUMBERS": len(program.body),
        "EFFECTS": len(program.effects),
    }
    return _source(translation, {**names, **sizes}, "recordings.c")


def driving_source(program: Program, wind: Program | None = None) -> str:
    """Return the C source of a program that simulates one vessel step by step.

    Args:
        program: The compiled program of a vessel.
        wind: The program of the same vessel with its effects of air alone; None for none.

    Raises:
        NotTranslatable: A law has no C form.
    """
    translation, module = Translation(), program.module
    names = dict[str, object]()
    for function in STEP:
        names |= _translated(translation, program, function)
    if module.HAS_ADVANCE_MOTION_MEMORY:
        names |= _translated(translation, program, MEMORY_OF_MOTION)
    else:
        names[f"{MEMORY_OF_MOTION.upper()}(...)"] = ""
    name, _ = translation.translate_function(module.minimum_substep, [REAL] * 3)
    names["MINIMUM_SUBSTEP"] = name
    state = translation.declare_struct(None, [REAL] * (2 * module.NQ))
    name, motion = translation.translate_function(module.pose_and_velocities, [state])
    names |= {"POSE_AND_VELOCITIES": name, "state_t": state.c, "motion_t": motion.c}
    kinds = argument_kinds(translation, SIMULATION["total_body_force"])
    name, force = translation.translate_function(module.total_body_force, kinds)
    names |= {"TOTAL_BODY_FORCE": name, "force_t": force.c}
    names |= _record_types(translation, {"fleet_t": FleetArrays})
    if wind is not None:
        names |= {
            "WIND_FORCE": translation.translate_function(wind.module.total_body_force, kinds)[0],
            "WIND_HELD": wind.module.HELD,
            "WIND_VALUES": len(wind.values()),
            "WIND_EFFECTS": len(wind.effects),
        }
    sizes = {
        "NQ": module.NQ,
        "HELD": module.HELD,
        "INPUTS": len(program.vessel.inputs),
        "ACTUATORS": len(program.vessel.actuators),
        "MEMORY": program.memory_size,
        "VALUES": len(program.values()),
        "EFFECTS": len(program.effects),
        "MASSES": module.K,
        "SHORTEST": module.SHORTEST,
        "ENOUGH": module.ENOUGH,
    }
    return _source(translation, {**names, **sizes}, "driving.c")


def compile_program(program: Program, compiler: WasmCompiler) -> bytes:
    """Compile the part of a program that simulates recordings to a WebAssembly module.

    Args:
        program: The compiled program of a vessel, with its candidate effects.
        compiler: The compiler, from `find_compiler`.

    Returns:
        The binary module. It exports `memory`, `allocate` and `simulate` (`c/recordings.c`), and
        imports functions of JavaScript's `Math` from the module `math`.

    Raises:
        NotTranslatable: A law has no C form.
        NoWasmCompiler: The compiler fails.
    """
    return compile_to_wasm(program_source(program), compiler)


def compile_driving_program(
    program: Program, compiler: WasmCompiler, wind: Program | None = None
) -> bytes:
    """Compile the part of a program that simulates one vessel step by step to WebAssembly.

    Args:
        program: The compiled program of a vessel.
        compiler: The compiler, from `find_compiler`.
        wind: The program of the same vessel with its effects of air alone; None for none.

    Returns:
        The binary module. It exports `memory`, `allocate`, `place_boat`, `advance`, `observe` and,
        with wind, `place_wind` (`c/driving.c`), and imports functions of JavaScript's `Math` from
        the module `math`.

    Raises:
        NotTranslatable: A law has no C form.
        NoWasmCompiler: The compiler fails.
    """
    return compile_to_wasm(driving_source(program, wind), compiler)


def _translated(translation: Translation, program: Program, function: str) -> dict[str, object]:
    """Translate a function of the program; return its name in capitals with its name in C."""
    entries = {**SIMULATION, **ESTIMATION}
    kinds: list[Kind] = argument_kinds(translation, entries[function])
    name, _ = translation.translate_function(getattr(program.module, function), kinds)
    return {function.upper(): name}


def _record_types(translation: Translation, types: Mapping[str, type]) -> dict[str, object]:
    """Declare the structs of named tuples; return the name of each in the page's C file."""
    found = dict[str, object]()
    for name, record in types.items():
        found[name] = translation.declare_struct(record, RECORDS[record]).c
    return found


def _source(translation: Translation, names: Mapping[str, object], functions: str) -> str:
    """Return translated functions followed by a C file of this package that calls them."""
    lines = [f"#define {name} {value!s}" for name, value in names.items()]
    files = [(FOLDER / file).read_text(encoding="utf-8") for file in ("memory.c", functions)]
    return "\n".join([translation.source_text, *lines, *files])
