"""Standard manoeuvres of any vessel as scenarios, with the IMO's limits as bands where they exist.

A vessel's [manoeuvring] table specifies how it is driven ahead and steered. Missing entries follow
from the channels: half of the largest thrust ahead, and all steering channels as helm, or else a
thrust difference between the sides.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import cos, degrees, inf, log10, pi, radians, sin
from pathlib import Path

import numpy as np

from boatsim.control.base import HelmManoeuvre
from boatsim.errors import BadInput, unknown_name_message
from boatsim.files import Value
from boatsim.physics import vessel as vessels
from boatsim.physics.content import vessel_reference
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.signals import Array, motion_signals
from boatsim.physics.vessel import ManoeuvringTable, Vessel
from boatsim.recordings.table import Recording
from boatsim.simulate import imo, scenario
from boatsim.simulate.batch import Batch
from boatsim.simulate.cases import ScenarioLocation
from boatsim.simulate.scenario import Scenario
from boatsim.simulate.steady_course import SteadyCourse, find_steady_course, steering_commands

ANGLES = {  # manoeuvre -> its usual angle [deg]
    "turning_circle": 35.0,
    "zigzag": 20.0,
    "pull_out": 20.0,
    "spiral": 20.0,
    "crash_stop": 0.0,
    "roll_decay": 10.0,
}
HULL_LENGTHS = 100.0  # [lengths] of travel after which an approach is steady
STEPS = 250  # integration steps per length of travel
ROWS = 25  # rows of the log per length of travel
BEFORE = 2.0  # [lengths] of approach before a manoeuvre begins
LONGEST = 200.0  # [lengths] of travel
HOLD = 30.0  # [lengths] for which each angle of a pull-out or spiral is held
ROUND = 2.5 * pi  # [rad] of a turning circle
# [rad] of helm that corresponds to the full thrust difference of a vessel without a helm
FULL = radians(35.0)
AHEAD = 0.5  # cosine of the angle from which on a thruster counts as a transverse one
ROLLS = 12  # estimated roll periods of a roll decay


def manoeuvre_scenario(
    manoeuvre: str,
    name: str,
    loads: Sequence[str] = (),
    angle: float | None = None,
    speed: float | None = None,
    heading: float | None = None,
) -> Scenario:
    """Return the scenario of a standard manoeuvre, such as a turning circle, for a vessel.

    Args:
        manoeuvre: Name of the manoeuvre.
        name: Name or file of the vessel.
        loads: Load conditions.
        angle: Helm [deg], positive to starboard; default: the usual angle, or as much helm as the
            vessel has.
        speed: Speed of the approach [m/s]; default: the vessel's.
        heading: Heading change [deg] at which a zig-zag reverses its helm; default: the helm.

    Raises:
        BadInput: If the manoeuvre or vessel does not exist or do not fit.
    """
    if manoeuvre not in ANGLES:
        raise BadInput(unknown_name_message("manoeuvre", manoeuvre, ANGLES))
    _check_heading(manoeuvre, heading)
    vessel = vessels.load_vessel(name, loads)
    usual = ANGLES[manoeuvre] if angle is None else angle
    if usual == 0.0 and manoeuvre != "crash_stop":
        raise BadInput(
            f"angle = 0 deg; a {manoeuvre} needs another, usual are {ANGLES[manoeuvre]:g} deg"
        )
    raw: dict[str, Value] = {
        "about": f"{manoeuvre.replace('_', ' ')} of {vessel.name}",
        "vessel": vessel_reference(vessel.file),
        "load": list(loads),
        "sensors": {"ideal": True},
    }
    if manoeuvre == "roll_decay":
        place = ScenarioLocation(Path(f"{manoeuvre}.toml"))
        return scenario.from_table(raw | _roll_decay_tables(vessel, usual), place, vessel)
    if "yaw" not in vessel.dof:
        raise BadInput(
            f"{vessel.name} is not free to turn; of the manoeuvres it can only do roll_decay"
        )
    loaded = vessel
    vessel = replace(loaded, manoeuvring=complete_manoeuvring_table(loaded))
    angle = min(usual, largest_helm(vessel)) if angle is None else angle
    _check_commands(vessel, 0.0 if manoeuvre == "crash_stop" else angle)
    if manoeuvre == "crash_stop" and not vessel.manoeuvring.astern:
        raise BadInput(
            f"{vessel.name}: no thrust astern; "
            "specify it by [manoeuvring] astern = { CHANNEL = value }"
        )
    approach = steady_approach(vessel, speed)
    reverses = abs(angle) if heading is None else heading
    place = ScenarioLocation(Path(f"{manoeuvre}.toml"))
    table = raw | _manoeuvre_tables(manoeuvre, vessel, angle, approach, reverses)
    return scenario.from_table(table, place, loaded)


def _check_heading(manoeuvre: str, heading: float | None) -> None:
    """Check that only a zig-zag has a heading, in its range."""
    if heading is None:
        return
    if manoeuvre != "zigzag":
        raise BadInput(
            f"heading = {heading:g} deg; "
            f"only a zigzag reverses its helm at a heading, not a {manoeuvre}"
        )
    if not 0.1 <= heading <= 170.0:
        raise BadInput(f"heading = {heading:g} deg; allowed 0.1 to 170 deg")


def complete_manoeuvring_table(vessel: Vessel) -> ManoeuvringTable:
    """Return a vessel's [manoeuvring] table, with missing entries derived from its channels.

    The table holds the commands for going ahead and astern, and those per rad of steering angle.

    Args:
        vessel: The vessel.

    Raises:
        BadInput: If a channel does not exist or there is no means of steering.
    """
    given, channels = vessel.manoeuvring, vessel.commands
    for name in (*given.ahead, *given.astern, *given.steer):
        if name not in channels:
            raise BadInput(f"{vessel.name}: [manoeuvring] {vessel.unknown_command_message(name)}")
    ahead, astern, steer = dict(given.ahead), dict(given.astern), dict(given.steer)
    transverse = transverse_thrusters(vessel)
    thrusters: list[str] = []
    for name in vessel.actuators:
        if vessel.roles[name] == "thrust" and name not in transverse:
            thrusters.append(name)
        elif vessel.roles[name] == "angle" and not given.steer:
            steer[name] = 1.0
    if not ahead:
        ahead = {name: 0.5 * channels[name].high for name in thrusters}
    if not astern:
        for name, value in ahead.items():
            if channels[name].low < 0.0 < value:
                astern[name] = max(channels[name].low, -value)
    if not steer:
        for name in thrusters:
            if vessel.side(name) and name in ahead:
                steer[name] = -vessel.side(name) * ahead[name] / FULL
    if not steer:
        raise BadInput(
            f"{vessel.name}: no means of steering; "
            "specify it by [manoeuvring] steer = { CHANNEL = per rad }"
        )
    table = given.model_copy(update={"ahead": ahead, "astern": astern, "steer": steer})
    if given.steer:
        return table
    return _orient_helm_to_starboard(replace(vessel, manoeuvring=table))


def transverse_thrusters(vessel: Vessel) -> dict[str, float]:
    """Return the thrusters of a vessel that act sideways at a fixed angle, such as bow tunnels.

    Args:
        vessel: The vessel.

    Returns:
        Channel of the thrust -> fraction of the thrust that acts to starboard, negative to port.
    """
    found: dict[str, float] = {}
    for effect in vessel.effects:
        if "angle" in type(effect).roles:
            bindings = vessel.bindings(effect)
            angle = bindings.get("angle")
            if isinstance(angle, int | float) and cos(angle) < AHEAD:
                found[str(bindings.get("thrust"))] = sin(angle)
    return found


def largest_helm(vessel: Vessel) -> float:
    """Return the largest helm angle [deg] that a vessel can apply to both sides.

    The ranges of all steering channels limit it.
    """
    table = vessel.manoeuvring
    largest: list[float] = []  # [rad]
    for name, per_rad in table.steer.items():
        channel, ahead = vessel.commands[name], table.ahead.get(name, 0.0)
        largest.append(min(channel.high - ahead, ahead - channel.low) / abs(per_rad))
    return float(np.round(degrees(min(largest)), 1))


def _check_commands(vessel: Vessel, angle: float) -> None:
    """Check the commands ahead, astern and with this much helm [deg] against their ranges."""
    table = vessel.manoeuvring
    cases = {"going ahead": table.ahead, "going astern": table.astern}
    for side in (angle, -angle):
        cases[f"{side:g} deg of helm"] = steering_commands(table, radians(side))
    for case, commands in cases.items():
        for name, value in commands.items():
            channel = vessel.commands[name]
            slack = 1e-6 * (channel.high - channel.low)
            if not channel.low - slack <= value <= channel.high + slack:
                raise BadInput(
                    f"{vessel.name}: {case} means {name} = {value:g}; "
                    f"allowed {channel.low:g} to {channel.high:g}"
                )


def _orient_helm_to_starboard(vessel: Vessel) -> ManoeuvringTable:
    """The table with the sign of the helm for which a short run turns to starboard."""
    table = vessel.manoeuvring
    commands = {**table.ahead, **steering_commands(table, 0.2)}
    heading = _simulate_from_ahead(vessel, _default_speed(vessel), commands, 3.0)[2]
    if heading > 0.0:
        return table
    steer = {name: -per_rad for name, per_rad in table.steer.items()}
    return table.model_copy(update={"steer": steer})


def approach_speed(vessel: Vessel, speed: float | None = None) -> float:
    """Return the speed [m/s] at which a vessel approaches a manoeuvre.

    It is the given speed, else that in the [manoeuvring] table of the vessel's file, else the
    steady speed straight ahead under the vessel's approach commands.

    Args:
        vessel: The vessel.
        speed: Approach speed that is returned instead [m/s]; None to compute it.

    Raises:
        BadInput: If the vessel does not move ahead or the given speed is not valid.
    """
    if speed is not None:
        if not 0.0 < speed < inf:
            raise BadInput(f"speed = {speed:g} m/s; allowed is more than 0 m/s")
        return speed
    table = vessel.manoeuvring
    u = table.speed or float(
        _simulate_from_ahead(vessel, _default_speed(vessel), table.ahead, HULL_LENGTHS)[
            -_dof_count(vessel)
        ]
    )
    if not u > 0.0:
        raise BadInput(
            f"{vessel.name} does not move ahead under {table.ahead}; "
            "specify its commands by [manoeuvring] ahead"
        )
    return u


def steady_approach(vessel: Vessel, speed: float | None = None) -> SteadyCourse:
    """Return the steady course on which a vessel approaches a manoeuvre.

    A given speed is kept; otherwise the speed is that at which the vessel is steady under its
    approach commands. The helm is that of calm water, since the force of waves changes. A vessel
    without a steady course, for example because its helm cannot hold it, approaches straight ahead
    with the helm midships.

    Args:
        vessel: The vessel, with a complete [manoeuvring] table.
        speed: Speed of the approach [m/s]; None for the steady one.

    Raises:
        BadInput: If the vessel does not move ahead or the given speed is not valid.
    """
    expected = approach_speed(vessel, speed)
    ahead = SteadyCourse({"u": expected}, 0.0)
    if "surge" not in vessel.dof:
        return ahead
    calm = vessel
    for effect in vessel.effects:
        if effect.wave_axes():
            calm = calm.without_effect(effect.name)
    found = find_steady_course(
        calm,
        expected,
        radians(largest_helm(vessel)),
        _integration_step(vessel, expected),
        hold_speed=speed is not None,
    )
    if found is None:
        return ahead
    return found


def approach_summary(scenario: Scenario, log: Recording) -> str:
    """Return a line with yaw rate and speed at the start of a manoeuvre, and the approach's helm.

    It is empty for a roll decay, which has no approach, and for a run that ended before the start.

    Args:
        scenario: Scenario of the manoeuvre.
        log: Log of its run.
    """
    controller = scenario.controller
    if not isinstance(controller, HelmManoeuvre) or log.t[-1] < controller.execute:
        return ""
    row = int(np.flatnonzero(log.t <= controller.execute + 1e-9)[-1])  # the last of the approach
    rate, trim = degrees(log["r_radps"][row]), degrees(controller.trim)
    return (
        f"at the start of the manoeuvre, t = {controller.execute:.4g} s: "
        f"yaw rate {round(rate, 4) + 0.0:.4f} deg/s, speed {log['u_mps'][row]:.4g} m/s; "
        f"helm of the approach {round(trim, 2) + 0.0:.2f} deg"
    )


def _default_speed(vessel: Vessel) -> float:
    """The table's speed [m/s], by default that of Froude number 0.15, a slow speed."""
    return vessel.manoeuvring.speed or 0.15 * float(np.sqrt(GRAVITY * vessel.length))


