"""Poses of messages that queued during a stall are recognised by the motion, and dropped."""

from pathlib import Path

import numpy as np
import pytest

from boatsim.diagnosis.checks.data_cleaning import clean_recording, cleaning_findings
from boatsim.diagnosis.checks.queued_messages import drop_queued_messages
from boatsim.physics.vessel import load_vessel
from boatsim.recordings.importing.convert import convert_log
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.mapping import parse_map
from boatsim.recordings.importing.queued_messages import Queue, late_samples, queued_positions
from boatsim.recordings.table import Recording

SPEED, YAW_RATE = 1.5, 0.08  # [m/s], [rad/s] of a boat on a circle
STALL, GAP, TIMES_AS_FAST = 40.0, 12.0, 3.0  # [s] begin and duration; the queue is read so fast
EMPTY = STALL + GAP + GAP / (TIMES_AS_FAST - 1.0)  # [s] when the last message is on time


def measured_at(t: np.ndarray, queue: bool) -> np.ndarray:
    """When the message that is read at a time was sent [s]."""
    late = STALL + TIMES_AS_FAST * (t - STALL - GAP)
    reading = queue & (t > STALL) & (t < EMPTY)
    return np.where(reading, late, t)


def circle(t: np.ndarray) -> dict[str, np.ndarray]:
    radius = SPEED / YAW_RATE
    psi = YAW_RATE * t
    return {"x_m": radius * np.sin(psi), "y_m": -radius * np.cos(psi), "psi_rad": psi}


def log(queue: bool = True, noise: float = 0.03, seed: int = 1) -> Recording:
    rng = np.random.default_rng(seed)
    t = np.sort(np.arange(0.0, 120.0, 0.2) + rng.uniform(-0.04, 0.04, 600)).clip(0.0)
    t = t[(t <= STALL) | (t >= STALL + GAP)]
    signals = circle(measured_at(t, queue))
    signals = {name: v + noise * rng.standard_normal(len(t)) for name, v in signals.items()}
    signals["r_radps"] = YAW_RATE + 0.01 * rng.standard_normal(len(t))
    signals["n_port_radps"], signals["n_starboard_radps"] = 40.0 + 0.1 * t, 40.0 - 0.1 * t
    return Recording("run", t, signals)


@pytest.mark.parametrize("seed", range(5))
def test_the_queue_is_found_from_its_stall_to_its_end(seed: int) -> None:
    run = log(seed=seed)
    ((last, begin, end),) = queued_positions(run.t, run["x_m"], run["y_m"])
    assert last == pytest.approx(STALL, abs=0.3) and begin == pytest.approx(STALL + GAP, abs=0.3)
    assert end == pytest.approx(EMPTY, abs=0.7)


def test_poses_that_had_queued_are_dropped_and_orders_stay() -> None:
    run, otter = log(), load_vessel("otter")
    found = drop_queued_messages(run)
    late = (run.t > STALL + 0.3) & (run.t < EMPTY - 0.7)
    other = (run.t < STALL - 0.3) | (run.t > EMPTY + 0.7)
    assert late.sum() > 20
    for name in ("x_m", "y_m", "psi_rad", "r_radps"):
        assert np.isnan(found[name][late]).all()
        assert np.array_equal(found[name][other], run[name][other])
    assert np.array_equal(found["n_port_radps"], run["n_port_radps"])
    (finding,) = [
        one
        for one in cleaning_findings(clean_recording(run, otter))
        if one.name == "queued_messages"
    ]
    assert finding.kind == "mended" and "stands still over the gap" in finding.evidence


def stopped(t: np.ndarray) -> np.ndarray:
    """Distance [m] of a boat that stops in a stall without orders and gets going again."""
    rest = (t > STALL) & (t < STALL + GAP)
    speed = np.where(rest, SPEED * np.exp(-(t - STALL)), SPEED)
    after = t >= STALL + GAP
    speed = np.where(after, SPEED * (1.0 - np.exp(-(t - STALL - GAP))), speed)
    return np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(t))])


def test_a_gap_in_which_the_boat_moves_on_is_no_queue() -> None:
    run = log(queue=False)
    assert not list(queued_positions(run.t, run["x_m"], run["y_m"]))
    assert drop_queued_messages(run) is run


def test_a_boat_that_stops_without_orders_has_no_queue() -> None:
    fine = np.arange(0.0, 120.0, 0.01)
    run = log()
    way = np.interp(run.t, fine, stopped(fine))
    assert not list(queued_positions(run.t, way, 0.2 * way))


def test_a_leap_of_the_position_is_no_queue() -> None:
    """The fix held still over the gap, and then is on time at once."""
    run = log(queue=False)
    x, y = run["x_m"].copy(), run["y_m"].copy()
    first = int(np.searchsorted(run.t, STALL + GAP))
    x[first], y[first] = x[first - 1], y[first - 1]
    assert not list(queued_positions(run.t, x, y))


def test_recordings_without_positions_or_fixes_are_left_alone() -> None:
    run = log()
    heading = Recording("run", run.t, {"psi_rad": run["psi_rad"]})
    assert drop_queued_messages(heading) is heading
    nowhere = Recording("run", run.t, dict.fromkeys(("x_m", "y_m"), np.full(len(run.t), np.nan)))
    assert drop_queued_messages(nowhere) is nowhere


def test_a_sensor_with_a_link_of_its_own_is_not_late() -> None:
    t, queue = np.arange(0.0, 100.0, 0.5), Queue(STALL, STALL + GAP, EMPTY)
    late = (t > STALL) & (t < EMPTY)
    held = np.where((t > STALL) & (t < STALL + GAP), 3.0, np.where(t <= STALL, 3.0, 0.1 * t))
    assert np.array_equal(late_samples(t, held, queue), late)
    stalled = np.where((t > STALL) & (t < STALL + GAP), np.nan, 0.1 * t)
    assert np.array_equal(late_samples(t, stalled, queue), late)
    assert not late_samples(t, 0.1 * t, queue).any()
    longer = np.where((t > STALL + 2.0) & (t < STALL + GAP), np.nan, 0.1 * t)
    assert np.array_equal(late_samples(t, longer, queue), late & (t > STALL + 2.0))


def test_an_import_omits_what_had_queued_and_says_so() -> None:
    run = log()
    signals = {name: Signal(run.t, run[name]) for name in run.signals}
    own = np.arange(0.0, 120.0, 0.1)
    signals["compass"] = Signal(own, circle(own)["psi_rad"])
    columns = {"x_m": "x_m", "y_m": "y_m", "r_radps": "r_radps", "n_port_radps": "n_port_radps"}
    for heading, queued in (("psi_rad", True), ("compass", False)):
        table = {"vessel": "otter", "columns": {**columns, "psi_rad": heading}}
        found = convert_log(Log(Path("log.csv"), signals), parse_map(table, "map.toml"), "map.toml")
        late = (run.t > STALL + GAP + 0.3) & (run.t < EMPTY - 0.7)
        for name, values in found.signals.items():
            known = found.t[np.isfinite(values)] + run.t[0]
            gone = name in ("x_m", "y_m", "r_radps") or (name == "psi_rad" and queued)
            assert gone != bool(((known > run.t[late][0]) & (known < run.t[late][-1])).any())
        remarks = " ".join(text for text in found.remarks if "had queued" in text)
        assert "x_m, y_m" in remarks and ("psi_rad" in remarks) == queued
