"""Heave and pitch in head waves at forward speed, from coefficients at zero speed."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from boatsim.hydrodynamics.response import linear_stiffness, rigid_body
from boatsim.physics.base import AXES, Array
from boatsim.physics.coefficients.table import Coefficients
from validation.waves.ship_speed import radiation

HEAVE, PITCH = AXES.index("heave"), AXES.index("pitch")


class Wave(NamedTuple):
    """A head wave and the speed at which the hull meets it."""

    frequency: float  # [rad/s]
    number: float  # [rad/m]
    speed: float  # [m/s]

    @property
    def encounter(self) -> float:
        """Frequency of encounter [rad/s]."""
        return self.frequency + self.number * self.speed


class SlowTable:
    """Coefficients of a hull in heave and pitch at zero speed, between frequencies by splines.

    Attributes:
        stiffness: Stiffness (2, 2).
        body: Mass matrix (2, 2).
        mass: Displaced mass [kg].
    """

    def __init__(
        self,
        found: Coefficients,
        depth: float,
        gyradius: float,
        undisturbed: Callable[[float], complex],
    ) -> None:
        """Prepare the coefficients.

        Args:
            found: Coefficients of the hull with the excitation of head waves only.
            depth: Depth of the mass centre below the waterline [m]. It lies above or below the
                centre of buoyancy.
            gyradius: Radius of gyration in pitch [m].
            undisturbed: Upward force of the undisturbed head wave per amplitude [N/m], as a complex
                amplitude for exp(i w t), as a function of the wave number [rad/m].
        """
        self.mass, self._undisturbed = found.density * found.volume, undisturbed
        inertia = self.mass * np.array([1.0, gyradius**2, gyradius**2])
        own = np.ix_([HEAVE, PITCH], [HEAVE, PITCH])
        self.stiffness = linear_stiffness(found, self.mass, depth)[own]
        self.body = rigid_body(self.mass, (float(found.buoyancy[0]), depth), inertia)[own]
        self._infinite = found.infinite_added_mass[own]
        w = found.frequency
        self._added = CubicSpline(w, found.added_mass[:, *own])
        self._damping = CubicSpline(w, found.damping[:, *own])
        self._excitation = CubicSpline(w, found.excitation[:, 0, [HEAVE, PITCH]])

    def coefficients(self, w: float) -> tuple[Array, Array]:
        """Return added mass and damping (2, 2) at zero speed.

        Args:
            w: Frequency [rad/s].
        """
        return np.array(self._added(w)), np.array(self._damping(w))

    def radiation(self, w: float, speed: float, method: str) -> Array:
        """Return the force (2, 2) of the radiated waves per motion, with the opposite sign.

        Args:
            w: Frequency of encounter [rad/s].
            speed: Forward speed [m/s].
            method: One of `ship_speed.METHODS`.
        """
        return radiation(*self.coefficients(w), self._infinite, w, speed, method)

    def excitation(self, wave: Wave, diffraction: bool = False) -> Array:
        """Return the complex excitation (2,) in heave and pitch per amplitude [N/m, N].

        Args:
            wave: The wave.
            diffraction: Whether it contains the moment of the diffraction at forward speed.
        """
        found = np.array(self._excitation(wave.frequency))
        if diffraction:
            scattered = found[0] + self._undisturbed(wave.number)  # z is down
            found[1] -= wave.speed / (1j * wave.encounter) * scattered
        return found

    def heave_and_pitch(self, wave: Wave, method: str, diffraction: bool = False) -> Array:
        """Return the complex motion (2,) per amplitude [m/m, rad/m].

        Args:
            wave: The wave.
            method: One of `ship_speed.METHODS`.
            diffraction: Whether the excitation contains the moment of the diffraction at speed.
        """
        return self.motion_under(wave, method, self.excitation(wave, diffraction))

    def motion_under(self, wave: Wave, method: str, excitation: Array) -> Array:
        """Return the complex motion (2,) per amplitude under a given excitation [m/m, rad/m].

        Args:
            wave: The wave.
            method: One of `ship_speed.METHODS`.
            excitation: Complex excitation (2,) in heave and pitch per amplitude [N/m, N].
        """
        w = wave.encounter
        dynamic = self.stiffness - w * w * self.body + self.radiation(w, wave.speed, method)
        return np.asarray(np.linalg.solve(dynamic, excitation))
