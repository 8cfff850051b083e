"""Yaw-rate waves: an irregular sea that adds a narrow-band yaw rate to whatever turn the hull makes."""

from dataclasses import dataclass, replace
from math import cos, hypot, pi, sin, sqrt
from typing import Any, ClassVar, Self

from numba import njit

from boatsim.physics.base import UNSET, Boat, Swell, Unsteady, Wrench, param, wrench
from boatsim.physics.noise import course, drawn, line

WAVES = 64  # components of the realisation
# of the numbers drawn: beyond those of other effects, which may have the same realisation
FIRST = 20_000


@njit(inline="always")
def component(k: int, q: Any) -> tuple[float, float, float]:
    """Frequency [rad/s], amplitude [rad/s] and phase [rad] of one part of the yaw rate r_w.

    It lies in the middle of its part of the line: the moment grows with the frequency, and one drawn by lot from the
    ends of the line, which reach to zero and to infinity, would drown all others.
    """
    w, weight = line((k + 0.5) / WAVES - 0.5, q.damping)
    return (
        q.frequency * w,
        q.rms * sqrt(2.0 * weight / WAVES),
        2.0 * pi * drawn(q.realisation, FIRST + k),
    )


@njit
def law(m: Any, q: Any) -> Wrench:
    """The moment I r_w' + d r_w under which a hull of yaw inertia I and damping d turns with r_w beside its own r."""
    N = 0.0
    if q.realisation == 0.0 or q.rms == 0.0:
        return wrench(N=N)
    for k in range(WAVES):
        w, size, phase = component(k, q)
        N += size * (q.drag * cos(w * m.t + phase) - q.inertia * w * sin(w * m.t + phase))
    return wrench(N=N)


@njit(inline="always")
def swell(q: Any) -> Swell:
    """The oscillator that the diagnosis follows: the moment is narrow-band too; none where there are no waves."""
    moment = q.rms * hypot(q.inertia * q.frequency, q.drag)
    return Swell(0.0, 0.0, 0.0, 0.0, 0.0, moment, q.frequency if q.rms > 0.0 else 0.0, q.damping)


@dataclass(frozen=True)
class YawRateWaves(Unsteady):
    """Second-order filter waves r_w = kappa s / (s^2 + 2 lambda w s + w^2) of white noise, in force form."""

    words: ClassVar[str] = "waves swing the bow to and fro about one frequency"
    shown_by: ClassVar[str] = "holding a heading"
    source: ClassVar[str] = "L. R. S. Theisen, R. Galeazzi, M. Blanke, IFAC CAMS 2013, equation 8"
    law: ClassVar = law
    swell: ClassVar = swell
    strength: ClassVar = ("rms",)

    rms: float = param(
        0.0, low=0.0, high=10.0, unit="rad/s", words="rms of the wave's yaw rate r_w"
    )
    frequency: float = param(3.0, low=0.05, high=20.0, unit="rad/s", words="of the filter, omega_w")
    damping: float = param(0.1, low=0.005, high=0.9, unit="", words="of the filter, lambda_w")
    inertia: float = param(
        UNSET,
        low=0.0,
        high=1e13,
        unit="kg m^2",
        words="in yaw, of hull and water; if not given, the vessel's own",
    )
    drag: float = param(
        UNSET, low=0.0, high=1e13, unit="N m s", words="the vessel's", follows="linear_damping.yaw"
    )
    realisation: float = param(
        1.0, low=0.0, high=1e9, unit="", words="number of the random course; 0: still"
    )

    def rules(self, vessel: Boat) -> dict[str, float]:
        """The vessel's inertia in yaw, its water's included."""
        yaw, sway, at = (
            self.followed(f"added_mass.{key}?", vessel) for key in ("yaw", "sway", "sway_at")
        )
        return {"inertia": vessel.body.yaw_inertia + (yaw + sway * at**2)}

    def seeded(self, seed: int) -> Self:
        """Another course for each seed, unless the water is still."""
        return replace(
            self, realisation=course(self.realisation, seed) if self.realisation else 0.0
        )
