"""Numbers of the thesis itself: its reference models (T7, T8) and the neutral steering angles of
its boats (F8)."""

from collections.abc import Callable
from math import cos, degrees, radians, sin
from typing import Any

import numpy as np
import pytest

from benchmarks import thesis_models
from boatsim.control.adaptive import solve_lyapunov
from boatsim.physics import vessel
from boatsim.physics.base import Wrench, make_motion

ARM = thesis_models.ARM
SWAY_YAW = thesis_models.SWAY_YAW

# Section 5 of the review, its exact column; the thesis prints the same to two or three digits
EXACT = {
    "u from surge force": (1.569, 0.714, 2.794),
    "v from sway force": (1.562, 1.500, 5.272),
    "v from yaw moment": (2.126, -1.046, 5.980),
    "r from sway force": (2.126, 1.046, 5.980),
    "r from yaw moment": (0.0, 0.459, 7.094),
}


@pytest.mark.parametrize("name", EXACT)
def test_reference_models_respond_as_published(name: str) -> None:
    assert thesis_models.step_response_figures(*thesis_models.RESPONSES[name]) == pytest.approx(
        EXACT[name], rel=0.005
    )


# T27 to its two decimals; N_rdot is printed -0.84, which would make the yaw inertia negative
T27 = {
    "Y_vdot": 1.37,
    "Y_rdot": 0.09,
    "N_vdot": 0.07,
    "N_rdot": 0.074,
    "Y_v": 2.72,
    "Y_r": -0.35,
    "N_v": 0.62,
    "N_r": 0.31,
}


def test_derivatives_are_clarkes_regressions() -> None:
    assert thesis_models.derivatives() == pytest.approx(T27, abs=0.0051)


def test_lyapunov_matrix_of_the_reference_model() -> None:
    assert solve_lyapunov(SWAY_YAW) == pytest.approx(
        np.array([[99 / 70, -1 / 2], [-1 / 2, 5 / 7]]), abs=1e-12
    )


def test_reference_model_turns_in_a_pure_sway() -> None:
    """Its gain at rest is v = 1.4 F - N, r = F: the thesis' diagonal feed-forward asks for 2.9 deg/s at 0.07 m/s."""
    gain = -np.linalg.inv(SWAY_YAW)
    assert gain == pytest.approx(np.array([[1.4, -1.0], [1.0, 0.0]]))
    assert degrees((gain @ np.diag([0.7143, 1.0]) @ [0.07, 0.0])[1]) == pytest.approx(2.9, abs=0.05)


def moment(load: str, spacing: str) -> Callable[[float], float]:
    """Yaw moment [N m] about the centre of lateral resistance over the inward angle [deg], 1 N
    ahead, 1 N astern."""
    boat: Any = vessel.load_vessel("joystick_boat", [load, spacing])

    def at(angle: float) -> float:
        pushed = inward(boat, 1.0, -1.0, angle)
        resistance_ahead_of_cg = boat.effect("port").x + ARM[load]
        return float(pushed.N - resistance_ahead_of_cg * pushed.Y)

    return at


def inward(boat: Any, port: float, starboard: float, angle: float) -> Wrench:
    """Wrench of both motors at these thrusts [N], turned inward by an angle [deg]."""
    a = radians(angle)
    one = boat.effect("port").wrench(make_motion(), thrust=port, angle=a)
    return Wrench(
        *np.add(one, boat.effect("starboard").wrench(make_motion(), thrust=starboard, angle=-a))
    )


@pytest.mark.parametrize(
    ("load", "spacing", "published"),
    [
        ("light", "narrow", 17.57),
        ("light", "wide", 25.02),
        ("heavy", "narrow", 16.53),
        ("heavy", "wide", 23.63),
    ],
)
def test_neutral_angles_of_the_boat_files_are_the_published_ones(
    load: str, spacing: str, published: float
) -> None:
    turning = moment(load, spacing)
    assert thesis_models.neutral_angle(load, spacing) == pytest.approx(published, abs=0.05)
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
def test_turning_lever_spans_the_published_range(
    load: str, spacing: str, straight: float, hard_over: float
) -> None:
    """The lever is the moment over the sum of both thrusts, here 2 N."""
    turning = moment(load, spacing)
    assert (turning(0.0) / 2, turning(45.0) / 2) == pytest.approx((straight, hard_over), abs=5e-4)


def test_sway_force_of_the_motors_is_the_sum_of_both_thrusts_times_the_sine() -> None:
    boat: Any = vessel.load_vessel("joystick_boat", ["light", "narrow"])
    wrench, a = inward(boat, 0.5, -0.3, 20.0), radians(20.0)
    assert (wrench.X, wrench.Y) == pytest.approx((0.2 * cos(a), 0.8 * sin(a)))
