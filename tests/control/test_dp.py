"""Dynamic positioning holds a vessel, and its parts do what the page says."""

from math import hypot, inf, nan, pi

import numpy as np
import pytest

from boatsim.control.base import Sense
from boatsim.control.passive_observer import PassiveObserver
from boatsim.control.reference_motion import ReferenceMotion
from boatsim.control.thrust_allocation import Setting
from boatsim.control.vessel_model import DriveCommands, ModelBasedController, WindLoads
from boatsim.errors import BadInput
from boatsim.physics.content import load_class
from boatsim.physics.vessel import load_vessel
from boatsim.simulate.vessel_model import vessel_model

OSV = vessel_model(load_vessel("osv"))


def controller(**settings: object) -> ModelBasedController:
    """Dynamic positioning of the supply vessel."""
    made: ModelBasedController = load_class("controller", "dp").from_settings(settings)
    made.use_vessel_model(OSV)
    return made


def hold(
    made: ModelBasedController,
    load: np.ndarray,
    seconds: float,
    outage: tuple[float, float] = (inf, inf),
) -> np.ndarray:
    """Errors (n, 3) of the linear vessel model under a constant load in body axes, heading zero.

    There is no position fix from the begin to the end of an outage [s].
    """
    place, velocity, rows = np.zeros(3), np.zeros(3), []
    inverse = np.linalg.inv(OSV.mass)
    for k in range(round(seconds / made.period)):
        t = k * made.period
        fix = [nan, nan] if outage[0] <= t < outage[1] else place[:2]
        sense = Sense(t, place[2], velocity[2], 0, 0, 0, 0, fix[0], fix[1])
        sent = made.step(sense, {"x_m": 0.0, "y_m": 0.0, "psi_rad": 0.0})
        thrust = np.array([sent[drive.thrust] for drive in OSV.drives])
        angle = np.array([sent.get(drive.angle, 0.0) for drive in OSV.drives])
        columns = [one.effect(a) for one, a in zip(OSV.thrusters, angle, strict=True)]
        force = np.array(columns).T @ thrust
        for _ in range(5):
            rate = inverse @ (force + load - OSV.damping @ velocity)
            velocity = velocity + 0.2 * made.period * rate
            place = place + 0.2 * made.period * velocity
        rows.append(place)
    return np.array(rows)


def test_a_constant_wind_leaves_no_mean_error() -> None:
    load = np.array([-6e4, 1e5, 1.5e6])
    settings = {"wave_frequency": 0.785, "natural_frequency": 0.15, "period": 1.0}
    errors = hold(controller(**settings), load, 500.0)
    assert np.abs(errors[:100]).max() > 0.3
    assert np.abs(errors[-50:].mean(axis=0)) == pytest.approx(np.zeros(3), abs=0.02)
    # without integral action the load over the stiffness remains
    without = hold(controller(**settings, integral=False), load, 300.0)
    stiffness = OSV.mass[0, 0] * 0.15**2
    assert without[-1, 0] == pytest.approx(load[0] / stiffness, rel=0.1)


def test_in_an_outage_of_the_position_the_vessel_is_held_by_the_model() -> None:
    load = np.array([-6e4, 1e5, 0.0])
    settings = {"wave_frequency": 0.785, "natural_frequency": 0.15, "period": 1.0}
    errors = hold(controller(**settings), load, 460.0, outage=(400.0, 430.0))
    assert np.abs(errors[400:, :2]).max() < 0.5  # without thrust the load moves it by 8 m


def test_the_reference_reaches_its_goal_within_its_limits() -> None:
    reference = ReferenceMotion(20.0)
    goal = np.array([30.0, 40.0, -3.0])
    reference.reset(np.array([0.0, 0.0, 3.0]))
    speeds, turns = [], []
    for _ in range(800):
        reference.step(goal, 0.5, 0.01, 0.5)
        speeds.append(hypot(*reference.velocity[:2]))
        turns.append(reference.position[2])
        assert hypot(*reference.acceleration[:2]) <= 0.5 / 20.0 + 1e-12
    assert max(speeds) <= 0.5 + 1e-12
    assert reference.position[:2] == pytest.approx(goal[:2], abs=0.05)
    assert turns[-1] == pytest.approx(2.0 * pi - 3.0, abs=0.01) and max(turns) <= 3.3


def test_the_wind_force_of_the_model_is_that_of_the_effect() -> None:
    loads = WindLoads(150.0, 468.0, 5.0, -15.0)
    X, Y, N = loads.force(3.0, -4.0)
    assert (X, Y) == pytest.approx((0.6 * 5.0 * 150.0 * 3.0, -0.6 * 5.0 * 468.0 * 4.0))
    assert pytest.approx((5.0 - 15.0 * 0.6) * Y) == N
    assert loads.force(0.0, 0.0) == (0.0, 0.0, 0.0)


def test_the_mass_matrix_of_the_model_is_that_of_its_source() -> None:
    m = 1025.0 * 0.65 * 83.0 * 18.0 * 5.0
    yaw = m * (0.25 * 83.0) ** 2 + m * 4.5**2 + 1.156e9
    wanted = [[m + 1e6, 0, 0], [0, m + 3e6, -4.5 * m - 6e6], [0, -4.5 * m - 6e6, yaw]]
    assert np.allclose(OSV.mass, wanted, rtol=1e-4)


def test_a_shaft_rate_gives_its_thrust() -> None:
    drive = DriveCommands("n", ahead=0.01, astern=0.005)
    assert drive.command_for_thrust(25.0) == pytest.approx(50.0)
    assert drive.command_for_thrust(-20.0) == pytest.approx(-(4000.0**0.5))
    setting = Setting(np.array([0.0, 0.0, 1e3, 0.0]), np.array([0.0, 0.0, 0.7, 0.0]))
    sent = OSV.commands(setting)
    assert sent["port_N"] == 1e3 and sent["port_angle_rad"] == 0.7


def test_a_thruster_out_of_service_gets_no_command() -> None:
    made = controller(unused=["port"])
    sent = made.step(Sense(0.0, 0, 0, 0, 0, 0, 0, 0, 0), {"x_m": 5.0})
    assert "port_N" not in sent and "starboard_N" in sent


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"unused": ["prt"]}, "did you mean 'port'"),
        ({"unused": ["bow_1", "bow_2", "port", "starboard"]}, "at least one thruster"),
        ({"weights": {"bow": 2.0}}, "does not exist"),
        ({"wave_frequency": 0.0}, "wave_frequency"),
    ],
)
def test_wrong_settings_are_refused(settings: dict[str, object], message: str) -> None:
    with pytest.raises(BadInput, match=message):
        controller(**settings)


def test_a_vessel_without_position_fix_is_refused() -> None:
    nan = float("nan")
    with pytest.raises(BadInput, match="position_sd"):
        controller().step(Sense(0.0, 0, 0, 0, 0, nan, nan, nan, nan), {})
    with pytest.raises(BadInput, match="above 0"):
        PassiveObserver(OSV.mass, OSV.damping, -1.0, 0.5)
