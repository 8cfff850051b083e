"""Latitudes and longitudes that are written as degrees and minutes, or with a hemisphere."""

import re
from collections.abc import Mapping, Sequence

import numpy as np

from boatsim.physics.base import Array

LATITUDES, LONGITUDES = ("lat", "latitude"), ("lon", "lng", "long", "longitude")
LARGEST = {"latitude": 90.0, "longitude": 180.0}  # [deg]
# 59°54'12.3"N, N 59 54.205', 59.9034° N, 59-54.205N
COORDINATE = re.compile(
    r"(?P<before>[NSEW])?\s*(?P<sign>[+-])?\s*(?P<degrees>\d{1,3}(?:[.,]\d+)?)\s*[°ºd]?"
    r"(?:[\s\-]*(?P<minutes>\d{1,2}(?:[.,]\d+)?)\s*['’′m]?"
    r"(?:\s*(?P<seconds>\d{1,2}(?:[.,]\d+)?)\s*(?:\"|''|”|″|s)?)?)?\s*(?P<after>[NSEW])?",
    re.IGNORECASE,
)
HEMISPHERES = {"N": 1.0, "E": 1.0, "S": -1.0, "W": -1.0}  # letter -> sign of the degrees
MIN_COORDINATES = 0.9  # share of the filled cells that are coordinates


def kind_of_place(name: str) -> str:
    """Return "latitude" or "longitude" by the last word of a name, "" for another column."""
    words = re.findall(r"[a-z]+", name.lower())
    if words and words[-1] in ("deg", "degrees"):
        words.pop()
    if not words:
        return ""
    for kind, names in (("latitude", LATITUDES), ("longitude", LONGITUDES)):
        if words[-1] in names:
            return kind
    return ""


def degrees_of_texts(cells: Sequence[str]) -> Array | None:
    """Return the degrees (N,) of texts such as `59°54'12.3"N`, nan for other texts.

    Returns:
        None if most of the texts are no coordinates.
    """
    found = np.full(len(cells), np.nan)
    filled = 0
    for i, cell in enumerate(cells):
        text = cell.strip()
        if text:
            filled += 1
            found[i] = _degrees(text)
    if not filled or np.isfinite(found).sum() < MIN_COORDINATES * filled:
        return None
    return found


def _degrees(text: str) -> float:
    parts = COORDINATE.fullmatch(text)
    if not parts:
        return float("nan")
    value, scale = 0.0, 1.0
    for key in ("degrees", "minutes", "seconds"):
        value += float((parts[key] or "0").replace(",", ".")) / scale
        scale *= 60.0
    hemisphere = (parts["before"] or parts["after"] or "").upper()
    if parts["sign"] == "-":
        return -value
    return HEMISPHERES.get(hemisphere, 1.0) * value


def places_of_hemispheres(
    columns: Mapping[str, Array], words: Mapping[str, str]
) -> dict[str, Array]:
    """Return the latitudes and longitudes (N,) that a column of S or W makes negative.

    One column must have a letter for north or south, and another one for east or west: a single
    letter may be a state.

    Args:
        columns: Name -> values (N,) of a table, in the order of the file.
        words: Name -> word of each column in which every cell is the same word.
    """
    letters = {word.upper() for word in words.values()}
    if not (letters & {"N", "S"} and letters & {"E", "W"}):
        return {}
    found = {}
    for kind, letter in (("latitude", "S"), ("longitude", "W")):
        names = [name for name in columns if kind_of_place(name) == kind]
        if letter in letters and names:
            found[names[0]] = -np.abs(columns[names[0]])
    return found


def degrees_of_degrees_and_minutes(columns: Mapping[str, Array]) -> dict[str, Array]:
    """Return the columns in degrees that are written as ddmm.mmmm, as NMEA 0183 does.

    Two signs are needed: the numbers of a latitude or a longitude exceed those of any place in
    degrees, and the minutes of both are below 60 in all rows.

    Args:
        columns: Name -> values (N,) of a table.

    Returns:
        Name -> degrees (N,), for latitude and longitude together; empty if they are in degrees.
    """
    places: dict[str, str] = {}
    for name, values in columns.items():
        kind = kind_of_place(name)
        if kind and kind not in places and np.isfinite(values).any():
            places[kind] = name
    if len(places) < len(LARGEST):
        return {}
    exceeds = False
    for kind, name in places.items():
        values = np.abs(columns[name][np.isfinite(columns[name])])
        is_possible = values.max() < 100.0 * LARGEST[kind] + 60.0
        if not is_possible or (np.remainder(values, 100.0) >= 60.0).any():
            return {}
        exceeds |= bool(values.max() > LARGEST[kind])
    if not exceeds:
        return {}
    found = {}
    for name in places.values():
        values = columns[name]
        size = np.abs(values)
        degrees = np.floor(size / 100.0)
        found[name] = np.sign(values) * (degrees + (size - 100.0 * degrees) / 60.0)
    return found
