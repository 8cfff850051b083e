import random
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from math import cos, degrees, exp, nan, pi, radians, sin
from typing import Any

import pytest

from boatsim.control.adaptive import Predictor
from boatsim.control.base import Sense
from boatsim.control.margins import stability_margins
from boatsim.errors import BadInput
from boatsim.physics.content import load_class

STILL = Sense(t=0.0, psi=0.0, r=0.0, ax=0.0, ay=0.0, u=nan, v=nan, x=nan, y=nan)
AsPublished = load_class("controller", "l1_joystick_as_published")
L1Joystick = load_class("controller", "l1_joystick")
L1JoystickProjection = load_class("controller", "l1_joystick_projection")
PidAutopilot = load_class("controller", "pid_autopilot")
OpenLoop = load_class("controller", "open_loop")
RIVALS = pytest.mark.parametrize(
    "controller", [L1Joystick, L1JoystickProjection, PidAutopilot], ids=lambda c: c.__name__
)
BOATS = {
    "S1": (0.19, 0.60),
    "S2": (0.28, 0.60),
    "S3": (0.19, 0.64),
    "S4": (0.28, 0.64),
}  # spacing, arm [m]


@dataclass
class Turntable:
    """A boat that can only turn: two outboards, inertia and damping, no lags; Euler steps of 10
    ms."""

    half_spacing: float = 0.235
    arm: float = 0.62
    inertia: float = 2.0
    damping: float = 0.1  # [N m s]
    thrust: float = 0.5  # [N] at PWM 150
    reverse: float = 0.67
    push: float = 0.0  # [N m] from outside
    psi: float = 0.0
    r: float = 0.0

    def moment(self, commands: Mapping[str, float]) -> float:
        total = self.push
        for name, y in (("port", -self.half_spacing), ("starboard", self.half_spacing)):
            pwm, angle = commands[f"pwm_{name}"], commands[f"steer_{name}_rad"]
            force = self.thrust * pwm / 150.0 * (1.0 if pwm > 0 else self.reverse)
            total += -self.arm * force * sin(angle) - y * force * cos(angle)
        return total

    def run(
        self,
        controller: Any,
        goal: Mapping[str, float],
        seconds: float,
        noise: random.Random | None = None,
        seen: list[float] | None = None,
    ) -> None:
        """From rest to the end; `seen` collects the yaw rate at each control step."""
        controller.reset()
        for i in range(round(seconds / 0.08)):
            psi, ax, ay = (noise.gauss(0.0, sd) if noise else 0.0 for sd in (0.0024, 0.02, 0.02))
            sense = replace(STILL, t=0.08 * i, psi=self.psi + psi, r=self.r, ax=ax, ay=ay)
            if seen is not None:
                seen.append(self.r)
            moment = self.moment(controller.step(sense, goal))
            for _ in range(8):
                self.r += 0.01 * (moment - self.damping * self.r) / self.inertia
                self.psi += 0.01 * self.r


def readings(seed: int = 1, number: int = 120) -> list[Sense]:
    """A boat that sways with a wandering heading: noise of the sensor, the bow passes north to
    port."""
    noise = random.Random(seed)
    return [
        replace(
            STILL,
            t=0.08 * i,
            psi=-0.4 * i / number + noise.gauss(0.0, 0.0024),
            r=-0.4 / number / 0.08,
            ax=noise.gauss(0.0, 0.02),
            ay=noise.gauss(0.02, 0.02),
        )
        for i in range(number)
    ]


def played(
    controller: Any, senses: list[Sense], goal: Mapping[str, float] | None = None
) -> list[dict[str, float]]:
    controller.reset()
    return [controller.step(sense, goal or {}) for sense in senses]


def inward(commands: Mapping[str, float]) -> float:
    return degrees(commands["steer_port_rad"])


# The thesis' program
# ----------------------------------------------------------------------------------------------


