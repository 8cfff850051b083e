"""Actuators between two commands: where their signals bend no step reaches, and one that has
arrived asks for none."""

from math import inf
from typing import Any

import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.physics.base import ChannelEffect, SignalSegment, segment_mean, segment_with_mean
from boatsim.physics.effects.command_delay import CommandDelay
from boatsim.physics.effects.drive_map import DriveMap
from boatsim.physics.effects.rate_limit import RateLimit
from boatsim.physics.effects.servo import Servo
from boatsim.physics.effects.steering_backlash import SteeringBacklash
from boatsim.physics.kernel.records import VesselNumbers
from boatsim.physics.program import Program
from boatsim.simulate.engine import Engine

STEP = 0.1  # [s]
SETTLED = 0.5  # [s] after which each of these has arrived
EFFECTS = [
    RateLimit(rate=8.0),
    Servo(rate=8.0, lag=0.0),
    Servo(rate=8.0, lag=0.06),
    CommandDelay(delay=0.23),
]


def parts(effect: Any, command: float, memory: Any, seconds: float) -> list[float]:
    """Lengths of the steps that it asks for while a command is held; `memory` is its own."""
    lengths, q = [], effect.values()
    for _ in range(round(seconds / STEP)):
        left = STEP
        while left > 1e-9:
            dt = min(
                left, max(type(effect).time_to_discontinuity.py_func(command, memory, 0, q), 1e-6)
            )
            lengths.append(dt)
            type(effect).transform_signal.py_func(
                SignalSegment(command, command, command), 0.0, 0.0, memory, 0, dt, q
            )
            left -= dt
            assert len(lengths) < 100, f"{effect.name} halts at {memory[:4]} under {command!r}"
    return lengths


@pytest.mark.parametrize("effect", EFFECTS, ids=lambda e: f"{e.name}_{getattr(e, 'lag', '')}")
def test_an_actuator_that_has_arrived_asks_for_no_shorter_step(effect: ChannelEffect) -> None:
    """Whatever the command: a last bit by which it were short of it would be a ramp for ever.

    A lag is followed.
    """
    memory, lag = np.zeros(type(effect).slots), getattr(effect, "lag", 0.0)
    settled = [lag, STEP - lag] if lag else [STEP]
    for command in np.random.default_rng(1).uniform(-0.785, 0.785, 300).tolist():
        moving = parts(effect, command, memory, SETTLED)
        assert (
            len(moving) <= len(settled) * round(SETTLED / STEP) + 3
        )  # a bend or two, and what a step leaves over
        assert parts(effect, command, memory, 5 * STEP) == pytest.approx(settled * 5)


@pytest.mark.parametrize("effect", EFFECTS[:2], ids=lambda e: e.name)
def test_a_ramp_ends_on_its_command_to_the_last_bit(effect: ChannelEffect) -> None:
    memory = np.zeros(type(effect).slots)
    for command in np.random.default_rng(2).uniform(-0.785, 0.785, 300).tolist():
        parts(effect, command, memory, SETTLED)
        assert memory[0] == command
        assert (
            type(effect).time_to_discontinuity.py_func(command, memory, 0, effect.values()) == inf
        )  # type: ignore[attr-defined]


def test_a_signal_that_stands_still_is_its_own_mean_to_the_last_bit() -> None:
    for x in [0.174533, *np.random.default_rng(3).uniform(-300.0, 300.0, 1000).tolist()]:
        assert segment_mean.py_func(SignalSegment(x, x, x)) == x
        assert segment_with_mean.py_func(x, x, x) == (x, x, x)


def test_the_mean_of_a_course_is_the_one_it_was_made_with() -> None:
    for begin, mean, end in np.random.default_rng(4).uniform(-3.0, 3.0, (100, 3)).tolist():
        assert segment_mean.py_func(segment_with_mean.py_func(begin, mean, end)) == pytest.approx(
            mean, abs=1e-14
        )


