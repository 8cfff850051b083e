"""Irregular sea: long-crested wind waves that exert coherent forces in sway, yaw and roll."""

from dataclasses import dataclass, replace
from math import cos, exp, log, pi, sin, sqrt
from typing import Any, ClassVar, Self

from numba import njit

from boatsim.errors import BadInput
from boatsim.physics import particulars
from boatsim.physics.base import UNSET, Boat, Force, Wrench, param, wrench
from boatsim.physics.noise import seeded_realisation, uniform_random

LOWEST = 0.45  # lowest frequency over the modal one; less than 1e-13 of the energy lies below
HIGHEST = 4.0  # default cut over the modal frequency; 0.5 % of the energy lies above
# Largest share of the energy above the cut: the significant height is then 1 % too low
MOST_LOST = 0.02
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


@njit(inline="always")
def beam_attenuation(s: float) -> float:
    """Return the roll moment of a wave on a section over that of a plane with the wave's slope.

    It is 3 (sin s - s cos s) / s^3: the integral of y sin(2 s y / b) over the breadth b, divided by
    that of y (2 s y / b).

    Args:
        s: Wave number across the hull times half the breadth [-].
    """
    if abs(s) < 0.05:  # series, because the closed form cancels numerically
        return 1.0 - s * s / 10.0 + s**4 / 280.0
    return 3.0 * (sin(s) - s * cos(s)) / s**3


@njit(inline="always")
def frequency_range(q: Any) -> tuple[float, float]:
    """Return the lowest and the highest frequency of the waves [rad/s].

    Args:
        q: Parameters of the effect.
    """
    modal = 2.0 * pi / q.modal_period
    if q.cut > 0.0:
        return LOWEST * modal, max(q.cut, modal)
    return LOWEST * modal, HIGHEST * modal


@njit(inline="always")
def wave_component(k: int, q: Any) -> tuple[float, float, float]:
    """Return frequency [rad/s], amplitude [m] and phase [rad] of one wave of the sea.

    Each of the `components` cells of equal width in frequency has one wave, at a random frequency
    inside the cell and with the energy of the spectrum in it.

    Args:
        k: Number of the wave, from 0.
        q: Parameters of the effect.
    """
    low, high = frequency_range(q)
    modal, width = 2.0 * pi / q.modal_period, (high - low) / int(q.components)
    below = 0.0  # share of the energy below the cell
    if k > 0:
        below = exp(-1.25 * (modal / (low + width * k)) ** 4)
    above = exp(-1.25 * (modal / (low + width * (k + 1))) ** 4)
    return (
        low + width * (k + uniform_random(q.realisation, 2 * k)),
        q.significant_height * sqrt((above - below) / 8.0),
        2.0 * pi * uniform_random(q.realisation, 2 * k + 1),
    )