def test_surge_loop_as_published_has_no_authority() -> None:
    """U_1 stays at a few thousandths, so the port motor knows two values only (item 17)."""
    largest = {}
    for broken in (True, False):
        controller, seen = AsPublished(surge_history=broken), []
        for sense in readings(number=400):
            commands = controller.step(sense, {})
            assert commands["pwm_port"] in (104.0, 105.0) and commands["pwm_starboard"] == -150.0
            seen.append(abs(controller._u[0][0]))
        largest[broken] = max(seen)
    assert largest[True] < 4e-3 < 1e-2 < largest[False]


def test_estimates_as_published_are_relays_between_their_bounds() -> None:
    controller = AsPublished()
    on_bound = total = 0
    for sense in readings(number=400):
        controller.step(sense, {})
        bounded = [e for e in controller.estimates().values() if e.low == e.low]
        assert all(e.low <= e.value <= e.high for e in bounded)
        on_bound += sum(
            e.value in (e.low, e.high) for e in bounded[1:]
        )  # theta_1 moves by error times surge, slowly
        total += len(bounded) - 1
    assert on_bound > 0.8 * total


def test_first_estimates_as_published_lie_outside_their_bounds() -> None:
    found = AsPublished().estimates()
    outside = {
        name for name, e in found.items() if not (e.low <= e.value <= e.high) and e.low == e.low
    }
    assert outside == {"theta_1", "omega_1", "sigma_1", "sigma_2", "sigma_3"}
    mended = AsPublished(start_values=False).estimates()
    assert all(e.low <= e.value <= e.high for e in mended.values() if e.low == e.low)


def steering_output(controller: Any) -> float:
    """U_3, which is not a command of its own; before the servo's integer it is 390.45 U_3 - 5.49 deg."""
    return float(controller._u[2][0])


def test_unseeded_heading_kicks_the_steering() -> None:
    """About 0.3 theta h0 two samples after the start (item 24); none when seeded."""
    outputs, thetas = {}, {}
    for h0, seeded in ((0.0, False), (0.1, False), (0.1, True)):
        controller = AsPublished(h0=h0, seeded=seeded)
        played(controller, [STILL] * 3)
        outputs[h0, seeded] = steering_output(controller)
        thetas[h0, seeded] = controller.estimates()["theta_23"].value
    kick = outputs[0.1, False] - outputs[0.0, False]
    assert kick == pytest.approx(0.3 * thetas[0.1, False] * 0.1, rel=0.2)
    assert outputs[0.1, True] == pytest.approx(outputs[0.0, False], abs=1e-12)


@pytest.mark.parametrize(("boat", "rate"), [("S1", 1.58), ("S2", 2.02), ("S3", 1.52), ("S4", 1.94)])
def test_the_law_itself_turns_the_boat(boat: str, rate: float) -> None:
    """U_3 must hold the neutral angle and lives on yaw rate alone: r = (U_3 + sigma)/(1.25 theta)."""
    turning, rates = Turntable(*BOATS[boat]), list[float]()
    turning.run(AsPublished(seeded=True), {}, 60.0, seen=rates)
    assert degrees(sum(rates[-500:]) / 500) == pytest.approx(rate, rel=0.03)


def test_servos_wait_at_thirty_degrees_inward() -> None:
    waiting = AsPublished().initial_commands()
    assert inward(waiting) == pytest.approx(30.0)
    assert waiting["steer_starboard_rad"] == -waiting["steer_port_rad"]
    assert (waiting["pwm_port"], waiting["pwm_starboard"]) == (0.0, 0.0)
    assert inward(AsPublished(parked_inward=False).initial_commands()) == 0.0


def test_steering_as_published_is_whole_degrees_between_the_stops() -> None:
    for commands in played(AsPublished(), readings()):
        port, starboard = inward(commands), -degrees(commands["steer_starboard_rad"])
        assert port == pytest.approx(round(port)) and 0.0 <= port <= 42.0
        assert (
            0.0 <= starboard - port <= 1.0 + 1e-9
        )  # truncation opens the port and closes the starboard servo


def test_a_loop_that_takes_too_long_runs_at_its_own_period() -> None:
    assert AsPublished().period == 0.08
    assert AsPublished(longer_period=True).period == pytest.approx(0.1)


