"""The list of all candidates in diagnosis.json."""

from types import SimpleNamespace

import pytest

from boatsim.diagnosis.answer.compose import candidate_entries


def test_a_candidate_with_which_the_boat_diverges_is_omitted_and_voids_nothing() -> None:
    ranking = SimpleNamespace(first={"wind": 3.0, "damping_exponent": float("-inf"), "tether": 0.0})
    entries = candidate_entries(ranking)
    assert [entry["name"] for entry in entries] == ["wind", "tether"]
    # against none, whose log evidence is zero: e^3 / (e^3 + 1 + 1)
    assert entries[0]["probability"] == pytest.approx(0.9094, abs=1e-4)


def test_an_effect_tested_in_two_places_is_listed_with_the_larger_gain() -> None:
    ranking = SimpleNamespace(first={"thrust_lag": 1.0, "reordered_thrust_lag": 4.0})
    entries = candidate_entries(ranking)
    assert [(entry["name"], entry["gain_nats"]) for entry in entries] == [("thrust_lag", 4.0)]
