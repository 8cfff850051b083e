"""What an open library must stand: entries that explain nothing, many of them, on boats that it has
no list for."""

from pathlib import Path

import numpy as np
import pytest

from boatsim.diagnosis import pipeline
from boatsim.diagnosis.priors import assumed_disturbance, estimate_sensor_noise
from boatsim.diagnosis.search.evidence import combined_gain, required_gain
from boatsim.diagnosis.search.generalization import error_ratio, errors_grew
from boatsim.physics import vessel
from boatsim.recordings.table import Recording

TRIALS = Path(__file__).parents[1] / "data" / "trials"
IRRELEVANT = '''"""A push in one place of the water."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    if ({a:.3f} * m.x + {b:.3f} * m.y + {c:.3f} * m.t) % 1.0 < {share:.3f}:
        return wrench(X=q.surge, Y=q.sway, N=q.yaw)
    return wrench()


@dataclass(frozen=True)
class {name}(Force):
    """Drawn at random."""

    words: ClassVar[str] = "something pushes now and then, here and there"
    law: ClassVar = law

    surge: float = param(0.0, low=-9.0, high=9.0, unit="N", words="ahead", fit=True, spread=0.1)
    sway: float = param(0.0, low=-9.0, high=9.0, unit="N", words="to starboard", fit=True, spread=0.1)
    yaw: float = param(0.0, low=-9.0, high=9.0, unit="N m", words="clockwise", fit=True, spread=0.03)
'''


def drawn(folder: Path, number: int) -> list[str]:
    """Files of entries that act where and when chance has it."""
    rng, files = np.random.default_rng(10), []
    for i in range(number):
        name = f"chance{chr(97 + i)}"
        a, b, c = rng.uniform(-1.0, 1.0, 3) * (1.0, 1.0, 0.1)
        text = IRRELEVANT.format(name=name.capitalize(), a=a, b=b, c=c, share=rng.uniform(0.1, 0.5))
        (folder / f"{name}.py").write_text(text)
        files.append(str(folder / f"{name}.py"))
    return files


@pytest.mark.slow
@pytest.mark.long
def test_twenty_entries_that_explain_nothing_change_no_verdict(tmp_path: Path) -> None:
    library = drawn(tmp_path, 20)
    for trial in sorted(p for p in TRIALS.iterdir() if p.is_dir()):
        runs, held_out = [trial / "run_1.csv", trial / "run_2.csv"], [trial / "run_3.csv"]
        usual = pipeline.diagnose(runs, held_out).findings.answer
        more = pipeline.diagnose(runs, held_out, library=library).findings.answer
        assert len(more["tried"]) == len(usual["tried"]) + 20
        assert more["rules"]["effect_gain_nats"] > usual["rules"]["effect_gain_nats"]
        assert more["verdict"] == usual["verdict"], trial.name
        assert [e["name"] for e in more["effects"]] == [e["name"] for e in usual["effects"]], (
            trial.name
        )


def test_the_price_of_an_effect_grows_with_the_number_tried_and_look_alikes_pay_together() -> None:
    assert required_gain(60) - required_gain(20) == pytest.approx(np.log(3.0))
    assert combined_gain([5.0, 5.0, -np.inf]) == pytest.approx(5.0 + np.log(2.0))


def test_an_error_has_grown_where_it_is_beyond_its_scatter_and_five_percent() -> None:
    before = {"position_rms_m": [1.0, 1.0, 1.0, 1.0]}
    assert errors_grew(before, {"position_rms_m": [1.3, 1.25, 1.35, 1.3]}, 2.0)
    assert not errors_grew(
        before, {"position_rms_m": [1.02, 1.02, 1.02, 1.02]}, 2.0
    )  # by one percent of the rms
    assert not errors_grew(before, {"position_rms_m": [3.0, 0.5, 0.9, 1.0]}, 2.0)  # scatter
    assert not errors_grew(
        {"position_rms_m": [1.0]}, {"position_rms_m": [9.0]}, 2.0
    )  # of one alone the scatter is not known
    assert error_ratio({"a": [4.0], "b": [1.0]}, {"a": [1.0], "b": [1.0]}) == pytest.approx(2.0)


def test_tolerated_forces_go_with_the_weight_and_their_moments_with_the_hull() -> None:
    boat, ship = vessel.load_vessel("trial_boat"), vessel.load_vessel("eastward_ho")
    force, moment = (
        assumed_disturbance(ship)[axis] / assumed_disturbance(boat)[axis]
        for axis in ("surge", "yaw")
    )
    assert force == pytest.approx(ship.body.mass / boat.body.mass)
    assert moment == pytest.approx(force * ship.length / boat.length)
    assert assumed_disturbance(ship)["roll"] == pytest.approx(
        assumed_disturbance(ship)["sway"] * ship.draught
    )


@pytest.mark.parametrize("noise", [0.002, 0.02])
def test_noise_that_nobody_states_is_found_in_a_moving_signal_with_outliers(noise: float) -> None:
    t, rng = np.arange(0.0, 60.0, 0.15), np.random.default_rng(3)
    x = 2.0 * np.sin(0.5 * t) + 0.1 * t + noise * rng.standard_normal(len(t))
    x[::50] += 1.0
    found = estimate_sensor_noise(
        vessel.load_vessel("trial_boat"), [Recording("r", t, {"x_m": x, "y_m": x})], "position_sd_m"
    )
    assert found == pytest.approx(noise, rel=0.25)
    assert (
        estimate_sensor_noise(
            vessel.load_vessel("trial_boat"), [Recording("r", t, {"x_m": x})], "heading_sd_rad"
        )
        == 0.0
    )
