"""A boat in head waves that bring its drives near the surface, held in surge, heave and pitch."""

import numpy as np

from boatsim.physics.vessel import Vessel
from validation.calibration.bodies.body import GRAVITY, Array, Body, Rng, ambient, integrate, steps

AXES = ("surge", "heave", "pitch")
DRIVES = {"fore": (0.4, 0.12), "aft": (-0.6, 0.18)}  # ahead of the middle, below the waterline [m]
AHEAD, ASTERN = 8.0, 6.0  # [N] full thrust of a drive
FREQUENCY = (2.0, 3.0)  # [rad/s] of the wave, below the natural ones of heave and pitch
AMPLITUDE = (0.01, 0.03)  # [m] of the wave
BANDWIDTH = 20.0  # [rad/s] of the measured wave, which changes regular waves by 0.1 % at most
LEVER = 0.25  # [lengths] of the ambient moment


def heaving_drives() -> Body:
    """A boat of small waterplane in regular waves, with two drives that push ahead and astern.

    M_u u' = X - M_w w q,  M_w w' = Z + M_u u q,  M_q q' = M + (M_w - M_u) u w

    with added mass in M_u, M_w and M_q (Kirchhoff's equations, as in T. I. Fossen, Handbook of
    Marine Craft Hydrodynamics, 2nd ed. 2021, section 6.3). Buoyancy is linear: Z = -c (z + eta) and
    M = -g theta in axes of the hull, with the elevation eta at the boat of a wave that is much
    longer than the hull. The thrust does not depend on the immersion of the drives.
    """
    mass, inertia, length = 40.0, 5.0, 1.4
    added = np.array([4.0, 40.0, 5.0])  # surge, heave [kg], pitch [kg m^2]
    damping = np.array([12.0, 80.0, 15.0])
    waterplane, trimming = 981.0, 150.0  # c [N/m] of 0.1 m^2, g [N m/rad]
    times = np.arange(0.0, 40.0, 0.05)
    noise = {"position_sd_m": 2e-3, "heave_sd_m": 1e-3, "pitch_sd_rad": 2e-3}
    noise |= {"speed_sd_mps": 0.01, "heave_rate_sd_mps": 0.01, "pitch_rate_sd_radps": 0.01}
    wave = {"on": {"elevation": "wave_in_m"}, "bandwidth": BANDWIDTH}
    vessel = Vessel.from_effects(
        name="trial_heaving_drives",
        dof=AXES,
        length=length,
        beam=0.5,
        draught=0.25,
        body={
            "mass": mass,
            "roll_inertia": 1.0,
            "pitch_inertia": inertia,
            "yaw_inertia": inertia,
        },
        effects=[
            {"use": "added_mass", "sway": 0.0, "yaw": 0.0, **dict(zip(AXES, added, strict=True))},
            {"use": "linear_damping", **dict(zip(AXES, damping, strict=True))},
            {"use": "hydrostatics", "heave": waterplane, "pitch": trimming},
            {"use": "wave_excitation", **wave, "heave_elevation": -waterplane},
            *deep_thrusters(),
        ],
        channels={f"{name}_N": {"low": -ASTERN, "high": AHEAD} for name in DRIVES},
        measured={"wave_in_m": {"about": "elevation at the boat"}},
        diagnosis={
            "facts": {"guided": True, "indoors": True},
            "rate": 20.0,
            "reasons": {"rate": "waves"},
        },
    )
    M = np.array([mass, mass, inertia]) + added
    depths = np.array([depth for _, depth in DRIVES.values()])

    def run(rng: Rng, factors: Array) -> dict[str, Array]:
        commands = steps(rng, times, 4.0, -ASTERN, AHEAD, len(DRIVES))
        forces = ambient(rng, times, mass, length, (1.0, 1.0, LEVER * length))
        forces[:, 0] += factors[3] * commands.sum(axis=1)
        forces[:, 2] += factors[3] * commands @ depths
        frequency, phase = rng.uniform(*FREQUENCY), rng.uniform(0.0, 2.0 * np.pi)
        height = rng.uniform(*AMPLITUDE)

        def elevation(t: Array | float, x: Array | float) -> Array:
            """Return the elevation [m] of a wave that comes from ahead, in deep water."""
            place = frequency**2 / GRAVITY * x
            return np.asarray(height * np.cos(frequency * t + place + phase))

        def rates(s: Array, i: int) -> Array:
            t, x, z, theta = s[6], s[0], s[1], s[2]
            u, w, q = s[3:6]
            c, k = np.cos(theta), np.sin(theta)
            own = np.array([0.0, -waterplane * (z + elevation(t, x)), -trimming * theta])
            turning = np.array([-M[1] * w * q, M[0] * u * q, (M[1] - M[0]) * u * w])
            speeds = (forces[i] + own + turning - factors[:3] * damping * s[3:6]) / M
            return np.array([u * c + w * k, w * c - u * k, q, *speeds, 1.0])

        states = integrate(rates, np.zeros(7), times)
        wave = elevation(times, states[:, 0])
        states = states[:, :6] + rng.standard_normal((len(times), 6)) * [
            0.002,
            0.001,
            0.002,
            0.01,
            0.01,
            0.01,
        ]
        names = ("x_m", "z_m", "theta_rad", "u_mps", "w_mps", "q_radps")
        signals = dict(zip(names, states.T, strict=True)) | {"wave_in_m": wave}
        return signals | {f"{name}_N": commands[:, i] for i, name in enumerate(DRIVES)}

    return Body(vessel, times, noise, run, 4)


def deep_thrusters() -> list[dict[str, object]]:
    """Return the tables of the drives."""
    found: list[dict[str, object]] = []
    for name, (x, z) in DRIVES.items():
        found.append(
            {"use": "thruster", "name": name, "on": {"thrust": f"{name}_N"}, "x": x, "z": z}
        )
    return found
