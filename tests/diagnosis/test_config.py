"""The configuration of a diagnosis: names, types, ranges and units of its settings."""

from dataclasses import fields

import pytest

from boatsim.diagnosis.config import DEFAULT, DiagnosisConfig, from_settings, settings_by_name
from boatsim.errors import BadInput


def test_every_setting_has_a_unit_and_a_reason_and_lies_in_its_range():
    for group in fields(DiagnosisConfig):
        for one in fields(getattr(DEFAULT, group.name)):
            about = one.metadata
            values = one.default if isinstance(one.default, tuple) else (one.default,)
            assert about["unit"], one.name
            assert about["reason"].endswith("."), one.name
            assert all(about["low"] <= value <= about["high"] for value in values), one.name


def test_the_plain_values_restore_a_configuration():
    changed = from_settings({"select.odds": "3", "fit.coefficient_range": "0.1, 10"})
    assert changed.select.odds == 3.0
    assert changed.fit.coefficient_range == (0.1, 10.0)
    assert from_settings(settings_by_name(changed)) == changed
    assert from_settings({}) == DEFAULT


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"select.ods": 3}, "did you mean 'select.odds'"),
        ({"odds": 3}, "does not exist"),
        ({"select.odds": "much"}, r"select.odds = 'much': allowed is a number from 0"),
        ({"select.odds": True}, "select.odds = True"),
        ({"select.odds": "nan"}, "select.odds = 'nan'"),
        ({"select.odds": -1.0}, "select.odds = -1.0"),
        ({"select.most_effects": 2.5}, "most_effects = 2.5: allowed is an integer from 1"),
        ({"fit.coefficient_range": [1.0]}, "2 numbers are needed"),
    ],
)
def test_a_mistake_is_one_clear_line(settings, message):
    with pytest.raises(BadInput, match=message) as refused:
        from_settings(settings)
    assert "\n" not in str(refused.value)