def _dof_count(vessel: Vessel) -> int:
    return len(vessel.dof)


def _simulate_from_ahead(
    vessel: Vessel, speed: float, commands: Mapping[str, float], lengths: float
) -> Array:
    """State after the time of so many lengths at a speed, from straight ahead."""
    step = _integration_step(vessel, speed)
    compiled = Batch(vessel, step=step)
    start = [0.0] * (2 * _dof_count(vessel))
    start[_dof_count(vessel)] = speed
    rows = np.tile(
        compiled.program.command_array(commands), (round(lengths * vessel.length / speed / step), 1)
    )
    last: Array = compiled.rollout(start, rows, step)[-1]
    return last


def _integration_step(vessel: Vessel, speed: float) -> float:
    """Integration step [s], a round number."""
    return _round_down(min(max(vessel.length / speed / STEPS, 0.002), 0.5))


def _round_down(seconds: float) -> float:
    """Largest 1, 2 or 5 times a power of ten that is not above."""
    power = 10.0 ** np.floor(log10(seconds))
    best = 1.0
    for factor in (2.0, 5.0):
        if factor * power <= seconds * (1 + 1e-9):
            best = factor
    return float(best * power)


def _manoeuvre_tables(
    manoeuvre: str, vessel: Vessel, angle: float, approach: SteadyCourse, reverses: float
) -> dict[str, Value]:
    """Tables of a manoeuvre after a steady approach; a zig-zag reverses at a heading [deg]."""
    speed = approach.state["u"]
    table, unit, step = vessel.manoeuvring, vessel.length / speed, _integration_step(vessel, speed)
    execute, hold = (step * round(lengths * unit / step) for lengths in (BEFORE, HOLD))
    helm, heading = {"angle": radians(angle)}, {"heading": radians(reverses)}
    place = {"execute": execute, "length": vessel.length}
    # tables of controller and metric set, and longest time [s]
    own: dict[str, tuple[Mapping[str, Value], Mapping[str, Value], float]] = {
        "turning_circle": (helm, place, LONGEST * unit),
        "zigzag": (helm | heading, place | heading, LONGEST * unit),
        "pull_out": (helm | {"hold": hold}, {}, execute + 4 * hold),
        "spiral": (helm | {"hold": hold}, {}, execute + 17 * hold),
        "crash_stop": ({"astern": table.astern}, place, LONGEST * unit),
    }
    controller, measure, duration = own[manoeuvre]
    handling: dict[str, Value] = {
        "period": step,
        "execute": execute,
        "trim": approach.helm,
        "ahead": table.ahead,
        "steer": table.steer,
    }
    bands: dict[str, Value] = {}
    if manoeuvre != "zigzag" or reverses == abs(angle):  # the limits are for 10/10 and 20/20
        for name, high in imo.imo_limits(manoeuvre, angle, vessel.length, speed).items():
            bands[name] = {"guard": [0.0, high]}
    return {
        "duration": min(duration, 86400.0),
        "step": step,
        "log": _round_down(unit / ROWS),
        "start": dict(approach.state),
        "controller": {"use": manoeuvre, **handling, **controller},
        "camera": {"rate": min(max(1.0 / _round_down(unit / ROWS), 0.1), 6.0)},
        "measure": {"use": manoeuvre, **measure},
        "norms": bands,
        "until": {"turned": ROUND} if manoeuvre == "turning_circle" else {},
    }


