"""Limit of the thrust as a share of the largest command, ahead and astern."""

from types import SimpleNamespace

import numpy as np
import pytest
from driven_boats import driven, random_orders, ranked

from boatsim.diagnosis.candidates import candidate_library
from boatsim.physics import vessel
from boatsim.physics.effects.thrust_limit import ROUNDED, limit_thrust


def limited(command: float, share: float = 0.5) -> float:
    values = SimpleNamespace(share=share, full_ahead=4.0, full_astern=2.0)
    return float(limit_thrust.py_func(command, values))


@pytest.mark.parametrize(
    ("command", "thrust"),
    [(0.0, 0.0), (1.8, 1.8), (3.0, 2.0), (4.0, 2.0), (-0.4, -0.4), (-1.5, -1.0), (-2.0, -1.0)],
)
def test_thrust_follows_the_command_up_to_the_limit(command: float, thrust: float) -> None:
    assert limited(command) == pytest.approx(thrust)


@pytest.mark.parametrize("share", [0.5, 0.98, 0.999])
def test_value_and_slope_are_continuous_in_the_command(share: float) -> None:
    x = np.linspace(0.0, 4.0, 400_001)
    y = np.array([limited(command, share) for command in x.tolist()])
    slope = np.diff(y) / np.diff(x)
    half = min(ROUNDED, 1.0 - share) * 4.0  # [N] over which the slope falls from 1 to 0
    assert np.abs(np.diff(slope)).max() < 1.01 * (x[1] - x[0]) / (2.0 * half) + 1e-6
    assert y[-1] == pytest.approx(share * 4.0)


def test_a_limit_at_full_command_changes_nothing_and_has_a_slope_there() -> None:
    for command in np.linspace(-2.0, 4.0, 61).tolist():
        assert limited(command, 1.0) == command
    for less in (1e-3, 1e-6):  # full command ahead loses what the limit is lower
        assert (4.0 - limited(4.0, 1.0 - less)) / less == pytest.approx(4.0)


def test_full_command_is_the_limit_of_the_channels() -> None:
    boat = vessel.load_vessel("blueboat", extra=[{"use": "thrust_limit"}])
    effect = boat.effect("thrust_limit")
    assert effect is not None
    limits = [boat.limits()[name] for name in boat.target_actuators(effect)]
    ahead, astern = max(high for _, high in limits), max(-low for low, _ in limits)
    assert effect.derived_parameters(boat) == {"full_ahead": ahead, "full_astern": astern}


def test_it_is_a_candidate_for_thrusts_and_for_shafts() -> None:
    thrusts, shafts = (candidate_library(vessel.load_vessel(n)) for n in ("trial_boat", "otter"))
    assert {"thrust_limit"} == {"thrust_limit", "shaft_limit"} & set(thrusts.tested_names)
    assert {"shaft_limit"} == {"thrust_limit", "shaft_limit"} & set(shafts.tested_names)


SHAFTS = ("n_port_radps", "n_starboard_radps")
RIVALS = ("shaft_limit", "shaft_deadband", "thrust_imbalance", "weak_reverse", "command_delay")


@pytest.mark.slow
@pytest.mark.parametrize(("share", "names"), [(0.5, ["shaft_limit"]), (1.0, [])])
def test_a_limit_of_the_shaft_rate_is_found_with_its_size(share: float, names: list[str]) -> None:
    """Recordings of an integrator that clips the orders sharply."""
    boat = vessel.load_vessel("otter")
    effect = vessel.load_vessel("otter", extra=[{"use": "shaft_limit"}]).effect("shaft_limit")
    assert effect is not None
    most = effect.derived_parameters(boat)
    low, high = -share * most["full_astern"], share * most["full_ahead"]
    recordings = []
    for seed in (1, 2):
        orders = random_orders(np.random.default_rng(seed), [most["full_ahead"]] * 2, 30, 10)
        columns = dict(zip(SHAFTS, orders.T, strict=True))
        recordings.append(driven(boat, columns, lambda x: np.clip(x, low, high), seed))
    ranking = ranked(boat, RIVALS, *recordings)
    assert [one.name for one in ranking.named] == names
    if names:
        value, sd = ranking.best.value("shaft_limit", "share")
        assert abs(value - share) < max(4.0 * sd, 0.02)
