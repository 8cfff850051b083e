"""Standards for ship manoeuvrability of the International Maritime Organization, resolution MSC.137(76).

They are meant for ships of 100 m and more; for anything smaller they are a yardstick. Lengths in ship lengths, angles
in degrees, as the resolution has them.
"""

ADVANCE = 4.5  # [L] turning circle
TACTICAL_DIAMETER = 5.0  # [L]
TRACK_TO_10 = 2.5  # [L] to a heading change of 10 deg with 10 deg of helm
OVERSHOOT_20 = 25.0  # [deg] first of the 20/20 zig-zag
TRACK_REACH = 15.0  # [L] full astern stopping test; an administration may allow up to 20


def first_overshoot_10(length: float, speed: float) -> float:
    """Largest first overshoot [deg] of the 10/10 zig-zag of a ship of `length` [m] at `speed` [m/s]."""
    ratio = length / speed
    return 10.0 if ratio < 10.0 else 20.0 if ratio >= 30.0 else 5.0 + 0.5 * ratio


def second_overshoot_10(length: float, speed: float) -> float:
    """Largest second overshoot [deg] of the 10/10 zig-zag."""
    ratio = length / speed
    return 25.0 if ratio < 10.0 else 40.0 if ratio >= 30.0 else 17.5 + 0.75 * ratio


def limits(manoeuvre: str, angle: float, length: float, speed: float) -> dict[str, float]:
    """Norm -> its largest value, for a manoeuvre with a helm `angle` [deg]; empty where the resolution has none."""
    if manoeuvre == "turning_circle" and abs(angle) == 35.0:
        return {"advance": ADVANCE, "tactical_diameter": TACTICAL_DIAMETER}
    if manoeuvre == "zigzag" and abs(angle) == 10.0:
        first, second = first_overshoot_10(length, speed), second_overshoot_10(length, speed)
        return {
            "track_to_reversal": TRACK_TO_10,
            "first_overshoot": first,
            "second_overshoot": second,
        }
    if manoeuvre == "zigzag" and abs(angle) == 20.0:
        return {"first_overshoot": OVERSHOOT_20}
    return {"track_reach": TRACK_REACH} if manoeuvre == "crash_stop" else {}
