"""Vessels of the set from their files, with laws written from the documented formulas.

Sources of the laws: linear and quadratic damping, added mass, hydrostatics, propellers: T. I.
Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021; cross-flow drag: O. M. Faltinsen, Sea
Loads, 1990; the ship: C. R. Martin, Rudder Roll Reduction for Small Ships, UBC 1993, after S.
Inoue, M. Hirano, K. Kijima 1981.
"""

import tomllib
from collections.abc import Callable, Mapping
from math import atanh, pi, sqrt
from pathlib import Path
from typing import Any

import numpy as np

from validation.practice.motion import GRAVITY, Array, Boat, Drive, Motion

MODELS = Path(__file__).parents[2] / "models"
AXES = ("surge", "sway", "heave", "roll", "pitch", "yaw")
SEA = 1025.0  # [kg/m^3]
FRESH = 1000.0  # [kg/m^3]
AT_ONCE = np.inf


class VesselFile:
    """A vessel's file."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.table: dict[str, Any] = tomllib.loads(
            (MODELS / name / "vessel.toml").read_text(encoding="utf-8")
        )

    def effect(self, name: str) -> dict[str, Any]:
        """Return the table of an effect."""
        return next(e for e in self.table["effect"] if e.get("name", e["use"]) == name)

    def boat(
        self, mass: tuple[Array, Array], law: Any, drive: Drive, c: Mapping[str, float], **more: Any
    ) -> Boat:
        """Return a boat with the values that every file specifies."""
        t = self.table
        free = tuple(i for i, a in enumerate(AXES) if a in t["freedoms"])
        kinds = {k: kind for kind in ("damping", "thrust", "restoring") for k in more.pop(kind, ())}
        return Boat(
            self.name,
            free,
            t["length"],
            t["draught"],
            t["body"]["mass"],
            *mass,
            c,
            kinds,
            t.get("diagnosis", {}).get("coefficient_uncertainty", {}),
            law,
            drive,
            {n: (v["low"], v["high"]) for n, v in t.get("channels", {}).items()},
            **more,
        )


def rigid_body_mass(body: Mapping[str, Any]) -> Array:
    """Return the mass matrix (6, 6) of a body with `centre` ahead of and below the origin."""
    x, z = body.get("centre", (0.0, 0.0))
    lever = np.array([[0.0, -z, 0.0], [z, 0.0, -x], [0.0, x, 0.0]])
    m = body["mass"]
    own = np.diag(
        [body["roll_inertia"], body.get("pitch_inertia", body["yaw_inertia"]), body["yaw_inertia"]]
    )
    return np.block([[m * np.eye(3), -m * lever], [m * lever, own - m * lever @ lever]])


def added_mass_matrix(table: Mapping[str, float]) -> Array:
    """Return the matrix (6, 6) of an added_mass table, with sway acting `sway_at` ahead."""
    found = np.diag([table.get(a, 0.0) for a in AXES])
    sway, at = table.get("sway", 0.0), table.get("sway_at", 0.0)
    found[1, 5] = found[5, 1] = sway * at
    found[5, 5] += sway * at * at
    return found


def stack_forces(size: int, **parts: Any) -> Array:
    """Stack X Y Z K M N as (6, B)."""
    found = np.zeros((6, size))
    for name, value in parts.items():
        found["XYZKMN".index(name)] = value
    return found


def cross_flow_integrals(v: Array, r: Array, stern: float, bow: float) -> tuple[Array, Array]:
    """Integrate w|w| and x w|w| with w = v + x r from stern to bow, in closed form."""
    slow = np.abs(r) < 1e-3
    turn = np.where(slow, 1.0, r)
    low, high = v + stern * r, v + bow * r
    low2, high2 = low * np.abs(low), high * np.abs(high)
    third = (high2 * high - low2 * low) / (3.0 * turn)
    moment = ((high2 * high * high - low2 * low * low) / 4.0 / turn - v * third) / turn
    if slow.any():
        near, length = np.abs(v), bow - stern
        first, second = 0.5 * (bow + stern) * length, (bow**3 - stern**3) / 3.0
        third = np.where(slow, near * (v * length + 2.0 * r * first), third)
        moment = np.where(slow, near * (v * first + 2.0 * r * second), moment)
    return third, moment


def thrust_force(size: int, thrust: Array, angle: Array, x: float, y: float) -> Array:
    """Return the force (6, B) of a thrust at a mount."""
    X, Y = thrust * np.cos(angle), thrust * np.sin(angle)
    return stack_forces(size, X=X, Y=Y, N=x * Y - y * X)


# ---- one function for each vessel


def catamaran() -> Boat:
    """Return Huang and Ji's azimuth boat: linear damping, one steered thruster ahead."""
    file = VesselFile("catamaran")
    x = file.effect("thruster")["x"]
    c = {k: file.effect("linear_damping")[k] for k in ("surge", "sway", "yaw")} | {"gain": 1.0}

    def law(c: Mapping[str, float], m: Motion) -> Array:
        u, v, _, _, _, r = m.through
        drag = stack_forces(u.size, X=-c["surge"] * u, Y=-c["sway"] * v, N=-c["yaw"] * r)
        return drag + thrust_force(u.size, c["gain"] * m.act[0], m.act[1], x, 0.0)

    drive = Drive(lambda u: u, np.zeros(2), np.full(2, AT_ONCE), (0,), (1,), ((x, 0.0),))
    mass = rigid_body_mass(file.table["body"]), added_mass_matrix(file.effect("added_mass"))
    return file.boat(mass, law, drive, c, damping=("surge", "sway", "yaw"), thrust=("gain",))


