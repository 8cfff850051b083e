"""The catamaran of Huang and Ji integrated from its printed equations, sharing no code with the
tool."""

from collections.abc import Callable
from dataclasses import dataclass
from math import atan2, cos, hypot, pi, sin

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.table import Recording

SWING = 0.47 * pi  # [rad] largest azimuth
CREEP = 0.02  # [m/s] below which a power law's damping is linear
LEVER = 0.4  # [m] mass centre to thruster
Control = Callable[
    [float, list[float]], tuple[float, float]
]  # t, state -> thrust [N], azimuth [rad]


@dataclass(frozen=True)
class Real:
    """What a catamaran really has, in the words of this file."""

    mass: float = 7.0  # [kg]
    depth: float = 0.045  # [m] D of its Table I
    sway: tuple[float, float] = (80.0, 1.0)  # damping d |v|^a sign(v), in very slow flow linear
    stern: bool = False  # thruster behind the mass centre
    gust: tuple[float, float, float] = (
        0.0,
        0.0,
        0.0,
    )  # [N] steady, [N] sine of 0.4 pi rad/s, [rad] towards
    lever: float = 0.0  # [m] of the gust ahead of the mass centre
    replay: bool = False  # positions as its eq. 1 has them

    def slopes(self, t: float, s: list[float], thrust: float, azimuth: float) -> list[float]:
        """Of x, y, psi, u, v, r; with `replay` x and y are the integrals of u and v."""
        _, _, z, u, v, w = s
        water = 1000.0 * pi * self.depth**2  # [kg/m]
        mx, my = 1.05 * self.mass, self.mass + water / 2
        mz = self.mass * (0.55**2 + 1.0) / 12 + (0.1 * self.mass * 0.55**2 + water) / 24
        d, a = self.sway
        steady, sine, toward = self.gust
        force = steady + sine * sin(0.4 * pi * t)
        ahead, abeam = force * cos(toward - z), force * sin(toward - z)
        side = thrust * sin(azimuth)
        du = (thrust * cos(azimuth) + ahead + my * v * w - 14.0 * u) / mx
        dv = (
            (-side if self.stern else side)
            + abeam
            - mx * u * w
            - d * hypot(v, CREEP) ** (a - 1.0) * v
        ) / my
        munk = water / 2 - 0.05 * self.mass
        dw = (
            LEVER * side
            + self.lever * (1.0 + 0.2 * cos(toward - z)) * abeam
            - munk * u * v
            - 5.0 * w
        ) / mz
        if self.replay:
            return [u, v, w, du, dv, dw]
        return [u * cos(z) - v * sin(z), u * sin(z) + v * cos(z), w, du, dv, dw]

    def place(self, s: list[float]) -> tuple[float, float]:
        """Where a state is taken to be."""
        x, y, c, n = s[0], s[1], cos(s[2]), sin(s[2])
        return (x * c - y * n, x * n + y * c) if self.replay else (x, y)

    def run(
        self, control: Control, duration: float, held: float = 0.0, start: list[float] | None = None
    ) -> Array:
        """Rows of t, X, Y, psi, u, v, r, thrust, azimuth every 10 ms; `held` [s] between two looks
        of the control.

        With `held` 0 the control is evaluated at every stage of the Runge-Kutta step, as the
        paper's is.
        """
        h, s, rows = 0.01, list(start or [0.0] * 6), []
        every = max(round(held / h), 1)
        for i in range(round(duration / h) + 1):
            t = i * h
            if i % every == 0:
                given = control(t, [*self.place(s), *s[2:]])
            rows.append([t, *self.place(s), *s[2:], *given])

            def slope(t: float, s: list[float], given: tuple[float, float] = given) -> list[float]:
                return self.slopes(t, s, *(given if held else control(t, [*self.place(s), *s[2:]])))

            a = slope(t, s)
            b = slope(t + h / 2, [x + h / 2 * k for x, k in zip(s, a, strict=True)])
            c = slope(t + h / 2, [x + h / 2 * k for x, k in zip(s, b, strict=True)])
            d = slope(t + h, [x + h * k for x, k in zip(s, c, strict=True)])
            s = [
                x + h / 6 * (p + 2 * q + 2 * r + w)
                for x, p, q, r, w in zip(s, a, b, c, d, strict=True)
            ]
        return np.array(rows)


def navigation(x: float, y: float, full: float = 20.0, radius: float = 2.5) -> Control:
    """Appendix B of the paper."""

    def control(t: float, s: list[float]) -> tuple[float, float]:
        distance, off = hypot(x - s[0], y - s[1]), atan2(y - s[1], x - s[0]) - s[2]
        off -= 2 * pi * round(off / (2 * pi))
        if distance <= radius:
            return 0.0, 0.0
        if abs(off) < pi / 2:
            return full, SWING * off / (pi / 2)
        return full / 3 * distance / 10 if distance <= 10.0 else full / 2, SWING * (
            1.0 if off > 0 else -1.0
        )

    return control


def recording(name: str, rows: Array, seed: int, every: int = 5) -> Recording:
    """What a good set of instruments makes of a run: 5 mm, 5 mrad, 5 mm/s, 5 mrad/s."""
    rng = np.random.default_rng(seed)
    rows = rows[::every]
    noisy = rows[:, 1:7] + 0.005 * rng.standard_normal((len(rows), 6))
    names = ("x_m", "y_m", "psi_rad", "u_mps", "v_mps", "r_radps")
    signals = dict(zip(names, noisy.T, strict=True)) | {
        "thrust_N": rows[:, 7],
        "azimuth_rad": rows[:, 8],
    }
    return Recording(name, rows[:, 0], signals)