def test_a_rate_limit_behind_a_lag_does_not_halt_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    """It ends no ramp while what it follows still moves: parts of a step that only ever halve would
    be thousands."""
    boat = vessel.load_vessel("joystick_boat", extra=[{"use": "steering_rate_limit", "rate": 0.5}])
    engine, parts, substep_length = Engine(boat, step=0.02), [], Engine(boat).code.substep_length

    def counted(*given: Any) -> float:
        parts.append(substep_length(*given))
        return float(parts[-1])

    monkeypatch.setattr(engine.code, "substep_length", counted)
    engine.command({"steer_port_rad": 0.2})
    engine.advance(100)
    assert len(parts) <= 8 * 100
    assert engine.actuators["steer_port_rad"] == pytest.approx(0.2, abs=1e-6)


@pytest.mark.parametrize("delay", [0.03, 0.105, 0.13, 0.17, 0.4301])
def test_a_delayed_command_acts_when_it_arrives_however_long_the_steps(delay: float) -> None:
    """A ramp and a delay in one channel, three channels that change at different times: no arrival
    is stepped over."""
    program = Program(vessel.load_vessel("jet_ski", ["low_speed"]), candidates=(CommandDelay(),))
    values, on = program.values(), program.effect_switches(["command_delay"])
    values[program.parameter_index("command_delay", "delay")] = delay
    rng, rows = np.random.default_rng(5), 100
    held = {"throttle": np.ones(rows), "jet_rad": np.repeat(rng.uniform(-0.2, 0.2, rows // 5), 5)}
    held["elevator_rad"] = np.repeat(rng.uniform(0.0, 0.9, rows // 4), 4)
    commands, ends = np.column_stack([held[c] for c in program.vessel.commands]), []
    code = program.simulation_functions
    for substeps in (1, 20):
        memory, path = np.zeros(program.memory_size), np.zeros((rows + 1, 2 * code.NQ))
        code.settle_actuators(
            commands[0], memory, values, on, np.zeros(3 * program.actuator_signal_size)
        )
        code.rollout(
            VesselNumbers(np.array(program.body), values, on),
            program.vessel_state(np.zeros(2 * code.NQ), memory),
            commands,
            0.0,
            STEP / substeps,
            substeps,
            path,
        )
        ends.append(path[-1, : code.NQ])
    assert ends[0] == pytest.approx(
        ends[1], abs=1e-4
    )  # [m], [rad]; an arrival missed by 10 ms moves it by 0.01


def test_a_delay_of_a_ship_outlasts_commands_that_change_at_every_step() -> None:
    """A sine sent anew every 20 ms, 6 s late: 300 commands are on their way; remembered in means 77
    ms long."""
    late, memory, step, shown = (
        CommandDelay(delay=6.0).values(),
        np.zeros(CommandDelay.slots),
        0.02,
        [],
    )
    times = step * np.arange(1500)
    for given in np.sin(0.5 * times):
        passed = CommandDelay.transform_signal.py_func(
            SignalSegment(given, given, given), 0.0, 0.0, memory, 0, step, late
        )
        shown.append(passed.middle)
    after = times > 6.5
    assert np.array(shown)[after] == pytest.approx(
        np.sin(0.5 * (times[after] - 6.0)), abs=0.5 * 0.077
    )


def test_a_drive_that_is_dead_over_all_of_its_span_is_refused_in_a_line() -> None:
    with pytest.raises(
        BadInput, match=r"^drive_map\.dead = 60; allowed is less than its span, 50$"
    ):
        DriveMap(span=50.0, dead=60.0)


@pytest.mark.parametrize(("behind", "first"), [(0.0, 0.3), (0.5, 0.25), (1.0, 0.2)])
def test_play_begins_where_it_is_said_to_hang_and_is_whole_from_then_on(
    behind: float, first: float
) -> None:
    """0.2 rad of play under a first command of 0.3 rad: half of it is between its middle and its end."""
    q = SteeringBacklash(width=0.2, behind=behind).values()
    memory = np.zeros(1)

    def angle(command: float, seconds: float) -> float:
        return float(
            SteeringBacklash.transform_signal.py_func(
                SignalSegment(*[command] * 3), 0.0, 0.0, memory, 0, seconds, q
            ).end
        )

    for _ in range(3):  # as actuators are settled
        angle(0.3, 1e4)
    assert angle(0.3, STEP) == pytest.approx(first)
    assert angle(0.5, STEP) == pytest.approx(0.4) and angle(0.45, STEP) == pytest.approx(0.4)
    assert angle(0.2, STEP) == pytest.approx(0.3)