def joystick_boat() -> Boat:
    """Return the thesis' boat.

    It has cross-flow drag and two steered outboards with lags and servos, driven by motor duty.
    """
    file = VesselFile("joystick_boat")
    flow, drag, pwm, servo = (
        file.effect(n) for n in ("cross_flow_drag", "surge_drag", "pwm_thrust", "servo")
    )
    length, draught = file.table["length"], file.table["draught"]
    a = flow["centre"]
    mounts = tuple((file.effect(n)["x"], file.effect(n)["y"]) for n in ("port", "starboard"))
    c = {
        "section": flow["section_drag_coefficient"],
        "linear": drag["linear"],
        "quadratic": drag["quadratic"],
    }
    c |= {"even": flow["linear"], "gain": 1.0}

    def law(c: Mapping[str, float], m: Motion) -> Array:
        u, v, _, _, _, r = m.through
        Y, N = cross_flow_integrals(v, r, a - length / 2, a + length / 2)
        k = 0.5 * FRESH * c["section"] * draught
        found = stack_forces(
            u.size,
            X=-(c["linear"] + c["quadratic"] * np.abs(u)) * u,
            Y=-k * Y - c["even"] * length * (v + a * r),
            N=-k * N - c["even"] * length * (a * v + (a * a + length * length / 12) * r),
        )
        for i, (x, y) in enumerate(mounts):
            found += thrust_force(u.size, c["gain"] * m.act[i], m.act[2 + i], x, y)
        return found

    def goals(u: Array) -> Array:
        thrust = u[:2] + pwm["at_span"] * u[4:] / pwm["span"]
        return np.concatenate([thrust, np.clip(u[2:4], -servo["range"], servo["range"])])

    lag = file.effect("thrust_lag")["time_constant"]
    drive = Drive(
        goals,
        np.array([lag, lag, servo["lag"], servo["lag"]]),
        np.array([AT_ONCE, AT_ONCE, *[servo["rate"]] * 2]),
        (0, 1),
        (2, 3),
        mounts,
    )
    mass = rigid_body_mass(file.table["body"]), added_mass_matrix(file.effect("added_mass"))
    return file.boat(
        mass, law, drive, c, damping=("section", "linear", "quadratic"), thrust=("gain",)
    )