CHANGED = {
    "seeded": True,
    "integer_division": False,
    "surge_history": False,
    "sigma_sign": False,
    "unscaled_disturbance": False,
    "start_values": False,
    "sway_coefficient": False,
    "misplaced_parenthesis": False,
    "divide_by_four": False,
    "acceleration_as_velocity": False,
    "unused_gyro": False,
    "reversed_difference": False,
    "heading_wrap": True,
}


@pytest.mark.parametrize("switch", CHANGED)
def test_each_switch_changes_what_the_program_does(switch: str) -> None:
    def trace(**settings: bool) -> list[float]:
        controller = AsPublished(**settings)
        values = []
        for sense in readings():
            controller.step(sense, {})
            values += [e.value for e in controller.estimates().values()] + [
                steering_output(controller)
            ]
        return values

    assert trace(**{switch: CHANGED[switch]}) != trace()


def test_integer_division_is_small_beside_the_start_up_kick() -> None:
    """Below 0.2 deg/s in the largest rate once the heading is seeded (item 16); with the kick it is
    ten times that."""

    def largest(**settings: Any) -> float:
        rates = list[float]()
        Turntable().run(AsPublished(**settings), {}, 20.0, random.Random(0), rates)
        return degrees(max(abs(rate) for rate in rates))

    assert abs(largest(seeded=True, integer_division=False) - largest(seeded=True)) < 0.2
    assert largest(integer_division=False) - largest() > 1.0


def test_surge_gain_matters_only_with_a_surge_command() -> None:
    def last(**settings: Any) -> float:
        controller = AsPublished(surge_history=False, **settings)
        played(controller, readings())
        return float(controller._u[0][0])

    assert last(surge_feed_forward=True) == last(surge_feed_forward=False)
    assert last(r_1=0.1, surge_feed_forward=False) > last(r_1=0.1)


def test_wrap_of_the_compass_reads_as_a_mad_yaw_rate() -> None:
    """2 pi over the sample time, times 1.25: 98 rad/s (item 23)."""
    controller = AsPublished(heading_wrap=True, h0=0.01, seeded=True)
    rates = []
    for psi in (0.0, -0.02):
        controller.step(replace(STILL, psi=psi), {})
        rates.append(controller._yaw)
    assert rates[1] == pytest.approx(-1.25 * (2 * pi - 0.02) / 0.08)


def test_yaw_program_straightens_the_motors() -> None:
    """The inferred yaw law drives the steering to 0, so that the turn is open loop."""
    controller = AsPublished(r_2=0.0, r_3=-0.56, seeded=True)
    assert {inward(c) for c in played(controller, [STILL] * 60)[30:]} == {0.0}


# Joystick and its rival
# -------------------------------------------------------------------------------------------


@RIVALS
@pytest.mark.parametrize("name", BOATS)
def test_sway_keeps_its_heading_without_knowing_the_boat(controller: Any, name: str) -> None:
    boat = Turntable(*BOATS[name], reverse=0.6, push=0.02)
    boat.run(controller(), {"sway_mps": 0.07}, 60.0, random.Random(1))
    assert abs(degrees(boat.psi)) < 1.0


@RIVALS
@pytest.mark.parametrize("turn", [1.0, -1.0])
def test_yaw_command_turns_at_its_rate_and_stops_at_its_angle(controller: Any, turn: float) -> None:
    boat, goal = Turntable(0.19, 0.6, inertia=1.6, damping=0.25), {"yaw_radps": turn * 0.1396}
    boat.run(controller(), goal, 30.0)
    assert boat.r == pytest.approx(turn * 0.1396, rel=0.05)
    assert boat.psi == pytest.approx(turn * 0.1396 * 30.0, abs=0.15)


@RIVALS
@pytest.mark.parametrize("sway", [0.0, 0.02, 0.07, -0.07])
def test_sway_and_yaw_at_once_still_turn_at_the_rate_asked_for(
    controller: Any, sway: float
) -> None:
    boat = Turntable(0.28, 0.64, thrust=0.6)
    boat.run(controller(), {"sway_mps": sway, "yaw_radps": 0.1}, 40.0)
    assert boat.r == pytest.approx(0.1, rel=0.05)


