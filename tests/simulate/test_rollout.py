"""The twin alone: closed forms, order of the method, held commands, coordinates."""

from math import pi, sqrt
from pathlib import Path

import boats
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.physics.base import AXES, Array
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel
from boatsim.simulate.batch import Batch

NO_COMMANDS = np.zeros((100, 0))


@pytest.fixture
def roller(tmp_path: Path) -> Vessel:
    """A roll oscillator without damping: stiffness 2 N m, inertia 0.5 kg m2, 2 rad/s."""
    return vessel.load_vessel(str(boats.written(tmp_path, "test_roller", boats.ROLL)))


def held(compiled: Batch, rows: int, X: float, N: float) -> Array:
    return np.tile(compiled.program.command_array(boats.push(X, N)), (rows, 1))


FREEDOMS = [("surge", "sway", "yaw"), ("surge", "sway", "roll", "yaw"), AXES]


def freed(folder: Path, dof: tuple[str, ...]) -> Program:
    """The boat of the reference cases with other freedoms."""
    text = boats.PLANAR.replace('["surge", "sway", "yaw"]', f"{list(dof)}")
    text = text.replace("yaw_inertia = 0.5 }", "yaw_inertia = 0.5, pitch_inertia = 0.4 }", 1)
    return Program(vessel.load_vessel(str(boats.written(folder, "freed", text))))


@pytest.mark.parametrize("dof", FREEDOMS, ids=["3", "4", "6"])
def test_body_and_joint_velocities_are_each_others_inverse(
    dof: tuple[str, ...], tmp_path_factory: pytest.TempPathFactory
) -> None:
    program = freed(tmp_path_factory.mktemp("boat"), dof)
    n, moves = program.module.NQ, sum(axis in ("surge", "sway", "heave") for axis in dof)

    @given(st.lists(st.floats(-1.5, 1.5), min_size=2 * n, max_size=2 * n))
    def inverse(state: list[float]) -> None:
        joints = program.to_joint_rates(np.array(state))
        assert program.to_body_velocities(joints[None])[0] == pytest.approx(state, abs=1e-12)
        assert np.linalg.norm(joints[n : n + moves]) == pytest.approx(
            np.linalg.norm(state[n : n + moves])
        )

    inverse()


def test_ahead_on_an_easterly_heading_is_motion_along_y(tmp_path: Path) -> None:
    joints = freed(tmp_path, FREEDOMS[0]).to_joint_rates(
        np.array([0.0, 0.0, pi / 2, 1.0, 0.0, 0.3])
    )
    assert joints == pytest.approx([0, 0, pi / 2, 0, 1, 0.3], abs=1e-15)


def test_an_undamped_roll_is_a_harmonic(roller: Vessel) -> None:
    found = Batch(roller, step=0.01).rollout([0.2, 0.1], NO_COMMANDS, 0.1)
    t = 0.1 * np.arange(101)
    assert found[:, 0] == pytest.approx(0.2 * np.cos(2 * t) + 0.05 * np.sin(2 * t), abs=1e-7)


def test_the_method_is_of_fourth_order(roller: Vessel) -> None:
    def error(step: float) -> float:
        end = Batch(roller, step=step).rollout([0.2, 0.0], NO_COMMANDS, 0.2)[-1]
        return float(np.hypot(end[0] - 0.2 * np.cos(40.0), (end[1] + 0.4 * np.sin(40.0)) / 2))

    assert error(0.1) / error(0.05) == pytest.approx(16.0, rel=0.05)


def test_a_roll_period_is_that_of_the_whole_inertia() -> None:
    boat = vessel.load_vessel("kvlcc2_roll", settings={"linear_damping": {"roll": 0.0}})
    phi = Batch(boat).rollout([0.1, 0.0], np.zeros((1500, 0)), 0.02)[:, 0]
    rising = np.flatnonzero((phi[:-1] < 0) & (phi[1:] >= 0))
    ends = rising + phi[rising] / (phi[rising] - phi[rising + 1])
    assert 0.02 * np.diff(ends) == pytest.approx(2 * pi * sqrt((115.6 + 19.8) / 822.3), rel=1e-4)


def test_coasting_is_a_free_run_with_constant_commands(tmp_path: Path) -> None:
    compiled, start = Batch(boats.planar(tmp_path)), [0.0, 0.0, 0.3, 0.2, 0.1, -0.1]
    run = compiled.rollout(start, held(compiled, 50, 2.0, 0.1), 0.1)
    assert compiled.hold_commands(start, boats.push(2.0, 0.1), 250) == pytest.approx(
        run[-1], rel=1e-12
    )
    assert run[0] == pytest.approx(start)


def test_a_command_acts_from_its_row_on_and_not_before(tmp_path: Path) -> None:
    compiled = Batch(boats.planar(tmp_path))
    rows = np.vstack([held(compiled, 10, 0.0, 0.0), held(compiled, 10, 2.0, 0.0)])
    u = compiled.rollout([0.0] * 6, rows, 0.1)[:, 3]
    assert (u[:11] == 0.0).all() and (np.diff(u[10:]) > 0).all()


def test_values_given_take_the_place_of_the_vessels(tmp_path: Path) -> None:
    own, other = boats.planar(tmp_path), boats.planar(tmp_path, {"linear_damping": {"surge": 5.0}})
    compiled = Batch(own)
    values = compiled.program.values()
    values[compiled.program.parameter_index("linear_damping", "surge")] = 5.0
    start, rows = [0.0] * 6, held(compiled, 20, 2.0, 0.1)
    changed = compiled.rollout(start, rows, 0.1, values)
    assert (changed == Batch(other).rollout(start, rows, 0.1)).all()
    assert changed[-1, 3] < compiled.rollout(start, rows, 0.1)[-1, 3]


def test_rows_of_unequal_steps_are_refused(tmp_path: Path) -> None:
    compiled = Batch(boats.planar(tmp_path), step=0.02)
    for interval in (0.05, 0.001):
        with pytest.raises(BadInput, match=r"step 0\.02 s does not divide the interval"):
            compiled.rollout([0.0] * 6, held(compiled, 2, 0.0, 0.0), interval)
