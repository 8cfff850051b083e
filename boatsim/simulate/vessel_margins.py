"""Stability margins of a controller on a vessel: from the linearised loop, and by simulation.

The linearised loop consists of the sampled control law and of the vessel's own motion over one
control period, with its actuators, lags and hull, at a steady motion. The extra delay that it
tolerates follows from the crossovers of its characteristic loci (MacFarlane and Postlethwaite
1977), because an equal delay of all commands turns every locus alike. Its agreement with the
simulated delay checks both.
"""

from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, replace
from math import degrees, exp, inf, nan, pi
from typing import Any

import numpy as np

from boatsim.control.adaptive import Complex
from boatsim.control.base import Controller, Sense
from boatsim.control.operating_points import FeedbackLoop, OperatingPoint
from boatsim.errors import BadInput, BadPhysics
from boatsim.physics.content import load_class, shipped_content_names, snake_case
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate.interval_map import SUBSTEPS, has_derivative
from boatsim.simulate.linearisation import LinearVessel, linearise_vessel
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.stepper import State
from boatsim.simulate.vessel_model import introduce_vessel

LOWEST = 1e-5  # [rad/s] lowest frequency, below the slowest drift of a boat at rest (0.004 1/s)
POINTS = 20000  # frequencies of the analysis
# velocity that a set point demands
VELOCITY_OF_GOAL = {"surge_mps": "u", "sway_mps": "v", "yaw_radps": "r"}
UNDISTURBED = 0.2  # of the pulse: rounded commands alone cause up to 0.12 near the margin
COUPLED = 1e-6  # a mode that takes a smaller share in a loop than this is no part of it
AVERAGED = 20.0  # [s] over which the steady motion is averaged: about ten oscillations
WATCHED = 80.0  # [s] of simulation from which stability is judged: six to forty oscillations
LARGEST_DELAY = 5.0  # [s] a loop that tolerates more is not limited by delay
RESOLUTION = 0.005  # of the delay by bisection, a tenth of the agreement asked for


@dataclass(frozen=True)
class VesselMargin:
    """Stability margin of a controller's loops at one steady motion of a vessel."""

    point: str
    crossover: float  # [rad/s]
    phase_deg: float  # [deg]
    delay_s: float  # [s] from the linearised loop; 0 if it is unstable
    simulated_delay_s: float  # [s] at which a simulation stops being stable
    ignored: tuple[str, ...] = ()  # effects of the vessel that the linearised loop leaves out

    @property
    def difference(self) -> float:
        """Relative difference of the analytic from the simulated delay margin.

        It is 0 if both exceed the longest delay that is simulated.
        """
        if self.simulated_delay_s == inf and self.delay_s >= LARGEST_DELAY:
            return 0.0
        if self.simulated_delay_s == 0.0:
            return 0.0 if self.delay_s == 0.0 else inf
        return self.delay_s / self.simulated_delay_s - 1.0


def margins_on_vessel(controller: Controller, vessel: Vessel) -> list[VesselMargin]:
    """Return the delay margins of a controller on a vessel, analytic and simulated.

    Args:
        controller: Controller with `operating_points`.
        vessel: The vessel.

    Raises:
        BadInput: The controller has no `operating_points`, or does not fit the vessel.
    """
    describe = getattr(controller, "operating_points", None)
    if describe is None:
        able = []
        for name in shipped_content_names("controller"):
            if hasattr(load_class("controller", name), "operating_points"):
                able.append(name)
        raise BadInput(
            f"controller {snake_case(type(controller).__name__)!r} describes no operating_points "
            f"(these do: {', '.join(able)})"
        )
    introduce_vessel(controller, vessel)
    for name in controller.channels():
        if name not in vessel.commands:
            raise BadInput(
                f"controller {snake_case(type(controller).__name__)} does not fit {vessel.name}: "
                f"{vessel.unknown_command_message(name)}"
            )
    return [_margin_at(controller, vessel, number) for number in range(len(describe()))]


