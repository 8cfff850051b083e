"""Laws of controllers in C: the numbers of numba to the last bit, and independent copies."""

import importlib
import os
import subprocess
import sys
from copy import deepcopy
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from boatsim.control import native_law
from boatsim.control.base import Sense
from boatsim.control.compiled import SENSE, CompiledController, merged, record_type, unlocked
from boatsim.physics.content import (
    content_root,
    import_module_file,
    load_class,
    shipped_content_names,
)

STEPS = 200
# a record with integers, and a named tuple that is a constant of a module, have no C form
ONLY_NUMBA = {"l1_cruise", "l1_heading", "l1_thesis"}


def compiled_controllers() -> list[str]:
    """Names of the shipped controllers with a compiled law."""
    found = []
    for name in shipped_content_names("controller"):
        cls = load_class("controller", name, named=True)
        if issubclass(cls, CompiledController):
            found.append(name)
    return found


def sensed(rng: np.random.Generator) -> tuple[float, ...]:
    """Random readings, sometimes with a sensor missing."""
    readings = rng.normal(0.0, 1.0, len(SENSE.names or ()))
    if rng.uniform() < 0.2:
        readings[rng.integers(len(readings))] = np.nan
    return tuple(readings.tolist())


@pytest.mark.parametrize("name", compiled_controllers())
def test_a_law_in_c_has_the_numbers_of_numba(name: str) -> None:
    controller = load_class("controller", name, named=True)()
    own: Any = [
        controller.settings_array(),
        np.zeros(1, type(controller).memory_type),
        np.zeros(1, SENSE),
        *(np.zeros(1, of) for of in type(controller).record_types()),
    ]
    law = type(controller).law
    native = native_law._native_law(law, tuple(array.dtype for array in own))
    if name in ONLY_NUMBA:
        assert native is None
        return
    assert native is not None
    others = [array.copy() for array in own]
    call = native.partial(native_law.ONE, *own)
    rng = np.random.default_rng(3)
    for _ in range(STEPS):
        readings = sensed(rng)
        goal = tuple(rng.normal(0.0, 1.0, len(controller.goals)).tolist())
        for records in (own, others):
            records[2][0], records[3][0] = readings, goal
        call()
        law(native_law.ONE, *others)
        for mine, other in zip(own, others, strict=True):
            if mine.dtype.itemsize:
                mine, other = mine.view(np.float64), other.view(np.float64)
                assert np.array_equal(mine, other, equal_nan=True)


def test_a_copy_of_a_controller_has_a_state_of_its_own() -> None:
    controller = load_class("controller", "l1_joystick", named=True)()
    sense = Sense(0.0, 0.1, 0.05, 0.0, 0.0, 0.2, 0.0, 0.0, 0.0)
    controller.step(sense, {})
    before = controller.memory.copy()
    copy = deepcopy(controller)
    copy.step(sense, {"surge_mps": 0.4})
    assert np.array_equal(controller.memory, before)
    assert not np.array_equal(copy.memory, before)


RUN = """
from boatsim.control.base import Sense
from boatsim.physics.content import load_class
controller = load_class("controller", "l1_joystick", named=True)()
for k in range(20):
    sense = Sense(0.05 * k, 0.01 * k, 0.05, 0.0, 0.0, 0.2, 0.0, 0.0, 0.0)
    print(controller.step(sense, {"surge_mps": 0.4, "yaw_radps": 0.1}))
"""


@pytest.mark.slow
def test_without_a_c_compiler_numba_gives_the_same_commands() -> None:
    printed = []
    for switch in ("1", "0"):
        done = subprocess.run(
            [sys.executable, "-c", RUN],
            env=os.environ | {"BOATSIM_NATIVE": switch, "PYTHONPATH": str(content_root())},
            capture_output=True,
            text=True,
            check=True,
        )
        printed.append(done.stdout)
    assert printed[0] == printed[1]


def outputs(law: Any, native: bool) -> list[list[float]]:
    """Memory and commands after three calls of a law, in C or by numba."""
    records = [
        np.zeros(1, record_type("gain")),
        np.zeros(1, np.dtype([("a", float), ("buffer", float, (5,)), ("b", float), ("k", float)])),
        np.zeros(1, record_type("psi")),
        np.zeros(1, record_type("x")),
        np.zeros(1, record_type("u", "v")),
    ]
    records[1][0] = (11.0, np.arange(1.0, 6.0), 22.0, 0.0)
    records[2][0] = (7.0,)
    call: Any = partial(law, native_law.ONE, *records)
    if native:
        found = native_law._native_law(law, tuple(array.dtype for array in records))
        assert found is not None
        call = found.partial(native_law.ONE, *records)
    for _ in range(3):
        call()
    return [records[1].view(np.float64).tolist(), records[4].view(np.float64).tolist()]


