"""Standard manoeuvres of any vessel: a scenario made from its data, with the IMO's limits as bars where there are some.

A vessel's [manoeuvring] table says how it is driven ahead and steered. What the table leaves out follows from the
channels: half of the largest thrust ahead, everything that turns as helm, or more thrust on one side than on the other.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import cos, degrees, inf, log10, pi, radians, sin
from pathlib import Path

import numpy as np

from boatsim.errors import BadInput, unknown_name
from boatsim.files import Value
from boatsim.physics import vessel as vessels
from boatsim.physics.content import vessel_address
from boatsim.physics.signals import Array, signals_of
from boatsim.physics.vessel import ManoeuvringTable, Vessel
from boatsim.simulate import imo, scenario
from boatsim.simulate.cases import Place
from boatsim.simulate.compiled_engine import Twin
from boatsim.simulate.scenario import Scenario

ANGLES = {  # manoeuvre -> its usual angle [deg]
    "turning_circle": 35.0,
    "zigzag": 20.0,
    "pull_out": 20.0,
    "spiral": 20.0,
    "crash_stop": 0.0,
    "roll_decay": 10.0,
}
HULL_LENGTHS = 100.0  # of travel after which an approach is steady
STEPS = 250  # of integration in the time of one length of travel
ROWS = 25  # of the log in that time
BEFORE = 2.0  # [lengths] of approach before a manoeuvre begins
LONGEST = 200.0  # [lengths] of travel
HOLD = 30.0  # [lengths] for which each angle of a pull-out or spiral is held
ROUND = 2.5 * pi  # [rad] of a turning circle
FULL = radians(
    35.0
)  # helm angle that stands for all of the differential thrust of a vessel that has no helm
AHEAD = 0.5  # cosine of the angle beyond which a thruster counts as one that pushes aside
ROLLS = 12  # periods of a roll decay, of a hull as wide as this one


def scenario_of(
    manoeuvre: str,
    name: str,
    loads: Sequence[str] = (),
    angle: float | None = None,
    speed: float | None = None,
    heading: float | None = None,
) -> Scenario:
    """The scenario of a manoeuvre; `angle` [deg], positive to starboard, `speed` [m/s] of the approach.

    Without an angle it is the usual one, or as much helm as the vessel has. `heading` [deg] is the change at which a
    zig-zag reverses its helm, without it the angle. Raises BadInput for a manoeuvre or vessel that does not exist, or a
    vessel that can not do it so.
    """
    if manoeuvre not in ANGLES:
        raise BadInput(unknown_name("manoeuvre", manoeuvre, ANGLES))
    _check_heading(manoeuvre, heading)
    vessel = vessels.load(name, loads)
    usual = ANGLES[manoeuvre] if angle is None else angle
    if usual == 0.0 and manoeuvre != "crash_stop":
        raise BadInput(
            f"angle = 0 deg; a {manoeuvre} needs another, usual are {ANGLES[manoeuvre]:g} deg"
        )
    raw: dict[str, Value] = {
        "about": f"{manoeuvre.replace('_', ' ')} of {vessel.name}",
        "vessel": vessel_address(vessel.file),
        "load": list(loads),
        "sensors": {"ideal": True},
    }
    if manoeuvre == "roll_decay":
        place = Place(Path(f"{manoeuvre}.toml"))
        return scenario.from_table(raw | _released(vessel, usual), place, vessel)
    if "yaw" not in vessel.dof:
        raise BadInput(
            f"{vessel.name} is not free to turn; of the manoeuvres it can only do roll_decay"
        )
    loaded = vessel
    vessel = replace(loaded, manoeuvring=handled(loaded))
    angle = min(usual, helm_of(vessel)) if angle is None else angle
    _check_commands(vessel, 0.0 if manoeuvre == "crash_stop" else angle)
    if manoeuvre == "crash_stop" and not vessel.manoeuvring.astern:
        raise BadInput(
            f"{vessel.name}: nothing to go astern with; [manoeuvring] astern = {{ CHANNEL = value }} says what"
        )
    at = approach(vessel, speed)
    reverses = abs(angle) if heading is None else heading
    place = Place(Path(f"{manoeuvre}.toml"))
    table = raw | _under_way(manoeuvre, vessel, angle, at, reverses)
    return scenario.from_table(table, place, loaded)


def _check_heading(manoeuvre: str, heading: float | None) -> None:
    """Only a zig-zag has one, and it lies ahead of the bow."""
    if heading is None:
        return
    if manoeuvre != "zigzag":
        raise BadInput(
            f"heading = {heading:g} deg; only a zigzag reverses its helm at a heading, not a {manoeuvre}"
        )
    if not 0.1 <= heading <= 170.0:
        raise BadInput(f"heading = {heading:g} deg; allowed 0.1 to 170 deg")


def handled(vessel: Vessel) -> ManoeuvringTable:
    """The vessel's [manoeuvring] table, completed from its channels. Raises BadInput where nothing steers."""
    given, taken = vessel.manoeuvring, vessel.commands
    if wrong := [n for n in (*given.ahead, *given.astern, *given.steer) if n not in taken]:
        raise BadInput(f"{vessel.name}: [manoeuvring] {vessel.unknown_command(wrong[0])}")
    thrusters = [
        n for n in vessel.actuators if vessel.roles[n] == "thrust" and n not in athwart(vessel)
    ]
    ahead = given.ahead or {n: 0.5 * taken[n].high for n in thrusters}
    astern = given.astern or {
        n: max(taken[n].low, -value) for n, value in ahead.items() if taken[n].low < 0.0 < value
    }
    steer = given.steer or {n: 1.0 for n in vessel.actuators if vessel.roles[n] == "angle"}
    if not steer:
        steer = {
            n: -vessel.side(n) * ahead[n] / FULL for n in thrusters if vessel.side(n) and n in ahead
        }
    if not steer:
        raise BadInput(
            f"{vessel.name}: nothing to steer with; [manoeuvring] steer = {{ CHANNEL = per rad }} says what"
        )
    table = given.model_copy(update={"ahead": ahead, "astern": astern, "steer": steer})
    return table if given.steer else _to_starboard(replace(vessel, manoeuvring=table))


