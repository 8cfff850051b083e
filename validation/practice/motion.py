"""Newton's law of hulls with up to six dof, vectorised, with one Runge-Kutta step.

Axes are SNAME; vectors have the order (surge, sway, heave, roll, pitch, yaw), held dof are zero. M
nu' = tau - C(nu) nu with Kirchhoff's form of C (T. I. Fossen, Handbook of Marine Craft
Hydrodynamics, 2nd ed. 2021, chapters 3, 6).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

GRAVITY = 9.81  # [m/s^2]
RUNS = 3  # of a trial


class Motion(NamedTuple):
    """Arguments of a force, for B hulls."""

    t: Array  # (B,) s
    run: Whole  # (B,) number of the run in the trial
    q: Array  # (6, B) x y z [m], phi theta psi [rad]
    nu: Array  # (6, B) u v w [m/s], p q r [rad/s] over ground
    through: Array  # (6, B) velocity relative to the water
    act: Array  # (A, B) thrusts [N], angles [rad], shaft rates [rad/s]


Law = Callable[[Mapping[str, float], Motion], Array]


@dataclass(frozen=True)
class Drive:
    """From commands to actuators: a map, then a lag and a rate limit of each."""

    goals: Callable[[Array], Array]  # commands (C, B) -> goals (A, B)
    lag: Array  # (A,) s, 0: no lag
    rate: Array  # (A,) per s
    thrusts: tuple[int, ...] = ()  # which of them push
    angles: tuple[int, ...] = ()  # which of them steer
    mounts: tuple[tuple[float, float], ...] = ()  # x, y [m] of each thrust

    def follow(self, y: Array, goal: Array, dt: float) -> Array:
        """Return the actuators (A, B) after dt.

        They move at the largest rate until the lag is as slow, then with the lag.
        """
        lag, gap = np.maximum(self.lag, 1e-9)[:, None], goal - y
        left: Array | float = dt
        limited = np.isfinite(self.rate)
        if limited.any():
            rate = np.where(limited, self.rate, 1e9)[:, None]
            ramp = np.minimum(np.maximum(np.abs(gap) / rate - lag, 0.0), dt) * limited[:, None]
            gap, left = gap - np.sign(gap) * rate * ramp, dt - ramp
        return np.asarray(goal - gap * np.exp(-left / lag))


@dataclass(frozen=True)
class Boat:
    """A hull with its numbers; `law` gives hull and actuator forces from the coefficients `c`."""

    name: str
    free: tuple[int, ...]
    length: float  # [m]
    draught: float  # [m]
    mass: float  # [kg]
    hull: Array  # (6, 6) rigid body about the origin
    water: Array  # (6, 6) added mass
    c: Mapping[str, float]
    kinds: Mapping[str, str]  # kinds of the uncertain coefficients: damping, thrust, restoring
    uncertainty: Mapping[str, float]  # relative sd of each kind from the vessel's file
    law: Law
    drive: Drive
    channels: Mapping[str, tuple[float, float]]  # low, high
    coriolis: float = 1.0  # share of the water's Coriolis force
    cruise: float = 0.0  # [m/s] speed about which the model is linearised
    disturbance: float = 1.0  # ambient force over the usual one

    @property
    def tilts(self) -> bool:
        """Whether axes are fixed in the hull; otherwise they stay level and only turn in yaw."""
        return 4 in self.free

    @property
    def scale(self) -> float:
        """Froude's time scale relative to the 1.2 m boat of the first practice set."""
        return float(np.sqrt(self.length / 1.2))

    @property
    def push(self) -> float:
        """Usual rms of the ambient force [N]: 2.2e-4 of the weight."""
        return 2.2e-4 * self.mass * GRAVITY

    def ambient(self) -> Array:
        """Rms of the ambient forces (6,) [N, N m]."""
        lever = np.array([1.0, 1.0, 1.0, self.draught, 0.25 * self.length, 0.25 * self.length])
        held = np.isin(np.arange(6), self.free)
        return np.asarray(self.disturbance * self.push * lever * held)

    def inverse(self) -> Array:
        """Inverse (6, 6) of the total mass over the free axes, zero elsewhere."""
        found, rows = np.zeros((6, 6)), np.ix_(self.free, self.free)
        found[rows] = np.linalg.inv((self.hull + self.water)[rows])
        return found


def vector_product(a: Array, b: Array) -> Array:
    """Return the vector product of (3, B)."""
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


def coriolis_force_in_hull_axes(mass: Array, nu: Array) -> Array:
    """Return -C(nu) nu (6, B) of a mass matrix, in axes fixed in the hull."""
    momentum = mass @ nu
    v, spin = nu[:3], nu[3:]
    return -np.concatenate(
        [
            vector_product(spin, momentum[:3]),
            vector_product(spin, momentum[3:]) + vector_product(v, momentum[:3]),
        ]
    )


