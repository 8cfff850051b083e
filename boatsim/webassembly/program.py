"""The part of a vessel's program that simulates recordings, as C source and as WebAssembly."""

from pathlib import Path

from boatsim.physics.kernel.records import Inputs, VesselNumbers
from boatsim.physics.native.entries import ESTIMATION, RECORDS
from boatsim.physics.native.translate import Translation
from boatsim.physics.program import Program
from boatsim.webassembly.compiler import WasmCompiler, compile_to_wasm

FUNCTION = "simulate_intervals"  # of the kernel, which a diagnosis calls for its free runs
PAGE_FUNCTIONS = Path(__file__).parent / "c" / "page.c"


def program_source(program: Program) -> str:
    """Return the C source of a program that simulates intervals of a recording.

    Args:
        program: The compiled program of a vessel, with its candidate effects.

    Raises:
        NotTranslatable: A law has no C form.
    """
    translation = Translation()
    kinds = []
    for kind in ESTIMATION[FUNCTION].arguments:
        if kind in RECORDS:
            kinds.append(translation.declare_struct(kind, RECORDS[kind]))
        else:
            kinds.append(kind)
    name, _ = translation.translate_function(getattr(program.module, FUNCTION), kinds)
    inputs = translation.declare_struct(Inputs, RECORDS[Inputs])
    vessel = translation.declare_struct(VesselNumbers, RECORDS[VesselNumbers])
    sizes = {
        "NQ": program.module.NQ,
        "INPUTS": len(program.vessel.inputs),
        "VALUES": len(program.values()) + len(program.body),
        "BODY_NUMBERS": len(program.body),
        "EFFECTS": len(program.effects),
    }
    names = [
        f"#define SIMULATE_INTERVALS {name}",
        f"typedef {inputs.c} inputs_t;",
        f"typedef {vessel.c} vessel_t;",
    ]
    names += [f"#define {size} {count}" for size, count in sizes.items()]
    functions = PAGE_FUNCTIONS.read_text(encoding="utf-8")
    return "\n".join([translation.source_text, *names, functions])


def compile_program(program: Program, compiler: WasmCompiler) -> bytes:
    """Compile the part of a program that simulates recordings to a WebAssembly module.

    Args:
        program: The compiled program of a vessel, with its candidate effects.
        compiler: The compiler, from `find_compiler`.

    Returns:
        The binary module. It exports `memory`, `allocate` and `simulate` (`c/page.c`), and imports
        functions of JavaScript's `Math` from the module `math`.

    Raises:
        NotTranslatable: A law has no C form.
        NoWasmCompiler: The compiler fails.
    """
    return compile_to_wasm(program_source(program), compiler)
