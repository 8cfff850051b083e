"""Irregular sea: long-crested wind waves that exert coherent forces in sway, yaw and roll."""

from dataclasses import dataclass, replace
from math import cos, exp, pi, sin, sqrt
from typing import Any, ClassVar, Self

from numba import njit

from boatsim.physics import particulars
from boatsim.physics.base import UNSET, Boat, Force, Wrench, param, wrench
from boatsim.physics.noise import seeded_realisation, uniform_random

LOWEST = 0.45  # lowest frequency over the modal one; less than 1e-13 of the energy lies below
GRAVITY = particulars.GRAVITY


@njit(inline="always")
def wave_slope_integrals(s: float, taper: float) -> tuple[float, float]:
    """Return the integrals of a wave's slope along a hull that give its side force and yaw moment.

    They are the integrals of (1 - taper x^2) cos(s x) and (1 - taper x^2) x sin(s x) over x in [-1,
    1], for a hull of parabolic section areas.

    Args:
        s: Wave number times half the length, along the hull [-].
        taper: Taper of the section areas [-].
    """
    if abs(s) < 0.02:  # series, because the closed forms cancel numerically
        s2 = s * s
        return 2.0 - 2.0 / 3.0 * taper - s2 * (1.0 / 3.0 - taper / 5.0), s * (
            2.0 / 3.0 - 0.4 * taper - s2 * (1.0 / 15.0 - taper / 21.0)
        )
    c, n = cos(s), sin(s)
    # halves of the integrals of cos and x^2 cos
    even = n / s
    square = n / s + 2.0 * c / s**2 - 2.0 * n / s**3
    odd = (n - s * c) / s**2
    cube = (3.0 * s * s * n - s**3 * c + 6.0 * s * c - 6.0 * n) / s**4
    return 2.0 * (even - taper * square), 2.0 * (odd - taper * cube)


