"""A body of the false-name campaign, and what the simulations of bodies share."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from boatsim.physics.vessel import Vessel

Array = NDArray[np.float64]
Rng = np.random.Generator
GRAVITY = 9.81  # [m/s^2]
AMBIENT = 2.2e-4  # rms of the ambient force, in weights, as in the practice set
AMBIENT_TIME = 1.0  # [s] its correlation time on a hull of 1.2 m
LEVER = 0.25  # [lengths] of the ambient moment
SUBSTEPS = 4  # Runge-Kutta steps in one row
POSE = ("x_m", "y_m", "psi_rad")


@dataclass(frozen=True)
class Body:
    """A body: its vessel file, the times of a run, and how a run is simulated.

    Attributes:
        vessel: The vessel, without anything missing.
        times: Times (N,) of the rows [s].
        noise: Standard deviation of the instruments, by their names in recording.toml.
        run: Returns the signals of one run from a random generator and factors of the
            coefficients of damping and thrust.
        coefficients: Number of those factors.
        longest_gap: Longest time [s] that may miss in a recording, as after a lost link.
    """

    vessel: Vessel
    times: Array
    noise: Mapping[str, float]
    run: Callable[[Rng, Array], dict[str, Array]]
    coefficients: int
    longest_gap: float = 0.0


def ambient(rng: Rng, times: Array, mass: float, length: float, arms: Sequence[float]) -> Array:
    """Return ambient forces (N, len(arms)): a first-order process in each axis.

    Args:
        rng: Random generator.
        times: Times (N,) [s].
        mass: Mass of the body [kg].
        length: Length of the body [m], which scales the correlation time.
        arms: Lever of each axis [m]; 1 for forces.
    """
    keep = np.exp(-(times[1] - times[0]) / (AMBIENT_TIME * np.sqrt(length / 1.2)))
    white = rng.standard_normal((len(times), len(arms))) * np.sqrt(1.0 - keep**2)
    white[0] /= np.sqrt(1.0 - keep**2)
    size = AMBIENT * mass * GRAVITY * np.array(arms)
    return np.asarray(lfilter([1.0], [1.0, -keep], white, axis=0) * size)


def integrate(rates: Callable[[Array, int], Array], start: Array, times: Array) -> Array:
    """Return the states (N, S) at given times, by Runge-Kutta steps of fourth order.

    Args:
        rates: Returns the rates of the state (S,) during row i.
        start: State (S,) at the first time.
        times: Times (N,) [s].
    """
    states = [start]
    h = (times[1] - times[0]) / SUBSTEPS
    for i in range(len(times) - 1):
        s = states[-1]
        for _ in range(SUBSTEPS):
            k1 = rates(s, i)
            k2 = rates(s + 0.5 * h * k1, i)
            k3 = rates(s + 0.5 * h * k2, i)
            k4 = rates(s + h * k3, i)
            s = s + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        states.append(s)
    return np.array(states)


def steps(rng: Rng, times: Array, seconds: float, low: float, high: float, count: int) -> Array:
    """Return commands (N, count) that are constant for some seconds."""
    at = (times / seconds).astype(int)
    return np.asarray(rng.uniform(low, high, (at[-1] + 1, count))[at])


def planar_forces(places: Mapping[str, tuple[float, float, float]], thrust: Array) -> Array:
    """Return surge force, sway force and yaw moment (N, 3) of fixed thrusters."""
    x, y, angle = np.array(list(places.values())).T
    X, Y = np.cos(angle), np.sin(angle)
    return np.asarray(thrust @ np.column_stack([X, Y, x * Y - y * X]))


def thrusters(places: Mapping[str, tuple[float, float, float]]) -> list[dict[str, object]]:
    """Return the tables of fixed thrusters."""
    found: list[dict[str, object]] = []
    for name, (x, y, angle) in places.items():
        on = {"thrust": f"{name}_N", "angle": float(angle)}
        found.append({"use": "thruster", "name": name, "on": on, "x": x, "y": y})
    return found


def boat_rates(state: Array, force: Array, inertia: Array, damping: Array) -> Array:
    """Return the rates (6,) of north, east, heading, surge, sway and yaw of a boat in a plane.

    Args:
        state: North, east [m], heading [rad], u, v [m/s] and r [rad/s].
        force: Surge force, sway force [N] and yaw moment [N m].
        inertia: Mass and moment of inertia with added mass (3,) [kg, kg m^2].
        damping: Linear damping (3,) [N s/m, N m s].
    """
    u, v, r = state[3:]
    c, k = np.cos(state[2]), np.sin(state[2])
    turning = np.array([inertia[1] * v * r, -inertia[0] * u * r, (inertia[0] - inertia[1]) * u * v])
    speeds = (force + turning - damping * state[3:]) / inertia
    return np.array([u * c - v * k, u * k + v * c, r, *speeds])


def pilot_force(
    asked: Array, state: Array, haste: Sequence[float], brake: Sequence[float]
) -> Array:
    """Return the force and moment (3,) in body axes by which a pilot goes to a pose.

    Args:
        asked: North, east [m] and heading [rad].
        state: North, east [m], heading [rad], u, v [m/s] and r [rad/s].
        haste: Force per distance (3,) [N/m, N/m, N m/rad].
        brake: Force per speed (3,) [N s/m, N s/m, N m s].
    """
    off = asked - state[:3]
    c, k = np.cos(state[2]), np.sin(state[2])
    own = np.array([off[0] * c + off[1] * k, off[1] * c - off[0] * k, off[2]])
    return np.asarray(np.array(haste) * own - np.array(brake) * state[3:])
