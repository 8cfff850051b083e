"""A vessel's compiled program, translated for Warp and kept where compiled programs are."""

from hashlib import sha256
from types import ModuleType

from boatsim.errors import BadInput
from boatsim.physics import cache
from boatsim.physics.program import Program
from boatsim.warp.kernels import ALONE, FORCES, HEAD, PARTS
from boatsim.warp.translate import NoForm, Translation
from boatsim.warp.values import NOTHING, REAL, ROW, WHOLE, Kind

ENTRIES: dict[str, tuple[Kind, ...]] = {  # what kernels call, and the kinds of its arguments
    "add_to_mujoco": (REAL, ROW, ROW, ROW, WHOLE, ROW, ROW, ROW, ROW),
    "step_in_place": (REAL, ROW, REAL, ROW, ROW, NOTHING, ROW, ROW),
    "actuate_in_place": (ROW, ROW, REAL, ROW, NOTHING, ROW),
    "until_bend": (ROW, ROW, REAL, REAL, ROW, NOTHING),
    "least_after": (REAL, REAL, REAL),
}


def text_of(program: Program, real: str) -> str:
    """The whole module; `real` is the kind of its floats. Raises BadInput for an effect that has no form there."""
    code, translation = program.module, Translation()
    try:
        for name, kinds in ENTRIES.items():
            translation.function(getattr(code, name), kinds)
    except NoForm as error:
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


def module(program: Program, real: str = "float32") -> ModuleType:
    """The translated program with the kernels of `boatsim.warp.kernels`, for Warp to compile."""
    return kept(text_of(program, real))


def kept(text: str) -> ModuleType:
    """A module of Warp's as a file in the cache: Warp reads the text of what it compiles."""
    return cache.package({"__init__.py": text}, f"warp_{sha256(text.encode()).hexdigest()[:16]}")
