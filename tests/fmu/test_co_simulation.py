"""An FMU in co-simulation moves as the compiled engine does, for FMI 3.0 and 2.0."""

import os
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np
import pytest

from boatsim.fmu.archive import write_fmu
from boatsim.physics.native.build import NoCompiler, compiler_path
from boatsim.physics.signals import COMPONENTS, STATE, Array, motion_signals
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.stepper import State

pytest.importorskip("fmpy")
from fmu_instance import opened, simulated  # noqa: E402

try:
    compiler_path()
except NoCompiler:
    pytest.skip("an FMU needs a C compiler", allow_module_level=True)

INTERVAL = 0.1  # [s] communication step, five integration steps
SAME = 1e-9  # largest difference, in SI units
CURRENT_TABLE = Path(__file__).parents[1] / "data" / "current.csv"
# planar; with lags and rate limits; six degrees of freedom; one
VESSELS = (
    "trial_boat",
    pytest.param("joystick_boat", marks=pytest.mark.slow),
    pytest.param("otter", marks=pytest.mark.slow),
    pytest.param("pendulum", marks=pytest.mark.slow),
)
Make = Callable[..., Path]


@pytest.fixture(scope="module")
def fmu(tmp_path_factory: pytest.TempPathFactory) -> Make:
    """Writes the FMU of a vessel once."""
    folder = tmp_path_factory.mktemp("fmu")
    written: list[tuple[Vessel, str, Path]] = []

    def write(vessel: Vessel, version: str = "3") -> Path:
        for known, its_version, path in written:
            if known == vessel and its_version == version:
                return path
        path = folder / f"{len(written)}.fmu"
        write_fmu(vessel, path, version)
        written.append((vessel, version, path))
        return path

    return write


def random_commands(vessel: Vessel, count: int) -> list[dict[str, float]]:
    """Commands that change in each communication step, some of them beyond their range."""
    rng = np.random.default_rng(5)
    rows = []
    for _ in range(count):
        row = {}
        for name, channel in vessel.commands.items():
            middle, half = (channel.low + channel.high) / 2, (channel.high - channel.low) / 2
            row[name] = float(middle + 1.1 * half * rng.uniform(-1.0, 1.0))
        rows.append(row)
    return rows


def names_of_outputs(vessel: Vessel) -> list[str]:
    forces = [f"force_{COMPONENTS[axis]}" for axis in COMPONENTS if axis in vessel.dof]
    return [*(signal.column for signal in motion_signals(vessel.dof)), *forces]


def engine_run(
    vessel: Vessel,
    commands: Sequence[Mapping[str, float]],
    start: State | None = None,
) -> Array:
    """The same outputs from the compiled engine."""
    engine = OpenWater(vessel)
    engine.reset(start, commands[0])
    moving = [i for i, signal in enumerate(STATE, 1) if signal.axis in vessel.dof]
    acting = [i for i, axis in enumerate(COMPONENTS) if axis in vessel.dof]
    rows = []
    for given in commands:
        engine.command(given)
        engine.advance(round(INTERVAL / engine.step))
        state, wrench = engine.state, engine.wrench()
        rows.append([*(state[i] for i in moving), *(wrench[i] for i in acting)])
    return np.array(rows)


@pytest.mark.parametrize("version", ["3", "2"])
@pytest.mark.parametrize("name", VESSELS)
def test_motion_and_forces_are_those_of_the_compiled_engine(
    name: str, version: str, fmu: Make
) -> None:
    vessel = load_vessel(name)
    commands = random_commands(vessel, 40)
    start = {"psi_rad": 0.7, "u_mps": 0.4, "v_mps": -0.2, "phi_rad": 0.1, "p_radps": 0.3}
    symbols = {signal.column: signal for signal in motion_signals(vessel.dof)}
    own = {column: value for column, value in start.items() if column in symbols}
    state = State(**{symbols[column].symbol: value for column, value in own.items()})
    expected = engine_run(vessel, commands, state)
    found = simulated(fmu(vessel, version), commands, INTERVAL, names_of_outputs(vessel), own)
    assert np.abs(expected).max() > 0.1
    np.testing.assert_allclose(found, expected, rtol=SAME, atol=SAME)


@pytest.mark.slow
def test_a_vessel_with_delay_and_lag_moves_as_in_the_compiled_engine(fmu: Make) -> None:
    vessel = load_vessel("trial_boat").with_effect({"use": "command_delay", "delay": 0.13})
    vessel = vessel.with_effect({"use": "rate_limit", "rate": 0.8})
    commands = random_commands(vessel, 40)
    found = simulated(fmu(vessel), commands, INTERVAL, names_of_outputs(vessel))
    np.testing.assert_allclose(found, engine_run(vessel, commands), rtol=SAME, atol=SAME)


