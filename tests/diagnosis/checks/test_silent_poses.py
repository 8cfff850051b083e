"""A recording whose poses were not measured is reported, and no diagnosis invents a motion for it."""

from pathlib import Path

import numpy as np
import pytest

from boatsim.diagnosis.checks.silent_poses import check_silent_poses
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.loading import LoadedRecordings, Request, load_recordings
from boatsim.diagnosis.log_check import check_files
from boatsim.errors import BadInput
from boatsim.physics.vessel import load_vessel
from boatsim.recordings.table import Recording, write_csv

T = np.arange(0.0, 60.0, 0.1)
NOTHING = np.full(len(T), np.nan)
BOAT = load_vessel("blueboat")
COMMANDS = {"thrust_port_N": 10.0 * np.sin(T), "thrust_starboard_N": 10.0 * np.cos(T)}
EMPTY = {"x_m": NOTHING, "y_m": NOTHING, "psi_rad": NOTHING}
ONE_VALUE = {"x_m": 0.0 * T + 3.2, "y_m": 0.0 * T, "psi_rad": 0.0 * T + 1.1}
MOVING = {"x_m": 0.3 * T, "y_m": 0.1 * np.sin(T), "psi_rad": 0.1 * np.sin(0.3 * T)}
SAID = {
    "empty": "no pose is measured: x_m, y_m and psi_rad empty in all 600 rows",
    "one value": "no motion is measured: x_m, y_m and psi_rad with one value in all 600 rows, "
    "although thrust_port_N moves; the sensor recorded nothing, or the vessel was held",
}


def written(folder: Path, name: str, *parts: dict) -> Path:
    """A file of one recording; of several parts, notes that select each of them."""
    signals = {key: np.concatenate([part[key] for part in parts]) for key in parts[0]}
    signals |= {key: np.tile(values, len(parts)) for key, values in COMMANDS.items()}
    t = np.arange(len(signals["x_m"])) * 0.1
    write_csv(Recording(name, t, signals), folder / f"{name}.csv")
    text = 'vessel = "blueboat"\n'
    if len(parts) > 1:
        spans = [[60.0 * k, 60.0 * k + 59.95] for k in range(len(parts))]
        text += f"use = {spans}\n"
    (folder / "recording.toml").write_text(text)
    return folder / f"{name}.csv"


def loaded(*files: Path, hold_out: tuple[Path, ...] = ()) -> LoadedRecordings:
    return load_recordings(Request(files, hold_out))


@pytest.mark.parametrize(("poses", "kind"), [(EMPTY, "empty"), (ONE_VALUE, "one value")])
def test_poses_that_were_not_measured_are_reported_and_refused(poses, kind, tmp_path) -> None:
    (finding,) = check_silent_poses(
        Recording("run", T, {**poses, **COMMANDS}), BOAT, DEFAULT.checks
    )
    assert (finding.name, finding.kind, finding.evidence) == ("poses_silent", "fault", SAID[kind])
    file = written(tmp_path, "run", poses)
    entries, refused = check_files([file])
    assert [entry["name"] for entry in entries[file]] == ["poses_silent"]
    assert not refused
    with pytest.raises(BadInput) as error:
        loaded(file)
    assert str(error.value).endswith(f"run.csv: {SAID[kind]}; leave this recording out")


@pytest.mark.parametrize(("poses", "kind"), [(EMPTY, "empty"), (ONE_VALUE, "one value")])
def test_a_diagnosis_goes_on_with_the_other_recordings(poses, kind, tmp_path) -> None:
    files = [written(tmp_path, "good", MOVING), written(tmp_path, "bad", poses)]
    files.append(written(tmp_path, "other", MOVING))
    found = loaded(*files[:2], hold_out=(files[2],))
    assert [one.name for one in found.fitted] == ["good"]
    (finding,) = [one for one in found.findings if one.name == "poses_silent"]
    assert finding.kind == "mended"
    assert finding.evidence == f"{SAID[kind]}; the diagnosis leaves bad out"
    with pytest.raises(BadInput, match=r"bad\.csv: no .*; leave this recording out"):
        loaded(files[0], hold_out=(files[1],))
    with pytest.raises(BadInput, match=r"bad\.csv: no .*; leave this recording out"):
        loaded(files[1], hold_out=(files[0],))


def test_the_part_of_a_file_before_a_start_is_left_out(tmp_path) -> None:
    file = written(tmp_path, "run", ONE_VALUE, MOVING)
    found = loaded(file)
    assert "the diagnosis leaves run (part 1) out" in found.findings[0].evidence
    assert {one.name.partition(" (")[0] for one in (*found.fitted, *found.held_out)} == {"run"}
    entries, _ = check_files([file])
    assert "poses_silent" in [entry["name"] for entry in entries[file]]


@pytest.mark.parametrize(
    "signals",
    [
        {**ONE_VALUE, "psi_rad": 0.01 * np.sin(T), **COMMANDS},
        {**EMPTY, "x_m": np.where(T < 30.0, T, np.nan), **COMMANDS},
        {**ONE_VALUE, "r_radps": 0.01 * np.sin(T), **COMMANDS},
        {**ONE_VALUE, "thrust_port_N": 0.0 * T, "thrust_starboard_N": 0.0 * T},
        {**ONE_VALUE, "thrust_port_N": 0.01 * np.sin(T), "thrust_starboard_N": 0.0 * T},
    ],
    ids=["turns", "measured in part", "gyro", "at rest", "at rest, with noise of a stick"],
)
def test_poses_that_show_some_motion_or_rest_are_no_fault(signals) -> None:
    assert check_silent_poses(Recording("run", T, signals), BOAT, DEFAULT.checks) == []
