"""A boat with four thrusters and recorded velocities."""

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

# of four thrusters that push both ways
CORNERS = {
    "port_bow": (0.5, -0.2, 0.5),
    "starboard_bow": (0.5, 0.2, -0.5),
    "port_stern": (-0.5, -0.2, -0.5),
    "starboard_stern": (-0.5, 0.2, 0.5),
}


def four_thrusters() -> Body:
    """A boat with four thrusters, and with recorded velocities."""
    mass, inertia, length = 20.0, 4.0, 1.4
    added = np.array([1.5, 15.0, 2.0])
    damping = np.array([12.0, 40.0, 6.0])
    times = np.arange(0.0, 120.0, 0.2)
    noise = {"position_sd_m": 0.02, "heading_sd_rad": 0.01}
    noise |= {"speed_sd_mps": 0.01, "yaw_rate_sd_radps": 0.005}
    vessel = Vessel.from_effects(
        name="trial_four_thrusters",
        dof=("surge", "sway", "yaw"),
        length=length,
        beam=0.6,
        draught=0.1,
        body={"mass": mass, "roll_inertia": 0.7, "yaw_inertia": inertia},
        effects=[
            {"use": "added_mass", "surge": added[0], "sway": added[1], "yaw": added[2]},
            {"use": "linear_damping", **dict(zip(("surge", "sway", "yaw"), damping, strict=True))},
            *thrusters(CORNERS),
        ],
        channels={f"{name}_N": {"low": -4.0, "high": 4.0} for name in CORNERS},
        diagnosis={"facts": {"position_fix": "gnss"}},
    )
    M = np.array([mass, mass, inertia]) + added

    def run(rng: Rng, factors: Array) -> dict[str, Array]:
        commands = steps(rng, times, 6.0, -2.0, 4.0, len(CORNERS))
        forces = factors[3] * planar_forces(CORNERS, commands)
        forces += ambient(rng, times, mass, length, (1.0, 1.0, LEVER * length))

        def rates(s: Array, i: int) -> Array:
            return boat_rates(s, forces[i], M, factors[:3] * damping)

        states = integrate(rates, np.zeros(6), times)
        states += rng.standard_normal(states.shape) * [0.02, 0.02, 0.01, 0.01, 0.01, 0.005]
        names = (*POSE, "u_mps", "v_mps", "r_radps")
        signals = dict(zip(names, states.T, strict=True))
        return signals | {f"{name}_N": commands[:, i] for i, name in enumerate(CORNERS)}

    return Body(vessel, times, noise, run, 4)
