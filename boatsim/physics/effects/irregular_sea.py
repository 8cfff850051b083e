"""Irregular sea: wind waves and swell that exert coherent forces in sway, yaw and roll."""

from dataclasses import dataclass, replace
from math import cos, pi, sin
from typing import Any, ClassVar

import numpy as np
from numba import njit

from boatsim.physics import particulars
from boatsim.physics.base import UNSET, Array, Boat, Force, Wrench, param, wrench
from boatsim.physics.waves.dispersion import pressure_attenuation, wave_number
from boatsim.physics.waves.encounter import heading_of_waves
from boatsim.physics.waves.field import WaveField
from boatsim.physics.waves.hull_integrals import beam_attenuation, wave_slope_integrals
from boatsim.physics.waves.sea_parameters import SeaParameters
from boatsim.physics.waves.sea_state import (
    has_directions,
    sea_state,
    wave_component,
    wave_direction,
)

GRAVITY = particulars.GRAVITY


@njit(forceinline=True)
def heading_of_encounter(bearing: float, m: Any, q: Any) -> tuple[float, float, float]:
    """Return the direction of waves in body axes, and the ship's place along it.

    With `course_kept` = 1 they are those on her initial course.

    Args:
        bearing: Direction to which the waves run [rad].
        m: Motion of the hull.
        q: Parameters of the effect.

    Returns:
        Parts of the direction ahead and to starboard, and the distance [m] travelled by the ship
        through the water along the direction of the waves.
    """
    if q.course_kept != 0.0:
        ahead = cos(bearing)
        return ahead, sin(bearing), ahead * q.speed * m.t
    return heading_of_waves(bearing, m)


