from itertools import pairwise
from math import asin, atan2, cos, degrees, hypot, pi, radians, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from boatsim.control.allocation import (
    ANGLE_MAX,
    HEADING,
    HOLD_SHARE,
    PWM_MAX,
    TURN_SHARE,
    Drive,
    Outboards,
    Push,
    Stick,
    integrate_heading,
)
from boatsim.errors import BadInput

OURS = Outboards()
GRID = [-0.12 + 0.01 * i for i in range(25)]


def force_of_each_motor(drive: Drive, half_spacing: float, arm: float) -> Push:
    """Section 1 of the thesis review: N = sum of x Y - y X over both motors, port at (-arm, -half_spacing)."""
    X = Y = N = 0.0
    motors = [
        (-half_spacing, drive.port, drive.angle),
        (half_spacing, drive.starboard, -drive.angle),
    ]
    for y, thrust, angle in motors:
        X, Y = X + thrust * cos(angle), Y + thrust * sin(angle)
        N += -arm * thrust * sin(angle) - y * thrust * cos(angle)
    return Push(X, Y, N)


@pytest.mark.parametrize("angle", [0.0, 0.3, ANGLE_MAX])
def test_push_is_the_sum_over_both_motors(angle: float) -> None:
    drive = Drive(0.4, -0.3, angle)
    assert OURS.nominal_wrench(drive) == pytest.approx(
        force_of_each_motor(drive, OURS.half_spacing, OURS.arm), abs=1e-14
    )


@pytest.mark.parametrize(
    ("half_spacing", "arm", "published"),
    [(0.19, 0.6, 17.57), (0.28, 0.6, 25.02), (0.19, 0.64, 16.53), (0.28, 0.64, 23.63)],
)
def test_neutral_angles_of_the_four_boats(
    half_spacing: float, arm: float, published: float
) -> None:
    boat = Outboards(half_spacing=half_spacing, arm=arm)
    assert degrees(boat.neutral_angle()) == pytest.approx(published, abs=0.01)
    assert boat.arm_per_thrust_difference(boat.neutral_angle()) == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("difference", [-0.6, -0.3, 0.0, 0.3, 0.6])
def test_what_is_asked_inside_the_limits_is_what_is_given(difference: float) -> None:
    side = 1.0 if difference >= 0.0 else -1.0
    reach = [m for m in GRID if not difference or -0.27 < m * side / abs(difference) < 0.235]
    assert len(reach) > 10
    for moment in reach:
        spread = difference or moment / OURS.half_spacing
        for surge in (-0.3 * abs(spread), 0.0, 0.3 * abs(spread)):
            drive = OURS.allocate(surge, difference, moment)
            push = OURS.nominal_wrench(drive)
            assert (push.X, push.N) == pytest.approx((surge, moment), abs=1e-12)
            assert drive.port - drive.starboard == pytest.approx(spread, abs=1e-12)


def test_sway_alone_is_the_fixed_difference_of_the_published_allocation() -> None:
    for moment, surge in [(0.0, 0.0), (0.05, 0.1), (-0.1, -0.1)]:
        drive = OURS.allocate(surge, 0.6, moment)
        d = atan2(0.235, 0.62) - asin(moment / (0.6 * hypot(0.235, 0.62)))
        assert drive.angle == pytest.approx(d)
        along = surge / cos(d)
        assert (drive.port, drive.starboard) == pytest.approx((0.3 + along / 2, -(0.3 - along / 2)))


@pytest.mark.parametrize("moment", [0.1, -0.1])
def test_yaw_alone_keeps_the_motors_straight_and_swaps_the_reversing_one(moment: float) -> None:
    drive = OURS.allocate(0.0, 0.0, moment)
    half = moment / 0.235 / 2
    assert drive == pytest.approx((half, -half, 0.0))


@pytest.mark.parametrize(("difference", "share"), [(0.6, HOLD_SHARE), (0.0, TURN_SHARE)])
def test_surge_correction_takes_its_share_only(difference: float, share: float) -> None:
    moment = 0.0 if difference else 0.06
    drive = OURS.allocate(5.0, difference, moment)
    assert drive.port + drive.starboard == pytest.approx(share * (drive.port - drive.starboard))
    assert OURS.nominal_wrench(drive).N == pytest.approx(moment, abs=1e-12)
    roomy = OURS.allocate(5.0, difference, moment, room=0.2)
    assert roomy.port + roomy.starboard == pytest.approx(drive.port + drive.starboard + 0.2)


def test_sway_thrust_grows_where_the_moment_needs_it() -> None:
    for moment in (0.15, -0.15):
        drive = OURS.allocate(0.0, 0.2, moment)
        assert drive.port - drive.starboard > 0.2
        assert OURS.nominal_wrench(drive).N == pytest.approx(moment)


def test_a_turn_at_the_limits_keeps_a_reserve_for_surge() -> None:
    weak = Outboards(
        rated_thrust=0.35
    )  # astern gives 0.4 N at most, less than half of the largest difference
    hard = weak.nominal_wrench(weak.allocate(0.0, 0.0, 1.0))
    assert hard.X == pytest.approx(0.0, abs=1e-12)
    back = weak.nominal_wrench(weak.allocate(-1.0, 0.0, 1.0))
    assert back.X < -0.1
    assert 0.6 * hard.N < back.N < hard.N


