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
        return signals | {f"{name}_N": commands[:, i] for i, name in enumerate(SIDES)}

    return Body(vessel, times, noise, run, 4)
