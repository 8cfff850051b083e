"""The passive observer filters motion in waves as its transfer function says."""

from math import cos, pi, sin

import numpy as np
import pytest

from boatsim.control.passive_observer import PassiveObserver, notch_response

MASS = np.diag([6e6, 8e6, 3.4e9])
DAMPING = np.diag([6e4, 1.6e5, 3.4e9])
WAVES, PERIOD = 0.8, 0.02  # [rad/s], [s]


@pytest.mark.parametrize("frequency", [0.1, 0.4, 0.8, 1.6])
def test_the_position_follows_the_transfer_function_of_a_notch_filter(frequency: float) -> None:
    observer = PassiveObserver(MASS, DAMPING, WAVES, PERIOD)
    gains = observer.design.gains.copy()
    gains[3:] = 0.0  # the velocity remains zero: the closed form is that of the filter alone
    observer.design = observer.design._replace(gains=gains)
    rows = []
    steps = round((60.0 + 4.0 * pi / frequency) / PERIOD)
    for k in range(steps):
        angle = frequency * PERIOD * (k + 0.5)  # the middle of the period in which it is held
        observer.step(np.array([sin(angle), cos(angle), 0.0]), np.zeros(3))
        if PERIOD * k >= 60.0:
            end = frequency * PERIOD * (k + 1)
            rows.append((sin(end), cos(end), observer.position[0]))
    first, second, found = np.array(rows).T
    (real, imaginary), *_ = np.linalg.lstsq(np.array([first, second]).T, found, rcond=None)
    wanted = complex(notch_response(np.array([frequency]), WAVES)[0])
    assert complex(real, imaginary) == pytest.approx(wanted, abs=2e-3)


def test_the_notch_passes_a_tenth_at_the_wave_frequency_and_all_of_a_constant() -> None:
    at_waves, constant = np.abs(notch_response(np.array([WAVES, 1e-6]), WAVES))
    assert at_waves == pytest.approx(0.1 * 1.1 / np.hypot(1.0, 1.1))
    assert constant == pytest.approx(1.0)


def test_a_constant_force_is_found_as_bias_at_any_heading() -> None:
    observer = PassiveObserver(MASS, DAMPING, WAVES, 0.5)
    observer.reset(np.array([3.0, -2.0, 1.0]))
    # the vessel lies still: thrust in body axes balances a force to the north
    c, s = cos(1.0), sin(1.0)
    for _ in range(1200):
        observer.step(np.array([3.0, -2.0, 1.0]), -1e5 * np.array([c, -s, 0.0]))
    assert observer.position == pytest.approx([3.0, -2.0, 1.0], abs=0.02)
    assert observer.bias[0] == pytest.approx(1e5, rel=0.02)
    assert observer.bias[1] == pytest.approx(0.0, abs=2e3)


def test_a_heading_that_passes_a_full_turn_does_not_jump() -> None:
    observer = PassiveObserver(MASS, DAMPING, WAVES, 0.5)
    for k in range(400):
        heading = 0.02 * 0.5 * k
        wrapped = (heading + pi) % (2.0 * pi) - pi
        observer.step(np.array([0.0, 0.0, wrapped]), np.zeros(3))
        assert abs(observer.position[2] - heading) < 0.5


def test_without_measurement_the_observer_moves_as_its_model_does() -> None:
    observer = PassiveObserver(MASS, DAMPING, WAVES, PERIOD, filters=False)
    observer.reset(np.zeros(3))
    force, outage = np.array([2e5, 0.0, 0.0]), np.full(3, np.nan)
    for _ in range(1000):
        observer.step(outage, force)
    mass, drag, t = MASS[0, 0], DAMPING[0, 0], 1000 * PERIOD
    speed = force[0] / drag * (1.0 - np.exp(-drag * t / mass))
    place = force[0] / drag * t - mass / drag * speed
    assert observer.velocity[0] == pytest.approx(speed, rel=1e-6)
    assert observer.position == pytest.approx([place, 0.0, 0.0], rel=1e-6)
