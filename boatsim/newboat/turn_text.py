"""The turn.toml of a new boat: a first scenario with runs ahead, turns to both sides and a stop."""

import math
from collections.abc import Iterator

from boatsim.newboat.particulars import Particulars
from boatsim.newboat.vessel_text import (
    MAX_ANGLE,
    approach_thrust_share,
    format_number,
    full_thrust,
    steering_commands,
    thrust_channel,
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
    steer = steering_commands(boat)
    part = approach_thrust_share(boat)

    def at(share: float, helm: float) -> dict[str, float]:
        found = {thrust_channel(n): share * most for (n, _), most in pairs}
        for channel, gain in steer.items():
            found[channel] = found.get(channel, 0.0) + helm * gain
        for (n, m), most in pairs:
            least = m.largest_astern(most)
            found[thrust_channel(n)] = min(max(found[thrust_channel(n)], -least), most)
        return found

    slow, fast = 0.6 * part, 1.6 * part
    return [
        at(part, 0.0),
        at(part, HELM),
        at(part, -HELM),
        at(fast, 0.0),
        at(slow, -MAX_ANGLE),
        at(-part, 0.0),
    ]
