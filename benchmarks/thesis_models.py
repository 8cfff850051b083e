"""Print figures of the thesis that need no run: `python -m benchmarks.thesis_models`.

These are the reference models (T7, T8), the neutral steering angles (F8) and the derivatives (T27).
"""

from math import degrees, pi, sqrt

import numpy as np
from scipy.optimize import brentq

from boatsim.control.adaptive import LinearSystem, step_response
from boatsim.physics import vessel
from boatsim.physics.base import Array, Force, make_motion

STEP = 1e-3  # [s]
SURGE = np.array([[-1.4]])
SWAY_YAW = np.array([[0.0, -1.0], [1.0, -1.4]])  # states v, r; inputs sway force, yaw moment
RESPONSES = {  # name -> model, input, state
    "u from surge force": (SURGE, 0, 0),
    "v from sway force": (SWAY_YAW, 0, 0),
    "v from yaw moment": (SWAY_YAW, 1, 0),
    "r from sway force": (SWAY_YAW, 0, 1),
    "r from yaw moment": (SWAY_YAW, 1, 1),
}
LENGTH, BEAM, DRAUGHT, BLOCK = 1.2, 0.30, 0.06, 0.86  # [m] and block coefficient in T27
SWAY = 0.07  # [m/s] speed commanded in the sway tests
GRAVITY = 9.81  # [m/s^2]
ARM = {"light": 0.60, "heavy": 0.64}  # [m] motors to centre of lateral resistance, T10 to T14


def figures() -> dict[str, float]:
    """Return every figure by name: times in s, angles in deg."""
    found = {}
    for name, (model, force, state) in RESPONSES.items():
        rise, peak, settling = step_response_figures(model, force, state)
        found |= {f"{name}: rise": rise, f"{name}: peak": peak, f"{name}: settling": settling}
    for load in ARM:
        for spacing in ("narrow", "wide"):
            found[f"neutral angle {load} {spacing}"] = neutral_angle(load, spacing)
    return (
        found | derivatives() | {"Froude number of the sway tests": SWAY / sqrt(GRAVITY * LENGTH)}
    )


def derivatives() -> dict[str, float]:
    """Return the derivatives of T27: Clarke's regressions (1983) divided by -pi (T/L)^2."""
    b, t, h = BEAM / LENGTH, BEAM / DRAUGHT, DRAUGHT / LENGTH
    return {
        "Y_vdot": 1.0 + 0.16 * BLOCK * t - 5.1 * b**2,
        "Y_rdot": 0.67 * b - 0.0033 * t**2,
        "N_vdot": 1.1 * b - 0.041 * t,
        "N_rdot": 1.0 / 12.0 + 0.017 * BLOCK * t - 0.33 * b,
        "Y_v": 1.0 + 0.4 * BLOCK * t,
        "Y_r": -0.5 + 2.2 * b - 0.08 * t,
        "N_v": 0.5 + 2.4 * h,
        "N_r": 0.25 + 0.039 * t - 0.56 * b,
    }


def step_response_figures(model: Array, force: int, state: int) -> tuple[float, float, float]:
    """Return rise time, peak and settling time of a state after a unit step of a force.

    Args:
        model: State matrix (n, n); the input matrix is the identity.
        force: Index of the force.
        state: Index of the state.

    Returns:
        Rise time from 10 to 90 % [s], peak, and settling time to 2 % [s]. If the final value is zero,
        the rise time is 0 and the settling time refers to 2 % of the peak.
    """
    n = len(model)
    x = step_response(LinearSystem(model, np.eye(n)[:, [force]], np.eye(n)[[state]]), STEP, 30_000)[
        :, 0
    ]
    peak = float(x[np.argmax(np.abs(x))])
    last = float(x[-1]) if abs(x[-1]) > 1e-6 else 0.0
    rise = _crossing(x / last, 0.9) - _crossing(x / last, 0.1) if last else 0.0
    off = np.abs(x - last) > 0.02 * abs(last or peak)
    return rise, peak, STEP * float(len(x) - np.argmax(off[::-1]))


def _crossing(x: Array, level: float) -> float:
    """Return the time [s] at which a rising signal first reaches a level."""
    i = int(np.argmax(x >= level))
    return float(STEP * (i - 1 + (level - x[i - 1]) / (x[i] - x[i - 1])))


def neutral_angle(load: str, spacing: str) -> float:
    """Return the inward angle [deg] at which opposite thrusts of both motors cause no yaw moment."""
    port, starboard = vessel.load_vessel("joystick_boat", [load, spacing]).effects_of_type(
        "thruster"
    )
    assert isinstance(port, Force) and isinstance(starboard, Force)
    resistance = port.x + ARM[load]  # type: ignore[attr-defined]  # [m] centre of lateral resistance ahead of the CG

    def moment(angle: float) -> float:
        pushes = (
            port.wrench(make_motion(), thrust=1.0, angle=angle),
            starboard.wrench(make_motion(), thrust=-1.0, angle=-angle),
        )
        return float(sum(w.N - resistance * w.Y for w in pushes))

    return degrees(brentq(moment, 0.0, pi / 4))


if __name__ == "__main__":
    for name, value in figures().items():
        print(f"{name:32} {value:8.3f}")
