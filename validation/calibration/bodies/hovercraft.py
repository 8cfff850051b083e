"""A craft without water and damping, with six fans that push one way only."""

import numpy as np

from boatsim.physics.vessel import Vessel
from validation.calibration.bodies.body import (
    LEVER,
    POSE,
    Array,
    Body,
    Rng,
    ambient,
    integrate,
    planar_forces,
    steps,
    thrusters,
)

# places ahead and to starboard [m] and directions [rad] of fans that push one way only
FANS = {
    "a1": (0.044, 0.015, 0.5 * np.pi),
    "a2": (0.044, -0.015, -0.5 * np.pi),
    "b1": (-0.009, -0.045, -np.pi / 6),
    "b2": (-0.035, -0.03, 5 * np.pi / 6),
    "c1": (-0.035, 0.03, -5 * np.pi / 6),
    "c2": (-0.009, 0.045, np.pi / 6),
}
OPPOSITE = [1, 0, 3, 2, 5, 4]  # fan that pushes against each one


def hovercraft() -> Body:
    """A craft without water and damping, six fans that push one way, poses only."""
    mass, inertia, length = 0.14, 5e-4, 0.12
    times = np.arange(0.0, 22.5, 0.025)
    noise = {"position_sd_m": 3e-4, "heading_sd_rad": 2e-3}
    facts = {"no_water": True, "indoors": True, "moored": False, "position_fix": "tracking"}
    vessel = Vessel.from_effects(
        name="trial_hovercraft",
        dof=("surge", "sway", "yaw"),
        length=length,
        beam=0.12,
        draught=0.01,
        body={"mass": mass, "roll_inertia": 3e-4, "yaw_inertia": inertia},
        effects=thrusters(FANS),
        channels={f"{fan}_N": {"low": 0.0, "high": 0.7} for fan in FANS},
        diagnosis={"facts": facts},
    )

    def run(rng: Rng, factors: Array) -> dict[str, Array]:
        commands = steps(rng, times, 0.25, 0.0, 0.25, len(FANS))
        braking = np.roll(commands[:, OPPOSITE], 10, axis=0)  # the step before, reversed
        second = (times / 0.25).astype(int) % 2 == 1
        commands = np.where(second[:, None], braking, commands)
        forces = factors[0] * planar_forces(FANS, commands)
        forces += ambient(rng, times, mass, length, (1.0, 1.0, LEVER * length))

        def rates(s: Array, i: int) -> Array:
            X, Y, N = forces[i]
            c, k = np.cos(s[2]), np.sin(s[2])
            north, east = (X * c - Y * k) / mass, (X * k + Y * c) / mass
            return np.array([s[3], s[4], s[5], north, east, N / inertia])

        pose = integrate(rates, np.zeros(6), times)[:, :3]
        pose += rng.standard_normal(pose.shape) * [3e-4, 3e-4, 2e-3]
        signals = dict(zip(POSE, pose.T, strict=True))
        return signals | {f"{fan}_N": commands[:, i] for i, fan in enumerate(FANS)}

    return Body(vessel, times, noise, run, 1)
