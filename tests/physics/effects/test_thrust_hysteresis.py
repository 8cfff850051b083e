"""Play of thrust commands: its law, and recordings in which it is found."""

from typing import Any

import numpy as np
import pytest
from driven_boats import driven, platform_of_three_drives, played, random_orders, ranked

from boatsim.diagnosis.candidates import candidate_library
from boatsim.physics import vessel
from boatsim.physics.base import Array, SignalSegment
from boatsim.physics.effects.thrust_hysteresis import ThrustHysteresis

SETTLED = 1e4  # [s] a long step, with which actuators are settled
RIVALS = (
    "thrust_hysteresis",
    "shaft_hysteresis",
    "reversal_pause",
    "thrust_lag",
    "command_delay",
    "weak_reverse",
    "thrust_deadband",
    "shaft_deadband",
    "thrust_exponent",
    "thrust_imbalance",
)


def thrusts(width: float, orders: Array, first: float = 0.0, behind: float = 0.0) -> Array:
    """Thrusts [N] of a drive under orders [N] of a second each, settled to a first one."""
    q = ThrustHysteresis(width=width, behind=behind).values()
    memory = np.zeros(1)
    found = []
    for order, seconds in [(first, SETTLED)] * 3 + [(order, 1.0) for order in orders.tolist()]:
        x = SignalSegment(order, order, order)
        out = ThrustHysteresis.transform_signal.py_func(x, 0.0, 0.0, memory, 0, seconds, q)
        found.append(out.end)
    return np.array(found[3:])


def test_a_staircase_gives_less_thrust_on_its_way_up_than_on_its_way_down() -> None:
    up = np.array([1.0, 2.0, 3.0])
    assert thrusts(0.4, up) == pytest.approx(up - 0.2)
    down = np.array([2.0, 1.0, 0.0])
    assert thrusts(0.4, np.append(up, down))[3:] == pytest.approx(down + 0.2)


def test_a_change_within_the_play_changes_nothing() -> None:
    assert thrusts(0.4, np.array([2.0, 1.7, 1.6, 1.9, 2.0])) == pytest.approx(np.full(5, 1.8))


def test_the_loop_of_a_sine_has_the_area_of_the_play_operator() -> None:
    """Parallelogram of width b over the amplitude a to both sides: b (2 a - b) a period."""
    amplitude, width = 2.0, 0.5
    orders = amplitude * np.sin(np.linspace(0.0, 4.0 * np.pi, 40001))
    out = thrusts(width, orders)
    x, y = orders[20000:], out[20000:]
    area = abs(np.sum(0.5 * (y[1:] + y[:-1]) * np.diff(x)))
    assert area == pytest.approx(width * (2.0 * amplitude - width), rel=1e-3)


@pytest.mark.parametrize(("behind", "first"), [(0.0, 1.0), (0.5, 0.9), (1.0, 0.8)])
def test_the_first_thrust_lies_within_the_play(behind: float, first: float) -> None:
    assert thrusts(0.4, np.array([1.0]), 1.0, behind) == pytest.approx([first])


def test_it_is_a_candidate_for_thrusts_for_shafts_and_for_single_drives() -> None:
    assert "thrust_hysteresis" in candidate_library(vessel.load_vessel("trial_boat")).tested_names
    shafts = candidate_library(vessel.load_vessel("otter"))
    assert "shaft_hysteresis" in shafts.tested_names
    assert "thrust_hysteresis" in shafts.inapplicable
    single = candidate_library(platform_of_three_drives()).tested_names
    assert {f"drive_hysteresis_{drive}_N" for drive in ("bow", "port", "starboard")} <= set(single)


# ---- recordings


CRAFT = {  # vessel -> candidate, channels of the drives, largest order and play in their unit
    "trial_boat": ("thrust_hysteresis", ("thrust_port_N", "thrust_starboard_N"), 0.9, 0.3),
    "otter": ("shaft_hysteresis", ("n_port_radps", "n_starboard_radps"), 80.0, 20.0),
}


def ranking_of(name: str, width: float, seeds: tuple[int, int]) -> Any:
    """What two recordings of a vessel whose drives have play say of the candidates."""
    boat = vessel.load_vessel(name)
    _, channels, largest, _ = CRAFT[name]
    recordings = []
    for seed in seeds:
        orders = random_orders(np.random.default_rng(seed), [largest] * 2, 30, 10)
        columns = dict(zip(channels, orders.T, strict=True))
        others = set(boat.commands) - set(channels)
        columns |= {other: np.zeros(len(orders)) for other in sorted(others)}
        recordings.append(driven(boat, columns, lambda x: played(x, width), seed))
    return ranked(boat, RIVALS, *recordings)


@pytest.mark.slow
@pytest.mark.parametrize("name", CRAFT)
def test_a_play_is_found_with_its_width(name: str) -> None:
    effect, _, _, width = CRAFT[name]
    ranking = ranking_of(name, width, (1, 2))
    assert [one.name for one in ranking.named] == [effect]
    value, sd = ranking.best.value(effect, "width")
    assert abs(value - width) < max(4.0 * sd, 0.05 * width)


@pytest.mark.slow
@pytest.mark.parametrize("name", CRAFT)
def test_no_play_is_found_where_there_is_none(name: str) -> None:
    assert CRAFT[name][0] not in [one.name for one in ranking_of(name, 0.0, (3, 4)).named]


@pytest.mark.slow
def test_a_dead_band_is_not_taken_for_play() -> None:
    boat = vessel.load_vessel("trial_boat")
    recordings = []
    for seed in (5, 6):
        orders = random_orders(np.random.default_rng(seed), [0.9, 0.9], 30, 10)
        columns = dict(zip(CRAFT["trial_boat"][1], orders.T, strict=True))
        columns |= {name: np.zeros(300) for name in ("steer_port_rad", "steer_starboard_rad")}
        recordings.append(driven(boat, columns, lambda x: x - np.clip(x, -0.15, 0.15), seed))
    assert [one.name for one in ranked(boat, RIVALS, *recordings).named] == ["thrust_deadband"]
