"""Standards for ship manoeuvrability of the International Maritime Organization, MSC.137(76).

They apply to ships of 100 m and more and serve as a comparison for anything smaller. As in the
resolution, lengths are in ship lengths [L] and angles in degrees.
"""

from typing import NamedTuple

ADVANCE = 4.5  # [L] turning circle
TACTICAL_DIAMETER = 5.0  # [L]
TRACK_TO_10 = 2.5  # [L] to a heading change of 10 deg with 10 deg of helm
OVERSHOOT_20 = 25.0  # [deg] first of the 20/20 zig-zag
TRACK_REACH = 15.0  # [L] full astern stopping test; an administration may allow up to 20


class OvershootLimit(NamedTuple):
    """IMO limit of a zig-zag overshoot angle, a function of ship length over speed L/V.

    The limit is `short` below L/V = 10 s, `long` from 30 s on, and `offset` + `slope` L/V in
    between.
    """

    short: float  # [deg]
    long: float  # [deg]
    offset: float  # [deg]
    slope: float  # [deg/s]

    def overshoot_limit(self, length: float, speed: float) -> float:
        """Return the IMO limit of an overshoot [deg] for a ship's length [m], speed [m/s]."""
        ratio = length / speed
        if ratio < 10.0:
            return self.short
        if ratio >= 30.0:
            return self.long
        return self.offset + self.slope * ratio


FIRST_OVERSHOOT_10 = OvershootLimit(10.0, 20.0, 5.0, 0.5)  # of the 10/10 zig-zag
SECOND_OVERSHOOT_10 = OvershootLimit(25.0, 40.0, 17.5, 0.75)


def imo_limits(manoeuvre: str, angle: float, length: float, speed: float) -> dict[str, float]:
    """Return the limits of IMO resolution MSC.137(76) for the metrics of a ship manoeuvre.

    Args:
        manoeuvre: Name of the manoeuvre.
        angle: Helm [deg].
        length: Length of the ship [m].
        speed: Speed of the approach [m/s].

    Returns:
        Metric -> its largest value; empty where the resolution has no limits.
    """
    if manoeuvre == "turning_circle" and abs(angle) == 35.0:
        return {"advance": ADVANCE, "tactical_diameter": TACTICAL_DIAMETER}
    if manoeuvre == "zigzag" and abs(angle) == 10.0:
        return {
            "track_to_reversal": TRACK_TO_10,
            "first_overshoot": FIRST_OVERSHOOT_10.overshoot_limit(length, speed),
            "second_overshoot": SECOND_OVERSHOOT_10.overshoot_limit(length, speed),
        }
    if manoeuvre == "zigzag" and abs(angle) == 20.0:
        return {"first_overshoot": OVERSHOOT_20}
    if manoeuvre == "crash_stop":
        return {"track_reach": TRACK_REACH}
    return {}
