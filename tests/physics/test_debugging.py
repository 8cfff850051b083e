"""`BOATSIM_DEBUG=1` runs the same run line by line in Python; a slow callback is reported."""

import os
import subprocess
import sys
import warnings
from pathlib import Path

import boats
import pytest

from boatsim.errors import BadPhysics
from boatsim.physics.content import content_root
from boatsim.simulate import native_callback
from boatsim.simulate.engine import Engine

RUN = """
import sys
import numpy as np
from boatsim.physics import vessel
from boatsim.physics.kernel.records import Inputs
from boatsim.simulate.engine import Engine
from boatsim.simulate.open_water import OpenWater

boat = vessel.load_vessel(sys.argv[1])
engine, water = Engine(boat), OpenWater(boat)
for stepper in (engine, water):
    stepper.command({"thrust_port_N": 1.0})
    stepper.advance(10)
    print(*(repr(float(x)) for x in stepper.state))
program = engine.program
times, out = 0.1 * np.arange(5), np.zeros((1, 5, 6))
inputs = Inputs(times, times[:1], program.command_array({"thrust_port_N": 1.0})[None])
begin, end, start = np.array([0]), np.array([4]), np.zeros((1, 6))
program.module.simulate_intervals(inputs, 0.02, program.vessel_numbers(), begin, end, start, out)
print(*(repr(float(x)) for x in out[0, -1]))
code = getattr(program.module.simulate_intervals, "py_func", program.module.simulate_intervals).__code__
print(code.co_filename)
print(hasattr(program.module.simulate_intervals, "py_func"))
"""


def run(place: Path, debug: str) -> list[str]:
    """Lines that the script prints in a process of its own."""
    done = subprocess.run(
        [sys.executable, "-c", RUN, str(place)],
        cwd=place.parent,
        env=os.environ | {"BOATSIM_DEBUG": debug, "PYTHONPATH": str(content_root())},
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.splitlines()


@pytest.mark.slow
def test_a_run_in_plain_python_has_the_same_numbers_and_the_files_of_the_repository(
    tmp_path: Path,
) -> None:
    place = boats.written(tmp_path, "test_boat", boats.PLANAR)
    *numbers, file, has_compiled = run(place, "1")
    *compiled_numbers, compiled_file, was_compiled = run(place, "0")
    assert (has_compiled, was_compiled) == ("False", "True")
    assert file == str(content_root() / "boatsim" / "physics" / "kernel" / "filter.py")
    assert compiled_file != file
    for line, other in zip(numbers, compiled_numbers, strict=True):
        found, wanted = ([float(x) for x in text.split()] for text in (line, other))
        assert found == pytest.approx(wanted, rel=1e-12, abs=1e-15)
        assert any(found)


def test_a_callback_in_python_is_reported_once_with_the_reason(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def missing() -> dict[str, int]:
        raise BadPhysics("mjData.qpos not found in MuJoCo 9.0")

    monkeypatch.setattr(native_callback, "mujoco_layout", missing)
    native_callback.warn_of_slow_callback.cache_clear()
    boat = boats.planar(tmp_path)
    with pytest.warns(native_callback.SlowCallbackWarning, match="mjData.qpos not found") as seen:
        Engine(boat)
        Engine(boat)
    own = [one for one in seen if issubclass(one.category, native_callback.SlowCallbackWarning)]
    assert len(own) == 1 and "\n" not in str(own[0].message)  # others: files of earlier tests


def test_a_native_callback_with_other_numbers_is_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    native_callback.warn_of_slow_callback.cache_clear()
    monkeypatch.setattr(Engine, "_callbacks_agree", lambda *_: False)
    with pytest.warns(native_callback.SlowCallbackWarning, match="accelerations differ"):
        Engine(boats.planar(tmp_path))


def test_a_python_callback_that_was_asked_for_is_not_reported(tmp_path: Path) -> None:
    native_callback.warn_of_slow_callback.cache_clear()
    with warnings.catch_warnings():
        warnings.simplefilter("error", native_callback.SlowCallbackWarning)
        Engine(boats.planar(tmp_path), callback="python")
