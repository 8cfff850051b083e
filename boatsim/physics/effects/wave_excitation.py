"""Wave excitation: forces of a measured wave on sway, heave and roll."""

from dataclasses import dataclass
from math import ceil, cos, exp, inf, sin, sqrt
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

DENSITY = 1000.0  # [kg/m^3] of fresh water
SUBSTEP = 0.5  # of Runge-Kutta in 1 / bandwidth, which keeps its error below 1e-3
SETTLED = 100.0  # steps longer than this [1 / bandwidth] lead to the steady state
# Share of the reference frequency squared over which the slope of the attenuation is taken
SLOPE = 0.1
# Bandwidth over the natural frequency of heave: a hull answers to waves of up to twice that
WIDE = 8.0


@njit(inline="always")
def advance_butterworth_filter(
    x: SignalSegment, a: float, b: float, c: float, w: float, dt: float
) -> tuple[float, float, float]:
    """Advance a Butterworth filter of third order by a step, by Runge and Kutta.

    Args:
        x: Input at begin, middle and end of the step.
        a: Output.
        b: Rate of the output.
        c: Second derivative of the output.
        w: Bandwidth [rad/s].
        dt: Step [s], short against 1 / w.

    Returns:
        Output, rate and second derivative at the end of the step.
    """
    w2, w3 = w * w, w * w * w
    k1 = w3 * (x.begin - a) - 2.0 * w2 * b - 2.0 * w * c
    a2, b2, c2 = a + 0.5 * dt * b, b + 0.5 * dt * c, c + 0.5 * dt * k1
    k2 = w3 * (x.middle - a2) - 2.0 * w2 * b2 - 2.0 * w * c2
    a3, b3, c3 = a + 0.5 * dt * b2, b + 0.5 * dt * c2, c + 0.5 * dt * k2
    k3 = w3 * (x.middle - a3) - 2.0 * w2 * b3 - 2.0 * w * c3
    a4, b4, c4 = a + dt * b3, b + dt * c3, c + dt * k3
    k4 = w3 * (x.end - a4) - 2.0 * w2 * b4 - 2.0 * w * c4
    sixth = dt / 6.0
    return (
        a + sixth * (b + 2.0 * b2 + 2.0 * b3 + b4),
        b + sixth * (c + 2.0 * c2 + 2.0 * c3 + c4),
        c + sixth * (k1 + 2.0 * k2 + 2.0 * k3 + k4),
    )


@njit(inline="always")
def bounded_ramp(level: float, target: float, slope: float, after: float) -> float:
    """Return a level that moves towards a target and stops there.

    Args:
        level: Level now.
        target: Level at which it stops.
        slope: Rate of change, towards the target [1/s].
        after: Time from now on [s].
    """
    moved = level + slope * after
    if (target - level) * (target - moved) <= 0.0:
        return target
    return moved


@njit(inline="always")
def start_ramp_to_sample(x: float, memory: Array, at: Any, dt: float) -> None:
    """Start a ramp to a new sample of the input, as long as the last one was held.

    Samples that arrive at one rate are thus interpolated linearly.

    Args:
        x: Sample in force.
        memory: States of all filters.
        at: Index of the first state: level, target, slope, time since the target changed.
        dt: Length of the step that begins [s].
    """
    if x != memory[at + 1]:
        held = memory[at + 3]
        if held <= 0.0:
            held = dt
        memory[at + 1] = x
        memory[at + 2] = (x - memory[at]) / held
        memory[at + 3] = 0.0
    memory[at + 3] += dt


