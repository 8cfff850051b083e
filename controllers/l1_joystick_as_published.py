"""Arduino program of the thesis (Bayless 2017, Appendix H), statement by statement.

Each of its defects can be switched off.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import nan, pi, radians
from typing import ClassVar

from boatsim.control.base import Controller, Estimate, Sense, clip
from boatsim.physics.base import param

# Constants of the listing (Bayless 2017, Appendix H)
T_S = 0.08  # [s] sample time assumed in the code, independent of the true period
GAMMA = 10000.0  # adaptation gain; omega_1 has twice as much
BOUNDS = {
    "theta_1": (0.9, 1.1),
    "theta_23": (0.5, 2.0),
    "omega_1": (1.0, 1.8),
    "omega_23": (1.0, 1.5),
    "sigma_1": (0.01, 0.02),
    "sigma_2": (0.01, 0.2),
    "sigma_3": (0.01, 0.2),
}
FIRST = {
    "theta_1": 0.0,
    "theta_23": 0.5,
    "omega_1": 0.0,
    "omega_23": 1.0,
    "sigma_1": 0.0,
    "sigma_2": 0.9,
    "sigma_3": 0.9,
}
NOMINAL_POWER = 150.0  # PWM of the starboard motor, which runs astern
PARKED = 30.0  # [deg] inward: servo positions 116 and 62, reference angles 86 and 92
LONG_PERIOD = 0.1  # [s] our estimate: 70 ms of serial text at 9600 baud, five readings of 5 to 6 ms


def push_sample(history: list[float], value: float) -> None:
    """Shift a history of samples [now, one ago, two ago] by one and insert a new sample.

    Args:
        history: Samples, newest first; changed in place.
        value: New sample.
    """
    history[2], history[1], history[0] = history[1], history[0], value


def filter_output(u: list[float], r: list[float], pole: float) -> float:
    """Return the output of the published sampled control law D(s) from past inputs and outputs.

    D(s) = 1.07 (s + 17.7) / (s (s + 50)).

    Args:
        u: Past outputs, u[0] the last one.
        r: Past inputs.
        pole: Coefficient of the last output.
    """
    return pole * u[1] - 0.08208 * u[2] + 0.03164 * r[1] - 0.01425 * r[2]


@dataclass
class L1JoystickAsPublished(Controller):
    """Controller program of a thesis (Bayless 2017, Appendix H), statement by statement in float64.

    A switch set to False corrects one defect. Item numbers are those of the review of the thesis.
    The goal is ignored: as in the thesis each manoeuvre is a separate program, set by r_1, r_2 and
    r_3. The yaw program is not published; here it is this one with r_2 = 0, r_3 = -0.56 and the
    seeded heading. `sense.psi` counts from the start heading; the five readings of a loop lie
    within one 10 ms sample of the sensor.
    """

    words: ClassVar[str] = "the thesis' Arduino program, defects included"
    commands: ClassVar[tuple[str, ...]] = (
        "pwm_port",
        "pwm_starboard",
        "steer_port_rad",
        "steer_starboard_rad",
    )

    r_1: float = param(0.0, low=-1.0, high=1.0, unit="m/s", words="surge command of the program")
    r_2: float = param(0.07, low=-1.0, high=1.0, unit="m/s", words="sway command of the program")
    r_3: float = param(0.0, low=-5.0, high=5.0, unit="rad/s", words="yaw command of the program")
    h0: float = param(0.159, low=0.0, high=2 * pi, unit="rad", words="compass bearing at the start")
    # item 24: heading[0] is 0 at the first sample; True: it is the first reading
    seeded: bool = False
    # item 16: 5/7 is 0, 99/70 is 1; mended: 5.0/7.0 (felt only if not seeded)
    integer_division: bool = True
    # item 17: U_1[0] = U_1[1]; U_1[1] = U_1[0]; mended: shifted like U_2 and U_3
    surge_history: bool = True
    sigma_sign: bool = True  # item 18: sigma adapts along +error; mended: along -error
    # item 18: theta x + sigma outside the sampled input; mended: inside it
    unscaled_disturbance: bool = True
    # item 19: sigma 0.9, theta_1, omega_1, sigma_1 0 at the start; mended: clipped
    start_values: bool = True
    # item 20: -0.9324 U_3[2] in the sway row; mended: -0.001193 U_3[2]
    sway_coefficient: bool = True
    # item 21: -yaw (a - sway b); mended: yaw a - sway b = -(xt' P b) x
    misplaced_parenthesis: bool = True
    divide_by_four: bool = True  # item 22: five readings over four; mended: over five
    # item 23: surge[0] = surge_a; mended: surge[0] = surge[1] + T_s surge_a
    acceleration_as_velocity: bool = True
    # item 23: yaw rate from two compass headings; mended: yaw[0] = yaw_a, the gyro
    unused_gyro: bool = True
    reversed_difference: bool = True  # item 23: old minus new heading; mended: new minus old
    # item 23: bearings in 0 to 2 pi, jumps left in; False: continuous bearing
    heading_wrap: bool = False
    parked_inward: bool = True  # item 25: servos wait at 30 deg; mended: at 0
    # item 26: kg_1 = 0.8; mended: 2, the pole of the coded surge model
    surge_feed_forward: bool = True
    # item 27: the loop's own work takes longer than T_s; False: exactly T_s
    longer_period: bool = False

    estimate: dict[str, float] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.longer_period:
            self.period = max(self.period, LONG_PERIOD)
        self.reset()

    def reset(self) -> None:
        """Reset to the state of the published program after `setup()`.

        Global arrays are zero and the servos parked.
        """
        self.estimate = (
            dict(FIRST) if self.start_values else {n: clip(v, *BOUNDS[n]) for n, v in FIRST.items()}
        )
        self._first = True
        self._surge = self._sway = self._yaw = self._heading = 0.0
        self._m_surge, self._m_sway, self._m_yaw = [0.0] * 3, [0.0] * 3, [0.0] * 3
        self._r = [[0.0] * 3 for _ in range(3)]
        self._u = [[0.0] * 3 for _ in range(3)]
        self._eta = [[0.0] * 3 for _ in range(3)]

    def initial_commands(self) -> dict[str, float]:
        """Return the servo and motor commands before the published program's first pass."""
        return self._commands(0.0, 0.0, *((PARKED, PARKED) if self.parked_inward else (0.0, 0.0)))

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Execute one pass of the published program's `loop()` and return its commands.

        Args:
            sense: Sensor readings.
            goal: Not used.
        """
        self._average_readings(sense)
        self._predict()
        self._adapt()
        self._control()
        return self._actuate()

    def estimates(self) -> dict[str, Estimate]:
        """Return the seven adaptive estimates with their bounds, and the model states.

        Velocities are not among them.
        """
        logged = {name: Estimate(self.estimate[name], *BOUNDS[name]) for name in BOUNDS}
        model = {"m_surge": self._m_surge[0], "m_sway": self._m_sway[0], "m_yaw": self._m_yaw[0]}
        return logged | {name: Estimate(state, nan, nan) for name, state in model.items()}

    def _average_readings(self, sense: Sense) -> None:
        """Average the five readings and compute surge, sway and yaw as the listing does."""
        scale = 5.0 / 4.0 if self.divide_by_four else 1.0
        bearing = self.h0 + sense.psi
        heading = scale * (bearing % (2.0 * pi) if self.heading_wrap else bearing)
        if self._first and self.seeded:
            self._heading = heading
        self._first = False
        surge_a, sway_a, yaw_a = scale * sense.ax, scale * sense.ay, scale * sense.r
        self._surge = surge_a if self.acceleration_as_velocity else self._surge + T_S * surge_a
        self._sway = sway_a if self.acceleration_as_velocity else self._sway + T_S * sway_a
        rate = (self._heading - heading) / T_S
        self._yaw = (rate if self.reversed_difference else -rate) if self.unused_gyro else yaw_a
        self._heading = heading

    def _predict(self) -> None:
        """Advance the reference model by one sample with previous estimates and older outputs."""
        e = self.estimate
        add_1 = e["sigma_1"] + e["theta_1"] * self._surge
        if self.unscaled_disturbance:
            (u1, u2, u3), omega_1, omega_23 = self._u, e["omega_1"], e["omega_23"]
            add = (
                add_1,
                e["theta_23"] * self._sway,
                e["sigma_2"],
                e["theta_23"] * self._yaw,
                e["sigma_3"],
            )
        else:  # eta = omega u + theta x + sigma, one sample younger than u in its history
            u1, u2, u3 = ([nan, *eta[:2]] for eta in self._eta)
            omega_1 = omega_23 = 1.0
            add = (0.0,) * 5
        sway_3 = 0.9324 if self.sway_coefficient else 0.001193
        m1, m2, m3 = self._m_surge, self._m_sway, self._m_yaw
        push_sample(m1, 0.9048 * m1[0] - 0.04758 * u1[1] * omega_1 + add[0])
        into_sway = (
            0.04998 * u2[1] - 0.0466 * u2[2] - 0.001221 * u3[1] - sway_3 * u3[2]
        ) * omega_23
        push_sample(m2, 1.93 * m2[0] - 0.9324 * m2[1] + add[1] + into_sway + add[2])
        into_yaw = (
            (0.04827 * u3[1] - 0.04827 * u3[2] + 0.001221 * u2[1] + 0.001193 * u2[2])
            * 0.2118
            * omega_23
        )
        push_sample(m3, 1.93 * m3[0] - 0.9324 * m3[1] + add[3] + into_yaw + add[4] - 0.3529)

    def _adapt(self) -> None:
        """Advance the seven adaptation laws by one Euler step, then apply `constrain`."""
        surge, sway, yaw, (u1, u2, u3) = self._surge, self._sway, self._yaw, (u[0] for u in self._u)
        surge_e = self._m_surge[0] - surge
        sway_e = self._m_sway[0] - sway
        yaw_e = self._m_yaw[0] - yaw
        sign = 1.0 if self.sigma_sign else -1.0
        self._step_estimate("theta_1", -1.0 * surge_e * surge)
        self._step_estimate("theta_23", self._cross_term_gradient(yaw, sway, sway_e, yaw_e))
        self._step_estimate("omega_1", 2.0 * surge_e * u1)
        self._step_estimate("omega_23", self._cross_term_gradient(u3, u2, sway_e, yaw_e))
        self._step_estimate("sigma_1", sign * surge_e)
        self._step_estimate("sigma_2", sign * sway_e)
        self._step_estimate("sigma_3", sign * yaw_e)

    def _cross_term_gradient(self, yaw: float, sway: float, sway_e: float, yaw_e: float) -> float:
        """Return the gradient of theta_23 or omega_23.

        It should be -(xt' P b) x with P of xt' P xt.
        """
        five_sevenths, ninety_nine = (
            (0.0, 1.0) if self.integer_division else (5.0 / 7.0, 99.0 / 70.0)
        )
        by_yaw, by_sway = 0.5 * sway_e - five_sevenths * yaw_e, ninety_nine * sway_e - 0.5 * yaw_e
        if self.misplaced_parenthesis:
            return -1.0 * yaw * (by_yaw - sway * by_sway)
        return yaw * by_yaw - sway * by_sway

    def _step_estimate(self, name: str, slope: float) -> None:
        self.estimate[name] = clip(self.estimate[name] + T_S * (GAMMA * slope), *BOUNDS[name])

    def _control(self) -> None:
        """Apply the control law: subtract the estimated dynamics, then filter."""
        e, u = self.estimate, self._u
        push_sample(
            self._eta[0], e["omega_1"] * u[0][0] + e["theta_1"] * self._surge + e["sigma_1"]
        )
        push_sample(
            self._eta[1], e["omega_23"] * u[1][0] + e["theta_23"] * self._sway + e["sigma_2"]
        )
        push_sample(
            self._eta[2], e["omega_23"] * u[2][0] + e["theta_23"] * self._yaw + e["sigma_3"]
        )
        kg = (0.8 if self.surge_feed_forward else 2.0, 0.7143, 1.0)
        for r, wanted, gain, eta in zip(
            self._r, (self.r_1, self.r_2, self.r_3), kg, self._eta, strict=True
        ):
            push_sample(r, wanted * gain - eta[0])
        for channel, pole in enumerate((1.062, 1.082, 1.082)):
            if channel == 0 and self.surge_history:
                u[0][0] = u[0][1]
                u[0][1] = u[0][0]
            else:
                push_sample(u[channel], u[channel][0])
            u[channel][0] = filter_output(u[channel], self._r[channel], pole)

    def _actuate(self) -> dict[str, float]:
        """Return servo positions and PWM values, truncated as by `write` and `analogWrite`."""
        rudder = 3.3952 * (115.0 * self._u[2][0]) - 5.49
        port = int(clip(86.0 + rudder, 86.0, 128.0)) - 86
        starboard = 92 - int(clip(92.0 - rudder, 50.0, 92.0))
        power = clip(NOMINAL_POWER - 0.30 * NOMINAL_POWER + 1.3 * self._u[0][0], 50.0, 255.0)
        return self._commands(float(int(power)), -NOMINAL_POWER, port, starboard)

    def _commands(
        self, pwm_port: float, pwm_starboard: float, port: float, starboard: float
    ) -> dict[str, float]:
        """Return the commands by channel from inward angles in degrees."""
        angles = (radians(port), -radians(starboard))
        return dict(zip(self.commands, (pwm_port, pwm_starboard, *angles), strict=True))
