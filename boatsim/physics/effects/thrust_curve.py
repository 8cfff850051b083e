"""Thrust curve: measured table of the thrust of a drive against its raw command."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from math import isfinite
from typing import Any, ClassVar

from numba import njit

from boatsim.errors import BadInput
from boatsim.physics.base import Array, Boat, ChannelEffect, SignalSegment, param
from boatsim.physics.kinds.channel import MAPS
from boatsim.physics.param import name_code_parameter

MAX_POINTS = 8


@njit(inline="always")
def interpolate_linearly(x: float, x0: float, x1: float, y0: float, y1: float) -> float:
    """Return the value at x of the straight line through (x0, y0) and (x1, y1).

    Args:
        x: Raw command.
        x0: Raw command of the first point.
        x1: Raw command of the second point.
        y0: Thrust of the first point [N].
        y1: Thrust of the second point [N].
    """
    return y0 + (y1 - y0) * (x - x0) / (x1 - x0)


@njit(inline="always")
def table_thrust(x: float, q: Any) -> float:
    """Return the thrust of a table [N], linear between its points and constant beyond them.

    Args:
        x: Raw command.
        q: Points of the table as parameters of the effect.
    """
    x = min(max(x, q.command_1), q.command_8)
    if x <= q.command_2:
        return interpolate_linearly(x, q.command_1, q.command_2, q.thrust_1, q.thrust_2)
    if x <= q.command_3:
        return interpolate_linearly(x, q.command_2, q.command_3, q.thrust_2, q.thrust_3)
    if x <= q.command_4:
        return interpolate_linearly(x, q.command_3, q.command_4, q.thrust_3, q.thrust_4)
    if x <= q.command_5:
        return interpolate_linearly(x, q.command_4, q.command_5, q.thrust_4, q.thrust_5)
    if x <= q.command_6:
        return interpolate_linearly(x, q.command_5, q.command_6, q.thrust_5, q.thrust_6)
    if x <= q.command_7:
        return interpolate_linearly(x, q.command_6, q.command_7, q.thrust_6, q.thrust_7)
    return interpolate_linearly(x, q.command_7, q.command_8, q.thrust_7, q.thrust_8)


@njit(inline="always")
def transform_signal(
    x: SignalSegment, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> SignalSegment:
    """Return the thrust of a drive: its signal plus the thrust of a table by a raw command.

    Args:
        x: Signal of the actuator before the effect, at begin, middle and end of the step.
        side: -1 on the port side, +1 on the starboard side, 0 on the centreline.
        source: Raw command that feeds the channel (`fed_by`).
        memory: Memory of the compiled program.
        at: Index of the first slot of this effect in `memory`.
        dt: Length of the step [s].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        The signal of the actuator after the effect, over the same step.
    """
    given = q.factor * table_thrust(source, q)
    return SignalSegment(x.begin + given, x.middle + given, x.end + given)


@dataclass(frozen=True)
class ThrustCurve(ChannelEffect):
    """Measured curve of the thrust of a drive against its raw command, such as per cent.

    T is `factor` times a function that is linear between the `points` and constant beyond them:
    2 to 8 pairs of a raw command and its thrust [N] by increasing command. The result is added to
    the drive's own command.
    """

    words: ClassVar[str] = "a measured table gives the thrust from the raw command of the drive"
    shown_by: ClassVar[str] = "a staircase of raw commands"
    source: ClassVar[str] = "a bollard pull test of the drive"
    formula: ClassVar[str] = (
        r"T = k \left(T_i + (T_{i+1} - T_i)\,\frac{c - c_i}{c_{i+1} - c_i}\right),"
        r"\qquad c_i \le c \le c_{i+1}"
    )
    symbols: ClassVar = {"factor": "k"}
    acts_on: ClassVar[str] = "thrust"
    stage: ClassVar[int] = MAPS
    transform_signal: ClassVar = transform_signal

    factor: float = param(1.0, low=0.0, high=10.0, unit="", words="thrust over that of the table")
    # pairs of a raw command and its thrust [N]
    points: Sequence[Sequence[float]] = field(default=((-1.0, -1.0), (1.0, 1.0)), kw_only=True)
    command_1: float = name_code_parameter("raw command of point 1")
    command_2: float = name_code_parameter("raw command of point 2")
    command_3: float = name_code_parameter("raw command of point 3")
    command_4: float = name_code_parameter("raw command of point 4")
    command_5: float = name_code_parameter("raw command of point 5")
    command_6: float = name_code_parameter("raw command of point 6")
    command_7: float = name_code_parameter("raw command of point 7")
    command_8: float = name_code_parameter("raw command of point 8")
    thrust_1: float = name_code_parameter("thrust of point 1")
    thrust_2: float = name_code_parameter("thrust of point 2")
    thrust_3: float = name_code_parameter("thrust of point 3")
    thrust_4: float = name_code_parameter("thrust of point 4")
    thrust_5: float = name_code_parameter("thrust of point 5")
    thrust_6: float = name_code_parameter("thrust of point 6")
    thrust_7: float = name_code_parameter("thrust of point 7")
    thrust_8: float = name_code_parameter("thrust of point 8")

    def __post_init__(self) -> None:
        """Check the points.

        Raises:
            BadInput: They are no table with increasing raw commands.
        """
        super().__post_init__()
        allowed = f"2 to {MAX_POINTS} pairs [raw command, thrust in N] by increasing command"
        refusal = BadInput(f"{self.name}.points = {str(self.points)[:80]}; allowed is {allowed}")
        if not isinstance(self.points, list | tuple) or not all(map(_is_pair, self.points)):
            raise refusal
        points = tuple((float(command), float(thrust)) for command, thrust in self.points)
        if not 2 <= len(points) <= MAX_POINTS:
            raise refusal
        for (first, _), (second, _) in pairwise(points):
            if not first < second:
                raise refusal
        object.__setattr__(self, "points", points)

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the points as numbers of the compiled law; the last one is repeated beyond it.

        Args:
            vessel: Vessel on which the effect acts.
        """
        points = [(point[0], point[1]) for point in self.points]
        while len(points) < MAX_POINTS:
            command, thrust = points[-1]
            points.append((command + 1.0, thrust))
        found: dict[str, float] = {}
        for number, (command, thrust) in enumerate(points, 1):
            found[f"command_{number}"] = command
            found[f"thrust_{number}"] = thrust
        return found

    def fixed_settings(self) -> dict[str, object]:
        """Return the settings that no fit changes: the points."""
        return {"points": [list(point) for point in self.points]} | super().fixed_settings()


def _is_pair(point: object) -> bool:
    if not isinstance(point, list | tuple) or len(point) != 2:
        return False
    return all(type(x) in (int, float) and isfinite(x) and abs(x) < 1e9 for x in point)