def otter() -> Boat:
    """Return Fossen's Otter: six dof, two propellers, cross-flow drag, hydrostatics."""
    file = VesselFile("otter")
    float_, flow = file.effect("hydrostatics"), file.effect("cross_flow_drag")
    at, half, mounts = float_["flotation"], file.table["length"] / 2, (-0.395, 0.395)
    ahead, astern = file.effect("port")["ahead"], file.effect("port")["astern"]
    linear = file.effect("linear_damping")
    c = {a: linear[a] for a in AXES} | {"turning": file.effect("quadratic_damping")["yaw"]}
    c |= {"section": flow["section_drag_coefficient"], "gain": 1.0}
    c |= {"buoyancy": float_["heave"], "righting": float_["roll"], "trimming": float_["pitch"]}
    depth = flow["density"] * file.table["draught"] / 2

    def law(c: Mapping[str, float], m: Motion) -> Array:
        z, phi, theta, nu = m.q[2], m.q[3], m.q[4], m.through
        found = -np.array([c[a] for a in AXES])[:, None] * nu
        found[5] -= c["turning"] * np.abs(nu[5]) * nu[5]
        both, turning = cross_flow_integrals(
            nu[1:3].ravel(), np.concatenate([nu[5], -nu[4]]), -half, half
        )
        (Y, Z), (N, M) = both.reshape(2, -1), turning.reshape(2, -1)
        k, sunk = c["section"] * depth, z - at * theta
        found -= k * stack_forces(z.size, Y=Y, Z=Z, M=-M, N=N)
        righting = stack_forces(z.size, Z=-c["buoyancy"] * sunk, K=-c["righting"] * phi)
        righting[4] = at * c["buoyancy"] * sunk - c["trimming"] * theta
        n = m.act
        thrust = c["gain"] * np.where(n > 0.0, ahead, astern) * n * np.abs(n)
        turn = -mounts[0] * thrust[0] - mounts[1] * thrust[1]
        return found + righting + stack_forces(z.size, X=thrust[0] + thrust[1], N=turn)

    lag = file.effect("shaft_lag")["time_constant"]
    drive = Drive(lambda u: u, np.full(2, lag), np.full(2, AT_ONCE), (0, 1))
    return file.boat(
        (rigid_body_mass(file.table["body"]), added_mass_matrix(file.effect("added_mass"))),
        law,
        drive,
        c,
        damping=(*AXES, "turning", "section"),
        thrust=("gain",),
        restoring=("buoyancy", "righting", "trimming"),
    )


def martin_tank_model() -> Boat:
    """Return the tank model that rolls."""
    file = VesselFile("martin_tank_model")
    c = {
        "roll": file.effect("linear_damping")["roll"],
        "righting": file.effect("righting_arm")["stiffness"],
    }

    def law(c: Mapping[str, float], m: Motion) -> Array:
        return stack_forces(m.t.size, K=-c["roll"] * m.through[3] - c["righting"] * m.q[3])

    drive = Drive(lambda u: u, np.zeros(0), np.zeros(0))
    mass = rigid_body_mass(file.table["body"]), added_mass_matrix(file.effect("added_mass"))
    return file.boat(mass, law, drive, c, damping=("roll",), restoring=("righting",))