def athwart(vessel: Vessel) -> dict[str, float]:
    """Thrusts of what is held at an angle, such as a tunnel across the bow, at which it drives nothing ahead.

    Each with the share of it that pushes to starboard.
    """
    bound = [vessel.bindings(e) for e in vessel.effects if "angle" in type(e).roles]
    held = [(b.get("thrust"), b.get("angle")) for b in bound]
    return {
        str(thrust): sin(angle)
        for thrust, angle in held
        if isinstance(angle, int | float) and cos(angle) < AHEAD
    }


def helm_of(vessel: Vessel) -> float:
    """Largest helm [deg] that all its channels can follow to both sides."""
    table, taken = vessel.manoeuvring, vessel.commands
    room = [
        min(taken[n].high - table.ahead.get(n, 0.0), table.ahead.get(n, 0.0) - taken[n].low)
        / abs(per_rad)
        for n, per_rad in table.steer.items()
    ]
    return float(np.round(degrees(min(room)), 1))


def _check_commands(vessel: Vessel, angle: float) -> None:
    """Ahead, astern and with this much helm [deg] to either side, no command leaves its channel's limits."""
    table = vessel.manoeuvring
    all_of_them = {"going ahead": table.ahead, "going astern": table.astern}
    for side in (angle, -angle):
        turned = {
            n: table.ahead.get(n, 0.0) + per_rad * radians(side)
            for n, per_rad in table.steer.items()
        }
        all_of_them[f"{side:g} deg of helm"] = turned
    for doing, commands in all_of_them.items():
        for name, value in commands.items():
            channel = vessel.commands[name]
            slack = 1e-6 * (channel.high - channel.low)
            if not channel.low - slack <= value <= channel.high + slack:
                raise BadInput(
                    f"{vessel.name}: {doing} means {name} = {value:g}; allowed {channel.low:g} to {channel.high:g}"
                )


def _to_starboard(vessel: Vessel) -> ManoeuvringTable:
    """The table with helm such that a positive angle turns to starboard, which a short run of the vessel tells."""
    table = vessel.manoeuvring
    held = {
        **table.ahead,
        **{n: table.ahead.get(n, 0.0) + 0.2 * per_rad for n, per_rad in table.steer.items()},
    }
    way = _state(vessel, _usual_speed(vessel), held, 3.0)[2]
    turned = {n: per_rad if way > 0.0 else -per_rad for n, per_rad in table.steer.items()}
    return table.model_copy(update={"steer": turned})


def approach(vessel: Vessel, speed: float | None = None) -> float:
    """Speed [m/s] at which the vessel goes straight ahead under the commands of its approach.

    A given speed is only where the run begins: what keeps it there is the vessel's own affair. Raises BadInput for one
    that makes no way.
    """
    if speed is not None:
        if not 0.0 < speed < inf:
            raise BadInput(f"speed = {speed:g} m/s; allowed is more than 0 m/s")
        return speed
    table = vessel.manoeuvring
    u = table.speed or float(
        _state(vessel, _usual_speed(vessel), table.ahead, HULL_LENGTHS)[-_half(vessel)]
    )
    if not u > 0.0:
        raise BadInput(
            f"{vessel.name} makes no way ahead under {table.ahead}; [manoeuvring] ahead says what drives it"
        )
    return u


