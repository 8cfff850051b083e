"""Motion of a hull at forward speed in waves of any heading, from coefficients at zero speed.

Axes are SNAME's, about the mass centre of the hull.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from boatsim.hydrodynamics.response import linear_stiffness, rigid_body
from boatsim.physics.base import AXES, Array
from boatsim.physics.coefficients.table import Coefficients
from boatsim.physics.particulars import GRAVITY
from validation.waves.ship_speed import METHODS, ROLL

Complex = NDArray[np.complex128]
SWAY, HEAVE, PITCH, YAW = (AXES.index(name) for name in ("sway", "heave", "pitch", "yaw"))


class Wave(NamedTuple):
    """A regular wave in deep water, and the speed of the hull."""

    length: float  # [m] wavelength
    direction: float  # [rad] to which it runs, clockwise from the bow: pi from ahead
    speed: float  # [m/s] forward speed of the hull

    @property
    def number(self) -> float:
        """Wave number [rad/m]."""
        return 2.0 * np.pi / self.length

    @property
    def frequency(self) -> float:
        """Frequency [rad/s]."""
        return float(np.sqrt(GRAVITY * self.number))

    @property
    def encounter(self) -> float:
        """Frequency of encounter [rad/s]."""
        return self.frequency - self.number * self.speed * float(np.cos(self.direction))


class Loading(NamedTuple):
    """Distribution of the mass of a hull, and the damping of its roll by viscosity."""

    depth: float  # [m] of the mass centre below the waterline, negative above it
    height: float  # [m] transverse metacentric height GM
    gyradii: tuple[float, float, float]  # [m] in roll, pitch and yaw
    roll_damping: float = 0.0  # in addition to that of radiated waves, over the critical damping


def radiated_force(
    added: Array, damping: Array, limit: Array, w: float, speed: float, method: str
) -> Complex:
    """Return the force (6, 6) of the radiated waves per motion, with the opposite sign.

    Args:
        added: Added mass (6, 6) at zero speed.
        damping: Damping (6, 6) at zero speed.
        limit: Added mass (6, 6) at infinite frequency.
        w: Frequency of encounter [rad/s].
        speed: Forward speed [m/s].
        method: One of `ship_speed.METHODS`: no effect of speed, equations of motion in body axes,
            or these with the terms of forward speed of strip theory.
    """
    impedance = damping + 1j * w * added
    velocity = 1j * w * np.eye(len(AXES))
    if method == METHODS[0]:
        return np.asarray(impedance @ velocity)
    velocity[HEAVE, PITCH] += speed
    velocity[SWAY, YAW] -= speed
    force = impedance @ velocity
    momentum = limit @ velocity
    if method == METHODS[-1]:
        momentum = force / (1j * w)
    force[PITCH] -= speed * momentum[HEAVE]
    force[YAW] += speed * momentum[SWAY]
    return np.asarray(force)


def undisturbed_heave(wet: Array, wave: Wave, density: float) -> complex:
    """Return the downward force of the undisturbed wave's pressure per amplitude [N/m].

    Args:
        wet: Wetted triangles (N, 3, 3) [m] about the origin, z up from the waterline and y to port,
            counter-clockwise seen from the water.
        wave: The wave, whose crest is at the origin at the time 0.
        density: Density of the water [kg/m^3].

    Returns:
        Complex amplitude of the time dependence exp(i w t).
    """
    a, b, c = np.moveaxis(wet, 1, 0)
    up = -0.5 * np.cross(b - a, c - a)[:, 2]
    x, port, z = np.moveaxis(0.5 * np.stack([a + b, b + c, c + a], axis=1), 2, 0)
    # the wave runs to starboard for directions above 0
    along = x * np.cos(wave.direction) - port * np.sin(wave.direction)
    pressure = density * GRAVITY * np.exp(wave.number * (z - 1j * along))
    return -complex(up @ pressure.mean(axis=1))


class HullAtSpeed:
    """A hull with its coefficients at zero speed and its mass, about the mass centre.

    Attributes:
        found: Its coefficients about a point on the waterline above or below its mass centre.
        loading: Distribution of its mass.
        place: Place of the mass centre in the mesh, along x [m].
        body: Mass matrix (6, 6).
        stiffness: Stiffness (6, 6).
    """

    def __init__(self, found: Coefficients, loading: Loading, wet: Array, place: float) -> None:
        """Prepare the matrices.

        Args:
            found: Coefficients with the frequencies and directions of the waves, and the
                frequencies of encounter.
            loading: Distribution of the mass.
            wet: Wetted triangles (N, 3, 3) [m] of the mesh, as `undisturbed_heave` takes them.
            place: Place of the mass centre and of the centre of buoyancy in the mesh, along x [m].
        """
        self.found, self.loading, self.place = found, loading, place
        self._wet = wet - np.array([place, 0.0, 0.0])
        mass = found.density * found.volume
        inertia = mass * np.array(loading.gyradii) ** 2
        self.body = rigid_body(mass, (0.0, 0.0), inertia)
        self.stiffness = self._about_centre(linear_stiffness(found, mass, loading.depth))
        self.stiffness[ROLL, ROLL] = mass * GRAVITY * loading.height

    def _about_centre(self, matrix: Array) -> Array:
        """Return a matrix (6, 6) about the waterline as one about the mass centre."""
        lever = self._lever()
        return np.asarray(lever.T @ matrix @ lever)

    def _lever(self) -> Array:
        """Motion (6, 6) of the origin on the waterline per motion of the mass centre."""
        lever = np.eye(len(AXES))
        lever[AXES.index("surge"), PITCH] = -self.loading.depth
        lever[SWAY, ROLL] = self.loading.depth
        return lever

    def coefficients(self, w: float) -> tuple[Array, Array]:
        """Return added mass and damping (6, 6) at zero speed about the mass centre.

        Args:
            w: Frequency [rad/s], one of those of the coefficients.
        """
        row = self._row(w)
        added, damping = self.found.added_mass[row], self.found.damping[row]
        return self._about_centre(added), self._about_centre(damping)

    def _row(self, w: float) -> int:
        return int(np.argmin(np.abs(self.found.frequency - w)))

    def excitation(self, wave: Wave, diffraction: bool = False) -> Complex:
        """Return the complex excitation (6,) per amplitude at zero speed [N/m, N].

        Args:
            wave: The wave.
            diffraction: Whether it contains the moment in pitch of the diffraction at speed.
        """
        column = int(np.argmin(np.abs(self.found.heading - wave.direction)))
        own = self.found.excitation[self._row(wave.frequency), column]
        force = self._lever().T @ own
        if diffraction:
            scattered = force[HEAVE] - undisturbed_heave(self._wet, wave, self.found.density)
            force[PITCH] -= wave.speed / (1j * wave.encounter) * scattered
        return np.asarray(force)

    def motion(
        self,
        wave: Wave,
        free: tuple[str, ...],
        method: str,
        diffraction: bool = False,
        excitation: Array | None = None,
    ) -> Complex:
        """Return the complex motion (6,) of the mass centre per amplitude [m/m, rad/m].

        Args:
            wave: The wave.
            free: Degrees of freedom that are not held.
            method: One of `ship_speed.METHODS`.
            diffraction: Whether the excitation contains the moment of the diffraction at speed.
            excitation: Excitation (6,) about the waterline that takes the place of that at rest;
                None for that at rest.
        """
        w = wave.encounter
        added, damping = self.coefficients(w)
        limit = self._about_centre(self.found.infinite_added_mass)
        inertia = self.body[ROLL, ROLL] + added[ROLL, ROLL]
        critical = 2.0 * np.sqrt(self.stiffness[ROLL, ROLL] * inertia)
        radiated = radiated_force(added, damping, limit, w, wave.speed, method)
        dynamic = self.stiffness - w * w * self.body + radiated
        dynamic[ROLL, ROLL] += 1j * w * self.loading.roll_damping * critical
        places = [AXES.index(axis) for axis in free]
        found = np.zeros(len(AXES), dtype=np.complex128)
        force = self.excitation(wave, diffraction)
        if excitation is not None:
            force = np.asarray(self._lever().T @ excitation, dtype=np.complex128)
        found[places] = np.linalg.solve(dynamic[np.ix_(places, places)], force[places])
        return found
