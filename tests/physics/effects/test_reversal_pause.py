"""Pause of a drive between ahead and astern: its law, and recordings in which it is found."""

from typing import Any

import numpy as np
import pytest
from driven_boats import (
    STEP,
    driven,
    paused,
    platform_of_three_drives,
    random_orders,
    ranked,
)

from boatsim.diagnosis.candidates import candidate_library
from boatsim.physics import vessel
from boatsim.physics.base import Array, SignalSegment, segment_mean
from boatsim.physics.effects.reversal_pause import (
    ReversalPause,
    present_output,
    time_to_discontinuity,
    transform_signal,
)

SETTLED = 1e4  # [s] a long step, with which actuators are settled
RIVALS = (
    "reversal_pause",
    "thrust_lag",
    "command_delay",
    "weak_reverse",
    "thrust_deadband",
    "shaft_deadband",
    "thrust_exponent",
)


def impulses(pause: float, orders: list[tuple[float, float]], first: float = 0.0) -> list[float]:
    """Impulses [N s] of a drive under orders [N], each held for some seconds, after a first one."""
    q = ReversalPause(pause=pause).values()
    memory = np.zeros(2)
    found = []
    for order, seconds in [(first, SETTLED)] * 3 + orders:
        x = SignalSegment(order, order, order)
        out = transform_signal.py_func(x, 0.0, 0.0, memory, 0, seconds, q)
        found.append(segment_mean(out) * seconds)
    return found[3:]


@pytest.mark.parametrize(
    ("orders", "expected"),
    [
        ([(1.0, 3.0), (-1.0, 3.0), (1.0, 2.0)], [3.0, -2.0, 1.0]),
        ([(1.0, 3.0), (0.0, 0.4), (-1.0, 3.0)], [3.0, 0.0, -2.4]),  # it stands under zero, too
        ([(1.0, 3.0), (0.0, 5.0), (-1.0, 3.0)], [3.0, 0.0, -3.0]),
        ([(1.0, 3.0), (0.0, 5.0), (1.0, 3.0)], [3.0, 0.0, 3.0]),  # in the same direction at once
        ([(2.0, 3.0), (-1.0, 0.5), (2.0, 3.0)], [6.0, 0.0, 4.0]),  # each change has its own pause
        ([(-2.0, 3.0), (-1.0, 0.5), (2.0, 0.5), (3.0, 1.0)], [-6.0, -0.5, 0.0, 1.5]),
    ],
)
def test_a_drive_stands_for_a_second_after_each_change_of_sign(
    orders: list[tuple[float, float]], expected: list[float]
) -> None:
    assert impulses(1.0, orders) == pytest.approx(expected)


def test_the_first_order_from_rest_is_followed_at_once_in_both_directions() -> None:
    assert impulses(1.0, [(2.0, 1.0)]) == [2.0]
    assert impulses(1.0, [(-2.0, 1.0)]) == [-2.0]
    assert impulses(1.0, [(-2.0, 1.5)], first=1.0) == pytest.approx([-1.0])


def test_the_impulse_is_continuous_in_the_pause_and_falls_by_the_order_per_second() -> None:
    orders = [(1.0, 0.7), (-1.0, 0.7), (1.0, 0.7), (-1.0, 0.7)]
    pauses = np.linspace(0.0, 2.0, 401)
    sums = np.array([np.abs(impulses(pause, orders)).sum() for pause in pauses])
    assert sums[0] == pytest.approx(2.8)
    assert np.abs(np.diff(sums)).max() < 3.0 * np.diff(pauses)[0] + 1e-9  # three changes of sign
    assert sums[1] - sums[0] == pytest.approx(-3.0 * pauses[1])


def test_the_result_does_not_depend_on_the_steps() -> None:
    coarse = [(1.0, 0.5), (-1.0, 2.0), (0.0, 0.3), (1.0, 1.0)]
    fine = [(order, 0.05) for order, seconds in coarse for _ in range(round(seconds / 0.05))]
    assert sum(impulses(0.73, fine)) == pytest.approx(sum(impulses(0.73, coarse)))


def test_a_step_ends_with_the_pause() -> None:
    q, memory = ReversalPause(pause=0.8).values(), np.zeros(2)

    def advance(order: float, seconds: float) -> Any:
        x = SignalSegment(order, order, order)
        return transform_signal.py_func(x, 0.0, 0.0, memory, 0, seconds, q)

    advance(1.0, SETTLED)
    assert time_to_discontinuity.py_func(1.0, memory, 0, q) == np.inf
    assert time_to_discontinuity.py_func(0.0, memory, 0, q) == np.inf
    assert time_to_discontinuity.py_func(-1.0, memory, 0, q) == 0.8
    assert advance(-1.0, 0.3) == (0.0, 0.0, 0.0)
    assert time_to_discontinuity.py_func(-1.0, memory, 0, q) == pytest.approx(0.5)
    assert present_output.py_func(-1.0, memory, 0, q) == 0.0
    advance(-1.0, 0.5)
    assert time_to_discontinuity.py_func(-1.0, memory, 0, q) == np.inf
    assert present_output.py_func(-1.0, memory, 0, q) == -1.0
    assert advance(-1.0, 0.2) == (-1.0, -1.0, -1.0)


