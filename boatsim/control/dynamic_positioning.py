"""Dynamic positioning: base of controllers that hold a pose or follow a moving reference.

The controllers `dp` and `dock` differ in the motion of the reference.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import cos, exp, isfinite, nan, pi, sin, sqrt

import numpy as np

from boatsim.control.base import Estimate, Sense
from boatsim.control.passive_observer import PassiveObserver
from boatsim.control.reference_motion import ReferenceMotion
from boatsim.control.thrust_allocation import ThrustAllocator, with_weights
from boatsim.control.vessel_model import ModelBasedController, VesselModel
from boatsim.errors import BadInput
from boatsim.physics.base import UNSET, Array, param

GRAVITY = 9.81  # [m/s^2]
# of the wave frequency: slow enough that thrusters ignore the waves that pass the notch, and fast
# enough for slow drift, with periods of one to two minutes for a ship of 80 m (Fossen 2021, 13.1)
BANDWIDTH_SHARE = 0.1
# of the natural frequency: the integral action is ten times slower than the loop (Fossen 2021,
# section 15.3.4)
INTEGRAL_SHARE = 0.1
# of its largest thrust: below it an azimuth thruster turns slowly, as its direction matters little
CALM = 0.1
# of full thrust: a smaller difference between demanded and given force is that of the allocation
# and no saturation. The integral action must not react to it, or a mean error would remain.
TOLERATED = 0.01
LOW_SPEED = 0.02  # Froude number of the default speed: 0.6 m/s for a ship of 80 m
GOALS = ("x_m", "y_m", "psi_rad")
AXES = ("X_N", "Y_N", "N_Nm")


@dataclass
class DynamicPositioning(ModelBasedController):
    """Station keeping and low-speed tracking for any set of thrusters.

    A nonlinear passive observer estimates the motion without waves and the velocity from position
    and heading. A PID law with a feed-forward of the measured wind gives the demanded force, which
    a constrained allocation distributes to the thrusters of the vessel. A derived class moves the
    reference.

    tau = -Kp e - Kd (nu - nu_d) - R' z + M a_d + D nu_d - tau_wind,  z' = 0.1 w Kp e

    Kp = M w^2 and Kd = 2 zeta w M - D, with the natural frequency w; an axis whose damping exceeds
    2 zeta w has Kd = 0 and Kp = M w (D / M - w), so that its slow pole is w.
    """

    period: float = param(
        0.5, low=0.001, high=10.0, unit="s", words="time between two control steps"
    )
    wave_frequency: float = param(
        UNSET,
        low=0.1,
        high=20.0,
        unit="rad/s",
        words="peak frequency of the waves; default: that of waves as long as the vessel",
    )
    natural_frequency: float = param(
        UNSET,
        low=0.001,
        high=10.0,
        unit="rad/s",
        words="bandwidth of the control loop; default: 0.1 of the wave frequency",
    )
    damping_ratio: float = param(1.0, low=0.3, high=3.0, unit="", words="damping ratio zeta")
    speed: float = param(
        UNSET,
        low=1e-3,
        high=10.0,
        unit="m/s",
        words="largest speed to a new goal without goal speed_mps; default: 0.02 sqrt(g L)",
    )
    singularity: float = param(
        1.0, low=0.0, high=100.0, unit="", words="cost of thrusters that all point alike"
    )
    yaw_priority: float = param(
        3.0, low=0.01, high=1e3, unit="", words="weight of the moment if the demand is too large"
    )
    integral: bool = True  # integral action
    wave_filter: bool = True  # False: the observer follows the motion in waves
    wind_feedforward: bool = True  # where the vessel has wind coefficients and an anemometer
    weights: dict[str, float] = field(default_factory=dict)  # cost by name of the thruster
    unused: Sequence[str] = ()  # thrusters that are out of service

    def __post_init__(self) -> None:
        """Check the parameters.

        Raises:
            BadInput: A parameter is out of bounds.
        """
        super().__post_init__()
        self._model: VesselModel | None = None

    def use_vessel_model(self, model: VesselModel) -> None:
        """Design observer, control law and allocation for a vessel.

        Args:
            model: Low-speed model of the vessel.

        Raises:
            BadInput: `weights` or `unused` names a thruster that does not exist, or none is left.
        """
        model = model.without([self.unused] if isinstance(self.unused, str) else self.unused)
        self._model = model
        self._wave = self.wave_frequency
        if self.wave_frequency is UNSET:
            self._wave = sqrt(2.0 * pi * GRAVITY / model.length)
        self._bandwidth = self.natural_frequency
        if self.natural_frequency is UNSET:
            self._bandwidth = BANDWIDTH_SHARE * self._wave
        self._speed = self.speed
        if self.speed is UNSET:
            self._speed = LOW_SPEED * sqrt(GRAVITY * model.length)
        self._allocator = ThrustAllocator(
            with_weights(model.thrusters, self.weights),
            (1.0, 1.0, self.yaw_priority),
            self.singularity,
            CALM,
        )
        self._observer = PassiveObserver(
            model.mass, model.damping, self._wave, self.period, self.wave_filter
        )
        self._reference = ReferenceMotion(4.0 / self._bandwidth)
        self._design_gains(model)
        self.reset()

    def _design_gains(self, model: VesselModel) -> None:
        """Gains of the PID law by the natural frequency, axis by axis."""
        w, zeta = self._bandwidth, self.damping_ratio
        inertia, drag = np.diag(model.mass), np.diag(model.damping)
        self._stiffness, self._friction = np.zeros(3), np.zeros(3)
        for i in range(3):
            rate = drag[i] / inertia[i]
            if rate < 2.0 * zeta * w:
                self._stiffness[i] = inertia[i] * w * w
                self._friction[i] = 2.0 * zeta * w * inertia[i] - drag[i]
            else:
                self._stiffness[i] = inertia[i] * w * max(w, rate - w)
        self._integral_gain = INTEGRAL_SHARE * w * self._stiffness * float(self.integral)

    def reset(self) -> None:
        """Reset observer, reference, integral action and thrusters."""
        self._started = False
        self._slow_force = np.zeros(3)  # integral action in earth axes
        self._wind = np.zeros(3)
        self._demand = np.zeros(3)
        self._given = np.zeros(3)
        if self._model is not None:
            self._allocator.reset()

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Return the commands of all thrusters for the next period.

        In an outage of position or heading the observer predicts them.

        Args:
            sense: Sensor readings; position and heading are needed at the first step.
            goal: `x_m`, `y_m` and `psi_rad`, by default those at the start, and `speed_mps`, the
                largest speed to them.

        Raises:
            BadInput: There is no position fix at the first step, or no model of the vessel.
        """
        if self._model is None:
            raise BadInput(f"{self._name} needs a model of its vessel; use_vessel_model gives it")
        measured = np.array([sense.x, sense.y, sense.psi])
        if not self._started and not np.isfinite(measured).all():
            raise BadInput(
                f"{self._name} needs position and heading; [sensors] position_sd = 0.1 (or ideal = "
                "true) gives a position fix"
            )
        if not self._started:
            self._started = True
            self._observer.reset(measured)
            self.start_reference(measured)
        else:
            self._observer.step(measured, self._given + self._wind)
        self.advance_reference(goal)
        self._wind = self._wind_force(sense)
        self._control()
        return self._model.commands(self._allocator.setting)

    @property
    def _name(self) -> str:
        """Name of the controller in messages."""
        return type(self).__name__.lower()

    def start_reference(self, measured: Array) -> None:
        """Place the reference at the first measured pose.

        Args:
            measured: x, y [m] and heading [rad] (3,).
        """
        self._reference.reset(measured)
        self._start = measured

    def advance_reference(self, goal: Mapping[str, float]) -> None:
        """Move the reference by one period; derived classes do this.

        Args:
            goal: Set points by name.
        """
        raise NotImplementedError

    def _wind_force(self, sense: Sense) -> Array:
        """Force of the measured wind in body axes, through a low-pass at the wave frequency."""
        assert self._model is not None
        speed, origin = (sense.more.get(n, nan) for n in ("wind_mps", "wind_from_rad"))
        known = isfinite(speed) and isfinite(origin) and self._model.wind is not None
        if not (self.wind_feedforward and known):
            return np.zeros(3)
        assert self._model.wind is not None
        force = self._model.wind.force(-speed * cos(origin), -speed * sin(origin))
        share = 1.0 - exp(-self._wave * self.period)
        return self._wind + share * (np.array(force) - self._wind)

    def _control(self) -> None:
        """Compute the demanded force, allocate it, and advance the integral action."""
        assert self._model is not None
        estimate, reference = self._observer, self._reference
        turn = rotation(estimate.position[2])
        error = estimate.position - reference.position
        error[2] = (error[2] + pi) % (2.0 * pi) - pi
        off = turn.T @ error
        velocity = turn.T @ reference.velocity
        acceleration = turn.T @ reference.acceleration
        demand = -self._stiffness * off - self._friction * (estimate.velocity - velocity)
        demand += self._model.mass @ acceleration + self._model.damping @ velocity
        demand -= turn.T @ self._slow_force + self._wind
        self._demand = demand
        self._given = self._allocator.step(demand, self.period).force
        if self.integral:
            # what the thrusters do not give lets the integral follow (back-calculation)
            missing = self._given - demand
            room = TOLERATED * self._allocator.scale
            excess = self._bandwidth * (missing - np.clip(missing, -room, room))
            self._slow_force += self.period * (turn @ (self._integral_gain * off - excess))

    def estimates(self) -> dict[str, Estimate]:
        """Return reference, motion without waves, and demanded and given force, for the log."""
        found: dict[str, Estimate] = {}
        if self._model is None:
            return found
        for i, (place, axis) in enumerate(zip(GOALS, AXES, strict=True)):
            values = {
                f"reference_{place}": self._reference.position[i],
                f"filtered_{place}": self._observer.position[i],
                f"demanded_{axis}": self._demand[i],
                f"allocated_{axis}": self._given[i],
                f"wind_{axis}": self._wind[i],
            }
            for name, value in values.items():
                found[name] = Estimate(float(value), nan, nan)
        return found


def rotation(heading: float) -> Array:
    """Return the rotation matrix (3, 3) from body axes to earth axes.

    Args:
        heading: Heading [rad].
    """
    c, s = cos(heading), sin(heading)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
