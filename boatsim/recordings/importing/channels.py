"""Command channels of a vessel, as far as the map of a log depends on them."""

from dataclasses import dataclass

SIDED = ("port", "starboard")  # sides of two drives that turn the vessel by their difference


@dataclass(frozen=True)
class VesselChannel:
    """A command channel of a vessel.

    Attributes:
        name: Name of the channel.
        low: Smallest value.
        high: Largest value.
        turns: Side to which a positive value turns the vessel: 1 starboard, -1 port, 0 unknown.
        lever: Moment to starboard per thrust ahead of a fixed drive [m]; None for another channel.
        coefficients: Thrust per square of the shaft rate, ahead and astern [N s^2/rad^2]; None for
            a channel that is no shaft rate.
        ahead: Value of the channel at which the vessel reaches `approach_speed`; 0 if unknown.
    """

    name: str
    low: float
    high: float
    turns: int = 0
    lever: float | None = None
    coefficients: tuple[float, float] | None = None
    ahead: float = 0.0
