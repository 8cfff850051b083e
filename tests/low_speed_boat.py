"""The water-jet craft at low speed as it might really be, integrated in steps of 10 ms by equations
of its own."""

from dataclasses import dataclass
from math import cos, exp, pi, sin, tanh

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.table import Notes, Recording

FINE, ROW = 0.01, 0.1  # [s]
RATE = 30.0 * pi / 180.0 * FINE  # [rad] nozzle and bucket turn in a step
LIP = 12.0 * pi / 180.0  # [rad] of the bucket's way on which it comes to lie in the jet
BUCKETS = (0.0, 15.0, 30.0, 40.0, 50.0, 55.0)  # [deg]


@dataclass(frozen=True)
class Real:
    """What the craft really has, in the words of this file."""

    # share of the jet that passes a lowered bucket; a raised one has nothing to leak
    leak: float = 0.0
    late: float = 0.0  # [s] commands, up to a tenth more or less each
    astern_time: float = 1.67  # [s] T_n while it goes astern
    sea: float = 0.0  # [rad/s] rms of waves in the yaw rate
    sea_frequency: float = 2.5  # [rad/s]
    pushed: float = 0.0  # [rad/s^2] constant yaw acceleration


def commanded(seed: int, seconds_each: float = 12.0) -> tuple[Array, Array]:
    """Nozzle and bucket [rad], a row every 0.1 s: +-6 or +-12 deg held for 3 s, six bucket angles
    in random order."""
    rng = np.random.default_rng(seed)
    steps = round(seconds_each / 3.0) * len(BUCKETS)
    nozzle = np.radians(rng.choice([-12.0, -6.0, 6.0, 12.0], steps))
    bucket = np.radians(np.repeat(rng.permutation(BUCKETS), steps // len(BUCKETS)))
    return np.repeat(nozzle, round(3.0 / ROW)), np.repeat(bucket, round(3.0 / ROW))


def waves(real: Real, n: int, seed: int) -> Array:
    """The yaw rate r_w of second-order filter waves at every fine step, lambda_w 0.1: a hundred
    sines by lot."""
    rng = np.random.default_rng(1000 + seed)
    w = real.sea_frequency * np.linspace(0.4, 2.5, 300)
    size = w**2 / ((w**2 - real.sea_frequency**2) ** 2 + (0.2 * real.sea_frequency * w) ** 2)
    at = FINE * np.arange(n)
    summed = np.sqrt(2.0 * size / size.sum()) @ np.cos(
        np.outer(w, at) + rng.uniform(0.0, 2.0 * pi, (300, 1))
    )
    return np.asarray(real.sea * summed)


def arrivals(real: Real, rows: int, seed: int) -> Array:
    """Fine steps (rows,) at which the commands of each row arrive; those of 3 s are late by one
    time."""
    rng = np.random.default_rng(2000 + seed)
    late = real.late * np.repeat(rng.uniform(0.9, 1.1, rows // 30 + 1), 30)[:rows]
    return np.round((ROW * np.arange(rows) + late) / FINE)


def recorded(real: Real, seed: int, commands: tuple[Array, Array] | None = None) -> Recording:
    """A run from rest as compass, gyro, speed log and a position fix record it."""
    nozzle, bucket = commands or commanded(seed)
    every = round(ROW / FINE)
    arrived = arrivals(real, len(nozzle), seed)
    n = every * len(nozzle)
    wave = waves(real, n + 1, seed) if real.sea else np.zeros(n + 1)
    x = y = psi = r = u = delta = beta = 0.0
    rows = []
    for i in range(n):
        if i % every == 0:
            rows.append((x, y, psi, u, r + wave[i]))
        row = max(int(np.searchsorted(arrived, i, "right")) - 1, 0)
        delta += min(max(nozzle[row] - delta, -RATE), RATE)
        beta += min(max(bucket[row] - beta, -RATE), RATE)
        passes = real.leak * (1.0 - exp(-beta / LIP))
        share = cos(2.0 * beta) + passes
        lag = 1.67 + (real.astern_time - 1.67) * 0.5 * (
            1.0 - tanh(u / 0.15)
        )  # the flow turns by and by
        r += FINE * ((share * delta - r) / lag + real.pushed * (1.0 + 0.3 * sin(0.7 * i * FINE)))
        u += FINE * (2.46 * share - u) / 5.58
        psi += FINE * (r + wave[i])
        x, y = x + FINE * u * cos(psi), y + FINE * u * sin(psi)
    rng = np.random.default_rng(seed)
    shown = np.array(rows) + rng.standard_normal((len(rows), 5)) * [
        0.3,
        0.3,
        0.01,
        0.05,
        0.5 * pi / 180.0,
    ]
    names = ("x_m", "y_m", "psi_rad", "u_mps", "r_radps")
    signals = dict(zip(names, shown.T, strict=True)) | {"jet_rad": nozzle, "elevator_rad": bucket}
    signals["throttle"] = np.ones(len(rows))
    return Recording(
        f"{seed}", ROW * np.arange(len(rows)), signals, Notes(vessel="jet_ski", load=("low_speed",))
    )
