"""What a diagnosis leaves out of a log or turns round by itself: repeated and outlying fixes, positions, a rudder."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from boatsim.diagnosis import priors
from boatsim.diagnosis.checks.finding import Finding
from boatsim.diagnosis.checks.position_frame import in_one_frame
from boatsim.diagnosis.checks.position_outliers import without_outliers
from boatsim.diagnosis.checks.reinterpretations import MIRRORED
from boatsim.diagnosis.checks.repeated_positions import without_repeats
from boatsim.diagnosis.checks.steering_sense import steered
from boatsim.diagnosis.checks.wrapped_angles import unwound
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

MENDED = {  # what a remark says -> the finding
    "repeat each fix": "position_held",
    "leap away and come back": "outliers",
    "off the course behind it": "begins_astray",
    "were turned with the heading": "positions_turned",
    "turns the other way": "rudder_sense",
}


def opened(recording: Recording, vessel: Vessel) -> Recording:
    """A recording as read, in one frame, with rudders counted as the vessel does."""
    return in_one_frame(steered(unwound(recording.used(), vessel), vessel))


def thinned(recording: Recording, vessel: Vessel, lasts: float = 0.0) -> Recording:
    """An opened recording with as many rows as are of use, without fixes that are none.

    `lasts` is how long [s] all the recordings are, of which it is one.
    """
    return without_outliers(without_repeats(recording.thinned(priors.rate(vessel, lasts))), vessel)


def lasting(recordings: Sequence[Recording]) -> float:
    """How long [s] recordings are together."""
    return float(sum(np.ptp(r.t) for r in recordings))


def findings(recording: Recording) -> list[Finding]:
    """What the remarks of a recording say of what was left out."""
    found = []
    for remark in recording.remarks:
        for words, name in MENDED.items():
            if words in remark:
                where = f"{recording.path or recording.name}: "
                made = Finding(
                    name, remark.removeprefix(where), "mended", remedy="a diagnosis allows for it"
                )
                if name == "rudder_sense":
                    made = replace(
                        made, alternatives=(("y and the heading are counted to port", MIRRORED),)
                    )
                found.append(made)
    return found
