"""A floating truncated vertical cylinder by expansions in eigenfunctions, independent of panels.

The water is divided at the cylinder's radius. Outside, the potential is a sum of the propagating
wave and of evanescent modes over the depth; below the cylinder it is a sum of modes over the gap to
the bed. The potential and its radial derivative are continuous between the two. Sources: C. J. R.
Garrett, Wave forces on a circular dock, J. Fluid Mech. 46, 1971 (diffraction); R. W. Yeung, Added
mass and damping of a vertical cylinder in finite-depth waters, Applied Ocean Research 3(3), 1981
(radiation).

Heights u are counted from the bed, time dependence is exp(i w t), and potentials are those of unit
velocity or of a wave of unit amplitude with its crest at the axis at t = 0, which runs along x.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import h2vp, hankel2, ive, jv, jvp, kve

from boatsim.physics.base import Array
from boatsim.physics.particulars import GRAVITY

Complex = NDArray[np.complex128]
MODES = 400  # of each region; half as many change surge and heave by 0.03 %, pitch by 0.5 % at most
SURGE, HEAVE, PITCH = 0, 2, 4  # rows of the matrices


class Cylinder(NamedTuple):
    """A cylinder in water of a finite depth."""

    radius: float  # [m]
    draught: float  # [m]
    depth: float  # [m]
    density: float = 1000.0  # [kg/m^3]

    @property
    def gap(self) -> float:
        """Height of the water below the cylinder [m]."""
        return self.depth - self.draught

    @property
    def share(self) -> float:
        """That height over the depth."""
        return self.gap / self.depth

    @property
    def volume(self) -> float:
        """Displaced volume [m^3]."""
        return float(np.pi * self.radius**2 * self.draught)


class CylinderCoefficients(NamedTuple):
    """Coefficients of a cylinder at one frequency, in SNAME axes about the waterline's centre."""

    added_mass: Array  # (6, 6) [kg, kg m, kg m^2]
    damping: Array  # (6, 6) [N s/m, N s, N m s]
    excitation: Complex  # (6,) [N/m, N] of a wave that runs forward


class Modes(NamedTuple):
    """Modes of both regions at one frequency, and what they have in common."""

    wave: float  # wave number [rad/m]
    decay: Array  # wave numbers of the evanescent modes (N,) [rad/m]
    norm: Array  # (N + 1,) square roots of the mean squares of cosh k u and cos k_j u
    gap: Array  # wave numbers of the modes below the cylinder (N + 1,) [rad/m]
    overlap: Array  # (N + 1, N + 1) integrals over the gap of products, over its height


def wave_numbers(frequency: float, depth: float, modes: int) -> tuple[float, Array]:
    """Return the wave number and those of the evanescent modes [rad/m].

    They solve w^2 = g k tanh k h and w^2 = -g k tan k h.

    Args:
        frequency: Angular frequency [rad/s].
        depth: Depth of the water [m].
        modes: Number of evanescent modes.
    """
    number = frequency**2 * depth / GRAVITY
    wave = brentq(lambda x: x * np.tanh(x) - number, 0.0, number + 1.0, xtol=1e-14)
    decay = []
    for j in range(1, modes + 1):
        # written without poles: the root lies in the second half of each period of the tangent
        low, high = (j - 0.5) * np.pi, j * np.pi
        decay.append(brentq(lambda x: x * np.sin(x) + number * np.cos(x), low, high, xtol=1e-14))
    return wave / depth, np.array(decay) / depth


def modes_of(cylinder: Cylinder, frequency: float, modes: int) -> Modes:
    """Return the modes of both regions.

    Args:
        cylinder: The cylinder.
        frequency: Angular frequency [rad/s].
        modes: Number of evanescent modes and of varying modes below the cylinder.
    """
    h, s = cylinder.depth, cylinder.gap
    wave, decay = wave_numbers(frequency, h, modes)
    square = np.append(
        0.5 * (1.0 + np.sinh(2.0 * wave * h) / (2.0 * wave * h)),
        0.5 * (1.0 + np.sin(2.0 * decay * h) / (2.0 * decay * h)),
    )
    norm, gap = np.sqrt(square), np.pi * np.arange(modes + 1) / s
    sign = np.where(np.arange(modes + 1) % 2 == 0, 1.0, -1.0)  # cos(gap s)
    scale = np.where(np.arange(modes + 1) == 0, 1.0, np.sqrt(2.0))
    k = decay[None, :]
    column = wave * np.sinh(wave * s) / (wave**2 + gap**2)
    # of cos(gap u) and cos(k u); a common wave number would divide by zero, and none was met
    block = k * np.sin(k * s) / (k**2 - gap[:, None] ** 2)
    overlap = np.column_stack([column, block]) * (sign * scale)[:, None] / norm / s
    return Modes(wave, decay, norm, gap, overlap)