def _roll_decay_tables(vessel: Vessel, angle: float) -> dict[str, Value]:
    """Tables of a roll decay from a heel [deg]."""
    if "roll" not in vessel.dof:
        raise BadInput(
            f"{vessel.name} does not roll; its degrees of freedom are {', '.join(vessel.dof)}"
        )
    period = _roll_period(vessel)
    step = _round_down(period / 200)
    return {
        "duration": ROLLS * period,
        "step": step,
        "start": {"phi": radians(angle)},
        "controller": {"use": "open_loop", "period": step},
        "measure": "roll_decay",
    }


def _roll_period(vessel: Vessel) -> float:
    """Period [s] of a small free roll. Raises BadInput if the hull does not oscillate."""
    # [s] of a ship of usual stability, with GM a twentieth of the beam
    guess = 2.0 * float(np.sqrt(vessel.beam))
    compiled = Batch(vessel, step=guess / 400)
    start = [0.0] * (2 * _dof_count(vessel))
    roll = [signal.symbol for signal in motion_signals(vessel.dof)].index("phi")
    start[roll] = radians(1.0)
    rows = np.tile(compiled.program.command_array({}), (8000, 1))
    phi = compiled.rollout(start, rows, guess / 400)[:, roll]
    crossings = np.flatnonzero((phi[:-1] > 0.0) & (phi[1:] <= 0.0))
    if len(crossings) < 2:
        raise BadInput(f"{vessel.name} does not oscillate when it is heeled and released")
    return float(crossings[1] - crossings[0]) * guess / 400