def _margin_at(controller: Any, vessel: Vessel, number: int) -> VesselMargin:
    point: OperatingPoint = controller.operating_points()[number]
    steady = _simulate(controller, vessel, point, 0.0, point.settle)
    state, commands = _mean_motion(steady, controller.period)
    linear = linearise_vessel(vessel, state, commands, controller.period)
    # a controller may have identified its actuators meanwhile
    loops = steady.controller.operating_points()[number].loops
    crossover, phase, delay = delay_margin(linear, loops, commands)
    ignored = []
    for effect in vessel.effects:
        if not has_derivative(effect):
            ignored.append(effect.name)
    simulated = simulated_delay_margin(controller, vessel, point)
    return VesselMargin(point.name, crossover, degrees(phase), delay, simulated, tuple(ignored))


# Linearised loop
# ------------------------------------------------------------------------------------------------


def delay_margin(
    linear: LinearVessel, loops: Sequence[FeedbackLoop], commands: Mapping[str, float]
) -> tuple[float, float, float]:
    """Return crossover [rad/s], phase margin [rad] and delay margin [s] of a linearised loop.

    They are those of the crossover that allows the least delay. All loops are closed at once and
    all commands are delayed alike.

    Args:
        linear: The vessel.
        loops: The feedback loops.
        commands: Commands of the steady motion by channel.
    """
    omega = np.geomspace(LOWEST, pi / linear.period, POINTS)
    forward, inner = _open_loop(linear, loops, commands, omega)
    loci = np.linalg.eigvals(np.linalg.solve(inner, forward))
    determinant = np.linalg.det(inner + forward)
    if not _is_stable(omega, determinant, _unstable_poles(linear, loops, commands)):
        return nan, nan, 0.0
    found: list[tuple[float, float, float]] = []
    order = np.argsort(np.abs(loci), axis=1)
    loci = np.take_along_axis(loci, order, axis=1)
    # each size, from the smallest to the largest, is continuous in the frequency
    for sizes, locus in zip(np.log(np.abs(loci)).T, loci.T, strict=True):
        for i in np.nonzero((sizes[:-1] > 0.0) != (sizes[1:] > 0.0))[0]:
            share = sizes[i] / (sizes[i] - sizes[i + 1])
            w = float(omega[i] + share * (omega[i + 1] - omega[i]))
            phase = float(np.angle(-locus[i]))
            found.append(((phase % (2.0 * pi)) / w, w, phase))
    if not found:
        return nan, inf, inf
    delay, crossover, phase = min(found)
    return crossover, phase, delay


def _open_loop(
    linear: LinearVessel,
    loops: Sequence[FeedbackLoop],
    commands: Mapping[str, float],
    omega: Array,
) -> tuple[Complex, Complex]:
    """Response of the loop, broken at the outputs of the control laws, as two factors.

    It is inner^-1 forward, both (N, loops, loops). `forward` contains vessel and measurements,
    `inner` the feedback of the applied forces within the control laws.
    """
    n, count = len(linear.a), len(loops)
    b = _input_matrix(linear, loops, commands)
    z = np.exp(1j * omega * linear.period)
    states = np.linalg.solve(z[:, None, None] * np.eye(n) - linear.a, b.astype(complex))
    matrix = np.empty((len(omega), count, count), dtype=complex)
    inner = np.empty_like(matrix)
    for i, loop in enumerate(loops):
        to_position, to_velocity, to_applied = loop.law(z)
        matrix[:, i] = to_velocity[:, None] * states[:, linear.outputs[loop.measured]]
        if loop.measured == "r":
            matrix[:, i] += to_position[:, None] * states[:, linear.outputs["psi"]]
        for j, other in enumerate(loops):
            applied = other.wrench_slopes(commands).get(loop.axis, 0.0)
            inner[:, i, j] = float(i == j) - to_applied * applied
    late = np.exp(-1j * omega * linear.delay)
    return np.asarray(matrix * late[:, None, None]), inner


def _input_matrix(
    linear: LinearVessel, loops: Sequence[FeedbackLoop], commands: Mapping[str, float]
) -> Array:
    """Change (n, loops) of the vessel's state per unit of each control law's output."""
    slopes = np.zeros((len(linear.commands), len(loops)))
    for j, loop in enumerate(loops):
        for name, slope in loop.command_slopes(commands).items():
            slopes[linear.commands.index(name), j] = slope
    return np.asarray(linear.b @ slopes)


