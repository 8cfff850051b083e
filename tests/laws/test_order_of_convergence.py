"""Under changing commands the integration keeps its fourth order, whatever lags and rates the
actuators have."""

from functools import cache

import numpy as np
import pytest
from alike import few

from boatsim.physics import content, vessel
from boatsim.physics.base import Array
from boatsim.simulate.batch import Batch

STEPS = (0.04, 0.02, 0.01, 0.005)  # [s]
FINE = 0.00125  # [s] taken for the truth
HELD = 0.4  # [s] that each command is held: a multiple of every step
ROWS = 50  # 20 s of commands drawn by lot
# A law that bends (a power curve in branches, a wake that depends on the side the water comes from)
# has no fourth order
# across its bend; these vessels are held to the error alone, the jet-ski on one branch of its power
# curve.
SIDED = "the wake and the flow at the rudder differ by the side the water comes from"
BENDS = {"kvlcc2_mmg": SIDED, "kvlcc2_mmg_full_scale": SIDED}
START = {"jet_ski": 15.0}  # [m/s] planing; others as their [manoeuvring] table says, or from rest
# The pendulum is driven within its weight's moment: beyond it, it spins ever faster
RANGE = {"throttle": (4.2, 7.0), "torque_Nm": (-1.0, 1.0)}


@cache
def paths(name: str) -> dict[float, Array]:
    """States by step, over the same commands."""
    boat = vessel.load_vessel(name)
    compiled, rng, n = Batch(boat), np.random.default_rng(0), len(boat.dof)
    limits = [RANGE.get(c, limits) for c, limits in boat.limits().items()]
    rows = (
        np.column_stack([rng.uniform(*limit, ROWS) for limit in limits])
        if limits
        else np.zeros((ROWS, 0))
    )
    start = np.zeros(2 * n)
    if "surge" in boat.dof:
        start[n] = START.get(name, boat.manoeuvring.speed or 0.0)
    else:
        start[0] = 0.1  # [rad] of heel, released
    found = {}
    for step in (*STEPS, FINE):
        compiled.step = step
        found[step] = compiled.rollout(start, rows, HELD)
    return found


def errors(name: str) -> Array:
    """Largest error of any coordinate [m, rad], by step."""
    found, n = paths(name), len(vessel.load_vessel(name).dof)
    return np.array([np.abs(found[step] - found[FINE])[:, :n].max() for step in STEPS])


@pytest.mark.parametrize("name", few(content.shipped_content_names("vessel"), 3, 5))
def test_twenty_milliseconds_are_exact_to_a_hundredth_of_a_millimetre(name: str) -> None:
    assert errors(name)[STEPS.index(0.02)] < 1e-5


SMOOTH = [name for name in content.shipped_content_names("vessel") if name not in BENDS]


@pytest.mark.parametrize("name", few(SMOOTH, 3, 5))
def test_halving_the_step_divides_the_error_by_sixteen(name: str) -> None:
    found = errors(name)
    size = max(1.0, float(np.abs(paths(name)[FINE]).max()))
    worth = found > 1e-12 * size * ROWS  # below that it is rounding
    order = np.log2(found[:-1] / found[1:])[worth[:-1] & worth[1:]]
    assert found[-1] < 1e-6 * size
    assert not len(order) or (order.mean() > 3.5 and order.min() > 2.5), (found, order)
