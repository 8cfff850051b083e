"""Several parts of a recording are used each as a recording, without what lies between them."""

from pathlib import Path

import numpy as np
import pytest

import boatsim
from boatsim.diagnosis.loading import Request, load_recordings
from boatsim.diagnosis.log_check import check_files
from boatsim.recordings.table import write_csv
from boatsim.simulate import scenario
from boatsim.simulate.run import run

USE = ((0.0, 12.0), (16.0, 30.0))
SCENARIO = """
vessel = "trial_boat"
duration = 30
log = 0.1
controller = { use = "open_loop" }
[[goal]]
thrust_port_N = { mean = 0.4, amplitude = 0.4, period = 9.0 }
thrust_starboard_N = { mean = 0.4, amplitude = 0.3, period = 7.0 }
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A recording of a run whose middle was disturbed by a hand, with the parts to use."""
    place = tmp_path_factory.mktemp("parts")
    (place / "run.toml").write_text(SCENARIO)
    log = run(scenario.load(str(place / "run.toml"))).recording
    hand = (log.t > 12.05) & (log.t < 15.95)
    log.signals["x_m"][hand] += 3.0
    log.signals["psi_rad"][hand] += 1.0
    write_csv(log, place / "log.csv")
    (place / "recording.toml").write_text(f'vessel = "trial_boat"\nuse = {list(map(list, USE))}\n')
    return place


def test_a_diagnosis_fits_the_first_parts_and_holds_the_last_one_out(folder: Path) -> None:
    loaded = load_recordings(Request([folder / "log.csv"]))
    assert [part.name for part in loaded.fitted] == ["log (part 1)"]
    assert [part.name for part in loaded.held_out] == ["log (part 2)"]
    assert "log (part 2)" in loaded.note
    spans = [(part.t[0], part.t[-1]) for part in (*loaded.fitted, *loaded.held_out)]
    assert np.allclose(spans, USE, atol=0.3)


def test_free_runs_start_in_each_part_and_never_cross_between_them(folder: Path) -> None:
    found = boatsim.replay(folder / "log.csv", horizon=4.0)
    inside = np.zeros(len(found.t), dtype=bool)
    for begin, end in USE:
        inside |= (found.t >= begin - 1e-6) & (found.t <= end + 1e-6)
    assert inside.all()
    starts = [float(found.t[found["segment"] == k][0]) for k in np.unique(found["segment"])]
    assert any(abs(start - 16.0) < 0.3 for start in starts)
    recorded = boatsim.read(folder / "log.csv")
    truth = np.interp(found.t, recorded.t, recorded["x_m"])
    late = found.t > 16.0
    assert np.max(np.abs(found["x_m"] - truth)[late]) < 0.1


def test_what_lies_between_the_parts_is_not_accused(folder: Path) -> None:
    entries, refused = check_files([folder / "log.csv"])
    assert not refused
    assert not [e for found in entries.values() for e in found if e["kind"] == "fault"]
