"""The map from a log to a recording: which signal is which column, in which unit; a TOML file that a user checks."""

from collections.abc import Mapping
from pathlib import Path

from pydantic import Field, field_validator, model_validator

from boatsim.errors import BadInput
from boatsim.files import Table, checked, read_toml
from boatsim.physics.signals import POSE, RATES

HELD = ("t_s", "x_m", "y_m")  # columns that `position` and the clock make


class Range(Table):
    """A signal between its ends, such as a pulse of 1100 to 1900 us, as a column between its own, bent at neutral."""

    signal: str
    low: float  # of the signal, in its unit
    neutral: float
    high: float
    least: float = -1.0  # of the column, where the signal is low
    most: float = 1.0

    @model_validator(mode="after")
    def _in_order(self) -> "Range":
        if not (self.low < self.neutral < self.high or self.low > self.neutral > self.high):
            raise ValueError("neutral must lie between low and high")
        return self


class Position(Table):
    """Latitude and longitude as expressions that end in radians, and the origin they are counted from."""

    latitude: str
    longitude: str
    origin: tuple[float, float] | None = None  # [deg] latitude, longitude; None: the first fix

    @field_validator("origin")
    @classmethod
    def _on_earth(cls, found: tuple[float, float] | None) -> tuple[float, float] | None:
        if found and not (abs(found[0]) < 89.0 and abs(found[1]) <= 360.0):
            raise ValueError(
                "allowed is [latitude, longitude] in degrees, not nearer than 1 degree to a pole"
            )
        return found


class Map(Table):
    """A whole map."""

    about: str = ""
    vessel: str | None = None
    rate: float | None = Field(
        None, gt=0.0, le=1000.0
    )  # [Hz] of rows; None: that of the fastest signal
    use: tuple[float, float] | None = None  # [s] since the log begins; None: all of it
    time: str | None = None  # of a table whose time is not found by its name; ends in s
    position: Position | None = None
    columns: dict[str, str | Range] = {}

    @field_validator("columns", mode="before")
    @classmethod
    def _texts_or_ranges(cls, found: object) -> object:
        for name, value in found.items() if isinstance(found, dict) else ():
            if isinstance(value, dict):
                checked(Range, value, f"columns.{name}")
            elif not isinstance(value, str | Range):
                allowed = '"[-] signal [* unit or number] [+ number]" or { signal, low, neutral, high, least, most }'
                raise ValueError(f"{name} is {value!r}; allowed is {allowed}")
        return found

    @model_validator(mode="after")
    def _fits(self) -> "Map":
        taken = HELD if self.position else HELD[:1]
        if twice := [name for name in self.columns if name in taken]:
            raise ValueError(
                f"columns.{twice[0]} is what {'time' if twice[0] == 't_s' else 'position'} makes; leave it out"
            )
        if self.use and not self.use[0] < self.use[1]:
            raise ValueError("use must be [from_s, to_s], the second larger")
        if not self.position and not set(self.columns) & {*POSE, *RATES}:
            raise ValueError(
                f"no pose: give position, or at least one column of {', '.join((*POSE, *RATES))}"
            )
        return self


def read_map(path: Path) -> Map:
    """A map from its file. Raises BadInput."""
    return map_of(read_toml(path), str(path))


def map_of(table: Mapping[str, object], file: str) -> Map:
    """A map from what a file says. Raises BadInput."""
    try:
        return checked(Map, table, file)
    except BadInput as error:
        raise BadInput(str(error) if str(error).startswith(file) else f"{file}: {error}") from None
