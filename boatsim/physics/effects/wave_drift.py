"""Wave drift: mean and slowly varying force of a measured wave."""

from dataclasses import dataclass
from math import cos, exp, inf, sin, sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import (
    UNSET,
    Array,
    Boat,
    FilteredSignal,
    Force,
    Role,
    SignalSegment,
    Wrench,
    param,
    wrench,
)
from boatsim.physics.particulars import GRAVITY

# Time constant in 1 / natural frequency of heave: the square of a wave swings at twice its
# frequency, and two lags of this length reduce that to a tenth
SMOOTH = 1.5


@njit(inline="always")
def store_lag_states(act: Array, own: Any, first: float, second: float) -> None:
    """Store the states of the two lags of the mean square among the actuator signals.

    Args:
        act: Values of the signals.
        own: Index of the first result.
        first: Output of the first lag [m^2].
        second: Output of the second lag [m^2].
    """
    act[own] = first
    act[own + 1] = second


@njit(inline="always")
def advance_two_lags(x: float, first: float, second: float, ratio: float) -> Any:
    """Advance two equal lags in series by a step under a constant input, exactly.

    Args:
        x: Input.
        first: Output of the first lag.
        second: Output of the second lag.
        ratio: Step over the time constant.

    Returns:
        Outputs of both lags at the end of the step.
    """
    decay = exp(-ratio)
    rest = first - x
    return x + rest * decay, x + (second - x + ratio * rest) * decay


@njit
def filter_signal(
    x: SignalSegment, act: Array, held: Any, own: Any, memory: Array, at: Any, dt: float, q: Any
) -> None:
    """Filter the square of the measured elevation over one step by two lags in series.

    Args:
        x: Measured elevation [m] over the step.
        act: Values of the signals; results are stored at `own` in each row.
        held: Number of signals in a row.
        own: Index of the first result.
        memory: States of all filters.
        at: Index of the first state.
        dt: Length of the step [s].
        q: Parameters of the effect.
    """
    mean = (x.begin + 4.0 * x.middle + x.end) / 6.0
    half = 0.5 * dt / q.smoothing
    first, second = memory[at], memory[at + 1]
    store_lag_states(act, own, first, second)
    first, second = advance_two_lags(mean * mean, first, second, half)
    store_lag_states(act, held + own, first, second)
    first, second = advance_two_lags(mean * mean, first, second, half)
    store_lag_states(act, 2 * held + own, first, second)
    memory[at], memory[at + 1] = first, second


@njit(inline="always")
def longest_filter_step(q: Any) -> float:
    """Return the longest step [s] over which three points describe the mean square of the wave.

    Args:
        q: Parameters of the effect.
    """
    return q.smoothing if q.smoothing > 0.0 else inf


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Return the drift force, in proportion to the mean square of the measured wave.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect, and the mean square of the wave.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    square = s.mean_square
    sway = q.sway * square
    return wrench(X=q.surge * square, Y=cos(m.phi) * sway, Z=-sin(m.phi) * sway, K=q.roll * square)


@dataclass(frozen=True)
class WaveDrift(FilteredSignal, Force):
    """Mean and slow drift force of a measured wave, in proportion to the square of its height.

    X_i = d_i <eta^2>,  i = surge, sway, roll

    <eta^2> is the mean square of the elevation over about a period, by two lags with the time
    constant `smoothing`. By Maruo's formula for beam waves d = rho g L R^2, where R is the
    amplitude of the reflected wave over that of the incident one, so that sway is at most
    rho g L.
    """

    formula: ClassVar[str] = (
        r"X_i = d_i \, \overline{\eta^2}, \quad \overline{\eta^2}(s) = \frac{\eta^2(s)}{(1 + T "
        r"s)^2}"
    )
    symbols: ClassVar = {"surge": "d_X", "sway": "d_Y", "roll": "d_K", "smoothing": "T"}
    ruled_out_by: ClassVar = {"no_waves": (True,)}
    words: ClassVar[str] = (
        "waves push the hull slowly, in proportion to the square of their height (drift force)"
    )
    shown_by: ClassVar[str] = "waves of two heights"
    source: ClassVar[str] = "H. Maruo, The drift of a body floating on waves, J. Ship Research 1960"
    roles: ClassVar = {"elevation": Role("m", "elevation of the wave at the hull, up")}
    filtered: ClassVar = ("lagged_square", "mean_square")
    filter_states: ClassVar = 2
    law: ClassVar = law
    filter_signal: ClassVar = filter_signal
    longest_filter_step: ClassVar = longest_filter_step

    sway: float = param(
        0.0,
        low=-1e9,
        high=1e9,
        unit="N/m^2",
        words="sway force per mean square of the elevation",
        fit=True,
        spread=300.0,
        axis="sway",
        calibrates="wave",
    )
    surge: float = param(
        0.0,
        low=-1e9,
        high=1e9,
        unit="N/m^2",
        words="surge force per mean square of the elevation",
        fit=True,
        spread=300.0,
        axis="surge",
        calibrates="wave",
    )
    roll: float = param(
        0.0,
        low=-1e10,
        high=1e10,
        unit="N/m",
        words="roll moment per mean square of the elevation",
        axis="roll",
    )
    smoothing: float = param(
        UNSET,
        low=1e-3,
        high=1e4,
        unit="s",
        words="time constant of each of two lags; default: 1.5 / sqrt(g / 2 T)",
    )

    def wave_axes(self) -> tuple[str, ...]:
        """Return the degrees of freedom with coefficients; empty if all are zero."""
        if self.surge == self.sway == self.roll == 0.0:
            return ()
        return ("surge", "sway", "roll")

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the default time constant of the mean [s], from the natural period of heave.

        Args:
            vessel: Vessel with a draught [m].
        """
        return {"smoothing": SMOOTH / sqrt(0.5 * GRAVITY / vessel.draught)}
