"""Line-of-sight path following: LOS, integral LOS and adaptive LOS with a heading autopilot."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import atan2, exp, hypot, isfinite, nan, pi, sqrt
from typing import Any, ClassVar

import numpy as np

from boatsim.control.base import Estimate, Sense, clip, wrap
from boatsim.control.guidance import LAWS, Guidance, LineOfSight
from boatsim.control.passive_observer import PassiveObserver
from boatsim.control.paths import Path, PathPoint, speed_profile
from boatsim.control.planned_path import PlannedPath
from boatsim.control.thrust_allocation import ThrustAllocator, with_weights
from boatsim.control.vessel_model import ModelBasedController, VesselModel
from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.base import UNSET, param

GRAVITY = 9.81  # [m/s^2]
# Froude number of the default speed, 1 m/s for a boat of 2.5 m: it makes hardly any waves, so
# that the drag is small and the thrusters have reserves for steering
CRUISE = 0.2
# Lengths of the vessel. The literature uses 2 to 5; docs/path_following.md shows the effect.
LOOKAHEAD_LENGTHS = 3.0
# Heading loop over the pole U / D of the cross-track error: its lag is a sixth of the time in which
# the error decays, so that it hardly delays the guidance
HEADING_SHARE = 6.0
# Integral gain of the heading over the cube of the natural frequency: the slowest pair of poles
# then has a damping ratio of 0.66; it removes the moment of a hull that slips sideways in a turn
INTEGRAL_SHARE = 0.2
# Integral gain of the speed over its proportional gain and the natural frequency, for a vessel
# without damping: critically damped. With damping the pole of the hull is cancelled if it is
# faster.
SPEED_SHARE = 0.25
STOPPING_LENGTHS = 5.0  # lengths within which the default acceleration stops from full speed
# Weight of a sway force that was not demanded: small, so that a rudder, whose moment comes with a
# side force, steers with 99.9 % of the demanded moment
SWAY_WEIGHT = 1e-3
YAW_WEIGHT = 10.0  # of the moment over the surge force: steering comes first at the limits
TOLERATED = 0.01  # of full thrust: a smaller difference of demanded and given force is rounding
# Of the speed: the reference for the speed at the end of a path may be this much astern
ASTERN_SHARE = 0.2
ENDS = ("pass", "stop")


@dataclass
class Los(PlannedPath, ModelBasedController):
    """Path following by line-of-sight guidance for any vessel with thrust ahead and steering.

    The guidance gives the heading, a speed profile the speed. A heading autopilot (PID with rate
    feed-forward) and a speed controller (PI) give the moment and the surge force, which a
    constrained allocation distributes to the thrusters of the vessel. No sway force is demanded.

    X = m w (u_d - u) + D_u u_d + z_X
    N = I (kp (psi_d - psi) + kd (r_d - r)) + D_r r_d + z_N

    with the natural frequency w, kp = w^2 and kd = 2 w - D_r / I, at least 0.
    """

    words: ClassVar[str] = (
        "path following by line of sight: waypoints, splines and Dubins paths, with a speed profile"
    )
    goals: ClassVar[tuple[str, ...]] = ("speed_mps",)

    period: float = param(
        0.1, low=0.001, high=10.0, unit="s", words="time between two control steps"
    )
    law: str = "adaptive"  # one of LAWS
    end: str = "pass"  # at the end of the path: "pass" it, or "stop" at low speed
    speed: float = param(
        UNSET,
        low=1e-3,
        high=30.0,
        unit="m/s",
        words="speed along the path without goal speed_mps; default: 0.2 sqrt(g L)",
    )
    lookahead: float = param(
        UNSET, low=1e-3, high=1e5, unit="m", words="look-ahead distance; default: three lengths"
    )
    guidance_damping: float = param(
        1.0, low=0.3, high=10.0, unit="", words="damping ratio of the integral or adaptive law"
    )
    natural_frequency: float = param(
        UNSET,
        low=0.001,
        high=10.0,
        unit="rad/s",
        words="bandwidth of heading and speed loop; default: 6 speed / lookahead",
    )
    turn_rate: float = param(
        UNSET,
        low=1e-4,
        high=10.0,
        unit="rad/s",
        words="turn rate in bends, which limits the speed; default: speed / turn_radius",
    )
    acceleration: float = param(
        UNSET,
        low=1e-5,
        high=10.0,
        unit="m/s^2",
        words="acceleration along the path; default: stops within five lengths",
    )
    weights: dict[str, float] = field(default_factory=dict)  # cost by name of the thruster

    def __post_init__(self) -> None:
        """Check the settings.

        Raises:
            BadInput: A parameter is out of bounds, or there is no such law, shape or end.
        """
        super().__post_init__()
        for name, value, allowed in (("law", self.law, LAWS), ("end", self.end, ENDS)):
            if value not in allowed:
                raise BadInput(unknown_name_message(f"Los: {name}", value, allowed))
        self._model: VesselModel | None = None

    def use_vessel_model(self, model: VesselModel) -> None:
        """Design guidance, autopilot and allocation for a vessel.

        Args:
            model: Low-speed model of the vessel.

        Raises:
            BadInput: There are no waypoints, or `weights` names a thruster that does not exist.
        """
        length = model.length
        self._path: Path = self.planned_path(length)
        self._cruise = CRUISE * sqrt(GRAVITY * length) if self.speed is UNSET else self.speed
        ahead = LOOKAHEAD_LENGTHS * length if self.lookahead is UNSET else self.lookahead
        self._guidance = LineOfSight(self.law, ahead, self.guidance_damping)
        self._bandwidth = self.natural_frequency
        if self.natural_frequency is UNSET:
            self._bandwidth = HEADING_SHARE * self._cruise / ahead
        self._acceleration = self.acceleration
        if self.acceleration is UNSET:
            self._acceleration = self._cruise**2 / (2.0 * STOPPING_LENGTHS * length)
        turn_rate = self.turn_rate
        if self.turn_rate is UNSET:
            turn_rate = self._cruise / self.radius_of_turns(length)
        self._profile = speed_profile(
            self._path,
            self._cruise,
            turn_rate,
            self._acceleration,
            0.0 if self.end == "stop" else self._cruise,
        )
        priorities = (1.0, SWAY_WEIGHT, YAW_WEIGHT)
        self._allocator = ThrustAllocator(with_weights(model.thrusters, self.weights), priorities)
        wave = sqrt(2.0 * pi * GRAVITY / length)
        self._observer = PassiveObserver(model.mass, model.damping, wave, self.period, False)
        self._model = model
        self.reset()

    def reset(self) -> None:
        """Reset guidance, observer, integral actions and thrusters."""
        self._started = False
        self._along = 0.0
        self._there = PathPoint(0.0, 0.0, 0.0, 0.0)  # foot point on the path
        self._wanted_speed = 0.0
        self._held = np.zeros(3)  # integral actions X, 0, N
        self._given = np.zeros(3)
        self._guided = Guidance(0.0, 0.0, 0.0, 0.0)
        if self._model is not None:
            self._guidance.reset()
            self._allocator.reset()

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Return the commands of all thrusters for the next period.

        Args:
            sense: Sensor readings; position and heading are needed at the first step. Afterwards
                the observer predicts missing ones.
            goal: `speed_mps`, the largest speed; without it the setting `speed`.

        Raises:
            BadInput: There is no position fix at the first step, or no model of the vessel.
        """
        if self._model is None:
            raise BadInput("los needs a model of its vessel; use_vessel_model gives it")
        measured = np.array([sense.x, sense.y, sense.psi])
        if not self._started and not np.isfinite(measured).all():
            raise BadInput(
                "los needs position and heading; [sensors] position_sd = 0.1 (or ideal = true) "
                "gives a position fix"
            )
        if not self._started:
            self._started = True
            self._observer.reset(measured)
            self._along = self._path.nearest(sense.x, sense.y)
            self._wanted_speed = max(sense.u, 0.0) if isfinite(sense.u) else 0.0
        else:
            self._observer.step(measured, self._given)
            sense = self._completed(sense)
            self._along = self._path.follow(sense.x, sense.y, self._along)
        self._there = self._path.point(self._along)
        u, v, r = self._velocity(sense)
        self._guide(sense, u, v)
        self._advance_speed(goal)
        self._control(sense.psi, u, r)
        return self._model.commands(self._allocator.setting)

    def _completed(self, sense: Sense) -> Sense:
        """Readings with the observer's position and heading where there are none."""
        values: dict[str, Any] = {}
        for name, estimate in zip(("x", "y", "psi"), self._observer.position, strict=True):
            if not isfinite(getattr(sense, name)):
                values[name] = float(estimate)
        return replace(sense, **values) if values else sense

    def _velocity(self, sense: Sense) -> tuple[float, float, float]:
        """Measured velocity over ground, completed by that of the observer."""
        known = self._observer.velocity.tolist()
        for i, measured in enumerate((sense.u, sense.v, sense.r)):
            if isfinite(measured):
                known[i] = measured
        return known[0], known[1], known[2]

    def _guide(self, sense: Sense, u: float, v: float) -> None:
        """Advance the guidance; near a stop the heading turns to that of the end of the path."""
        there = self._there
        course, speed = sense.psi + atan2(v, max(u, 1e-9)), hypot(max(u, 0.0), v)
        found = self._guidance.step(there, sense.x, sense.y, course, speed, self.period)
        if self.end == "stop":
            left = (self._path.length - self._along) / self._guidance.lookahead
            share = clip(left, 0.0, 1.0)
            turned = share * wrap(found.heading - there.course)
            found = found._replace(
                heading=there.course + turned, heading_rate=share * found.heading_rate
            )
        self._guided = found

    def _advance_speed(self, goal: Mapping[str, float]) -> None:
        """Move the wanted speed towards that of the profile, with limited acceleration."""
        most = goal.get("speed_mps", self._cruise)
        along = self._along
        wanted = min(self._profile.at(along), max(most, 0.0))
        if self.end == "stop":
            # near the end the speed is proportional to the distance, as a brake without end would
            # reach it with a step of the acceleration
            left = self._path.length - along
            slow = ASTERN_SHARE * self._cruise
            wanted = min(wanted, max(0.5 * self._bandwidth * left, -slow))
        room = self._acceleration * self.period
        self._wanted_speed += clip(wanted - self._wanted_speed, -2.0 * room, room)

    def _control(self, heading: float, u: float, r: float) -> None:
        """Compute the demanded force, allocate it, and advance the integral actions."""
        assert self._model is not None
        w = self._bandwidth
        inertia, drag = np.diag(self._model.mass), np.diag(self._model.damping)
        slow, off = self._wanted_speed - u, wrap(self._guided.heading - heading)
        rate = self._guided.heading_rate
        friction = max(2.0 * w - drag[2] / inertia[2], 0.0)
        surge = inertia[0] * w * slow + drag[0] * self._wanted_speed
        moment = inertia[2] * (w * w * off + friction * (rate - r)) + drag[2] * rate
        demand = np.array([surge, 0.0, moment]) + self._held
        self._given = self._allocator.step(demand, self.period).force
        missing = self._given - demand
        room = TOLERATED * self._allocator.scale
        excess = missing - np.clip(missing, -room, room)
        keep = 1.0 - exp(-w * self.period)
        surge_gain = w * max(drag[0], SPEED_SHARE * inertia[0] * w)
        gains = np.array([surge_gain, 0.0, INTEGRAL_SHARE * w**3 * inertia[2]])
        self._held += self.period * gains * np.array([slow, 0.0, off]) + keep * excess
        self._held[1] = 0.0

    @property
    def done(self) -> bool:
        """Whether the vessel has passed the end of the path."""
        return self.end == "pass" and self._started and self._along > self._path.length

    def estimates(self) -> dict[str, Estimate]:
        """Return the foot point on the path, heading and speed to steer, and the crab angle."""
        if self._model is None:
            return {}
        there = self._there
        values = {
            "reference_x_m": there.x,
            "reference_y_m": there.y,
            "reference_course_rad": there.course,
            "reference_psi_rad": self._guided.heading,
            "reference_u_mps": self._wanted_speed,
            "along_track_m": self._along,
            "cross_track_m": self._guided.cross_track,
            "crab_angle_rad": self._guided.crab_angle,
        }
        found: dict[str, Estimate] = {}
        for name, value in values.items():
            found[name] = Estimate(float(value), nan, nan)
        return found
