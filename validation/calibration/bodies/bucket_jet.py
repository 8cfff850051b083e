"""A craft with an idling water jet whose bucket reverses it."""

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

THRUST = 60.0  # [N] with the bucket up
STEER = 80.0  # [N m/rad] of the nozzle with the bucket up
NOZZLE = 0.4  # [rad] to either side
BUCKET = 1.4  # [rad] fully down; at pi/4 the jet gives no thrust


def bucket_jet() -> Body:
    """A craft that a jet drives ahead and astern, and steers.

    X = T cos 2b,  N = N_d d cos 2b,  with bucket b and nozzle d: L. R. S. Theisen, R. Galeazzi,
    M. Blanke, IFAC CAMS 2013, equations 2 and 5. It turns alike ahead and astern.
    """
    mass, inertia, length = 150.0, 60.0, 2.5
    added = np.array([12.0, 100.0, 40.0])
    damping = np.array([30.0, 200.0, 80.0])
    times = np.arange(0.0, 120.0, 0.2)
    noise = {"position_sd_m": 0.02, "heading_sd_rad": 0.01, "yaw_rate_sd_radps": 0.005}
    on = {"angle": "nozzle_rad", "bucket": "bucket_rad"}
    vessel = Vessel.from_effects(
        name="trial_bucket_jet",
        dof=("surge", "sway", "yaw"),
        length=length,
        beam=1.0,
        draught=0.2,
        body={"mass": mass, "roll_inertia": 15.0, "yaw_inertia": inertia},
        effects=[
            {"use": "added_mass", "surge": added[0], "sway": added[1], "yaw": added[2]},
            {"use": "linear_damping", **dict(zip(("surge", "sway", "yaw"), damping, strict=True))},
            {"use": "reversing_jet", "on": on, "thrust": THRUST, "yaw": STEER},
        ],
        channels={
            "nozzle_rad": {"low": -NOZZLE, "high": NOZZLE},
            "bucket_rad": {"low": 0.0, "high": BUCKET},
        },
        diagnosis={"facts": {"position_fix": "gnss"}},
    )
    M = np.array([mass, mass, inertia]) + added

    def run(rng: Rng, factors: Array) -> dict[str, Array]:
        nozzle = steps(rng, times, 5.0, -NOZZLE, NOZZLE, 1)[:, 0]
        bucket = steps(rng, times, 8.0, 0.0, BUCKET, 1)[:, 0]
        share = np.cos(2.0 * bucket)
        forces = ambient(rng, times, mass, length, (1.0, 1.0, LEVER * length))
        forces[:, 0] += factors[3] * THRUST * share
        forces[:, 2] += factors[4] * STEER * share * nozzle

        def rates(s: Array, i: int) -> Array:
            return boat_rates(s, forces[i], M, factors[:3] * damping)

        states = integrate(rates, np.zeros(6), times)
        states += rng.standard_normal(states.shape) * [0.02, 0.02, 0.01, 0.0, 0.0, 0.005]
        signals = dict(zip(POSE, states[:, :3].T, strict=True)) | {"r_radps": states[:, 5]}
        return signals | {"nozzle_rad": nozzle, "bucket_rad": bucket}

    return Body(vessel, times, noise, run, 5)
