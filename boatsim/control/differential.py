"""Control allocation of a surge force and a yaw moment to two propellers that cannot turn.

With the thrusts T_p and T_s, and the distances y_p < 0 < y_s of the propellers to starboard:

    X = T_p + T_s        N = -y_p T_p - y_s T_s

Yaw has priority over surge, because a boat that cannot turn cannot be steered clear of anything.
"""

from collections.abc import Sequence
from math import copysign, sqrt
from typing import Any

import numpy as np

from boatsim.control.allocation import limit
from boatsim.control.compiled import Records, record_type
from boatsim.control.thrust_allocation import Thruster
from boatsim.control.vessel_model import DriveCommands, VesselModel
from boatsim.errors import BadInput
from boatsim.physics.kernel.compiling import lean

# Distance to starboard [m]; smallest and largest thrust [N]; thrust over squared shaft rate
# [N s^2/rad^2], 0 for a command that is the thrust itself; thrust over commanded thrust
PROPELLER = record_type("side", "low", "high", "ahead", "astern", "gain")


@lean
def allocate_to_propellers(q: Any, surge: float, moment: float) -> tuple[float, float]:
    """Return the thrusts [N] of port and starboard propeller for a surge force and a yaw moment.

    The yaw moment is limited to what the propellers give with any surge force between zero and the
    demanded one, the surge force then to what they have left.

    Args:
        q: Record with the `PROPELLER` records `port` and `starboard`.
        surge: Surge force X [N].
        moment: Yaw moment N [N m].
    """
    port, starboard = q.port, q.starboard
    width = starboard.side - port.side
    a, b = starboard.side / width, -port.side / width  # shares of a surge force without a moment
    low, high = min(surge, 0.0), max(surge, 0.0)
    # largest difference ahead and astern, with the surge force at which both are at their limits
    best = limit(port.high + starboard.low, low, high)
    to_starboard = min(port.high - a * best, b * best - starboard.low)
    best = limit(starboard.high + port.low, low, high)
    to_port = min(starboard.high - b * best, a * best - port.low)
    difference = limit(moment / width, -to_port, to_starboard)
    least = max((port.low - difference) / a, (starboard.low + difference) / b)
    most = min((port.high - difference) / a, (starboard.high + difference) / b)
    total = limit(surge, least, max(least, most))
    return a * total + difference, b * total - difference


@lean
def command_for_thrust(p: Any, thrust: float) -> float:
    """Return the command at which a propeller has a thrust, in the unit of its channel.

    Args:
        p: `PROPELLER` record.
        thrust: Thrust [N].
    """
    wanted: float = thrust / p.gain
    if p.ahead == 0.0:
        return wanted
    per_square = p.ahead if wanted >= 0.0 else p.astern
    return copysign(sqrt(abs(wanted) / per_square), wanted) if per_square > 0.0 else 0.0


@lean
def thrust_at_command(p: Any, command: float) -> float:
    """Return the thrust [N] of a propeller at a command; the inverse of `command_for_thrust`.

    Args:
        p: `PROPELLER` record.
        command: Command, in the unit of the channel.
    """
    thrust: float = p.gain * command
    if p.ahead != 0.0:
        thrust *= (p.ahead if command >= 0.0 else p.astern) * abs(command)
    return thrust


def propeller_pair(model: VesselModel, controller: str) -> tuple[Records, Records, tuple[str, str]]:
    """Return the propellers of a vessel as records (1,), port first, and their command channels.

    Args:
        model: The vessel.
        controller: Name of the controller, for the message.

    Raises:
        BadInput: The vessel has other drives than one fixed propeller on each side.
    """
    found = sorted(zip(model.thrusters, model.drives, strict=True), key=lambda pair: _side(pair[0]))
    if not _is_pair([thruster for thruster, _ in found]):
        names = ", ".join(thruster.name for thruster in model.thrusters)
        raise BadInput(
            f"controller {controller} needs two fixed propellers that push ahead, one on each "
            f"side, and no other drive; {model.name} has {names}"
        )
    (port, left), (starboard, right) = found
    return _record(port, left), _record(starboard, right), (left.thrust, right.thrust)


def _is_pair(thrusters: Sequence[Thruster]) -> bool:
    """Whether thrusters, sorted by side, are one fixed propeller on each side."""
    if len(thrusters) != 2 or any(one.turns for one in thrusters):
        return False
    ahead = all(one.column[0] > 0.0 and one.column[1] == 0.0 for one in thrusters)
    return ahead and _side(thrusters[0]) < 0.0 < _side(thrusters[1])


def _side(thruster: Thruster) -> float:
    """Distance of a thruster to starboard [m]."""
    return -thruster.column[2]


def _record(thruster: Thruster, drive: DriveCommands) -> Records:
    """Propeller as a record (1,)."""
    row = (_side(thruster), thruster.low, thruster.high, drive.ahead, drive.astern, drive.gain)
    return np.array([row], PROPELLER)