@njit
def law(m: Any, q: Any, p: Array, first: Any) -> Wrench:
    """Return the force of an irregular sea in sway, yaw and roll.

    It is a sum over wave components. The waves travel on the water, which moves with the current:
    the position along them is that relative to the water, from the origin at t = 0.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        p: Parameters and tables of all effects.
        first: Index of the effect's table.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    Y = K = N = 0.0
    if q.significant_height == 0.0:
        return wrench()
    ahead, across, run = heading_of_encounter(q.toward, m, q)
    half = 0.5 * q.length
    # of water, per length of hull [N]
    weight = 0.25 * pi * q.density * GRAVITY * q.draught**2 * q.length
    sea = sea_state(q, p, first)
    for k in range(int(sea.number)):
        w, amplitude, phase = wave_component(k, q, sea, p, first)
        if has_directions(q):
            ahead, across, run = heading_of_encounter(wave_direction(k, q, p, first), m, q)
        number = wave_number(w, q.depth)
        slope = number * amplitude * across
        theta = w * m.t - number * run + phase
        up, turn = slope * sin(theta), slope * cos(theta)
        if q.flat != 0.0:
            Y += up
            K += up
        else:
            together, apart = wave_slope_integrals(number * ahead * half, q.taper)
            deep = pressure_attenuation(number, q.centre_depth, q.depth)
            Y += deep * together * up
            N -= deep * apart * turn
            sides = beam_attenuation(0.5 * number * across * q.beam)
            K += pressure_attenuation(number, q.roll_depth, q.depth) * sides * up
    Y *= q.sway * (q.mass * GRAVITY if q.flat != 0.0 else weight)
    N *= q.yaw * weight * half
    return wrench(Y=Y, K=q.roll * q.stiffness * K + q.arm * Y, N=N)


@dataclass(frozen=True)
class IrregularSea(SeaParameters, Force):
    """Forces of the slope of the waves of a spectrum, of one direction or spread about it.

    Sway force and yaw moment are integrals of the wave slope over the sections of an ellipsoid. The
    roll moment is the righting stiffness times the wave slope at midship, exp(-k T) times that at
    the surface, and B(s), the mean over the beam: on a section of breadth b the pressure of the
    elevation a sin(k |sin beta| y) has the moment rho g a integral y sin(k |sin beta| y) dy, and
    3 (sin s - s cos s) / s^3, s = k b |sin beta| / 2, is its ratio to that of a plane with the
    slope a k |sin beta|. With `flat` = 1 the waves are long compared with the hull, and no force is
    attenuated.

    `spectrum` is "bretschneider" (by height and period), "pierson_moskowitz" (a fully developed
    sea, whose period follows from the height), "jonswap" (with the peak enhancement `gamma`),
    "torsethaugen" (wind sea and swell of the open ocean) or "regular": one wave of
    `significant_height` from trough to crest, with its crest at the origin at t = 0. With
    "tabulated" it is that of the file `spectrum_file`, whose height holds if none is given, and
    whose directions are turned by `toward`. The realisation and the seed of the scenario give the
    frequencies inside their cells and the phases, with `spreading` the directions, and with
    `random_amplitudes` = 1 the amplitudes. Each component has one direction.

    The spectrum ends at `cut`, by default at four times the modal frequency, and that of
    Torsethaugen where 0.5 % of the energy lies above; a cut above which more than 2 % of the energy
    lies is refused. In water of a `depth` the wave number k follows from w^2 = g k tanh(k h), and
    the pressure decreases by cosh k (h - z) / cosh k h instead of exp(-k z).

    The waves travel on the water, with the current. The elevation of their surface, which
    `boatsim.wave_field` gives at any place and time, is the one whose slope exerts the force. With
    `course_kept` = 1 the ship meets the waves as on her initial course (north) at `speed`, so that
    `toward` is the angle of encounter: 0 following sea, pi / 2 beam sea, pi head sea. Otherwise her
    actual heading and position count.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} S(\omega) &= \frac{5}{16} \, H_s^2 \, \frac{\omega_m^4}{\omega^5} "
        r"\exp\left(-\frac{5}{4} \, \frac{\omega_m^4}{\omega^4}\right), \quad \omega \le \omega_c "
        r"\quad \text{(or another spectrum)} "
        r"\\ a_i &= \sqrt{2 S(\omega_i) \Delta\omega_i}, \quad s_i = k_i a_i, \quad \omega_i^2 = g "
        r"k_i \tanh k_i d, \quad \gamma_i \sim \cos^n(\gamma_i - \gamma) "
        r"\\ \theta_i &= \omega_i t - k_i \left((x - V_N t) \cos\gamma_i + (y - V_E t) "
        r"\sin\gamma_i\right) + \epsilon_i, \quad \eta = -\sum_i a_i \cos\theta_i "
        r"\\ Y &= f_Y \, w \sum_i e^{-k_i h} J_0(\kappa_i) \, s_i \sin\beta_i \sin\theta_i "
        r"\\ N &= -f_N \, w \, \frac{L}{2} \sum_i e^{-k_i h} J_1(\kappa_i) \, s_i \sin\beta_i "
        r"\cos\theta_i "
        r"\\ K &= f_K \, m g \, GM \sum_i e^{-k_i h_K} B(\sigma_i) \, s_i \sin\beta_i "
        r"\sin\theta_i + l \, Y "
        r"\\ w &= \frac{\pi}{4} \rho g T^2 L, \quad \beta_i = \gamma_i - \psi "
        r"\\ \kappa_i &= \tfrac{1}{2} k_i L \cos\beta_i, \quad "
        r"\sigma_i = \tfrac{1}{2} k_i b \left|\sin\beta_i\right| "
        r"\\ J_0(\kappa) &= \int_{-1}^{1} (1 - c \xi^2) \cos(\kappa \xi) \, \mathrm{d}\xi "
        r"\\ J_1(\kappa) &= \int_{-1}^{1} (1 - c \xi^2) \, \xi \sin(\kappa \xi) \, \mathrm{d}\xi "
        r"\\ B(\sigma) &= 3 \, \frac{\sin\sigma - \sigma \cos\sigma}{\sigma^3} \end{aligned}"
    )
    symbols: ClassVar = {
        "significant_height": "H_s",
        "toward": r"\gamma",
        "cut": r"\omega_c",
        "spreading": "n",
        "depth": "d",
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
    sees_table: ClassVar[bool] = True
    law: ClassVar = law

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

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the default depths of the sway force and of the roll moment.

        Args:
            vessel: Vessel on which the effect acts.

        Returns:
            `centre_depth`, 0.4 of the draught, and `roll_depth`, the draught [m].
        """
        return {"centre_depth": 0.4 * self.draught, "roll_depth": self.draught}

    def table(self) -> tuple[float, ...]:
        """Return the table of a tabulated sea."""
        return self.sea_table()

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

    def wave_field(self) -> WaveField | None:
        """Return the waves of the sea; None if it is calm.

        With `course_kept` = 1 it is the elevation that the ship meets on her initial course, the
        same at all places.
        """
        field = super().wave_field()
        if field is None or not self.course_kept:
            return field
        frequency = field.frequency - field.wave_number * np.cos(field.direction) * self.speed
        return replace(field, frequency=frequency, wave_number=0.0 * field.wave_number)
