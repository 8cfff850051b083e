"""A hull in strips: breadth, section area, added mass and damping along its length.

Each quantity is a polynomial of second degree along the hull, which has three given moments: its
total, its first and its second moment. These are the particulars that a hull's motion in long waves
depends on: area, centre and inertia of the waterplane, volume and centre of buoyancy, and the
entries of the matrices of added mass and damping. Where the sections of the hull are known, its
breadth and section area are those of a table instead.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

from numba import njit

from boatsim.physics.signals import Array

NO_SECTIONS = (0.0,)  # the table without sections


class Line(NamedTuple):
    """A quantity per length [1/m] along the hull, a polynomial in the place from -1 to 1."""

    level: float
    slope: float
    curve: float


class StripHull(NamedTuple):
    """Quantities that are distributed along the hull, of all hulls together."""

    hulls: float  # 1 or 2
    width: float  # [m] of a strip, along the hull
    breadth: Line  # [m] of the waterplane
    area: Line  # [m^2] of the sections
    sway_mass: Line  # [kg/m] added mass
    heave_mass: Line  # [kg/m]
    sway_damping: Line  # [N s/m^2]
    heave_damping: Line  # [N s/m^2]


@njit(inline="always")
def line_value(place: float, line: Line) -> float:
    """Return a quantity per length at a place along the hull.

    Args:
        place: Place ahead of mid-length, from -1 at the stern to 1 at the bow.
        line: The quantity.
    """
    return line.level + place * (line.slope + place * line.curve)


@njit
def line_of_moments(total: float, first: float, second: float, q: Any) -> Line:
    """Return the polynomial whose sum over the strips has exactly the given moments.

    With xi the middles of n strips, the mean of xi^2 is (1 - 1 / n^2) / 3, and that of xi^4 (3 - 10
    / n^2 + 7 / n^4) / 15.

    Args:
        total: Total of the quantity.
        first: First moment about the origin of motion [times m].
        second: Second moment about the origin [times m^2].
        q: Parameters of the effect.
    """
    half, c, per_strip = 0.5 * q.length, q.centre, 1.0 / (int(q.strips) * int(q.strips))
    square = (1.0 - per_strip) / 3.0
    fourth = (3.0 - 10.0 * per_strip + 7.0 * per_strip * per_strip) / 15.0
    ahead = (first - c * total) / half  # moments about mid-length
    apart = (second - 2.0 * c * first + c * c * total) / (half * half)
    curve = (apart - total * square) / (fourth - square * square)
    return Line((total - curve * square) / q.length, ahead / square / q.length, curve / q.length)


@njit
def strip_hull(q: Any) -> StripHull:
    """Return the distributions along the hull that follow from the parameters of the effect.

    The sections have the same relative slenderness towards the ends as the waterline, so that the
    draught is constant along a hull whose centres of buoyancy and flotation coincide.

    Args:
        q: Parameters of the effect.
    """
    hulls = 1.0
    if q.hull_spacing > 0.0:
        hulls = 2.0
    box = hulls * q.hull_beam * q.length  # [m^2]
    plane, volume = box * q.waterplane_coefficient, box * q.block_coefficient * q.draught
    about = q.waterplane_gyradius * q.waterplane_gyradius + q.flotation * q.flotation
    # the second moment about mid-length of the area over the volume is that of the waterplane
    shift = 2.0 * q.centre * (q.buoyancy - q.flotation)
    sway, sway_at = q.sway_mass, q.sway_mass_at
    drag, drag_at = q.sway_damping, q.sway_damping_at
    return StripHull(
        hulls,
        q.length / int(q.strips),
        line_of_moments(plane, plane * q.flotation, plane * about, q),
        line_of_moments(volume, volume * q.buoyancy, volume * (about + shift), q),
        line_of_moments(sway, sway * sway_at, q.yaw_mass + sway * sway_at * sway_at, q),
        line_of_moments(q.heave_mass, 0.0, q.pitch_mass, q),
        line_of_moments(drag, drag * drag_at, q.yaw_damping + drag * drag_at * drag_at, q),
        line_of_moments(q.heave_damping, 0.0, q.pitch_damping, q),
    )


@njit(inline="always")
def strip_place(i: int, q: Any) -> float:
    """Return the middle of a strip along the hull, from -1 at the stern to 1 at the bow.

    Args:
        i: Number of the strip, from 0 at the stern.
        q: Parameters of the effect.
    """
    return (2.0 * i + 1.0) / int(q.strips) - 1.0


def section_table(breadth: Sequence[float], area: Sequence[float]) -> tuple[float, ...]:
    """Return the table of known sections, as a law reads it.

    Args:
        breadth: Breadth of each strip from the stern, of all hulls [m].
        area: Section area of each [m^2].

    Returns:
        The number of strips, then breadth and area of each.
    """
    pairs: list[float] = []
    for one, other in zip(breadth, area, strict=True):
        pairs += [float(one), float(other)]
    return (float(len(breadth)), *pairs)


@njit(inline="always")
def end_of_sections(p: Array, first: Any) -> Any:
    """Return the index after the table of sections.

    Args:
        p: Parameters and tables of all effects.
        first: Index of the table of sections.
    """
    return first + 1 + 2 * int(p[first])


@njit(inline="always")
def strip_section(
    i: int, place: float, hull: StripHull, p: Array, first: Any
) -> tuple[float, float]:
    """Return breadth [m] and section area [m^2] of a strip, of all hulls.

    Args:
        i: Number of the strip, from 0 at the stern.
        place: Its middle, from -1 at the stern to 1 at the bow.
        hull: Distributions along the hull.
        p: Parameters and tables of all effects.
        first: Index of the table of sections.
    """
    breadth, area = line_value(place, hull.breadth), line_value(place, hull.area)
    if p[first] > 0.0:
        breadth, area = p[first + 1 + 2 * i], p[first + 2 + 2 * i]
    return breadth, area
