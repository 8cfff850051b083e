"""Boats whose recordings have names of their own: the BlueBoat with its swapped thrusters, a USV of
unknown mass."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from boatsim.cli import diagnosis as commands
from boatsim.diagnosis import loading
from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.physics.base import SignalSegment, make_motion
from boatsim.physics.effects.added_mass import AddedMass
from boatsim.physics.effects.dragged_propeller import DraggedPropeller
from boatsim.physics.effects.sway_yaw_coupling import SwayYawCoupling
from boatsim.physics.effects.thruster import Thruster
from boatsim.recordings import table as recording

DATA = Path(__file__).parents[1] / "data" / "twin_usv_paths"
MASS, ARM, INERTIA = 15.0, 0.285, 1.7  # kg, m, kg m^2 as the source of the recordings gives them
SURGE, SWAY, YAW = 32.0, 60.0, 15.0  # N s/m, N s/m, N m s of the vessel file
HEADER = "t_s,north_m,east_m,heading_rad,u_mps,v_mps,r_radps,pwm_left_us,pwm_right_us,force_left_N,force_right_N,filled"


def slopes(t: float, y: np.ndarray, left: float, right: float) -> list[float]:
    """The nominal boat written down here; the thruster called right is the one on the port side."""
    _, _, psi, u, v, r = y
    c, s = np.cos(psi), np.sin(psi)
    return [
        u * c - v * s,
        u * s + v * c,
        r,
        (left + right - SURGE * u) / MASS + v * r,
        -SWAY * v / MASS - u * r,
        (ARM * (right - left) - YAW * r) / INERTIA,
    ]


def recorded(folder: Path, seconds: float = 40.0) -> Path:
    """A run of the nominal boat, in the columns of the lake recordings, speeds spoilt: they must
    not be looked at."""
    rng = np.random.default_rng(5)
    t = np.arange(0.0, seconds + 0.05, 0.1)
    force = np.repeat(rng.uniform(-20.0, 50.0, (len(t) // 20 + 1, 2)), 20, axis=0)[: len(t)]
    y = np.zeros((len(t), 6))
    y[0] = [3.0, -7.0, 1.2, 0.0, 0.0, 0.0]
    for i in range(len(t) - 1):
        y[i + 1] = solve_ivp(
            slopes, (0.0, 0.1), y[i], args=tuple(force[i]), rtol=1e-9, atol=1e-12
        ).y[:, -1]
    pose = y[:, :3] + rng.normal(0.0, [0.005, 0.005, 0.001], (len(t), 3))
    idle = np.full((len(t), 2), 1511.0)
    rows = np.column_stack(
        [t, pose, rng.normal(0.0, 1.0, (len(t), 3)), idle, force, np.zeros(len(t))]
    )
    path = folder / "run_900.csv"
    np.savetxt(path, rows, delimiter=",", header=HEADER, comments="", fmt="%.6f")
    return path


def test_a_vessel_names_the_columns_of_its_recordings(tmp_path: Path) -> None:
    path = recorded(tmp_path)
    boat = vessel.load_vessel("blueboat")
    seen = recording.read(path, boat.limits(), boat.columns)
    table = np.genfromtxt(path, delimiter=",", names=True)
    assert seen["x_m"] == pytest.approx(table["north_m"])
    assert seen["thrust_port_N"] == pytest.approx(table["force_right_N"])
    assert seen["thrust_starboard_N"] == pytest.approx(table["force_left_N"])
    assert "u_mps" not in seen.signals and seen["estimate_u_mps"] == pytest.approx(table["u_mps"])


def test_a_recording_toml_has_the_last_word_about_columns(tmp_path: Path) -> None:
    path = recorded(tmp_path)
    (tmp_path / "recording.toml").write_text('[columns]\npsi_rad = "-heading_rad"\n')
    boat = vessel.load_vessel("blueboat")
    seen = recording.read(path, boat.limits(), boat.columns)
    table = np.genfromtxt(path, delimiter=",", names=True)
    assert seen["psi_rad"] == pytest.approx(-table["heading_rad"])
    assert seen["y_m"] == pytest.approx(table["east_m"])


def test_a_minus_in_a_vessels_columns_flips_the_sign(tmp_path: Path) -> None:
    seen = recording.read(
        recorded(tmp_path), columns={"x_m": "north_m", "psi_rad": "- heading_rad"}
    )
    table = np.genfromtxt(tmp_path / "run_900.csv", delimiter=",", names=True)
    assert seen["psi_rad"] == pytest.approx(-table["heading_rad"])


def test_without_a_vessel_the_line_says_that_there_is_none(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match=r"run_900\.csv: no vessel given"):
        loading.open_recording(recorded(tmp_path), None, [])


def test_more_of_the_channel_called_left_turns_the_blueboat_to_port(tmp_path: Path) -> None:
    boat = vessel.load_vessel("blueboat")
    assert boat.columns["thrust_starboard_N"] == "force_left_N"
    left, right = 30.0, 10.0
    thrusts = {"port": right, "starboard": left}
    wrenches = [
        e.wrench(make_motion(), pushing(e, thrusts[e.name]))
        for e in boat.effects_of_type("thruster")
    ]
    X, Y, _, _, _, N = np.sum(wrenches, axis=0)
    assert N == pytest.approx(ARM * (right - left))
    assert X == pytest.approx(left + right) and Y == 0.0


def pushing(thruster: Thruster, thrust: float, angle: float = 0.0) -> Any:
    """Its signals."""
    return type(thruster).signals_type()(thrust, angle, np.cos(angle), np.sin(angle))


@pytest.mark.slow
def test_a_run_in_the_columns_of_the_lake_is_replayed_right(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    commands.replay(recorded(tmp_path), "blueboat", [], 10.0, tmp_path / "out")
    said = dict(line.split(":") for line in capsys.readouterr().out.splitlines()[:2])
    assert float(said["position_rms_m"].split()[0]) < 0.1  # it goes some 15 m in 10 s
    assert float(said["heading_rms_rad"].split()[0]) < 0.02


def test_the_munk_moment_is_a_coupling_of_yaw_to_sway() -> None:
    added = AddedMass(surge=1.0, sway=12.0, yaw=0.5)
    at = {"u": 1.3, "v": -0.4, "r": 0.0}
    munk = added.wrench(make_motion(**at)).N
    assert SwayYawCoupling(yaw=12.0 - 1.0).wrench(make_motion(**at)).N == pytest.approx(munk)
    assert SwayYawCoupling(yaw=11.0).wrench(make_motion(u=-1.3, v=-0.4)).N == pytest.approx(-munk)


def test_a_boat_that_turns_without_slipping_has_its_side_force_from_the_coupling() -> None:
    u, r = 1.5, 0.6
    wrench = SwayYawCoupling(sway=-MASS).wrench(make_motion(u=u, r=r))
    assert wrench.Y == pytest.approx(MASS * u * r)  # centripetal force of a circle at the speed u
    assert wrench.X == wrench.Z == wrench.K == wrench.M == wrench.N == 0.0


@pytest.mark.parametrize("speed", [2.0, -1.3])
@pytest.mark.parametrize("thrust", [30.0, 8.0, -8.0, -30.0])
def test_of_a_thrust_against_the_way_is_left_what_exceeds_the_idle_drag(
    thrust: float, speed: float
) -> None:
    drag, a, yawing = 4.0, 0.4, 0.5
    port = (
        speed + ARM * yawing
    )  # along its axis, of a mount on the port side in a turn to starboard
    m = make_motion(u=port * np.cos(a) - ARM * yawing, v=port * np.sin(a), r=yawing)
    own, signals = Thruster(y=-ARM), pushing(Thruster(), thrust, a)
    left = (
        thrust if thrust * port > 0.0 else np.sign(thrust) * max(abs(thrust) - drag * port**2, 0.0)
    )
    both = np.add(
        own.wrench(m, signals), DraggedPropeller(drag=drag).wrench(m, signals, own.values())
    )
    assert both == pytest.approx(
        [left * np.cos(a), left * np.sin(a), 0.0, 0.0, 0.0, ARM * left * np.cos(a)]
    )


def test_an_idle_propeller_and_one_at_rest_lack_nothing() -> None:
    lost, at = DraggedPropeller(drag=4.0), Thruster(x=-0.45, y=-ARM).values()
    idle, nothing = make_motion(u=2.0, v=0.1, r=0.3), pytest.approx(np.zeros(6))
    assert lost.wrench(idle, pushing(Thruster(), 0.0), at) == nothing
    assert lost.wrench(make_motion(), pushing(Thruster(), 20.0), at) == nothing


def test_the_usv_of_no_mass_turns_to_the_side_whose_thruster_pushes_less() -> None:
    boat = vessel.load_vessel("twin_usv")
    seen, _ = loading.open_recording(DATA / "sin.csv", "twin_usv", [])
    assert boat.columns.get("pwm_left_us", "pwm_left_us") == "pwm_left_us"
    smooth = np.ones(20) / 20
    turning = np.convolve(np.gradient(seen["psi_rad"], seen.t), smooth, "same")
    push = np.convolve(seen["pwm_left_us"] - seen["pwm_right_us"], smooth, "same")
    assert np.corrcoef(turning, push)[0, 1] > 0.9
    port = replace(boat.effect("pulse_thrust"), at_span=2.0)  # type: ignore[type-var]
    given = type(port).transform_signal(
        SignalSegment(0.0, 0.0, 0.0), -1.0, 1700.0, np.zeros(1), 0, 0.1, port.values()
    )
    assert given == pytest.approx((1.0, 1.0, 1.0))
