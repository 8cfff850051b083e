"""A boat on two pontoons in all six freedoms: restoring, damping, cross-flow drag and two propellers from a data file.

The laws are those of Fossen's Otter (Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, and his MSS toolbox).
"""

from math import exp

import numpy as np
from pydantic import Field, PositiveFloat

from boatsim.files import Table, checked, read_toml
from boatsim.physics.base import Array
from boatsim.physics.content import root
from boatsim.physics.effects.cross_flow_drag import panel
from boatsim.simulate.free_body import FreeBody, Solid

Three = tuple[float, float, float]
Six = tuple[float, float, float, float, float, float]


class BodyTable(Table):
    """Rigid body about the origin."""

    mass: PositiveFloat  # [kg]
    centre: Three  # [m]
    gyration: Three  # [m] about the mass centre


class WaterTable(Table):
    """What the water does to the hull."""

    density: PositiveFloat  # [kg/m^3]
    gravity: PositiveFloat  # [m/s^2]
    added_mass: Six  # [kg, kg m^2] about the origin
    damping: Six  # [N s/m, N m s]
    yaw_growth: float = Field(ge=0)  # [s/rad]
    section_drag_coefficient: float = Field(ge=0)
    stations: int = Field(default=0, ge=0)  # of the trapezoidal rule along a pontoon; 0: the exact integral


class PontoonTable(Table):
    """Two equal pontoons."""

    length: PositiveFloat  # [m]
    beam: PositiveFloat  # [m]
    offset: PositiveFloat  # [m] of each from the centre line
    waterline_coefficient: PositiveFloat
    block_coefficient: PositiveFloat
    flotation: float  # [m]
    fullness: PositiveFloat


class PropellerTable(Table):
    """Two equal propellers, one behind each pontoon."""

    ahead: float  # [N s^2/rad^2]
    astern: float  # [N s^2/rad^2]
    lag: PositiveFloat  # [s]


class PontoonBoat(Table):
    """The content of a free_body.toml."""

    about: str
    source: str
    body: BodyTable
    water: WaterTable
    pontoons: PontoonTable
    propellers: PropellerTable

    @property
    def inertia(self) -> Array:
        """(3,) kg m^2 about the mass centre."""
        return self.body.mass * np.array(self.body.gyration) ** 2

    @property
    def draught(self) -> float:
        """[m] at which the pontoons carry the boat."""
        p = self.pontoons
        return self.body.mass / self.water.density / (2.0 * p.block_coefficient * p.beam * p.length)

    def stiffness(self) -> Array:
        """(6, 6) N/m, N, N m restoring about the origin, of heave, roll and pitch in the centre of flotation."""
        p, k = self.pontoons, self.water.density * self.water.gravity
        c, plane, volume = p.waterline_coefficient, p.length * p.beam, self.body.mass / self.water.density
        across = p.length * p.beam**3 / 6.0 * 6.0 * c**3 / ((1.0 + c) * (1.0 + 2.0 * c)) + 2.0 * c * plane * p.offset**2
        along = p.fullness * p.beam * p.length**3 / 6.0
        buoyancy = (2.5 * self.draught - 0.5 * volume / plane) / 3.0  # [m] its centre above the keel
        below = buoyancy - self.draught + self.body.centre[2]  # [m] above the mass centre
        G = np.diag([0.0, 0.0, k * 2.0 * c * plane, k * (across + volume * below), k * (along + volume * below), 0.0])
        H = np.eye(6)
        H[2, 4] = -p.flotation  # heave of that point
        return np.asarray(H.T @ G @ H)

    def drag(self, nu: Array) -> Array:
        """(6,) linear damping, growing with the yaw rate in yaw, and cross-flow drag in sway-yaw and heave-pitch."""
        w, half = self.water, 0.5 * self.pontoons.length
        found = -np.array(w.damping) * nu
        found[5] *= 1.0 + w.yaw_growth * abs(nu[5])
        k = 0.5 * w.density * self.draught * w.section_drag_coefficient
        sway, yaw = strips(nu[1], nu[5], half, w.stations)
        heave, pitch = strips(nu[2], -nu[4], half, w.stations)  # a bow that rises moves up
        return found - k * np.array([0.0, sway, heave, 0.0, -pitch, yaw])

    def launched(self, port: float, starboard: float, step: float = 0.02) -> FreeBody:
        """At rest on still water; at t = 0 its propellers are told to turn at these rates [rad/s]."""
        body, G = self.body, self.stiffness()
        solid = Solid(body.mass, np.array(body.centre), self.inertia, np.diag(self.water.added_mass))

        def law(t: float, pose: Array, nu: Array) -> Array:
            reached = 1.0 - exp(-t / self.propellers.lag)
            return self.thrust(reached * port, reached * starboard) + self.drag(nu) - G @ pose

        return FreeBody(solid, law, step)

    def thrust(self, port: float, starboard: float) -> Array:
        """(6,) of two propellers that turn at these rates [rad/s]; more to port turns to starboard."""
        k = self.propellers
        left, right = (n * abs(n) * (k.ahead if n > 0.0 else k.astern) for n in (port, starboard))
        return np.array([left + right, 0.0, 0.0, 0.0, 0.0, self.pontoons.offset * (left - right)])


def otter() -> PontoonBoat:
    """The shipped boat."""
    path = root() / "models" / "otter" / "free_body.toml"
    return checked(PontoonBoat, read_toml(path), "otter/free_body.toml")


def strips(v: float, r: float, half: float, stations: int) -> tuple[float, float]:
    """Integrals of w|w| and x w|w|, w = v + x r, over the length: exact, or by the trapezoidal rule."""
    if stations:
        x = np.linspace(-half, half, stations)
        f = (v + x * r) * np.abs(v + x * r)
        return float(np.trapezoid(f, x)), float(np.trapezoid(x * f, x))
    turn = min(max(-v / r, -half), half) if r else -half  # the cross flow changes sign there
    (aft, aft_moment), (fore, fore_moment) = panel(-half, turn, v, r), panel(turn, half, v, r)
    return aft + fore, aft_moment + fore_moment
