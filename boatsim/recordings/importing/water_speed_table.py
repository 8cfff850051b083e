"""Table of a map for the current by a speed through the water."""

from pydantic import Field

from boatsim.files import Table

NORTH, EAST = "current_north_mps", "current_east_mps"  # columns by which effects know a current


class WaterSpeed(Table):
    """The current by a log of speed, the track and the heading.

    Attributes:
        speed: Expression of the speed through the water, ahead, in m/s.
        across: Expression of that to starboard in m/s; without it 0 on average.
        window: Time over which the current is averaged [s]. A tidal stream changes within an hour;
            positions with an error of 1 m give a current to about 0.05 m/s in half a minute.
        north: Column of the velocity of the water to north.
        east: Column of that to east.
    """

    speed: str
    across: str | None = None
    window: float = Field(30.0, gt=0.0, le=3600.0)
    north: str = NORTH
    east: str = EAST
