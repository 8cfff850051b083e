"""Manoeuvres that show a boat: for any vessel, as shares of its command limits, with times by Froude's law."""

import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from math import radians

import numpy as np

from boatsim.diagnosis.problem import froude_scale
from boatsim.physics.vessel import Vessel

LONG, LONG_SHIP = (
    40.0,
    80.0,
)  # [s] a manoeuvre of a 1.2 m boat, or ship model, lasts; other lengths by Froude's law
TICK = 0.5  # [s] of the same boat, on which commands change
LEVELS = (0.15, 0.35, 0.6, 0.9)  # shares of a command's limit that random steps take
# seconds held; shares of the limits of drive port and starboard, and of angle port and starboard
Step = tuple[float, float, float, float, float]


@dataclass(frozen=True)
class Manoeuvre:
    """Commands in time: from each time on, until the next, the levels of its row."""

    words: str  # what a report calls it
    times: tuple[float, ...] = (0.0,)  # [s]
    levels: tuple[dict[str, float], ...] = ({},)  # command -> value
    duration: float = LONG  # [s]
    # [rad] off the first course at which a zig-zag changes over; 0: levels change by the clock
    heading: float = 0.0
    under_way: bool = False  # begins at the speed of the recordings, not at rest
    to_wall: bool = False  # is laid so that it reaches a wall
    heel: float = 0.0  # [rad] roll angle it is released at


SCRIPTS: dict[str, tuple[Step, ...]] = {
    "slow and fast astern, thrusters straight and turned": (
        (6, -0.4, -0.4, 0, 0), (6, -0.9, -0.9, 0, 0), (6, 0.6, 0.6, 0, 0), (6, -0.6, -0.6, 0.5, 0.5),
        (6, -0.6, -0.6, -0.5, -0.5), (10, 0.6, 0.6, 0, 0),
    ),
    "slow and fast spins on the spot, both ways round": (
        (10, 0.4, -0.4, 0, 0), (10, -0.4, 0.4, 0, 0), (10, 0.9, -0.9, 0, 0), (10, -0.9, 0.9, 0, 0),
    ),
    "runs at two speeds on opposite headings": (
        (6, 0.3, 0.3, 0, 0), (5, 0.9, 0.9, 0, 0), (12, 0.7, -0.7, 0, 0), (6, 0.3, 0.3, 0, 0), (6, 0.9, 0.9, 0, 0),
        (5, 0, 0, 0, 0),
    ),
    "crash stops from two speeds": (
        (8, 0.9, 0.9, 0, 0), (7, -0.9, -0.9, 0, 0), (3, 0, 0, 0, 0), (8, 0.5, 0.5, 0, 0), (7, -0.5, -0.5, 0, 0),
        (7, 0, 0, 0, 0),
    ),
    "drifts after short bursts ahead, turning and astern": (
        (4, 0.9, 0.9, 0, 0), (10, 0, 0, 0, 0), (3, 0.8, -0.8, 0, 0), (10, 0, 0, 0, 0), (4, -0.9, -0.9, 0, 0),
        (9, 0, 0, 0, 0),
    ),
    "zig-zag ahead, then astern": (
        *((4, 0.6, 0.6, s * 0.6, s * 0.6) for s in (1, -1, 1, -1, 1)),
        *((4, -0.6, -0.6, s * 0.6, s * 0.6) for s in (-1, 1, -1, 1, -1)),
    ),
    "circles with two steering angles, both ways round": (
        (12, 0.6, 0.6, 0.3, 0.3), (8, 0.6, 0.6, -0.8, -0.8), (12, 0.6, 0.6, -0.3, -0.3), (8, 0.6, 0.6, 0.8, 0.8),
    ),
    "one thruster at a time, straight and turned, ahead and astern": tuple(
        (5, p * level, (1 - p) * level, angle, angle)
        for level, angle in ((0.7, 0), (-0.7, 0), (0.7, 0.5), (-0.7, 0.5)) for p in (1, 0)
    ),
    "thrust in steps from small to full, ahead and astern": tuple(
        (4, sign * level, sign * level, 0, 0) for level in (0.1, 0.2, 0.35, 0.6, 0.9) for sign in (1, -1)
    ),
}  # fmt: skip
TO_WALL: tuple[Step, ...] = (
    (8, 0.4, 0.4, 0, 0), (6, 0, 0, 0, 0), (6, -0.5, -0.5, 0, 0), (8, 0.4, 0.4, 0, 0), (6, 0, 0, 0, 0),
    (6, -0.5, -0.5, 0, 0),
)  # fmt: skip
# share of the drive's limit on each side for a full steering angle, where no thruster turns
DIFFERENCE = 0.5
RANDOM = {"quick": (1.0, 3.0), "slow": (4.0, 8.0)}  # [s] shortest and longest hold
SHIP: dict[
    str, tuple[Step, ...]
] = {  # about approach speed: shares of the drive in use, and of the rudder's limit
    "turning circles with two rudder angles": ((40, 1, 1, 0.4, 0.4), (40, 1, 1, -0.9, -0.9)),
    "straight runs at three speeds": (
        (10, 1, 1, 0, 0),
        (25, 0.6, 0.6, 0, 0),
        (25, 0.8, 0.8, 0, 0),
        (20, 1, 1, 0, 0),
    ),
    "rudder in random steps on several levels": (),
}
ZIGZAGS = (
    10.0,
    20.0,
)  # [deg] rudder and heading, as the IMO's standards for manoeuvrability (MSC.137(76)) have them
HEELS = (0.5, 1.5)  # of the largest roll angle recorded
STEEPEST = 0.5  # [rad] roll angle a release is proposed for


