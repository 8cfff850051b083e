"""L1 adaptive joystick control of surge and yaw of a boat with two fixed propellers."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import partial
from math import nan, sqrt
from typing import Any, ClassVar

import numpy as np

from boatsim.control.allocation import HEADING
from boatsim.control.axis import AXIS
from boatsim.control.base import Estimate, clip
from boatsim.control.compiled import (
    CompiledController,
    Records,
    add_nested_records,
    record_type,
    unlocked,
)
from boatsim.control.differential import (
    PROPELLER,
    allocate_to_propellers,
    command_for_thrust,
    propeller_pair,
    thrust_at_command,
)
from boatsim.control.joystick import surge_force, yaw_moment
from boatsim.control.lag_design import HEADING_SHARE, POLE_SHARE, bandwidth_for_delay
from boatsim.control.operating_points import FeedbackLoop, OperatingPoint, sampled_l1_law
from boatsim.control.vessel_model import ModelBasedController, VesselModel
from boatsim.errors import BadInput
from boatsim.physics.base import UNSET, param

GRAVITY = 9.81  # [m/s^2]
LENGTH = 1.2  # [m] of the scale boat, for which `RESERVE` and the rates of turn below are stated
# [s] delay or lag of that boat in addition to the known ones; 95 % of drawn Otters, whose times are
# 1.3 times as long, survive an additional delay of 1 s with it (docs/robustness.md)
RESERVE = 0.3
RATED_TURN = 0.1396  # [rad/s] of that boat, 8 deg/s (Bayless 2017)
HOLD_RATE = 0.1  # [rad/s] of that boat: largest rate by which a heading error is reduced
TURN_RATE = 0.25  # [rad/s] of that boat: the same in a rated turn
SPEED = 0.2  # Froude number of the full stick: a speed at which a boat makes hardly any waves
THRUST_SHARE = 0.5  # of full thrust, which the speed at full stick needs at most
# The pole may rise to this share of the bandwidth, on a hull whose own damping is as fast: the
# reference motion then follows the hull, which reduces the error on the Otter by 40 % and keeps the
# delay that 95 % of drawn boats survive; equal to the bandwidth it would reduce that delay
DAMPED_SHARE = 0.75
# of the pole: the L1-norm condition needs more than 1, and noise of the speed log needs little
SURGE_SHARE = 1.2
# Steady motions at which the loops are analysed, as shares of the full stick
AHEAD, TURN = 0.5, 1.0
SURGE_PULSE, YAW_PULSE = 0.03, 0.04  # the same for the pulses that excite them there
SLOPE_STEP = 1e-4  # of the full thrust, over which slopes are taken

# X [N], N [N m]: values applied in the last period
REMEMBERS = record_type("acted", "X", "N", yaw=AXIS, surge=AXIS, heading=HEADING)


@unlocked
def law(boats: Any, settings: Any, memory: Any, sense: Any, goal: Any, sent: Any) -> None:
    """Compute the propeller commands of L1 joystick controllers for the next period.

    The inputs are gyro, surge speed if measured, and stick demands.

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
        port, starboard = allocate_to_propellers(q, surge, moment)
        sent[b].port = command_for_thrust(q.port, port)
        sent[b].starboard = command_for_thrust(q.starboard, starboard)
        m.X, m.N = port + starboard, -q.port.side * port - q.starboard.side * starboard
        m.acted = 1.0


