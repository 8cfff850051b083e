"""The map from a log to a recording: the signal and unit of each column, in a TOML file."""

import math
from collections.abc import Mapping
from pathlib import Path

from pydantic import Field, field_validator, model_validator

from boatsim.errors import BadInput, unknown_name_message
from boatsim.files import Table, read_toml, validate_table
from boatsim.physics.signals import POSE, RATES
from boatsim.recordings.conversion import Allocation, Curve, Range, map_conversion_of
from boatsim.recordings.importing.water_speed_table import WaterSpeed
from boatsim.recordings.importing.waves import WaveProbes
from boatsim.recordings.notes import MAX_LATENCY

COMPUTED = ("t_s", "x_m", "y_m")  # columns that follow from the clock and from `position`


class Position(Table):
    """Position by latitude and longitude.

    Attributes:
        latitude: Expression in rad.
        longitude: Expression in rad.
        origin: Latitude and longitude of the origin [deg]; the first fix by default.
    """

    latitude: str
    longitude: str
    origin: tuple[float, float] | None = None

    @field_validator("origin")
    @classmethod
    def _on_earth(cls, found: tuple[float, float] | None) -> tuple[float, float] | None:
        if found and not (abs(found[0]) < 89.0 and abs(found[1]) <= 360.0):
            raise ValueError(
                "allowed is [latitude, longitude] in degrees, not nearer than 1 degree to a pole"
            )
        return found


class Map(Table):
    """Content of a map.

    Attributes:
        about: Description.
        vessel: Name or path of the vessel.
        rate: Rate of the rows [Hz]; that of the fastest signal by default.
        use: Part of the log that is converted, from and to [s] since its begin, or a list of these.
        time: Expression in s of the time of a table without a column of a known name; of several
            files the expression of each by its name.
        begins: File of a run in several files -> begin after that of the first file [s].
        latency: Column -> delay by which its values are older than their times [s].
        position: Latitude and longitude.
        columns: Column -> expression of a signal, its `Range` or `Curve`, or the `Allocation` of
            several signals.
        waves: Column -> probes from which the wave at the hull follows.
        current: Speed through the water from which the current follows.
    """

    about: str = ""
    vessel: str | None = None
    rate: float | None = Field(None, gt=0.0, le=1000.0)
    use: tuple[tuple[float, float], ...] = ()
    time: str | dict[str, str] | None = None
    begins: dict[str, float] = {}
    latency: dict[str, float] = {}
    position: Position | None = None
    columns: dict[str, str | Range | Curve | Allocation] = {}
    waves: dict[str, WaveProbes] = {}
    current: WaterSpeed | None = None

    @field_validator("columns", mode="before")
    @classmethod
    def _texts_or_ranges(cls, found: object) -> object:
        if not isinstance(found, dict):
            return found
        columns = dict(found)
        for name, value in found.items():
            if isinstance(value, dict):
                columns[name] = map_conversion_of(value, f"columns.{name}")
            elif not isinstance(value, str | Range | Curve | Allocation):
                allowed = (
                    '"[-] signal [* unit or number] [+ number]", { signal, low, neutral, '
                    "high, least, most, exponent }, { signal, points } or { sum, low, high, "
                    "coefficient, exponent, inverse }"
                )
                raise ValueError(f"{name} is {value!r}; allowed is {allowed}")
        return columns

    @field_validator("use", mode="before")
    @classmethod
    def _one_or_several(cls, found: object) -> object:
        if not isinstance(found, list | tuple):
            return found
        parts = found
        if found and not isinstance(found[0], list | tuple):
            parts = [found]
        return tuple(tuple(part) if isinstance(part, list) else part for part in parts)

    @field_validator("latency")
    @classmethod
    def _short(cls, found: dict[str, float]) -> dict[str, float]:
        for name, seconds in found.items():
            if not abs(seconds) <= MAX_LATENCY:
                raise ValueError(
                    f"{name} = {seconds:g}; allowed is -{MAX_LATENCY:g} to {MAX_LATENCY:g} s"
                )
        return found

    @model_validator(mode="after")
    def _fits(self) -> "Map":
        for name in self.columns:
            if name == "t_s":
                raise ValueError("columns.t_s is what time makes; leave it out")
            if self.position and name in COMPUTED:
                raise ValueError(f"columns.{name} is what position makes; leave it out")
        for name in self.waves:
            if name in self.columns:
                raise ValueError(f"columns.{name} is what waves makes; leave it out")
        for name in (self.current.north, self.current.east) if self.current else ():
            if name in self.columns:
                raise ValueError(f"columns.{name} is what current makes; leave it out")
        known = set(self.columns)
        if self.position:
            known |= set(COMPUTED[1:])
        for name in self.latency:
            if name not in known:
                raise ValueError(unknown_name_message("latency: column", name, sorted(known)))
        last = -math.inf
        for begin, end in self.use:
            if not last < begin < end:
                raise ValueError(
                    "use must be [from_s, to_s], the second larger, or a list of these in order "
                    "of time"
                )
            last = end
        if not self.position and not set(self.columns) & {*POSE, *RATES}:
            raise ValueError(
                f"no pose: give position, or at least one column of {', '.join((*POSE, *RATES))}"
            )
        return self


def read_map(path: Path) -> Map:
    """Read a map from log signals to columns from its file. Raises BadInput."""
    return parse_map(read_toml(path), str(path))


def parse_map(table: Mapping[str, object], file: str) -> Map:
    """Return the map of log signals that a table read from a file contains. Raises BadInput."""
    try:
        return validate_table(Map, table, file)
    except BadInput as error:
        message = str(error)
        if not message.startswith(file):
            message = f"{file}: {message}"
        raise BadInput(message) from None
