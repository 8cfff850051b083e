"""The L1 joystick with its sway closed too, for a boat that measures her sway velocity: three channels."""

from dataclasses import dataclass
from functools import partial
from math import atan2, copysign, isnan, nan, sin
from typing import Any, ClassVar

from boatsim.control.adaptive import LoopChannel
from boatsim.control.allocation import HEADING, set_outboards, sway_difference, within
from boatsim.control.axis import AXIS, filtered_disturbance
from boatsim.control.base import Estimate
from boatsim.control.compiled import merged, record, unlocked
from boatsim.control.joystick import SERVO_LAG, AdaptiveJoystick, surge_force, yaw_moment
from boatsim.physics.base import param


@merged
def sway_spread(q: Any, m: Any, s: Any, wanted: float) -> float:
    """Thrust difference [N] for a sway speed wanted [m/s]; without its sensor that of the open loop.

    It keeps the side of the stick and is never so small that the motors could not steer.
    """
    opened = sway_difference(q, wanted)
    if isnan(s.v):
        return opened
    felt = filtered_disturbance(
        m.sway,
        s.v,
        m.Y,
        m.acted != 0.0,
        wanted,
        q.sway_pole,
        q.sway_mass,
        q.sway_bandwidth,
        q.period,
    )
    if opened == 0.0:
        return 0.0
    spread = (q.sway_mass * q.sway_pole * wanted - felt) / sin(atan2(q.half_spacing, q.arm))
    side = copysign(1.0, wanted)
    return side * within(side * spread, q.least_difference, q.largest_difference)


@unlocked
def law(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
    """Commands for the next period from the gyro, what speeds are measured, and the stick."""
    for b in boats:
        q, m, s, g = settings[b], memory[b], sense[b], goal[b]
        moment = yaw_moment(q, m, s, g.yaw_radps)
        surge = surge_force(q, m, s, g.surge_mps)
        spread = sway_spread(q, m, s, g.sway_mps)
        room = q.pole * q.mass * abs(g.surge_mps)
        m.X, m.Y, m.N = set_outboards(q, surge, spread, moment, room, sent[b])
        m.acted = 1.0


@dataclass
class L1JoystickSway(AdaptiveJoystick):
    """As its base, and sway speed by an L1 channel of its own where a sensor gives it.

    The motion asked for in sway is half as fast as in surge and yaw: what two small motors can give a hull that takes
    her own mass of water with her. While the stick asks for no sway the motors do not work against each other for one.
    """

    words: ClassVar[str] = (
        "L1 adaptive joystick with surge, sway and yaw closed, for a measured sway velocity"
    )
    law: ClassVar = law
    memory_type: ClassVar = record(
        "acted", "X", "Y", "N", yaw=AXIS, surge=AXIS, sway=AXIS, heading=HEADING
    )

    sway_mass: float = param(
        11.5, low=0.5, high=2000.0, unit="kg", words="assumed sway mass, added mass included"
    )
    sway_pole: float = param(
        0.7, low=0.05, high=10.0, unit="1/s", words="pole of the sway asked for"
    )
    sway_bandwidth: float = param(
        1.0, low=0.05, high=20.0, unit="rad/s", words="low-pass of the sway estimate"
    )
    least_difference: float = param(
        0.3, low=0.01, high=5.0, unit="N", words="least thrust difference while swaying"
    )

    def estimates(self) -> dict[str, Estimate]:
        """The base's, and those of sway."""
        sway = self.remembered["sway"]
        return {
            **super().estimates(),
            "sigma_sway_N": Estimate(float(sway["sigma"]), nan, nan),
            "reference_v_mps": Estimate(float(sway["model"]), nan, nan),
        }

    def loop_channels(self) -> tuple[LoopChannel, ...]:
        """The base's, and sway."""
        delayed = partial(
            LoopChannel, hold_s=0.5 * self.period, servo_lag_s=SERVO_LAG, input_gain=(0.5, 1.0, 1.8)
        )
        return (
            *super().loop_channels(),
            delayed("sway", pole=self.sway_pole, bandwidth=self.sway_bandwidth),
        )