class Expansion(NamedTuple):
    """A potential with one dependence on the angle, cos(m theta)."""

    order: int  # m
    outer: Complex  # (N + 1,) values of the modes outside, at the cylinder's radius
    inner: Complex  # (N + 1,) values of those below it


def radial_slopes(cylinder: Cylinder, own: Modes, order: int) -> tuple[Complex, Array]:
    """Return the radial derivatives of modes that are 1 at the radius, outside and inside [1/m].

    Args:
        cylinder: The cylinder.
        own: The modes.
        order: Order m of the angle.
    """
    a, k = cylinder.radius, own.wave
    outer = np.empty(len(own.gap), dtype=complex)
    outer[0] = k * h2vp(order, k * a) / hankel2(order, k * a)
    x = own.decay * a
    outer[1:] = -own.decay * (kve(order + 1, x) / kve(order, x) - order / x)
    inner = np.full(len(own.gap), order / a)
    y = own.gap[1:] * a
    inner[1:] = own.gap[1:] * (ive(order + 1, y) / ive(order, y) + order / y)
    return outer, inner


def matched(
    cylinder: Cylinder, own: Modes, order: int, inner: Array, outer: Complex, incident: complex
) -> Expansion:
    """Return the potential whose value and radial derivative are continuous at the radius.

    Args:
        cylinder: The cylinder.
        own: The modes.
        order: Order m of the angle.
        inner: Projections on the inner modes of a given potential below the cylinder (N + 1,).
        outer: Projections of the given radial derivative at the radius on the outer modes, over the
            depth (N + 1,).
        incident: Value of an incident wave at the radius, in the first outer mode.
    """
    slope, below = radial_slopes(cylinder, own, order)
    share, C = cylinder.share, own.overlap
    system = np.diag(slope) - share * C.T @ (below[:, None] * C)
    given = C[:, 0] * incident - inner
    found = np.linalg.solve(system, share * C.T @ (below * given) + outer)
    return Expansion(order, found, C @ found + given)


def base_integrals(cylinder: Cylinder, own: Modes, order: int) -> Array:
    """Return integrals over the bottom of the inner modes times r^m cos^2(m theta) (N + 1,).

    Args:
        cylinder: The cylinder.
        own: The modes.
        order: Order m, 0 or 1.
    """
    a = cylinder.radius
    around = 2.0 * np.pi if order == 0 else np.pi
    found = np.empty(len(own.gap))
    found[0] = a ** (order + 2) / (2 * order + 2)
    y = own.gap[1:] * a
    sign = np.where(np.arange(1, len(own.gap)) % 2 == 0, 1.0, -1.0)
    found[1:] = np.sqrt(2.0) * sign * a ** (order + 1) / own.gap[1:]
    found[1:] *= ive(order + 1, y) / ive(order, y)
    return around * found


def side_integrals(cylinder: Cylinder, own: Modes) -> tuple[Array, Array]:
    """Return integrals over the height of the side of the outer modes, and of them times z.

    z = u - h is the height above the waterline.

    Args:
        cylinder: The cylinder.
        own: The modes.

    Returns:
        Integrals (N + 1,) [m] and [m^2].
    """
    h, s, d, k, q = cylinder.depth, cylinder.gap, cylinder.draught, own.wave, own.decay
    level = np.append((np.sinh(k * h) - np.sinh(k * s)) / k, (np.sin(q * h) - np.sin(q * s)) / q)
    lever = np.append(
        (d * np.sinh(k * s) - (np.cosh(k * h) - np.cosh(k * s)) / k) / k,
        (d * np.sin(q * s) + (np.cos(q * h) - np.cos(q * s)) / q) / q,
    )
    return level / own.norm, lever / own.norm


class Forced(NamedTuple):
    """Potential of a unit motion: expansion, and the forces of the given part below the bottom."""

    expansion: Expansion
    base: float  # integral over the bottom of the given potential times r^m cos^2(m theta)


def heave_potential(cylinder: Cylinder, own: Modes) -> Forced:
    """Return the potential of a unit velocity upward; below, (u^2 - r^2 / 2) / 2 s is given."""
    a, s, n = cylinder.radius, cylinder.gap, len(own.gap)
    inner = np.zeros(n)
    inner[0] = (s * s / 3.0 - 0.5 * a * a) / (2.0 * s)
    inner[1:] = np.sqrt(2.0) * _square_projections(own, s) / (2.0 * s)
    slope = -a / (2.0 * s) * own.overlap[0] * cylinder.share
    found = matched(cylinder, own, 0, inner, slope.astype(complex), 0.0)
    return Forced(found, 2.0 * np.pi * (s * s * a * a / 2.0 - a**4 / 8.0) / (2.0 * s))


