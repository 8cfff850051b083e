"""Laws of controllers in C: the numbers of numba to the last bit, and independent copies."""

import os
import subprocess
import sys
from copy import deepcopy
from typing import Any

import numpy as np
import pytest

from boatsim.control import native_law
from boatsim.control.base import Sense
from boatsim.control.compiled import SENSE, CompiledController
from boatsim.physics.content import content_root, load_class, shipped_content_names

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
