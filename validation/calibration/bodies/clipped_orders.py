"""A boat whose program asks its drives for no thrust astern, and logs what it asked for."""

import numpy as np

from boatsim.physics.vessel import Vessel
from validation.calibration.bodies.body import (
    LEVER,
    POSE,
    Array,
    Body,
    Rng,
    ambient,
    boat_rates,
    integrate,
    planar_forces,
    steps,
    thrusters,
)

SIDES = {"port": (-0.6, -0.35, 0.0), "starboard": (-0.6, 0.35, 0.0)}
FULL = 6.0  # [N] of one thruster
GAIN = 0.001  # [N s^2] thrust over the squared shaft rate
# Instruments of a station measure a wind above the sheltered water and a current outside; neither
# reaches the boat. The log has both, and the wind also as the boat would feel it.
BREEZE, GUSTS = (1.0, 6.0), 1.0  # [m/s] mean of a run, standard deviation
VEER = 0.2  # [rad] standard deviation of the direction
STREAM = 0.1  # [m/s] standard deviation of the current, to north and to east
CHANGE = 30.0  # [s] correlation time of gusts and stream
INSTRUMENTS = (
    "wind_mps",
    "wind_from_rad",
    "apparent_wind_mps",
    "apparent_wind_from_rad",
    "current_north_mps",
    "current_east_mps",
)


def clipped_orders() -> Body:
    """A boat with two propellers that never push astern, next to the force and moment asked for."""
    mass, inertia, length = 20.0, 4.0, 1.4
    added = np.array([1.5, 15.0, 2.0])
    damping = np.array([8.0, 40.0, 6.0])
    times = np.arange(0.0, 120.0, 0.2)
    noise = {"position_sd_m": 0.02, "heading_sd_rad": 0.01, "yaw_rate_sd_radps": 0.005}
    vessel = Vessel.from_effects(
        name="trial_clipped_orders",
        dof=("surge", "sway", "yaw"),
        length=length,
        beam=0.8,
        draught=0.1,
        body={"mass": mass, "roll_inertia": 0.7, "yaw_inertia": inertia},
        effects=[
            {"use": "added_mass", "surge": added[0], "sway": added[1], "yaw": added[2]},
            {"use": "linear_damping", **dict(zip(("surge", "sway", "yaw"), damping, strict=True))},
            *thrusters(SIDES),
        ],
        channels={f"{name}_N": {"low": -FULL, "high": FULL} for name in SIDES},
        measured={name: {} for name in INSTRUMENTS},
        diagnosis={"facts": {"position_fix": "gnss"}},
    )
    M = np.array([mass, mass, inertia]) + added

    def run(rng: Rng, factors: Array) -> dict[str, Array]:
        force = steps(rng, times, 6.0, -5.0, 10.0, 1)[:, 0]
        moment = steps(rng, times, 6.0, -1.5, 1.5, 1)[:, 0]
        half = SIDES["starboard"][1]
        asked = 0.5 * np.column_stack([force + moment / half, force - moment / half])
        commands = np.clip(asked, 0.0, FULL)
        forces = factors[3] * planar_forces(SIDES, commands)
        forces += ambient(rng, times, mass, length, (1.0, 1.0, LEVER * length))

        def rates(s: Array, i: int) -> Array:
            return boat_rates(s, forces[i], M, factors[:3] * damping)

        states = integrate(rates, np.zeros(6), times)
        states += rng.standard_normal(states.shape) * [0.02, 0.02, 0.01, 0.0, 0.0, 0.005]
        signals = dict(zip(POSE, states[:, :3].T, strict=True)) | {"r_radps": states[:, 5]}
        signals |= {"force_x_N": force, "force_n_Nm": moment}
        signals |= instruments_elsewhere(rng, times, states)
        return signals | {f"{name}_N": commands[:, i] for i, name in enumerate(SIDES)}

    return Body(vessel, times, noise, run, 4)


def instruments_elsewhere(rng: Rng, times: Array, states: Array) -> dict[str, Array]:
    """Return a wind and a current that do not reach the boat, as a station measures them.

    Args:
        rng: Random generator.
        times: Times (N,) [s].
        states: North, east [m], heading [rad], u, v [m/s] and r [rad/s] (N, 6), with noise.
    """
    slow = slow_changes(rng, times, 4)
    speed = np.abs(rng.uniform(*BREEZE) + GUSTS * slow[:, 0])
    comes_from = rng.uniform(-np.pi, np.pi) + VEER * slow[:, 1]
    north, east = STREAM * slow[:, 2], STREAM * slow[:, 3]
    from_bow = comes_from - states[:, 2]
    ahead = speed * np.cos(from_bow) + states[:, 3]
    aside = speed * np.sin(from_bow) + states[:, 4]
    values = (speed, comes_from, np.hypot(ahead, aside), np.arctan2(aside, ahead), north, east)
    return dict(zip(INSTRUMENTS, values, strict=True))


def slow_changes(rng: Rng, times: Array, count: int) -> Array:
    """Return first-order processes (N, count) of standard deviation 1 and `CHANGE` [s]."""
    keep = np.exp(-(times[1] - times[0]) / CHANGE)
    white = rng.standard_normal((len(times), count))
    white[1:] *= np.sqrt(1.0 - keep**2)
    for row in range(1, len(times)):
        white[row] += keep * white[row - 1]
    return white
