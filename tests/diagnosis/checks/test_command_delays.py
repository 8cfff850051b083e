"""Delays, lags and differences of clocks follow from log likelihoods that are known functions.

All commands of a file count, in whichever part they move, and all maxima of the log likelihood.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from boatsim.diagnosis.checks import command_clock_differences
from boatsim.diagnosis.checks.command_clock import _finding, most_clock_differences
from boatsim.diagnosis.checks.command_clock_differences import (
    ClockDifference,
    _refitted,
    clock_differences,
    delays_of_files,
)
from boatsim.diagnosis.checks.command_delays import (
    ALL,
    Delay,
    DelayEstimator,
    Parts,
    Response,
    moving_commands,
)
from boatsim.diagnosis.checks.drive_delays import best_drive_rival, common_lag
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.physics.program import Program
from boatsim.physics.vessel import load_vessel
from boatsim.recordings.table import Recording

OTTER = load_vessel("otter")
PORT, STARBOARD = "n_port_radps", "n_starboard_radps"


@dataclass(frozen=True)
class Known(DelayEstimator):
    """An estimator whose log likelihood is a known function of the response of the commands."""

    value: Callable[[Response], float] = lambda response: 0.0

    config = DEFAULT.checks
    time_scale = 1.0

    def log_likelihood(self, parts: Parts, response: Response) -> float:
        return self.value(response)

    def _sd(self, parts: Parts, delay: float, lag: float) -> float:
        return 0.01


def known(value: Callable[[Response], float]) -> Known:
    return Known(SimpleNamespace(), SimpleNamespace(), value)


def peak(at: float, height: float, width: float) -> Callable[[float], float]:
    return lambda seconds: height * float(np.exp(-(((seconds - at) / width) ** 2)))


def part(*moving: str, name: str = "part") -> MappedRecording:
    """Part of a file in which some commands change."""
    t = 0.1 * np.arange(20)
    signals = {"x_m": 0.1 * t, "y_m": 0.0 * t, "psi_rad": 0.0 * t}
    for command in (PORT, STARBOARD):
        signals[command] = 40.0 + 0.0 * t
        if command in moving:
            signals[command][10:] = 60.0
    return map_recording(Recording(name, t, signals), Program(OTTER, ()))


def without_positions(mapped: MappedRecording) -> bool:
    return not np.isfinite(mapped.measured[:, mapped.signals.index("x_m")]).any()


def number(command: str) -> int:
    return list(OTTER.commands).index(command)


def test_a_command_moves_in_a_file_if_it_moves_in_any_part() -> None:
    assert moving_commands([part(), part(STARBOARD)]) == [number(STARBOARD)]
    assert moving_commands([part(PORT), part(STARBOARD)]) == [number(PORT), number(STARBOARD)]
    assert moving_commands([part(), part()]) == []


def test_a_file_without_a_command_that_moves_has_no_delay() -> None:
    by_delay = peak(0.25, 10.0, 0.2)
    estimator = known(lambda response: by_delay(response.delay))
    files = {"idle": [part(), part()], "moving": [part(), part(PORT)]}
    found = delays_of_files(estimator, files)
    assert found.keys() == {"moving"}
    assert found["moving"].seconds == pytest.approx(0.25, abs=1e-3)


def test_the_finding_corrects_the_commands_of_all_parts() -> None:
    found = ClockDifference(0.2, 0.01, 3, 5.0)
    finding = _finding("log", found, [part(), part(STARBOARD), part(PORT)], DEFAULT.checks)
    assert {change.column: change.delay for change in finding.changes} == {
        PORT: -0.2,
        STARBOARD: -0.2,
    }


def test_a_command_that_moves_in_a_later_part_alone_is_a_rival() -> None:
    by_delay = peak(0.4, 7.0, 0.3)

    def value(response: Response) -> float:
        if response.only == number(STARBOARD):
            return by_delay(response.only_delay)
        return 0.0

    found = best_drive_rival(known(value), [part(), part(STARBOARD)], Response())
    assert found == pytest.approx(7.0, abs=1e-3)


@pytest.mark.parametrize("only", [ALL, number(PORT)])
def test_the_largest_of_several_maxima_of_a_lag_is_found(only: int) -> None:
    """A search between both ends begins at 38 % of the interval, and finds the lower maximum."""
    low, high = peak(0.35, 5.0, 0.15), peak(0.85, 9.0, 0.08)

    def value(response: Response) -> float:
        lag = response.lag if only == ALL else response.only_lag
        return max(low(lag), high(lag)) if response.only == only else -50.0

    found = best_drive_rival(known(value), [part(PORT)], Response())
    assert found == pytest.approx(9.0, abs=1e-3)


@pytest.mark.parametrize("nowhere", [-1.0, 0.0])
def test_a_rival_is_found_where_the_filter_diverges_with_others(nowhere: float) -> None:
    by_delay = peak(0.4, 7.0, 0.3)

    def value(response: Response) -> float:
        if response.only == ALL or response.only_delay == nowhere:
            return np.nan
        return by_delay(response.only_delay)

    assert best_drive_rival(known(value), [part(PORT)], Response()) == pytest.approx(7.0, abs=1e-3)


def test_the_lag_of_all_drives_is_found_where_the_filter_diverges_without_a_lag() -> None:
    by_lag = peak(0.2, 10.0, 0.1)

    def value(response: Response) -> float:
        return by_lag(response.lag) if response.lag > 0.0 else np.nan

    files, delays = {"log": [part(PORT)]}, {"log": Delay(0.0, 0.01, 0.0)}
    assert common_lag(known(value), files, delays) == pytest.approx(0.2, abs=0.01)


FILES = ("first", "second", "third", "late")
MOVED = 0.2  # [s] by which the late file is corrected before its likeliest delay is sought again


@dataclass(frozen=True)
class Corrected(Known):
    """Finds no further delay of corrected files; the heading alone may show one of the late file."""

    by_heading: float = 0.0  # [s]
    rival: float = 0.0  # log likelihood of the late file as recorded [nats]

    def log_likelihood(self, parts: Parts, response: Response) -> float:
        likeliest = 0.0
        if parts[0].name == "late":
            if parts[0].command_times[0] < 0.5 * MOVED:
                return self.rival
            if without_positions(parts[0]):
                likeliest = self.by_heading
        return peak(likeliest, 10.0, 0.2)(response.delay) - response.lag


def differences(
    monkeypatch: pytest.MonkeyPatch, first: MappedRecording | None = None, **numbers: float
) -> dict[str, ClockDifference]:
    problem = SimpleNamespace(recordings=[first])
    estimator = Corrected(problem, SimpleNamespace(), **numbers)
    monkeypatch.setattr(command_clock_differences, "_refitted", lambda *given: estimator)
    files = {name: [part(PORT, name=name)] for name in FILES}
    if first:
        files["first"] = [first]
    return clock_differences(estimator, files, {"late": MOVED}, FILES)


def test_a_file_with_another_clock_differs_by_its_correction(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    found = differences(monkeypatch)
    assert found.keys() == {"late"}
    assert found["late"].seconds == pytest.approx(MOVED, abs=1e-3)
    assert found["late"].lead == pytest.approx(10.0, abs=1e-3)


@pytest.mark.parametrize("rival", [8.0, np.nan, -np.inf])
def test_a_rival_that_is_as_likely_or_unknown_refutes_another_clock(
    rival: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert differences(monkeypatch, rival=rival) == {}


def test_late_positions_are_no_clock_whatever_the_first_file_measures(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The heading of the file in question is then early after the correction."""
    heading_alone = part(PORT, name="first")
    heading_alone = replace(
        heading_alone,
        measured=heading_alone.measured[:, [heading_alone.signals.index("psi_rad")]],
        signals=("psi_rad",),
    )
    for first in (None, heading_alone):
        assert differences(monkeypatch, first, by_heading=-MOVED) == {}
    assert differences(monkeypatch, heading_alone).keys() == {"late"}


