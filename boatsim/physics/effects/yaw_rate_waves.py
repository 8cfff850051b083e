"""Yaw-rate waves: irregular sea that adds a narrow-band yaw rate to that of the hull."""

from dataclasses import dataclass, replace
from math import cos, hypot, pi, sin, sqrt
from typing import Any, ClassVar, Self

from numba import njit

from boatsim.physics.base import UNSET, Boat, OscillatingForce, RandomForce, Wrench, param, wrench
from boatsim.physics.noise import random_spectral_line, seeded_realisation, uniform_random

WAVES = 64  # components of the realisation
# index of the first random number, beyond those of other effects with the same realisation
FIRST = 20_000


@njit(inline="always")
def wave_component(k: int, q: Any) -> tuple[float, float, float]:
    """Return frequency [rad/s], amplitude [rad/s] and phase [rad] of one cosine of wave yaw rate.

    The frequency is the middle of its part of the spectrum. The moment grows with the frequency, so
    that one sampled at random near the ends of the spectrum, which reach zero and infinity, would
    exceed all others.

    Args:
        k: Number of the component.
        q: Parameters of the effect.
    """
    w, weight = random_spectral_line((k + 0.5) / WAVES - 0.5, q.damping)
    return (
        q.frequency * w,
        q.rms * sqrt(2.0 * weight / WAVES),
        2.0 * pi * uniform_random(q.realisation, FIRST + k),
    )


@njit
def law(m: Any, q: Any) -> Wrench:
    """Return the yaw moment by which waves add a narrow-band yaw rate r_w to that of the hull.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    N = 0.0
    if q.realisation == 0.0 or q.rms == 0.0:
        return wrench(N=N)
    for k in range(WAVES):
        w, size, phase = wave_component(k, q)
        N += size * (q.drag * cos(w * m.t + phase) - q.inertia * w * sin(w * m.t + phase))
    return wrench(N=N)


@njit(inline="always")
def oscillating_force(q: Any) -> OscillatingForce:
    """Return the oscillator by which the diagnosis filter models the yaw moment of waves.

    There is none if the waves have zero amplitude.

    Args:
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Rms force of each axis [N, N m], frequency [rad/s] and damping ratio of the oscillators.
    """
    moment = q.rms * hypot(q.inertia * q.frequency, q.drag)
    return OscillatingForce(
        0.0, 0.0, 0.0, 0.0, 0.0, moment, q.frequency if q.rms > 0.0 else 0.0, q.damping
    )


@dataclass(frozen=True)
class YawRateWaves(RandomForce):
    """Wave-induced yaw rate of a second-order filter, as the moment that causes it.

    r_w(s) = kappa s / (s^2 + 2 lambda_w omega_w s + omega_w^2) applied to white noise
    N = I r_w' + d r_w

    I is the yaw inertia with the added one, d the linear yaw damping of the vessel.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} N &= \left(I_z - N_{\dot r}\right) \dot{r_w} + d_r r_w \\ "
        r"r_w(s) &\sim \frac{\kappa s}{s^2 + 2 \lambda_w \omega_w s + \omega_w^2} \quad "
        r"\text{applied to white noise} \end{aligned}"
    )
    symbols: ClassVar = {
        "frequency": r"\omega_w",
        "damping": r"\lambda_w",
        "inertia": r"\left(I_z - N_{\dot r}\right)",
        "drag": "d_r",
    }
    words: ClassVar[str] = "waves cause a narrow-band yaw rate about one frequency"
    shown_by: ClassVar[str] = "holding a heading"
    source: ClassVar[str] = "L. R. S. Theisen, R. Galeazzi, M. Blanke, IFAC CAMS 2013, equation 8"
    law: ClassVar = law
    oscillating_force: ClassVar = oscillating_force
    strength: ClassVar = ("rms",)

    rms: float = param(0.0, low=0.0, high=10.0, unit="rad/s", words="rms of the wave yaw rate r_w")
    frequency: float = param(
        3.0, low=0.05, high=20.0, unit="rad/s", words="natural frequency of the filter, omega_w"
    )
    damping: float = param(
        0.1, low=0.005, high=0.9, unit="", words="damping ratio of the filter, lambda_w"
    )
    inertia: float = param(
        UNSET,
        low=0.0,
        high=1e13,
        unit="kg m^2",
        words="yaw inertia with added inertia; default: that of the vessel",
    )
    drag: float = param(
        UNSET,
        low=0.0,
        high=1e13,
        unit="N m s",
        words="linear yaw damping of the vessel",
        follows="linear_damping.yaw",
    )
    realisation: float = param(
        1.0, low=0.0, high=1e9, unit="", words="number of the realisation; 0: no waves"
    )

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the default yaw inertia of the hull in waves, with its added inertia.

        Args:
            vessel: Vessel with a body.
        """
        yaw, sway, at = (
            self.inherited_value(f"added_mass.{key}?", vessel) for key in ("yaw", "sway", "sway_at")
        )
        return {"inertia": vessel.body.yaw_inertia + (yaw + sway * at**2)}

    def wave_axes(self) -> tuple[str, ...]:
        """Return the degree of freedom in which the waves act, yaw; empty if there are none."""
        if self.rms == 0.0 or self.realisation == 0.0:
            return ()
        return ("yaw",)

    def with_seed(self, seed: int) -> Self:
        """Return a copy of the wave yaw rate whose random realisation follows from the seed.

        Realisation 0 (no waves) does not change.

        Args:
            seed: Seed of the scenario.
        """
        return replace(
            self,
            realisation=seeded_realisation(self.realisation, seed) if self.realisation else 0.0,
        )
