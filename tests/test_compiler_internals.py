"""What boatsim assumes of undocumented parts of numba and MuJoCo; a new version must pass before
its bound is raised.

Each test covers one assumption in the list of `boatsim.physics.compiler_internals`.
"""

import ctypes
import importlib
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import mujoco
import numba
import numpy as np
import pytest
from numba import carray, njit, types
from numba.core.caching import FunctionCache, IndexDataCacheFile
from numpy.typing import NDArray

from boatsim.physics import compiler_internals as internals
from boatsim.physics.cache_folder import cache_folder
from boatsim.physics.content import content_root
from boatsim.physics.kernel.compiling import WITHOUT_REFERENCE_COUNTS, compiled
from boatsim.physics.signals import Wrench, wrench

PRIVATE = re.compile(r"numba\.core|\._cache\b|_nrt\b|llvmlite|\._address\b")
CACHED = """
from boatsim.physics.kernel.compiling import compiled


@compiled
def doubled(x):
    return 2.0 * x


print(doubled(1.5), sum(doubled.stats.cache_hits.values()))
"""


def test_only_two_modules_use_private_parts_of_the_compilers() -> None:
    users = set()
    for file in (content_root() / "boatsim").rglob("*.py"):
        if PRIVATE.search(file.read_text(encoding="utf-8")):
            users.add(file.relative_to(content_root() / "boatsim").as_posix())
    # numba.core.errors holds documented warnings
    assert users == {
        "physics/compiler_internals.py",
        "physics/function_compiler.py",
        "control/compiled.py",
    }


def test_the_installed_versions_lie_below_their_bounds() -> None:
    text = (content_root() / "pyproject.toml").read_text(encoding="utf-8")
    bound = re.search(r'"numba>=[\d.]+,<(\d+)\.(\d+)"', text)
    assert bound is not None, "numba has no upper bound"
    installed = tuple(int(n) for n in numba.__version__.split(".")[:2])
    assert installed < (int(bound[1]), int(bound[2]))
    assert re.search(r'"mujoco>=[\d.]+,<\d', text), "MuJoCo has no upper bound"


def test_1_compiled_code_fills_named_tuples_by_name_with_defaults() -> None:
    @njit
    def law(x: float) -> Wrench:
        return wrench(K=x, X=2)

    assert law(3.0) == Wrench(X=2.0, K=3.0)
    assert isinstance(law(3.0), Wrench)


def test_2_the_cache_of_numba_has_the_methods_that_are_replaced() -> None:
    for name in ("load", "save", "flush", "_save_data", "_load_data", "_dump", "_data_path"):
        assert callable(getattr(IndexDataCacheFile, name, None)), f"{name} is missing"
    assert callable(getattr(IndexDataCacheFile, "_open_for_write", None))

    @compiled
    def function(x: float) -> float:
        return x

    assert isinstance(function._cache, FunctionCache)
    assert type(function._cache._cache_file) is internals.SealedCacheFile
    assert function._cache._cache_file._source_stamp  # numba compares it with the one on disk


@pytest.mark.slow
def test_2_compiled_code_is_found_on_disk_and_a_damaged_file_is_compiled_again(
    tmp_path: Path,
) -> None:
    (tmp_path / "script.py").write_text(CACHED)
    cached = tmp_path / "cache"
    environment = os.environ | {
        "PYTHONPATH": str(content_root()),
        "BOATSIM_CACHE": str(cached),
        "NUMBA_CACHE_DIR": str(tmp_path / "numba"),  # of any user: nothing is read or written there
    }

    def hits() -> str:
        command = [sys.executable, str(tmp_path / "script.py")]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
        return done.stdout.strip()

    assert [hits(), hits()] == ["3.0 0", "3.0 1"]
    (code,) = tmp_path.rglob("*.nbc")
    assert code.is_relative_to(cached) and not (tmp_path / "numba").exists()
    content = bytearray(code.read_bytes())
    content[-1] ^= 1
    code.write_bytes(content)
    assert [hits(), hits()] == ["3.0 0", "3.0 1"]


def test_3_functions_without_reference_counts_contain_none() -> None:
    def first(rows: Any) -> float:
        row = rows[0]
        return row[0]

    def counts(function: Any) -> int:
        function(np.ones((2, 2)))
        (text,) = function.inspect_llvm().values()
        body = text[text.index("define") : text.index("define", text.index("define") + 1)]
        return len(re.findall(r"call void @NRT_(?:incref|decref)", body))

    assert counts(njit(**WITHOUT_REFERENCE_COUNTS)(first)) == 0


def test_4_compiled_code_calls_a_function_by_its_pointer() -> None:
    signature = types.float64(types.float64)

    @njit
    def doubled(x: float) -> float:
        return 2.0 * x

    @njit
    def applied(function: Any, x: float) -> float:
        return function(x)

    pointer = internals.FunctionPointer(doubled, signature)
    assert pointer.kind == types.FunctionType(signature)
    assert applied(pointer, 4.0) == 8.0


def test_5_a_callback_follows_an_address_to_an_array() -> None:
    def called(holder, _):  # type: ignore[no-untyped-def]
        address = carray(holder, (1,), np.int64)[0]
        carray(internals.pointer_from_integer(address), (1,), np.float64)[0] += 1.0

    target = np.array([2.0])
    holder = np.array([target.ctypes.data], dtype=np.int64)
    internals.compile_callback(called).ctypes(holder.ctypes.data, None)
    assert target[0] == 3.0


def words_at(address: int, count: int) -> NDArray[np.int64]:
    """Words of memory from an address on."""
    return np.frombuffer(ctypes.string_at(address, 8 * count), dtype=np.int64)


def test_6_the_fields_of_the_structs_of_mujoco_are_found() -> None:
    layout = internals.mujoco_layout()
    model = mujoco.MjModel.from_xml_string(internals.PROBE_MODELS[1])
    data = mujoco.MjData(model)
    data.time = 1.25
    words = words_at(data._address, max(layout.values()) + 1)
    for name in internals.FIELDS:
        assert words[layout[name]] == getattr(data, name).ctypes.data, f"mjData.{name}"
    assert words.view(np.float64)[layout["time"]] == 1.25
    sizes = words_at(model._address, 256).view(np.int32)
    assert sizes[layout["nuserdata"]] == model.nuserdata


def test_6_a_field_that_is_not_found_is_an_error_with_its_name(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(internals, "_search", lambda address, wanted: set())
    internals.mujoco_layout.cache_clear()
    try:
        with pytest.raises(internals.BadPhysics, match="mjData.qpos not found in MuJoCo"):
            internals.mujoco_layout()
    finally:
        internals.mujoco_layout.cache_clear()


def test_no_compiled_function_of_the_package_is_kept_outside_of_the_cache_folder() -> None:
    for name in ("boatsim.control.allocation", "boatsim.simulate.sensing", "boatsim.control.jet"):
        for one in vars(importlib.import_module(name)).values():
            if store := getattr(one, "_cache", None):
                folder = Path(getattr(store, "_cache_path", cache_folder()))
                assert folder.is_relative_to(cache_folder()), name
