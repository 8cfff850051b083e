"""The turn.toml of a new boat: a first scenario with runs ahead, turns to both sides and a stop."""

import math
from collections.abc import Iterator

from boatsim.newboat.particulars import MAX_ANGLE, Particulars
from boatsim.newboat.vessel_text import (
    approach_thrust_share,
    differential_thrust,
    format_number,
    full_thrust,
    steering_angles,
)

STAGE_DURATION = 8.0  # [s] for a boat of the reference length, scaled by Froude's law for others
REFERENCE_LENGTH = 3.0  # [m]
HELM = 0.35  # [rad] 20 deg


def turn_scenario_text(boat: Particulars) -> str:
    """Return the text of turn.toml, the first scenario of a new boat: straight runs and turns.

    Args:
        boat: Particulars of the boat.
    """
    return "\n".join([*_scenario_lines(boat), ""])


def _scenario_lines(boat: Particulars) -> Iterator[str]:
    stage = round(STAGE_DURATION * math.sqrt(boat.hull.length / REFERENCE_LENGTH), 1)
    parts = _stage_commands(boat)
    yield "#!/usr/bin/env -S boatsim run"
    yield 'about = "Ahead, a turn to starboard and one to port, faster, and astern."'
    yield 'vessel = "vessel.toml"'
    yield f"duration = {format_number(stage * len(parts))}  # [s]"
    yield from ("", "[controller]", 'use = "open_loop"')
    for i, commands in enumerate(parts):
        yield from ("", "[[goal]]", f"from = {format_number(i * stage)}")
        for channel, value in commands.items():
            yield f"{channel} = {format_number(value)}"


def _stage_commands(boat: Particulars) -> list[dict[str, float]]:
    """Commands of each stage, within the ranges of the channels."""
    full, _ = full_thrust(boat)
    pairs = list(zip(boat.named_thrusters(), full, strict=True))
    angles = steering_angles(boat)
    by_thrust: dict[str, float] = {}
    if not angles:
        by_thrust = differential_thrust(boat)
    part = approach_thrust_share(boat)
    limit = boat.helm.most

    def commands_at(share: float, helm: float) -> dict[str, float]:
        found: dict[str, float] = {}
        for (name, mount), most in pairs:
            least = mount.largest_astern(most)
            force = share * most + helm * by_thrust.get(name, 0.0)
            force = min(max(force, -least), most)
            found[boat.law.channel_name(name)] = boat.law.command_for_thrust(force, most, least)
        for channel, gain in angles.items():
            found[channel] = min(max(helm * gain, -limit), limit)
        return found

    slow, fast = 0.6 * part, 1.6 * part
    return [
        commands_at(part, 0.0),
        commands_at(part, HELM),
        commands_at(part, -HELM),
        commands_at(fast, 0.0),
        commands_at(slow, -MAX_ANGLE),
        commands_at(-part, 0.0),
    ]
