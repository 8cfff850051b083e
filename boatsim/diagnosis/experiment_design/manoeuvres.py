"""Manoeuvres for any vessel: shares of its command limits, with times scaled by Froude's law."""

import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import radians

import numpy as np

from boatsim.diagnosis.command_range import manoeuvre_commands
from boatsim.diagnosis.config import DEFAULT, PlanConfig
from boatsim.diagnosis.problem import froude_scale
from boatsim.physics.vessel import Vessel

# duration [s]; shares of the limits of port and starboard drive, and of port and starboard angle
Step = tuple[float, float, float, float, float]


@dataclass(frozen=True)
class Manoeuvre:
    """A manoeuvre for the next experiment: commands over time, and how it starts and ends.

    Attributes:
        name: Name in a report.
        times: Times [s] from which the rows of `levels` hold.
        levels: Values of the commands.
        duration: Duration [s].
        switch_heading: Change of heading [rad] at which a zig-zag reverses its rudder; 0 if the
            commands change at `times`.
        under_way: Whether it begins at the speed of the recordings instead of at rest.
        to_wall: Whether it is placed so that it reaches a wall.
        release_angle: Roll angle [rad] at which the hull is released.
    """

    name: str
    times: tuple[float, ...] = (0.0,)
    levels: tuple[dict[str, float], ...] = ({},)
    duration: float = 0.0
    switch_heading: float = 0.0
    under_way: bool = False
    to_wall: bool = False
    release_angle: float = 0.0


SCRIPTS: dict[str, tuple[Step, ...]] = {
    "slow and fast astern, thrusters straight and turned": (
        (6, -0.4, -0.4, 0, 0), (6, -0.9, -0.9, 0, 0), (6, 0.6, 0.6, 0, 0),
        (6, -0.6, -0.6, 0.5, 0.5), (6, -0.6, -0.6, -0.5, -0.5), (10, 0.6, 0.6, 0, 0),
    ),
    "slow and fast spins on the spot, both ways round": (
        (10, 0.4, -0.4, 0, 0), (10, -0.4, 0.4, 0, 0), (10, 0.9, -0.9, 0, 0), (10, -0.9, 0.9, 0, 0),
    ),
    "runs at two speeds on opposite headings": (
        (6, 0.3, 0.3, 0, 0), (5, 0.9, 0.9, 0, 0), (12, 0.7, -0.7, 0, 0), (6, 0.3, 0.3, 0, 0),
        (6, 0.9, 0.9, 0, 0), (5, 0, 0, 0, 0),
    ),
    "crash stops from two speeds": (
        (8, 0.9, 0.9, 0, 0), (7, -0.9, -0.9, 0, 0), (3, 0, 0, 0, 0), (8, 0.5, 0.5, 0, 0),
        (7, -0.5, -0.5, 0, 0), (7, 0, 0, 0, 0),
    ),
    "drifts after short bursts ahead, turning and astern": (
        (4, 0.9, 0.9, 0, 0), (10, 0, 0, 0, 0), (3, 0.8, -0.8, 0, 0), (10, 0, 0, 0, 0),
        (4, -0.9, -0.9, 0, 0), (9, 0, 0, 0, 0),
    ),
    "zig-zag ahead, then astern": (
        (4, 0.6, 0.6, 0.6, 0.6), (4, 0.6, 0.6, -0.6, -0.6), (4, 0.6, 0.6, 0.6, 0.6),
        (4, 0.6, 0.6, -0.6, -0.6), (4, 0.6, 0.6, 0.6, 0.6),
        (4, -0.6, -0.6, -0.6, -0.6), (4, -0.6, -0.6, 0.6, 0.6), (4, -0.6, -0.6, -0.6, -0.6),
        (4, -0.6, -0.6, 0.6, 0.6), (4, -0.6, -0.6, -0.6, -0.6),
    ),
    "circles with two steering angles, both ways round": (
        (12, 0.6, 0.6, 0.3, 0.3), (8, 0.6, 0.6, -0.8, -0.8), (12, 0.6, 0.6, -0.3, -0.3),
        (8, 0.6, 0.6, 0.8, 0.8),
    ),
    "one thruster at a time, straight and turned, ahead and astern": (
        (5, 0.7, 0, 0, 0), (5, 0, 0.7, 0, 0), (5, -0.7, 0, 0, 0), (5, 0, -0.7, 0, 0),
        (5, 0.7, 0, 0.5, 0.5), (5, 0, 0.7, 0.5, 0.5), (5, -0.7, 0, 0.5, 0.5),
        (5, 0, -0.7, 0.5, 0.5),
    ),
    "thrust in steps from small to full, ahead and astern": (
        (4, 0.1, 0.1, 0, 0), (4, -0.1, -0.1, 0, 0), (4, 0.2, 0.2, 0, 0), (4, -0.2, -0.2, 0, 0),
        (4, 0.35, 0.35, 0, 0), (4, -0.35, -0.35, 0, 0), (4, 0.6, 0.6, 0, 0),
        (4, -0.6, -0.6, 0, 0), (4, 0.9, 0.9, 0, 0), (4, -0.9, -0.9, 0, 0),
    ),
}  # fmt: skip
TO_WALL: tuple[Step, ...] = (
    (8, 0.4, 0.4, 0, 0), (6, 0, 0, 0, 0), (6, -0.5, -0.5, 0, 0), (8, 0.4, 0.4, 0, 0),
    (6, 0, 0, 0, 0), (6, -0.5, -0.5, 0, 0),
)  # fmt: skip
# for ships, around the approach speed: shares of the usual drive and of the rudder's limit
SHIP_SCRIPTS: dict[str, tuple[Step, ...]] = {
    "turning circles with two rudder angles": ((40, 1, 1, 0.4, 0.4), (40, 1, 1, -0.9, -0.9)),
    "straight runs at three speeds": (
        (10, 1, 1, 0, 0), (25, 0.6, 0.6, 0, 0), (25, 0.8, 0.8, 0, 0), (20, 1, 1, 0, 0),
    ),
}  # fmt: skip
RANDOM_RUDDER = "rudder in random steps on several levels"


