"""Causes outside the library: finite on every vessel, not a candidate effect, right memory."""

import numpy as np
import pytest

from boatsim.physics.content import shipped_content_names
from validation.calibration.unknown_causes import FURTHER, UNKNOWN, LaggedSignal
from validation.calibration.vessels import BOATS, PLANS
from validation.practice.cause import Maker
from validation.practice.make import Trial, simulate_trial
from validation.practice.motion import RUNS, Boat, Motion

CASES = [(vessel, maker) for vessel in sorted(UNKNOWN) for maker in UNKNOWN[vessel]]


def random_motion(boat: Boat, t: float) -> Motion:
    """A random motion of all runs at one time."""
    rng = np.random.default_rng(5)
    free = np.isin(np.arange(6), boat.free)[:, None]
    size = np.array([1.0, 0.3, 0.1, 0.2, 0.1, 0.3])[:, None] * boat.scale
    q = rng.standard_normal((6, RUNS)) * size * free
    nu = rng.standard_normal((6, RUNS)) * size * free
    nu[0] += boat.cruise
    act = rng.standard_normal((len(boat.drive.lag), RUNS))
    return Motion(np.full(RUNS, t), np.arange(RUNS), q, nu, nu, act)


@pytest.mark.parametrize(("vessel", "maker"), CASES)
def test_a_cause_is_finite_acts_and_is_no_candidate(vessel: str, maker: Maker) -> None:
    boat = BOATS[vessel]()
    cause = maker(boat, np.random.default_rng(2), 0.5)
    prefix, _, name = cause.name.partition(":")
    assert prefix == "outside_library"
    assert name not in shipped_content_names("effect")
    assert bool(cause.force) + bool(cause.drive) + bool(cause.show) == 1
    motion = random_motion(boat, 3.0)
    if cause.force:
        first = cause.force(boat, motion)
        later = cause.force(boat, motion._replace(t=motion.t + 0.1, nu=-motion.nu, q=-motion.q))
        assert first.shape == later.shape == (6, RUNS)
        assert np.isfinite(first).all()
        assert np.isfinite(later).all()
        held = [axis for axis in range(6) if axis not in boat.free]
        if not boat.tilts and vessel != "martin_tank_model":
            assert not first[held].any()
    if cause.show:
        shown = cause.show(motion.q)
        assert shown.shape == motion.q.shape
        assert np.isfinite(shown).all()
    if cause.drive:
        change = cause.drive(boat, 0.05)
        for k in range(4):
            goal = change(motion.act * (k + 1), k)
            assert goal.shape == motion.act.shape
            assert np.isfinite(goal).all()


def test_every_vessel_has_further_causes_and_at_least_seven_exist() -> None:
    assert set(FURTHER) == set(UNKNOWN) == set(PLANS) == set(BOATS)
    further = {maker for makers in FURTHER.values() for maker in makers}
    assert len(further) >= 7
    assert not any(maker in PLANS[vessel].strange for vessel in PLANS for maker in further)


def test_a_lag_evaluated_step_by_step_is_that_of_the_whole_course() -> None:
    count, dt = 200, 0.05
    t = np.arange(count) * dt
    rate = np.sin(t)[:, None] * np.array([1.0, 2.0, -1.0])
    nu = np.zeros((6, count * RUNS))
    nu[5] = rate.ravel()
    none = np.zeros((0, count * RUNS))
    course = Motion(np.repeat(t, RUNS), np.tile(np.arange(RUNS), count), nu, nu, nu, none)
    lag = LaggedSignal(1.5, lambda m: m.nu[5])
    whole = lag(course).reshape(count, RUNS)
    for _ in range(2):  # a second simulation starts from a settled state again
        for k in range(count):
            now = np.zeros((6, RUNS))
            now[5] = rate[k]
            time = np.full(RUNS, t[k])
            found = lag(Motion(time, np.arange(RUNS), now, now, now, none[:, :RUNS]))
            assert found == pytest.approx(whole[k], abs=1e-12)


@pytest.mark.parametrize("index", range(len(FURTHER["martin_tank_model"])))
def test_a_stronger_cause_gives_more_evidence(index: int) -> None:
    name = "martin_tank_model"
    maker = FURTHER[name][index]
    gains = []
    for strength in (0.1, 0.5):
        trial = Trial(
            "T001_" + name,
            name,
            "unknown",
            False,
            False,
            (maker,),
            PLANS[name],
            BOATS[name],
        )
        oracle = simulate_trial(trial, (3, 1), np.array([strength]))
        gains.append(oracle.beyond_library(oracle.causes[0]))
    assert 0.0 < gains[0] < gains[1]
