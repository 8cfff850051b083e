"""Which terms of a formula count beyond the recordings that they were found in."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.free_runs import FreeRun
from boatsim.diagnosis.search import generalization
from boatsim.diagnosis.symbolic import residual_description
from boatsim.diagnosis.symbolic.term_selection import Formula
from boatsim.physics.effects.described_force import DescribedForce

TERM = DescribedForce.from_settings({"of": ["heave_speed"], "axis": "heave"})


@pytest.mark.parametrize(
    ("axis", "heave", "kept"),
    [
        ("heave", 0.6, False),  # heave gets worse by a force in heave, although roll improves
        ("heave", 0.45, True),
        ("roll", 0.6, True),
    ],
)
def test_a_term_that_makes_its_own_axis_worse_is_not_kept(
    axis: str, heave: float, kept: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem: Any = SimpleNamespace(config=DEFAULT, horizon=5.0)
    fit: Any = SimpleNamespace(effects=())
    found = Formula(problem, fit, {"described_1": replace(TERM, axis=axis)})
    plain = Formula(problem, fit, {})
    t = np.arange(0.0, 5.0, 0.5)
    # rms errors (heave, roll) of each model: with the term, without it
    errors = {
        "recorded": (0.0, 0.0),
        "recalibrated": (1.0, 1.0),
        "0": (heave, 0.1),
        "1": (0.5, 0.5),
    }
    channels = {m: {"z_m": 0 * t + z, "phi_rad": 0 * t + phi} for m, (z, phi) in errors.items()}

    def runs(*_: object) -> list[FreeRun]:
        return [FreeRun("unseen", 0.0, t, channels)]

    monkeypatch.setattr(residual_description, "free_runs", runs)
    monkeypatch.setattr(residual_description, "refit_without_term", lambda *_: plain)
    monkeypatch.setattr(residual_description, "longest_recording_duration", lambda _: 5.0)
    monkeypatch.setattr(generalization, "harmed_groups", lambda *_: ())
    unseen: Any = [SimpleNamespace(groups=())]
    chosen = residual_description._general(
        problem, found, plain, {"described_1": 20.0}, fit, unseen
    )
    assert (chosen is found) == kept