def available_manoeuvres(
    vessel: Vessel,
    usual_commands: Mapping[str, float],
    roll_angle: float,
    walls: bool,
    config: PlanConfig = DEFAULT.plan,
) -> tuple[Manoeuvre, ...]:
    """Return the manoeuvres that a vessel can perform, as candidates for the next experiment.

    A boat that can go astern performs manoeuvres around rest, other vessels around the speed of
    their recordings. A hull without commands is released at another roll angle; without roll
    either, there is no manoeuvre.

    Args:
        vessel: The vessel.
        usual_commands: Usual value of each command in the recordings.
        roll_angle: Largest roll angle in the recordings [rad].
        walls: Whether the walls of a tank are known.
        config: Settings of the manoeuvres.
    """
    if not vessel.commands:
        return _roll_releases(vessel, roll_angle, config)
    for name in manoeuvre_commands(vessel):
        if not _is_angle(name) and vessel.commands[name].low < 0:
            return _boat_manoeuvres(vessel, walls, config)
    return _ship_manoeuvres(vessel, usual_commands, config)


def _is_angle(command: str) -> bool:
    """Whether a command is a rudder or thruster angle; every other command drives."""
    return command.endswith("_rad")


def _duration(seconds: float, vessel: Vessel) -> float:
    """A duration of a hull of 1.2 m [s] for another vessel, to two digits."""
    return float(f"{seconds * froude_scale('s', vessel):.2g}")


def _roll_releases(vessel: Vessel, roll_angle: float, config: PlanConfig) -> tuple[Manoeuvre, ...]:
    if "roll" not in vessel.dof:
        return ()
    duration = _duration(config.boat_duration, vessel)
    found = []
    for share in config.release_shares:
        angle = min(share * roll_angle, config.max_release_angle)
        name = f"a release at {np.degrees(angle):.1f} deg of roll"
        found.append(Manoeuvre(name, duration=duration, release_angle=angle))
    return tuple(found)


def _boat_manoeuvres(vessel: Vessel, walls: bool, config: PlanConfig) -> tuple[Manoeuvre, ...]:
    scripts: dict[str, Sequence[Step]] = {}
    for seed, holds in (("quick", config.quick_holds), ("slow", config.slow_holds)):
        name = f"random steps of all commands on several levels, {seed}"
        scripts[name] = _random_script(seed, holds, config.boat_duration, config)
    scripts |= SCRIPTS
    found = []
    for name, script in scripts.items():
        found.append(_from_script(vessel, name, script, config))
    if walls:
        name = "slowly up to a wall and back, twice"
        found.append(_from_script(vessel, name, TO_WALL, config, to_wall=True))
    return tuple(filter(_moves, found))


def _ship_manoeuvres(
    vessel: Vessel, usual_commands: Mapping[str, float], config: PlanConfig
) -> tuple[Manoeuvre, ...]:
    scripts: dict[str, Sequence[Step]] = dict(SHIP_SCRIPTS)
    random = _random_script(RANDOM_RUDDER, config.ship_holds, config.ship_duration, config)
    scripts[RANDOM_RUDDER] = [(step[0], 1, 1, step[3], step[3]) for step in random]
    found = []
    for name, script in scripts.items():
        found.append(_from_script(vessel, name, script, config, usual_commands))
    if "yaw" in vessel.dof:
        for degrees in config.zigzag_angles:
            found.append(_zigzag(vessel, degrees, usual_commands, config))
    return tuple(filter(_varies, found))


