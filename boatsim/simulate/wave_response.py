"""Response amplitude operators: motion of a vessel in regular waves per amplitude of the waves."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import ceil, cos, pi, sin, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BadInput
from boatsim.physics.base import AXES, Array
from boatsim.physics.content import load_class, shipped_content_names
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.vessel import Vessel
from boatsim.physics.vessel.effect_tables import effect_table
from boatsim.physics.vessel.wave_field import wave_field
from boatsim.physics.waves.sea_parameters import SeaParameters
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.stepper import State
from boatsim.simulate.vessel_model import planar_mass

STEPS = 100  # integration steps in a period of the waves
SAMPLES = 20  # of a period, in equal distances
FITTED = 10  # periods of a fit; a Hann window over them separates waves from other motion
# The response is steady if its degrees of freedom differ between two successive fits by less than
# this share of the largest: model tests repeat within some per cent
STEADY = 0.005
MOST_FITS = 40  # 400 periods: a roll damped by 1 % of the critical damping has long decayed
# Frequency of the springs that hold place and heading, as a share of that of the waves: they change
# the response by its square, 0.25 %
SPRING_SHARE = 0.05
# [sqrt(L / g)] in calm water after which the waves of the start have left a boat, in steps of a
# thirtieth, as short as those in waves of a length
SETTLING, SETTLING_STEPS = 40.0, 30
# Frequency of encounter, as a share of that of the waves, below which there is no response: a boat
# that runs with the waves is steered and accelerated by each of them, and does not oscillate
LEAST_ENCOUNTER = 0.1
# What regular waves state themselves, of the parameters of a sea
STATED = (
    *("spectrum", "spectrum_file", "significant_height", "modal_period", "toward", "spreading"),
    *("gamma", "cut"),
)
SPRINGS = {"surge": "stiffness_north", "sway": "stiffness_east", "yaw": "turn"}
COLUMNS = dict(zip(AXES, ("x", "y", "z", "phi", "theta", "psi"), strict=True))

Complex = NDArray[np.complex128]
Report = Callable[[float], None]


@dataclass(frozen=True)
class WaveResponse:
    """Response of a vessel to regular waves.

    Attributes:
        vessel: Name of the vessel.
        dof: Its degrees of freedom.
        directions: Directions to which the waves run, relative to the bow (H,) [rad]: 0 for waves
            from astern, pi for waves from ahead.
        periods: Periods of the waves (P,) [s].
        height: Height of the waves [m].
        operators: Complex motion (H, P, D) per amplitude of the wave at the mean place, in m/m and
            rad/m, for the time dependence exp(i w_e t) with the frequency of encounter w_e; nan
            where it did not become steady.
        steady: Whether each response became steady (H, P).
        speed: Forward speed [m/s].
    """

    vessel: str
    dof: tuple[str, ...]
    directions: Array
    periods: Array
    height: float
    operators: Complex
    steady: NDArray[np.bool_]
    speed: float = 0.0


def wave_response(
    vessel: Vessel,
    directions: Sequence[float],
    periods: Sequence[float],
    height: float,
    waves: Mapping[str, object] | None = None,
    report: Report | None = None,
    speed: float = 0.0,
) -> WaveResponse:
    """Return the response of a vessel to regular waves, by simulation.

    Soft springs hold place and heading. At forward speed they move ahead with it, and a constant
    force takes the place of the propulsion. The motion is fitted by a harmonic at the frequency of
    encounter, until it is steady.

    Args:
        vessel: The vessel.
        directions: Directions to which the waves run, relative to the bow (H,) [rad].
        periods: Periods of the waves (P,) [s].
        height: Height of the waves [m].
        waves: Table of the effect by which waves act; None for that of the vessel, or
            `strip_wave_loads` without one.
        report: Receives the share that is done.
        speed: Forward speed [m/s].

    Raises:
        BadInput: The effect does not exist or does not fit, or exerts no force, or the vessel
            cannot have the speed.
    """
    own, table = _without_waves(vessel, waves)
    start = State()
    if speed != 0.0:
        own = _towed(own, speed)
        start = _towed_start(own, speed)
    shape = (len(directions), len(periods))
    operators = np.zeros((*shape, len(own.dof)), dtype=np.complex128)
    steady = np.zeros(shape, dtype=bool)
    for number, (i, k) in enumerate(np.ndindex(*shape)):
        sea = {
            **table,
            "spectrum": "regular",
            "spectrum_file": "",
            "significant_height": height,
            "modal_period": periods[k],
            "toward": directions[i],
            "spreading": 0.0,
            "random_amplitudes": 0.0,
        }
        boat = own.with_effect(sea)
        if not wave_axes(boat):
            raise BadInput(f"{vessel.name}: the waves of {table['use']} exert no force on it")
        encounter = _encounter_frequency(boat, periods[k], directions[i], speed)
        operators[i, k] = np.nan
        if abs(encounter) >= LEAST_ENCOUNTER * 2.0 * pi / periods[k]:
            floating = _on_springs(boat, abs(encounter), speed)
            run = _Towing(periods[k], encounter, speed, start)
            operators[i, k], steady[i, k] = _response(floating, run)
        if report:
            report((number + 1) / steady.size)
    return WaveResponse(
        vessel.name,
        own.dof,
        np.array(directions),
        np.array(periods),
        height,
        operators,
        steady,
        speed,
    )


def wave_axes(vessel: Vessel) -> tuple[str, ...]:
    """Return the degrees of freedom of a vessel in which its waves exert a force.

    Args:
        vessel: The vessel.
    """
    found: set[str] = set()
    for effect in vessel.effects:
        if isinstance(effect, SeaParameters):
            found |= set(effect.wave_axes())
    return tuple(axis for axis in vessel.dof if axis in found)


def _without_waves(
    vessel: Vessel, waves: Mapping[str, object] | None
) -> tuple[Vessel, dict[str, object]]:
    """A vessel without its waves, and the table of the effect by which waves act."""
    table: dict[str, object] = {"use": "strip_wave_loads"}
    for effect in vessel.effects:
        if isinstance(effect, SeaParameters):
            table = effect_table(effect)
            vessel = vessel.without_effect(effect.name)
    if waves is not None:
        table = dict(waves)
        check_waves(table)
    return vessel, table


def check_waves(table: Mapping[str, object]) -> None:
    """Check that a table describes an effect by which waves act, without the waves themselves.

    Args:
        table: The table.

    Raises:
        BadInput: There is no such effect of waves, or it states the waves.
    """
    use = str(table["use"])
    if not issubclass(load_class("effect", use), SeaParameters):
        known = []
        for name in shipped_content_names("effect"):
            if issubclass(load_class("effect", name), SeaParameters):
                known.append(name)
        raise BadInput(f"{use} is no effect of waves; allowed are {', '.join(known)}")
    for key in STATED:
        if key in table:
            raise BadInput(f"{use}: {key} does not apply to the regular waves of a response")


def _towed(vessel: Vessel, speed: float) -> Vessel:
    """A vessel with a constant force that balances its resistance in calm water at a speed."""
    if "surge" not in vessel.dof:
        raise BadInput(
            f"{vessel.name} is not free in surge; --speed is allowed for vessels that are"
        )
    engine = OpenWater(vessel)
    engine.reset(State(u=speed))
    tow = {"use": "push", "name": "tow", "surge": -engine.wrench().X}
    return vessel.with_effect(tow)


def _towed_start(vessel: Vessel, speed: float) -> State:
    """State from which a towed vessel reaches a speed and the place of its springs in calm water.

    The force of the waves that it radiates at the start changes its speed and place for good where
    nothing damps surge. Both changes are linear in the speed at the start.

    Args:
        vessel: The vessel with the force that tows it.
        speed: The speed [m/s].

    Raises:
        BadInput: It does not stay near the speed.
    """
    unit = sqrt(vessel.length / GRAVITY)
    engine = OpenWater(vessel, step=unit / SETTLING_STEPS)
    begin = speed
    for _ in range(2):
        engine.reset(State(u=begin))
        engine.advance(round(SETTLING * SETTLING_STEPS))
        end = engine.state
        if not 0.5 * speed < end.u < 2.0 * speed:
            raise BadInput(
                f"{vessel.name}: its speed does not stay at --speed = {speed:g} m/s under a "
                f"constant force; it reaches {end.u:.4g} m/s"
            )
        first, begin = begin, begin * speed / end.u
    return State(x=speed * end.t - end.x, z=end.z, theta=end.theta, u=first)


def _encounter_frequency(vessel: Vessel, period: float, direction: float, speed: float) -> float:
    """Frequency at which a vessel meets its regular waves [rad/s]; negative if it overtakes them.

    Args:
        vessel: The vessel with its waves.
        period: Period of the waves [s].
        direction: Direction to which they run, relative to the bow [rad].
        speed: Forward speed [m/s].
    """
    frequency = 2.0 * pi / period
    if speed == 0.0:
        return frequency
    field = wave_field(vessel.effects)
    north, east = field.water_velocity  # the waves travel on the water
    along = (speed - north) * cos(direction) - east * sin(direction)
    return frequency - float(field.wave_number[0]) * along


def _on_springs(vessel: Vessel, frequency: float, speed: float) -> Vessel:
    """A vessel on soft springs in its horizontal degrees of freedom, which move with a speed."""
    mass = planar_mass(vessel)
    spring: dict[str, object] = {"use": "ground_spring", "name": "station_spring"}
    for i, (axis, key) in enumerate(SPRINGS.items()):
        if axis in vessel.dof:
            spring[key] = float(mass[i, i]) * (SPRING_SHARE * frequency) ** 2
    if len(spring) == 2:
        return vessel
    if speed != 0.0:
        spring["velocity_north"] = speed
    return vessel.with_effect(spring)


class _Towing(NamedTuple):
    """Waves of a run, and speed and state of the vessel at its start."""

    period: float  # [s] of the waves
    encounter: float  # [rad/s] frequency of encounter
    speed: float  # [m/s]
    start: State


def _response(vessel: Vessel, run: _Towing) -> tuple[Complex, bool]:
    """Complex motion per amplitude of the wave (D,), and whether it is steady.

    Args:
        vessel: The vessel on its springs.
        run: The run.
    """
    speed, met = run.speed, run.period
    if speed != 0.0:
        met = 2.0 * pi / abs(run.encounter)
    # a step is a hundredth of the shorter one of both periods
    substeps = STEPS // SAMPLES * ceil(met / run.period - 1e-9)
    engine = OpenWater(vessel, step=met / (SAMPLES * substeps))
    engine.reset(run.start)
    field = wave_field(vessel.effects)
    names = [COLUMNS[axis] for axis in vessel.dof]
    before = np.full(len(names), np.inf + 0j)
    for _ in range(MOST_FITS):
        rows = []
        for _ in range(FITTED * SAMPLES):
            engine.advance(substeps)
            state = engine.state
            rows.append([state.t, state.x, state.y, *(getattr(state, name) for name in names)])
        table = np.array(rows)
        t, carried = table[:, 0], speed * table[:, 0]
        weights = None
        if speed != 0.0:  # the start of towing leaves a slow motion on the springs
            weights = _window(t)
        x = float(np.average(table[:, 1] - carried, weights=weights))
        y = float(np.average(table[:, 2], weights=weights))
        elevation = []  # at the mean place, which moves ahead with the speed
        for at, ahead in zip(t, carried, strict=True):
            elevation.append(float(field.elevation(x + ahead, y, at)))
        if "x" in names:
            table[:, 3 + names.index("x")] -= carried
        harmonics = _harmonics(t, np.column_stack([elevation, table[:, 3:]]), run.encounter)
        found = harmonics[1:] / harmonics[0]
        scale = np.abs(found).max()
        if np.abs(found - before).max() <= STEADY * scale:
            return found, True
        before = found
    return np.full(len(names), np.nan + 0j), False


def _harmonics(t: Array, signals: Array, frequency: float) -> Complex:
    """Complex amplitudes of signals (N, D) at a frequency, for the time dependence exp(i w t)."""
    share = (t - t[0]) / (t[-1] - t[0])
    # besides the wave a cubic and the oscillation on the springs, for the slow motion
    slow = [share**k for k in range(4)]
    swing = SPRING_SHARE * frequency * t
    waves = [np.cos(frequency * t), np.sin(frequency * t)]
    basis = np.column_stack([*waves, np.cos(swing), np.sin(swing), *slow])
    weight = _window(t)[:, None]
    cosine, sine = np.linalg.lstsq(weight * basis, weight * signals, rcond=None)[0][:2]
    return np.asarray(cosine - 1j * sine)


def _window(t: Array) -> Array:
    """Hann window (N,) over times (N,) [s]."""
    return np.asarray(np.sin(pi * (t - t[0]) / (t[-1] - t[0])) ** 2)


def usual_periods(length: float, count: int) -> Array:
    """Return periods of waves in deep water, from half to ten times as long as a vessel [s].

    Args:
        length: Length of the vessel [m].
        count: Number of periods; their lengths are in equal ratios.
    """
    wave_lengths = length * np.geomspace(0.5, 10.0, count)
    return np.asarray(np.sqrt(2.0 * pi * wave_lengths / GRAVITY))


def deep_water_length(periods: Array) -> Array:
    """Return the lengths of waves in deep water [m].

    Args:
        periods: Periods [s].
    """
    return np.asarray(GRAVITY * periods**2 / (2.0 * pi))


def largest_responses(found: WaveResponse) -> Iterable[tuple[str, float, float, float]]:
    """Yield for each degree of freedom its largest response, and where it is.

    Args:
        found: The response, of which one at least is steady.

    Yields:
        Degree of freedom, amplitude per amplitude of the wave, period [s] and direction [rad].
    """
    sizes = np.where(found.steady[..., None], np.abs(found.operators), -np.inf)
    for d, axis in enumerate(found.dof):
        i, k = np.unravel_index(int(sizes[..., d].argmax()), sizes.shape[:2])
        yield axis, float(sizes[i, k, d]), float(found.periods[k]), float(found.directions[i])
