"""Motors tried by pulses, on a boat of a few lines that turns, moves ahead and drifts; no law of
the library's."""

from dataclasses import dataclass
from math import cos, exp, pi, sin

import numpy as np
import pytest

from boatsim.control.motor_check import NEITHER, PORT, STARBOARD, Drift, MotorCheck, Pulse

PERIOD, LAG, ANGLE = 0.08, 0.15, pi / 4
SPACING, ARM = 0.2, 0.6  # [m]


@dataclass
class Boat:
    """Two outboards with a lag, weak astern, both steerings off by an angle; Euler steps of a tenth
    of a period."""

    reverse: float = 0.6  # thrust astern over ahead at the same setting
    power: float = 1.0
    off: float = 0.0  # [rad]
    wind: float = 0.0  # [N m]
    thrust: float = 0.3  # [N] of a setting of 1
    mass: float = 5.0
    inertia: float = 1.8
    u: float = 0.0
    r: float = 0.0
    motor: float = 0.0  # setting, behind its command

    def force(self) -> float:
        ahead = self.thrust * abs(self.motor) ** self.power
        return ahead if self.motor > 0.0 else -self.reverse * ahead

    def play(self, setting: float, inward: int) -> None:
        port = (ANGLE if inward == PORT else 0.0) + self.off
        starboard = (-ANGLE if inward == STARBOARD else 0.0) + self.off
        for _ in range(10):
            self.motor += (1.0 - exp(-0.1 * PERIOD / LAG)) * (setting - self.motor)
            f = self.force()
            moment = sum(
                -ARM * f * sin(a) - y * f * cos(a)
                for a, y in ((port, -SPACING), (starboard, SPACING))
            )
            self.u += 0.1 * PERIOD * f * (cos(port) + cos(starboard)) / self.mass
            self.r += 0.1 * PERIOD * (moment + self.wind) / self.inertia


def new_check(**changed: float) -> MotorCheck:
    settings = dict(
        period=PERIOD,
        rest=0.8,
        reach=0.05,
        shortest=0.32,
        longest=0.64,
        lag=LAG,
        drift=Drift(0.0, 0.0),
        power=1.25,
        enough=1e-9,
        most=4,
        straight=2.0 / (1.0 + cos(ANGLE)),
    )
    return MotorCheck(**{**settings, **changed})  # type: ignore[arg-type]


def tried(boat: Boat, check: MotorCheck, noise: float = 0.0) -> list[Pulse]:
    """Play the whole check; astern settings are believed to need 1.5 times those ahead."""
    rng, played = np.random.default_rng(1), []
    for _ in range(2000):
        felt = boat.force() * (1.0 + cos(ANGLE)) / boat.mass
        pulse = check.step(
            boat.r + noise * rng.standard_normal(), felt + 10 * noise * rng.standard_normal()
        )
        if check.done:
            return played
        played.append(pulse)
        boat.play({1: 1.0, -1: -1.5 * check.astern, 0: 0.0}[pulse.sense], pulse.inward)
    raise AssertionError("never done")


@pytest.mark.parametrize("reverse", [0.45, 0.6667, 0.85])
@pytest.mark.parametrize(("power", "within"), [(1.0, 0.006), (1.6, 0.015)])
def test_thrust_astern_is_as_thrust_ahead_afterwards(
    reverse: float, power: float, within: float
) -> None:
    boat, check = Boat(reverse=reverse, power=power), new_check()
    tried(boat, check)
    assert reverse * (1.5 * check.astern) ** power == pytest.approx(1.0, abs=within)


@pytest.mark.parametrize(
    "changed", [{"inertia": 0.9}, {"mass": 10.0}, {"thrust": 0.15}, {"wind": 0.002}]
)
def test_what_it_finds_does_not_depend_on_hull_or_a_lasting_moment(
    changed: dict[str, float],
) -> None:
    usual, other = new_check(), new_check()
    tried(Boat(), usual)
    tried(Boat(**changed), other)
    assert other.astern == pytest.approx(usual.astern, rel=0.004)


@pytest.mark.parametrize("off", [-0.05, 0.0, 0.03])
def test_steerings_that_are_both_off_turn_the_boat_unevenly(off: float) -> None:
    boat, check = Boat(off=off), new_check()
    tried(boat, check)
    lever = SPACING * cos(ANGLE) - ARM * sin(ANGLE) - SPACING
    reach = SPACING * sin(ANGLE) + ARM * cos(ANGLE) + ARM
    assert check.yaw_asymmetry * -lever / reach == pytest.approx(off, abs=0.002)


def test_the_boat_is_left_as_it_says() -> None:
    boat, check = Boat(reverse=0.5), new_check()
    tried(boat, check)
    assert check.ahead_acceleration == pytest.approx(0.3 * (1.0 + cos(ANGLE)) / 5.0, rel=0.02)
    assert boat.u == pytest.approx(check.speed, abs=0.003)
    assert (
        abs(check.speed) < 0.5 * PERIOD * 2.0 * boat.thrust / boat.mass + 1e-9
    )  # half a period of both motors


def test_noise_costs_as_much_as_it_says() -> None:
    """The noise of a small boat's gyro; pairs go on until the reverse is known to 1 %."""
    boat, check = Boat(reverse=0.6), new_check(enough=0.01, most=50)
    played = tried(boat, check, noise=0.00175)
    assert 0.6 * 1.5 * check.astern == pytest.approx(1.0, abs=0.03)
    assert len(played) < 2000


def test_a_pair_turns_in_one_motor_and_then_the_other_and_amends_straight() -> None:
    played = tried(Boat(reverse=0.45), new_check(most=2))
    sides = [p.inward for p in played]
    assert sides[0] == PORT
    assert {a: b for a, b in zip(sides, sides[1:], strict=False) if a != b}.keys() == {
        PORT,
        STARBOARD,
        NEITHER,
    }
