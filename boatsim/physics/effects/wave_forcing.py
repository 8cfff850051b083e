"""Wave forcing: independent narrow-band wave forces in body axes."""

from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

from numba import njit

from boatsim.physics.base import OscillatingForce, RandomForce, Wrench, param, wrench
from boatsim.physics.noise import narrow_band_noise, seeded_realisation

WAVES = 64.0  # components of the realisation in each axis
# channels of the noise, different from those of other effects
SURGE = 100.0
SWAY = 101.0
ROLL = 102.0
YAW = 103.0


@njit
def law(m: Any, q: Any) -> Wrench:
    """Return one realisation of narrow-band wave forces in body axes.

    Axes with zero rms force are not computed.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    X = Y = K = N = 0.0
    if q.realisation == 0.0:
        return wrench(X=X, Y=Y, K=K, N=N)
    w, z, number = q.frequency, q.damping, q.realisation
    if q.surge > 0.0:
        X = q.surge * narrow_band_noise(m.t, w, z, number, SURGE, WAVES)
    if q.sway > 0.0:
        Y = q.sway * narrow_band_noise(m.t, w, z, number, SWAY, WAVES)
    if q.roll > 0.0:
        K = q.roll * narrow_band_noise(m.t, w, z, number, ROLL, WAVES)
    if q.yaw > 0.0:
        N = q.yaw * narrow_band_noise(m.t, w, z, number, YAW, WAVES)
    return wrench(X=X, Y=Y, K=K, N=N)


@njit(inline="always")
def oscillating_force(q: Any) -> OscillatingForce:
    """Return the oscillators by which the diagnosis filter models the wave forces.

    There are none if all forces are zero.

    Args:
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Rms force of each axis [N, N m], frequency [rad/s] and damping ratio of the oscillators.
    """
    there = q.surge > 0.0 or q.sway > 0.0 or q.roll > 0.0 or q.yaw > 0.0
    return OscillatingForce(
        q.surge, q.sway, 0.0, q.roll, 0.0, q.yaw, q.frequency if there else 0.0, q.damping
    )


@dataclass(frozen=True)
class WaveForcing(RandomForce):
    """Narrow-band wave forces in body axes, independent from axis to axis.

    F = sigma n(t),  n(t) a process of unit rms shaped by 2 z w0 s / (s^2 + 2 z w0 s + w0^2)

    sigma is the rms force of the axis, w0 the `frequency` [rad/s], z the `damping` of the filter.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} X &= \sigma_X n_1(t), \quad Y = \sigma_Y n_2(t), \quad K = "
        r"\sigma_K n_3(t), \quad N = \sigma_N n_4(t) \\ n_i(s) &\sim \frac{2 \zeta "
        r"\omega_0 s}{s^2 + 2 \zeta \omega_0 s + \omega_0^2} \quad \text{applied to white "
        r"noise, with unit rms} \end{aligned}"
    )
    symbols: ClassVar = {
        "surge": r"\sigma_X",
        "sway": r"\sigma_Y",
        "roll": r"\sigma_K",
        "yaw": r"\sigma_N",
        "frequency": r"\omega_0",
        "damping": r"\zeta",
    }
    ruled_out_by: ClassVar = {"no_waves": (True,), "no_water": (True,)}
    words: ClassVar[str] = "waves exert narrow-band forces on the hull about one frequency"
    shown_by: ClassVar[str] = "at rest without thrust"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft, 2nd ed. 2021, section 10.2: second-order wave "
        "filter"
    )
    law: ClassVar = law
    oscillating_force: ClassVar = oscillating_force
    strength: ClassVar = ("surge", "sway", "yaw", "roll")
    starts: ClassVar = tuple({"frequency": w} for w in (1.5, 2.2, 3.2, 4.5, 6.5))

    surge: float = param(
        0.0,
        low=0.0,
        high=1e7,
        unit="N",
        words="rms surge force",
        fit=True,
        spread=0.2,
        axis="surge",
    )
    sway: float = param(
        0.0, low=0.0, high=1e7, unit="N", words="rms sway force", fit=True, spread=0.2, axis="sway"
    )
    yaw: float = param(
        0.0,
        low=0.0,
        high=1e9,
        unit="N m",
        words="rms yaw moment",
        fit=True,
        spread=0.06,
        axis="yaw",
    )
    roll: float = param(
        0.0,
        low=0.0,
        high=1e9,
        unit="N m",
        words="rms roll moment",
        fit=True,
        spread=0.02,
        axis="roll",
    )
    frequency: float = param(
        3.0,
        low=0.05,
        high=20.0,
        unit="rad/s",
        words="frequency of encounter",
        fit=True,
        spread=1.5,
        inactive_value=3.0,
    )
    damping: float = param(
        0.08,
        low=0.005,
        high=0.5,
        unit="",
        words="damping ratio, the relative width of the spectrum",
        fit=True,
        spread=0.05,
        inactive_value=0.08,
    )
    realisation: float = param(
        1.0, low=0.0, high=1e9, unit="", words="number of the realisation; 0: no waves"
    )

    def wave_axes(self) -> tuple[str, ...]:
        """Return the degrees of freedom for which there is an rms force; empty if all are zero."""
        calm = self.surge == self.sway == self.roll == self.yaw == 0.0
        if calm or self.realisation == 0.0:
            return ()
        return ("surge", "sway", "roll", "yaw")

    def with_seed(self, seed: int) -> Self:
        """Return a copy of the wave forces whose random realisation follows from the seed.

        Realisation 0 (no waves) does not change.

        Args:
            seed: Seed of the scenario.
        """
        return replace(
            self,
            realisation=seeded_realisation(self.realisation, seed) if self.realisation else 0.0,
        )
