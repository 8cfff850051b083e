"""A guided section that heaves, rolls and sways beside a measured wave."""

import numpy as np

from boatsim.physics.vessel import Vessel
from validation.calibration.bodies.body import Array, Body, Rng, ambient, integrate


def guided_section() -> Body:
    """A guided section that heaves, rolls and sways freely beside a small measured wave."""
    mass, inertia, length = 46.8, 0.97, 0.6
    added = np.array([37.0, 33.0, 0.19])  # sway, heave, roll
    damping = np.array([24.0, 4.3, 0.035])  # so small that it still moves at the end
    stiffness = np.array([0.0, 2299.0, 28.9])
    times = np.arange(0.0, 40.0, 0.1)
    noise = {"position_sd_m": 5e-4, "heave_sd_m": 5e-4, "roll_sd_rad": 2e-3}
    axes = ("sway", "heave", "roll")
    facts = {"guided": True, "indoors": True, "forward_speed_mps": 0.0}
    vessel = Vessel.from_effects(
        name="trial_section",
        dof=axes,
        length=length,
        beam=0.4,
        draught=0.2,
        body={"mass": mass, "roll_inertia": inertia, "yaw_inertia": 1.35},
        effects=[
            {"use": "added_mass", "surge": 0.0, "yaw": 0.0, **dict(zip(axes, added, strict=True))},
            {"use": "hydrostatics", "heave": 2299.0, "roll": 28.9, "vertical": 1.0},
            {"use": "linear_damping", **dict(zip(axes, damping, strict=True))},
        ],
        channels={},
        measured={"wave_in_m": {"about": "elevation at its place"}},
        diagnosis={"facts": facts, "rate": 10.0, "reasons": {"rate": "short waves"}},
    )
    M = np.array([mass, mass, inertia]) + added

    def run(rng: Rng, factors: Array) -> dict[str, Array]:
        forces = ambient(rng, times, mass, length, (1.0, 1.0, 0.2))

        def rates(s: Array, i: int) -> Array:
            v, w, p = s[3:]
            c, k = np.cos(s[2]), np.sin(s[2])
            up = -stiffness[1] * s[1]  # vertical, in body axes below
            own = np.array([up * k, up * c, -stiffness[2] * k])
            turning = np.array([M[1] * w * p, -M[0] * v * p, (M[0] - M[1]) * v * w])
            speeds = (forces[i] + own + turning - factors * damping * s[3:]) / M
            return np.array([v * c - w * k, v * k + w * c, p, *speeds])

        start = np.array([0.0, 0.02 * rng.standard_normal(), 0.05 * rng.standard_normal()])
        states = integrate(rates, np.append(start, np.zeros(3)), times)[:, :3]
        states += rng.standard_normal(states.shape) * [5e-4, 5e-4, 2e-3]
        wave = 0.001 * np.sin(2.0 * np.pi * rng.uniform(0.6, 1.2) * times + rng.uniform(0.0, 6.0))
        signals = dict(zip(("y_m", "z_m", "phi_rad"), states.T, strict=True))
        return signals | {"wave_in_m": wave}

    return Body(vessel, times, noise, run, 3)
