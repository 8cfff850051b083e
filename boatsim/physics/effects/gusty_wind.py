"""Gusty wind: air drag in a wind with a mean, a profile with height and random gusts."""

from dataclasses import dataclass, replace
from math import atan, cos, pi, sin, sqrt
from typing import Any, ClassVar, Self

from numba import njit

from boatsim.physics.base import Force, Wrench, param
from boatsim.physics.effects.fan_wind import AIR_DENSITY, air_drag
from boatsim.physics.gust_spectra import davenport, harris, mean_speed_at, npd
from boatsim.physics.noise import seeded_realisation, uniform_random
from boatsim.physics.param import name_code_parameter
from boatsim.physics.terms import index_code

SPECTRA = ("davenport", "harris", "npd", "none")
DAVENPORT, HARRIS, NPD, NONE = map(float, range(4))
# Range of the gusts [Hz]: from a quarter of an hour, over which a mean is taken, to two seconds,
# gusts smaller than a boat
SLOWEST, FASTEST = 1.0 / 900.0, 0.5
FIRST = 30_000  # index of the first random number, beyond those of waves
FIRST_OF_DIRECTION = 40_000  # the same of the direction, beyond those of the gusts
CELLS = 40  # of the frequency of the direction


@njit
def gust_density(frequency: float, q: Any) -> float:
    """Return the spectral density of the gusts [m^2/s].

    Args:
        frequency: Frequency [Hz].
        q: Parameters of the effect.
    """
    if q.spectrum_code == NPD:
        return float(npd(frequency, q.speed, q.height))
    if q.spectrum_code == HARRIS:
        return float(harris(frequency, q.speed))
    return float(davenport(frequency, q.speed))


@njit
def gust_speed(t: float, q: Any) -> float:
    """Return the speed of the gusts along the mean wind, less the mean [m/s].

    It is a sum of cosines in cells of equal ratio in frequency, each with the energy of its cell,
    at a random frequency in it and with a random phase.

    Args:
        t: Time [s].
        q: Parameters of the effect.
    """
    total = 0.0
    if q.spectrum_code == NONE or q.speed == 0.0:
        return total
    ratio = (FASTEST / SLOWEST) ** (1.0 / q.components)
    low = SLOWEST
    for k in range(int(q.components)):
        width = low * (ratio - 1.0)
        energy = gust_density(low * sqrt(ratio), q) * width
        frequency = low + width * uniform_random(q.realisation, FIRST + 2 * k)
        phase = 2.0 * pi * uniform_random(q.realisation, FIRST + 2 * k + 1)
        total += sqrt(2.0 * energy) * cos(2.0 * pi * frequency * t + phase)
        low *= ratio
    return total


@njit
def wind_direction(t: float, q: Any) -> float:
    """Return the direction that the air moves to [rad].

    It veers at a constant rate and varies as a process with an exponential correlation: a sum of
    cosines, each with the energy of its cell of the frequency, whose variances add up to that of
    the direction.

    Args:
        t: Time [s].
        q: Parameters of the effect.
    """
    mean = q.toward + q.veer * t
    if q.direction_sd == 0.0:
        return float(mean)
    turn = 2.0 * pi * q.direction_time
    whole = atan(turn * FASTEST) - atan(turn * SLOWEST)
    ratio = (FASTEST / SLOWEST) ** (1.0 / CELLS)
    low, total = SLOWEST, 0.0
    for k in range(CELLS):
        share = (atan(turn * low * ratio) - atan(turn * low)) / whole
        place = uniform_random(q.realisation, FIRST_OF_DIRECTION + 2 * k)
        phase = 2.0 * pi * uniform_random(q.realisation, FIRST_OF_DIRECTION + 2 * k + 1)
        frequency = low * (1.0 + (ratio - 1.0) * place)
        total += sqrt(2.0 * share) * cos(2.0 * pi * frequency * t + phase)
        low *= ratio
    return float(mean + q.direction_sd * total)


