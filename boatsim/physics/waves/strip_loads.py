"""Loads of one wave on the strips of a hull: pressure of the undisturbed wave, and diffraction.

A strip is a rectangle at rest in still water. With the elevation a cos(theta), theta = w t - k (x
cos beta + y sin beta) + epsilon, the pressure is rho g a C(z) cos(theta). The velocity of the water
along the waves is (g k a / w) C(z) cos(theta), and downward (g k a / w) S(z) sin(theta), with C =
cosh k (h - z) / cosh k h and S = sinh k (h - z) / cosh k h.
"""

from math import cos, exp, sin
from typing import Any, NamedTuple

from numba import njit

from boatsim.physics.particulars import GRAVITY
from boatsim.physics.signals import Array, Wrench, wrench
from boatsim.physics.waves.hull_integrals import beam_integrals
from boatsim.physics.waves.hull_strips import StripHull, line_value, strip_place, strip_section


class EncounteredWave(NamedTuple):
    """One wave as it meets the hull."""

    frequency: float  # [rad/s] seen by an observer that drifts with the water
    amplitude: float  # [m]
    number: float  # wave number [rad/m]
    ahead: float  # cosine of its direction relative to the hull
    across: float  # sine of it
    phase: float  # [rad] at the origin of motion; a crest at 0
    bed: float  # exp(-2 k h); 0 in deep water


class WaveOnStrip(NamedTuple):
    """One strip of the hull, and the wave at it."""

    place: float  # middle of the strip, from -1 at the stern to 1 at the bow
    x: float  # [m] ahead of the origin of motion
    breadth: float  # [m] at the waterline, of all hulls
    draught: float  # [m] section area over breadth
    even: float  # [m] integral of cos(k y) over the waterline, k across the hull
    odd: float  # [m^2] integral of y sin(k y) over it
    pressure: float  # C at the bottom
    vertical: float  # S at the bottom
    sides: float  # [m] integral of C over the draught
    lever: float  # [m^2] integral of z C over the draught
    cosine: float  # of the phase of the wave at the strip
    sine: float


@njit(inline="always")
def draught_attenuation(draught: float, wave: EncounteredWave) -> tuple[float, float, float, float]:
    """Return the attenuation of a wave over the draught of a section.

    Args:
        draught: Draught of the section [m].
        wave: The wave.

    Returns:
        C and S at the bottom, and the integrals over the draught of C [m] and z C [m^2].
    """
    k, bed = wave.number, wave.bed
    near, far = exp(-k * draught), 0.0
    if bed > 0.0:
        far = bed / near
    pressure, vertical = (near + far) / (1.0 + bed), (near - far) / (1.0 + bed)
    sides = ((1.0 - bed) / (1.0 + bed) - vertical) / k
    return pressure, vertical, sides, ((1.0 - pressure) / k - draught * vertical) / k


@njit(inline="always")
def wave_on_strip(
    place: float,
    breadth: float,
    area: float,
    c: float,
    s: float,
    sides: tuple[float, float],
    wave: EncounteredWave,
    hull: StripHull,
    q: Any,
) -> WaveOnStrip:
    """Return a strip and the wave at it.

    Args:
        place: Middle of the strip, from -1 at the stern to 1 at the bow.
        breadth: Breadth of the waterplane, of all hulls [m].
        area: Area of the section, of all hulls [m^2].
        c: Cosine of the phase of the wave at the strip.
        s: Sine of it.
        sides: Sums over the hulls of cos(k y) [-] and of y sin(k y) [m] at their centre planes.
        wave: The wave.
        hull: Distributions along the hull.
        q: Parameters of the effect.
    """
    draught, beam = area / breadth, breadth / hull.hulls
    pressure, vertical, side, lever = draught_attenuation(draught, wave)
    across = wave.number * wave.across
    mean, moment = beam_integrals(0.5 * across * beam)
    even = beam * mean * sides[0]
    odd = across * beam * beam * beam / 12.0 * moment * sides[0] + beam * mean * sides[1]
    x = q.centre + 0.5 * q.length * place
    return WaveOnStrip(place, x, breadth, draught, even, odd, pressure, vertical, side, lever, c, s)