def _usual_speed(vessel: Vessel) -> float:
    """The table's speed, else one [m/s] at which a hull of this length is still slow: Froude number 0.15."""
    return vessel.manoeuvring.speed or 0.15 * float(np.sqrt(9.81 * vessel.length))


def _half(vessel: Vessel) -> int:
    return len(vessel.dof)


def _state(vessel: Vessel, speed: float, commands: Mapping[str, float], lengths: float) -> Array:
    """State after so many lengths' time at a speed, begun straight ahead."""
    step = _step(vessel, speed)
    twin = Twin(vessel, step)
    start = [0.0] * (2 * _half(vessel))
    start[_half(vessel)] = speed
    rows = np.tile(
        twin.program.command_array(commands), (round(lengths * vessel.length / speed / step), 1)
    )
    last: Array = twin.rollout(start, rows, step)[-1]
    return last


def _step(vessel: Vessel, speed: float) -> float:
    """Step of integration [s], a round number."""
    return _rounded(min(max(vessel.length / speed / STEPS, 0.002), 0.5))


def _rounded(seconds: float) -> float:
    """1, 2 or 5 times a power of ten, not above."""
    power = 10.0 ** np.floor(log10(seconds))
    return float(max(m for m in (1.0, 2.0, 5.0) if m * power <= seconds * (1 + 1e-9)) * power)


def _under_way(
    manoeuvre: str, vessel: Vessel, angle: float, speed: float, reverses: float
) -> dict[str, Value]:
    """Tables of a manoeuvre that begins with an approach at a speed; a zig-zag reverses at a heading [deg]."""
    table, unit, step = vessel.manoeuvring, vessel.length / speed, _step(vessel, speed)
    execute, hold = (step * round(lengths * unit / step) for lengths in (BEFORE, HOLD))
    helm, heading = {"angle": radians(angle)}, {"heading": radians(reverses)}
    place = {"execute": execute, "length": vessel.length}
    own: dict[
        str, tuple[Mapping[str, Value], Mapping[str, Value], float]
    ] = {  # controller, measure, longest time
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
        "ahead": table.ahead,
        "steer": table.steer,
    }
    as_usual = manoeuvre != "zigzag" or reverses == abs(
        angle
    )  # the limits are those of 10/10 and 20/20
    bars = imo.limits(manoeuvre, angle, vessel.length, speed) if as_usual else {}
    return {
        "duration": min(duration, 86400.0),
        "step": step,
        "log": _rounded(unit / ROWS),
        "start": {"u": speed},
        "controller": {"use": manoeuvre, **handling, **controller},
        "camera": {"rate": min(max(1.0 / _rounded(unit / ROWS), 0.1), 6.0)},
        "measure": {"use": manoeuvre, **measure},
        "norms": {name: {"guard": [0.0, high]} for name, high in bars.items()},
        "until": {"turned": ROUND} if manoeuvre == "turning_circle" else {},
    }


def _released(vessel: Vessel, angle: float) -> dict[str, Value]:
    """Tables of a roll decay from a heel [deg]."""
    if "roll" not in vessel.dof:
        raise BadInput(f"{vessel.name} does not roll; its freedoms are {', '.join(vessel.dof)}")
    period = _roll_period(vessel)
    step = _rounded(period / 200)
    return {
        "duration": ROLLS * period,
        "step": step,
        "start": {"phi": radians(angle)},
        "controller": {"use": "open_loop", "period": step},
        "measure": "roll_decay",
    }


def _roll_period(vessel: Vessel) -> float:
    """Time [s] between two upward crossings of a small free roll. Raises BadInput for a hull that does not swing."""
    guess = 2.0 * float(
        np.sqrt(vessel.beam)
    )  # [s] of a ship of usual stability, GM a twentieth of the beam
    twin = Twin(vessel, guess / 400)
    start = [0.0] * (2 * _half(vessel))
    roll = [signal.symbol for signal in signals_of(vessel.dof)].index("phi")
    start[roll] = radians(1.0)
    rows = np.tile(twin.program.command_array({}), (8000, 1))
    phi = twin.rollout(start, rows, guess / 400)[:, roll]
    crossings = np.flatnonzero((phi[:-1] > 0.0) & (phi[1:] <= 0.0))
    if len(crossings) < 2:
        raise BadInput(f"{vessel.name} does not swing when it is heeled and released")
    return float(crossings[1] - crossings[0]) * guess / 400
