"""Late columns of a recording are moved to the times at which they were true, and no value changes."""

from pathlib import Path

import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.recordings.table import Recording, TimedCommands, read


def x(t):
    return 1.5 * t + np.sin(0.4 * t)


def psi(t):
    return 0.8 * np.sin(0.3 * t)


def thrust(t):
    return np.where(np.floor(t / 3.0) % 2 > 0, 20.0, 40.0)


def written(folder: Path, late: float, notes: str, every: int = 1) -> Path:
    """A recording of 40 s at 10 Hz whose positions are late, with its notes."""
    t = np.round(np.arange(0.0, 40.0, 0.1), 6)
    lines = ["t_s,x_m,y_m,psi_rad,thrust_motor_N"]
    for i, now in enumerate(t):
        fix = f"{x(now - late):.9f},{0.5 * x(now - late):.9f}" if i % every == 0 else ","
        lines.append(f"{now:.6f},{fix},{psi(now):.9f},{thrust(now + 1e-9):.3f}")
    (folder / "run.csv").write_text("\n".join(lines) + "\n")
    (folder / "recording.toml").write_text(notes)
    return folder / "run.csv"


@pytest.mark.parametrize("every", [1, 2])
@pytest.mark.parametrize("late", [0.3, 0.43, -0.25])
def test_late_positions_are_those_of_their_rows(tmp_path, late, every):
    notes = f"[latency]\nx_m = {late}\ny_m = {late}\n"
    run = read(written(tmp_path, late, notes, every), {"thrust_motor_N": (0.0, 50.0)})
    known = np.isfinite(run["x_m"])
    assert known.sum() > 390 // every
    assert run["x_m"][known] == pytest.approx(x(run.t[known]), abs=1e-6)
    assert np.array_equal(np.isfinite(run["y_m"]), known)
    headings = np.isfinite(run["psi_rad"])
    assert run["psi_rad"][headings] == pytest.approx(psi(run.t[headings]), abs=1e-6)
    assert headings.sum() > 390
    off = np.abs((run.t + 1.5) % 3.0 - 1.5) > 0.11  # not in the row of a step
    assert run["thrust_motor_N"][off] == pytest.approx(thrust(run.t[off]))
    assert (np.diff(run.t) > 0.0).all()


def test_a_late_command_is_in_force_earlier(tmp_path):
    run = read(written(tmp_path, 0.0, "latency.thrust_motor_N = 0.5\n"))
    assert run["thrust_motor_N"][:-6] == pytest.approx(thrust(run.t[:-6] + 0.5 + 1e-9))


def test_no_command_is_known_before_a_command_that_acts_later(tmp_path):
    run = read(written(tmp_path, 0.0, "latency.thrust_motor_N = -0.54\n"))
    assert np.isfinite(run["thrust_motor_N"]).all()
    off = np.abs((run.t - 0.54 + 1.5) % 3.0 - 1.5) > 0.11  # not in the row of a step
    assert run["thrust_motor_N"][off] == pytest.approx(thrust(run.t[off] - 0.54 + 1e-9))


def test_commands_at_their_own_times_are_moved_with_their_columns():
    t = np.arange(0.0, 10.0, 0.1)
    fine = np.arange(0.0, 10.0, 0.01)
    orders = TimedCommands(fine, {"thrust_N": np.floor(fine), "steer_rad": np.floor(2.0 * fine)})
    run = Recording("run", t, {"thrust_N": np.floor(t), "steer_rad": t}, orders=orders)
    moved = run.without_latency({"thrust_N": -0.253}).orders
    at = np.arange(1.0, 9.0, 0.0173)
    last = np.searchsorted(moved.t, at, side="right") - 1
    assert moved.signals["steer_rad"][last] == pytest.approx(np.floor(2.0 * at))
    assert moved.signals["thrust_N"][last] == pytest.approx(np.floor(at - 0.253))


def test_a_wrong_column_and_half_a_fix_are_refused_in_one_line(tmp_path):
    with pytest.raises(BadInput, match="latency: column 'psi_deg' does not exist"):
        read(written(tmp_path, 0.0, "latency.psi_deg = 0.5\n"))
    with pytest.raises(BadInput, match="one measurement"):
        read(written(tmp_path, 0.0, "latency.x_m = 0.5\n"))
    with pytest.raises(BadInput, match="allowed is -60 to 60 s"):
        read(written(tmp_path, 0.0, "latency.psi_rad = 100.0\n"))


def test_a_column_that_ends_early_leaves_the_rows_of_the_motion(tmp_path):
    """Such as the view of a camera that the boat leaves."""
    path = written(tmp_path, 0.3, "[latency]\nx_m = 0.3\ny_m = 0.3\n")
    head, *lines = path.read_text().splitlines()
    seen = [f"{line},{'1.5' if i < 20 else ''}" for i, line in enumerate(lines)]
    path.write_text("\n".join([f"{head},camera_x_m", *seen]) + "\n")
    run = read(path)
    assert len(run) > 390
    assert np.isfinite(run["camera_x_m"]).sum() == 20
