"""Corrections that a diagnosis applies to a log automatically, and the findings about them.

Repeated values and outliers are ignored, positions that contradict the velocities and poses that
had queued are dropped, positions that were logged late are moved, outliers of voltages and
currents of the supply are interpolated, and rudder signs are aligned with the vessel.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from boatsim.diagnosis import priors
from boatsim.diagnosis.checks.accelerometer_clock import POSE_CLOCK
from boatsim.diagnosis.checks.finding import Finding
from boatsim.diagnosis.checks.interpolated_samples import (
    INTERPOLATED,
    drop_interpolated_samples,
)
from boatsim.diagnosis.checks.order_signs import REMARK as SIGN_LOST
from boatsim.diagnosis.checks.position_frame import drop_rotated_positions
from boatsim.diagnosis.checks.position_outliers import drop_position_outliers
from boatsim.diagnosis.checks.position_times import LATE_BY_ROWS, correct_position_times
from boatsim.diagnosis.checks.queued_messages import QUEUED, drop_queued_messages
from boatsim.diagnosis.checks.reinterpretations import MIRRORED, MIRRORED_WORDS
from boatsim.diagnosis.checks.repeated_values import (
    FIX_REPEATED,
    VALUE_REPEATED,
    drop_repeated_values,
)
from boatsim.diagnosis.checks.steering_sense import correct_rudder_sense
from boatsim.diagnosis.checks.supply_outliers import (
    CURRENT_OUTLIERS,
    VOLTAGE_OUTLIERS,
    replace_supply_outliers,
)
from boatsim.diagnosis.checks.wrapped_angles import unwrap_directions
from boatsim.diagnosis.config import DEFAULT, ChecksConfig, DiagnosisConfig
from boatsim.physics.vessel import Vessel
from boatsim.recordings.interpolated_wraps import ACROSS_WRAP
from boatsim.recordings.table import BEYOND_RANGE, Recording

# phrase in a remark of a recording -> name of the finding
FINDING_OF_REMARK = {
    POSE_CLOCK: "pose_clock",
    FIX_REPEATED: "position_held",
    VALUE_REPEATED: "channel_held",
    ACROSS_WRAP: "heading_across_wrap",
    INTERPOLATED: "interpolated",
    LATE_BY_ROWS: "position_times",
    QUEUED: "queued_messages",
    "jump away and return": "outliers",
    VOLTAGE_OUTLIERS: "voltage_outliers",
    CURRENT_OUTLIERS: "supply_current_outliers",
    "off the course of the following fixes": "begins_astray",
    "were rotated with the heading": "positions_turned",
    "turns the hull to the other side": "rudder_sense",
    BEYOND_RANGE: "command_range",
    SIGN_LOST: "order_signs",
}

RANGE_REMEDY = (
    "a diagnosis continues with the range of the log; if the commands are right, write that range "
    "into the vessel file"
)


def prepare_recording(
    recording: Recording, vessel: Vessel, config: ChecksConfig = DEFAULT.checks
) -> Recording:
    """Return the usable part of a raw recording with consistent angles, rudder signs and positions.

    Wrapped angles are unwrapped, outliers of measured voltages and currents are interpolated,
    rudder angles get the sign convention of the vessel, and positions that were rotated with the
    boat are dropped.

    Args:
        recording: The recording as read.
        vessel: The vessel that it is a recording of.
        config: Thresholds of the quality checks.

    Returns:
        The prepared recording; its remarks list each correction.
    """
    unwrapped = unwrap_directions(recording.used(), vessel)
    powered = replace_supply_outliers(unwrapped, vessel, config)
    return drop_rotated_positions(correct_rudder_sense(powered, vessel, config), config)


def clean_recording(
    recording: Recording,
    vessel: Vessel,
    duration: float = 0.0,
    config: DiagnosisConfig = DEFAULT,
) -> Recording:
    """Downsample a prepared recording to the useful rate, and drop values that are no measurements.

    These are values that a logger interpolated or repeated, outliers, and poses of messages that
    had queued. Positions that were logged late are moved to the times of their rows first.

    Args:
        recording: A prepared recording.
        vessel: The vessel that it is a recording of.
        duration: Total duration [s] of all recordings of the diagnosis, which sets the rate.
        config: Settings; the groups `checks` and `load` are used.

    Returns:
        The cleaned recording; ignored values are nan, and its remarks list each correction.
    """
    on_time = correct_position_times(drop_queued_messages(recording))
    measured = drop_interpolated_samples(on_time, config.checks)
    reduced = measured.thinned(priors.downsampling_rate(vessel, duration, config.load))
    return drop_faulty_values(reduced, vessel, config)


def drop_faulty_values(
    recording: Recording, vessel: Vessel, config: DiagnosisConfig = DEFAULT
) -> Recording:
    """Return a prepared recording without repeated values and outliers, which become nan.

    Args:
        recording: A prepared recording.
        vessel: The vessel that it is a recording of.
        config: Settings; the groups `checks` and `load` are used.
    """
    return drop_position_outliers(drop_repeated_values(recording), vessel, config)


def total_duration(recordings: Sequence[Recording]) -> float:
    """Return the sum of the durations [s] of several recordings."""
    return float(sum(np.ptp(r.t) for r in recordings))


def cleaning_findings(recording: Recording) -> list[Finding]:
    """Return findings that inform the user about corrections made to a recording automatically.

    The corrections are read from the remarks of the recording, such as dropped outliers.
    """
    file = f"{recording.origin}: "
    found = []
    for remark in recording.remarks:
        for phrase, name in FINDING_OF_REMARK.items():
            if phrase in remark:
                finding = Finding(
                    name,
                    remark.removeprefix(file),
                    "mended",
                    remedy="a diagnosis corrects this automatically",
                )
                if name == "command_range":
                    finding = replace(finding, remedy=RANGE_REMEDY)
                if name == "rudder_sense":
                    finding = replace(finding, alternatives=((MIRRORED_WORDS, MIRRORED),))
                found.append(finding)
    return found
