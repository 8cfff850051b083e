"""Wave forcing: an irregular force about one frequency on every axis."""

from dataclasses import dataclass
from math import cos, floor, pi, sqrt, tan
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Swell, Unsteady, Wrench, param

WAVES = 8  # components of the realisation, of equal energy
GOLDEN = 0.6180339887498949  # multiples of it modulo 1 are spread evenly: phases without a random generator


@njit(inline="always")
def phase(k: int) -> float:
    """Phase of component k [rad]."""
    return 2.0 * pi * (k * GOLDEN - floor(k * GOLDEN))


@njit
def law(m: Any, q: Any) -> Wrench:
    """One realisation: components at the quantiles of the oscillator's spectrum, each axis with phases of its own."""
    X = Y = K = N = 0.0
    if q.realisation == 0.0:
        return Wrench(X, Y, K, N)
    for k in range(WAVES):
        off = q.damping * tan(pi * ((k + 0.5) / WAVES - 0.5))  # quantile of a Lorentz line
        w = q.frequency * max(1.0 + off, 0.2)
        first = 1000 * int(q.realisation) + 3 * k
        X += cos(w * m.t + phase(first))
        Y += cos(w * m.t + phase(first + 1))
        N += cos(w * m.t + phase(first + 2))
        K += cos(w * m.t + phase(first + 3 * WAVES))
    share = sqrt(2.0 / WAVES)
    return Wrench(q.surge * share * X, q.sway * share * Y, q.roll * share * K, q.yaw * share * N)


@njit(inline="always")
def swell(q: Any) -> Swell:
    """The oscillators that the diagnosis follows; none where the force is zero."""
    there = q.surge > 0.0 or q.sway > 0.0 or q.roll > 0.0 or q.yaw > 0.0
    return Swell(q.surge, q.sway, q.roll, q.yaw, q.frequency if there else 0.0, q.damping)


@dataclass(frozen=True)
class WaveForcing(Unsteady):
    """Narrow-band wave forces in body axes, independent from axis to axis."""

    words: ClassVar[str] = "waves push the hull to and fro about one frequency"
    shown_by: ClassVar[str] = "lying still without thrust"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft, 2nd ed. 2021, section 10.2: second-order wave filter"
    )
    law: ClassVar = law
    swell: ClassVar = swell
    strength: ClassVar = ("surge", "sway", "yaw", "roll")
    starts: ClassVar = tuple({"frequency": w} for w in (1.5, 2.2, 3.2, 4.5, 6.5))

    surge: float = param(0.0, low=0.0, high=1e7, unit="N", words="rms surge force", fit=True, spread=0.2, axis="surge")
    sway: float = param(0.0, low=0.0, high=1e7, unit="N", words="rms sway force", fit=True, spread=0.2, axis="sway")
    yaw: float = param(0.0, low=0.0, high=1e9, unit="N m", words="rms yaw moment", fit=True, spread=0.06, axis="yaw")
    roll: float = param(0.0, low=0.0, high=1e9, unit="N m", words="rms roll moment", fit=True, spread=0.02, axis="roll")
    frequency: float = param(
        3.0, low=0.05, high=20.0, unit="rad/s", words="of encounter", fit=True, spread=1.5, absent=3.0
    )
    damping: float = param(
        0.08, low=0.005, high=0.5, unit="", words="width of the spectrum", fit=True, spread=0.05, absent=0.08
    )
    realisation: float = param(1.0, low=0.0, high=1e6, unit="", words="number of the random course; 0: still")