def largest_moment_of_the_motors(surge: float, low: float, high: float) -> tuple[float, float]:
    """Brute force over the limits of both motors and servos: least and largest yaw moment [N m].

    Each port thrust in steps of a quarter PWM and each angle from `low` to `high` in steps of a
    quarter degree is combined with the starboard thrust that leaves the surge force `surge`; the
    port motor pushes ahead of the starboard one.
    """
    ahead, astern = OURS.thrust_at_pwm(PWM_MAX), -OURS.thrust_at_pwm(-PWM_MAX)
    port = np.array([OURS.thrust_at_pwm(0.25 * i) for i in range(-1020, 1021)])
    moments = []
    for angle in np.radians(np.arange(degrees(low), degrees(high) + 0.01, 0.25)):
        starboard = surge / cos(angle) - port
        possible = (starboard >= -astern) & (starboard <= ahead) & (port >= starboard)
        spread = port[possible] - starboard[possible]
        moments.append(spread * OURS.arm_per_thrust_difference(angle))
    every = np.concatenate(moments)
    return float(every.min()), float(every.max())


@pytest.mark.parametrize("surge", [-0.25, -0.1, 0.0, 0.1, 0.25])
def test_a_turn_on_the_spot_may_use_all_that_the_motors_give(surge: float) -> None:
    """The nominal motors give 0.268 N m without surge force: twice the thrust astern."""
    _, largest = largest_moment_of_the_motors(surge, 0.0, 0.0)
    if surge == 0.0:
        assert largest == pytest.approx(2 * 0.5695 * 0.235, rel=2e-3)
    for turn in (1.0, -1.0):
        push = OURS.nominal_wrench(OURS.allocate(surge, 0.0, 5.0 * turn, room=0.3))
        assert push.N == pytest.approx(turn * largest, rel=2e-3)
        assert (push.X, push.Y) == pytest.approx((surge, 0.0), abs=1e-12)


@pytest.mark.parametrize("surge", [-0.15, 0.0, 0.15])
@pytest.mark.parametrize("difference", [0.05, 0.6, -0.6])
def test_a_turn_during_sway_may_use_all_that_the_motors_give(
    surge: float, difference: float
) -> None:
    least, largest = largest_moment_of_the_motors(surge, 0.0, ANGLE_MAX)
    side = 1.0 if difference > 0.0 else -1.0
    for asked, possible in ((5.0, largest), (-5.0, least)):
        push = OURS.nominal_wrench(OURS.allocate(surge, difference, side * asked, room=0.3))
        assert push.N == pytest.approx(side * possible, rel=2e-3)
        assert push.X == pytest.approx(surge, abs=1e-12)


def test_every_moment_that_the_motors_can_give_during_sway_is_given() -> None:
    weak = Outboards(rated_thrust=0.35)  # the motors limit the sway thrust, not its own limit
    lever = hypot(weak.half_spacing, weak.arm)
    spread = -2.0 * weak.thrust_at_pwm(-PWM_MAX)
    for moment in (-0.2, -0.1, 0.05, 0.15, 0.185):
        drive = weak.allocate(0.0, 0.9, moment)
        assert drive.port - drive.starboard == pytest.approx(spread)
        assert drive.angle == pytest.approx(
            weak.neutral_angle() - asin(moment / (spread * lever)), abs=1e-12
        )
        assert weak.nominal_wrench(drive).N == pytest.approx(moment, abs=1e-12)


DEMANDS = {
    "surge": st.floats(-3, 3),
    "difference": st.floats(-1, 1),
    "moment": st.floats(-2, 2),
    "room": st.floats(0, 2),
}


@given(**DEMANDS)
def test_mirrored_demand_gives_the_mirrored_drive(
    surge: float, difference: float, moment: float, room: float
) -> None:
    port, starboard, angle = OURS.allocate(surge, difference, moment, room)
    assert OURS.allocate(surge, -difference, -moment, room) == pytest.approx(
        (starboard, port, angle), abs=1e-12
    )


@given(**DEMANDS)
def test_no_demand_exceeds_the_motors_or_the_servos(
    surge: float, difference: float, moment: float, room: float
) -> None:
    drive = OURS.allocate(surge, difference, moment, room)
    ahead, astern = 0.5 * 255 / 150, 0.67 * 0.5 * 255 / 150
    for thrust in drive[:2]:
        assert -astern - 1e-12 <= thrust <= ahead + 1e-12
    setting = OURS.commands_for_thrusts(drive)
    assert max(abs(setting.pwm_port), abs(setting.pwm_starboard)) <= PWM_MAX
    assert 0 <= setting.degrees <= 45


