"""Many boats at once: each moves as it would alone, whoever steps it, and as the twin does."""

import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.simulate.batch import TURN, Batch

EXTRA = (
    {"use": "weak_reverse", "astern_factor": 0.694},
    {"use": "fan_wind", "speed": 1.5, "toward": 0.8},
    {"use": "current", "north": 0.02, "east": -0.01},
)
BOAT = vessel.load_vessel("joystick_boat", extra=EXTRA)
START = [0.0, 0.0, 0.3, 0.2, 0.05, 0.1]


def orders(n: int, seed: int = 0) -> np.ndarray:
    """Commands of n boats, all of them different."""
    rng = np.random.default_rng(seed)
    low, high = np.array(list(BOAT.limits().values())).T
    return rng.uniform(low, high, (n, len(low))) * [0, 0, 1, 1, 1, 1]


def sailed(batch: Batch, calls: int = 12) -> np.ndarray:
    """States after some control periods, each with commands of its own."""
    batch.reset(START)
    for i in range(calls):
        batch.advance(orders(batch.n, i), 4)
    return batch.states


def test_a_boat_in_a_batch_moves_to_the_last_bit_as_it_does_alone_on_any_number_of_threads():
    n = 2 * TURN + 3  # more turns than threads, the last of them short
    wind = np.linspace(0.0, 2.0, n)

    def fleet(threads: int) -> np.ndarray:
        batch = Batch(BOAT, n, threads=threads)
        batch.set("fan_wind.speed", wind)
        return sailed(batch)

    together = fleet(1)
    assert (fleet(2) == together).all() and (fleet(5) == together).all()
    assert len(np.unique(together[:, 0])) == n
    for i in (0, TURN - 1, TURN, n - 1):
        alone = Batch(BOAT, 1)
        alone.set("fan_wind.speed", wind[i])
        alone.reset(START)
        for k in range(12):
            alone.advance(orders(n, k)[i], 4)
        assert (alone.states[0] == together[i]).all()


@pytest.mark.parametrize("name", ["joystick_boat", "otter", "kvlcc2_mmg", "jet_ski"])
def test_a_batch_agrees_with_the_twin(name):
    boat = vessel.load_vessel(name)
    compiled, batch = Batch(boat, step=0.02), Batch(boat, 3, 0.02)
    low, high = np.array(list(boat.limits().values())).T
    rows = np.random.default_rng(1).uniform(0.3 * low, 0.3 * high, (20, len(low)))
    rows = np.where(np.isfinite(rows), rows, 0.0)
    start = np.zeros(2 * compiled.code.NQ)
    start[compiled.code.NQ] = 1.0
    course = compiled.rollout(start, rows, 0.1)
    batch.reset(start, rows[0])
    for i, row in enumerate(rows):
        batch.advance(row, 5)
        np.testing.assert_allclose(
            batch.states, np.tile(course[i + 1], (3, 1)), rtol=1e-9, atol=1e-9
        )
    np.testing.assert_allclose(batch.t, 2.0)


def test_actuators_keep_what_they_remember_from_call_to_call():
    whole, pieces = Batch(BOAT, 2), Batch(BOAT, 2)
    order = orders(2)
    whole.advance(order, 40)
    for _ in range(40):
        pieces.advance(order)
    assert (whole.states == pieces.states).all() and (whole.actuators == pieces.actuators).all()


def test_only_the_boats_meant_are_reset_set_and_assigned():
    batch = Batch(
        [vessel.load_vessel("joystick_boat", [load], extra=EXTRA) for load in ("light", "heavy")], 6
    )
    mass = batch._body[:, 0].copy()
    assert mass[0] != mass[1] and (mass[::2] == mass[0]).all()
    batch.advance(orders(6), 50)
    moved = batch.states
    mask = np.array([True, False, False, True, False, False])
    batch.reset(START, boats=mask)
    np.testing.assert_allclose(batch.states[mask], [START, START], atol=1e-12)
    assert (batch.states[~mask] == moved[~mask]).all() and batch.t.tolist() == [0, 1, 1, 0, 1, 1]
    batch.set("weak_reverse.astern_factor", [0.5, 0.6], boats=[1, 4])
    assert batch.get("weak_reverse.astern_factor").tolist() == [
        0.694,
        0.5,
        0.694,
        0.694,
        0.6,
        0.694,
    ]
    batch.assign(0, boats=[1])
    assert batch._body[1, 0] == mass[0] and batch.get("weak_reverse.astern_factor")[1] == 0.694


def test_added_mass_that_is_set_acts():
    batch = Batch(BOAT, 2)
    batch.set("added_mass.surge", batch.get("added_mass.surge")[0] + 5.0, boats=[1])
    batch.advance({"pwm_port": 150.0, "pwm_starboard": 150.0}, 50)
    slow, quick = batch.states[1, 3], batch.states[0, 3]
    assert 0.2 * quick < slow < 0.8 * quick