@njit
def filter_signal(
    x: SignalSegment, act: Array, held: Any, own: Any, memory: Array, at: Any, dt: float, q: Any
) -> None:
    """Filter the measured elevation over one step, and store elevation, rate and acceleration.

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
    w, ramp = q.bandwidth, at + 3
    a, b, c = memory[at], memory[at + 1], memory[at + 2]
    if w * dt > SETTLED:
        a, b, c = x.end, 0.0, 0.0
        memory[ramp], memory[ramp + 1], memory[ramp + 2], memory[ramp + 3] = x.end, x.end, 0.0, 0.0
        for row in range(3):
            store_wave_kinematics(act, row * held + own, a, b, c)
    else:
        start_ramp_to_sample(x.begin, memory, ramp, dt)
        level, target, slope = memory[ramp], memory[ramp + 1], memory[ramp + 2]
        count = 2 * max(1, ceil(0.5 * w * dt / SUBSTEP))
        part = dt / count
        store_wave_kinematics(act, own, a, b, c)
        for i in range(count):
            u = SignalSegment(
                bounded_ramp(level, target, slope, i * part),
                bounded_ramp(level, target, slope, (i + 0.5) * part),
                bounded_ramp(level, target, slope, (i + 1.0) * part),
            )
            a, b, c = advance_butterworth_filter(u, a, b, c, w, part)
            if 2 * (i + 1) == count:
                store_wave_kinematics(act, held + own, a, b, c)
        store_wave_kinematics(act, 2 * held + own, a, b, c)
        memory[ramp] = bounded_ramp(level, target, slope, dt)
    memory[at], memory[at + 1], memory[at + 2] = a, b, c


@njit(inline="always")
def store_wave_kinematics(act: Array, own: Any, a: float, b: float, c: float) -> None:
    """Store elevation, rate and acceleration of the filtered wave among the actuator signals.

    Args:
        act: Values of the signals.
        own: Index of the first result.
        a: Output of the filter [m].
        b: Its rate [m/s].
        c: Its second derivative [m/s^2].
    """
    act[own] = a
    act[own + 1] = b
    act[own + 2] = c


@njit(inline="always")
def longest_filter_step(q: Any) -> float:
    """Return the longest step [s] over which three points describe the filtered wave.

    Args:
        q: Parameters of the effect.
    """
    return 2.0 / q.bandwidth if q.bandwidth > 0.0 else inf


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Return the force of a measured wave, linear in elevation, rate and acceleration.

    Sway and heave are level and vertical, whatever the heel.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect, and the filtered wave.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    e, v, a = s.filtered_elevation, s.elevation_rate, s.elevation_acceleration
    level = q.sway_elevation * e + q.sway_rate * v + q.sway_acceleration * a
    down = q.heave_elevation * e + q.heave_rate * v + q.heave_acceleration * a
    c, n = cos(m.phi), sin(m.phi)
    return wrench(
        Y=c * level + n * down,
        Z=c * down - n * level,
        K=q.roll_elevation * e + q.roll_rate * v + q.roll_acceleration * a,
    )


def response_parameter(axis: str, part: str, unit: str, spread: float, high: float) -> float:
    """Declare one coefficient of the response to the wave as a parameter.

    Args:
        axis: Degree of freedom.
        part: "elevation", "rate" or "acceleration".
        unit: Unit of the coefficient.
        spread: Prior standard deviation, for a hull of 1.2 m and 4.6 kg.
        high: Largest size.
    """
    return param(
        UNSET,
        low=-high,
        high=high,
        unit=unit,
        words=f"{axis} force per {part} of the wave",
        fit=True,
        spread=spread,
        axis=axis,
        calibrates="wave",
    )


@dataclass(frozen=True)
class WaveExcitation(FilteredSignal, Force):
    """Force of a measured wave on sway, heave and roll: Froude-Krylov force and diffraction.

    X_i = c_i eta + b_i eta' + a_i eta'',  i = sway, heave, roll

    The forces in sway and heave are level and vertical, as the pressure of the wave.

    eta is the elevation of the incident wave at the hull [m, up], a recorded channel. Elevation,
    rate and acceleration come from a low-pass filter of third order with `bandwidth` w. The
    response has another size and phase at each frequency, as diffraction theory requires. The
    filter is late by 2 / w; a replay and a diagnosis know the recorded wave and lead it by that
    time.

    With `undisturbed` = 1 coefficients that are not given follow from the pressure of the
    undisturbed wave on a box of the vessel's length, beam and draught in beam waves, about the
    frequency `reference`: heave with the attenuation exp(-k T) sin(k B / 2) / (k B / 2) and its
    slope there, sway and roll in quadrature with the elevation. Waves come from starboard with
    `side` = 1, from port with -1.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} X_i &= c_i \, \eta + b_i \, \dot\eta + a_i \, \ddot\eta, \quad i = Y, Z, "
        r"K \\ \eta(s) &= \frac{\omega_c^3 \, \eta_m(s)}{(s + \omega_c)(s^2 + \omega_c s + "
        r"\omega_c^2)} \end{aligned}"
    )
    symbols: ClassVar = {
        "sway_elevation": "c_Y",
        "sway_rate": "b_Y",
        "sway_acceleration": "a_Y",
        "heave_elevation": "c_Z",
        "heave_rate": "b_Z",
        "heave_acceleration": "a_Z",
        "roll_elevation": "c_K",
        "roll_rate": "b_K",
        "roll_acceleration": "a_K",
        "bandwidth": r"\omega_c",
        "density": r"\rho",
    }
    ruled_out_by: ClassVar = {"no_waves": (True,)}
    words: ClassVar[str] = "the measured wave exerts other forces on the hull than in the model"
    shown_by: ClassVar[str] = "waves of several periods"
    source: ClassVar[str] = (
        "O. M. Faltinsen, Sea Loads on Ships and Offshore Structures, 1990, chapter 3"
    )
    roles: ClassVar = {"elevation": Role("m", "elevation of the wave at the hull, up")}
    filtered: ClassVar = ("filtered_elevation", "elevation_rate", "elevation_acceleration")
    filter_states: ClassVar = 7
    law: ClassVar = law
    filter_signal: ClassVar = filter_signal
    longest_filter_step: ClassVar = longest_filter_step

    heave_elevation: float = response_parameter("heave", "elevation", "N/m", 100.0, 1e12)
    heave_rate: float = response_parameter("heave", "rate", "N s/m", 20.0, 1e12)
    heave_acceleration: float = response_parameter("heave", "acceleration", "kg", 4.0, 1e12)
    roll_elevation: float = response_parameter("roll", "elevation", "N", 5.0, 1e13)
    roll_rate: float = response_parameter("roll", "rate", "N s", 2.0, 1e13)
    roll_acceleration: float = response_parameter("roll", "acceleration", "kg m", 0.5, 1e13)
    sway_elevation: float = response_parameter("sway", "elevation", "N/m", 50.0, 1e12)
    sway_rate: float = response_parameter("sway", "rate", "N s/m", 20.0, 1e12)
    sway_acceleration: float = response_parameter("sway", "acceleration", "kg", 4.0, 1e12)
    undisturbed: float = param(
        0.0,
        low=0.0,
        high=1.0,
        unit="",
        words="1: coefficients from the pressure of the undisturbed wave on a box",
    )
    side: float = param(
        1.0, low=-1.0, high=1.0, unit="", words="1: waves come from starboard, -1: from port"
    )
    density: float = param(
        DENSITY, low=900.0, high=1100.0, unit="kg/m^3", words="density of the water"
    )
    reference: float = param(
        UNSET,
        low=0.01,
        high=100.0,
        unit="rad/s",
        words="frequency about which the pressure is evaluated; default: sqrt(g / 2 T)",
    )
    bandwidth: float = param(
        UNSET,
        low=0.1,
        high=1000.0,
        unit="rad/s",
        words="bandwidth of the filter of the wave; default: 8 sqrt(g / 2 T)",
    )

    @property
    def lookahead(self) -> float:
        """Delay of the filter at low frequencies [s]; a recorded wave is read so much ahead."""
        if not self.has_value("bandwidth"):
            return 0.0
        return 2.0 / self.bandwidth

    def wave_axes(self) -> tuple[str, ...]:
        """Return the degrees of freedom with coefficients; empty if all are zero."""
        for name in type(self).symbols:
            if name.startswith(("sway", "heave", "roll")) and getattr(self, name) != 0.0:
                return ("sway", "heave", "roll")
        return ()

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the coefficients of the undisturbed wave's pressure, and the bandwidth.

        Args:
            vessel: Vessel with length, beam and draught [m].

        Returns:
            Name of the parameter -> value.
        """
        natural = sqrt(0.5 * GRAVITY / vessel.draught)
        found = {"reference": natural, "bandwidth": WIDE * natural}
        if not self.undisturbed:
            return found
        reference = natural
        if self.has_value("reference"):
            reference = self.reference
        return found | box_pressure_coefficients(vessel, reference, self.density, self.side)


def box_pressure_coefficients(
    vessel: Boat, frequency: float, density: float, side: float = 1.0
) -> dict[str, float]:
    """Return the coefficients of the pressure of an undisturbed beam wave on a box, deep water.

    Args:
        vessel: Vessel with length, beam and draught [m].
        frequency: Frequency about which the response is evaluated [rad/s].
        density: Density of the water [kg/m^3].
        side: 1 for waves from starboard, -1 from port.

    Returns:
        Name of the parameter -> value.
    """
    weight = density * GRAVITY * vessel.length  # [N/m^2] per area of the section
    squared = frequency * frequency
    # attenuation alpha - beta w^2 about the reference, hence an elevation and an acceleration
    beyond = squared * (1.0 + SLOPE)
    at, after = pressure_attenuation(squared, vessel), pressure_attenuation(beyond, vessel)
    beta = (at - after) / (beyond - squared)
    alpha = at + beta * squared
    k = squared / GRAVITY
    half, depth = 0.5 * k * vessel.beam, k * vessel.draught
    difference = 2.0 * sin(half) / frequency  # [s] of the elevation on both sides, per rate
    sides = difference * (1.0 - exp(-depth)) / k
    bottom = exp(-depth) * 2.0 * (sin(half) - half * cos(half)) / (k * k * frequency)
    lever = difference * (1.0 - exp(-depth) * (1.0 + depth)) / (k * k)
    return {
        "heave_elevation": -weight * vessel.beam * alpha,
        "heave_rate": 0.0,
        "heave_acceleration": -weight * vessel.beam * beta,
        "sway_elevation": 0.0,
        "sway_rate": -side * weight * sides,
        "sway_acceleration": 0.0,
        "roll_elevation": 0.0,
        "roll_rate": side * weight * (lever - bottom),
        "roll_acceleration": 0.0,
    }


def pressure_attenuation(squared: float, vessel: Boat) -> float:
    """Return the mean pressure on the bottom of a box over that at the surface amidships.

    Args:
        squared: Frequency squared [rad^2/s^2].
        vessel: Vessel with beam and draught [m].
    """
    k = squared / GRAVITY
    half = 0.5 * k * vessel.beam
    return exp(-k * vessel.draught) * sin(half) / half