def test_the_vessel_is_fitted_to_recordings_of_which_the_suspects_are_corrected(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    recordings = [part(PORT, name="same"), part(name="same"), part(PORT, name="same")]
    problem = SimpleNamespace(recordings=recordings, with_recordings=list)
    monkeypatch.setattr(
        command_clock_differences, "fit_baseline", lambda one: SimpleNamespace(recalibrated=one)
    )
    fitted = _refitted(
        DelayEstimator(problem, SimpleNamespace()), {"late": MOVED}, ["a", "late", "late"]
    )
    for before, after, moved in zip(recordings, fitted.problem, (0.0, MOVED, MOVED), strict=True):
        assert after.command_times == pytest.approx(before.command_times + moved)
        assert np.array_equal(after.command_values, before.command_values)


def test_a_small_difference_beside_a_large_one_is_found() -> None:
    delays = {f"run_{i}": Delay(0.002 * (-1) ** i, 0.005, 0.0) for i in range(12)}
    delays["run_3"] = Delay(0.8, 0.005, 0.0)
    delays["run_7"] = Delay(0.15, 0.005, 0.0)
    tried = []

    def differences(suspects: Mapping[str, float]) -> dict[str, ClockDifference]:
        tried.append(set(suspects))
        return {name: ClockDifference(off, 0.01, 12) for name, off in suspects.items()}

    estimator = cast(DelayEstimator, SimpleNamespace(config=DEFAULT.checks, time_scale=1.0))
    found = most_clock_differences(delays, estimator, differences)
    assert tried == [{"run_3"}, {"run_3", "run_7"}]
    assert found["run_7"].seconds == pytest.approx(0.15, abs=0.005)
    assert found["run_3"].seconds == pytest.approx(0.8, abs=0.005)