def _moves(manoeuvre: Manoeuvre) -> bool:
    """Whether a manoeuvre has a command other than zero."""
    return any(any(level.values()) for level in manoeuvre.levels)


def _varies(manoeuvre: Manoeuvre) -> bool:
    """Whether the commands of a manoeuvre change."""
    return any(level != manoeuvre.levels[0] for level in manoeuvre.levels)


def _zigzag(
    vessel: Vessel, degrees: float, usual_commands: Mapping[str, float], config: PlanConfig
) -> Manoeuvre:
    """Zig-zag with equal rudder angle and change of heading [deg]."""
    angle = radians(degrees)
    sides: list[dict[str, float]] = []
    for sign in (1, -1):
        level = {}
        for name in manoeuvre_commands(vessel):
            command = vessel.commands[name]
            if _is_angle(name):
                level[name] = float(np.clip(sign * angle, command.low, command.high))
            else:
                level[name] = usual_commands.get(name, 0.0)
        sides.append(level)
    duration = _duration(config.ship_duration, vessel)
    name = f"{degrees:g}/{degrees:g} zig-zag"
    return Manoeuvre(name, (0.0, duration / 2), tuple(sides), duration, angle, True)


def _from_script(
    vessel: Vessel,
    name: str,
    script: Sequence[Step],
    config: PlanConfig,
    usual_commands: Mapping[str, float] | None = None,
    to_wall: bool = False,
) -> Manoeuvre:
    """Manoeuvre from a script.

    With usual commands, the drives are shares of them and the vessel is under way.
    """
    scale = froude_scale("s", vessel)
    tick = float(f"{config.command_tick * scale:.1g}")
    elapsed = [0.0]
    levels = []
    for step in script:
        elapsed.append(elapsed[-1] + step[0])
        level = {}
        for command in manoeuvre_commands(vessel):
            level[command] = _command(vessel, command, step, config, usual_commands)
        levels.append(level)
    ends = np.array(elapsed) * scale
    times = [round(t, 6) for t in (tick * np.round(ends / tick)).tolist()]
    return Manoeuvre(
        name,
        tuple(times[:-1]),
        tuple(levels),
        times[-1],
        under_way=usual_commands is not None,
        to_wall=to_wall,
    )


def _command(
    vessel: Vessel,
    name: str,
    step: Step,
    config: PlanConfig,
    usual_commands: Mapping[str, float] | None,
) -> float:
    """Value of a command in a step of a script, to three digits and within its limits."""
    command = vessel.commands[name]
    share = _share(vessel, name, step, config)
    if usual_commands is not None and not _is_angle(name):
        full = usual_commands.get(name, 0.0)
    elif share > 0:
        full = command.high
    else:
        full = -command.low
    value = float(f"{share * full:.3g}")
    return float(np.clip(value, command.low, command.high)) + 0.0  # no negative zero


def _share(vessel: Vessel, name: str, step: Step, config: PlanConfig) -> float:
    """Share of its limit that a command has in a step.

    A vessel without steering angles is steered by unequal thrust.
    """
    _, port, starboard, port_angle, starboard_angle = step
    if _is_angle(name):
        port = port_angle
        starboard = starboard_angle
    elif port == starboard != 0.0 and not any(map(_is_angle, vessel.commands)):
        port = port + config.steering_difference * port_angle
        starboard = starboard - config.steering_difference * starboard_angle
    shares = {-1: port, 0: 0.5 * (port + starboard), 1: starboard}
    return shares[vessel.side(name)]


def _random_script(
    seed: str, holds: Sequence[float], total: float, config: PlanConfig
) -> tuple[Step, ...]:
    """Steps of all commands to random levels, with a random hold; seeded by a name."""
    rng = np.random.default_rng(zlib.crc32(seed.encode()))
    tick = config.command_tick
    shortest, longest = holds
    steps: list[Step] = []
    remaining = total
    while remaining > 0:
        hold = min(round(rng.uniform(shortest, longest) / tick) * tick, remaining)
        signs = rng.choice((-1.0, 1.0), 4)
        a, b, c, d = (signs * rng.choice(config.random_levels, 4)).tolist()
        steps.append((hold, a, b, c, d))
        remaining = total - sum(step[0] for step in steps)
    return tuple(steps)
