"""Filtered sea: sway, yaw and roll each pushed by a noise of its own about one frequency."""

from dataclasses import dataclass, replace
from math import cos, pi, sqrt, tan
from typing import Any, ClassVar, Self

from numba import njit

from boatsim.physics.base import UNSET, Force, Wrench, param
from boatsim.physics.effects.irregular_sea import drawn


@njit
def noise(t: float, q: Any, channel: int) -> float:
    """White noise through s / (s^2 + 2 z w0 s + w0^2) with unit variance, as a sum of cosines.

    In the variable a = w / w0 - w0 / w the spectrum is a Lorentz line times 1 + a / sqrt(a^2 + 4), whose second part
    is odd: cells of equal area of the line, weighted with that factor.
    """
    total, count = 0.0, int(q.components)
    for k in range(count):
        first = 2 * (channel * count + k)
        a = 2.0 * q.damping * tan(pi * ((k + drawn(q.realisation, first)) / count - 0.5))
        root = sqrt(a * a + 4.0)
        w = 0.5 * q.frequency * (a + root if a > 0.0 else 4.0 / (root - a))
        total += sqrt(1.0 + a / root) * cos(w * t + 2.0 * pi * drawn(q.realisation, first + 1))
    return total * sqrt(2.0 / count)


@njit
def law(m: Any, q: Any) -> Wrench:
    """Channels that nothing pushes cost nothing."""
    Y = q.sway * noise(m.t, q, 0) if q.sway > 0.0 else 0.0
    K = q.roll * noise(m.t, q, 1) if q.roll > 0.0 else 0.0
    N = q.yaw * noise(m.t, q, 2) if q.yaw > 0.0 else 0.0
    return Wrench(0.0, Y, K + q.arm * Y, N)


@dataclass(frozen=True)
class FilteredSea(Force):
    """Coloured noise for waves, as controllers' authors fit it: independent from axis to axis."""

    words: ClassVar[str] = "waves push sway, yaw and roll, each with a noise of its own about one frequency"
    shown_by: ClassVar[str] = "lying across the sea without steering"
    source: ClassVar[str] = "C. R. Martin, Rudder Roll Reduction for Small Ships, UBC 1993, Appendix V: shaping filters"
    law: ClassVar = law

    sway: float = param(0.0, low=0.0, high=1e9, unit="N", words="rms sway force")
    roll: float = param(0.0, low=0.0, high=1e11, unit="N m", words="rms roll moment")
    yaw: float = param(0.0, low=0.0, high=1e11, unit="N m", words="rms yaw moment")
    frequency: float = param(1.0, low=0.01, high=50.0, unit="rad/s", words="of the filter, w0")
    damping: float = param(0.1, low=0.001, high=2.0, unit="", words="of the filter, z")
    components: float = param(160.0, low=1.0, high=2000.0, unit="", words="number of cosines on each axis")
    realisation: float = param(1.0, low=0.0, high=1e9, unit="", words="number of the random course")
    arm: float = param(
        UNSET,
        low=-100.0,
        high=100.0,
        unit="m",
        words="the vessel's roll by sway; if not given, its own if it has one",
        follows="linear_hull.arm?",
    )

    def seeded(self, seed: int) -> Self:
        """Another course for each seed."""
        return replace(self, realisation=self.realisation + seed)
