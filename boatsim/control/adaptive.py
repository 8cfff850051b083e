"""Textbook blocks of L1 adaptive control: predictors, adaptation laws, projections, L1 norm and loop margins.

The form is that of Hovakimyan and Cao, L1 Adaptive Control Theory (SIAM 2010). What a controller steps on a boat
works in plain floats; what is worked out beforehand (norms, margins) uses numpy.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import ceil, exp, inf, pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from boatsim.errors import BadInput
from boatsim.physics.base import Array

Complex = NDArray[np.complex128]
Loop = Callable[[Complex], Complex]  # L(s) at s = j omega, omega in rad/s; pure delays allowed
# of z: what the controller answers to position and to rate
Law = Callable[[Complex], tuple[Complex, Complex]]
HIGHEST = 1e3  # [rad/s] beyond which a continuous loop has no crossover


def ball_share(square: float, along: float, radius: float, tolerance: float) -> float:
    """Share of theta that the projection takes off its rate y; square is theta'theta, along is theta'y.

    The convex function is ((1 + tolerance) theta'theta - radius^2) / (tolerance radius^2): 0 on the inner ball of
    radius/sqrt(1 + tolerance), 1 on the outer one, where all outward motion is gone.
    """
    excess = ((1.0 + tolerance) * square - radius * radius) / (tolerance * radius * radius)
    if excess <= 0.0 or along <= 0.0:
        return 0.0
    return along * excess / square


def project_interval(value: float, rate: float, low: float, high: float, tolerance: float) -> float:
    """Projection of one number on [low, high]: the ball about the middle, so that both bounds are kept."""
    off = value - 0.5 * (low + high)
    return rate - ball_share(off * off, off * rate, 0.5 * (high - low), tolerance) * off


@dataclass
class Gradient:
    """Estimate of one unknown number by the gradient law, kept inside [low, high].

    value' = gain Proj(value, -regressor error); the regressor is the state for a theta, the input for omega, 1 for
    sigma, and the error is (xh - x)' P b with P from `lyapunov`.
    """

    value: float
    low: float
    high: float
    gain: float
    tolerance: float = 0.1

    def rate(self, regressor: float, error: float) -> float:
        """Time derivative of the estimate [1/s]."""
        return self.gain * project_interval(
            self.value, -regressor * error, self.low, self.high, self.tolerance
        )

    def step(self, regressor: float, error: float, dt: float) -> float:
        """Follow the rate over dt [s]; cut at the bounds, which a step too long for the gain would jump over."""
        self.value = min(max(self.value + dt * self.rate(regressor, error), self.low), self.high)
        return self.value


@dataclass
class Predictor:
    """What the boat should do: xh' = -a xh + b0 drive, exact for a drive held over each period."""

    a: float  # [1/s] pole
    b0: float  # assumed input gain: unit of x per second per unit of input
    period: float  # [s]
    xh: float = 0.0  # predicted state
    decay: float = field(init=False, repr=False)  # e^{-aT}
    gain: float = field(init=False, repr=False)  # b0 (1 - e^{-aT}) / a

    def __post_init__(self) -> None:
        self.decay = exp(-self.a * self.period)
        self.gain = self.b0 * (1.0 - self.decay) / self.a

    def predict(self, drive: float) -> float:
        """Carry the prediction over one period; returns the new prediction."""
        self.xh = self.decay * self.xh + self.gain * drive
        return self.xh


@dataclass
class PiecewiseConstant(Predictor):
    """Predictor whose unknown input sig is set anew every period from the prediction error, in the input's unit.

    Each period: `predict` with what was really applied (after saturation), then `adapt` to what is measured.
    """

    sig: float = 0.0  # all that the predictor does not know, as an input

    def predict(self, drive: float) -> float:
        """Carry the prediction over one period in which `drive` was applied and sig acted beside it."""
        return super().predict(drive + self.sig)

    def adapt(self, measured: float) -> float:
        """Choose sig so that over one period it takes away what is left of the prediction error; returns sig."""
        self.sig = -(self.xh - measured) * self.decay / self.gain
        return self.sig


@dataclass
class DiscreteFilter:
    """Ratio of two polynomials in z (coefficients of falling powers), stepped once a period."""

    numerator: Sequence[float]
    denominator: Sequence[float]
    state: list[float] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        n = len(self.denominator)
        lead = self.denominator[0]
        self.denominator = [a / lead for a in self.denominator]
        self.numerator = [0.0] * (n - len(self.numerator)) + [b / lead for b in self.numerator]
        self.state = [0.0] * (n - 1)

    def step(self, value: float) -> float:
        """Output of this period, its input already in it where the two polynomials are of the same order."""
        b, a, x = self.numerator, self.denominator, self.state
        out = x[0] + b[0] * value
        for i in range(len(x)):
            x[i] = b[i + 1] * value - a[i + 1] * out + (x[i + 1] if i + 1 < len(x) else 0.0)
        return out

    def at(self, z: Complex) -> Complex:
        """Its value for complex z; z = 1 gives the gain of a constant input."""
        return np.asarray(np.polyval(self.numerator, z) / np.polyval(self.denominator, z))


def held(numerator: Sequence[float], denominator: Sequence[float], period: float) -> DiscreteFilter:
    """A strictly proper ratio of polynomials in s (falling powers) as seen through a zero-order hold, exact."""
    lead, n = denominator[0], len(denominator) - 1
    a = np.vstack([-np.asarray(denominator[1:], dtype=float) / lead, np.eye(n - 1, n)])
    c = np.concatenate([np.zeros(n - len(numerator)), np.asarray(numerator, dtype=float) / lead])
    whole = matrix_exp(np.block([[a, np.eye(n, 1)], [np.zeros((1, n + 1))]]) * period)
    # determinant of zI - A; that of zI - A + b c is numerator + denominator
    poles = np.poly(whole[:n, :n])
    zeros = np.poly(whole[:n, :n] - np.outer(whole[:n, n], c)) - poles
    return DiscreteFilter(zeros[1:].tolist(), poles.tolist())


def lyapunov(am: ArrayLike, q: ArrayLike | None = None) -> Array:
    """P of Am'P + P Am = -Q, (n, n); Q is the identity if not given."""
    a = np.asarray(am, dtype=float)
    eye = np.eye(len(a))
    right = eye if q is None else np.asarray(q, dtype=float)
    p = np.linalg.solve(np.kron(eye, a.T) + np.kron(a.T, eye), -right.ravel()).reshape(a.shape)
    return np.asarray(0.5 * (p + p.T))


def matrix_exp(a: Array) -> Array:
    """e^A of a square matrix."""
    from scipy.linalg import expm

    return np.asarray(expm(a))


@dataclass(frozen=True)
class LinearSystem:
    """x' = A x + B v, y = C x: A (n, n), B (n, inputs), C (outputs, n)."""

    a: Array
    b: Array
    c: Array


def unfiltered(am: ArrayLike, b: ArrayLike, bandwidth: float) -> LinearSystem:
    """(sI - Am)^-1 b (1 - C) with C = bandwidth/(s + bandwidth): what the low-pass leaves of an uncertainty.

    Am (n, n) [1/s], b (n,), bandwidth [rad/s]; the outputs are the n states.
    """
    a = np.atleast_2d(np.asarray(am, dtype=float))
    column = np.asarray(b, dtype=float).reshape(-1, 1)
    n = len(a)
    whole = np.block([[a, -column], [np.zeros((1, n)), np.array([[-bandwidth]])]])
    return LinearSystem(whole, np.vstack([column, [[bandwidth]]]), np.eye(n, n + 1))


def step_response(system: LinearSystem, dt: float, steps: int) -> Array:
    """Outputs (steps + 1, outputs) every dt [s] from rest while the first input is 1; exact at these times."""
    n = len(system.a)
    with_input = np.block([[system.a, system.b[:, :1]], [np.zeros((1, n + 1))]])
    states = _free_motion(matrix_exp(with_input * dt), np.eye(n + 1)[n], steps)
    return np.asarray(states[:, :n] @ system.c.T)


def l1_rows(system: LinearSystem) -> Array:
    """L1 norm of each row of the transfer matrix, (outputs,): the sum over inputs of the integrals of |h(t)|."""
    each = [[_absolute_integral(system.a, b, c) for b in system.b.T] for c in system.c]
    return np.asarray(np.sum(np.array(each), axis=1))


def l1_norm(system: LinearSystem) -> float:
    """L1 norm of a stable transfer matrix: its largest gain from bounded input to bounded output."""
    return float(np.max(l1_rows(system)))


def l1_condition(norm: float, slope: float) -> float:
    """L1-norm condition: below 1 where the loop stays bounded for uncertainties of at most this slope."""
    return norm * slope


def _absolute_integral(a: Array, b: Array, c: Array) -> float:
    """Integral over t > 0 of |c e^{At} b| for a stable A: the step response rises and falls between zeros of h.

    Between two zeros the integral of h is c A^-1 (x2 - x1), exact; a zero is located by bisection.
    """
    primitive = np.linalg.solve(a.T, c)
    total, start = 0.0, b
    for dt, steps in _grid(a):
        x = _free_motion(matrix_exp(a * dt), start, steps)
        h, halves = x @ c, [matrix_exp(a * dt * 0.5**k) for k in range(1, 40)]
        total += float(np.sum(np.abs(np.diff(x @ primitive))))
        for i in np.nonzero(h[:-1] * h[1:] < 0.0)[0]:
            at = _zero(halves, x[i], c)
            total += (
                abs(primitive @ (at - x[i]))
                + abs(primitive @ (x[i + 1] - at))
                - abs(primitive @ (x[i + 1] - x[i]))
            )
        start = x[-1]
    return total


def _grid(a: Array) -> list[tuple[float, int]]:
    """Steps [s] and their numbers: twenty per radian of the fastest mode that has not yet died out (to 1e-13)."""
    modes = sorted(
        ((30.0 / -pole.real, abs(pole)) for pole in np.linalg.eigvals(a)), key=lambda mode: mode[0]
    )
    if modes[0][0] <= 0.0 or modes[-1][0] == inf:
        raise BadInput(
            f"the L1 norm exists for a stable system only; poles found: {np.linalg.eigvals(a)} 1/s"
        )
    parts, begin = [], 0.0
    for i, (end, _) in enumerate(modes):
        steps = max(2, ceil((end - begin) * 20.0 * max(speed for _, speed in modes[i:])))
        if end > begin:
            parts.append(((end - begin) / steps, steps))
        begin = end
    return parts


def _free_motion(once: Array, start: Array, steps: int) -> Array:
    """States (steps + 1, n) from start where each is `once` times the one before, by doubling what is there."""
    x, power = start[None, :], once
    while len(x) <= steps:
        x, power = np.vstack([x, x @ power.T]), power @ power
    return np.asarray(x[: steps + 1])


def _zero(halves: list[Array], x: Array, c: Array) -> Array:
    """State where c x first changes its sign after x, by bisection: halves[k] moves a state by the step / 2^(k+1)."""
    for half in halves:
        later = half @ x
        x = later if (c @ later) * (c @ x) > 0.0 else x
    return x


@dataclass(frozen=True)
class LoopMargins:
    """How far a loop is from instability; of several crossovers the one that allows the least extra delay."""

    crossover: float  # [rad/s] where |L| is 1
    phase: float  # [rad] lag that may be added at the crossover
    delay: float  # [s] pure delay that may be added; 0 where the loop is unstable already
    stable: bool


def loop_margins(
    loop: Loop, low: float = 1e-4, high: float = HIGHEST, points: int = 20000
) -> LoopMargins:
    """Crossover, phase margin and extra-delay margin of a loop L(s) under negative feedback.

    The loop must have no pole in the right half plane, and its behaviour outside low..high [rad/s] must be plain:
    integrators below, |L| < 1 above.
    """
    omega = np.geomspace(low, high, points)
    response = loop(np.asarray(1j * omega))
    above = np.abs(response) > 1.0
    found = [
        _crossover(loop, omega[i], omega[i + 1]) for i in np.nonzero(above[:-1] != above[1:])[0]
    ]
    stable = _stable(omega, response)
    if not found:
        return LoopMargins(0.0, inf, inf, stable)
    lag = {w: float(np.angle(-loop(np.array([1j * w]))[0])) for w in found}
    worst = min(found, key=lambda w: (lag[w] % (2.0 * pi)) / w)
    return LoopMargins(
        worst, lag[worst], (lag[worst] % (2.0 * pi)) / worst if stable else 0.0, stable
    )


def _crossover(loop: Loop, low: float, high: float) -> float:
    """Frequency between low and high where |L| passes 1, by bisection."""
    rising = abs(loop(np.array([1j * high]))[0]) > 1.0
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (
            (low, middle)
            if (abs(loop(np.array([1j * middle]))[0]) > 1.0) == rising
            else (middle, high)
        )
    return 0.5 * (low + high)


def _stable(omega: Array, response: Complex) -> bool:
    """Nyquist's criterion without unstable open-loop poles: 1 + L turns by a quarter for each integrator, no more."""
    integrators = round(
        -float(np.diff(np.log(np.abs(response[:2])))[0] / np.diff(np.log(omega[:2]))[0])
    )
    turned = np.unwrap(np.angle(1.0 + response))
    return bool(abs(turned[-1] - turned[0] - 0.5 * pi * integrators) < 0.5 * pi)


@dataclass(frozen=True)
class LoopChannel:
    """One feedback channel of a controller, as the loop analysis sees it.

    The plant is x' = -damping x + (input gain) tau / I0, the position is the integral of x; tau reaches it through a
    zero-order hold of mean delay `hold_s` (half a sample period) and a lag `servo_lag_s`. The controller is the L1 law
    tau = I0 pole x_ref - C sig, x_ref = heading_gain (position error), C = bandwidth/(s + bandwidth), with sig taken
    as I0 (x' + pole x) - tau, which fast adaptation approaches; or a PID on the position, its gains divided by I0.
    """

    name: str
    pole: float = 0.0  # [1/s] of the predictor
    bandwidth: float = 0.0  # [rad/s] of C
    heading_gain: float = 0.0  # [1/s] position error to rate wanted
    # true over assumed: lowest, nominal, highest
    input_gain: tuple[float, float, float] = (1.0, 1.0, 1.0)
    hold_s: float = 0.0
    servo_lag_s: float = 0.0
    pid: tuple[float, float, float] | None = None  # (kp [1/s^2], ki [1/s^3], kd [1/s])
    damping: float = 0.0  # [1/s] of the boat itself

    @property
    def highest(self) -> float:
        """Frequency up to which the loop is looked at [rad/s]."""
        return HIGHEST

    def loop(self, gain: float) -> Loop:
        """L(s), broken at the plant input, for one true-over-assumed input gain."""

        def response(s: Complex) -> Complex:
            held = (
                -np.expm1(-2.0 * self.hold_s * s) / (2.0 * self.hold_s * s)
                if self.hold_s > 0.0
                else 1.0
            )
            actuator = gain * held / (1.0 + self.servo_lag_s * s)
            return np.asarray(self._law(s) * actuator / (s * (s + self.damping)))

        return response

    def _law(self, s: Complex) -> Complex:
        """-tau/(I0 position): what the controller answers to a position error, its own filter loop closed."""
        if self.pid is not None:
            kp, ki, kd = self.pid
            return np.asarray(kp + ki / s + kd * s)
        unfiltered_again = (s + self.bandwidth) / s  # 1/(1 - C)
        return np.asarray(
            self.pole * self.heading_gain * unfiltered_again + self.bandwidth * (s + self.pole)
        )

    def norm(self, gain: float) -> float | None:
        """L1 norm [s] of (1 - C)/(s + pole), C = gain bandwidth/(s + gain bandwidth); None for a PID."""
        if self.pid is not None:
            return None
        return l1_norm(unfiltered([[-self.pole]], [1.0], gain * self.bandwidth))


@dataclass(frozen=True)
class SampledChannel:
    """One feedback channel of a sampled controller, exact: position and rate of a plant whose input is held.

    The plant is x' = -damping x + (input gain) a, the position is the integral of x; the controller answers
    a = -(position law(z)[0] + rate law(z)[1]), its own inner loops closed. Both are stable but for the plant's
    integrator. A delay between them need not be a whole number of periods: the margin is that of the phase.
    """

    name: str
    law: Law
    damping: float  # [1/s] of the boat itself
    period: float  # [s]
    input_gain: tuple[float, ...] = (1.0,)  # true over assumed
    pole: float = 0.0  # [1/s] of the predictor

    @property
    def highest(self) -> float:
        """Frequency up to which the loop is looked at [rad/s]: half the sampling rate, where it mirrors itself."""
        return pi / self.period

    def loop(self, gain: float) -> Loop:
        """L(s), z = e^{sT}, broken at the plant input, for one true-over-assumed input gain."""
        decay = exp(-self.damping * self.period)
        # F and g of the plant over one period, zero-order hold
        rate_gain = (1.0 - decay) / self.damping
        place_gain = (self.period - rate_gain) / self.damping

        def response(s: Complex) -> Complex:
            z = np.exp(s * self.period)
            rate = rate_gain / (z - decay)
            place = (rate_gain * rate + place_gain) / (z - 1.0)
            to_place, to_rate = self.law(z)
            return np.asarray(gain * (to_place * place + to_rate * rate))

        return response

    def norm(self, gain: float) -> float | None:
        """No L1 norm: its condition is one of continuous loops."""
        return None
