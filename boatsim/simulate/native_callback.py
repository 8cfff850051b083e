"""Makes a vessel's force callback native, so that no interpreter runs inside MuJoCo's step.

The callback is compiled against the layout of MuJoCo's structs. No header is needed: the addresses of mjData's
buffers are known from Python, so scanning the struct for them gives each field's offset, whatever the version.
"""

import ctypes
from functools import cache
from pathlib import Path

import mujoco
import numpy as np

from boatsim.errors import BadPhysics

FIELDS = (
    "qpos",
    "qvel",
    "userdata",
    "qfrc_passive",
    "M",
)  # arrays of mjData, found by the address of their buffer
SCAN = 1 << 17  # [words] no field of interest lies further from the start of the struct
A_TIME = 76543.21098765432  # [s] a time that occurs nowhere else in a fresh mjData
SIZES = (1237, 3571, 911)  # sizes of userdata that occur nowhere else in a fresh mjModel

_PROBES = (
    """<mujoco><size nuserdata="5"/><worldbody><body><joint type="slide" axis="1 0 0"/><joint axis="0 0 1"/>
    <inertial pos="0 0 .1" mass="1" diaginertia="1 1 1"/></body></worldbody></mujoco>""",
    """<mujoco><size nuserdata="3"/><worldbody><body><freejoint/><geom size=".1"/></body></worldbody></mujoco>""",
)


def _words(address: int, count: int) -> np.ndarray:
    """A view of `count` 8-byte words of memory."""
    return np.ctypeslib.as_array(ctypes.cast(address, ctypes.POINTER(ctypes.c_int64)), (count,))


def _scan(address: int, wanted: int) -> set[int]:
    """Word offsets at which the struct holds `wanted`; stops soon after the first, so as not to leave the struct."""
    hits: set[int] = set()
    for start in range(0, SCAN, 32):
        found = np.flatnonzero(_words(address + 8 * start, 32) == wanted)
        hits |= {start + int(i) for i in found}
        if hits and not len(found):
            break
    return hits


@cache
def layout() -> dict[str, int]:
    """Word offsets of mjData's fields and of its time, and the 4-byte offset of mjModel's nuserdata.

    Raises BadPhysics if a field is not found, in which case the Python callback serves.
    """
    saved = mujoco.get_mjcb_passive()
    mujoco.set_mjcb_passive(None)  # compiling the probes runs callbacks
    try:
        probes = [mujoco.MjData(mujoco.MjModel.from_xml_string(xml)) for xml in _PROBES]
        found = {}
        for name in FIELDS:
            # fields of size zero share their neighbour's address; the last candidate common to both
            # probes is right
            hits = set.intersection(
                *(_scan(d._address, getattr(d, name).ctypes.data) for d in probes)
            )
            if not hits:
                raise BadPhysics(f"mjData.{name} not found in MuJoCo {mujoco.__version__}")
            found[name] = max(hits)
        probes[0].time = A_TIME
        found["time"] = min(
            _scan(probes[0]._address, int(np.float64(A_TIME).view(np.int64))), default=-1
        )
        found["nuserdata"] = _size_offset()
    finally:
        mujoco.set_mjcb_passive(saved)
    if found["time"] < 0:
        raise BadPhysics(f"mjData.time not found in MuJoCo {mujoco.__version__}")
    return found


def _size_offset() -> int:
    """Offset of mjModel.nuserdata in 4-byte words, by models of several known sizes."""
    common: set[int] = set(range(512))
    for size in SIZES:
        model = mujoco.MjModel.from_xml_string(f'<mujoco><size nuserdata="{size}"/></mujoco>')
        words = np.ctypeslib.as_array(
            ctypes.cast(model._address, ctypes.POINTER(ctypes.c_int32)), (512,)
        )
        common &= set(np.flatnonzero(words == size).tolist())
    if len(common) != 1:
        raise BadPhysics(f"mjModel.nuserdata not found in MuJoCo {mujoco.__version__}")
    return common.pop()


@cache
def make_symbols_known() -> None:
    """Let compiled code call MuJoCo's own mj_factorM by name."""
    from llvmlite import binding

    folder = Path(mujoco.__file__).parent
    library = sorted([*folder.glob("libmujoco.so*"), *folder.glob("libmujoco*.dylib")])[0]
    binding.load_library_permanently(str(library))