@pytest.mark.slow
def test_a_changed_parameter_gives_the_motion_of_a_vessel_with_that_parameter(fmu: Make) -> None:
    vessel = load_vessel("joystick_boat")
    changes = {"surge_drag": {"quadratic": 4.0}, "body": {"mass": 6.1}, "servo": {"lag": 0.2}}
    values = {}
    for effect, table in changes.items():
        values |= {f"{effect}.{name}": value for name, value in table.items()}
    commands = random_commands(vessel, 20)
    names = names_of_outputs(vessel)
    expected = engine_run(vessel.with_parameters(changes), commands)
    found = simulated(fmu(vessel), commands, INTERVAL, names, values)
    np.testing.assert_allclose(found, expected, rtol=SAME, atol=SAME)
    assert np.abs(expected - engine_run(vessel, commands)).max() > 1e-3


def test_a_parameter_can_be_changed_between_two_steps(fmu: Make) -> None:
    vessel = load_vessel("trial_boat")
    with opened(fmu(vessel)) as boat:
        boat.start({"u_mps": 1.0})
        boat.step(0.0, 1.0)
        before = boat.get("body.mass", "sensed_ax_mps2")
        boat.set({"body.mass": 1e6})
        assert boat.get("body.mass") == [1e6]
        assert abs(boat.get("sensed_ax_mps2")[0]) < 1e-3 * abs(before[1])


def test_a_current_carries_a_boat_and_may_change(fmu: Make) -> None:
    vessel = load_vessel("trial_boat")
    drifting = vessel.with_effect({"use": "current", "north": 0.3, "east": -0.2})
    names = names_of_outputs(vessel)
    commands = random_commands(vessel, 20)
    flow = {"current.north": 0.3, "current.east": -0.2}
    found = simulated(fmu(vessel), commands, INTERVAL, names, flow)
    np.testing.assert_allclose(found, engine_run(drifting, commands), rtol=SAME, atol=SAME)
    with opened(fmu(vessel)) as boat:
        boat.start()
        boat.step(0.0, 1.0)
        still = boat.get("force_X_N")[0]
        boat.set({"current.north": 0.5})
        assert boat.get("force_X_N")[0] > still + 0.1


def test_a_current_of_a_table_adds_to_the_input_of_a_current(fmu: Make) -> None:
    table = {"use": "current_table", "file": str(CURRENT_TABLE), "start": 4.0, "scale": 0.5}
    vessel = load_vessel("trial_boat").with_effect(table)
    together = vessel.with_effect({"use": "current", "north": 0.3, "east": -0.2})
    names, commands = names_of_outputs(vessel), random_commands(vessel, 20)
    flow = {"current.north": 0.3, "current.east": -0.2}
    found = simulated(fmu(vessel), commands, INTERVAL, names, flow)
    np.testing.assert_allclose(found, engine_run(together, commands), rtol=SAME, atol=SAME)


def test_wind_acts_through_its_inputs_once_drag_areas_are_set(fmu: Make) -> None:
    vessel = load_vessel("trial_boat")
    areas = {"measured_wind.front": 0.05, "measured_wind.side": 0.2}
    blowing = vessel.with_effect(
        {"use": "fan_wind", "speed": 6.0, "toward": -2.0, "front": 0.05, "side": 0.2, "arm": 0.0}
    )
    names = names_of_outputs(vessel)
    commands = random_commands(vessel, 20)
    gale = {"wind_mps": 6.0, "wind_from_rad": np.pi - 2.0}
    found = simulated(fmu(vessel), commands, INTERVAL, names, areas | gale)
    np.testing.assert_allclose(found, engine_run(blowing, commands), rtol=SAME, atol=SAME)
    idle = simulated(fmu(vessel), commands, INTERVAL, names, gale)
    np.testing.assert_allclose(idle, engine_run(vessel, commands), rtol=SAME, atol=SAME)


@pytest.mark.slow
def test_the_wind_of_a_vessel_file_is_an_input(fmu: Make) -> None:
    vessel = load_vessel("trial_boat").with_effect({"use": "wind", "force": 0.2, "toward": 1.0})
    with opened(fmu(vessel)) as boat:
        boat.start()
        assert boat.get("wind.force", "wind.toward") == [0.2, 1.0]
        boat.set({"wind.force": 0.0})
        assert boat.get("force_Y_N") == pytest.approx([0.0], abs=1e-12)