def _unstable_poles(
    linear: LinearVessel, loops: Sequence[FeedbackLoop], commands: Mapping[str, float]
) -> int:
    """Number of unstable poles of the vessel that the loops excite and measure.

    A boat that is directionally unstable straight ahead has one in yaw, which surge does not see.
    """
    poles, modes = np.linalg.eig(linear.a)
    excited = np.abs(np.linalg.solve(modes, _input_matrix(linear, loops, commands).astype(complex)))
    if not excited.any():
        return 0
    rows = [linear.outputs[loop.measured] for loop in loops]
    measured = np.abs(modes[rows])
    count = 0
    for i, pole in enumerate(poles):
        share = excited[i].max() / excited.max() * measured[:, i].max()
        if abs(pole) > exp(LOWEST * linear.period) and share > COUPLED:
            count += 1
    return count


def _is_stable(omega: Array, determinant: Complex, unstable: int) -> bool:
    """Apply the generalised Nyquist criterion to the determinant of a return difference.

    It is given over the upper half of |z| = 1 and must have no unstable poles but those of the
    vessel. It turns by 90 deg for each integrator and by 180 deg for each unstable pole.
    """
    slope = np.diff(np.log(np.abs(determinant[:2])))[0] / np.diff(np.log(omega[:2]))[0]
    integrators = round(-float(slope))
    turned = np.unwrap(np.angle(determinant))
    expected = 0.5 * pi * integrators + pi * unstable
    return bool(abs(turned[-1] - turned[0] - expected) < 0.5 * pi)


# Simulation
# ------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Trace:
    """Samples of a closed-loop simulation, one for each control period."""

    controller: Any  # at the end
    states: list[State]
    commands: list[Mapping[str, float]]


def simulated_delay_margin(controller: Controller, vessel: Vessel, point: OperatingPoint) -> float:
    """Return the extra delay of all commands at which the simulated loop stops being stable [s].

    The loop settles without the delay. Then the delay begins and a pulse of the set point excites
    the loop. It counts as unstable if the pulsed velocity varies more (rms about its linear trend)
    in the second half of the following 80 s than in the first half or than the pulse is high, or
    if the motion diverges. The second limit is for oscillations that the actuators' limits have
    stopped from growing. Variations below a fifth of the pulse are those that the rounding of the
    commands causes and do not count. The delay is found by bisection.

    Args:
        controller: The controller.
        vessel: The vessel.
        point: The steady motion.

    Returns:
        The delay [s]: 0 for a loop that is unstable without it, infinite above 5 s.
    """
    if not _stays_stable(controller, vessel, point, 0.0):
        return 0.0
    low, high = 0.0, controller.period
    while _stays_stable(controller, vessel, point, high):
        if high >= LARGEST_DELAY:
            return inf
        low, high = high, 2.0 * high
    while high - low > RESOLUTION * high:
        middle = 0.5 * (low + high)
        if _stays_stable(controller, vessel, point, middle):
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


def _stays_stable(
    controller: Controller, vessel: Vessel, point: OperatingPoint, delay: float
) -> bool:
    """Whether the pulsed velocity varies less in the second half than in the first."""
    try:
        trace = _simulate(controller, vessel, point, delay, point.settle + WATCHED)
    except BadPhysics:
        return False
    period = controller.period
    begin = round((point.settle + point.pulse_length + delay) / period)
    middle = (begin + len(trace.states)) // 2
    for name, by in point.pulse.items():
        height = abs(by)
        velocities = np.array([getattr(s, VELOCITY_OF_GOAL[name]) for s in trace.states])
        before, after = _variation(velocities[begin:middle]), _variation(velocities[middle:])
        if after > min(max(before, UNDISTURBED * height), height):
            return False
    return True


def _variation(values: Array) -> float:
    """Root mean square of values about their linear trend."""
    at = np.arange(len(values), dtype=float)
    return float(np.std(values - np.polyval(np.polyfit(at, values, 1), at)))


