"""Response amplitude operators: motion of a vessel in regular waves per amplitude of the waves."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import pi

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
            rad/m; nan where it did not become steady.
        steady: Whether each response became steady (H, P).
    """

    vessel: str
    dof: tuple[str, ...]
    directions: Array
    periods: Array
    height: float
    operators: Complex
    steady: NDArray[np.bool_]


def wave_response(
    vessel: Vessel,
    directions: Sequence[float],
    periods: Sequence[float],
    height: float,
    waves: Mapping[str, object] | None = None,
    report: Report | None = None,
) -> WaveResponse:
    """Return the response of a vessel at rest to regular waves, by simulation.

    Soft springs hold place and heading. The motion is fitted by a harmonic at the frequency of the
    waves, until it is steady.

    Args:
        vessel: The vessel.
        directions: Directions to which the waves run, relative to the bow (H,) [rad].
        periods: Periods of the waves (P,) [s].
        height: Height of the waves [m].
        waves: Table of the effect by which waves act; None for that of the vessel, or
            `strip_wave_loads` without one.
        report: Receives the share that is done.

    Raises:
        BadInput: The effect does not exist or does not fit, or exerts no force.
    """
    own, table = _without_waves(vessel, waves)
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
        floating = _on_springs(own.with_effect(sea), 2.0 * pi / periods[k])
        if not wave_axes(floating):
            raise BadInput(f"{vessel.name}: the waves of {table['use']} exert no force on it")
        operators[i, k], steady[i, k] = _response(floating, periods[k])
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


def _on_springs(vessel: Vessel, frequency: float) -> Vessel:
    """A vessel on soft springs in its horizontal degrees of freedom."""
    mass = planar_mass(vessel)
    spring: dict[str, object] = {"use": "ground_spring", "name": "station_spring"}
    for i, (axis, key) in enumerate(SPRINGS.items()):
        if axis in vessel.dof:
            spring[key] = float(mass[i, i]) * (SPRING_SHARE * frequency) ** 2
    return vessel.with_effect(spring) if len(spring) > 2 else vessel


def _response(vessel: Vessel, period: float) -> tuple[Complex, bool]:
    """Complex motion per amplitude of the wave (D,), and whether it is steady."""
    engine = OpenWater(vessel, step=period / STEPS)
    engine.reset()
    field = wave_field(vessel.effects)
    names = [COLUMNS[axis] for axis in vessel.dof]
    before = np.full(len(names), np.inf + 0j)
    for _ in range(MOST_FITS):
        rows = []
        for _ in range(FITTED * SAMPLES):
            engine.advance(STEPS // SAMPLES)
            state = engine.state
            rows.append([state.t, state.x, state.y, *(getattr(state, name) for name in names)])
        table = np.array(rows)
        t, x, y = table[:, 0], float(table[:, 1].mean()), float(table[:, 2].mean())
        elevation = [float(field.elevation(x, y, at)) for at in t]  # at the mean place
        harmonics = _harmonics(t, np.column_stack([elevation, table[:, 3:]]), 2.0 * pi / period)
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
    weight = np.sin(pi * share)[:, None] ** 2
    cosine, sine = np.linalg.lstsq(weight * basis, weight * signals, rcond=None)[0][:2]
    return np.asarray(cosine - 1j * sine)


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
