"""Expressions of columns: a name, units, numbers, a sign, an offset; anything else is a name or a
clear refusal."""

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from boatsim.errors import BadInput
from boatsim.recordings.expression import UNITS, Expression, parse
from boatsim.recordings.table import read

DEG = math.pi / 180.0


@pytest.mark.parametrize(
    "text, name, factor, offset",
    [
        ("ATT.Yaw", "ATT.Yaw", 1.0, 0.0),
        ("-delta", "delta", -1.0, 0.0),
        ("- delta", "delta", -1.0, 0.0),
        ("ATT.Yaw * deg", "ATT.Yaw", DEG, 0.0),
        ("heading_deg*deg", "heading_deg", DEG, 0.0),
        ("-/odom.pose.yaw + 90 * deg", "/odom.pose.yaw", -1.0, math.pi / 2),
        ("shaft / 60", "shaft", 1 / 60, 0.0),
        ("lat * deg * 1e-7", "lat", DEG * 1e-7, 0.0),
        ("x * -1", "x", -1.0, 0.0),
        ("x * -2 - 3", "x", -2.0, -3.0),
        ("Heading (deg) * deg - 1.5", "Heading (deg)", DEG, -1.5),
        ("Yaw rate [deg/s] * degps", "Yaw rate [deg/s]", DEG, 0.0),
        ("a - b", "a - b", 1.0, 0.0),
        ("/imu/data.orientation.z", "/imu/data.orientation.z", 1.0, 0.0),
    ],
)
def test_an_expression_says_name_factor_and_offset(text, name, factor, offset):
    found = parse(text)
    assert found.signal == name
    assert (found.factor, found.offset) == (
        pytest.approx(factor, rel=1e-15),
        pytest.approx(offset, rel=1e-15),
    )


def test_a_known_name_is_that_name_whatever_stands_in_it():
    assert parse("a * deg", ["a * deg"]) == Expression("a * deg")
    assert parse("-a / 2", ["a / 2"]) == Expression("a / 2", -1.0)
    assert parse("-3", ["-3"]) == Expression("-3")


def test_words_of_units_are_what_they_say():
    assert UNITS["rpm"] * 60 == pytest.approx(2 * math.pi) and UNITS["rps"] == pytest.approx(
        2 * math.pi
    )
    assert UNITS["kn"] * 3600 == pytest.approx(1852) and UNITS["kmh"] * 3.6 == pytest.approx(1.0)
    assert UNITS["percent"] * 100 == pytest.approx(1.0) and UNITS["us"] * 1e6 == pytest.approx(1.0)


@pytest.mark.parametrize(
    "text, said",
    [
        ("x * dge", "there is no unit 'dge'; did you mean 'deg'"),
        ("x / 0", "divides by zero"),
        ("", "is no expression"),
        ("* deg", "is no expression"),
        ("x * 1e400", "too large"),
        ("x * deg * deg * deg * deg * deg * deg * deg", "is no expression"),
    ],
)
def test_what_is_no_expression_is_refused_with_what_is_allowed(text, said):
    with pytest.raises(BadInput, match=said.replace("(", r"\(")):
        parse(text)


@given(st.text(max_size=60))
def test_any_text_is_a_name_or_is_refused(text):
    try:
        found = parse(text)
    except BadInput:
        return
    assert found.signal and found.signal in text and math.isfinite(found.factor)


def test_code_in_an_expression_is_a_name_that_does_not_exist():
    assert parse("__import__('os').system('true')").signal == "__import__('os').system('true')"


# [columns] of recording.toml
# ----------------------------------------------------------------------------------------


def folder(path: Path, columns: str, header: str = "t_s,x_m,y_m,heading_deg,delta") -> Path:
    rows = "".join(
        f"{0.1 * i:.1f},{0.1 * i:.2f},{0.01 * i:.3f},{350 + 0.5 * i:.2f},{0.1:.2f}\n"
        for i in range(40)
    )
    (path / "run.csv").write_text(header + "\n" + rows)
    (path / "recording.toml").write_text("[columns]\n" + columns)
    return path / "run.csv"


def test_columns_of_a_recording_are_converted_by_their_expressions(tmp_path):
    run = read(
        folder(tmp_path, 'psi_rad = "heading_deg * deg"\nrudder_rad = "-delta * deg + 0.5 * deg"\n')
    )
    np.testing.assert_allclose(run["psi_rad"], np.radians(350 + 0.5 * np.arange(40)), rtol=1e-12)
    np.testing.assert_allclose(run["rudder_rad"], math.radians(0.4), rtol=1e-12)


def test_a_misspelt_column_is_named_with_the_nearest_right_one(tmp_path):
    with pytest.raises(
        BadInput,
        match="columns.psi_rad = 'headng_deg.*no column 'headng_deg'; did you mean 'heading_deg'",
    ):
        read(folder(tmp_path, 'psi_rad = "headng_deg * deg"\n'))
    with pytest.raises(
        BadInput, match="columns.psi_rad.*no unit 'dgr'; did you mean 'degpmin'|'deg'"
    ):
        read(folder(tmp_path, 'psi_rad = "heading_deg * dgr"\n'))


def test_a_column_that_other_runs_of_the_folder_have_is_a_remark(tmp_path):
    run = read(folder(tmp_path, 'psi_rad = "heading_deg * deg"\nn_rps = "shaft speed"\n'))
    assert any(
        "names columns that do not exist: n_rps = 'shaft speed'" in line for line in run.remarks
    )
