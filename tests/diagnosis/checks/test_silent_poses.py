"""A recording whose poses were not measured is reported, and no diagnosis invents a motion for it."""

from pathlib import Path

import numpy as np
import pytest

from boatsim.diagnosis.checks.silent_poses import check_silent_poses
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.loading import Request, load_recordings
from boatsim.errors import BadInput
from boatsim.physics.vessel import load_vessel
from boatsim.recordings.table import Recording, write_csv

T = np.arange(0.0, 60.0, 0.1)
NOTHING = np.full(len(T), np.nan)
BOAT = load_vessel("blueboat")
COMMANDS = {"thrust_port_N": 10.0 * np.sin(T), "thrust_starboard_N": 10.0 * np.cos(T)}
EMPTY = {"x_m": NOTHING, "y_m": NOTHING, "psi_rad": NOTHING}
ONE_VALUE = {"x_m": 0.0 * T + 3.2, "y_m": 0.0 * T, "psi_rad": 0.0 * T + 1.1}


@pytest.mark.parametrize(
    ("poses", "said"),
    [
        (EMPTY, "no pose is measured: x_m, y_m and psi_rad without a value in all 600 rows"),
        (
            ONE_VALUE,
            "no motion is measured: x_m, y_m and psi_rad with one value in all 600 rows, although "
            "thrust_port_N moves; the sensor recorded nothing, or the vessel was held",
        ),
    ],
)
def test_poses_that_were_not_measured_are_reported_and_refused(poses, said, tmp_path) -> None:
    recording = Recording("run", T, {**poses, **COMMANDS})
    (finding,) = check_silent_poses(recording, BOAT, DEFAULT.checks)
    assert (finding.name, finding.kind, finding.evidence) == ("poses_silent", "fault", said)
    file = Path(tmp_path / "run.csv")
    write_csv(recording, file)
    with pytest.raises(BadInput) as error:
        load_recordings(Request([file], vessel="blueboat"))
    assert f"{said}; leave this recording out" in str(error.value)
    assert "run.csv" in str(error.value)


@pytest.mark.parametrize(
    "signals",
    [
        {**ONE_VALUE, "psi_rad": 0.01 * np.sin(T), **COMMANDS},  # a boat that only turns
        {**EMPTY, "x_m": np.where(T < 30.0, T, np.nan), **COMMANDS},  # a part was measured
        {**ONE_VALUE, "r_radps": 0.01 * np.sin(T), **COMMANDS},  # a gyro shows the motion
        {**ONE_VALUE, "thrust_port_N": 0.0 * T, "thrust_starboard_N": 0.0 * T},  # a boat at rest
    ],
    ids=["turns", "measured in part", "gyro", "at rest"],
)
def test_poses_that_show_some_motion_or_rest_are_no_fault(signals) -> None:
    assert check_silent_poses(Recording("run", T, signals), BOAT, DEFAULT.checks) == []
