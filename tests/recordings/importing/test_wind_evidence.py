"""The motion of a boat shows the frame, the sense and the unit of a wind, or that it does not."""

import numpy as np
import pytest

from boatsim.recordings.importing.log import Signal
from boatsim.recordings.importing.signal_classification import Classification
from boatsim.recordings.importing.track import track_of_positions
from boatsim.recordings.importing.wind_evidence import WindEvidence, wind_evidence

T = np.arange(0.0, 240.0, 0.5)
KN = 1852.0 / 3600.0


def shown(
    turn: float,
    factor: float = 1.0,
    frame: str = "",
    to_port: bool = False,
    true: bool = False,
    goes_to: bool = False,
) -> WindEvidence:
    """Evidence of a boat of 2 m/s that turns by up to `turn` [rad] in a gusty wind."""
    rng = np.random.default_rng(2)
    psi = turn * np.sin(0.05 * T)
    velocity = 2.0 * np.exp(1j * psi)
    place = 0.5 * np.cumsum(velocity)
    gusts = np.convolve(rng.standard_normal(len(T) + 19), np.ones(20) / 20, "valid")
    wind = -(5.0 + gusts) * np.exp(0.7j + 0.1j * np.roll(gusts, 100))
    air = wind if true else (wind - velocity) * np.exp(-1j * psi)
    angle = np.angle(air if goes_to else -air)
    if to_port:
        angle = -angle
    signals = []
    for name, values in (("speed", abs(air) / factor), ("angle", angle), ("psi", psi)):
        signals.append(Classification(name, Signal(T, values), name, "", 0.0))
    track = track_of_positions(T, place.real, place.imag)
    return wind_evidence(*signals[:2], track, signals[2], frame)


@pytest.mark.parametrize(("unit", "factor"), [("", 1.0), ("kn", KN), ("kmh", 1.0 / 3.6)])
@pytest.mark.parametrize("to_port", [False, True])
@pytest.mark.parametrize("frame", ["", "apparent"])
def test_a_boat_that_turns_shows_sense_and_unit_of_an_apparent_wind(
    unit: str, factor: float, to_port: bool, frame: str
) -> None:
    assert shown(2.5, factor, frame, to_port) == ("apparent", to_port, unit, False)


@pytest.mark.parametrize("to_port", [False, True])
@pytest.mark.parametrize("frame", ["", "apparent"])
def test_a_boat_that_turns_shows_an_angle_to_which_the_wind_goes(frame: str, to_port: bool) -> None:
    assert shown(2.5, KN, frame, to_port, goes_to=True) == ("apparent", to_port, "kn", True)


def test_a_wind_that_does_not_turn_with_the_boat_is_a_true_one_of_unknown_unit() -> None:
    assert shown(2.5, KN, true=True) == ("true", False, None, False)


@pytest.mark.parametrize("frame", ["", "apparent", "true"])
def test_a_boat_on_a_straight_course_shows_nothing(frame: str) -> None:
    assert shown(0.0, KN, frame) == (frame, False, None, False)