@RIVALS
def test_mirrored_readings_and_stick_give_mirrored_commands(controller: Any) -> None:
    goal = {"surge_mps": 0.05, "sway_mps": 0.04, "yaw_radps": -0.05}
    mirrored_goal = {"surge_mps": 0.05, "sway_mps": -0.04, "yaw_radps": 0.05}
    noise = random.Random(4)
    senses = [
        replace(STILL, r=noise.gauss(0.0, 0.05), u=noise.gauss(0.05, 0.02)) for _ in range(100)
    ]
    mirrored = [replace(s, r=-s.r) for s in senses]
    for one, other in zip(
        played(controller(), senses, goal),
        played(controller(), mirrored, mirrored_goal),
        strict=True,
    ):
        assert (other["pwm_port"], other["pwm_starboard"]) == (
            one["pwm_starboard"],
            one["pwm_port"],
        )
        assert other["steer_port_rad"] == -one["steer_starboard_rad"]


@RIVALS
def test_surge_command_with_a_speed_sensor_is_held(controller: Any) -> None:
    run, u, speeds = controller(), 0.0, []
    for _ in range(1000):
        commands = run.step(replace(STILL, u=u), {"surge_mps": 0.1})
        thrust = sum(
            0.004 * pwm * (1.0 if pwm > 0 else 0.6)
            for name, pwm in commands.items()
            if "pwm" in name
        )
        u += 0.08 * (thrust - 0.02 * u - 2.5 * u * abs(u)) / 4.8
        speeds.append(u)
    assert sum(speeds[-200:]) / 200 == pytest.approx(0.1, rel=0.02)


@pytest.mark.parametrize("pole", [0.5, 1.4])
def test_response_to_the_stick_has_its_own_pole(pole: float) -> None:
    """Without heading feedback, on a boat with the pole of the predictor."""
    controller = L1Joystick(response_pole=pole, pole=0.5, heading_gain=0.0)
    boat, seen = Turntable(damping=0.5 * controller.inertia), list[float]()
    boat.run(controller, {"yaw_radps": 0.05}, 4.0, seen=seen)
    expected = [0.05 * (1.0 - exp(-pole * 0.08 * k)) for k in range(len(seen))]
    assert max(abs(a - b) for a, b in zip(seen, expected, strict=True)) < 0.03 * 0.05


@RIVALS
def test_nothing_asked_for_at_rest_stops_the_motors(controller: Any) -> None:
    for commands in played(controller(), [STILL] * 5):
        assert commands == {
            "pwm_port": 0,
            "pwm_starboard": 0,
            "steer_port_rad": 0,
            "steer_starboard_rad": 0,
        }


@RIVALS
def test_reset_forgets_the_last_run(controller: Any) -> None:
    run, goal = controller(), {"sway_mps": 0.05, "surge_mps": 0.02}
    senses = [replace(s, u=0.01) for s in readings()]
    assert played(run, senses, goal) == played(run, senses, goal)


@RIVALS
def test_compass_corrects_the_heading_only_where_it_is_trusted(controller: Any) -> None:
    off = [replace(STILL, psi=0.2)] * 50
    assert played(controller(), off)[-1]["pwm_port"] == 0
    assert played(controller(compass_trust=0.1), off)[-1]["pwm_port"] < 0


def test_predictor_is_told_the_saturated_command() -> None:
    """A boat that does exactly what the outboards can give leaves nothing to explain, however much
    was asked for."""
    controller, rate = L1Joystick(), 0.0
    assumed = Predictor(controller.pole, 1.0 / controller.inertia, controller.period)
    for _ in range(40):
        commands = controller.step(replace(STILL, r=rate), {"yaw_radps": 0.5})
        assert controller.estimates()["sigma_yaw_Nm"].value == pytest.approx(0.0, abs=1e-12)
        port, astern = (
            commands["pwm_port"] / 150 * 0.5,
            commands["pwm_starboard"] / 150 * 0.5 * 0.67,
        )
        rate = assumed.decay * rate + assumed.gain * 0.235 * (port - astern)
    assert abs(commands["pwm_starboard"]) > 150


