"""Filtered sea: independent narrow-band wave forces in sway, yaw and roll."""

from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

from numba import njit

from boatsim.physics.base import UNSET, Force, Wrench, param, wrench
from boatsim.physics.noise import narrow_band_noise, seeded_realisation


@njit
def law(m: Any, q: Any) -> Wrench:
    """Return one realisation of narrow-band wave forces in sway, yaw and roll at the present time.

    Axes with zero rms force are not computed.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    Y = K = N = 0.0
    w, z, number, count = q.frequency, q.damping, q.realisation, q.components
    if q.sway > 0.0:
        Y = q.sway * narrow_band_noise(m.t, w, z, number, 0.0, count)
    if q.roll > 0.0:
        K = q.roll * narrow_band_noise(m.t, w, z, number, 1.0, count)
    if q.yaw > 0.0:
        N = q.yaw * narrow_band_noise(m.t, w, z, number, 2.0, count)
    return wrench(Y=Y, K=K + q.arm * Y, N=N)


@dataclass(frozen=True)
class FilteredSea(Force):
    """Coloured noise for wave forces: the linear second-order wave model of autopilot design.

    F = sigma n(t),  n(t) white noise filtered by 2 z w0 s / (s^2 + 2 z w0 s + w0^2), of unit rms

    sigma is the rms force of the axis, w0 the `frequency` [rad/s], z the `damping` of the shaping
    filter. n(t) is realised as a sum of cosines. The sway force also heels the hull with the lever
    `arm` [m].
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} Y &= \sigma_Y n_1(t), \quad K = \sigma_K n_2(t) + l \, Y, \quad "
        r"N = \sigma_N n_3(t) \\ n_i(s) &\sim \frac{2 \zeta \omega_0 s}{s^2 + 2 \zeta "
        r"\omega_0 s + \omega_0^2} \quad \text{applied to white noise, with unit rms} "
        r"\end{aligned}"
    )
    symbols: ClassVar = {
        "sway": r"\sigma_Y",
        "roll": r"\sigma_K",
        "yaw": r"\sigma_N",
        "frequency": r"\omega_0",
        "damping": r"\zeta",
        "arm": "l",
    }
    words: ClassVar[str] = "waves exert independent narrow-band forces in sway, yaw and roll"
    shown_by: ClassVar[str] = "lying beam to the sea without steering"
    source: ClassVar[str] = (
        "C. R. Martin, Rudder Roll Reduction for Small Ships, UBC 1993, Appendix V: shaping filters"
    )
    law: ClassVar = law

    sway: float = param(0.0, low=0.0, high=1e9, unit="N", words="rms sway force")
    roll: float = param(0.0, low=0.0, high=1e11, unit="N m", words="rms roll moment")
    yaw: float = param(0.0, low=0.0, high=1e11, unit="N m", words="rms yaw moment")
    frequency: float = param(
        1.0, low=0.01, high=50.0, unit="rad/s", words="natural frequency of the filter, w0"
    )
    damping: float = param(
        0.1, low=0.001, high=2.0, unit="", words="damping ratio of the filter, z"
    )
    components: float = param(
        160.0, low=1.0, high=2000.0, unit="", words="number of cosines in each axis"
    )
    realisation: float = param(1.0, low=0.0, high=1e9, unit="", words="number of the realisation")
    arm: float = param(
        UNSET,
        low=-100.0,
        high=100.0,
        unit="m",
        words="roll moment per sway force; default: that of the vessel's linear_hull",
        follows="linear_hull.arm?",
    )

    def wave_axes(self) -> tuple[str, ...]:
        """Return the degrees of freedom for which there is an rms force; empty if all are zero."""
        if self.sway == self.roll == self.yaw == 0.0:
            return ()
        return ("sway", "roll", "yaw")

    def with_seed(self, seed: int) -> Self:
        """Return a copy of the wave forces whose random realisation follows from the seed.

        Args:
            seed: Seed of the scenario.
        """
        return replace(self, realisation=seeded_realisation(self.realisation, seed))
