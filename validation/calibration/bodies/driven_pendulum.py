"""A weight on the axis of a motor, in bearings: roll alone, driven by a measured torque."""

import numpy as np
from scipy.signal import lfilter

from boatsim.physics.vessel import Vessel
from validation.calibration.bodies.body import Array, Body, Rng, integrate, steps

AMBIENT_MOMENT = 0.02  # [N m] rms: ripple of the motor
RIPPLE_TIME = 0.2  # [s] its correlation time
SENSOR = 0.01  # [N m] noise of the measured torque
RISE = 0.1  # [s] in which the torque follows its order
EVERY = 5  # steps of the simulation in one row, so that the torque changes smoothly between rows


def driven_pendulum() -> Body:
    """A pendulum with viscous damping and without dry friction, in both groups of recordings."""
    inertia, weight, damping = 0.15, 3.0, 0.05
    times = np.arange(0.0, 20.0, 0.02)
    vessel = Vessel.from_effects(
        name="trial_driven_pendulum",
        dof=("roll",),
        length=0.5,
        beam=0.1,
        draught=0.5,
        body={"mass": 0.7, "roll_inertia": inertia, "yaw_inertia": inertia},
        effects=[
            {"use": "applied_load", "on": {"moment": "torque_Nm"}, "roll": 1.0},
            {"use": "righting_moment", "moment": weight},
            {"use": "linear_damping", "roll": damping},
        ],
        channels={"torque_Nm": {"low": -5.0, "high": 5.0}},
        diagnosis={
            "facts": {"guided": True, "indoors": True},
            "ambient": {"roll": AMBIENT_MOMENT},
            "reasons": {"ambient": "ripple of the motor"},
        },
    )

    def run(rng: Rng, factors: Array) -> dict[str, Array]:
        t = np.linspace(0.0, times[-1], EVERY * (len(times) - 1) + 1)
        torque = first_order(steps(rng, t, 0.5, -2.0, 2.0, 1)[:, 0], t[1], RISE)
        keep = np.exp(-t[1] / RIPPLE_TIME)
        white = rng.standard_normal(len(t)) * np.sqrt((1.0 + keep) / (1.0 - keep))
        total = torque + AMBIENT_MOMENT * first_order(white, t[1], RIPPLE_TIME)
        total[:-1] = 0.5 * (total[:-1] + total[1:])  # mean over each step

        def rates(s: Array, i: int) -> Array:
            moment = total[i] - weight * np.sin(s[0]) - factors[0] * damping * s[1]
            return np.array([s[1], moment / inertia])

        states = integrate(rates, np.array([0.3 * rng.standard_normal(), 0.0]), t)[::EVERY]
        states += rng.standard_normal(states.shape) * [1e-3, 0.02]
        measured = torque[::EVERY] + SENSOR * rng.standard_normal(len(times))
        return {"phi_rad": states[:, 0], "p_radps": states[:, 1], "torque_Nm": measured}

    noise = {"roll_sd_rad": 1e-3, "roll_rate_sd_radps": 0.02}
    return Body(vessel, times, noise, run, 1)


def first_order(values: Array, step: float, rise: float) -> Array:
    """Return values (N,) after a lag of the first order with a time constant [s]."""
    keep = np.exp(-step / rise)
    return np.asarray(lfilter([1.0 - keep], [1.0, -keep], values))
