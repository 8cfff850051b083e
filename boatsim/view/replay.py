"""The replay of a page: boats that move over a figure, as frames for the script of the page."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, pi, sin
from typing import NotRequired, TypedDict

import numpy as np

from boatsim.physics.base import Array

LONGEST_REPLAY = 40.0  # [s]; a longer run or recording is played faster
SPEEDS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)  # times real time
MARGIN = 0.06  # of the range of each axis, on each side
# to starboard and down
SECTION = ((-0.5, -0.3), (0.5, -0.3), (0.5, 0.1), (0.3, 0.3), (-0.3, 0.3), (-0.5, 0.1))
SECTION_SIZE = 0.2  # size of the drawn midship section, relative to the height of the figure
MARK = tuple((0.5 * cos(k * pi / 4), 0.5 * sin(k * pi / 4)) for k in range(8))
MARK_SIZE = 0.03  # size of the mark, relative to the height of the figure

Outline = list[tuple[float, float]]


class Boat(TypedDict):
    """A boat drawn in a replay: its position and rotation in each frame.

    Values are None where nothing was recorded.
    """

    look: str  # class of the style sheet
    name: str  # words of the legend
    x: list[float | None]
    y: list[float | None]
    turned: list[float | None]  # [rad] clockwise


class Readout(TypedDict):
    """A number that a replay prints below its figure, in each frame."""

    name: str
    unit: str
    decimals: int
    values: list[float | None]


class Animation(TypedDict):
    """Data of a replay, which the script of the HTML page plays."""

    t: list[float]  # [s]; two equal times where a new free run starts
    start: int  # first frame shown
    rate: int  # times real time
    plan: bool  # seen from above [m], with the distance from the recording as text
    unit: str
    outline: Outline  # to the right and down, in units of the vertical axis of the figure
    boats: list[Boat]
    readouts: NotRequired[list[Readout]]  # numbers below the figure
    cursor: NotRequired[bool]  # whether the plots over time of the page show the time of the replay


@dataclass(frozen=True)
class Replay:
    """The animated figure of a page and its data; `legend` and `picture` are mark-up."""

    title: str
    about: str
    legend: str
    picture: str
    film: Animation


def playback_speed(seconds: float) -> int:
    """Return the slowest speed at which a replay of so many seconds is short enough.

    Args:
        seconds: Length of the run or recording [s].

    Returns:
        Factor of real time.
    """
    for speed in SPEEDS:
        if seconds <= speed * LONGEST_REPLAY:
            return speed
    return SPEEDS[-1]


def rounded_or_none(values: Array, decimals: int) -> list[float | None]:
    """Return rounded numbers with None in the place of nan, for JSON."""
    rounded = np.round(values, decimals).astype(object)
    rounded[~np.isfinite(values)] = None
    numbers: list[float | None] = rounded.tolist()
    return numbers


def axis_limits_with_margin(limits: tuple[float, float]) -> tuple[float, float]:
    """Return limits of an axis with room for boats at the ends of their paths."""
    low, high = limits
    return low - MARGIN * (high - low), high + MARGIN * (high - low)


def scaled_outline(shape: Sequence[tuple[float, float]], across: float, down: float) -> Outline:
    """Return an outline in units of the figure, to four digits."""
    return [(float(f"{across * a:.4g}"), float(f"{down * b:.4g}")) for a, b in shape]