def _mean_motion(trace: _Trace, period: float) -> tuple[State, Mapping[str, float]]:
    """Mean motion and mean commands at the end of a simulation."""
    last = round(AVERAGED / period)
    state = State(*np.mean(np.array(trace.states[-last:]), axis=0).tolist())
    commands = {}
    for name in trace.commands[-1]:
        commands[name] = float(np.mean([sent[name] for sent in trace.commands[-last:]]))
    return state, commands


def _simulate(
    controller: Controller, vessel: Vessel, point: OperatingPoint, delay: float, seconds: float
) -> _Trace:
    """Simulate a closed loop whose commands take effect late by `delay` from `point.settle` on."""
    law, period = deepcopy(controller), controller.period
    law.reset()
    engine = OpenWater(vessel, period / SUBSTEPS)
    engine.reset(State(), law.initial_commands())
    trace = _Trace(law, [], [])
    waiting: list[tuple[float, Mapping[str, float]]] = []  # when each command takes effect
    for k in range(round(seconds / period)):
        t = k * period
        goal = dict(point.goal)
        late = 0.0
        if t >= point.settle:
            late = delay
            if t < point.settle + point.pulse_length:
                for name, by in point.pulse.items():
                    goal[name] = goal.get(name, 0.0) + by
        trace.states.append(engine.state)
        trace.commands.append(law.step(_readings(engine, point.unmeasured), goal))
        waiting.append((t + late, trace.commands[-1]))
        _advance_period(engine, waiting, t, period)
    return trace


def _advance_period(
    engine: OpenWater, waiting: list[tuple[float, Mapping[str, float]]], t: float, period: float
) -> None:
    """Advance a vessel by one period; commands that take effect in it are removed from the list."""
    now, end, tiny = t, t + period, 1e-9 * period
    while waiting and waiting[0][0] < end - tiny:
        at, commands = waiting.pop(0)
        if at > now + tiny:
            _advance_by(engine, at - now)
            now = at
        engine.command(commands)
    _advance_by(engine, end - now)


def _advance_by(engine: OpenWater, seconds: float) -> None:
    """Advance a vessel in equal steps that are not longer than the engine's."""
    steps = max(1, int(np.ceil(seconds / engine.step - 1e-9)))
    engine.advance(steps, seconds / steps)


def _readings(engine: OpenWater, unmeasured: Sequence[str]) -> Sense:
    """Exact readings of all standard sensors but the missing ones."""
    s = engine.state
    ahead, starboard = engine.acceleration()
    felt = Sense(s.t, s.psi, s.r, ahead, starboard, s.u, s.v, s.x, s.y, s.phi, s.p)
    missing: dict[str, Any] = dict.fromkeys(unmeasured, nan)
    return replace(felt, **missing)


# Text
# ------------------------------------------------------------------------------------------------


def format_vessel_margins(found: Sequence[VesselMargin], vessel: Vessel) -> str:
    """Return a table of delay margins as text.

    Args:
        found: Results of `margins_on_vessel`.
        vessel: The vessel.
    """
    head = ("loop", "crossover rad/s", "phase deg", "extra delay s", "simulated s", "difference")
    width = max(len(row.point) for row in found)
    lines = [
        f"Delay margins on {vessel.name}, with its own actuators, lags and delays:",
        "  ".join((f"{head[0]:{width}}", *head[1:])),
    ]
    ignored: set[str] = set()
    for row in found:
        ignored.update(row.ignored)
        phase = "unstable" if row.delay_s == 0.0 else f"{row.phase_deg:.0f}"
        simulated, difference = f"{row.simulated_delay_s:.3f}", f"{100.0 * row.difference:+.1f} %"
        if row.simulated_delay_s == inf:
            simulated = f"over {LARGEST_DELAY:g}"
            if row.difference == 0.0:
                difference = "-"
        values = (f"{row.crossover:.2f}", phase, f"{row.delay_s:.3f}", simulated, difference)
        cells = [f"{v:>{len(h)}}" for v, h in zip(values, head[1:], strict=True)]
        lines.append("  ".join((f"{row.point:{width}}", *cells)))
    if ignored:
        lines.append(f"The linearised loop leaves out: {', '.join(sorted(ignored))}.")
    return "\n".join(lines)
