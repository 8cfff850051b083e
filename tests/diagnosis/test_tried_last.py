"""Candidates that are tried last: a quay, which a line to the other side resembles."""

from pathlib import Path

import numpy as np
import pytest
from answers import diagnosed
from real_boat import Real, recorded

from boatsim.diagnosis.candidates import candidate_library
from boatsim.physics.vessel import load_vessel

TRACK = {"track_m": (0.0, 0.0, 1.0, 0.5)}
START = (0.0, 0.1, 0.3)  # the side of the hull is 0.1 m from the fender
FENDER, PLACE = 80.0, 0.5  # [N/m], [m] to the east


def test_a_quay_is_tried_last_only_where_the_boat_stays_near_a_place() -> None:
    near = candidate_library(load_vessel("trial_boat"), facts=TRACK)
    assert near.tried_last["quay"] == ("tether",)
    assert "quay" not in near.tested_names and "tether" in near.tested_names
    assert "--library quay" in near.excluded["quay"]
    far = candidate_library(load_vessel("trial_boat"))
    assert "quay" not in far.tried_last and "quay" in far.inapplicable


def test_a_requested_quay_is_an_ordinary_candidate() -> None:
    asked = candidate_library(load_vessel("trial_boat"), ("quay",), TRACK)
    assert "quay" in asked.tested_names and "quay" not in asked.tried_last


@pytest.mark.slow
def test_a_quay_is_found_without_a_request_and_predicts_the_next_run(tmp_path: Path) -> None:
    runs = [recorded(Real(quay=(FENDER, PLACE)), seed, start=START) for seed in (1, 2, 3)]
    answer = diagnosed(runs, tmp_path, "trial_boat")
    (found,) = answer["effects"]
    assert found["name"] == "quay" and not answer["also_possible"]
    values = found["parameters"]
    assert abs(values["toward_rad"]["value"] + 0.5 * np.pi) < 0.1
    furthest = max(float(run["y_m"].max()) for run in runs)
    side = furthest + 0.5 * load_vessel("trial_boat").beam
    assert abs(side - values["overlap_m"]["value"] - PLACE) < 0.02
    # pressed in by less than 0.03 m, the fender shows that it is elastic, but hardly how stiff it is
    stiffness = values["stiffness_Npm"]
    assert abs(stiffness["value"] - FENDER) < 2.0 * stiffness["sd"]
    assert 0.5 * FENDER < stiffness["value"] < 2.0 * FENDER
    assert "quay" in answer["tried"]
    errors = answer["fit"]["position_rms_m"]
    assert errors["patched"] < 0.5 * errors["recalibrated"]


@pytest.mark.slow
def test_a_line_is_not_taken_for_a_quay(tmp_path: Path) -> None:
    runs = [recorded(Real(line=(1.5, 0.3, 0.5, 0.0)), seed) for seed in (1, 2, 3)]
    answer = diagnosed(runs, tmp_path, "trial_boat")
    assert {one["name"] for one in answer["effects"]} == {"tether"}
    assert not answer["also_possible"]
