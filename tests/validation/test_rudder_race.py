"""A launch whose rudder stands in the propeller's race, from an integrator that shares no code with
the tool."""

from pathlib import Path

import numpy as np
import pytest
from boats import HULL
from scipy.integrate import solve_ivp

from boatsim.diagnosis.pipeline import diagnose
from boatsim.physics.base import Array

M, IZ, ADDED = 900.0, 2300.0, np.array([60.0, 700.0, 1500.0])  # [kg], [kg m^2], [kg, kg, kg m^2]
LINEAR, SQUARE = np.array([40.0, 500.0, 1500.0]), np.array([35.0, 700.0, 900.0])
AT, SLOPE, RACE = (
    -2.2,
    60.0,
    0.9,
)  # [m] of the blade, [N s^2/m^2 per rad] in open water, normal force per thrust
HOLD, RATE, SD = 6.0, 5.0, np.array([0.02, 0.02, 0.01])

VESSEL = f"""about = "a launch by whoever thought of the blade as one in open water"
source = "tests/validation/test_rudder_race.py"
freedoms = ["surge", "sway", "yaw"]
length = 5.0
beam = 1.8
draught = 0.4
body = {{ mass = {M}, roll_inertia = 200.0, yaw_inertia = {IZ} }}
channels.thrust_N = {{ low = -400.0, high = 800.0 }}
channels.rudder_rad = {{ low = -0.7, high = 0.7 }}
effect = [
  {{ use = "added_mass", surge = {ADDED[0]}, sway = {ADDED[1]}, yaw = {ADDED[2]} }},
  {{ use = "linear_damping", surge = {LINEAR[0]}, sway = {LINEAR[1]}, yaw = {LINEAR[2]} }},
  {{ use = "quadratic_damping", surge = {SQUARE[0]}, sway = {SQUARE[1]}, yaw = {SQUARE[2]} }},
  {{ use = "thruster", on = {{ thrust = "thrust_N" }}, x = -2.0 }},
  {{ use = "rudder", on = {{ angle = "rudder_rad" }}, sway = {-SLOPE * 4.0}, yaw = {-SLOPE * 4.0 * AT} }},
  {{ use = "speed_scaled_steering", on = {{ angle = "rudder_rad" }}, speed = 2.0, rudder_sway = 1, rudder_yaw = 1 }},
]
"""


def sailed(commands: Array, t: Array) -> Array:
    """(N, 3) place and heading under commands (N, 2) [N, rad], held from row to row."""

    def slope(y: Array, thrust: float, helm: float) -> Array:
        psi, nu = y[2], y[3:]
        u, v, r = nu
        normal = SLOPE * u * abs(u) * helm, RACE * max(thrust, 0.0) * np.sin(helm)
        side = -normal[0] - normal[1] * np.cos(helm)
        drag = LINEAR * nu + SQUARE * nu * np.abs(nu)
        X = thrust - normal[1] * np.sin(helm) - drag[0] + (M + ADDED[1]) * v * r
        Y = side - drag[1] - (M + ADDED[0]) * u * r
        N = AT * side - drag[2] - (ADDED[1] - ADDED[0]) * u * v
        turned = u * np.cos(psi) - v * np.sin(psi), u * np.sin(psi) + v * np.cos(psi), r
        return np.array([*turned, X / (M + ADDED[0]), Y / (M + ADDED[1]), N / (IZ + ADDED[2])])

    y, rows = np.zeros(6), [np.zeros(3)]
    for a, b, (thrust, helm) in zip(t[:-1], t[1:], commands, strict=False):
        y = solve_ivp(
            lambda _, y, f=thrust, h=helm: slope(y, f, h), (a, b), y, rtol=1e-8, atol=1e-9
        ).y[:, -1]
        rows.append(y[:3])
    return np.array(rows)


@pytest.mark.slow
def test_the_race_is_named_with_its_strength_on_a_boat_whose_rudder_was_thought_to_steer_by_speed_alone(
    tmp_path: Path,
) -> None:
    (tmp_path / "vessel.toml").write_text(VESSEL)
    (tmp_path / "hull.xml").write_text(HULL.format(name="launch"))
    rng = np.random.default_rng(4)
    t = np.arange(round(240.0 * RATE) + 1) / RATE
    levels = rng.uniform([-0.3, -0.6], [1.0, 0.6], (int(t[-1] / HOLD) + 1, 2)) * [600.0, 1.0]
    commands = levels[(t / HOLD + 1e-9).astype(int)]
    rows = np.column_stack(
        [t, sailed(commands, t) + rng.standard_normal((len(t), 3)) * SD, commands]
    )
    header = "t_s,x_m,y_m,psi_rad,thrust_N,rudder_rad"
    np.savetxt(tmp_path / "run.csv", rows, "%.9g", ",", header=header, comments="")
    found = diagnose([tmp_path / "run.csv"], vessel=str(tmp_path / "vessel.toml")).findings.answer
    assert [e["name"] for e in found["effects"]] == ["rudder_race"] and found["verdict"] == "named"
    value = found["effects"][0]["parameters"]["normal_force_per_thrust"]
    assert value["value"] == pytest.approx(RACE, abs=3.0 * value["sd"]) and value["sd"] < 0.1