@dataclass
class L1Differential(CompiledController, ModelBasedController):
    """L1 adaptive control of surge speed and yaw rate by the thrust of two fixed propellers.

    Its loops are those of `l1_joystick`, and so is the rule by which its gains follow from the lag
    of the vessel: with theta = period / 2 + lag + reserve the bandwidth of the low-pass in yaw is
    1 / (2 theta), the pole half of it (up to three quarters on a hull whose own damping is that
    fast), the low-pass in surge 1.2 times the pole. The reserve for unknown delays is 0.3 s for a
    boat of 1.2 m and grows with the square root of the length. Mass, inertia, thrust curves and
    places of the propellers are those of the vessel file. Goals: `surge_mps`, `yaw_radps`.
    """

    words: ClassVar[str] = (
        "L1 adaptive joystick of a boat with two fixed propellers: surge and yaw commands"
    )
    commands: ClassVar[tuple[str, ...]] = ("port", "starboard")  # fields of the law's output
    goals: ClassVar[tuple[str, ...]] = ("surge_mps", "yaw_radps")
    default_goals: ClassVar = {"surge_mps": 0.0, "yaw_radps": 0.0}
    tuned: ClassVar[tuple[str, ...]] = (
        "pole",
        "yaw_bandwidth",
        "surge_bandwidth",
        "heading_gain",
    )
    law: ClassVar = law
    memory_type: ClassVar = REMEMBERS

    pole: float = param(
        UNSET, low=0.001, high=10.0, unit="1/s", words="pole of the reference motion"
    )
    yaw_bandwidth: float = param(
        UNSET, low=0.001, high=20.0, unit="rad/s", words="low-pass of the yaw estimate"
    )
    surge_bandwidth: float = param(
        UNSET, low=0.001, high=20.0, unit="rad/s", words="low-pass of the surge estimate"
    )
    heading_gain: float = param(
        UNSET, low=0.0, high=5.0, unit="1/s", words="yaw rate demanded per heading error"
    )
    lag: float = param(
        UNSET,
        low=0.0,
        high=60.0,
        unit="s",
        words="known lag and delay of the propellers; default: that of the vessel",
    )
    inertia: float = param(
        UNSET,
        low=1e-6,
        high=1e12,
        unit="kg m^2",
        words="yaw inertia, added mass included; default: that of the vessel",
    )
    mass: float = param(
        UNSET,
        low=1e-3,
        high=1e10,
        unit="kg",
        words="surge mass, added mass included; default: that of the vessel",
    )
    rated_surge: float = param(
        UNSET, low=1e-3, high=30.0, unit="m/s", words="speed of the full stick"
    )
    rated_yaw: float = param(
        UNSET, low=1e-4, high=10.0, unit="rad/s", words="yaw rate of the full stick"
    )
    hold_rate: float = param(
        UNSET, low=1e-4, high=10.0, unit="rad/s", words="largest yaw rate without a yaw command"
    )
    turn_rate: float = param(
        UNSET, low=1e-4, high=10.0, unit="rad/s", words="largest yaw rate in a rated turn"
    )
    blind_surge: float = param(
        UNSET,
        low=0.0,
        high=1e9,
        unit="N s/m",
        words="surge force per m/s with no speed sensor; default: the damping of the vessel",
    )
    compass_trust: float = param(
        0.0, low=0.0, high=5.0, unit="1/s", words="rate at which the compass corrects the gyro"
    )

    def __post_init__(self) -> None:
        """Check the parameters.

        Raises:
            BadInput: A parameter is out of bounds.
        """
        self._pair: tuple[Records, Records] = np.zeros(1, PROPELLER), np.zeros(1, PROPELLER)
        self._channels: tuple[str, ...] = ()  # not known yet
        super().__post_init__()

    def use_vessel_model(self, model: VesselModel) -> None:
        """Derive the parameters that are not given from a vessel, and learn its propellers.

        Args:
            model: Low-speed model of the vessel.

        Raises:
            BadInput: The vessel has other drives than one fixed propeller on each side.
        """
        port, starboard, self._channels = propeller_pair(model, "l1_differential")
        self._pair = port, starboard
        froude = sqrt(model.length / LENGTH)  # ratio of times to those of the scale boat
        lag = model.lag if self.lag is UNSET else self.lag
        delay = 0.5 * self.period + lag + RESERVE * froude
        bandwidth = self.yaw_bandwidth
        if bandwidth is UNSET:
            bandwidth = bandwidth_for_delay(delay)
        inertia, drag = np.diag(model.mass).tolist(), np.diag(model.damping).tolist()
        own = min(drag[0] / inertia[0], drag[2] / inertia[2])  # [1/s] pole of the hull
        pole = clip(own, POLE_SHARE * bandwidth, DAMPED_SHARE * bandwidth)
        if self.pole is not UNSET:
            pole = self.pole
        speed = SPEED * sqrt(GRAVITY * model.length)
        if drag[0] > 0.0:
            speed = min(speed, THRUST_SHARE * self._full_thrust() / drag[0])
        design = {
            "pole": pole,
            "yaw_bandwidth": bandwidth,
            "surge_bandwidth": SURGE_SHARE * pole,
            "heading_gain": HEADING_SHARE * bandwidth,
            "lag": lag,
            "inertia": inertia[2],
            "mass": inertia[0],
            "rated_surge": speed,
            "rated_yaw": RATED_TURN / froude,
            "hold_rate": HOLD_RATE / froude,
            "turn_rate": TURN_RATE / froude,
            "blind_surge": max(drag[0], 0.0),
        }
        for name, value in design.items():
            if getattr(self, name) is UNSET:
                setattr(self, name, value)
        self.reset()

    def channels(self) -> tuple[str, ...]:
        """Return the command channels of the propellers, port first.

        Raises:
            BadInput: The controller has no model of a vessel.
        """
        if not self._channels:
            raise BadInput("l1_differential needs a model of its vessel; use_vessel_model gives it")
        return self._channels

    def settings_array(self, count: int = 1) -> Records:
        """Return the parameters and the propellers as an array of equal records for the law.

        Args:
            count: Number of equal controllers.
        """
        names = [f.name for f in fields(self) if "param" in f.metadata]
        row = tuple(float(getattr(self, name)) for name in names)
        records = np.full(count, np.array([row], record_type(*names)))
        port, starboard = self._pair
        return add_nested_records(records, port=port, starboard=starboard)

    def estimates_from(self, memory: Any) -> dict[str, Estimate]:
        """Return the estimated disturbances of yaw and surge, and the reference motion."""
        yaw, surge = memory["yaw"], memory["surge"]
        return {
            "sigma_yaw_Nm": Estimate(yaw["sigma"], nan, nan),
            "sigma_surge_N": Estimate(surge["sigma"], nan, nan),
            "reference_u_mps": Estimate(surge["model"], nan, nan),
            "reference_r_radps": Estimate(yaw["model"], nan, nan),
        }

    def largest_goals(self) -> Mapping[str, float]:
        """Return the joystick demands at full stick: largest speed [m/s] and turn rate [rad/s]."""
        return {"surge_mps": self.rated_surge, "yaw_radps": self.rated_yaw}

    def operating_points(self) -> tuple[OperatingPoint, ...]:
        """Return the steady motions at which the controller's loops are analysed on a vessel.

        Raises:
            BadInput: The controller has no model of a vessel.
        """
        self.channels()  # that it has one
        speed, rate = self.rated_surge, self.rated_yaw
        surge = self._loop("u", "X", "mass", "surge_bandwidth", 0.0)
        yaw = self._loop("r", "N", "inertia", "yaw_bandwidth", self.heading_gain)
        ahead, turn = {"surge_mps": AHEAD * speed}, {"yaw_radps": TURN * rate}
        pulse, blind = {"yaw_radps": YAW_PULSE * rate}, ("u", "v")
        faster = {"surge_mps": SURGE_PULSE * speed}
        return (
            OperatingPoint("surge", (surge,), ahead, faster, ("v",)),
            OperatingPoint("yaw ahead", (yaw,), ahead, pulse, blind),
            OperatingPoint("yaw in a turn", (yaw,), turn, pulse, blind),
        )

    def _loop(
        self, measured: str, axis: str, inertia: str, bandwidth: str, heading_gain: float
    ) -> FeedbackLoop:
        """Feedback of one velocity to the force or moment along its axis."""
        law = sampled_l1_law(
            self.pole,
            float(getattr(self, inertia)),
            float(getattr(self, bandwidth)),
            heading_gain,
            self.period,
        )
        return FeedbackLoop(
            measured, axis, law, partial(self._command_slopes, axis), lambda _: {axis: 1.0}
        )

    def _command_slopes(self, axis: str, commands: Mapping[str, float]) -> dict[str, float]:
        """Change of each command per unit of a surge force or yaw moment, at given commands."""
        port, starboard = self._pair
        step = SLOPE_STEP * self._full_thrust()
        width = float(starboard["side"][0] - port["side"][0])
        shares = {
            "X": (float(starboard["side"][0]) / width, -float(port["side"][0]) / width),
            "N": (1.0 / width, -1.0 / width),
        }[axis]
        slopes = {}
        for channel, drive, share in zip(self._channels, self._pair, shares, strict=True):
            thrust = thrust_at_command(drive[0], commands[channel])
            after = command_for_thrust(drive[0], thrust + step)
            before = command_for_thrust(drive[0], thrust - step)
            slopes[channel] = share * (after - before) / (2.0 * step)
        return slopes

    def _full_thrust(self) -> float:
        """Largest surge force ahead of both propellers [N]."""
        return float(sum(drive["high"][0] for drive in self._pair))
