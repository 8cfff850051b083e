"""Times in which a boat moves, but not by its recorded commands, are reported."""

from pathlib import Path

import numpy as np
import pytest

from boatsim.diagnosis import loading
from boatsim.diagnosis.checks.finding import Finding
from boatsim.diagnosis.checks.ignored_commands import check_ignored_commands
from boatsim.diagnosis.loading import Request
from boatsim.diagnosis.question import set_up_estimation_problem
from boatsim.diagnosis.search.ranking import fit_baseline
from boatsim.recordings.table import Recording, write_csv
from validation.calibration import abilities

OFF = 70.0  # [s]


DRIFT = 0.2  # [m/s] abeam


def findings(tmp_path: Path, speed: float | None) -> list[Finding]:
    """Findings about two runs of a boat with four thrusters.

    From a time on the second one drifts abeam with its drives off, while the program goes on to log
    commands; None: it obeys to the end.
    """
    body = abilities.boat()
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
    return check_ignored_commands(problem, fit, problem.recordings, ["one", "two"])


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
def test_drives_that_are_off_while_the_boat_drifts_are_reported(tmp_path):
    (finding,) = findings(tmp_path, DRIFT)
    assert (finding.name, finding.run) == ("commands_ignored", "two")
    begin, end = finding.spans[0][0], finding.spans[-1][1]
    assert begin == pytest.approx(OFF, abs=8.0)
    assert end == pytest.approx(119.8, abs=0.5)


@pytest.mark.parametrize("speed", [None, 0.0])
def test_a_boat_that_obeys_or_does_not_move_is_not_accused(tmp_path, speed):
    assert findings(tmp_path, speed) == []
