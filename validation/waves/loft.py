"""Meshes of hulls from tables of offsets: stations with half-breadths over heights."""

from typing import NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from validation.waves.hulls import Surface, grid_triangles

# Half-breadth over the largest one below which a panel lies in the centre plane: a skeg without
# thickness, or no hull at all
FLAT = 1e-6
# Share of the spacing of stations that is closer at the ends of the hull, by a cosine, where the
# half-breadth changes fast; the rest is uniform
CLOSER = 0.5


class Station(NamedTuple):
    """Section of a hull."""

    x: float  # [m] place along the hull, forward
    half_breadth: Array  # (N,) [m]
    height: Array  # (N,) [m] above the base line, never decreasing


class Panels(NamedTuple):
    """Numbers of panels of one side of a hull; each is halved into two triangles."""

    along: int  # between both ends
    up: int  # from the base line to the waterline
    bottom: int  # across half of the flat bottom


class Hydrostatics(NamedTuple):
    """Displacement of a hull, from the wetted triangles of its mesh."""

    volume: float  # [m^3]
    centre: Array  # (3,) [m] centre of buoyancy
    waterplane: float  # [m^2] area of the waterplane
    metacentre: float  # [m] transverse metacentre above the centre of buoyancy


def half_breadth_of(stations: list[Station]) -> Surface:
    """Return the half-breadth of a hull at places x and heights z above the base line.

    It is linear between the points of a station, and between stations monotone cubic at a constant
    height. Where a station has several half-breadths at one height, the largest counts. Outside of
    its heights it is 0.

    Args:
        stations: Stations, in the order of increasing x.
    """
    place = np.array([station.x for station in stations])

    def half_breadth(x: Array, z: Array) -> Array:
        levels, at = np.unique(z, return_inverse=True)
        rows = []
        for station in stations:
            heights = np.unique(station.height)
            widths = [station.half_breadth[station.height == h].max() for h in heights]
            rows.append(np.interp(levels, heights, widths, left=0.0, right=0.0))
        curves = PchipInterpolator(place, np.array(rows), axis=0)(np.ravel(x))
        own = curves[np.arange(curves.shape[0]), np.ravel(at)]
        return np.asarray(np.clip(own, 0.0, None).reshape(np.shape(x)))

    return half_breadth


def loft(stations: list[Station], draught: float, panels: Panels) -> Array:
    """Return the triangles (N, 3, 3) of both sides of a hull below its waterline, z = 0 there.

    The bottom is flat at the base line. Both ends are closed by flat panels where they have a
    breadth.

    Args:
        stations: Stations, in the order of increasing x.
        draught: Height of the waterline above the base line [m].
        panels: Numbers of panels.

    Raises:
        BadInput: There are fewer than two stations, or no hull below the waterline.
    """
    first, last = _wetted_ends(stations, draught)
    share = np.linspace(0.0, 1.0, panels.along + 1)
    ends = 0.5 * (1.0 - np.cos(np.pi * share))
    x = first + (last - first) * (CLOSER * ends + (1.0 - CLOSER) * share)
    height = 0.5 * draught * (1.0 - np.cos(np.pi * np.linspace(0.0, 1.0, panels.up + 1)))
    places, levels = np.meshgrid(x, height, indexing="ij")
    side = half_breadth_of(stations)(places, levels)
    across = np.linspace(0.0, 1.0, panels.bottom + 1)[:-1]
    y = np.column_stack([side[:, :1] * across, side])
    z = np.concatenate([np.zeros(panels.bottom), height]) - draught
    points = np.stack([np.broadcast_to(x[:, None], y.shape), y, np.tile(z, (len(x), 1))], axis=-1)
    found = [_both_sides(points)]
    for end, forward in ((points[0], False), (points[-1], True)):
        found.append(_flat_end(end, forward))
    triangles = np.concatenate(found)
    size = float(y.max())
    flat = np.abs(triangles[..., 1]).max(axis=1) < FLAT * size
    return np.asarray(triangles[~flat])


def _wetted_ends(stations: list[Station], draught: float) -> tuple[float, float]:
    """Return the places between which stations have a breadth below the waterline [m].

    A station without one next to the hull is its end.
    """
    if len(stations) < 2:
        raise BadInput(f"{len(stations)} stations; allowed are 2 and more")
    wet = []
    for station in stations:
        level = np.interp(draught, station.height, station.half_breadth, left=0.0, right=0.0)
        below = station.half_breadth[station.height <= draught]
        wet.append(bool(max(level, below.max(initial=0.0)) > 0.0))
    if not any(wet):
        raise BadInput(f"no station has a breadth below a draught of {draught:g} m")
    first, last = wet.index(True), len(wet) - 1 - wet[::-1].index(True)
    return stations[max(first - 1, 0)].x, stations[min(last + 1, len(wet) - 1)].x


def _both_sides(points: Array) -> Array:
    """Return the triangles (N, 3, 3) of a grid of points to port and of its mirror image."""
    port = grid_triangles(points)
    starboard = port[:, ::-1] * np.array([1.0, -1.0, 1.0])
    return np.concatenate([port, starboard])


def _flat_end(end: Array, forward: bool) -> Array:
    """Return the triangles of the flat end between a side of the hull (M, 3) and its mirror."""
    middle = end * np.array([1.0, 0.0, 1.0])
    points = np.stack([middle, end])
    if forward:
        points = points[::-1]
    return _both_sides(points)


def hydrostatics(triangles: Array) -> Hydrostatics:
    """Return the displacement of a hull, exact for its panels.

    Args:
        triangles: Wetted triangles (N, 3, 3) [m], z up from the waterline, counter-clockwise seen
            from the water, which leave only the waterplane open.
    """
    a, b, c = np.moveaxis(triangles, 1, 0)
    above = -0.5 * np.cross(b - a, c - a)[:, 2]  # waterplane above each triangle
    # cones from the origin, which lies in the waterplane
    cones = np.sum(a * np.cross(b, c), axis=1) / 6.0
    volume = float(cones.sum())
    centre = cones @ (a + b + c) / 4.0 / volume
    y = triangles[..., 1]
    second = float(above @ (np.sum(y**2, axis=1) + np.sum(y, axis=1) ** 2)) / 12.0
    return Hydrostatics(volume, centre, float(above.sum()), second / volume)


def section_area(station: Station, draught: float) -> float:
    """Return the area of both sides of a section below the waterline [m^2].

    Args:
        station: The section.
        draught: Height of the waterline above the base line [m].
    """
    height = np.clip(station.height, None, draught)
    at_top = np.interp(draught, station.height, station.half_breadth)
    breadth = np.where(station.height > draught, at_top, station.half_breadth)
    return float(2.0 * np.trapezoid(breadth, height))
