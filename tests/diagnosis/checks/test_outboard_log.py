"""A boat with one outboard motor, gently driven: what is wrong with its log is found, a good one is
left in peace."""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from alike import long
from typer.testing import CliRunner

from boatsim.cli.commands import app
from boatsim.diagnosis.checks.course_over_ground import heading_offset
from boatsim.diagnosis.log_check import check_files
from boatsim.physics import vessel as vessels
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.importing.recording_notes import recording_notes_text
from boatsim.recordings.table import Recording
from boatsim.simulate.batch import Batch
from validation.log_faults import Columns, write

FULL = 1300.0  # [N]
RATE = 5.0  # [Hz] of rows
PLAN = (  # seconds, share of full ahead, helm [rad]
    (15, 0.6, 0.0), (10, 0.6, 0.25), (15, 0.75, 0.0), (12, 0.5, -0.3), (15, 0.6, 0.0), (8, -0.45, 0.0), (8, 0.3, 0.3),
    (15, 0.7, 0.0), (14, 0.6, 0.2), (20, 0.6, 0.0),
)  # fmt: skip


@pytest.fixture(scope="module")
def rib(tmp_path_factory: pytest.TempPathFactory) -> Vessel:
    home = tmp_path_factory.mktemp("boats") / "rib"
    size = ["--length", "5.57", "--beam", "2.29", "--mass", "956", "--hulls", "1", "--speed", "3.6"]
    made = CliRunner().invoke(app, ["new", str(home), *size, f"--steered=-2.45,0.00,{FULL:g},830"])
    assert made.exit_code == 0, made.output
    return vessels.load_vessel(str(home))


def sailed(boat: Vessel, share: float = 1.0, current: complex = 0.0) -> Columns:
    """The plan with a share of its thrust; the drag is a half more than the vessel's, as
    particulars miss it."""
    orders = np.concatenate(
        [np.tile([share * FULL * a, b], (round(s * RATE), 1)) for s, a, b in PLAN]
    )
    felt = orders * [1.0 / 1.5, 1.0]
    states = Batch(boat, step=0.02).rollout(np.zeros(6), felt, 1.0 / RATE)[: len(orders)]
    t = np.arange(len(orders)) / RATE
    seen = states[:, :3] + np.random.default_rng(3).standard_normal((len(t), 3)) * [
        0.02,
        0.02,
        0.01,
    ]
    seen[:, :2] += np.outer(t, [current.real, current.imag])
    pose = dict(zip(("x_m", "y_m", "psi_rad"), seen.T, strict=True))
    return {"t_s": t, **pose, **dict(zip(boat.commands, orders.T, strict=True))}


def found_in(log: Columns, boat: Vessel, folder: Path) -> list[Mapping[str, Any]]:
    write(log, folder / "run.csv")
    found, refused = check_files([folder / "run.csv"], str(Path(str(boat.file)).parent))
    assert not refused, refused
    return [e for entries in found.values() for e in entries if e["kind"] == "fault"]


def in_per_cent(log: Columns) -> Columns:
    return log | {"thrust_motor_N": np.round(100.0 * log["thrust_motor_N"] / FULL, 1)}


def turned(log: Columns, degrees: float) -> Columns:
    return log | {"psi_rad": log["psi_rad"] + np.radians(degrees)}


@pytest.mark.slow
def test_per_cent_within_the_range_of_newtons_are_found(rib: Vessel, tmp_path: Path) -> None:
    entry = found_in(in_per_cent(sailed(rib)), rib, tmp_path)[0]
    assert entry["name"] == "command_unit" and "per cent" in entry["evidence"]
    assert entry["lines"][-1] == 'thrust_motor_N = "thrust_motor_N * 13"'


@pytest.mark.parametrize("share", [1.0, 0.1])
def test_a_boat_that_is_driven_with_little_thrust_is_left_in_peace(
    rib: Vessel, share: float, tmp_path: Path
) -> None:
    assert not found_in(sailed(rib, share), rib, tmp_path)


@pytest.mark.slow
def test_a_compass_turned_by_an_odd_angle_is_found_to_the_degree(
    rib: Vessel, tmp_path: Path
) -> None:
    entry = found_in(turned(sailed(rib), -35.0), rib, tmp_path)[0]
    assert entry["name"] == "heading_turned"
    (degrees,) = re.findall(r"psi_rad \+ ([\d.]+) \* deg", entry["lines"][-1])
    assert abs(float(degrees) - 35.0) <= 3.0


@pytest.mark.parametrize("current", [0.0, 0.6j, 0.5 - 0.3j])
@pytest.mark.parametrize("degrees", [0.0, -35.0, 120.0])
def test_way_and_bow_tell_a_turned_compass_from_a_current(
    rib: Vessel, current: complex, degrees: float
) -> None:
    log = turned(sailed(rib, current=current), degrees)
    angle = heading_offset(
        [Recording("run", log["t_s"], {n: v for n, v in log.items() if n != "t_s"})], rib
    )
    assert angle is not None
    assert abs(np.angle(np.exp(1j * (angle + np.radians(degrees))))) < np.radians(4.0)


def test_on_one_course_nobody_can_tell_a_current_from_a_compass(rib: Vessel) -> None:
    t: Array = np.arange(0.0, 60.0, 0.2)
    log = {"x_m": 2.0 * t, "y_m": 1.2 * t, "psi_rad": 0.0 * t, "thrust_motor_N": 0.0 * t + 500.0}
    assert heading_offset([Recording("run", t, log | {"steer_motor_rad": 0.0 * t})], rib) is None


@pytest.mark.parametrize("imported", [long(False), True])
@pytest.mark.slow
def test_what_is_advised_may_be_written_at_the_end_of_the_file(
    rib: Vessel, imported: bool, tmp_path: Path
) -> None:
    notes = tmp_path / "recording.toml"
    if imported:
        notes.write_text(
            recording_notes_text(tmp_path / "run.csv", str(Path(str(rib.file)).parent), "gnss")
        )
    log = sailed(rib)
    late = np.arange(len(log["t_s"])) > 480
    leaps = in_per_cent(log) | {"x_m": log["x_m"] + 40.0 * late}
    before = found_in(leaps, rib, tmp_path)
    use = next(line for e in before for line in e["lines"] if line.startswith("use = "))
    with notes.open("a") as file:
        file.write(f"{use}\n")
    left = found_in(leaps, rib, tmp_path)
    assert "position_leaps" in {e["name"] for e in before} - {None} and "position_leaps" not in {
        e["name"] for e in left
    }
    with notes.open("a") as file:
        file.write("\n".join(next(e["lines"] for e in left if e["lines"])) + "\n")
    assert not found_in(leaps, rib, tmp_path)
