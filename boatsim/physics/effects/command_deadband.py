"""Command dead band: small commands have no effect, and full commands keep their full effect."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Boat, ChannelEffect, SignalSegment, param
from boatsim.physics.kinds.channel import COMMANDS
from boatsim.physics.param import name_code_parameter


@njit(inline="always")
def apply_command_deadband(x: float, q: Any) -> float:
    """Return the thrust of a command of which a share of full command has no effect.

    Args:
        x: Thrust command [N].
        q: Parameters with `share`, and with the full thrusts `full_ahead` and `full_astern` [N]; a
            command in a direction without a full thrust is returned unchanged.
    """
    full = q.full_ahead if x > 0.0 else q.full_astern
    if not full > 0.0:
        return x
    effective = max(abs(x) - q.share * full, 0.0) / (1.0 - q.share)
    return effective if x > 0.0 else -effective


@njit(inline="always")
def transform_signal(
    x: SignalSegment, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> SignalSegment:
    """Return the thrust of a drive whose commands have a dead band, at each of the three instants.

    Args:
        x: Signal of the actuator before the effect, at begin, middle and end of the step.
        side: -1 on the port side, +1 on the starboard side, 0 on the centreline.
        source: Raw command that feeds the channel (`fed_by`).
        memory: Memory of the compiled program.
        at: Index of the first slot of this effect in `memory`.
        dt: Length of the step [s].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        The signal of the actuator after the effect, over the same step.
    """
    return SignalSegment(
        apply_command_deadband(x.begin, q),
        apply_command_deadband(x.middle, q),
        apply_command_deadband(x.end, q),
    )


@dataclass(frozen=True)
class CommandDeadband(ChannelEffect):
    """Dead band of a throttle or motor controller, as a share of full command in each direction.

    y = sign(x) (|x| - d T) / (1 - d)  for |x| > d T, else 0,  with the largest command T of the
    drives ahead or astern

    Full thrust is unchanged. The loss by friction of a motor, `thrust_deadband`, is the same force
    in both directions instead. Where the limits are the same ahead and astern, both effects differ
    only in the thrust of all commands.
    """

    formula: ClassVar[str] = (
        r"y = \operatorname{sgn}(x) \, \frac{\max(|x| - d \, T, \, 0)}{1 - d}, \quad "
        r"T = \begin{cases} T_+ & x > 0 \\ T_- & x < 0 \end{cases}"
    )
    symbols: ClassVar = {"share": "d", "full_ahead": "T_+", "full_astern": "T_-"}
    words: ClassVar[str] = (
        "commands below a share of full command have no effect, and full commands keep theirs"
    )
    shown_by: ClassVar[str] = "slow runs at several small thrust levels"
    source: ClassVar[str] = "the dead band about neutral of motor controllers and throttle levers"
    acts_on: ClassVar[str] = "thrust"
    stage: ClassVar[int] = COMMANDS
    limits_differ: ClassVar[bool] = True
    transform_signal: ClassVar = transform_signal
    starts: ClassVar = ({"share": 0.05}, {"share": 0.15}, {"share": 0.3})

    share: float = param(
        0.0,
        low=0.0,
        high=0.8,
        unit="",
        words="d: share of full command that has no effect",
        fit=True,
        spread=0.15,
    )
    full_ahead: float = name_code_parameter("largest command ahead")
    full_astern: float = name_code_parameter("largest command astern")

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the largest commands [N] ahead and astern of the drives on which it acts.

        Args:
            vessel: Vessel on which the effect acts.
        """
        ahead, astern = self.largest_commands(vessel)
        return {"full_ahead": ahead, "full_astern": astern}
