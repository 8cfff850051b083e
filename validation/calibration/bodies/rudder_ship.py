"""A ship model with a rudder, linear about its approach speed."""

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
    steps,
)

SPEED, SHAFT = 1.0, 10.0  # [m/s], [1/s] of the approach
SLOWEST, FASTEST = 7.0, 12.0  # [1/s] shaft rates of a run
HELM = 0.5  # [rad] to either side
SWAY, YAW = -20.0, 30.0  # [N/rad], [N m/rad] of the rudder, 1.5 m behind the middle
FAN = 5.0  # [N] full thrust of the fan, a fifth of the resistance
# A lead battery of nominally 24 V; neither its voltage nor the current drawn from it changes the
# revolutions, which a controller keeps.
NOMINAL = 24.0  # [V]
FULLEST, EMPTIEST = 25.5, 23.0  # [V] at rest
SAG = 0.1  # [V s] under load, about 5 % at the highest shaft rate
VOLTMETER = 0.02  # [V] noise
LOAD = 10.0  # [A] nominal current, at the approach; it grows with the cube of the shaft rate
AMMETER = 0.1  # [A] noise


def rudder_ship() -> Body:
    """A ship model whose rudder force depends on the angle alone, as its vessel file states.

    X = -d (u - U n / n_0),  Y = Y_d d,  N = N_d d,  about the approach speed U at the shaft rate
    n_0: linear model of M. A. Abkowitz, Lectures on Ship Hydrodynamics, Hy-5, Lyngby 1964. A shaft
    dynamometer measures the thrust T = T_0 (n / n_0)^2 - t (u - U), which is part of X.
    """
    mass, inertia, length = 120.0, 60.0, 3.0
    added = np.array([6.0, 30.0, 20.0])
    damping = np.array([25.0, 80.0, 70.0])
    times = np.arange(0.0, 120.0, 0.2)
    noise = {"position_sd_m": 0.02, "heading_sd_rad": 0.01, "yaw_rate_sd_radps": 0.005}
    approach = {"damping": damping[0], "speed": SPEED, "shaft_rate": SHAFT}
    vessel = Vessel.from_effects(
        name="trial_rudder_ship",
        dof=("surge", "sway", "yaw"),
        length=length,
        beam=0.5,
        draught=0.15,
        body={"mass": mass, "roll_inertia": 5.0, "yaw_inertia": inertia},
        effects=[
            {"use": "added_mass", "surge": added[0], "sway": added[1], "yaw": added[2]},
            {"use": "linear_damping", "sway": damping[1], "yaw": damping[2]},
            {"use": "approach_balance", "on": {"shaft": "shaft_rps"}, **approach},
            {"use": "rudder", "on": {"angle": "helm_rad"}, "sway": SWAY, "yaw": YAW},
            {"use": "thruster", "name": "fan", "on": {"thrust": "fan_N"}},
        ],
        channels={
            "helm_rad": {"low": -HELM, "high": HELM},
            "shaft_rps": {"low": 0.0, "high": 15.0},
            "fan_N": {"low": 0.0, "high": FAN},
        },
        measured={"battery_V": {"neutral": NOMINAL}, "battery_A": {"neutral": LOAD}},
        diagnosis={"facts": {"indoors": True, "position_fix": "tracking"}},
    )
    M = np.array([mass, mass, inertia]) + added

    def run(rng: Rng, factors: Array) -> dict[str, Array]:
        helm = steps(rng, times, 5.0, -HELM, HELM, 1)[:, 0]
        shaft = steps(rng, times, 15.0, SLOWEST, FASTEST, 1)[:, 0]
        fan = steps(rng, times, 10.0, 0.0, FAN, 1)[:, 0]
        forces = ambient(rng, times, mass, length, (1.0, 1.0, LEVER * length))
        forces[:, 0] += factors[3] * damping[0] * factors[0] * SPEED * shaft / SHAFT
        forces[:, 0] += factors[5] * fan
        forces[:, 1] += factors[4] * SWAY * helm
        forces[:, 2] += factors[4] * YAW * helm

        def rates(s: Array, i: int) -> Array:
            return boat_rates(s, forces[i], M, factors[:3] * damping)

        start = np.array([0.0, 0.0, 0.0, SPEED, 0.0, 0.0])
        states = integrate(rates, start, times)
        states += rng.standard_normal(states.shape) * [0.02, 0.02, 0.01, 0.0, 0.0, 0.005]
        signals = dict(zip(POSE, states[:, :3].T, strict=True)) | {"r_radps": states[:, 5]}
        voltage = rng.uniform(EMPTIEST, FULLEST) - SAG * shaft
        voltage += VOLTMETER * rng.standard_normal(len(times))
        drawn = LOAD * (shaft / SHAFT) ** 3 + AMMETER * rng.standard_normal(len(times))
        signals |= {"helm_rad": helm, "shaft_rps": shaft, "fan_N": fan}
        return signals | {"battery_V": voltage, "battery_A": drawn}

    return Body(vessel, times, noise, run, 6)
