"""The turn.toml of a boat: a first scenario, ahead, turns to both sides and a stop, that shows what it can do."""

import math
from collections.abc import Iterator

from boatsim.newboat.particulars import Particulars
from boatsim.newboat.vessel_text import (
    TURNS,
    approach,
    full_thrust,
    number,
    steering,
    thrust_channel,
)

STAGE = 8.0  # [s] of each part on a boat of 3 m, by Froude's law on others
BOAT = 3.0  # [m]
HELM = 0.35  # [rad] 20 deg


def turn_text(boat: Particulars) -> str:
    """The whole file."""
    return "\n".join([*_lines(boat), ""])


def _lines(boat: Particulars) -> Iterator[str]:
    stage = round(STAGE * math.sqrt(boat.hull.length / BOAT), 1)
    parts = _stages(boat)
    yield "#!/usr/bin/env -S boatsim run"
    yield 'about = "Ahead, a turn to starboard and one to port, faster, and astern."'
    yield 'vessel = "vessel.toml"'
    yield f"duration = {number(stage * len(parts))}  # [s]"
    yield from ("", "[controller]", 'use = "open_loop"')
    for i, commands in enumerate(parts):
        yield from ("", "[[goal]]", f"from = {number(i * stage)}")
        yield from (f"{channel} = {number(value)}" for channel, value in commands.items())


def _stages(boat: Particulars) -> list[dict[str, float]]:
    """Commands of each part, within the channels' ranges."""
    full, _ = full_thrust(boat)
    pairs = list(zip(boat.named(), full, strict=True))
    steer, part = steering(boat), approach(boat)

    def at(share: float, helm: float) -> dict[str, float]:
        found = {thrust_channel(n): share * most for (n, _), most in pairs}
        for channel, gain in steer.items():
            found[channel] = found.get(channel, 0.0) + helm * gain
        for (n, m), most in pairs:
            least = most if m.astern is None else m.astern
            found[thrust_channel(n)] = min(max(found[thrust_channel(n)], -least), most)
        return found

    slow, fast = 0.6 * part, 1.6 * part
    return [
        at(part, 0.0),
        at(part, HELM),
        at(part, -HELM),
        at(fast, 0.0),
        at(slow, -TURNS),
        at(-part, 0.0),
    ]