@njit(inline="always")
def froude_krylov(strip: WaveOnStrip, wave: EncounteredWave, q: Any) -> Wrench:
    """Return the force per length of the pressure of the undisturbed wave on one strip.

    Args:
        strip: The strip, and the wave at it.
        wave: The wave.
        q: Parameters of the effect.

    Returns:
        Force [N/m] and moment [N].
    """
    top = q.density * GRAVITY * wave.amplitude  # [N/m^2] pressure at the surface
    along, across = wave.number * wave.ahead, wave.number * wave.across
    level = -top * strip.sides * strip.even * strip.sine  # [N] force over the wave number
    turning = -top * strip.lever * strip.even * strip.sine  # [N m] its moment
    Z = -top * strip.pressure * strip.even * strip.cosine
    return wrench(
        X=along * level,
        Y=across * level,
        Z=Z,
        K=-top * strip.pressure * strip.odd * strip.sine - across * turning,
        M=along * turning - strip.x * Z,
        N=strip.x * across * level - along * top * strip.sides * strip.odd * strip.cosine,
    )


@njit(inline="always")
def diffraction(strip: WaveOnStrip, wave: EncounteredWave, hull: StripHull, q: Any) -> Wrench:
    """Return the force per length of added mass and damping of one strip in the moving water.

    The force is proportional to acceleration and velocity of the undisturbed water, averaged over
    the section: added mass and damping act on the motion relative to the water.

    Args:
        strip: The strip, and the wave at it.
        wave: The wave.
        hull: Distributions along the hull.
        q: Parameters of the effect.

    Returns:
        Force [N/m] and moment [N].
    """
    w = wave.frequency
    speeding = GRAVITY * wave.number * wave.amplitude / strip.breadth
    level = speeding * strip.even * strip.sides / strip.draught
    surging, drift = -level * strip.sine, level * strip.cosine / w  # [m/s^2], [m/s]
    vertical = speeding * strip.even * strip.vertical
    heaving, sinking = vertical * strip.cosine, vertical * strip.sine / w
    beam, arm = strip.breadth / hull.hulls, 0.5 * q.hull_spacing
    slope = speeding * strip.odd * strip.vertical / (beam * beam / 12.0 + arm * arm)
    rolling, heeling = slope * strip.sine, -slope * strip.cosine / w  # [rad/s^2], [rad/s]
    sway = line_value(strip.place, hull.sway_mass) * wave.across * surging
    drag = line_value(strip.place, hull.sway_damping) * wave.across * drift
    heave = line_value(strip.place, hull.heave_mass) * heaving
    heave += line_value(strip.place, hull.heave_damping) * sinking
    roll = (q.roll_mass * rolling + q.roll_damping * heeling) / q.length
    return wrench(
        X=wave.ahead * (q.surge_mass * surging + q.surge_damping * drift) / q.length,
        Y=sway + drag,
        Z=heave,
        K=roll - q.sway_mass_below * sway,
        M=-strip.x * heave,
        N=strip.x * (sway + drag),
    )


@njit
def wave_loads(wave: EncounteredWave, hull: StripHull, q: Any, p: Array, first: Any) -> Wrench:
    """Return the force of one wave on all strips of the hull.

    The phase of the wave is turned from strip to strip, which takes no sine and cosine. Strips
    without a waterplane exert no force.

    Args:
        wave: The wave.
        hull: Distributions along the hull.
        q: Parameters of the effect.
        p: Parameters and tables of all effects.
        first: Index of the effect's table, by `section_table`.
    """
    X = Y = Z = K = M = N = 0.0
    along, arm = wave.number * wave.ahead, 0.5 * q.hull_spacing
    shift = wave.number * wave.across * arm
    sides = (hull.hulls * cos(shift), hull.hulls * arm * sin(shift))
    at_stern = wave.phase - along * (q.centre + 0.5 * q.length * strip_place(0, q))
    c, s = cos(at_stern), sin(at_stern)
    turn, rise = cos(along * hull.width), sin(along * hull.width)
    for i in range(int(q.strips)):
        place = strip_place(i, q)
        breadth, area = strip_section(i, place, hull, p, first)
        if breadth > 0.0 and area > 0.0:
            strip = wave_on_strip(place, breadth, area, c, s, sides, wave, hull, q)
            f = froude_krylov(strip, wave, q)
            d = diffraction(strip, wave, hull, q)
            X += f.X + d.X
            Y += f.Y + d.Y
            Z += f.Z + d.Z
            K += f.K + d.K
            M += f.M + d.M
            N += f.N + d.N
        c, s = c * turn + s * rise, s * turn - c * rise
    width = hull.width
    return wrench(X=X * width, Y=Y * width, Z=Z * width, K=K * width, M=M * width, N=N * width)
