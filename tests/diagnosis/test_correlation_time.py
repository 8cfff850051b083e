"""The latent force's correlation time: one rule for every vessel, from the fitted recordings
alone."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from real_boat import Real, recorded

from boatsim.diagnosis import correlation_time, pipeline, priors
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.errors import BadInput
from boatsim.files import read_toml
from boatsim.physics import vessel
from boatsim.physics.content import find_content_file, shipped_content_names
from boatsim.physics.program import Program
from boatsim.recordings.table import Notes, Recording, write_csv


@pytest.mark.parametrize("name", shipped_content_names("vessel"))
def test_no_vessel_states_one_and_the_usual_one_goes_by_froudes_law(name: str) -> None:
    text = read_toml(find_content_file("vessel", name))
    assert "time_constant" not in text.get("diagnosis", {})
    boat = vessel.load_vessel(name)
    assert priors.assumed_correlation_time(boat) == pytest.approx(np.sqrt(boat.length / 1.2))


def test_a_vessel_file_that_states_one_is_told_so(tmp_path: Path) -> None:
    own = vessel.load_vessel("kvlcc2_roll").file
    (tmp_path / "hull.xml").write_text((own.parent / "hull.xml").read_text())
    (tmp_path / "vessel.toml").write_text(
        own.read_text().replace("[diagnosis]", "[diagnosis]\ntime_constant = 2.0")
    )
    with pytest.raises(BadInput, match="time_constant"):
        vessel.load_vessel(str(tmp_path))


@pytest.mark.parametrize(
    ("errors", "taken"),
    [
        ({0.5: 0.96, 1.0: 1.0, 2.0: 1.1}, 1.0),  # not clearly better
        ({0.25: 0.99, 0.5: 0.9, 1.0: 1.0, 2.0: 0.8}, 0.5),
        ({0.25: 0.8, 0.5: 0.9, 1.0: 1.0, 2.0: 1.1}, 0.25),
        ({0.5: 1.1, 1.0: 1.0, 2.0: 0.9, 4.0: 0.8}, 4.0),
        ({0.5: np.nan, 1.0: 1.0, 2.0: np.nan}, 1.0),  # the boat runs away
    ],
)
def test_it_is_halved_or_doubled_as_long_as_that_predicts_clearly_better(
    errors: dict[float, float], taken: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        correlation_time,
        "cross_validation_errors",
        lambda problem, found, seconds: np.full(9, errors[seconds]),
    )
    problem: Any = SimpleNamespace(ambient=SimpleNamespace(time_constant=1.0), config=DEFAULT)
    named: Any = SimpleNamespace(effects=("wind",))
    assert correlation_time.cross_validated_correlation_time(problem, named) == taken
    assert (
        correlation_time.cross_validated_correlation_time(problem, SimpleNamespace(effects=()))
        == 1.0
    )  # type: ignore[arg-type]


def test_what_swings_from_run_to_run_is_not_clearly_less() -> None:
    before = np.full(8, 0.01)
    assert correlation_time.errors_clearly_fell(0.9 * before, before)
    assert not correlation_time.errors_clearly_fell(
        0.9 * before * np.exp(0.3 * (-1.0) ** np.arange(8)), before
    )


def test_a_single_recording_is_halved_in_time_and_each_row_is_in_one_half() -> None:
    boat = vessel.load_vessel("kvlcc2_roll")
    t = np.arange(0.0, 20.0, 0.2)
    whole = map_recording(
        Recording("decay", t, {"phi_rad": 0.2 * np.cos(2.5 * t) * np.exp(-0.05 * t)}),
        Program(boat, ()),
    )
    ((first,), (second,)) = correlation_time.split_in_halves([whole])
    assert np.concatenate([first.times, second.times]) == pytest.approx(t)
    assert (
        len(first.times) == len(second.times)
        and second.initial_state_prior.mean[0] == whole.measured[50, 0]
    )
    pair = correlation_time.split_in_halves([whole, first, second])
    assert [len(half) for half in pair] == [2, 1]


@pytest.mark.slow
def test_what_a_recordings_notes_state_is_a_fact(tmp_path: Path) -> None:
    assert (
        prior_noise_levels(
            vessel.load_vessel("trial_boat"), [Recording("r", np.zeros(1), {})]
        ).time_constant
        == 1.0
    )
    run = replace(recorded(Real(power=(1.15, 0.85)), 1), notes=Notes())
    write_csv(run, tmp_path / "run.csv")
    (tmp_path / "recording.toml").write_text(
        'vessel = "trial_boat"\n[ambient]\ntime_constant_s = 3.0\n'
    )
    assert pipeline.diagnose([tmp_path / "run.csv"]).problem.ambient.time_constant == 3.0


def test_free_runs_over_which_nothing_was_recorded_say_nothing() -> None:
    before, less = np.array([1.0, 1.1, 0.9, 1.0]), np.array([0.5, 0.55, 0.45, 0.5])
    outage = np.array([1.0, 1.0, np.nan, 1.0])
    assert correlation_time.errors_clearly_fell(less * outage, before * outage)
    assert not correlation_time.errors_clearly_fell(before * outage, before * outage)
    assert not correlation_time.errors_clearly_fell(less * np.nan, before)