@njit
def law(m: Any, q: Any) -> Wrench:
    """Return the force of an irregular, long-crested sea in sway, yaw and roll.

    It is a sum over wave components. The waves travel on the water, which moves with the current:
    the position along them is that relative to the water, from the origin at t = 0.

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
    # [m] distance travelled by the ship through the water along the direction of the waves
    run = ahead * (m.x - m.water_north * m.t) + across * (m.y - m.water_east * m.t)
    if q.course_kept != 0.0:
        run = ahead * q.speed * m.t
    else:
        ahead, across = (
            m.cos_psi * ahead + m.sin_psi * across,
            m.cos_psi * across - m.sin_psi * ahead,
        )
    half = 0.5 * q.length
    # of water, per length of hull [N]
    weight = 0.25 * pi * q.density * GRAVITY * q.draught**2 * q.length
    for k in range(int(q.components)):
        w, amplitude, phase = wave_component(k, q)
        number = w * w / GRAVITY  # deep water
        slope = number * amplitude
        theta = w * m.t - number * run + phase
        up, turn = slope * sin(theta), slope * cos(theta)
        if q.flat != 0.0:
            Y += up
            K += up
        else:
            together, apart = wave_slope_integrals(number * ahead * half, q.taper)
            deep = exp(-number * q.centre_depth)
            Y += deep * together * up
            N -= deep * apart * turn
            sides = beam_attenuation(0.5 * number * across * q.beam)
            K += exp(-number * q.roll_depth) * sides * up
    Y *= q.sway * across * (q.mass * GRAVITY if q.flat != 0.0 else weight)
    N *= q.yaw * across * weight * half
    return wrench(Y=Y, K=q.roll * across * q.stiffness * K + q.arm * Y, N=N)


@dataclass(frozen=True)
class IrregularSea(Force):
    """Forces of the slope of unidirectional waves of a Bretschneider spectrum.

    Sway force and yaw moment are integrals of the wave slope over the sections of an ellipsoid. The
    roll moment is the righting stiffness times the wave slope at midship, exp(-k T) times that at
    the surface, and B(s), the mean over the beam: on a section of breadth b the pressure of the
    elevation a sin(k |sin gamma_r| y) has the moment rho g a integral y sin(k |sin gamma_r| y) dy,
    and 3 (sin s - s cos s) / s^3, s = k b |sin gamma_r| / 2, is its ratio to that of a plane with
    the slope a k |sin gamma_r|. With `flat` = 1 the waves are long compared with the hull, and no
    force is attenuated.

    The spectrum ends at `cut`, by default at four times the modal frequency; a cut above which more
    than 2 % of the energy lies is refused. The waves travel on the water, with the current. With
    `course_kept` = 1 the ship meets the waves as on her initial course (north) at `speed`, so that
    `toward` is the angle of encounter: 0 following sea, pi / 2 beam sea, pi head sea. Otherwise her
    actual heading and position count.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} S(\omega) &= \frac{5}{16} \, H_s^2 \, \frac{\omega_m^4}{\omega^5} "
        r"\exp\left(-\frac{5}{4} \, \frac{\omega_m^4}{\omega^4}\right), \quad \omega \le \omega_c "
        r"\\ s_i &= k_i \sqrt{2 S(\omega_i) \Delta\omega_i} "
        r"\\ \theta_i &= \omega_i t - k_i \left((x - V_N t) \cos\gamma + (y - V_E t) "
        r"\sin\gamma\right) + \epsilon_i "
        r"\\ Y &= f_Y \, w \sin\gamma_r \sum_i e^{-k_i h} J_0(\kappa_i) \, s_i \sin\theta_i "
        r"\\ N &= -f_N \, w \, \frac{L}{2} \sin\gamma_r \sum_i e^{-k_i h} J_1(\kappa_i) \, s_i "
        r"\cos\theta_i "
        r"\\ K &= f_K \, m g \, GM \sin\gamma_r \sum_i e^{-k_i h_K} B(\sigma_i) \, s_i "
        r"\sin\theta_i + l \, Y "
        r"\\ w &= \frac{\pi}{4} \rho g T^2 L, \quad \gamma_r = \gamma - \psi "
        r"\\ \kappa_i &= \tfrac{1}{2} k_i L \cos\gamma_r, \quad "
        r"\sigma_i = \tfrac{1}{2} k_i b \left|\sin\gamma_r\right| "
        r"\\ J_0(\kappa) &= \int_{-1}^{1} (1 - c \xi^2) \cos(\kappa \xi) \, \mathrm{d}\xi "
        r"\\ J_1(\kappa) &= \int_{-1}^{1} (1 - c \xi^2) \, \xi \sin(\kappa \xi) \, \mathrm{d}\xi "
        r"\\ B(\sigma) &= 3 \, \frac{\sin\sigma - \sigma \cos\sigma}{\sigma^3} \end{aligned}"
    )
    symbols: ClassVar = {
        "significant_height": "H_s",
        "toward": r"\gamma",
        "cut": r"\omega_c",
        "sway": "f_Y",
        "roll": "f_K",
        "yaw": "f_N",
        "taper": "c",
        "centre_depth": "h",
        "roll_depth": "h_K",
        "beam": "b",
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
        0.0,
        low=0.0,
        high=200.0,
        unit="rad/s",
        words="highest frequency; 0: four times the modal frequency",
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
    roll_depth: float = param(
        UNSET,
        low=0.0,
        high=50.0,
        unit="m",
        words="depth at which the slope for the roll moment is taken; default: the draught",
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
    beam: float = param(
        UNSET,
        low=0.0,
        high=100.0,
        unit="m",
        words="breadth over which the roll moment is averaged; default: that of the vessel",
        follows="vessel.beam",
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

    def __post_init__(self) -> None:
        """Check that the waves up to the cut have nearly all energy of the spectrum.

        Raises:
            BadInput: More than 2 % of the energy lies above the cut.
        """
        super().__post_init__()
        if self.significant_height == 0.0 or self.cut == 0.0:
            return
        modal = 2.0 * pi / self.modal_period
        lost = 1.0 - exp(-1.25 * (modal / self.cut) ** 4)
        if lost > MOST_LOST:
            lowest = modal * (-1.25 / log(1.0 - MOST_LOST)) ** 0.25
            raise BadInput(
                f"{self.name}.cut = {self.cut:g} rad/s omits {100.0 * lost:.0f} % of the energy of "
                f"waves of {self.modal_period:g} s; allowed is at least {lowest:.3g} rad/s, "
                f"or 0 for {HIGHEST:g} times the modal frequency"
            )

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the default depths of the sway force and of the roll moment.

        Args:
            vessel: Vessel on which the effect acts.

        Returns:
            `centre_depth`, 0.4 of the draught, and `roll_depth`, the draught [m].
        """
        return {"centre_depth": 0.4 * self.draught, "roll_depth": self.draught}

    def wave_axes(self) -> tuple[str, ...]:
        """Return the degrees of freedom in which the sea exerts a force; empty if it is calm.

        Yaw has none in long waves (`flat`), roll none without a righting stiffness or a lever.
        """
        if self.significant_height == 0.0:
            return ()
        axes = ["sway"]
        if self.stiffness > 0.0 or self.arm != 0.0:
            axes.append("roll")
        if self.flat == 0.0:
            axes.append("yaw")
        return tuple(axes)

    def with_seed(self, seed: int) -> Self:
        """Return a copy of the irregular sea whose random waves follow from the seed.

        Args:
            seed: Seed of the scenario.
        """
        return replace(self, realisation=seeded_realisation(self.realisation, seed))
