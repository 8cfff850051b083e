"""L1 joystick with three closed loops, for a boat that measures its sway velocity."""

from dataclasses import dataclass
from functools import partial
from math import atan2, copysign, isnan, nan, sin
from typing import Any, ClassVar

from boatsim.control.adaptive import LoopChannel
from boatsim.control.allocation import (
    HEADING,
    command_outboards,
    limit,
    thrust_difference_for_sway,
)
from boatsim.control.axis import AXIS, filtered_disturbance
from boatsim.control.base import Estimate
from boatsim.control.compiled import merged, record_type, unlocked
from boatsim.control.joystick import AdaptiveJoystick, outboard_loop, surge_force, yaw_moment
from boatsim.control.operating_points import OperatingPoint, sampled_l1_law
from boatsim.physics.base import param

BRISK = 1.2  # times the rated sway: the thrust difference is about in the middle of its limits
# [m/s], [rad/s] excite the three loops in sway; large against the rounding of the commands, and
# small enough that the thrust difference keeps within its limits
PULSES = {"sway_mps": 0.005, "yaw_radps": 0.01, "surge_mps": 0.005}


@merged
def sway_thrust_difference(q: Any, m: Any, s: Any, wanted: float) -> float:
    """Return the thrust difference [N] of two outboards for a demanded sway speed.

    Without a sensor it is that of the open loop. It has the sign of the stick and a lower limit, so
    that the motors can always steer.

    Args:
        q: Parameters of the controller.
        m: State of the controller.
        s: Sensor readings.
        wanted: Demanded sway speed [m/s].
    """
    opened = thrust_difference_for_sway(q, wanted)
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
    return side * limit(side * spread, q.least_difference, q.largest_difference)


@unlocked
def law(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
    """Compute the outboard commands of a joystick controller from gyro, measured speeds and stick.

    Args:
        boats: Row numbers of the boats to process.
        settings: Parameters of each controller.
        memory: State of each controller.
        sense: Sensor readings of each boat.
        goal: Demands of each boat.
        sent: Commands of each boat, filled in.
    """
    for b in boats:
        q, m, s, g = settings[b], memory[b], sense[b], goal[b]
        moment = yaw_moment(q, m, s, g.yaw_radps)
        surge = surge_force(q, m, s, g.surge_mps)
        spread = sway_thrust_difference(q, m, s, g.sway_mps)
        room = q.pole * q.mass * abs(g.surge_mps)
        m.X, m.Y, m.N = command_outboards(q, surge, spread, moment, room, sent[b])
        m.acted = 1.0


@dataclass
class L1JoystickSway(AdaptiveJoystick):
    """L1 joystick with an additional L1 channel for the sway speed, if it is measured.

    The reference motion in sway is half as fast as in surge and yaw, because two small motors
    accelerate a hull whose sway added mass equals its own mass. Without a sway demand the motors do
    not work against each other for sway.
    """

    words: ClassVar[str] = (
        "L1 adaptive joystick with surge, sway and yaw closed, for a measured sway velocity"
    )
    law: ClassVar = law
    memory_type: ClassVar = record_type(
        "acted", "X", "Y", "N", yaw=AXIS, surge=AXIS, sway=AXIS, heading=HEADING
    )

    sway_mass: float = param(
        11.5, low=0.5, high=2000.0, unit="kg", words="assumed sway mass, added mass included"
    )
    sway_pole: float = param(
        0.7, low=0.05, high=10.0, unit="1/s", words="pole of the reference motion in sway"
    )
    sway_bandwidth: float = param(
        1.0, low=0.05, high=20.0, unit="rad/s", words="low-pass of the sway estimate"
    )
    least_difference: float = param(
        0.3, low=0.01, high=5.0, unit="N", words="least thrust difference while swaying"
    )

    def estimates_from(self, memory: Any) -> dict[str, Estimate]:
        """Return the estimated disturbances of yaw, surge and sway, and the reference motion."""
        sway = memory["sway"]
        return {
            **super().estimates_from(memory),
            "sigma_sway_N": Estimate(sway["sigma"], nan, nan),
            "reference_v_mps": Estimate(sway["model"], nan, nan),
        }

    def feedback_loops(self) -> tuple[LoopChannel, ...]:
        """Return the yaw, surge and sway feedback loops on a nominal boat with ideal actuators."""
        held = partial(LoopChannel, hold_s=0.5 * self.period, input_gain=(0.5, 1.0, 1.8))
        return (
            *super().feedback_loops(),
            held("sway", pole=self.sway_pole, bandwidth=self.sway_bandwidth),
        )

    def operating_points(self) -> tuple[OperatingPoint, ...]:
        """Return the steady motions at which the controller's loops are analysed on a vessel.

        In the last one all three loops are closed: thrust difference and steering angle both change
        sway force and yaw moment.
        """
        law = sampled_l1_law(self.sway_pole, self.sway_mass, self.sway_bandwidth, 0.0, self.period)
        loops = (outboard_loop(self, "Y", True, law), self.yaw_loop(True), self.surge_loop())
        goal, pulse = {"sway_mps": BRISK * self.rated_sway}, PULSES
        return (
            *super().operating_points(),
            OperatingPoint("all three in sway", loops, goal, pulse),
        )