def menu(
    vessel: Vessel, in_use: dict[str, float], heel: float, walls: bool
) -> tuple[Manoeuvre, ...]:
    """What this vessel can do: `in_use` are its commands' usual values, `heel` the largest roll angle recorded [rad].

    A boat that can go astern is steered about rest; others about the speed they came with; a hull without any command
    is released at another roll angle.
    """
    if not vessel.commands:
        found = [min(share * heel, STEEPEST) for share in HEELS]
        length = float(f"{LONG * froude_scale('s', vessel):.2g}")
        return tuple(
            Manoeuvre(f"a release at {np.degrees(a):.1f} deg of roll", duration=length, heel=a)
            for a in found
        )
    drives = [c for n, c in vessel.commands.items() if n in commanded(vessel) and not _turns(n)]
    if any(c.low < 0 for c in drives):
        return _boat(vessel, walls)
    return _ship(vessel, in_use)


def commanded(vessel: Vessel) -> tuple[str, ...]:
    """Commands a manoeuvre uses: a command that feeds an actuator (PWM) takes its place."""
    fed = {a for e in vessel.effects for a in vessel.targets(e) if vessel.feeding_command(e, a)}
    return tuple(n for n in vessel.commands if n not in fed)


def _turns(command: str) -> bool:
    """A rudder or thruster angle; every other command drives."""
    return command.endswith("_rad")


def _boat(vessel: Vessel, walls: bool) -> tuple[Manoeuvre, ...]:
    scripts = {
        f"random steps of all commands on several levels, {k}": _random(k, *v)
        for k, v in RANDOM.items()
    }
    found = [
        _from_script(vessel, words, script) for words, script in {**scripts, **SCRIPTS}.items()
    ]
    if walls:
        found.append(
            _from_script(vessel, "slowly up to a wall and back, twice", TO_WALL, to_wall=True)
        )
    return tuple(m for m in found if any(any(level.values()) for level in m.levels))


def _ship(vessel: Vessel, in_use: dict[str, float]) -> tuple[Manoeuvre, ...]:
    found = []
    for words, script in SHIP.items():
        script = script or tuple(
            (t, 1, 1, a, a) for t, _, _, a, _ in _random(words, 4.0, 12.0, LONG_SHIP)
        )
        found.append(_from_script(vessel, words, script, in_use))
    for degrees in ZIGZAGS if "yaw" in vessel.dof else ():
        angle = radians(degrees)
        both = tuple(
            {
                n: float(np.clip(s * angle, c.low, c.high)) if _turns(n) else in_use.get(n, 0.0)
                for n, c in vessel.commands.items()
                if n in commanded(vessel)
            }
            for s in (1, -1)
        )
        length = float(f"{LONG_SHIP * froude_scale('s', vessel):.2g}")
        words = f"{degrees:g}/{degrees:g} zig-zag"
        found.append(Manoeuvre(words, (0.0, length / 2), both, length, angle, True))
    return tuple(m for m in found if len({tuple(level.items()) for level in m.levels}) > 1)


def _from_script(
    vessel: Vessel,
    words: str,
    script: Sequence[Step],
    in_use: dict[str, float] | None = None,
    to_wall: bool = False,
) -> Manoeuvre:
    """A script for this vessel; with `in_use` the drive is a share of that and the boat is under way."""
    scale = froude_scale("s", vessel)
    tick = float(f"{TICK * scale:.1g}")
    ends = np.cumsum([0.0, *(step[0] for step in script)]) * scale
    times = [round(float(tick * np.round(t / tick)), 6) for t in ends]
    levels = tuple(
        {n: _level(vessel, n, step, in_use) for n in commanded(vessel)} for step in script
    )
    return Manoeuvre(words, tuple(times[:-1]), levels, times[-1], 0.0, in_use is not None, to_wall)


def _level(vessel: Vessel, name: str, step: Step, in_use: dict[str, float] | None) -> float:
    """Value of one command in a step of a script, to three digits and inside its limits."""
    channel = vessel.commands[name]
    port, starboard = step[3:] if _turns(name) else step[1:3]
    straight = port == starboard != 0.0 and not any(_turns(n) for n in vessel.commands)
    if straight and not _turns(name):  # steered by pushing harder on one side
        port, starboard = port + DIFFERENCE * step[3], starboard - DIFFERENCE * step[4]
    share = {-1: port, 0: 0.5 * (port + starboard), 1: starboard}[vessel.side(name)]
    limit = channel.high if share > 0 else -channel.low
    value = share * (in_use.get(name, 0.0) if in_use is not None and not _turns(name) else limit)
    return float(np.clip(float(f"{value:.3g}"), channel.low, channel.high)) + 0.0


def _random(seed: str, shortest: float, longest: float, total: float = LONG) -> tuple[Step, ...]:
    """Every command jumps to a level of its own; seeded by the name alone."""
    rng = np.random.default_rng(zlib.crc32(seed.encode()))
    steps: list[Step] = []
    while (left := total - sum(step[0] for step in steps)) > 0:
        held = min(round(rng.uniform(shortest, longest) / TICK) * TICK, left)
        shares = rng.choice((-1.0, 1.0), 4) * rng.choice(LEVELS, 4)
        steps.append((held, *(float(share) for share in shares)))  # type: ignore[arg-type]
    return tuple(steps)