def coriolis_force_in_level_axes(mass: Array, nu: Array) -> Array:
    """Return -C(nu) nu (6, B) in level axes, which only yaw turns."""
    momentum, found = mass @ nu, np.zeros_like(nu)
    found[0], found[1] = momentum[1] * nu[5], -momentum[0] * nu[5]
    found[5] = nu[1] * momentum[0] - nu[0] * momentum[1]
    return found


def rotations_to_earth(boat: Boat, q: Array) -> Array:
    """Return the rotations (3, 3, B) from body to earth axes."""
    psi = q[5]
    cp, sp, zero = np.cos(psi), np.sin(psi), np.zeros_like(psi)
    if not boat.tilts:
        return np.array([[cp, -sp, zero], [sp, cp, zero], [zero, zero, zero + 1.0]])
    cf, sf, ct, st = np.cos(q[3]), np.sin(q[3]), np.cos(q[4]), np.sin(q[4])
    return np.array(
        [
            [cp * ct, cp * st * sf - sp * cf, sp * sf + cp * st * cf],
            [sp * ct, cp * cf + sp * st * sf, sp * st * cf - cp * sf],
            [-st, ct * sf, ct * cf],
        ]
    )


def pose_rates(boat: Boat, q: Array, nu: Array, R: Array) -> Array:
    """Return the rates of the pose (6, B)."""
    moved = R[:, 0] * nu[0] + R[:, 1] * nu[1] + R[:, 2] * nu[2]
    if not boat.tilts:
        return np.concatenate([moved, nu[3:]])
    cf, sf, ct, tt = np.cos(q[3]), np.sin(q[3]), np.cos(q[4]), np.tan(q[4])
    across = sf * nu[4] + cf * nu[5]
    return np.concatenate([moved, [nu[3] + tt * across, cf * nu[4] - sf * nu[5], across / ct]])


class Flow(NamedTuple):
    """Velocity (2, B) of the water at the hulls, north and east [m/s]."""

    north: Array
    east: Array


Extra = Callable[[Motion], Array]  # further forces (6, B)
Water = Callable[[Array, Array, Whole], Flow | None]  # of t, q, run


def motion_relative_to_water(
    boat: Boat, t: Array, run: Whole, q: Array, nu: Array, act: Array, water: Water
) -> tuple[Motion, Array, Array]:
    """Return the motion relative to the water, R, and the water's velocity (3, B) in body axes."""
    R, flow = rotations_to_earth(boat, q), water(t, q, run)
    carried = np.zeros_like(nu[:3]) if flow is None else R[0] * flow.north + R[1] * flow.east
    through = np.concatenate([nu[:3] - carried, nu[3:]])
    return Motion(t, run, q, nu, through, act), R, carried


def generalised_force(boat: Boat, m: Motion, carried: Array, extra: Extra) -> Array:
    """Return M nu' (6, B): laws, Coriolis forces, and the rotation of a uniform current."""
    coriolis = coriolis_force_in_hull_axes if boat.tilts else coriolis_force_in_level_axes
    found = boat.law(boat.c, m) + extra(m)
    if not carried.any():
        return np.asarray(found + coriolis(boat.hull + boat.coriolis * boat.water, m.nu))
    found += coriolis(boat.hull, m.nu) + boat.coriolis * coriolis(boat.water, m.through)
    spin = m.nu[3:] if boat.tilts else m.nu[3:] * np.array([[0.0], [0.0], [1.0]])
    return np.asarray(found - boat.water[:, :3] @ vector_product(spin, carried))


def runge_kutta_step(
    boat: Boat,
    t: Array,
    run: Whole,
    q: Array,
    nu: Array,
    acts: tuple[Array, Array, Array],
    dt: float,
    push: Array,
    extra: Extra,
    water: Water,
    inverse: Array,
) -> tuple[Array, Array]:
    """Take one Runge-Kutta step.

    `acts` holds the actuators at begin, middle and end of the step, `push` (6, B) a force held over
    it.
    """

    def slopes(ahead: float, q: Array, nu: Array, act: Array) -> tuple[Array, Array]:
        m, R, carried = motion_relative_to_water(boat, t + ahead, run, q, nu, act, water)
        return pose_rates(boat, q, nu, R), inverse @ (
            generalised_force(boat, m, carried, extra) + push
        )

    a, b, c = acts
    q1, n1 = slopes(0.0, q, nu, a)
    q2, n2 = slopes(dt / 2, q + dt / 2 * q1, nu + dt / 2 * n1, b)
    q3, n3 = slopes(dt / 2, q + dt / 2 * q2, nu + dt / 2 * n2, b)
    q4, n4 = slopes(dt, q + dt * q3, nu + dt * n3, c)
    return q + dt / 6 * (q1 + 2 * q2 + 2 * q3 + q4), nu + dt / 6 * (n1 + 2 * n2 + 2 * n3 + n4)
