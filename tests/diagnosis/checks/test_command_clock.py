"""A recording whose commands act later than those of the others is named with the delay; drives that
differ, late positions, gusts and few recordings are not taken for another clock."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from alike import long

from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.checks.command_clock import (
    candidates_besides_clocks,
    find_command_clocks,
    recordings_with_one_clock,
)
from boatsim.diagnosis.checks.command_delays import Response, with_response
from boatsim.diagnosis.checks.finding import Finding, apply_corrections, recording_toml_lines
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.diagnosis.pipeline import find_other_clocks, fit_baseline_models
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.question import set_up_estimation_problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.ranking import select_and_rank_candidates
from boatsim.physics.base import Array
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

# A light body on air: two fans push ahead and two to the sides, off the centre
MASS, INERTIA, DRAG, WEAK_DRAG = 0.14, 5e-4, 0.05, 1e-5
FANS = {  # places [m] and directions [rad]
    "port": (0.0, -0.05, 0.0),
    "starboard": (0.0, 0.05, 0.0),
    "bow": (0.05, 0.0, 0.5 * np.pi),
    "stern": (-0.05, 0.0, -0.5 * np.pi),
}
STEP, ROWS, FINE = 0.02, 700, 10  # [s], rows, integration steps in a row
POSES = ("x_m", "y_m", "psi_rad")
LATE = 4  # rows by which the poses of one recording are late, 80 ms


def craft() -> Vessel:
    effects: list[dict[str, object]] = [
        {"use": "linear_damping", "surge": DRAG, "sway": DRAG, "yaw": WEAK_DRAG}
    ]
    for fan, (x, y, angle) in FANS.items():
        on = {"thrust": f"{fan}_N", "angle": float(angle)}
        effects.append({"use": "thruster", "name": fan, "on": on, "x": x, "y": y})
    return Vessel.from_effects(
        name="craft_on_air",
        dof=("surge", "sway", "yaw"),
        length=0.12,
        beam=0.12,
        draught=0.01,
        body={"mass": MASS, "roll_inertia": 3e-4, "yaw_inertia": INERTIA},
        effects=effects,
        channels={f"{fan}_N": {"low": -0.2, "high": 0.2} for fan in FANS},
        diagnosis={"facts": {"no_water": True}},
    )


CRAFT = craft()


@cache
def flown(
    seed: int,
    lags: tuple[float, ...] = (0.04,) * 4,
    inertia: float = 0.7,
    gain: float = 1.0,
    gusts: float = 0.0,
) -> Recording:
    """A flight of a craft with lags of its fans [s], an inertia and gusts that its file lacks."""
    rng = np.random.default_rng(seed)
    commands = np.repeat(rng.uniform(-0.15, 0.15, (ROWS // 14, len(FANS))), 14, axis=0)
    x, y, angle = np.array(list(FANS.values())).T
    ahead, aside = np.cos(angle), np.sin(angle)
    levers = x * aside - y * ahead
    dt = STEP / FINE
    kept = np.exp(-dt / np.maximum(np.array(lags), 1e-9))
    thrust, pose, speed = np.zeros(len(FANS)), np.zeros(3), np.zeros(3)
    wind, poses = np.zeros(2), []
    for order in gain * commands:
        poses.append(pose)
        wind = 0.98 * wind + 0.2 * gusts * rng.standard_normal(2)
        for _ in range(FINE):
            later = order + kept * (thrust - order)
            middle = 0.5 * (thrust + later)
            thrust = later
            c, s = np.cos(pose[2] + 0.5 * dt * speed[2]), np.sin(pose[2] + 0.5 * dt * speed[2])
            u, v = c * speed[0] + s * speed[1], c * speed[1] - s * speed[0]
            X, Y = middle @ ahead - DRAG * u, middle @ aside - DRAG * v
            force = np.array([c * X - s * Y, s * X + c * Y]) + wind
            turning = (middle @ levers - WEAK_DRAG * speed[2]) / (inertia * INERTIA)
            change = np.append(force / MASS, turning)
            pose = pose + dt * speed + 0.5 * dt * dt * change
            speed = speed + dt * change
    seen = np.array(poses) + rng.standard_normal((len(poses), 3)) * [3e-4, 3e-4, 2e-3]
    signals = dict(zip(POSES, seen.T, strict=True))
    signals |= {f"{fan}_N": commands[:, i] for i, fan in enumerate(FANS)}
    return Recording(f"flight_{seed}", STEP * np.arange(len(poses)), signals)


def late(log: Recording, rows: int, names: Sequence[str] = POSES) -> Recording:
    """The recording with columns that are late by some rows, or early."""
    signals = {
        name: np.roll(log[name], rows) if name in names else log[name] for name in log.signals
    }
    margin = slice(abs(rows), len(log) - abs(rows))
    kept = {name: values[margin] for name, values in signals.items()}
    return replace(log, t=log.t[margin], signals=kept)


def found_in(recordings: Sequence[Recording]) -> list[Finding]:
    program = Program(CRAFT, ())
    mapped = [map_recording(recording, program) for recording in recordings]
    levels = prior_noise_levels(CRAFT, recordings)
    problem = Problem(mapped, levels, {"thrust": 0.3, "damping": 0.5})
    return find_command_clocks(problem, recordings)


def flights(count: int = 4, **lacking: float) -> list[Recording]:
    return [flown(seed, **lacking) for seed in range(count)]


@pytest.mark.parametrize("rows", [LATE, long(-LATE), long(10)])
@pytest.mark.slow
def test_the_recording_with_another_clock_is_named_with_its_delay(rows: int) -> None:
    logs = flights()
    logs[1] = late(logs[1], rows)
    [found] = found_in(logs)
    assert (found.name, found.run, found.of_run_only) == ("command_clock", "flight_1", True)
    delays = {change.column: change.delay for change in found.changes}
    assert delays.keys() == {f"{fan}_N" for fan in FANS}
    for delay in delays.values():  # commands are in force later than stamped
        assert delay == pytest.approx(-rows * STEP, abs=0.005)
    assert recording_toml_lines(found, {})[0] == "[runs.flight_1.latency]"
    logs[1] = apply_corrections(logs[1], found.changes)
    assert found_in(logs) == []


NO_OTHER_CLOCK = {
    "nothing differs": lambda: flown(1),
    "slower fans": lambda: flown(1, lags=(0.12,) * 4),
    "one slower fan": lambda: flown(1, lags=(0.04, 0.04, 0.2, 0.04)),
    "weaker fans": lambda: flown(1, gain=0.7),
    "late positions": lambda: late(flown(1), LATE, ("x_m", "y_m")),
    "one late command": lambda: late(flown(1), -LATE, ("bow_N",)),
    "gusts": lambda: flown(1, gusts=0.05),
    "a short log": lambda: flown(1).between(0.0, 0.9),
}


@pytest.mark.parametrize(
    "case",
    [
        "nothing differs",
        "slower fans",
        "late positions",
        *map(long, ("one slower fan", "weaker fans", "one late command", "gusts", "a short log")),
    ],
)
@pytest.mark.slow
def test_what_differs_otherwise_is_no_clock(case: str) -> None:
    logs = flights()
    logs[1] = NO_OTHER_CLOCK[case]()
    assert found_in(logs) == []


@pytest.mark.slow
def test_a_diagnosis_corrects_the_clock_and_names_the_drives_of_all() -> None:
    logs = flights()
    logs[1] = late(logs[1], LATE)
    loaded = LoadedRecordings(logs[:3], logs[3:], {None: CRAFT}, "")
    question = set_up_estimation_problem(loaded, with_candidates=False)
    clocks = find_other_clocks(loaded, question, fit_baseline_models(question))
    assert [(found.run, found.kind) for found in clocks] == [("flight_1", "mended")]
    loaded = recordings_with_one_clock(loaded, clocks)
    tested = ("command_delay", "thrust_lag", "clock_offset")
    effects = [e for e in candidate_library(CRAFT).compiled_effects if e.name in tested]
    program = Program(CRAFT, effects)
    mapped = [map_recording(recording, program) for recording in loaded.fitted]
    problem = Problem(mapped, prior_noise_levels(CRAFT, loaded.fitted), {"thrust": 0.3})
    ranking = select_and_rank_candidates(problem, tested)
    assert [one.name for one in ranking.named] == ["thrust_lag"]
    value, sd = ranking.best.value("thrust_lag", "time_constant")
    assert abs(value - 0.04) < max(4.0 * sd, 0.002)


@pytest.mark.parametrize(
    ("corrected", "determined"),
    [
        (("flight_0",), ("b",)),  # group a has no other recording
        (("flight_1",), ("a", "b")),  # the other recording of b shows a delay of both
        (("flight_1", "flight_2"), ("a",)),  # none of b does, for the held-out one is not fitted
    ],
)
def test_no_delay_is_tested_for_a_group_of_corrected_recordings_alone(
    corrected: tuple[str, ...], determined: tuple[str, ...]
) -> None:
    """Recordings are corrected to the clock of the others, which a delay of a group may have."""
    logs = []
    for log, group in zip(flights(4), ("a", "b", "b", "b"), strict=True):
        logs.append(replace(log, notes=replace(log.notes, groups=(group,))))
    loaded = LoadedRecordings(logs[:3], logs[3:], {None: CRAFT}, "")
    findings = [Finding("command_clock", "", run=run) for run in corrected]
    names = ("command_delay", "clock_offset@a", "clock_offset@b", "thrust_lag@a", "thrust_lag@b")
    expected = {"command_delay", "thrust_lag@a", "thrust_lag@b"}
    expected |= {f"clock_offset@{group}" for group in determined}
    kept = candidates_besides_clocks(names, loaded, findings)
    assert set(kept) == expected


@pytest.mark.slow
def test_gusts_do_not_hide_another_clock() -> None:
    logs = flights(5, gusts=0.01)
    logs[3] = late(logs[3], LATE)
    [found] = found_in(logs)
    assert found.run == "flight_3"
    assert found.changes[0].delay == pytest.approx(-LATE * STEP, abs=0.01)


def test_of_three_recordings_it_is_unclear_which_is_right() -> None:
    logs = flights(3)
    logs[1] = late(logs[1], LATE)
    assert found_in(logs) == []


def commands(times: Array, values: Array, at: Array) -> Array:
    """Commands (N, K) in force at some times (N,)."""
    return values[np.maximum(np.searchsorted(times, at, side="right") - 1, 0)]


def test_a_response_moves_commands_and_lags_them() -> None:
    mapped = map_recording(flown(0), Program(CRAFT, ()))
    at = np.arange(1.0, 9.0, 0.0037)
    before = commands(mapped.command_times, mapped.command_values, at - 0.05)
    moved = with_response(mapped, Response(delay=0.05))
    assert commands(moved.command_times, moved.command_values, at) == pytest.approx(before)
    one = with_response(mapped, Response(only=2, only_delay=0.05))
    found = commands(one.command_times, one.command_values, at)
    now = commands(mapped.command_times, mapped.command_values, at)
    assert found[:, 2] == pytest.approx(before[:, 2])
    assert np.delete(found, 2, axis=1) == pytest.approx(np.delete(now, 2, axis=1))
    lagged = with_response(mapped, Response(lag=0.1))
    first, second = mapped.command_values[:2]
    change = mapped.command_times[1]
    after = change + np.arange(0.5, 10.0) * STEP
    expected = second + np.exp(-(after - change) / 0.1)[:, None] * (first - second)
    assert commands(lagged.command_times, lagged.command_values, after) == pytest.approx(
        expected, abs=0.01 * np.abs(first - second).max()
    )
