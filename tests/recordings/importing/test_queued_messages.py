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
    (queue,) = queued_positions(run.t, run["x_m"], run["y_m"])
    assert queue.last == pytest.approx(STALL, abs=0.3)
    assert queue.begin == pytest.approx(STALL + GAP, abs=0.3)
    assert queue.end == pytest.approx(EMPTY, abs=0.7)


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


def test_coordinates_that_arrive_all_along_had_not_queued_and_are_not_remarked_on() -> None:
    """Rows with one coordinate each are no fixes, so that there seems to be a gap of these."""
    run = log()
    t = np.sort(np.concatenate([run.t, np.arange(STALL + 0.5, STALL + GAP - 0.4, 0.25)]))
    added = ~np.isin(t, run.t)
    signals = {}
    for column, (name, values) in enumerate(run.signals.items()):
        signals[name] = np.interp(t, run.t, values)
        signals[name][added & (np.arange(len(t)) % 2 == column % 2)] = np.nan
    alternating = Recording("run", t, {name: signals[name] for name in ("x_m", "y_m")})
    assert len(list(queued_positions(t, alternating["x_m"], alternating["y_m"]))) == 1
    found = drop_queued_messages(alternating)
    assert found.remarks == ()
    for name in ("x_m", "y_m"):
        assert np.array_equal(found[name], alternating[name], equal_nan=True)


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


PERIOD, POLL = 0.2, 0.11  # [s] of the sensor, and of a program that reads one message at a time
WAIT, STORED = 6.0, 10  # [s] until the program reads, and messages that its link stores until then


def polled(seconds: float = 60.0, stored: int = STORED, first: bool = True) -> Recording:
    """Log of a program that waits, and then reads the stored messages and the new ones in turn.

    Args:
        seconds: Duration of the log.
        stored: Number of messages that the link stores while the program waits.
        first: Whether the program has a first fix before it waits.
    """
    rows = np.append(0.0, WAIT + POLL * np.arange(round((seconds - WAIT) / POLL)))
    sent = np.empty(len(rows))
    following = WAIT - stored * PERIOD  # when the next message that is not read yet was sent
    sent[0] = 0.0
    for i, t in enumerate(rows[1:], 1):
        sent[i] = sent[i - 1]
        if following <= t:
            sent[i] = following
            following += PERIOD
    noise = np.random.default_rng(0)
    signals = {name: value[:] for name, value in circle(sent).items()}
    fresh = np.append(True, np.diff(sent) > 0.0)
    for name in signals:
        error = np.where(fresh, 0.005 * noise.standard_normal(len(rows)), np.nan)
        last = np.maximum.accumulate(np.where(fresh, np.arange(len(rows)), 0))
        signals[name] = signals[name] + error[last]
    if not first:
        signals["x_m"][0] = signals["y_m"][0] = np.nan
    signals["n_port_radps"] = signals["n_starboard_radps"] = np.full(len(rows), 40.0)
    return Recording("run", rows, signals)


@pytest.mark.parametrize("first", [True, False])
def test_a_queue_with_which_a_log_begins_is_found_by_the_number_of_its_messages(
    first: bool,
) -> None:
    """It is empty after the time in which reading gains what was stored: 10 x 0.2 s."""
    run = polled(first=first)
    (queue,) = queued_positions(run.t, run["x_m"], run["y_m"])
    empty = WAIT + POLL * STORED * PERIOD / (PERIOD - POLL)
    assert queue.last == 0.0 and queue.begin == WAIT
    assert queue.end == pytest.approx(empty, abs=3.0 * POLL)
    assert queue.late == pytest.approx(STORED * PERIOD, abs=2.0 * PERIOD)


def test_a_log_that_begins_with_a_gap_without_stored_messages_has_no_queue() -> None:
    for stored in (0, 1):
        run = polled(stored=stored)
        assert not list(queued_positions(run.t, run["x_m"], run["y_m"]))


def test_a_sensor_that_becomes_faster_after_a_gap_has_no_queue() -> None:
    slow, fast = np.arange(0.0, 20.0, 0.4), np.arange(26.0, 40.0, 0.2)
    t = np.concatenate([slow, fast])
    way = circle(t)
    assert not list(queued_positions(t, way["x_m"], way["y_m"]))


def test_more_messages_than_fit_into_the_gap_are_no_queue() -> None:
    """A sensor that sends faster for 10 s after a gap of 1 s stored 10 s of messages in none."""
    t = np.concatenate([[0.0], 1.0 + 0.1 * np.arange(100), 11.0 + 0.2 * np.arange(200)])
    way = circle(t)
    assert not list(queued_positions(t, way["x_m"], way["y_m"]))


def test_an_import_puts_the_positions_of_a_log_that_begins_with_a_queue_to_their_times() -> None:
    """With the stored messages their rhythm is too fast, and a boat is up to 0.5 m off its track.

    A program that polls reads a message half a period late on average.
    """
    run = polled(seconds=36.0)
    signals = {name: Signal(run.t, run[name]) for name in run.signals}
    names = ("x_m", "y_m", "psi_rad", "n_port_radps", "n_starboard_radps")
    table = {"vessel": "otter", "columns": {name: name for name in names}}
    found = convert_log(Log(Path("log.csv"), signals), parse_map(table, "map.toml"), "map.toml")
    assert any("the first one is" in text and "s old" in text for text in found.remarks)
    known = np.isfinite(found["x_m"]) & (found.t > 0.5 * WAIT)  # without the fix before the stall
    t = found.t[known]
    assert t[0] > WAIT + 0.5 * POLL * STORED * PERIOD / (PERIOD - POLL)
    radius = SPEED / YAW_RATE
    angle = np.unwrap(np.arctan2(found["x_m"][known], -found["y_m"][known]))
    late = t - angle / YAW_RATE  # [s] of the positions behind their times
    assert np.hypot(found["x_m"][known], found["y_m"][known]) == pytest.approx(radius, abs=0.05)
    assert 0.0 < late.mean() < POLL
    assert np.abs(late).max() < 1.2 * PERIOD
