"""Instruments on board: receiver, compass, gyro and orders, each with own rate and noise."""

from dataclasses import dataclass, replace

import numpy as np

from validation.owner_logs.boats import Boat, Rng
from validation.owner_logs.sail import DT, Array, Voyage


@dataclass(frozen=True)
class Series:
    """Samples of one instrument."""

    t: Array  # (N,) s
    values: dict[str, Array]  # (N,) each

    def having(self, **made: Array) -> "Series":
        """Return the series with some values replaced."""
        return replace(self, values=self.values | made)

    def at(self, rows: Array) -> "Series":
        """Return the given rows."""
        return Series(self.t[rows], {n: v[rows] for n, v in self.values.items()})


@dataclass(frozen=True)
class RecordedSignals:
    """Recorded signals of a voyage; orders are shares of full, helm in rad to starboard."""

    fixes: Series  # north, east [m], speed [m/s], course [rad]
    compass: Series  # psi [rad], unbounded
    gyro: Series  # r [rad/s]
    orders: Series  # one channel per drive by name, and helm [rad]


@dataclass(frozen=True)
class InstrumentQuality:
    """Quality of a boat's instruments."""

    fix_rate: float  # [Hz]
    fix_sd: float  # [m]
    compass_sd: float  # [rad]
    gyro_sd: float  # [rad/s]
    gyro_bias: float
    antenna: float  # [m] ahead of the mass centre


def sample_instruments(boat: Boat, rng: Rng) -> InstrumentQuality:
    """Sample the instruments; good receivers are as likely as plain ones."""
    sd = float(np.exp(rng.uniform(np.log(0.02), np.log(0.3))))
    return InstrumentQuality(
        float(rng.choice([5.0, 10.0])),
        min(sd, 0.08 * boat.length),
        float(np.radians(rng.uniform(0.7, 1.6))),
        float(rng.uniform(0.002, 0.006)),
        float(rng.normal(0.0, 0.001)),
        0.03 * boat.length * rng.uniform(-1.0, 1.0),
    )


def drive_names(boat: Boat) -> tuple[str, ...]:
    """Return the names of the drives: motor, or port and starboard."""
    return tuple(c.removeprefix("thrust_").removesuffix("_N") for c in boat.channels)


def sample_rows(v: Voyage, rate: float) -> Array:
    """Return rows of the voyage at a rate [Hz]."""
    return np.arange(0, len(v.t), round(1.0 / rate / DT))


def record_voyage(boat: Boat, v: Voyage, on: InstrumentQuality, rng: Rng) -> RecordedSignals:
    """Return the voyage as recorded by the instruments."""
    rows = sample_rows(v, on.fix_rate)
    north, east, psi = v.states[rows, :3].T
    noise = on.fix_sd * rng.standard_normal((2, len(rows)))
    ahead = on.antenna * np.array([np.cos(psi), np.sin(psi)])
    velocity = np.gradient(v.states[:, :2], DT, axis=0)[rows].T + 0.05 * rng.standard_normal(
        (2, len(rows))
    )
    fixes = Series(
        v.t[rows],
        {
            "north": north + ahead[0] + noise[0],
            "east": east + ahead[1] + noise[1],
            "speed": np.hypot(*velocity),
            "course": np.arctan2(velocity[1], velocity[0]),
        },
    )
    rows = sample_rows(v, 10.0)
    compass = Series(
        v.t[rows], {"psi": v.states[rows, 2] + on.compass_sd * rng.standard_normal(len(rows))}
    )
    rows = sample_rows(v, 25.0)
    r = v.states[rows, 5] + on.gyro_sd * rng.standard_normal(len(rows)) + on.gyro_bias
    rows_of_orders = sample_rows(v, 10.0)
    orders = {n: v.throttles[rows_of_orders, i] for i, n in enumerate(drive_names(boat))}
    helm = {"helm": v.helm[rows_of_orders] * boat.helm_most} if boat.helm_most else {}
    return RecordedSignals(
        fixes, compass, Series(v.t[rows], {"r": r}), Series(v.t[rows_of_orders], orders | helm)
    )