def test_lasting_moment_is_answered_in_full() -> None:
    boat = Turntable(push=0.03, damping=2.8)  # the predictor's own pole: nothing else is unknown
    controller = L1Joystick()
    boat.run(controller, {"sway_mps": 0.07}, 40.0)
    assert controller.single_memory_record["N"] == pytest.approx(
        -0.03, abs=0.006
    )  # a servo step of 1 deg is 0.006 N m
    assert controller.estimates()["sigma_yaw_Nm"].value == pytest.approx(0.03, abs=0.008)


def test_saturation_does_not_wind_the_pid_up() -> None:
    """Held fast under a full stick for 40 s, the rival answers a heading past its aim within three
    steps."""
    controller = PidAutopilot()
    commands = played(controller, [STILL] * 500, {"yaw_radps": 0.02})
    assert (
        commands[-1]["pwm_starboard"] < -200
    )  # 0.45 N astern: as much as the allocation ever asks for
    swing = replace(STILL, r=12.0)  # one period of this is 1 rad, well past the 0.8 rad asked for
    controller.step(swing, {})
    answers = [controller.step(STILL, {}) for _ in range(3)]
    assert answers[-1]["pwm_port"] < 0


@cache
def margins_of(controller: Any) -> Any:
    """Margins of the loops of a controller with its usual settings, computed once."""
    return stability_margins(controller())


@RIVALS
def test_loops_bear_two_more_periods_of_delay(controller: Any) -> None:
    rows = margins_of(controller)
    assert {row.channel for row in rows} == {"yaw", "surge"}
    assert all(row.stable and row.delay_s > 0.16 for row in rows)


@pytest.mark.parametrize(
    ("name", "channels"),
    [
        ("l1_joystick", {"yaw", "surge"}),
        ("l1_joystick_projection", {"yaw", "surge"}),
        ("l1_joystick_sway", {"yaw", "surge", "sway"}),
        ("l1_joystick_blind", {"yaw"}),
    ],
)
def test_every_channel_meets_the_l1_condition_for_every_input_gain(
    name: str, channels: set[str]
) -> None:
    rows = margins_of(load_class("controller", name))
    assert {row.channel for row in rows} == channels
    assert all(row.norm * row.needed < 1.0 and row.stable and row.delay_s > 0.16 for row in rows)


def test_published_low_pass_does_not_meet_the_l1_condition() -> None:
    """D(s) = 1.07 (s + 17.7) / (s (s + 50)) closes at 0.379 rad/s; 1.4 1/s are to be covered."""
    rows = stability_margins(L1JoystickProjection(yaw_bandwidth=1.07 * 17.7 / 50.0))
    worst = max(row.norm * row.needed for row in rows if row.channel == "yaw")
    assert worst == pytest.approx(1.46, abs=0.01)


@pytest.mark.parametrize("push", [-0.05, 0.05])
def test_projected_estimates_stay_within_their_bounds_on_a_boat(push: float) -> None:
    controller, boat, noise = L1JoystickProjection(), Turntable(push=push), random.Random(2)
    for seconds, goal in ((10.0, {"sway_mps": 0.07}), (10.0, {"yaw_radps": 0.1})):
        boat.run(controller, goal, seconds, noise)
        for name, estimate in controller.estimates().items():
            assert not estimate.value < estimate.low and not estimate.value > estimate.high, name


def test_two_adaptive_laws_move_a_boat_alike() -> None:
    """Both low-pass filters have 2 rad/s; the difference is that of the zero of D(s) and of the
    commands, which are rounded to whole degrees."""
    rates = {}
    alike = {"pole": 1.4, "yaw_bandwidth": 2.0, "surge_bandwidth": 2.0, "heading_gain": 0.2}
    for controller in (L1Joystick(**alike), L1JoystickProjection()):
        boat, seen = Turntable(push=0.03), list[float]()
        boat.run(controller, {"sway_mps": 0.07}, 20.0, seen=seen)
        rates[type(controller)] = seen
    pairs = list(zip(rates[L1Joystick], rates[L1JoystickProjection], strict=True))
    largest = max(abs(rate) for rate in rates[L1Joystick])
    assert max(abs(one - other) for one, other in pairs) < 0.3 * largest


