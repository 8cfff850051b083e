"""Numbers of the thesis itself: its reference models (T7, T8) and the neutral steering angles of its boats (F8)."""

from collections.abc import Callable
from math import cos, degrees, radians, sin
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from boatsim import vessel
from boatsim.adaptive import LinearSystem, lyapunov, step_response
from boatsim.base import Array, motion

STEP = 1e-3  # [s]
SURGE = np.array([[-1.4]])
SWAY_YAW = np.array([[0.0, -1.0], [1.0, -1.4]])  # states v, r; inputs sway force, yaw moment
ARM = {"light": 0.60, "heavy": 0.64}  # [m] motors to centre of lateral resistance, T10 to T14


def response(am: Array, force: int, state: int) -> Array:
    """One state every millisecond of 30 s after a unit step of one force, b = I."""
    n = len(am)
    return step_response(LinearSystem(am, np.eye(n)[:, [force]], np.eye(n)[[state]]), STEP, 30_000)[:, 0]


def crossing(x: Array, level: float) -> float:
    """Time [s] at which a rising signal first reaches a level."""
    i = int(np.argmax(x >= level))
    return STEP * (i - 1 + (level - x[i - 1]) / (x[i] - x[i - 1]))


def rise(x: Array) -> float:
    """10 to 90 % of the last value [s]; 0 where that is zero."""
    last = x[-1]
    return 0.0 if abs(last) < 1e-6 else crossing(x / last, 0.9) - crossing(x / last, 0.1)


def settling(x: Array) -> float:
    """Time [s] from which on the signal stays within 2 % of its last value, or of its peak where that is zero."""
    last = x[-1] if abs(x[-1]) > 1e-6 else 0.0
    scale = abs(last) or np.abs(x).max()
    off = np.abs(x - last) > 0.02 * scale
    return STEP * float(len(x) - np.argmax(off[::-1]))


def peak(x: Array) -> float:
    return float(x[np.argmax(np.abs(x))])


# Section 5 of the review, its exact column; the thesis prints the same to two or three digits
EXACT = [
    ("u from surge force", SURGE, 0, 0, 1.569, 0.714, 2.794),
    ("v from sway force", SWAY_YAW, 0, 0, 1.562, 1.500, 5.272),
    ("v from yaw moment", SWAY_YAW, 1, 0, 2.126, -1.046, 5.980),
    ("r from sway force", SWAY_YAW, 0, 1, 2.126, 1.046, 5.980),
    ("r from yaw moment", SWAY_YAW, 1, 1, 0.0, 0.459, 7.094),
]


@pytest.mark.parametrize(
    ("name", "am", "force", "state", "rises", "peaks", "settles"), EXACT, ids=[e[0] for e in EXACT]
)
def test_reference_models_respond_as_published(
    name: str, am: Array, force: int, state: int, rises: float, peaks: float, settles: float
) -> None:
    x = response(am, force, state)
    assert (rise(x), peak(x), settling(x)) == pytest.approx((rises, peaks, settles), rel=0.005)


def test_lyapunov_matrix_of_the_reference_model() -> None:
    assert lyapunov(SWAY_YAW) == pytest.approx(np.array([[99 / 70, -1 / 2], [-1 / 2, 5 / 7]]), abs=1e-12)


def test_reference_model_turns_in_a_pure_sway() -> None:
    """Its gain at rest is v = 1.4 F - N, r = F: the thesis' diagonal feed-forward asks for 2.9 deg/s at 0.07 m/s."""
    gain = -np.linalg.inv(SWAY_YAW)
    assert gain == pytest.approx(np.array([[1.4, -1.0], [1.0, 0.0]]))
    assert degrees((gain @ np.diag([0.7143, 1.0]) @ [0.07, 0.0])[1]) == pytest.approx(2.9, abs=0.05)


def moment(load: str, spacing: str) -> Callable[[float], float]:
    """Yaw moment [N m] about the centre of lateral resistance over the inward angle [deg], 1 N ahead, 1 N astern."""
    boat: Any = vessel.load("joystick_boat", [load, spacing])
    outboards = boat.effect("outboards")

    def at(angle: float) -> float:
        a = radians(angle)
        wrench = outboards.wrench(
            motion(thrust_port_N=1.0, thrust_starboard_N=-1.0, steer_port_rad=a, steer_starboard_rad=-a)
        )
        resistance_ahead_of_cg = outboards.x + ARM[load]
        return float(wrench.N - resistance_ahead_of_cg * wrench.Y)

    return at


@pytest.mark.parametrize(
    ("load", "spacing", "published"),
    [
        ("light", "narrow", 17.57),
        ("light", "wide", 25.02),
        ("heavy", "narrow", 16.53),
        ("heavy", "wide", 23.63),
    ],
)
def test_neutral_angles_of_the_boat_files_are_the_published_ones(load: str, spacing: str, published: float) -> None:
    turning = moment(load, spacing)
    assert brentq(turning, 0.0, 45.0) == pytest.approx(published, abs=0.05)
    assert turning(published - 5.0) > 0.0 > turning(published + 5.0)


@pytest.mark.parametrize(
    ("load", "spacing", "straight", "hard_over"),
    [
        ("light", "narrow", 0.190, -0.290),
        ("light", "wide", 0.280, -0.226),
        ("heavy", "narrow", 0.190, -0.318),
        ("heavy", "wide", 0.280, -0.255),
    ],
)
def test_turning_lever_spans_the_published_range(load: str, spacing: str, straight: float, hard_over: float) -> None:
    """The lever is the moment over the sum of both thrusts, here 2 N."""
    turning = moment(load, spacing)
    assert (turning(0.0) / 2, turning(45.0) / 2) == pytest.approx((straight, hard_over), abs=5e-4)


def test_sway_force_of_the_motors_is_the_sum_of_both_thrusts_times_the_sine() -> None:
    boat: Any = vessel.load("joystick_boat", ["light", "narrow"])
    a = radians(20.0)
    wrench = boat.effect("outboards").wrench(
        motion(thrust_port_N=0.5, thrust_starboard_N=-0.3, steer_port_rad=a, steer_starboard_rad=-a)
    )
    assert (wrench.X, wrench.Y) == pytest.approx((0.2 * cos(a), 0.8 * sin(a)))
