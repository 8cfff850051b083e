"""The water-jet craft of Svendsen et al.

as it might really be, integrated by scipy from the printed equations.
"""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.recordings.table import Notes, Recording

A1, A2, A3 = -0.1926, -0.0035, 5.032  # Table 3 [1/s], [1/m], 1
STEERING = np.array([  # eq. 15, rows v', p', r' by v, p, r, phi, delta
    [-0.218, 2.10, 0.443, 0.0, -2.29], [0.184, -1.06, -0.433, -1.74, 2.21], [-0.0526, 1.22, -0.697, 0.0, 2.01],
])  # fmt: skip
NOISE = {  # standard deviations in the recordings
    "x_m": 0.3,
    "y_m": 0.3,
    "psi_rad": 0.002,
    "phi_rad": 0.005,
    "u_mps": 0.15,
    "r_radps": 0.005,
    "p_radps": 0.005,
}
ORDER = ("x_m", "y_m", "psi_rad", "phi_rad", "u_mps", "v_mps", "p_radps", "r_radps")  # of a state
RATE = 3.0  # [1/s] of the handle
TURN = np.radians(30.0)  # [rad/s] of the jet


@dataclass(frozen=True)
class Craft:
    """What the craft really has."""

    full_speed: float = 28.0  # [m/s] of kappa; 0: none
    least: float = 0.2
    turn_loss: float = A3
    bias: float = 0.0  # [rad] of the jet
    starboard: float = 1.0  # jet angle that is effective to starboard, per commanded one
    q2: float = 154.9
    # [s/m^2] of drag per mass and cube of the speed, as of a craft dragged down by the stern
    cube: float = 0.0
    # in its own way: it planes by and by, is uneven by and by, and loses speed as it skids
    blunt: bool = False


def power(h: float, q2: float = 154.9) -> float:
    """Shaft power per mass, eq.

    10 with Table 2 [m^2/s^3].
    """
    if h < 2.0:
        return 12.10 * h - 11.30
    return -21.1 - 20.0 * h + 18.5 * h * h if h < 4.0 else 10.00 * h + q2


def slopes(y: Array, h: float, delta: float, craft: Craft) -> Array:
    """Derivative of (x, y, psi, phi, u, v, p, r), the printed model."""
    psi, phi, u, v, p, r = y[2:]
    kappa, skid = 1.0, 1.0
    if craft.full_speed > 0.0:
        part = u / craft.full_speed
        kappa = min(
            (craft.least**6 + abs(part) ** 6) ** (1 / 6) if craft.blunt else max(part, craft.least),
            1.0,
        )
    if craft.blunt:
        skid = 0.95 + 0.05 * abs(v)
    du = kappa * (
        A1 * u + A2 * u * abs(u) + craft.turn_loss * skid * v * r + power(h, craft.q2) / max(u, 0.5)
    )
    du -= craft.cube * u**3
    jet = delta + craft.bias
    if craft.blunt:
        jet *= 1.0 + 0.5 * (craft.starboard - 1.0) * (1.0 + np.tanh(jet / 0.03))
    else:
        jet *= craft.starboard if jet > 0.0 else 1.0
    dv, dp, dr = STEERING @ [v, p, r, phi, jet]
    c, s = np.cos(psi), np.sin(psi)
    return np.array([u * c - v * s, u * s + v * c, r, p, du, dv, dp, dr])


def ramp(value: float, wanted: float, most: float) -> float:
    """One step towards what is wanted."""
    return value + min(max(wanted - value, -most), most)


def sailed(
    craft: Craft,
    throttle: Array,
    jet: Array,
    start: float,
    dt: float = 0.2,
    fine: int = 10,
    noise: float = 1.0,
    seed: int = 0,
    name: str = "run",
) -> Recording:
    """A run under commands (N,) held for dt [s] each; handle and jet move at their rates in `fine`
    steps of a row."""
    rng = np.random.default_rng(seed)
    y, rows = np.array([0.0, 0.0, 0.0, 0.0, start, 0.0, 0.0, 0.0]), []
    h, delta, part = float(throttle[0]), float(jet[0]), dt / fine
    for wanted_h, wanted_delta in zip(throttle, jet, strict=True):
        rows.append(y)
        for _ in range(fine):
            later = ramp(h, wanted_h, RATE * part), ramp(delta, wanted_delta, TURN * part)
            middle = 0.5 * (h + later[0]), 0.5 * (delta + later[1])
            y = rk4(y, part, *middle, craft)
            h, delta = later
    columns = dict(zip(ORDER, np.array(rows).T, strict=True))
    signals = {
        n: columns[n] + noise * sd * rng.standard_normal(len(rows)) for n, sd in NOISE.items()
    }
    signals |= {
        "throttle": np.asarray(throttle),
        "jet_rad": np.asarray(jet),
        "elevator_rad": np.zeros(len(rows)),
    }
    return Recording(name, dt * np.arange(len(rows)), signals, Notes(vessel="jet_ski"))


def rk4(y: Array, dt: float, h: float, delta: float, craft: Craft) -> Array:
    """One step of the classical method."""
    a = slopes(y, h, delta, craft)
    b = slopes(y + 0.5 * dt * a, h, delta, craft)
    c = slopes(y + 0.5 * dt * b, h, delta, craft)
    d = slopes(y + dt * c, h, delta, craft)
    return np.asarray(y + dt / 6.0 * (a + 2.0 * b + 2.0 * c + d))


def solved(craft: Craft, h: float, delta: float, start: Array, times: Array) -> Array:
    """States (N, 8) under held actuators by an eighth-order method."""
    done = solve_ivp(
        lambda _, y: slopes(y, h, delta, craft),
        (0.0, times[-1]),
        start,
        "DOP853",
        times,
        rtol=1e-11,
        atol=1e-11,
    )
    return np.asarray(done.y.T)


def nominal_without(folder: Path, *effects: str) -> Path:
    """The vessel file of the craft with some of its effects left out, in a folder of its own."""
    own = vessel.load_vessel("jet_ski").file
    head, *blocks = re.split(
        r"(?=^\[\[effect\]\]$|^\[diagnosis\]$)", own.read_text(encoding="utf-8"), flags=re.M
    )
    kept = [block for block in blocks if not any(f'use = "{name}"' in block for name in effects)]
    place = folder / "craft"
    place.mkdir(exist_ok=True)
    (place / "hull.xml").write_text((own.parent / "hull.xml").read_text(encoding="utf-8"))
    (place / "vessel.toml").write_text(head + "".join(kept))
    return place
