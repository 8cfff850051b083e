"""What a report says of a mean force that stays in the patched vessel."""

from boatsim.diagnosis.report.formatting import listed, number, quantity
from boatsim.diagnosis.report.schema import Answer, MeanEntry

WAYS = {  # axis -> where a positive one pushes or turns, and a negative one
    "surge": ("forward", "astern"),
    "sway": ("to starboard", "to port"),
    "heave": ("down", "up"),
    "roll": ("that heels her to starboard", "that heels her to port"),
    "pitch": ("bow up", "bow down"),
    "yaw": ("bow to starboard", "bow to port"),
}


def in_words(answer: Answer, patched: bool) -> list[str]:
    """A line if one stays, none if not: how much, which way, share of full thrust."""
    found = answer.get("mean_left") or {}
    if not found:
        return []
    vessel = "the patched vessel" if patched else "the vessel with its own coefficients refitted"
    return [
        f"A mean force stays in {vessel}: {listed(_said(axis, m) for axis, m in found.items())}, on average over all "
        "recordings. No part of the model makes it; a controller without integral action is left with an offset by it."
    ]


def _said(axis: str, m: MeanEntry) -> str:
    way = WAYS[axis][0 if m["mean"] > 0.0 else 1]
    share = m.get("share_of_full_thrust")
    of_thrust = f" ({number(100.0 * share, 2)} % of full thrust)" if share is not None else ""
    return f"{quantity(abs(m['mean']), m['unit'], m['sd'])} {way} in {axis}{of_thrust}"
