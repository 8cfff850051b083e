"""Times in which a boat moves, but not by its recorded commands, are reported and left out."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from boatsim.diagnosis import loading
from boatsim.diagnosis.checks.finding import Finding
from boatsim.diagnosis.checks.ignored_commands import (
    check_ignored_commands,
    recordings_that_follow_commands,
)
from boatsim.diagnosis.loading import LoadedRecordings, Request
from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.question import set_up_estimation_problem
from boatsim.diagnosis.search.ranking import fit_baseline
from boatsim.recordings.table import Recording, write_csv
from validation.calibration.bodies.four_thrusters import four_thrusters

OFF = 70.0  # [s]


DRIFT = 0.2  # [m/s] abeam


class Checked(NamedTuple):
    """Recordings of a boat, the same on its program, and the findings about the fitted ones."""

    loaded: LoadedRecordings
    problem: Problem
    findings: list[Finding]


def checked(tmp_path: Path, speed: float | None) -> Checked:
    """Check two runs of a boat with four thrusters, and a third one that is held out.

    From a time on the second one drifts abeam with its drives off, while the program goes on to log
    commands; None: it obeys to the end.
    """
    body = four_thrusters()
    vessel = body.vessel.save(tmp_path / body.vessel.name).file
    signals = []
    for seed in range(3):
        signals.append(body.run(np.random.default_rng(seed), np.ones(body.coefficients)))
    if speed is not None:
        drifting(signals[1], body.times, speed)
    files = []
    for i in range(3):
        files.append(tmp_path / f"run_{i + 1}.csv")
        write_csv(Recording(f"run_{i + 1}", body.times, signals[i]), files[-1])
    loaded = loading.load_recordings(Request(files[:2], files[2:], vessel=str(vessel)))
    problem = set_up_estimation_problem(loaded, with_candidates=False).problem
    fit = fit_baseline(problem).nominal
    names = [one.origin for one in loaded.fitted]
    return Checked(loaded, problem, check_ignored_commands(problem, fit, problem.recordings, names))


def drifting(signals: dict[str, np.ndarray], t: np.ndarray, speed: float) -> None:
    """Change signals: from a time on the boat drifts to starboard, and its heading stays."""
    rng = np.random.default_rng(9)
    since = t > OFF
    psi = signals["psi_rad"][~since][-1]
    way = speed * (t - OFF)
    x, y = signals["x_m"][~since][-1], signals["y_m"][~since][-1]
    motion = {
        "x_m": x - way * np.sin(psi),
        "y_m": y + way * np.cos(psi),
        "psi_rad": np.full(len(t), psi),
        "u_mps": np.zeros(len(t)),
        "v_mps": np.full(len(t), speed),
        "r_radps": np.zeros(len(t)),
    }
    for name, values in motion.items():
        noise = 0.01 * rng.standard_normal(len(t))
        signals[name] = np.where(since, values + noise, signals[name])


@pytest.mark.slow
def test_the_time_in_which_a_boat_drifts_with_its_drives_off_is_reported_and_left_out(tmp_path):
    loaded, problem, (finding,) = checked(tmp_path, DRIFT)
    first, second = loaded.fitted
    assert (finding.name, finding.run) == ("commands_ignored", second.origin)
    begin, end = finding.spans[0][0], finding.spans[-1][1]
    assert begin == pytest.approx(OFF, abs=8.0)
    assert end == pytest.approx(119.8, abs=0.5)
    kept = recordings_that_follow_commands(loaded, problem, [finding])
    assert [len(one) for one in kept.held_out] == [len(one) for one in loaded.held_out]
    whole, part = kept.fitted
    assert whole.t.tolist() == first.t.tolist()
    assert 0.7 * OFF < part.t[-1] < OFF  # less what is too near to tell
    assert (part.t[0], part.origin) == (second.t[0], second.origin)


@pytest.mark.parametrize("speed", [None, 0.0])
def test_a_boat_that_obeys_or_does_not_move_is_not_accused(tmp_path, speed):
    assert checked(tmp_path, speed).findings == []
