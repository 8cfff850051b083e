"""Yaw-rate waves: an irregular sea that adds a narrow-band yaw rate to whatever turn the hull makes."""

from dataclasses import dataclass, replace
from math import cos, floor, hypot, pi, sin, sqrt, tan
from typing import Any, ClassVar, Self

from numba import njit

from boatsim.physics.base import UNSET, Swell, Unsteady, Wrench, param

PAIRS = 32  # pairs of components of the realisation


@njit(inline="always")
def spread(k: int, damping: float) -> tuple[float, float, float]:
    """Frequencies of pair k above and below the filter's own, per its own, and the upper one's share of their energy.

    With x = (w - 1/w) / (2 damping) the spectrum w^2 / ((1 - w^2)^2 + (2 damping w)^2) is that of a Lorentz line in
    x; a pair lies at +-x, where the lines of equal energy are, its members share by w^2 : 1.
    """
    off = damping * tan(0.5 * pi * (k + 0.5) / PAIRS)
    root = sqrt(1.0 + off * off)
    return root + off, root - off, 0.5 * (root + off) / root


@njit(inline="always")
def phase(k: int, realisation: float) -> float:
    """Phase of component k [rad]: the fraction of a large sine, as good as drawn by lot."""
    far = 43758.5453 * sin(12.9898 * k + 78.233 * realisation)
    return 2.0 * pi * (far - floor(far))


@njit
def law(m: Any, q: Any) -> Wrench:
    """The moment I r_w' + d r_w under which a hull of yaw inertia I and damping d turns with r_w beside its own r."""
    N = 0.0
    if q.realisation == 0.0 or q.rms == 0.0:
        return Wrench(0.0, 0.0, 0.0, N)
    for k in range(PAIRS):
        above, below, share = spread(k, q.damping)
        for side in range(2):
            w = q.frequency * (above if side == 0 else below)
            size = q.rms * sqrt(2.0 * (share if side == 0 else 1.0 - share) / PAIRS)
            angle = w * m.t + phase(2 * k + side, q.realisation)
            N += size * (q.drag * cos(angle) - q.inertia * w * sin(angle))
    return Wrench(0.0, 0.0, 0.0, N)


@njit(inline="always")
def swell(q: Any) -> Swell:
    """The oscillator that the diagnosis follows: the moment is narrow-band too; none where there are no waves."""
    moment = q.rms * hypot(q.inertia * q.frequency, q.drag)
    return Swell(0.0, 0.0, 0.0, moment, q.frequency if q.rms > 0.0 else 0.0, q.damping)


@dataclass(frozen=True)
class YawRateWaves(Unsteady):
    """Second-order filter waves r_w = kappa s / (s^2 + 2 lambda w s + w^2) of white noise, in force form."""

    words: ClassVar[str] = "waves swing the bow to and fro about one frequency"
    shown_by: ClassVar[str] = "holding a heading"
    source: ClassVar[str] = "L. R. S. Theisen, R. Galeazzi, M. Blanke, IFAC CAMS 2013, equation 8"
    law: ClassVar = law
    swell: ClassVar = swell

    rms: float = param(0.0, low=0.0, high=10.0, unit="rad/s", words="rms of the wave's yaw rate r_w")
    frequency: float = param(3.0, low=0.05, high=20.0, unit="rad/s", words="of the filter, omega_w")
    damping: float = param(0.1, low=0.005, high=0.9, unit="", words="of the filter, lambda_w")
    inertia: float = param(
        UNSET, low=0.0, high=1e13, unit="kg m^2", words="in yaw, of hull and water; if not given, the vessel's own"
    )
    drag: float = param(UNSET, low=0.0, high=1e13, unit="N m s", words="the vessel's", follows="linear_damping.yaw")
    realisation: float = param(1.0, low=0.0, high=1e6, unit="", words="number of the random course; 0: still")

    def rules(self, vessel: Any) -> dict[str, float]:
        """The vessel's inertia in yaw, its water's included."""
        water = vessel.effect("added_mass")
        return {"inertia": vessel.body.yaw_inertia + (water.yaw + water.sway * water.sway_at**2 if water else 0.0)}

    def seeded(self, seed: int) -> Self:
        """The realisation of that number, unless the water is still."""
        return replace(self, realisation=float(1 + seed % 999_999) if self.realisation else 0.0)