@njit
def law(m: Any, q: Any) -> Wrench:
    """Return the air drag of the hull in a gusty wind.

    It follows from the velocity of the air relative to the hull.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    speed = mean_speed_at(q.height, q.speed) + gust_speed(m.t, q)
    direction = wind_direction(m.t, q)
    north, east = speed * cos(direction), speed * sin(direction)
    along = m.cos_psi * north + m.sin_psi * east - m.u
    across = m.cos_psi * east - m.sin_psi * north - m.v
    return air_drag(along, across, AIR_DENSITY, q, q.swing)


@dataclass(frozen=True)
class GustyWind(Force):
    """Air drag of the hull in a wind whose speed has random gusts and whose direction may vary.

    The direction veers at a constant rate, and varies at random with an exponential correlation n.
    The mean speed grows with the height by the power 1 / 7. `spectrum` of the gusts is "davenport",
    "harris", "npd" (of the Norwegian Petroleum Directorate, with the height) or "none". Gusts and
    changes of direction of 2 s to 15 min are simulated; the realisation and the seed of the
    scenario give their phases.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} X &= \tfrac{1}{2} \rho \, U A_x a, \quad Y = \tfrac{1}{2} \rho "
        r"\, U A_y b, \quad N = \left(l + l_1 \frac{a}{U}\right) Y, \quad "
        r"U = \sqrt{a^2 + b^2} \\ a &= V(t) \cos(\gamma(t) - \psi) - u, \quad b = V(t) "
        r"\sin(\gamma(t) - \psi) - v \\ V(t) &= V_{10} "
        r"\left(\frac{h}{10}\right)^{1/7} + \sum_i \sqrt{2 S(f_i) \Delta f_i} \cos(2 \pi f_i t + "
        r"\epsilon_i) \\ \gamma(t) &= \gamma_0 + \dot\gamma t + \sigma_\gamma \, n(t) \end{aligned}"
    )
    symbols: ClassVar = {
        "speed": "V_{10}",
        "height": "h",
        "toward": r"\gamma_0",
        "veer": r"\dot\gamma",
        "direction_sd": r"\sigma_\gamma",
        "front": "A_x",
        "side": "A_y",
        "arm": "l",
        "swing": "l_1",
    }
    words: ClassVar[str] = "a wind with gusts exerts a drag and a yaw moment on the hull"
    shown_by: ClassVar[str] = "holding a position in the wind"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 10.1: gust "
        "spectra of Davenport 1961, Harris 1971 and NPD"
    )
    tied_to: ClassVar[str] = "the air"
    law: ClassVar = law
    of_air: ClassVar = True

    spectrum: str = "npd"  # one of SPECTRA
    speed: float = param(
        5.0, low=0.0, high=60.0, unit="m/s", words="mean speed at a height of 10 m"
    )
    toward: float = param(0.0, low=-pi, high=pi, unit="rad", words="direction the air moves to")
    veer: float = param(
        0.0, low=-1.0, high=1.0, unit="rad/s", words="rate at which the wind veers, clockwise"
    )
    direction_sd: float = param(
        0.0, low=0.0, high=1.5, unit="rad", words="standard deviation of the direction"
    )
    direction_time: float = param(
        60.0, low=1.0, high=1e5, unit="s", words="correlation time of the direction"
    )
    height: float = param(
        1.0, low=0.05, high=200.0, unit="m", words="height of the middle of the drag areas"
    )
    components: float = param(
        80.0, low=1.0, high=1000.0, unit="", words="number of gust components"
    )
    realisation: float = param(1.0, low=0.0, high=1e9, unit="", words="number of the realisation")
    front: float = param(0.021, low=0.0, high=5000.0, unit="m^2", words="frontal drag area")
    side: float = param(0.114, low=0.0, high=20000.0, unit="m^2", words="lateral drag area")
    arm: float = param(
        0.0,
        low=-200.0,
        high=200.0,
        unit="m",
        words="lever of the side force, ahead of the origin",
    )
    swing: float = param(
        0.0,
        low=-200.0,
        high=200.0,
        unit="m",
        words="additional lever with the wind from astern",
    )
    spectrum_code: float = name_code_parameter("code of the spectrum")

    def __post_init__(self) -> None:
        """Check the spectrum.

        Raises:
            BadInput: There is no such spectrum.
        """
        super().__post_init__()
        code = index_code(f"{self.name}: spectrum", self.spectrum, SPECTRA)
        object.__setattr__(self, "spectrum_code", code)

    def air_velocity(self, t: float) -> tuple[float, float]:
        """Return the velocity of the air over ground, north and east [m/s].

        Args:
            t: Time [s].
        """
        values = self.values()
        speed = mean_speed_at(self.height, self.speed) + gust_speed(t, values)
        direction = wind_direction(t, values)
        return speed * cos(direction), speed * sin(direction)

    def with_seed(self, seed: int) -> Self:
        """Return a copy of the wind whose random gusts follow from the seed.

        Args:
            seed: Seed of the scenario.
        """
        return replace(self, realisation=seeded_realisation(self.realisation, seed))