@njit
def law(m: Any, q: Any) -> Wrench:
    """Return the force of an irregular, long-crested sea in sway, yaw and roll.

    It is a sum over wave components. The frequency range is divided into cells with one wave in
    each, at a random frequency inside the cell and with the energy of the spectrum in it.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    Y = K = N = 0.0
    if q.significant_height == 0.0:
        return wrench()
    ahead, across = cos(q.toward), sin(q.toward)  # direction of the waves in earth axes
    # [m] distance travelled by the ship along the direction of the waves
    run = ahead * m.x + across * m.y
    if q.course_kept != 0.0:
        run = ahead * q.speed * m.t
    else:
        ahead, across = (
            m.cos_psi * ahead + m.sin_psi * across,
            m.cos_psi * across - m.sin_psi * ahead,
        )
    modal, count = 2.0 * pi / q.modal_period, int(q.components)
    low = LOWEST * modal
    width, half = (max(q.cut, modal) - low) / count, 0.5 * q.length
    # of water, per length of hull [N]
    weight = 0.25 * pi * q.density * GRAVITY * q.draught**2 * q.length
    below = 0.0
    for k in range(count):
        w = low + width * (k + uniform_random(q.realisation, 2 * k))
        # share of the energy below the cell's upper end
        above = exp(-1.25 * (modal / (low + width * (k + 1))) ** 4)
        number = w * w / GRAVITY  # deep water
        slope = number * q.significant_height * sqrt((above - below) / 8.0)
        theta = w * m.t - number * run + 2.0 * pi * uniform_random(q.realisation, 2 * k + 1)
        up, turn = slope * sin(theta), slope * cos(theta)
        K += up
        if q.flat != 0.0:
            Y += up
        else:
            together, apart = wave_slope_integrals(number * ahead * half, q.taper)
            deep = exp(-number * q.centre_depth)
            Y += deep * together * up
            N -= deep * apart * turn
        below = above
    Y *= q.sway * across * (q.mass * GRAVITY if q.flat != 0.0 else weight)
    N *= q.yaw * across * weight * half
    return wrench(Y=Y, K=q.roll * across * q.stiffness * K + q.arm * Y, N=N)


@dataclass(frozen=True)
class IrregularSea(Force):
    """Forces of the slope of unidirectional waves of a Bretschneider spectrum.

    Sway force and yaw moment are integrals of the wave slope over the sections of an ellipsoid; the
    roll moment is the righting stiffness times the wave slope. With `course_kept` = 1 the ship
    meets the waves as on her initial course (north) at `speed`, so that `toward` is the angle of
    encounter: 0 following sea, pi / 2 beam sea, pi head sea. Otherwise her actual heading and
    position count.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} S(\omega) &= \frac{5}{16} \, H_s^2 \, "
        r"\frac{\omega_m^4}{\omega^5} \exp\left(-\frac{5}{4} \, "
        r"\frac{\omega_m^4}{\omega^4}\right) \\ s_i &= k_i \sqrt{2 S(\omega_i) "
        r"\Delta\omega_i}, \quad \theta_i = \omega_i t - k_i (x \cos\gamma + y "
        r"\sin\gamma) + \epsilon_i \\ Y &= f_Y \, w \sin\gamma_r \sum_i e^{-k_i h} "
        r"J_0(\kappa_i) \, s_i \sin\theta_i \\ N &= -f_N \, w \, \frac{L}{2} \sin\gamma_r "
        r"\sum_i e^{-k_i h} J_1(\kappa_i) \, s_i \cos\theta_i \\ K &= f_K \, m g \, GM "
        r"\sin\gamma_r \sum_i s_i \sin\theta_i + l \, Y \\ w &= \frac{\pi}{4} \rho g T^2 "
        r"L, \quad \gamma_r = \gamma - \psi, \quad \kappa_i = \tfrac{1}{2} k_i L "
        r"\cos\gamma_r \\ J_0(\kappa) &= \int_{-1}^{1} (1 - c \xi^2) \cos(\kappa \xi) \, "
        r"\mathrm{d}\xi \\ J_1(\kappa) &= \int_{-1}^{1} (1 - c \xi^2) \, \xi \sin(\kappa "
        r"\xi) \, \mathrm{d}\xi \end{aligned}"
    )
    symbols: ClassVar = {
        "significant_height": "H_s",
        "toward": r"\gamma",
        "sway": "f_Y",
        "roll": "f_K",
        "yaw": "f_N",
        "taper": "c",
        "centre_depth": "h",
        "density": r"\rho",
        "length": "L",
        "draught": "T",
        "stiffness": r"m g \, GM",
        "arm": "l",
    }
    words: ClassVar[str] = "wind waves exert sway, yaw and roll forces on the hull"
    shown_by: ClassVar[str] = "lying beam to the sea without steering"
    source: ClassVar[str] = (
        "C. R. Martin, Rudder Roll Reduction for Small Ships, UBC 1993, Appendix V"
    )
    tied_to: ClassVar[str] = "the ground, to which the phase of its waves is referred"
    law: ClassVar = law

    significant_height: float = param(
        0.0, low=0.0, high=30.0, unit="m", words="four times the rms of the elevation; 0: calm"
    )
    modal_period: float = param(
        7.5, low=0.2, high=40.0, unit="s", words="period at the peak of the elevation spectrum"
    )
    toward: float = param(
        0.0, low=-2 * pi, high=2 * pi, unit="rad", words="direction the waves run to"
    )
    course_kept: float = param(
        0.0, low=0.0, high=1.0, unit="", words="1: encounter as on course north at `speed`"
    )
    speed: float = param(
        UNSET,
        low=-50.0,
        high=50.0,
        unit="m/s",
        words="speed for course_kept = 1; default: that of the vessel's speed_hold",
        follows="speed_hold.speed?",
    )
    cut: float = param(
        3.0, low=0.0, high=100.0, unit="rad/s", words="highest frequency; shorter waves are omitted"
    )
    components: float = param(
        160.0, low=1.0, high=2000.0, unit="", words="number of wave components"
    )
    realisation: float = param(1.0, low=0.0, high=1e9, unit="", words="number of the realisation")
    sway: float = param(
        1.0, low=0.0, high=10.0, unit="", words="factor on the sway force; 1: as the formula"
    )
    roll: float = param(1.0, low=0.0, high=10.0, unit="", words="factor on the direct roll moment")
    yaw: float = param(1.0, low=0.0, high=10.0, unit="", words="factor on the yaw moment")
    flat: float = param(
        0.0, low=0.0, high=1.0, unit="", words="1: long waves, force = weight times wave slope"
    )
    taper: float = param(
        1.0, low=-10.0, high=10.0, unit="", words="section area 1 - taper (2 x / L)^2; 1: ellipsoid"
    )
    centre_depth: float = param(
        UNSET,
        low=0.0,
        high=50.0,
        unit="m",
        words="depth of the centre of buoyancy; default: 0.4 of the draught",
    )
    density: float = param(
        particulars.SEA_WATER, low=1.0, high=1500.0, unit="kg/m^3", words="density of the water"
    )
    length: float = param(
        UNSET,
        low=0.0,
        high=500.0,
        unit="m",
        words="default: that of the vessel",
        follows="vessel.length",
    )
    draught: float = param(
        UNSET,
        low=0.0,
        high=50.0,
        unit="m",
        words="default: that of the vessel",
        follows="vessel.draught",
    )
    mass: float = param(
        UNSET, low=0.0, high=1e9, unit="kg", words="mass of the vessel", follows="vessel.body.mass"
    )
    stiffness: float = param(
        UNSET,
        low=0.0,
        high=1e13,
        unit="N m",
        words="m g GM; default: that of the vessel's righting_arm",
        follows="righting_arm.stiffness?",
    )
    arm: float = param(
        UNSET,
        low=-100.0,
        high=100.0,
        unit="m",
        words="roll moment per sway force; default: that of the vessel's linear_hull",
        follows="linear_hull.arm?",
    )

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the default depth of the hull's centre of buoyancy, 0.4 of the draught.

        Args:
            vessel: Vessel on which the effect acts.
        """
        return {"centre_depth": 0.4 * self.draught}

    def with_seed(self, seed: int) -> Self:
        """Return a copy of the irregular sea whose random waves follow from the seed.

        Args:
            seed: Seed of the scenario.
        """
        return replace(self, realisation=seeded_realisation(self.realisation, seed))