def test_it_is_tested_only_where_a_drive_can_push_astern() -> None:
    for name in ("trial_boat", "otter", "blueboat"):
        assert "reversal_pause" in candidate_library(vessel.load_vessel(name)).tested_names
    one_way = candidate_library(vessel.load_vessel("catamaran"))
    assert one_way.inapplicable["reversal_pause"] == "no command is negative"
    single = candidate_library(vessel.load_vessel("osv")).tested_names
    assert "drive_reversal_pause_bow_1_N" in single
    assert "drive_reversal_pause_n_port_radps" not in single  # it pushes ahead only


# ---- recordings


CRAFT = {  # vessel -> channels of the drives, and the largest order in their unit
    "trial_boat": (("thrust_port_N", "thrust_starboard_N"), 0.9),
    "otter": (("n_port_radps", "n_starboard_radps"), 80.0),
}


def ranking_of(name: str, pause: float, seeds: tuple[int, int]) -> Any:
    """What two recordings of a vessel whose drives pause say of the candidates."""
    boat = vessel.load_vessel(name)
    channels, largest = CRAFT[name]
    recordings = []
    for seed in seeds:
        orders = random_orders(np.random.default_rng(seed), [largest] * 2, 30, 10)
        columns = dict(zip(channels, orders.T, strict=True))
        others = set(boat.commands) - set(channels)
        columns |= {other: np.zeros(len(orders)) for other in sorted(others)}
        recordings.append(driven(boat, columns, lambda x: paused(x, pause), seed))
    return ranked(boat, RIVALS, *recordings)


def only_the_second_pauses(orders: Array) -> Array:
    """Orders of three drives, the second of which stands for 0.8 s after each change of sign."""
    return np.column_stack([orders[:, 0], paused(orders, 0.8)[:, 1], orders[:, 2]])


@pytest.mark.slow
@pytest.mark.parametrize(("name", "pause"), [("trial_boat", 0.6), ("otter", 0.8)])
def test_a_pause_is_found_with_its_length(name: str, pause: float) -> None:
    ranking = ranking_of(name, pause, (1, 2))
    assert [one.name for one in ranking.named] == ["reversal_pause"]
    value, sd = ranking.best.value("reversal_pause", "pause")
    assert abs(value - pause) < max(4.0 * sd, 0.05)


@pytest.mark.slow
@pytest.mark.parametrize("name", CRAFT)
def test_no_pause_is_found_where_the_drives_reverse_at_once(name: str) -> None:
    assert "reversal_pause" not in [one.name for one in ranking_of(name, 0.0, (3, 4)).named]


@pytest.mark.slow
def test_a_lag_is_not_taken_for_a_pause() -> None:
    def lagging(orders: Array) -> Array:
        out = orders.copy()
        for row in range(1, len(orders)):
            out[row] = out[row - 1] + (orders[row] - out[row - 1]) * STEP / 0.3
        return out

    boat = vessel.load_vessel("trial_boat")
    recordings = []
    for seed in (5, 6):
        orders = random_orders(np.random.default_rng(seed), [0.9, 0.9], 30, 10)
        columns = dict(zip(CRAFT["trial_boat"][0], orders.T, strict=True))
        columns |= {name: np.zeros(300) for name in ("steer_port_rad", "steer_starboard_rad")}
        recordings.append(driven(boat, columns, lagging, seed))
    assert [one.name for one in ranked(boat, RIVALS, *recordings).named] == ["thrust_lag"]


@pytest.mark.slow
def test_the_pause_of_one_of_three_drives_is_found_with_the_drive() -> None:
    boat = platform_of_three_drives()
    drives = tuple(boat.commands)
    recordings = []
    for seed in (1, 2):
        orders = random_orders(np.random.default_rng(seed), [8.0] * 3, 30, 10)
        columns = dict(zip(drives, orders.T, strict=True))
        recordings.append(driven(boat, columns, only_the_second_pauses, seed))
    tested = tuple(
        f"drive_{effect}_{drive}"
        for effect in ("reversal_pause", "lag", "delay")
        for drive in drives
    )
    ranking = ranked(boat, ("reversal_pause", "thrust_lag", *tested), *recordings)
    assert [one.name for one in ranking.named] == ["drive_reversal_pause_port_N"]
    value, sd = ranking.best.value("drive_reversal_pause_port_N", "pause")
    assert abs(value - 0.8) < max(4.0 * sd, 0.05)
