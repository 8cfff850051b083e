"""Filtered sea: sway, yaw and roll each pushed by a noise of its own about one frequency."""

from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

from numba import njit

from boatsim.physics.base import UNSET, Force, Wrench, param, wrench
from boatsim.physics.noise import course, noise


@njit
def law(m: Any, q: Any) -> Wrench:
    """Channels that nothing pushes cost nothing."""
    Y = K = N = 0.0
    w, z, number, count = q.frequency, q.damping, q.realisation, q.components
    if q.sway > 0.0:
        Y = q.sway * noise(m.t, w, z, number, 0.0, count)
    if q.roll > 0.0:
        K = q.roll * noise(m.t, w, z, number, 1.0, count)
    if q.yaw > 0.0:
        N = q.yaw * noise(m.t, w, z, number, 2.0, count)
    return wrench(Y=Y, K=K + q.arm * Y, N=N)


@dataclass(frozen=True)
class FilteredSea(Force):
    """Coloured noise for waves, as controllers' authors fit it: independent from axis to axis."""

    words: ClassVar[str] = (
        "waves push sway, yaw and roll, each with a noise of its own about one frequency"
    )
    shown_by: ClassVar[str] = "lying across the sea without steering"
    source: ClassVar[str] = (
        "C. R. Martin, Rudder Roll Reduction for Small Ships, UBC 1993, Appendix V: shaping filters"
    )
    law: ClassVar = law

    sway: float = param(0.0, low=0.0, high=1e9, unit="N", words="rms sway force")
    roll: float = param(0.0, low=0.0, high=1e11, unit="N m", words="rms roll moment")
    yaw: float = param(0.0, low=0.0, high=1e11, unit="N m", words="rms yaw moment")
    frequency: float = param(1.0, low=0.01, high=50.0, unit="rad/s", words="of the filter, w0")
    damping: float = param(0.1, low=0.001, high=2.0, unit="", words="of the filter, z")
    components: float = param(
        160.0, low=1.0, high=2000.0, unit="", words="number of cosines on each axis"
    )
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
        return replace(self, realisation=course(self.realisation, seed))