def test_drive_is_continuous_while_the_sway_keeps_its_side() -> None:
    step = 0.002  # [N m], [N]; the steepest slope is 1 / half_spacing = 4.3 N per N m
    for surge in (-0.3, 0.0, 0.2):
        for difference in (0.06, 0.3, 0.6):
            line = [OURS.allocate(surge, difference, -0.4 + step * i, 0.1) for i in range(401)]
            for a, b in pairwise(line):
                assert (
                    max(
                        abs(p - q)
                        for p, q in zip(OURS.nominal_wrench(a), OURS.nominal_wrench(b), strict=True)
                    )
                    < 5 * step
                )
                assert max(abs(a.port - b.port), abs(a.starboard - b.starboard)) < 5 * step
        for moment in (-0.2, -0.05, 0.0, 0.1):
            line = [OURS.allocate(surge, 0.06 + step * i, moment, 0.1) for i in range(420)]
            for a, b in pairwise(line):
                assert max(abs(a.port - b.port), abs(a.starboard - b.starboard)) < 2 * step
                assert abs(a.angle - b.angle) < 10 * step


def test_letting_go_of_sway_is_smooth_in_a_helping_turn_and_reverses_the_motors_in_the_other() -> (
    None
):
    turn, still_swaying = OURS.allocate(0.0, 0.0, 0.1), OURS.allocate(0.0, 1e-9, 0.1)
    assert still_swaying == pytest.approx(turn, abs=1e-6)
    turn, still_swaying = OURS.allocate(0.0, 0.0, -0.1), OURS.allocate(0.0, 1e-9, -0.1)
    assert still_swaying.port > 0.0 > turn.port
    assert OURS.nominal_wrench(still_swaying).N == pytest.approx(OURS.nominal_wrench(turn).N)


@given(st.integers(-PWM_MAX, PWM_MAX), st.floats(0.0, 60.0), st.floats(0.6, 2.0))
def test_pwm_and_thrust_are_inverse_above_the_dead_band(
    pwm: int, dead: float, power: float
) -> None:
    motor = Outboards(dead_pwm=dead, thrust_power=power)
    assert motor.pwm_for_thrust(motor.thrust_at_pwm(pwm)) == (
        pwm if abs(pwm) > dead + 1 else pytest.approx(0, abs=dead + 1)
    )


def test_a_motor_gives_less_astern() -> None:
    assert (OURS.thrust_at_pwm(150), OURS.thrust_at_pwm(-150)) == pytest.approx((0.5, -0.335))
    assert (
        OURS.pwm_for_thrust(0.25),
        OURS.pwm_for_thrust(-0.25),
        OURS.pwm_for_thrust(9.0),
        OURS.pwm_for_thrust(-9.0),
    ) == (75, -112, 255, -255)


def test_applied_push_is_that_of_the_rounded_setting() -> None:
    drive = Drive(0.3, -0.3, radians(20.4))
    setting = OURS.commands_for_thrusts(drive)
    assert setting == (90, -134, 20)
    rounded = Drive(90 / 150 * 0.5, -134 / 150 * 0.335, radians(20))
    assert OURS.wrench_for_commands(setting) == pytest.approx(OURS.nominal_wrench(rounded))
    assert OURS.wrench_for_commands(
        OURS.commands_for_thrusts(Drive(5.0, 5.0, 0.0))
    ).X == pytest.approx(2 * 0.85)


def test_commands_are_mirror_angles_by_name() -> None:
    assert OURS.commands_for_thrusts(Drive(0.5, -0.335, radians(30))).commands() == pytest.approx(
        {
            "pwm_port": 150,
            "pwm_starboard": -150,
            "steer_port_rad": pi / 6,
            "steer_starboard_rad": -pi / 6,
        }
    )


def test_sway_thrust_follows_the_stick_beyond_its_dead_zone() -> None:
    asked = [OURS.thrust_difference_for_sway(v) for v in (0.0, 0.0069, 0.035, -0.07, 1.0)]
    assert asked == pytest.approx([0.0, 0.0, 0.3, -0.6, 0.9])


def test_stick_reads_what_is_given() -> None:
    assert Stick.from_goal({"yaw_radps": 0.1, "elsewhere": 3.0}) == (0.0, 0.0, 0.1)


def test_compass_takes_out_the_drift_of_the_gyro_across_the_wrap() -> None:
    drifting, held = np.zeros(2, HEADING).view(np.recarray)
    for i in range(6000):  # two turns in 600 s with a gyro that reads 1 mrad/s too much
        true = 4 * pi * (i + 1) / 6000
        wrapped = (true + pi) % (2 * pi) - pi
        for heading, trust in ((drifting, 0.0), (held, 0.05)):
            integrate_heading(heading, 4 * pi / 600 + 0.001, wrapped, 0.0, 0.1, trust)
    assert drifting.own - true == pytest.approx(0.6)
    assert held.own - true == pytest.approx(0.001 / 0.05, rel=0.01)
    assert held.wanted == 0.0


def test_geometry_outside_its_bounds_is_refused() -> None:
    with pytest.raises(BadInput, match="half_spacing"):
        Outboards(half_spacing=0.0)


def test_lever_runs_from_spacing_to_arm() -> None:
    assert OURS.arm_per_thrust_difference(0.0) == 0.235
    assert OURS.arm_per_thrust_difference(ANGLE_MAX) == pytest.approx(
        (0.235 - 0.62) * sin(ANGLE_MAX)
    )