def eastward_ho() -> Boat:
    """Return Martin's fishing vessel: linear in sway, yaw and roll, speed held, one rudder."""
    file = VesselFile("eastward_ho")
    t, hull, rudder = file.table, file.effect("linear_hull"), file.effect("rudder")
    L, T, m, hold = t["length"], t["draught"], t["body"]["mass"], file.effect("speed_hold")
    U = hold["speed"]
    water = spheroid_added_mass(t)
    below = hull["above_keel"] - T / 2
    arm = below * water[1, 1] / (m + water[1, 1])
    c = hull_derivatives(t, hull, U, water[0, 0])
    c["righting"] = m * GRAVITY * file.effect("righting_arm")["metacentric_height"]
    f = U / sqrt(GRAVITY * L) / hull["block"]
    height = file.effect("righting_arm")["metacentric_height"]
    ratio = file.effect("roll_damping")["at_rest"]
    ratio += 0.00085 * L / t["beam"] * sqrt(L / height) * f * (1 + f + 2 * f * f)
    c["roll"] = 2 * ratio * sqrt(c["righting"] * (t["body"]["roll_inertia"] + water[3, 3]))
    blade = (
        0.5
        * SEA
        * 6.13
        * rudder["aspect"]
        / (rudder["aspect"] + 2.25)
        * rudder["area"]
        * rudder["inflow"] ** 2
    )
    c["steer"] = -(1 + 0.627 * hull["block"] - 0.153) * blade

    def law(c: Mapping[str, float], motion: Motion) -> Array:
        u, v, _, p, _, r = motion.through
        phi, delta = motion.q[3], motion.act[0]
        Y = -c["sway"] * v - c["sway_by_yaw"] * r
        steer = c["steer"] * delta
        K = (
            -below * Y
            + arm * (Y - m * u * r)
            - c["righting"] * phi
            - c["roll"] * p
            + (arm - rudder["below"]) * steer
        )
        N = -c["yaw_by_sway"] * v - c["yaw"] * r + c["heeled"] * phi + rudder["at"] * steer
        return stack_forces(u.size, X=-m * v * r - hold["gain"] * (u - U), Y=Y + steer, K=K, N=N)

    drive = Drive(lambda u: u, np.zeros(1), np.full(1, AT_ONCE), (), (0,))
    return file.boat(
        (rigid_body_mass(t["body"]), water),
        law,
        drive,
        c,
        coriolis=0.0,
        cruise=U,
        damping=("sway", "sway_by_yaw", "yaw_by_sway", "yaw", "roll", "heeled"),
        thrust=("steer",),
        restoring=("righting",),
    )


def spheroid_added_mass(t: Mapping[str, Any]) -> Array:
    """Return the added mass (6, 6) of a prolate spheroid of this length and draught.

    Source: H. Lamb, Hydrodynamics, 1932; in roll the coefficient is 0.2.
    """
    flat = (2 * t["draught"] / t["length"]) ** 2
    e = sqrt(1 - flat)
    a = 2 * flat / e**3 * (atanh(e) - e)
    b = 1 / e**2 - flat / e**3 * atanh(e)
    turn = e**4 * (b - a) / ((2 - e * e) * (2 * e * e - (2 - e * e) * (b - a)))
    m, body = t["body"]["mass"], t["body"]
    return np.diag(
        [
            m * a / (2 - a),
            m * b / (2 - b),
            0,
            0.2 * body["roll_inertia"],
            0,
            turn * body["yaw_inertia"],
        ]
    )


def hull_derivatives(
    t: Mapping[str, Any], hull: Mapping[str, float], U: float, m_x: float
) -> dict[str, float]:
    """Return linear derivatives about the mass centre.

    The speed U is in m/s; `m_x` is the added mass of surge [kg].
    """
    L, T = t["length"], t["draught"]
    k, tau = 2 * T / L, hull["trim"] / T
    lift = 0.5 * pi * k + 1.4 * hull["block"] * t["beam"] / L
    Yv, Yr = -lift * (1 + 2 / 3 * tau), 0.25 * pi * k * (1 + 0.8 * tau)
    Nv, Nr = -k * (1 - 0.27 * tau * lift / k), -(0.54 * k - k * k) * (1 + 0.3 * tau)
    q, x = 0.5 * SEA * L * T * U, -hull["ahead"]
    return {
        "sway": -q * Yv,
        "sway_by_yaw": -q * L * Yr + m_x * U,
        "yaw_by_sway": -q * (L * Nv + Yv * x),
        "yaw": -q * L * (L * Nr + Yr * x),
        "heeled": q * L * U * -0.0076,
    }


BOATS: dict[str, Callable[[], Boat]] = {
    f.__name__: f for f in (catamaran, eastward_ho, joystick_boat, martin_tank_model, otter)
}
