"""The table [estimated] of a vessel file: its keys, its errors, and which effects refine a number."""

import re
from pathlib import Path

import boats
import pytest

from boatsim.diagnosis import priors
from boatsim.errors import BadInput
from boatsim.physics import content, vessel
from boatsim.physics.base import Effect
from boatsim.physics.kinds.effect import REFINED_GROUPS
from boatsim.physics.vessel import sd_of_corrected_estimates
from boatsim.physics.vessel.schema import Body

TABLE = """
[estimated]
damping = 0.5
"body.mass" = 0.1
thrust_lag.time_constant = 1.0
"""


def of(text: str, tmp_path: Path) -> vessel.Vessel:
    """The test boat with more lines in its file."""
    return vessel.load_vessel(str(boats.written(tmp_path, "test_boat", boats.PLANAR + text)))


def candidate(name: str, of_vessel: vessel.Vessel) -> Effect:
    found: Effect = (
        content.load_class("effect", name).from_settings({}).with_all_parameters(of_vessel)
    )
    return found


def test_the_table_is_read_and_saved(tmp_path: Path) -> None:
    loaded = of(TABLE, tmp_path)
    assert loaded.estimated == {"damping": 0.5, "body.mass": 0.1, "thrust_lag.time_constant": 1.0}
    saved = loaded.save(tmp_path / "saved")
    assert (
        vessel.load_vessel(str(tmp_path / "saved")).estimated == saved.estimated == loaded.estimated
    )
    assert of("", tmp_path).estimated == {}


@pytest.mark.parametrize(
    "line, message",
    [
        ("dampig = 0.5", "key in [estimated] 'dampig' does not exist; did you mean 'damping'?"),
        ("damping = -0.5", "estimated.damping = -0.5; input should be greater than 0"),
        ('damping = "much"', "estimated.damping = 'much'; input should be a valid number"),
        ("body.mas = 0.1", "'body.mas' does not exist; did you mean 'body.mass'?"),
        ("thrust_lag.time = 1.0", "did you mean 'thrust_lag.time_constant'?"),
    ],
)
def test_a_wrong_key_or_value_gives_one_line(line: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(BadInput, match=re.escape(message)) as error:
        of(f"[estimated]\n{line}\n", tmp_path)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("name", content.shipped_content_names("effect"))
def test_every_effect_refines_a_known_group_or_none(name: str) -> None:
    kind: type[Effect] = content.load_class("effect", name)
    assert kind.refines in ("", *REFINED_GROUPS)
    assert not (kind.refines and kind.kind == "measurement")
    for parameter, number in kind.adds_to.items():
        owner, key = number.split(".")
        assert parameter in kind.params() and owner == "body" and key in Body.model_fields


@pytest.mark.parametrize(
    "line, effect, sd",
    [
        ("lag = 1.0", "thrust_lag", 1.0),
        ("lag = 1.0", "weak_reverse", None),
        ('"thrust_lag.time_constant" = 2.0', "thrust_lag", 2.0),
        ("damping = 0.5", "quadratic_damping", 0.5),
        ("damping = 0.5", "damping_error", 0.5),
        ("inertia = 0.3", "payload", 0.3),
        ('"body.mass" = 0.1', "extra_mass", 0.1),
        ('"body.mass" = 0.1\n"body.yaw_inertia" = 0.3\n"body.roll_inertia" = 0.2', "payload", 0.3),
        ('"position_frame_error.forward" = 1.0', "position_frame_error", 1.0),
        # the mass was weighed, only an inertia is an estimate
        ('"body.yaw_inertia" = 0.3', "payload", None),
        ('"body.yaw_inertia" = 0.3', "extra_mass", None),
    ],
)
def test_an_effect_refines_numbers_that_are_estimated(
    line: str, effect: str, sd: float | None, tmp_path: Path
) -> None:
    loaded = of(f"[estimated]\n{line}\n", tmp_path)
    assert sd_of_corrected_estimates(candidate(effect, loaded), loaded, loaded.estimated) == sd
    assert sd_of_corrected_estimates(candidate(effect, loaded), loaded, {}) is None


def test_an_estimate_is_the_prior_of_the_coefficients(tmp_path: Path) -> None:
    loaded = of("[estimated]\ndamping = 0.7\n", tmp_path)
    assert priors.coefficient_uncertainty(loaded)["damping"] == 0.7
    text = "[diagnosis]\ncoefficient_uncertainty = { damping = 0.2 }\n[estimated]\ndamping = 0.7\n"
    assert priors.coefficient_uncertainty(of(text, tmp_path))["damping"] == 0.2