@unlocked
def ring_buffer(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
    for k in boats:
        m = memory[k]
        i = int(m.k)
        sent[k].u = m.buffer[i - 1]  # the last entry at the first step
        for j in range(-2, 0):
            sent[k].v += m.buffer[j] * (1.0, 2.0, 4.0)[i - 3]
        m.buffer[i] = sense[k].psi
        m.k = (i + 1) % 5


@unlocked
def long_slices(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
    for k in boats:
        m = memory[k]
        n = int(m.k)
        m.buffer[n - 9 : 2] = -1.0
        m.buffer[n + 3 : 8] = 0.0
        m.buffer[4:1] = 5.0
        m.buffer[8:9] = 6.0
        sent[k].u = m.b


@unlocked
def divides_by_zero(
    boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any
) -> None:
    for k in boats:
        m = memory[k]
        least = -9223372036854775807 - int(m.a > 0.0)
        sent[k].u = 5 // int(m.k) + 5 % int(m.k)
        sent[k].v = least // (int(m.k) - 1) + least % (int(m.k) - 1)


@pytest.mark.parametrize("law", [ring_buffer, long_slices, divides_by_zero])
def test_indices_slices_and_divisions_are_those_of_numba(law: Any) -> None:
    assert outputs(law, native=True) == outputs(law, native=False)


def two_laws(gain: bool) -> Any:
    """One of two laws with equal qualified names."""
    if gain:

        @unlocked
        def law(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
            for k in boats:
                sent[k].u = 1.0

    else:

        @unlocked
        def law(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
            for k in boats:
                sent[k].u = 2.0

    return law


def test_two_laws_of_one_name_are_two_libraries() -> None:
    assert outputs(two_laws(True), native=True)[1] == [1.0, 0.0]
    assert outputs(two_laws(False), native=True)[1] == [2.0, 0.0]


@merged
def with_nothing(x: float, y: Any = None) -> float:
    return x if y is None else x + y


@unlocked
def calls_with_nothing(
    boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any
) -> None:
    for k in boats:
        sent[k].u = with_nothing(sense[k].psi)


@unlocked
def default_argument(
    boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any, extra: float = 2.0
) -> None:
    for k in boats:
        sent[k].u = extra * sense[k].psi


@unlocked
def number_of_boats(
    boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any
) -> None:
    for k in range(len(memory)):
        sent[k].u = sense[k].psi


@unlocked
def shape_of_boats(
    boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any
) -> None:
    for k in range(memory.shape[0]):
        sent[k].u = sense[k].psi


@unlocked
def last_boat(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
    for k in boats:
        sent[k].u = memory[-1].b


class InClass:
    """Holds a law whose text starts in the first column."""

    @unlocked
    def law(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:  # noqa: N805
        """A law.

Text in the first column.
        """  # fmt: skip
        for k in boats:
            sent[k].u = sense[k].psi


@pytest.mark.parametrize(
    "law",
    [
        calls_with_nothing,
        default_argument,
        number_of_boats,
        shape_of_boats,
        last_boat,
        InClass.law,
    ],
)
def test_numba_compiles_what_has_no_c_form_without_a_message(
    law: Any, recwarn: pytest.WarningsRecorder
) -> None:
    types = [("a", "b"), ("a", "b"), ("psi",), ("x",), ("u",)]
    records = [np.zeros(1, record_type(*names)) for names in types]
    records[1]["b"] = records[2]["psi"] = 3.0
    native_law.single_boat_law(law, records)()
    assert records[4]["u"][0] in (3.0, 6.0)
    assert not recwarn.list


LAW = '''"""A controller."""
from typing import Any
from boatsim.physics.kernel.compiling import unlocked
GAIN = {}

@unlocked
def law(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
    for k in boats:
        sent[k].u = {}
'''


@pytest.mark.parametrize(
    ("edit", "own"),
    [((1.0, "2.0"), True), ((3.0, "GAIN"), True), ((1.0, "2.0"), False)],
)
def test_a_law_is_that_of_the_loaded_file(
    edit: tuple[float, str], own: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "edited_law.py"
    path.write_text(LAW.format(1.0, edit[1] if edit[1] == "GAIN" else "1.0"))
    if own:
        module = import_module_file(path, f"edited_law_{tmp_path.name}")
    else:
        monkeypatch.syspath_prepend(str(tmp_path))
        monkeypatch.delitem(sys.modules, "edited_law", raising=False)
        module = importlib.import_module("edited_law")
    path.write_text(LAW.format(*edit))
    records = [np.zeros(1, record_type(name)) for name in ("a", "b", "c", "d", "u")]
    native_law.single_boat_law(module.law, records)()
    assert records[4]["u"][0] == 1.0