def test_an_external_force_accelerates_the_boat(fmu: Make) -> None:
    vessel = load_vessel("trial_boat")
    with opened(fmu(vessel)) as boat:
        boat.start({"external.X_N": 2.0})
        (acceleration,) = boat.get("sensed_ax_mps2")
        boat.step(0.0, 0.02)
        assert 0.0 < boat.get("u_mps")[0] == pytest.approx(0.02 * acceleration, rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("version", ["3", "2"])
def test_a_stored_state_is_continued_in_the_same_way(version: str, fmu: Make) -> None:
    vessel = load_vessel("joystick_boat")
    names = [*names_of_outputs(vessel), "time"]
    commands = random_commands(vessel, 10)
    with opened(fmu(vessel, version)) as boat, opened(fmu(vessel, version)) as other:
        boat.start({"surge_drag.quadratic": 3.0})
        other.start()
        boat.set(commands[0])
        boat.step(0.0, INTERVAL)
        state, content = boat.states()

        def continue_run(one) -> list[float]:
            for i, given in enumerate(commands[1:], 1):
                one.set(given)
                one.step(i * INTERVAL, INTERVAL)
            return one.get(*names)

        first = continue_run(boat)
        boat.restore(state)
        assert continue_run(boat) == first
        other.restore(other.from_bytes(content))
        assert continue_run(other) == first


def test_two_instances_do_not_share_anything(fmu: Make) -> None:
    path = fmu(load_vessel("trial_boat"))
    with opened(path) as one, opened(path) as other:
        one.start({"u_mps": 1.0})
        other.start()
        one.step(0.0, 1.0)
        other.step(0.0, 1.0)
        assert one.get("x_m")[0] > 0.5 and other.get("x_m") == [0.0]


def test_a_communication_step_need_not_be_a_multiple_of_the_integration_step(fmu: Make) -> None:
    vessel = load_vessel("trial_boat")
    thrust = {name: channel.high / 2 for name, channel in vessel.commands.items()}
    path = fmu(vessel)
    ends = []
    for length, count in ((0.1, 30), (0.03, 100), (0.007, 0)):
        with opened(path) as boat:
            boat.start(thrust)
            count = count or round(3.0 / length)
            for i in range(count):
                boat.step(i * length, length)
            boat.step(count * length, 3.0 + 0.02 - count * length)
            ends.append(boat.get("x_m", "psi_rad", "time"))
    assert ends[0][0] > 0.3
    np.testing.assert_allclose(ends[1:], [ends[0]] * 2, rtol=1e-5, atol=1e-9)


def test_values_that_are_not_allowed_are_refused_with_their_bounds(fmu: Make) -> None:
    with opened(fmu(load_vessel("trial_boat"))) as boat:
        with pytest.raises(Exception, match="fmi3Error|status"):
            boat.set({"body.mass": -1.0})
        assert boat.messages == ["body.mass = -1; allowed 1e-09 to inf"]
        boat.start()
        for values, said in (
            ({"x_m": 1.0}, "x_m can be set before the start only"),
            ({"force_X_N": 1.0}, "force_X_N cannot be set"),
            ({"current.north": float("nan")}, "current.north = nan; allowed -5 to 5"),
        ):
            with pytest.raises(Exception, match="fmi3Error|status"):
                boat.set(values)
            assert boat.messages[-1] == said
        with pytest.raises(Exception, match="fmi3Error|status"):
            boat.step(3.0, 0.1)
        assert boat.messages[-1] == "a step of 0.1 s from t = 3 s; the vessel is at t = 0 s"


def test_a_motion_that_diverges_is_an_error(fmu: Make) -> None:
    with opened(fmu(load_vessel("trial_boat"))) as boat:
        boat.start({"u_mps": 1e200})
        with pytest.raises(Exception, match="fmi3Error|status"):
            boat.step(0.0, 1.0)
        assert boat.messages[-1].startswith("the motion is no longer finite at t = 1 s")


@pytest.mark.slow
def test_the_example_steers_a_boat_to_its_heading_as_the_page_shows(tmp_path: Path) -> None:
    root = Path(__file__).parents[2]
    done = subprocess.run(
        [sys.executable, root / "examples" / "fmu" / "couple.py", "--out", tmp_path],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "PYTHONPATH": str(root)},
    )
    assert done.stdout in (root / "docs" / "fmu.md").read_text()


@pytest.mark.slow
def test_a_saved_vessel_with_an_effect_that_was_found_is_exported_with_it(
    tmp_path: Path, fmu: Make
) -> None:
    effect = {"use": "thrust_imbalance", "fraction": 0.3}
    vessel = load_vessel("trial_boat")
    patched = vessel.with_effect(effect).replace(found=("thrust_imbalance",))
    patched.save(tmp_path / "patched")
    again = load_vessel(str(tmp_path / "patched"))
    commands = random_commands(vessel, 20)
    found = simulated(fmu(again), commands, INTERVAL, names_of_outputs(again))
    expected = engine_run(patched, commands)
    np.testing.assert_allclose(found, expected, rtol=SAME, atol=SAME)
    assert np.abs(expected - engine_run(vessel, commands)).max() > 1e-3
