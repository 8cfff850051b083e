"""Hulls from tables of offsets: files of ShipX (NAME.mgf), and surfaces lofted through them."""

from pathlib import Path
from typing import NamedTuple
from zipfile import BadZipFile, ZipFile

import numpy as np
from scipy.interpolate import PchipInterpolator

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from validation.waves.hulls import grid_triangles

TEXT_LINES = 4  # before the length


class Station(NamedTuple):
    """Half of a section of a hull.

    Attributes:
        x: Its place ahead of amidships [m].
        points: Half-breadth and height above the baseline (N, 2) [m], from the keel upward.
    """

    x: float
    points: Array


class Offsets(NamedTuple):
    """Sections of a hull.

    Attributes:
        length: Length between perpendiculars [m].
        stations: The sections, from aft to forward.
    """

    length: float
    stations: tuple[Station, ...]


def mgf_in_archive(path: Path) -> str:
    """Return the text of the one file NAME.mgf in a ship of ShipX, a ZIP archive.

    Args:
        path: NAME.shipx_ship.

    Raises:
        BadInput: The file is no archive, or has not exactly one such file.
    """
    return _only_file(path, ".mgf").decode("latin-1")


def extract(path: Path, ending: str, folder: Path) -> Path:
    """Write the one file of a name's ending in a ship of ShipX to a folder, and return its path.

    Args:
        path: NAME.shipx_ship.
        ending: End of the name, such as ".re1".
        folder: Folder, which is created.

    Raises:
        BadInput: The file is no archive, or has not exactly one such file.
    """
    folder.mkdir(parents=True, exist_ok=True)
    found = folder / f"{path.stem}{ending}"
    found.write_bytes(_only_file(path, ending))
    return found


def _only_file(path: Path, ending: str) -> bytes:
    """Return the content of the one file of a name's ending in an archive. Raises BadInput."""
    try:
        with ZipFile(path) as archive:
            names = [name for name in archive.namelist() if name.lower().endswith(ending)]
            if len(names) != 1:
                raise BadInput(f"{path}: {len(names)} files *{ending} in it; one is required")
            return archive.read(names[0])
    except (OSError, BadZipFile) as error:
        raise BadInput(f"{path}: the archive cannot be read: {error}") from None


def parse_mgf(text: str, name: str) -> Offsets:
    """Return the sections of a file NAME.mgf of ShipX.

    It has four lines of text, the length, and for each section its number, its place aft of
    amidships, the number of its points, and as many lines of half-breadth and height above the
    baseline. The points run from the deck to the keel or from the keel to the deck.

    Args:
        text: Content of the file.
        name: Its name, for messages.

    Raises:
        BadInput: The file has another form.
    """
    numbers: list[float] = []
    for number, line in enumerate(text.splitlines()[TEXT_LINES:], TEXT_LINES + 1):
        for word in line.split():
            try:
                numbers.append(float(word))
            except ValueError:
                raise BadInput(f"{name}:{number}: {word!r} is not a number") from None
    values = iter(numbers)
    stations = []
    try:
        length = next(values)
        while next(values, None) is not None:  # the number of the section
            x, count = -next(values), round(next(values))
            points = np.array([(next(values), next(values)) for _ in range(count)])
            if count < 2:
                raise BadInput(f"{name}: a section has {count} points; at least 2 are required")
            if points[0, 1] > points[-1, 1]:
                points = points[::-1]
            stations.append(Station(x, points))
    except (StopIteration, RuntimeError):
        raise BadInput(f"{name}: the file ends early") from None
    if len(stations) < 2:
        raise BadInput(f"{name}: {len(stations)} sections; at least 2 are required")
    return Offsets(length, tuple(sorted(stations, key=lambda station: station.x)))


def submerged_half(station: Station, draught: float, parts: int) -> Array:
    """Return points (parts + 1, 2) of a section from its keel to the waterline.

    They have equal distances along the section, which is straight between its offsets.

    Args:
        station: The section. Its keel is below the waterline and its deck is above it.
        draught: Height of the waterline above the baseline [m].
        parts: Number of parts.
    """
    points = station.points
    if points[0, 0] > 0.0:  # a flat bottom
        points = np.concatenate([[[0.0, points[0, 1]]], points])
    above = int(np.argmax(points[:, 1] >= draught))
    low, high = points[above - 1], points[above]
    share = (draught - low[1]) / (high[1] - low[1])
    points = np.concatenate([points[:above], [low + share * (high - low)]])
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(points, axis=0).T)))
    places = np.linspace(0.0, along[-1], parts + 1)
    return np.column_stack([np.interp(places, along, points[:, k]) for k in range(2)])


def lofted(offsets: Offsets, draught: float, spacing: float, parts: int) -> Array:
    """Return the triangles (N, 3, 3) of a hull below the waterline, which is z = 0.

    Points of the same place along the sections are joined by monotone cubics. Flat panels close
    the ends. The axes are x ahead of amidships, y to port and z up.

    Args:
        offsets: The hull.
        draught: Height of the waterline above the baseline [m].
        spacing: Largest distance of sections of the mesh [m].
        parts: Number of panels from keel to waterline.

    Raises:
        BadInput: Fewer than two sections reach below the waterline and above it.
    """
    wet = []
    for station in offsets.stations:
        if station.points[0, 1] < draught <= station.points[-1, 1]:
            wet.append(station)
    if len(wet) < 2:
        raise BadInput(f"draught {draught:g} m: {len(wet)} sections cross the waterline")
    places = np.array([station.x for station in wet])
    x = [places[:1]]
    for low, high in zip(places[:-1], places[1:], strict=True):
        number = int(np.ceil((high - low) / spacing - 1e-9))
        x.append(np.linspace(low, high, number + 1)[1:])
    along = np.concatenate(x)
    sections = np.array([submerged_half(station, draught, parts) for station in wet])
    half = PchipInterpolator(places, sections)(along)
    half[..., 1] -= draught
    half[:, -1, 1] = 0.0
    half[:, 0, 0] = 0.0
    found = []
    for side in (1.0, -1.0):
        points = np.stack(
            [np.broadcast_to(along[:, None], half.shape[:2]), side * half[..., 0], half[..., 1]],
            axis=-1,
        )
        patches = [grid_triangles(points)]
        for end, order in ((points[-1], 1), (points[0], -1)):
            middle = end * np.array([1.0, 0.0, 1.0])
            patches.append(grid_triangles(np.stack([end, middle]))[:, ::order])
        triangles = np.concatenate(patches)
        if side < 0.0:
            triangles = triangles[:, ::-1]
        found.append(triangles)
    return np.concatenate(found)
