"""An FMU in model exchange: a solver outside integrates the states, the FMU moves the actuators."""

from pathlib import Path

import numpy as np
import pytest

from boatsim.fmu.archive import write_fmu
from boatsim.physics.native.build import NoCompiler, compiler_path
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.simulate.open_water import OpenWater

fmpy = pytest.importorskip("fmpy")
from fmu_instance import FmuInstance, opened  # noqa: E402

try:
    compiler_path()
except NoCompiler:
    pytest.skip("an FMU needs a C compiler", allow_module_level=True)

PERIOD = 0.1  # [s] between changes of the commands
NAMES = ("x_m", "y_m", "psi_rad", "u_mps", "v_mps", "r_radps")


class Solver:
    """The classical Runge-Kutta method with one step from each event to the next."""

    def __init__(self, boat: FmuInstance) -> None:
        self.boat = boat
        self.size = boat.fmu.getNumberOfContinuousStates()
        self.t = 0.0

    def derivatives(self, t: float, y: Array) -> Array:
        found = np.zeros(self.size)
        self.boat.fmu.setTime(t)
        self._set(y)
        self.boat.fmu.getContinuousStateDerivatives(_pointer(found), self.size)
        return found

    def _set(self, y: Array) -> None:
        self.boat.fmu.setContinuousStates(_pointer(y), self.size)

    def advance(self, until: float, longest: float) -> None:
        """Integrate to a time with steps that end at events."""
        while until - self.t > 1e-9:
            *_, defined, event = self.boat.fmu.updateDiscreteStates()
            self.boat.fmu.enterContinuousTimeMode()
            end = min(until, self.t + longest)
            if defined:
                end = min(end, event)
            h, y = end - self.t, np.zeros(self.size)
            self.boat.fmu.getContinuousStates(_pointer(y), self.size)
            a = self.derivatives(self.t, y)
            b = self.derivatives(self.t + h / 2, y + h / 2 * a)
            c = self.derivatives(self.t + h / 2, y + h / 2 * b)
            d = self.derivatives(self.t + h, y + h * c)
            self._set(y + h / 6 * (a + 2 * b + 2 * c + d))
            self.t = end
            self.boat.fmu.enterEventMode()


def _pointer(values: Array):
    from ctypes import POINTER, c_double

    return values.ctypes.data_as(POINTER(c_double))


def commands_of(vessel: Vessel) -> list[dict[str, float]]:
    rng = np.random.default_rng(8)
    rows = []
    for _ in range(20):
        rows.append(
            {name: float(rng.uniform(c.low, c.high)) for name, c in vessel.commands.items()}
        )
    return rows


@pytest.mark.parametrize(
    "name", ["trial_boat", pytest.param("joystick_boat", marks=pytest.mark.slow)]
)
def test_a_solver_with_the_steps_of_the_engine_gives_its_motion(name: str, tmp_path: Path) -> None:
    vessel = load_vessel(name)
    write_fmu(vessel, tmp_path / "boat.fmu")
    rows = commands_of(vessel)
    engine = OpenWater(vessel)
    engine.reset(None, rows[0])
    found, expected = [], []
    with opened(tmp_path / "boat.fmu", "me") as boat:
        boat.start(rows[0])
        solver = Solver(boat)
        for i, given in enumerate(rows, 1):
            engine.command(given)
            engine.advance(round(PERIOD / engine.step))
            expected.append(engine.state[1:3] + engine.state[6:9] + engine.state[12:])
            boat.set(given)
            solver.advance(i * PERIOD, engine.step)
            found.append(boat.get(*NAMES))
    assert np.abs(expected).max() > 0.05
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-9)


@pytest.mark.slow
def test_commands_that_change_within_a_part_act_at_once(tmp_path: Path) -> None:
    vessel = load_vessel("joystick_boat")
    write_fmu(vessel, tmp_path / "boat.fmu", step=0.05)
    write_fmu(vessel, tmp_path / "fine.fmu", step=0.001)
    first, second = commands_of(vessel)[:2]
    with opened(tmp_path / "boat.fmu", "me") as boat, opened(tmp_path / "fine.fmu") as fine:
        boat.start(first)
        fine.start(first)
        solver = Solver(boat)
        for at, given in ((0.32, second), (0.673, first), (1.5, second)):
            solver.advance(at, 0.05)
            fine.step(fine.get("time")[0], at - fine.get("time")[0])
            np.testing.assert_allclose(boat.get(*NAMES), fine.get(*NAMES), rtol=1e-4, atol=1e-5)
            boat.set(given)
            fine.set(given)


@pytest.mark.slow
def test_the_solver_of_fmpy_integrates_a_vessel(tmp_path: Path) -> None:
    path = tmp_path / "boat.fmu"
    vessel = load_vessel("otter")
    write_fmu(vessel, path)
    given = {**dict.fromkeys(vessel.commands, 70.0), "u_mps": 0.5, "current.east": 0.2}
    found = {}
    for kind in ("CoSimulation", "ModelExchange"):
        rows = fmpy.simulate_fmu(
            str(path),
            fmi_type=kind,
            start_values=given,
            stop_time=5.0,
            output_interval=0.5,
            output=[*NAMES, "force_X_N"],
            relative_tolerance=1e-10,
        )
        found[kind] = rows[-1].tolist()
    assert found["CoSimulation"][1] > 1.0
    np.testing.assert_allclose(found["ModelExchange"], found["CoSimulation"], rtol=1e-5, atol=1e-6)
