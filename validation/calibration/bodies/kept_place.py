"""A boat that keeps its place in an ambient force that is larger than its vessel file states."""

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
    pilot_force,
    planar_forces,
    thrusters,
)

CORNERS = {
    "port_bow": (1.0, -0.4, 0.5),
    "starboard_bow": (1.0, 0.4, -0.5),
    "port_stern": (-1.0, -0.4, -0.5),
    "starboard_stern": (-1.0, 0.4, 0.5),
}
STRONGEST = 10.0  # largest ambient force over the stated one
REACH = (2.0, 2.0, 1.0)  # [m, m, rad] about the place, of the poses that the pilot asks for
STAY = 20.0  # [s] that he asks for each
FULL = 12.0  # [N] of one thruster
HASTE = (3.0, 3.0, 8.0)  # [N/m, N/m, N m/rad] of the pilot's force
BRAKE = (18.0, 18.0, 25.0)  # [N s/m, N s/m, N m s] of it


def kept_place() -> Body:
    """A boat that stays within four lengths, in up to ten times the stated ambient force."""
    mass, inertia, length = 120.0, 60.0, 2.5
    added = np.array([10.0, 80.0, 30.0])
    damping = np.array([25.0, 80.0, 40.0])
    times = np.arange(0.0, 100.0, 0.2)
    noise = {"position_sd_m": 0.02, "heading_sd_rad": 0.01}
    vessel = Vessel.from_effects(
        name="trial_kept_place",
        dof=("surge", "sway", "yaw"),
        length=length,
        beam=1.2,
        draught=0.2,
        body={"mass": mass, "roll_inertia": 15.0, "yaw_inertia": inertia},
        effects=[
            {"use": "added_mass", "surge": added[0], "sway": added[1], "yaw": added[2]},
            {"use": "linear_damping", **dict(zip(("surge", "sway", "yaw"), damping, strict=True))},
            *thrusters(CORNERS),
        ],
        channels={f"{name}_N": {"low": -FULL, "high": FULL} for name in CORNERS},
        diagnosis={"facts": {"position_fix": "gnss"}},
    )
    M = np.array([mass, mass, inertia]) + added
    shares = np.linalg.pinv(planar_forces(CORNERS, np.eye(len(CORNERS))).T)

    def run(rng: Rng, factors: Array) -> dict[str, Array]:
        strength = np.exp(rng.uniform(0.0, np.log(STRONGEST)))
        forces = strength * ambient(rng, times, mass, length, (1.0, 1.0, LEVER * length))
        asked = rng.uniform(-1.0, 1.0, (int(times[-1] / STAY) + 1, 3)) * REACH
        states, commands = [np.zeros(6)], []
        for i in range(len(times)):
            state = states[-1]
            order = shares @ pilot_force(asked[int(times[i] / STAY)], state, HASTE, BRAKE)
            commands.append(np.clip(order, -FULL, FULL))
            if i == len(times) - 1:
                break
            thrust = factors[3] * planar_forces(CORNERS, commands[-1])
            total = forces[i] + thrust

            def rates(s: Array, _: int, total: Array = total) -> Array:
                return boat_rates(s, total, M, factors[:3] * damping)

            states.append(integrate(rates, state, times[i : i + 2])[-1])
        pose = np.array(states)[:, :3]
        pose += rng.standard_normal(pose.shape) * [0.02, 0.02, 0.01]
        signals = dict(zip(POSE, pose.T, strict=True))
        columns = np.array(commands).T
        return signals | {f"{n}_N": own for n, own in zip(CORNERS, columns, strict=True)}

    return Body(vessel, times, noise, run, 4, longest_gap=8.0)