def surge_potential(cylinder: Cylinder, own: Modes) -> Forced:
    """Return the potential of a unit velocity along x, which is given on the side."""
    level, _ = side_integrals(cylinder, own)
    slope = (level / cylinder.depth).astype(complex)
    return Forced(matched(cylinder, own, 1, np.zeros(len(own.gap)), slope, 0.0), 0.0)


def pitch_potential(cylinder: Cylinder, own: Modes) -> Forced:
    """Return the potential of a unit rate that moves the top forward and the front down.

    Below, -(u^2 r - r^3 / 4) / 2 s is given.
    """
    a, s, n = cylinder.radius, cylinder.gap, len(own.gap)
    inner = np.zeros(n)
    inner[0] = -(a * s * s / 3.0 - a**3 / 4.0) / (2.0 * s)
    inner[1:] = -a * np.sqrt(2.0) * _square_projections(own, s) / (2.0 * s)
    _, lever = side_integrals(cylinder, own)
    # derivative of the given part at the radius: -(u^2 - 3 a^2 / 4) / 2 s
    below = np.zeros(n)
    below[0] = -(s * s / 3.0 - 0.75 * a * a) / (2.0 * s)
    below[1:] = -np.sqrt(2.0) * _square_projections(own, s) / (2.0 * s)
    slope = lever / cylinder.depth + below @ own.overlap * cylinder.share
    base = -np.pi * (s * s * a**4 / 4.0 - a**6 / 24.0) / (2.0 * s)
    return Forced(matched(cylinder, own, 1, inner, slope.astype(complex), 0.0), base)


def _square_projections(own: Modes, s: float) -> Array:
    """Return means over the gap of u^2 cos(gap u), of the varying inner modes (N,)."""
    sign = np.where(np.arange(1, len(own.gap)) % 2 == 0, 1.0, -1.0)
    return np.asarray(2.0 * sign / own.gap[1:] ** 2)


def cylinder_coefficients(
    cylinder: Cylinder, frequency: float, modes: int = MODES
) -> CylinderCoefficients:
    """Return added mass, damping and excitation in surge, heave and pitch.

    Args:
        cylinder: The cylinder.
        frequency: Angular frequency [rad/s].
        modes: Number of modes of each region.
    """
    own, w = modes_of(cylinder, frequency, modes), frequency
    level, lever = side_integrals(cylinder, own)
    bottom = [base_integrals(cylinder, own, order) for order in (0, 1)]
    a, around = cylinder.radius, np.pi * cylinder.radius

    def integrals(found: Expansion, base: float) -> Complex:
        """Integrals (6,) of a potential times the normals of the motions, z up."""
        total = np.zeros(6, dtype=complex)
        if found.order == 0:
            total[HEAVE] = -(found.inner @ bottom[0] + base)
        else:
            total[SURGE] = around * (found.outer @ level)
            total[PITCH] = around * (found.outer @ lever) + found.inner @ bottom[1] + base
        return total

    forced = {
        SURGE: surge_potential(cylinder, own),
        HEAVE: heave_potential(cylinder, own),
        PITCH: pitch_potential(cylinder, own),
    }
    matrix = np.zeros((6, 6), dtype=complex)
    for place, motion in forced.items():
        matrix[:, place] = integrals(motion.expansion, motion.base)
    top = 1j * GRAVITY / w * own.norm[0] / np.cosh(own.wave * cylinder.depth)
    total = np.zeros(6, dtype=complex)
    for order, factor in ((0, 1.0), (1, -2.0j)):
        incident = top * factor * jv(order, own.wave * a)
        slope = np.zeros(modes + 1, dtype=complex)
        slope[0] = -top * factor * own.wave * jvp(order, own.wave * a)
        zero = np.zeros(modes + 1)
        scattered = matched(cylinder, own, order, zero, slope, incident)
        outer = scattered.outer.copy()
        outer[0] += incident
        total += integrals(Expansion(order, outer, scattered.inner), 0.0)
    # z down and y to starboard: heave and pitch have the opposite sign
    sign = np.array([1.0, 1.0, -1.0, 1.0, -1.0, 1.0])
    matrix *= np.outer(sign, sign)
    rho = cylinder.density
    return CylinderCoefficients(
        -rho * matrix.real, rho * w * matrix.imag, sign * 1j * w * rho * total
    )
