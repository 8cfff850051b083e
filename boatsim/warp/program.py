"""A vessel's program, translated for Warp and kept in the cache folder of compiled programs."""

from hashlib import sha256
from types import ModuleType

from boatsim.errors import BadInput
from boatsim.physics import cache
from boatsim.physics.kinds.motion_memory import effects_with_motion_memory
from boatsim.physics.program import Program
from boatsim.warp.kernels import ALONE, FORCES, HEAD, PARTS
from boatsim.warp.translate import NotTranslatable, Translation
from boatsim.warp.values import NOTHING, REAL, ROW, WHOLE, Kind

# Functions that the kernels call, and the kinds of their arguments
ENTRIES: dict[str, tuple[Kind, ...]] = {
    "add_force_and_inertia_to_mujoco": (REAL, ROW, ROW, ROW, WHOLE, ROW, ROW, ROW, ROW),
    "step_in_place": (REAL, ROW, REAL, ROW, ROW, NOTHING, ROW, ROW),
    "advance_actuators": (ROW, ROW, REAL, ROW, NOTHING, ROW),
    "substep_length": (ROW, ROW, REAL, REAL, ROW, NOTHING),
    "minimum_substep": (REAL, REAL, REAL),
}


def translated_source(program: Program, real: str) -> str:
    """Return the source of a vessel's compiled program, translated to Warp's dialect of Python.

    Args:
        program: The vessel's program.
        real: Kind of its floats, "float32" or "float64".

    Raises:
        BadInput: The law of an effect cannot be translated.
    """
    code, translation = program.module, Translation()
    if code.HAS_ADVANCE_MOTION_MEMORY:
        raise BadInput(
            f"{program.vessel.name}: a batch on Warp takes no effect with a memory of the motion: "
            f"{effects_with_motion_memory(program.vessel.effects)}"
        )
    try:
        for name, kinds in ENTRIES.items():
            translation.translate_function(getattr(code, name), kinds)
    except NotTranslatable as error:
        raise BadInput(f"{program.vessel.name}: {error}") from None
    limits = {
        "{real}": real,
        "{enough}": repr(code.ENOUGH),
        "{shortest}": repr(code.SHORTEST),
    }
    text = "\n\n".join([HEAD, translation.text, FORCES, PARTS, ALONE])
    for mark, number in limits.items():
        text = text.replace(mark, number)
    return text


def import_program(program: Program, real: str = "float32") -> ModuleType:
    """Translate a vessel's program for Warp and import it as a module, with the kernels of a batch.

    Args:
        program: The vessel's program.
        real: Kind of its floats, "float32" or "float64".
    """
    return import_text(translated_source(program, real))


def import_text(text: str) -> ModuleType:
    """Write the source of a Python module to the cache folder and import it.

    Warp needs a file, since it reads the source of what it compiles.

    Args:
        text: Source of the module.
    """
    return cache.import_cached_package(
        {"__init__.py": text}, f"warp_{sha256(text.encode()).hexdigest()[:16]}"
    )