def test_boats_in_waves_take_their_courses_from_their_seeds():
    waves = {"significant_height": 1.9, "modal_period": 8.8, "toward": 0.5}
    sea = vessel.load_vessel("kynoc", settings={"irregular_sea": waves})
    batch = Batch(sea, 4, 0.1, seeds=[3, 3, 4, 5])
    batch.advance(steps=200)
    x = batch.states
    assert (x[0] == x[1]).all() and (x[0] != x[2]).any() and (x[2] != x[3]).any()


@pytest.mark.parametrize(
    ("act", "said"),
    [
        (lambda b: b.set("fan_wnd.speed", 1.0), "fan_wind.speed"),
        (
            lambda b: b.set("fan_wind.speed", [1.0, 99.0]),
            "fan_wind.speed = 99; allowed 0 to 40 m/s",
        ),
        (lambda b: b.advance(np.zeros((2, 3))), "commands of shape (2, 3)"),
        (lambda b: b.advance(np.zeros((3, len(BOAT.commands)))), "commands of shape (3, "),
        (lambda b: b.advance(1.0), "commands of shape ()"),
        (
            lambda b: b.set("fan_wind.speed", [1.0, 2.0, 3.0]),
            "allowed are one, or one for each of 2 boats",
        ),
        (lambda b: b.assign(1), "vessel 1; allowed 0 to 0"),
        (lambda b: b.assign(-1), "vessel -1; allowed 0 to 0"),
        (lambda b: Batch(BOAT, 2, seeds=[1]), "1 seeds for 2 boats"),
        (lambda b: b.advance(np.full((2, 6), np.nan)), "nan"),
        (lambda b: b.advance({"pwm_prt": 1.0}), "pwm_port"),
        (lambda b: b.advance({"pwm_port": 1e9}), "pwm_port = 1e+09; allowed -255 to 255"),
        (lambda b: b.advance({"pwm_port": "fast"}), "pwm_port = 'fast'; allowed is a number"),
        (lambda b: b.advance(np.full((2, 6), -1e9)), "allowed"),
        (lambda b: b.advance(steps=-1), "steps = -1; allowed 0 to"),
        (lambda b: b.advance(steps=1.5), "steps = 1.5; allowed is a whole number"),
        (lambda b: b.advance(steps=float("inf")), "steps = inf; allowed is a whole number"),
        (lambda b: b.advance(steps=10**15), "allowed 0 to 1e+12"),
        (lambda b: b.reset([1.0, 2.0]), "states of shape (2,)"),
        (lambda b: b.reset(boats=[2]), "boat 2; allowed 0 to 1"),
        (lambda b: Batch([BOAT, vessel.load_vessel("otter")]), "otter"),
        (lambda b: Batch(BOAT, 0), "n = 0; allowed 1 to"),
    ],
)
def test_what_can_not_be_is_refused_in_one_line(act, said):
    with pytest.raises(BadInput) as refused:
        act(Batch(BOAT, 2))
    assert said in str(refused.value) and "\n" not in str(refused.value)


def test_many_steps_are_interrupted_after_the_same_steps_of_all_boats(monkeypatch):
    batch, calls = Batch(BOAT, 2), []

    def interrupted(*args, **kwargs):
        calls.append(kwargs["steps"])
        if len(calls) == 3:
            raise KeyboardInterrupt
        step_boats(*args, **kwargs)

    step_boats = batch._step_boats
    monkeypatch.setattr(batch, "_step_boats", interrupted)
    with pytest.raises(KeyboardInterrupt):
        batch.advance(steps=10**12)
    assert max(calls) * batch.n <= 1_000_000
    assert batch.t[0] == batch.t[1] == pytest.approx(2 * calls[0] * batch.step)


def test_steps_in_parts_move_a_boat_as_steps_at_once(monkeypatch):
    at_once, in_parts = Batch(BOAT, 3), Batch(BOAT, 3)
    at_once.advance(orders(3), 500)
    monkeypatch.setattr("boatsim.simulate.batch.UNINTERRUPTED", 100)
    in_parts.advance(orders(3), 500)
    assert (at_once.states == in_parts.states).all()


def test_a_boat_that_goes_wild_is_told_and_leaves_the_others_alone():
    batch, calm = Batch(BOAT, 3), Batch(BOAT, 3)
    batch.reset([0, 0, 0, 1e200, 0, 0], boats=[1])
    for b in (batch, calm):
        b.advance(orders(3), 20)
    assert batch.lost.tolist() == [False, True, False]
    assert (batch.states[[0, 2]] == calm.states[[0, 2]]).all()


def test_a_boat_takes_the_same_memory_however_many_there_are():
    assert Batch(BOAT, 10).bytes_per_boat == Batch(BOAT, 1000).bytes_per_boat < 2048