def test_one_euler_step_a_period_is_too_long_for_the_gain() -> None:
    """The stability limit is 2 / sqrt(gain lambda_max(P)) = 0.0155 s for slow states."""
    largest = {}
    for step in (0.002, 0.01, 0.08):
        boat, seen = Turntable(push=0.03), list[float]()
        boat.run(L1JoystickProjection(adaptation_step=step), {"sway_mps": 0.07}, 30.0, seen=seen)
        largest[step] = max(abs(rate) for rate in seen[-100:])
    assert largest[0.002] < 0.01 and largest[0.01] < 0.01 and largest[0.08] > 0.03


def test_sway_is_held_at_the_speed_asked_for_where_it_is_measured() -> None:
    """A hull that drifts of itself: without the sensor thrust alone decides how fast it is."""
    speeds = {}
    for measured in (True, False):
        controller, v = load_class("controller", "l1_joystick_sway")(), 0.0
        for _ in range(600):
            commands = controller.step(replace(STILL, v=v if measured else nan), {"sway_mps": 0.07})
            angle = commands["steer_port_rad"]
            thrust = sum(0.004 * abs(commands[f"pwm_{side}"]) for side in ("port", "starboard"))
            v += 0.08 * (thrust * sin(angle) - 3.0 * v) / 11.0
        speeds[measured] = v
    assert speeds[True] == pytest.approx(0.07, rel=0.03)
    assert speeds[False] != pytest.approx(0.07, rel=0.2)


def test_a_blind_boat_whose_motors_are_known_is_not_tried_again() -> None:
    """Its commands are the parent's, astern by the factor and both motors turned by the angle."""
    knows = load_class("controller", "l1_joystick_blind")(known_astern=1.2, known_angle=0.03)
    usual = L1Joystick()
    one = played(knows, [STILL] * 20, {"sway_mps": 0.07})[0]
    other = played(usual, [replace(STILL, u=0.0)] * 20, {"sway_mps": 0.07})[0]
    assert one["pwm_port"] == other["pwm_port"] > 0.0 > other["pwm_starboard"]
    assert one["pwm_starboard"] == round(1.2 * other["pwm_starboard"])
    assert one["steer_port_rad"] == pytest.approx(other["steer_port_rad"] - 0.03)


def test_a_blind_boat_hears_no_stick_while_its_motors_are_tried() -> None:
    controller = load_class("controller", "l1_joystick_blind")()
    assert all(
        c["pwm_port"] == c["pwm_starboard"]
        for c in played(controller, [STILL] * 40, {"sway_mps": 0.07})
    )
    assert controller.check_result is None


def test_a_blind_boat_that_is_tied_up_says_so() -> None:
    with pytest.raises(BadInput, match="is it free to move"):
        played(load_class("controller", "l1_joystick_blind")(), [STILL] * 80)


def test_open_loop_plays_its_goal() -> None:
    goal = {"thrust_port_N": 0.3, "pwm_starboard": -120.0}
    controller = OpenLoop()
    commands = controller.step(STILL, goal)
    assert commands == goal and commands is not goal
    assert controller.initial_commands() == {}


@pytest.mark.parametrize(
    "name", ["l1_joystick", "l1_joystick_as_published", "pid_autopilot", "open_loop"]
)
def test_misspelt_setting_is_named_with_the_nearest_one(name: str) -> None:
    with pytest.raises(BadInput, match="'perod' does not exist; did you mean 'period'"):
        load_class("controller", name).from_settings({"perod": 0.1})


def test_integer_division_is_named_when_misspelt() -> None:
    with pytest.raises(BadInput, match="did you mean 'integer_division'"):
        AsPublished.from_settings({"integer_divison": False})
    assert AsPublished.from_settings({"integer_division": False, "h0": radians(5.0)}).h0 == radians(
        5.0
    )
