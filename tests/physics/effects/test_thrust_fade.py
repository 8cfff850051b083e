"""Thrust that decreases with the time since the begin of a run."""

import numpy as np
import pytest

from boatsim.physics.base import make_motion
from boatsim.physics.effects.thrust_fade import ThrustFade
from boatsim.physics.effects.thruster import Thruster

MOUNT = {"x": -0.5, "y": 0.2, "z": 0.1, "gain": 1.2}


@pytest.mark.parametrize(("t", "left"), [(0.0, 1.0), (10.0, 0.9), (50.0, 0.5), (100.0, 0.25)])
@pytest.mark.parametrize(("thrust", "angle"), [(0.7, 0.0), (-0.4, 0.6)])
def test_the_thrust_that_is_left_acts_at_the_thruster(
    t: float, left: float, thrust: float, angle: float
) -> None:
    thruster, moment = Thruster(**MOUNT), make_motion(t=t, u=0.3)
    signals = Thruster.signals(thrust=thrust, angle=angle)
    full = thruster.wrench(moment, signals)
    change = ThrustFade(rate=0.01).wrench(moment, signals, thruster.values())
    assert np.add(full, change) == pytest.approx(left * np.array(full))


def test_the_thrust_decreases_smoothly_and_stays_positive() -> None:
    thruster, signals = Thruster(), Thruster.signals(thrust=1.0)
    t = np.linspace(0.0, 1e4, 100_001)
    fade = ThrustFade(rate=0.01)
    lost = [fade.wrench(make_motion(t=s), signals, thruster.values()).X for s in t.tolist()]
    left = 1.0 + np.array(lost)
    slope = np.diff(left) / np.diff(t)
    assert (left > 0.0).all() and (slope < 0.0).all()
    # of the hyperbola, twice the slope over the time at which half of the thrust is left
    assert np.diff(slope).max() < 1.01 * 2.0 * 0.01 / 50.0 * (t[1] - t[0])
