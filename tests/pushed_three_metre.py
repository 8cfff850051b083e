"""A 3 m boat with two thrusters, from an integrator that shares no code with the tool: current,
weak reverse, lag."""

from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

from boatsim.physics.base import Array

M, IZ = 90.0, 62.0  # [kg], [kg m^2]
ADDED = np.array([7.0, 34.0, 14.0])  # [kg], [kg], [kg m^2]
LINEAR = np.array([14.0, 60.0, 38.0])  # [N s/m], [N s/m], [N m s]
SQUARE = np.array([6.0, 80.0, 30.0])  # [N s^2/m^2], [N s^2/m^2], [N m s^2]
ARM = 0.6  # [m] of each thruster beside the centre line
LAG, ASTERN, CURRENT = (
    0.35,
    0.7,
    np.array([0.15, -0.1]),
)  # [s], share of the thrust, [m/s] north and east
HOLD, RATE = 4.0, 10.0  # [s] between commands, [Hz] of rows
FULL = 60.0  # [N] of each
SD = np.array([0.02, 0.02, 0.01])  # [m], [m], [rad] of what is read


def path(commands: Array, t: Array) -> Array:
    """(N, 3) place and heading at times t under commands (N, 2) [N]."""
    mass = np.array([M + ADDED[0], M + ADDED[1], IZ + ADDED[2]])

    def slope(now: float, y: Array) -> Array:
        psi, u, v, r, port, starboard = y[2:]
        c, s = np.cos(psi), np.sin(psi)
        north, east = u * c - v * s + CURRENT[0], u * s + v * c + CURRENT[1]
        nu = np.array([u, v, r])
        drag = LINEAR * nu + SQUARE * nu * np.abs(nu)
        push = [x if x > 0.0 else ASTERN * x for x in (port, starboard)]
        X = push[0] + push[1] - drag[0] + (M + ADDED[1]) * v * r
        Y = -drag[1] - (M + ADDED[0]) * u * r
        N = ARM * (push[0] - push[1]) - drag[2] - (ADDED[1] - ADDED[0]) * u * v
        order = commands[min(int(now * RATE), len(commands) - 1)]
        return np.array(
            [north, east, r, X / mass[0], Y / mass[1], N / mass[2], *((order - y[6:]) / LAG)]
        )

    y, rows = np.zeros(8), []
    for a, b in zip(
        t[:-1], t[1:], strict=True
    ):  # through the water from rest; commands are held over each row
        rows.append(y[:3])
        y = solve_ivp(
            lambda s, y, a=a: slope(min(s, a + 0.5 / RATE), y), (a, b), y, rtol=1e-7, atol=1e-9
        ).y[:, -1]
    return np.array([*rows, y[:3]])


def write(file: Path, seed: int, duration: float = 180.0) -> None:
    """A recording of it under random commands."""
    rng = np.random.default_rng(seed)
    t = np.arange(round(duration * RATE) + 1) / RATE
    levels = rng.uniform(-0.5, 1.0, (int(duration / HOLD) + 1, 2)) * FULL
    commands = levels[np.minimum((t / HOLD + 1e-9).astype(int), len(levels) - 1)]
    seen = path(commands, t) + rng.standard_normal((len(t), 3)) * SD
    rows = np.column_stack([t, seen, commands])
    np.savetxt(
        file,
        rows,
        "%.9g",
        ",",
        header="t_s,x_m,y_m,psi_rad,thrust_port_N,thrust_starboard_N",
        comments="",
    )


HAND_MADE = f"""about = "the 3 m boat by whoever built it: its own numbers, but for the day's current"
source = "tests/pushed_three_metre.py"
freedoms = ["surge", "sway", "yaw"]
length = 3.0
beam = 1.6
draught = 0.05
body = {{ mass = {M}, roll_inertia = 30.0, yaw_inertia = {IZ} }}
channels.thrust_port_N = {{ low = -60.0, high = 60.0 }}
channels.thrust_starboard_N = {{ low = -60.0, high = 60.0 }}
effect = [
  {{ use = "added_mass", surge = {ADDED[0]}, sway = {ADDED[1]}, yaw = {ADDED[2]} }},
  {{ use = "linear_damping", surge = {LINEAR[0]}, sway = {LINEAR[1]}, yaw = {LINEAR[2]} }},
  {{ use = "quadratic_damping", surge = {SQUARE[0]}, sway = {SQUARE[1]}, yaw = {SQUARE[2]} }},
  {{ use = "weak_reverse", astern_factor = {ASTERN} }},
  {{ use = "thrust_lag", time_constant = {LAG} }},
  {{ use = "thruster", name = "port", on = {{ thrust = "thrust_port_N" }}, x = -1.2, y = -{ARM} }},
  {{ use = "thruster", name = "starboard", on = {{ thrust = "thrust_starboard_N" }}, x = -1.2, y = {ARM} }},
]
"""
