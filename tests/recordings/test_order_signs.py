"""Orders of drives that lost their sign follow from the force and moment of the same log."""

import numpy as np
import pytest

from boatsim.recordings.order_signs import (
    laws_of_unsigned_orders,
    order_law,
    rows_without_sign,
    signed_orders,
)

RNG = np.random.default_rng(7)
FORCE = np.repeat(RNG.uniform(-40.0, 120.0, 60), 20)  # [N]
MOMENT = np.repeat(RNG.uniform(-30.0, 30.0, 60), 20)  # [N m]
GAIN, HALF = 0.01, 0.4  # [N s^2/rad^2] of a propeller, [m] from the middle line


def thrusts(force: np.ndarray, moment: np.ndarray) -> dict[str, np.ndarray]:
    return {
        "n_port": 0.5 * force + 0.5 * moment / HALF,
        "n_starboard": 0.5 * force - 0.5 * moment / HALF,
    }


def rates(thrust: np.ndarray) -> np.ndarray:
    return np.sign(thrust) * np.sqrt(np.abs(thrust) / GAIN)


TRUE = {name: rates(thrust) for name, thrust in thrusts(FORCE, MOMENT).items()}
# what a program may log: the size, zero instead of astern, or the order for the size of the force
LOGGED = {
    "size": {name: np.abs(values) for name, values in TRUE.items()},
    "clipped": {name: np.maximum(values, 0.0) for name, values in TRUE.items()},
    "size of the force": {
        name: np.maximum(rates(thrust), 0.0)
        for name, thrust in thrusts(np.abs(FORCE), MOMENT).items()
    },
}


@pytest.mark.parametrize("orders", LOGGED.values(), ids=LOGGED)
def test_lost_signs_are_restored_by_force_and_moment(orders: dict[str, np.ndarray]) -> None:
    laws = laws_of_unsigned_orders(orders, FORCE, MOMENT)
    assert laws.keys() == TRUE.keys()
    for name, law in laws.items():
        assert law.squared and law.a == pytest.approx(0.5 / GAIN, rel=1e-3)
        assert np.array_equal(law.negative, TRUE[name] < -np.sqrt(0.01 * law.range))
        off = law.force(law.with_sign(orders[name], rows_without_sign(laws))) - law.force(
            TRUE[name]
        )
        assert np.abs(off).max() <= 0.01 * law.range


def test_rounded_orders_keep_their_logged_values_where_they_follow_the_law() -> None:
    orders = {name: np.round(np.abs(values), 1) for name, values in TRUE.items()}
    laws = laws_of_unsigned_orders(orders, FORCE, MOMENT)
    for name, law in laws.items():
        ahead = TRUE[name] > 0.0
        assert np.array_equal(
            law.with_sign(orders[name], rows_without_sign(laws))[ahead], orders[name][ahead]
        )


def test_thrusts_are_recognised_as_such() -> None:
    thrust = thrusts(FORCE, MOMENT)["n_port"]
    law = order_law(np.maximum(thrust, 0.0), FORCE, MOMENT)
    assert not law.squared and law.b == pytest.approx(0.5 / HALF, rel=1e-6)


def test_force_and_moment_that_are_not_known_leave_the_orders_as_they_are() -> None:
    force = np.where(np.arange(len(FORCE)) % 3 == 0, np.nan, FORCE)
    orders = LOGGED["size"]
    laws = laws_of_unsigned_orders(orders, force, MOMENT)
    assert laws
    for name, law in laws.items():
        unknown = np.isnan(force)
        assert np.array_equal(
            law.with_sign(orders[name], rows_without_sign(laws))[unknown], orders[name][unknown]
        )


@pytest.mark.parametrize(
    ("orders", "force"),
    [
        pytest.param(TRUE, FORCE, id="signs are there"),
        pytest.param(LOGGED["size"], FORCE[::-1], id="another force"),
        pytest.param(
            {name: rates(thrust) for name, thrust in thrusts(np.abs(FORCE) + 80, MOMENT).items()},
            np.abs(FORCE) + 80.0,
            id="never astern",
        ),
        pytest.param({name: np.zeros(len(FORCE)) for name in TRUE}, FORCE, id="no orders"),
    ],
)
def test_other_orders_have_lost_nothing(orders: dict[str, np.ndarray], force: np.ndarray) -> None:
    assert laws_of_unsigned_orders(orders, force, MOMENT) == {}


def test_saturated_orders_ahead_are_not_changed() -> None:
    most = 0.8 * max(values.max() for values in TRUE.values())
    orders = {name: np.minimum(values, most) for name, values in LOGGED["size"].items()}
    laws = laws_of_unsigned_orders(orders, FORCE, MOMENT)
    assert laws
    ahead = np.all([values > 0.0 for values in TRUE.values()], axis=0)
    for name, law in laws.items():
        after = law.with_sign(orders[name], rows_without_sign(laws))
        assert np.array_equal(after[ahead], orders[name][ahead])


def test_rows_without_force_and_moment_are_no_evidence_of_a_law() -> None:
    rng = np.random.default_rng(1)
    orders = {name: rng.uniform(1.0, 90.0, len(FORCE)) for name in TRUE}
    force = np.where(rng.uniform(size=len(FORCE)) < 0.15, FORCE, np.nan)
    assert laws_of_unsigned_orders(orders, force, MOMENT) == {}


def test_orders_for_the_size_of_the_force_are_turned_round_with_their_sides() -> None:
    """A program that turns the direction of its force turns -P and -S of opposite drives."""
    orders = LOGGED["size of the force"]
    possible = signed_orders(orders, laws_of_unsigned_orders(orders, FORCE, MOMENT), FORCE)
    assert possible.keys() == {"computed", "signed", "idle", "exchanged"}
    port, starboard = orders["n_port"], orders["n_starboard"]
    astern = FORCE < 0.0
    assert np.array_equal(possible["exchanged"]["n_port"][astern], -starboard[astern])
    assert np.array_equal(possible["exchanged"]["n_starboard"][astern], -port[astern])
    for name in orders:
        assert np.array_equal(possible["exchanged"][name][~astern], orders[name][~astern])
    # where both push astern, this is what force and moment ask for
    both = astern & (np.maximum(TRUE["n_port"], TRUE["n_starboard"]) < 0.0)
    assert both.sum() > 50
    assert possible["exchanged"]["n_port"][both] == pytest.approx(TRUE["n_port"][both], rel=1e-9)


def test_sizes_as_logged_take_the_sign_alone() -> None:
    for kind in ("size", "clipped"):
        orders = LOGGED[kind]
        possible = signed_orders(orders, laws_of_unsigned_orders(orders, FORCE, MOMENT), FORCE)
        for name, values in possible["signed"].items():
            assert np.array_equal(np.abs(values), orders[name])
            small = TRUE[name] ** 2 < 0.02 * np.max(TRUE[name] ** 2)
            expected = TRUE[name] if kind == "size" else orders[name]
            assert values[~small] == pytest.approx(expected[~small], rel=1e-9)


def test_sides_are_exchanged_only_between_opposite_drives() -> None:
    """Without the drive of the other side none can have taken its order."""
    orders = {"n_port": LOGGED["size"]["n_port"]}
    laws = laws_of_unsigned_orders(orders, FORCE, MOMENT)
    assert laws and "exchanged" not in signed_orders(orders, laws, FORCE)
