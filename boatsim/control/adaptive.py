"""Blocks of L1 adaptive control: predictors, adaptation laws, projection, L1 norm and loop margins.

After N. Hovakimyan and C. Cao, L1 Adaptive Control Theory (SIAM 2010). What a controller evaluates
at run time uses plain floats; what is computed beforehand (norms, margins) uses numpy.
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
# of z: response of the controller to position and to rate
Law = Callable[[Complex], tuple[Complex, Complex]]
HIGHEST = 1e3  # [rad/s] highest crossover of a continuous loop


def projection_factor(square: float, along: float, radius: float, tolerance: float) -> float:
    """Return the factor by which the projection operator of adaptive control corrects a rate.

    The projected rate of the estimate theta is y less this factor times theta. The convex function
    is f = ((1 + tolerance) theta'theta - radius^2) / (tolerance radius^2): 0 on the inner ball of
    radius / sqrt(1 + tolerance), 1 on the outer one, where all outward motion is removed.

    Args:
        square: theta'theta.
        along: theta'y.
        radius: Radius of the outer ball.
        tolerance: Projection tolerance.
    """
    excess = ((1.0 + tolerance) * square - radius * radius) / (tolerance * radius * radius)
    if excess <= 0.0 or along <= 0.0:
        return 0.0
    return along * excess / square


def project_interval(value: float, rate: float, low: float, high: float, tolerance: float) -> float:
    """Return the rate of a scalar adaptive estimate after projection on the interval [low, high].

    The interval is the ball of the projection operator about its middle.

    Args:
        value: Estimate.
        rate: Rate of the estimate before projection [1/s].
        low: Lower bound.
        high: Upper bound.
        tolerance: Projection tolerance.
    """
    off = value - 0.5 * (low + high)
    return rate - projection_factor(off * off, off * rate, 0.5 * (high - low), tolerance) * off


@dataclass
class Gradient:
    """Gradient adaptation law with projection for one unknown number in [low, high].

    value' = gain Proj(value, -regressor error)

    The regressor is the state for theta, the input for omega and 1 for sigma; the error is (xh -
    x)' P b with P from `solve_lyapunov`. The law is discretised by the explicit Euler method.
    """

    value: float
    low: float
    high: float
    gain: float
    tolerance: float = 0.1

    def projected_rate(self, regressor: float, error: float) -> float:
        """Return the time derivative [1/s] of the adaptive estimate by its gradient law.

        Args:
            regressor: State, input or 1.
            error: (xh - x)' P b.
        """
        return self.gain * project_interval(
            self.value, -regressor * error, self.low, self.high, self.tolerance
        )

    def step(self, regressor: float, error: float, dt: float) -> float:
        """Advance the adaptive estimate by one Euler step and return it, limited to its bounds.

        Args:
            regressor: State, input or 1.
            error: (xh - x)' P b.
            dt: Length of the step [s].
        """
        self.value = min(
            max(self.value + dt * self.projected_rate(regressor, error), self.low), self.high
        )
        return self.value


@dataclass
class Predictor:
    """First-order state predictor xh' = -a xh + b0 drive, exact for a drive held over each period.

    xh(k+1) = e^(-aT) xh(k) + b0 (1 - e^(-aT)) / a drive(k)
    """

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
        """Advance the state predictor by one period and return the predicted state.

        Args:
            drive: Input held over the period.
        """
        self.xh = self.decay * self.xh + self.gain * drive
        return self.xh


@dataclass
class PiecewiseConstant(Predictor):
    """State predictor with piecewise-constant adaptation of the unknown input sigma.

    sigma = -(xh - x) e^(-aT) / (b0 (1 - e^(-aT)) / a)

    Hovakimyan and Cao 2010, section 3.3. In each period call `predict` with the input that was
    applied (after saturation), then `adapt` with the measurement.
    """

    sig: float = 0.0  # lumped uncertainty in the unit of the input

    def predict(self, drive: float) -> float:
        """Advance the state predictor by one period and return the predicted state.

        The estimated disturbance sigma acts in addition to the input.

        Args:
            drive: Input applied over the period.
        """
        return super().predict(drive + self.sig)

    def adapt(self, measured: float) -> float:
        """Estimate the unknown input sigma from the prediction error of a period, and return it.

        Sigma is the constant input that cancels the error over one period.

        Args:
            measured: Measured state.
        """
        self.sig = -(self.xh - measured) * self.decay / self.gain
        return self.sig


@dataclass
class DiscreteFilter:
    """Discrete transfer function: ratio of two polynomials in z, coefficients of falling powers."""

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
        """Advance the filter by one period and return its output.

        Args:
            value: Input of this period; it acts without delay if both polynomials have the same
                order.
        """
        b, a, x = self.numerator, self.denominator, self.state
        out = x[0] + b[0] * value
        for i in range(len(x)):
            x[i] = b[i + 1] * value - a[i + 1] * out + (x[i + 1] if i + 1 < len(x) else 0.0)
        return out

    def evaluate(self, z: Complex) -> Complex:
        """Return the filter's transfer function at complex z; z = 1 gives the static gain.

        Args:
            z: Complex frequencies.
        """
        return np.asarray(np.polyval(self.numerator, z) / np.polyval(self.denominator, z))


def zero_order_hold(
    numerator: Sequence[float], denominator: Sequence[float], period: float
) -> DiscreteFilter:
    """Return the discrete transfer function equivalent to a continuous one with a held input.

    The zero-order-hold equivalent is exact; the transfer function must be strictly proper.

    Args:
        numerator: Coefficients of falling powers of s.
        denominator: Coefficients of falling powers of s.
        period: Sample time [s].
    """
    lead, n = denominator[0], len(denominator) - 1
    a = np.vstack([-np.asarray(denominator[1:], dtype=float) / lead, np.eye(n - 1, n)])
    c = np.concatenate([np.zeros(n - len(numerator)), np.asarray(numerator, dtype=float) / lead])
    whole = matrix_exp(np.block([[a, np.eye(n, 1)], [np.zeros((1, n + 1))]]) * period)
    # determinant of zI - A; that of zI - A + b c is numerator + denominator
    poles = np.poly(whole[:n, :n])
    zeros = np.poly(whole[:n, :n] - np.outer(whole[:n, n], c)) - poles
    return DiscreteFilter(zeros[1:].tolist(), poles.tolist())


def solve_lyapunov(am: ArrayLike, q: ArrayLike | None = None) -> Array:
    """Solve the Lyapunov equation Am'P + P Am = -Q for P (n, n).

    Args:
        am: Stable matrix (n, n) [1/s].
        q: Q (n, n); default: the identity.
    """
    a = np.asarray(am, dtype=float)
    eye = np.eye(len(a))
    right = eye if q is None else np.asarray(q, dtype=float)
    p = np.linalg.solve(np.kron(eye, a.T) + np.kron(a.T, eye), -right.ravel()).reshape(a.shape)
    return np.asarray(0.5 * (p + p.T))


def matrix_exp(a: Array) -> Array:
    """Return the matrix exponential e^A of a square matrix.

    Args:
        a: Square matrix.
    """
    from scipy.linalg import expm

    return np.asarray(expm(a))


@dataclass(frozen=True)
class LinearSystem:
    """State-space model of a linear system, x' = A x + B v, y = C x.

    The matrices are A (n, n), B (n, inputs), C (outputs, n).
    """

    a: Array
    b: Array
    c: Array


def uncertainty_to_state_system(am: ArrayLike, b: ArrayLike, bandwidth: float) -> LinearSystem:
    """Return the linear system from an uncertainty to the state of an L1 adaptive loop.

    It is (sI - Am)^-1 b (1 - C(s)) with the low-pass filter C = bandwidth / (s + bandwidth): the
    response to the part of an uncertainty that the filter does not cancel. Its L1 norm enters the
    L1-norm condition. The outputs are the n states.

    Args:
        am: Am (n, n) [1/s].
        b: b (n,).
        bandwidth: Bandwidth of the filter [rad/s].
    """
    a = np.atleast_2d(np.asarray(am, dtype=float))
    column = np.asarray(b, dtype=float).reshape(-1, 1)
    n = len(a)
    whole = np.block([[a, -column], [np.zeros((1, n)), np.array([[-bandwidth]])]])
    return LinearSystem(whole, np.vstack([column, [[bandwidth]]]), np.eye(n, n + 1))


def step_response(system: LinearSystem, dt: float, steps: int) -> Array:
    """Return the response of a linear system to a unit step of its first input, from rest, exact.

    Args:
        system: Linear system.
        dt: Time between two samples [s].
        steps: Number of steps.

    Returns:
        Outputs (steps + 1, outputs).
    """
    n = len(system.a)
    with_input = np.block([[system.a, system.b[:, :1]], [np.zeros((1, n + 1))]])
    states = _free_response(matrix_exp(with_input * dt), np.eye(n + 1)[n], steps)
    return np.asarray(states[:, :n] @ system.c.T)


def l1_norm_of_outputs(system: LinearSystem) -> Array:
    """Return the L1 norm (outputs,) of each output of a linear system.

    It is the sum over the inputs of the integrals of |h(t)|, the impulse response.

    Args:
        system: Stable linear system.
    """
    integrals = np.empty((len(system.c), system.b.shape[1]))
    for i, c in enumerate(system.c):
        for j, b in enumerate(system.b.T):
            integrals[i, j] = _absolute_integral(system.a, b, c)
    return np.asarray(np.sum(integrals, axis=1))


def l1_norm(system: LinearSystem) -> float:
    """Return the L1 norm of a stable linear system.

    It is the largest gain from bounded input to bounded output.

    Args:
        system: Stable linear system.
    """
    return float(np.max(l1_norm_of_outputs(system)))


def l1_condition_value(norm: float, slope: float) -> float:
    """Return the left side of the L1-norm stability condition, a norm times a slope.

    Below 1 the adaptive loop is bounded for uncertainties of at most this slope.

    Args:
        norm: L1 norm [s].
        slope: Lipschitz constant of the uncertainty [1/s].
    """
    return norm * slope


def _absolute_integral(a: Array, b: Array, c: Array) -> float:
    """Return the integral over t > 0 of |c e^(At) b| for a stable A.

    Between two zeros of h the integral is c A^-1 (x2 - x1), exact; the zeros are located by
    bisection.
    """
    primitive = np.linalg.solve(a.T, c)
    total, start = 0.0, b
    for dt, steps in _integration_steps(a):
        x = _free_response(matrix_exp(a * dt), start, steps)
        h, halves = x @ c, [matrix_exp(a * dt * 0.5**k) for k in range(1, 40)]
        total += float(np.sum(np.abs(np.diff(x @ primitive))))
        for i in np.nonzero(h[:-1] * h[1:] < 0.0)[0]:
            at = _bisect_zero_crossing(halves, x[i], c)
            total += (
                abs(primitive @ (at - x[i]))
                + abs(primitive @ (x[i + 1] - at))
                - abs(primitive @ (x[i + 1] - x[i]))
            )
        start = x[-1]
    return total


def _integration_steps(a: Array) -> list[tuple[float, int]]:
    """Return steps [s] and their numbers: twenty per radian of the fastest mode above 1e-13."""
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


def _free_response(once: Array, start: Array, steps: int) -> Array:
    """Return the states (steps + 1, n) of x(k+1) = once x(k), computed by repeated doubling."""
    x, power = start[None, :], once
    while len(x) <= steps:
        x, power = np.vstack([x, x @ power.T]), power @ power
    return np.asarray(x[: steps + 1])


def _bisect_zero_crossing(halves: list[Array], x: Array, c: Array) -> Array:
    """Return the state where c x first changes its sign, by bisection with steps dt / 2^(k+1)."""
    for half in halves:
        later = half @ x
        if (c @ later) * (c @ x) > 0.0:
            x = later
    return x


@dataclass(frozen=True)
class LoopMargins:
    """Crossover frequency, phase margin and delay margin of a feedback loop.

    Of several crossovers it is the one that allows the least extra delay.
    """

    crossover: float  # [rad/s] where |L| is 1
    phase: float  # [rad] lag that may be added at the crossover
    delay: float  # [s] pure delay that may be added; 0 for an unstable loop
    stable: bool


def loop_margins(
    loop: Loop, low: float = 1e-4, high: float = HIGHEST, points: int = 20000
) -> LoopMargins:
    """Return crossover, phase margin and delay margin of a loop L(s) under negative feedback.

    The loop must have no pole in the right half plane. Outside low..high it must consist of
    integrators below and have |L| < 1 above.

    Args:
        loop: L(s) for s = j omega.
        low: Lowest frequency [rad/s].
        high: Highest frequency [rad/s].
        points: Number of frequencies.
    """
    omega = np.geomspace(low, high, points)
    response = loop(np.asarray(1j * omega))
    above = np.abs(response) > 1.0
    found = [
        _crossover(loop, omega[i], omega[i + 1]) for i in np.nonzero(above[:-1] != above[1:])[0]
    ]
    stable = _is_stable(omega, response)
    if not found:
        return LoopMargins(0.0, inf, inf, stable)
    lag = {w: float(np.angle(-loop(np.array([1j * w]))[0])) for w in found}
    worst = min(found, key=lambda w: (lag[w] % (2.0 * pi)) / w)
    delay = (lag[worst] % (2.0 * pi)) / worst
    return LoopMargins(worst, lag[worst], delay if stable else 0.0, stable)


def _crossover(loop: Loop, low: float, high: float) -> float:
    """Return the frequency between low and high at which |L| is 1, by bisection."""
    rising = abs(loop(np.array([1j * high]))[0]) > 1.0
    for _ in range(50):
        middle = 0.5 * (low + high)
        if (abs(loop(np.array([1j * middle]))[0]) > 1.0) == rising:
            high = middle
        else:
            low = middle
    return 0.5 * (low + high)


def _is_stable(omega: Array, response: Complex) -> bool:
    """Apply Nyquist's criterion: without unstable poles 1 + L turns 90 deg per integrator."""
    integrators = round(
        -float(np.diff(np.log(np.abs(response[:2])))[0] / np.diff(np.log(omega[:2]))[0])
    )
    turned = np.unwrap(np.angle(1.0 + response))
    return bool(abs(turned[-1] - turned[0] - 0.5 * pi * integrators) < 0.5 * pi)


@dataclass(frozen=True)
class LoopChannel:
    """Feedback loop of one axis with a continuous controller, for an analysis of its margins.

    The plant is x' = -damping x + (input gain) tau / I0; the position is the integral of x. tau
    passes a zero-order hold of mean delay `hold_s` (half a sample time) and a lag `servo_lag_s`.
    The controller is the L1 law tau = I0 pole x_ref - C sigma with x_ref = heading_gain (position
    error) and C = bandwidth / (s + bandwidth), where sigma is I0 (x' + pole x) - tau, the limit of
    fast adaptation; or a PID on the position with gains divided by I0.
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
    damping: float = 0.0  # [1/s] linear damping of the boat

    @property
    def highest_frequency(self) -> float:
        """Highest frequency [rad/s] at which the continuous feedback loop is analysed."""
        return HIGHEST

    def open_loop_response(self, gain: float) -> Loop:
        """Return the open-loop frequency response L(s) of a continuous feedback loop.

        The loop is broken at the plant input.

        Args:
            gain: Ratio of the true to the assumed input gain of the plant.
        """

        def frequency_response(s: Complex) -> Complex:
            held = (
                -np.expm1(-2.0 * self.hold_s * s) / (2.0 * self.hold_s * s)
                if self.hold_s > 0.0
                else 1.0
            )
            actuator = gain * held / (1.0 + self.servo_lag_s * s)
            return np.asarray(self._controller_response(s) * actuator / (s * (s + self.damping)))

        return frequency_response

    def _controller_response(self, s: Complex) -> Complex:
        """Return -tau / (I0 position) with the filter loop of the controller closed."""
        if self.pid is not None:
            kp, ki, kd = self.pid
            return np.asarray(kp + ki / s + kd * s)
        unfiltered_again = (s + self.bandwidth) / s  # 1/(1 - C)
        return np.asarray(
            self.pole * self.heading_gain * unfiltered_again + self.bandwidth * (s + self.pole)
        )

    def l1_norm(self, gain: float) -> float | None:
        """Return the L1 norm [s] of (1 - C) / (s + pole), which bounds an L1 adaptive loop.

        C is the low-pass filter. None for a PID.

        Args:
            gain: Ratio of the true to the assumed input gain; C = gain bandwidth / (s + gain
                bandwidth).
        """
        if self.pid is not None:
            return None
        return l1_norm(uncertainty_to_state_system([[-self.pole]], [1.0], gain * self.bandwidth))


@dataclass(frozen=True)
class SampledLoop:
    """Feedback loop of one axis with a sampled controller, for an exact analysis of its margins.

    The plant is x' = -damping x + (input gain) a with a held input; the position is the integral of
    x. The controller is a = -(position law(z)[0] + rate law(z)[1]) with its inner loops closed.
    Both are stable except for the integrator of the plant. The delay margin follows from the phase
    and need not be a multiple of the sample time.
    """

    name: str
    law: Law
    damping: float  # [1/s] linear damping of the boat
    period: float  # [s]
    input_gain: tuple[float, ...] = (1.0,)  # true over assumed
    pole: float = 0.0  # [1/s] of the predictor

    @property
    def highest_frequency(self) -> float:
        """Highest frequency [rad/s] at which the sampled loop is analysed.

        It is half the sampling rate.
        """
        return pi / self.period

    def open_loop_response(self, gain: float) -> Loop:
        """Return the open-loop frequency response L(s) of a sampled feedback loop, z = e^(sT).

        The loop is broken at the plant input.

        Args:
            gain: Ratio of the true to the assumed input gain of the plant.
        """
        decay = exp(-self.damping * self.period)
        # F and g of the plant over one period, zero-order hold
        rate_gain = (1.0 - decay) / self.damping
        place_gain = (self.period - rate_gain) / self.damping

        def frequency_response(s: Complex) -> Complex:
            z = np.exp(s * self.period)
            rate = rate_gain / (z - decay)
            place = (rate_gain * rate + place_gain) / (z - 1.0)
            to_place, to_rate = self.law(z)
            return np.asarray(gain * (to_place * place + to_rate * rate))

        return frequency_response

    def l1_norm(self, gain: float) -> float | None:
        """Return None: the L1-norm condition applies to continuous loops, and this one is sampled.

        Args:
            gain: Ratio of the true to the assumed input gain of the plant.
        """
        return None
