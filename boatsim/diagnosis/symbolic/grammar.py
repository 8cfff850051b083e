"""Grammar of the symbolic regression: all terms that are tested on a vessel, and their neighbours.

A term is a described effect without a coefficient. Forces are products of powers of speeds,
commands, averages of commands over the past, heading and position; a change of thrust belongs to
the drives. Either may act for a limited time: within an interval, rising, fading, oscillating. A
term that acts within an interval of one recording is an event of that recording.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, product

import numpy as np

from boatsim.diagnosis.config import DescribeConfig
from boatsim.diagnosis.filter import MappedRecording, dof_in_state_order
from boatsim.physics.base import Array
from boatsim.physics.described_laws import EVER, SymbolicTerm
from boatsim.physics.effects.described_force import DescribedForce
from boatsim.physics.effects.described_thrust import SENSES, SIDES, DescribedThrust
from boatsim.physics.terms import BEYOND, RIPPLES, SPEEDS
from boatsim.physics.vessel import Vessel

Recordings = Sequence[MappedRecording]
PLANAR_SPEEDS = (SPEEDS[0], SPEEDS[1], SPEEDS[5])  # surge, sway and yaw
THRUST_ROLES = ("thrust", "shaft")  # roles of actuators that drive the hull
BEARINGS = ("cos_heading", "sin_heading", "cos_twice_heading", "sin_twice_heading")
# Share of a period or wavelength by which a sine is shifted against a cosine. It is no setting: the
# sum of both has any phase.
QUARTER = 0.25


@dataclass(frozen=True)
class Course:
    """When a term of the symbolic regression acts: within an interval, rising, fading or swinging.

    Attributes:
        run: Name of the recording of an event; "" for all recordings.
        acts: "within", "rising", "fading" or "swinging".
        begin: Begin [s].
        end: End [s].
    """

    run: str
    acts: str
    begin: float
    end: float


def candidate_terms(
    vessel: Vessel,
    recordings: Recordings,
    speeds: Mapping[str, Array],
    commands: Sequence[str],
    config: DescribeConfig,
) -> Iterator[SymbolicTerm]:
    """Yield all terms that the symbolic regression of an unexplained force tests.

    A term is a force along an axis, or a change of thrust, as a product of speeds, commands,
    angles, places or functions of time.

    Args:
        vessel: The vessel.
        recordings: The fitted recordings.
        speeds: Speeds through the water (rows,) [SI] that vary, by the name of the factor.
        commands: Actuators that vary.
        config: Settings of the symbolic regression.
    """
    lasting = list(_lasting(recordings, config))
    oscillating = list(_oscillating(recordings, config.most_oscillations, config))
    memories = _memories(recordings, config)
    axes = dof_in_state_order(vessel)
    earth = ("north", "east") if {"surge", "sway"} <= set(axes) else ()
    for axis in axes:
        for of in _products(vessel, list(speeds), commands):
            yield DescribedForce(axis=axis, of=of)
        for of, memory in product(_averages(list(speeds), commands), memories):
            yield DescribedForce(axis=axis, of=of, memory=memory)
        for speed, beyond in _thresholds(speeds, config):
            yield DescribedForce(axis=axis, of=(speed,), beyond=beyond)
            yield DescribedForce(axis=axis, of=(speed, speed), beyond=beyond)
    for axis in earth or axes:  # a pattern fixed to the earth pushes in a fixed direction
        for place, wavelength, crest in _ripples(vessel, recordings, config):
            yield DescribedForce(axis=axis, of=(place,), wavelength=wavelength, crest=crest)
        for place in earth:
            yield DescribedForce(axis=axis, of=(place,))
    for axis in (*axes, *earth):
        for c in (*lasting, *oscillating):
            yield DescribedForce(axis=axis, acts=c.acts, begin=c.begin, end=c.end, run=c.run)
    if vessel.effects_of_type(DescribedThrust.per_instance_of):
        courses = [*lasting, *_oscillating(recordings, config.most_thrust_oscillations, config)]
        yield from _thrust_terms(vessel, list(speeds), commands, courses, memories)


def _thrust_terms(
    vessel: Vessel,
    speeds: Sequence[str],
    commands: Sequence[str],
    courses: Sequence[Course],
    memories: Sequence[float],
) -> Iterator[SymbolicTerm]:
    """Yield changes of the thrust, of the drives on each side and in each sense."""
    sides = SIDES if _has_side_drives(vessel) else ("all",)
    for side, sense in product(sides, SENSES):
        for c in courses:
            yield DescribedThrust(
                side=side, sense=sense, acts=c.acts, begin=c.begin, end=c.end, run=c.run
            )
        for speed in speeds:
            yield DescribedThrust(side=side, sense=sense, of=(f"abs_{speed}",))
        for drive in commands:
            if not _drives(vessel, drive, SIDES[side]):
                continue
            for memory in memories:
                of = (f"recent_abs_{drive}",)
                yield DescribedThrust(side=side, sense=sense, of=of, memory=memory)


def _drives(vessel: Vessel, signal: str, side: float) -> bool:
    """Return whether a signal belongs to drives on a side; 0 for all drives, or the only one."""
    first, *others = vessel.signal_sums.get(signal, (signal,))
    if vessel.roles[first] not in THRUST_ROLES:
        return False
    if side:
        return vessel.side(signal) == side
    return bool(others) or vessel.roles[first] not in vessel.signal_sums


def _has_side_drives(vessel: Vessel) -> bool:
    """Return whether a drive lies off the centre line."""
    for drive in vessel.effects_of_type(DescribedThrust.per_instance_of):
        if getattr(drive, "y", 0.0) != 0.0:
            return True
    return False


def _products(
    vessel: Vessel, speeds: Sequence[str], commands: Sequence[str]
) -> Iterator[tuple[str, ...]]:
    """Yield the factors of forces that always act."""
    planar = [s for s in speeds if s in PLANAR_SPEEDS]
    yield ()
    for s in speeds:
        yield from ((s,), (s, f"abs_{s}"), (s, s, s), (f"abs_{s}",), (s, s), (f"sign_{s}",))
    for a, b in combinations(speeds, 2):
        yield from ((a, b), (a, f"abs_{b}"), (f"abs_{a}", b), (a, b, b), (a, a, b))
    for c in commands:
        yield from ((c,), (f"abs_{c}",), (c, f"abs_{c}"))
        for s in speeds:
            yield from ((c, s), (f"abs_{c}", s), (c, f"abs_{s}"))
    yield from combinations((c for c in commands if c in vessel.actuators), 2)
    if "yaw" in vessel.dof:
        for bearing in BEARINGS:
            yield (bearing,)
            yield from product((bearing,), planar)
    if "heave" in vessel.dof:
        yield ("depth",)
    for axis, angle in (("roll", "roll_angle"), ("pitch", "pitch_angle")):
        if axis in vessel.dof:
            yield from ((angle,), (angle, angle), (angle, angle, angle))
            yield from product((angle,), speeds)
    if {"surge", "sway"} <= set(vessel.dof):
        yield from product(("north", "east"), planar)


def _averages(speeds: Sequence[str], commands: Sequence[str]) -> list[tuple[str, ...]]:
    """Return the factors of forces that vary with the average of a command over the past."""
    found: list[tuple[str, ...]] = []
    for c in commands:
        found += [(f"recent_{c}",), (f"recent_abs_{c}",), (f"changed_{c}",)]
        for s in speeds:
            found += [(f"recent_{c}", s), (f"recent_abs_{c}", s)]
    return found


def _row_interval(recordings: Recordings) -> float:
    """Return the longest typical interval [s] between rows."""
    return max(float(np.median(np.diff(r.times))) for r in recordings)


def longest_recording_duration(recordings: Recordings) -> float:
    """Return the duration [s] of the longest recording."""
    return max(float(r.times[-1] - r.times[0]) for r in recordings)


def _memories(recordings: Recordings, config: DescribeConfig) -> list[float]:
    """Return the time constants [s] of averages over the past."""
    rows, whole = _row_interval(recordings), longest_recording_duration(recordings)
    shortest = config.shortest_memory * rows
    longest = max(config.longest_memory, config.shortest_memory * rows / whole) * whole
    return list(map(_allowed_memory, np.geomspace(shortest, longest, config.memories).tolist()))


def _allowed_memory(seconds: float) -> float:
    """Return the nearest time constant [s] that a term may have."""
    about = SymbolicTerm.params()["memory"]
    return min(max(seconds, about.low), about.high)


def _thresholds(speeds: Mapping[str, Array], config: DescribeConfig) -> Iterator[tuple[str, float]]:
    """Yield factors with their thresholds [SI] of a speed."""
    for speed, values in speeds.items():
        for share in config.threshold_shares:
            yield f"beyond_{speed}", float(np.quantile(np.abs(values), share))


def _ripples(
    vessel: Vessel, recordings: Recordings, config: DescribeConfig
) -> Iterator[tuple[str, float, float]]:
    """Yield patterns fixed to the earth: factor, wavelength [m], position of a crest [m].

    The longest wavelength is the extent of the longest track: a longer pattern would only give each
    recording its own constant force.
    """
    for axis, place, signal in (("surge", "north", "x_m"), ("sway", "east", "y_m")):
        extents = []
        for r in recordings:
            if signal in r.signals:
                extents.append(_extent(r.measured[:, r.signals.index(signal)]))
        if axis not in vessel.dof or not extents:
            continue
        extent, shortest = max(extents), config.shortest_wavelength * vessel.length
        if extent > 2.0 * shortest:
            for wavelength in np.geomspace(shortest, extent, config.wavelengths).tolist():
                yield f"ripple_{place}", wavelength, 0.0
                yield f"ripple_{place}", wavelength, QUARTER * wavelength


def _extent(positions: Array) -> float:
    """Distance [m] between the extremes of positions (N,), 0 if none was recorded."""
    known = positions[np.isfinite(positions)]
    return float(np.ptp(known)) if len(known) else 0.0


def _lasting(recordings: Recordings, config: DescribeConfig) -> Iterator[Course]:
    """Yield intervals of one or all recordings, and courses that rise or fade."""
    begin, end = _time_range(recordings)
    parts = config.recording_parts
    for span in config.fading_spans:
        yield Course("", "fading", begin, begin + span * (end - begin))
    yield Course("", "rising", begin, end)
    for recording in recordings:
        first, last = float(recording.times[0]), float(recording.times[-1])
        part = (last - first) / parts
        for a, b in _intervals(config):
            yield Course(recording.name, "within", first + a * part, first + b * part)
        for k in range(parts - int(config.interval_lengths[-1]) + 1, parts):  # until the end
            yield Course(recording.name, "within", first + k * part, EVER)
    if len(recordings) > 1:
        part = (end - begin) / parts
        for a, b in _intervals(config):
            yield Course("", "within", begin + a * part, begin + b * part)


def _intervals(config: DescribeConfig) -> Iterator[tuple[int, int]]:
    """Yield begin and end of the intervals of a recording, in its parts."""
    for length in map(int, config.interval_lengths):
        for k in range(config.recording_parts - length + 1):
            yield k, k + length


def _oscillating(recordings: Recordings, most: int, config: DescribeConfig) -> Iterator[Course]:
    """Yield oscillations, as cosine and sine, of all recordings alike and of single ones."""
    groups: list[tuple[str, Recordings]] = [("", recordings)]
    if len(recordings) > 1:
        for recording in recordings:
            groups.append((recording.name, [recording]))
    for run, group in groups:
        begin, end = _time_range(group)
        shortest = config.shortest_period * _row_interval(group)
        for half in range(2, 2 * most + 1):
            period = 2.0 * (end - begin) / half
            if period > shortest:
                yield Course(run, "swinging", 0.0, period)
                yield Course(run, "swinging", QUARTER * period, (1.0 + QUARTER) * period)


def _time_range(recordings: Recordings) -> tuple[float, float]:
    """Return the first and the last time [s] of recordings."""
    first = min(float(r.times[0]) for r in recordings)
    return first, max(float(r.times[-1]) for r in recordings)


def term_variants(
    term: SymbolicTerm, recordings: Recordings, step: float, config: DescribeConfig
) -> list[SymbolicTerm]:
    """Return variants of a term of the symbolic regression with slightly changed constants.

    The constants are its times, wavelength, threshold or time constant.

    Args:
        term: A term of the symbolic regression.
        recordings: The fitted recordings.
        step: Size of the change, relative to the step of the grammar.
        config: Settings of the symbolic regression.
    """
    whole = longest_recording_duration([r for r in recordings if term.run in ("", r.name)])
    found: list[SymbolicTerm] = []
    if term.acts == "within":
        found += _moved_interval(term, step * whole / config.recording_parts)
    if term.acts in ("rising", "fading"):
        span = term.end - term.begin
        for factor in (2.0**step, 2.0**-step):
            found.append(replace(term, end=term.begin + span * factor))
    if term.acts == "swinging":
        found += _moved_oscillation(term, step, whole, config.oscillation_step)
    if set(term.of) & set(RIPPLES):
        found += _moved_ripple(term, step, config.wavelength_step)
    for factor in (1.0 + step, 1.0 / (1.0 + step)):
        if set(term.of) & set(BEYOND):
            found.append(replace(term, beyond=term.beyond * factor))
    for factor in (1.0 + step, 1.0 / (1.0 + step)):
        if term.uses_history:
            found.append(replace(term, memory=_allowed_memory(term.memory * factor)))
    return found


def _moved_interval(term: SymbolicTerm, seconds: float) -> list[SymbolicTerm]:
    """Return the term with begin and end moved by this time [s] in all combinations."""
    found = []
    for a, b in product((-1, 0, 1), repeat=2):
        begin, end = term.begin + a * seconds, term.end + b * seconds
        if term.end >= EVER:
            end = EVER
        if (a or b) and end > begin:
            found.append(replace(term, begin=begin, end=end))
    return found


def _moved_oscillation(
    term: SymbolicTerm, step: float, whole: float, periods: float
) -> list[SymbolicTerm]:
    """Return the term with period and phase changed in all combinations.

    Args:
        term: A term that oscillates.
        step: Size of the change, relative to the step of the grammar.
        whole: Duration of the longest recording in which it acts [s].
        periods: Step of the grammar, in periods in this duration.
    """
    found, period = [], term.end - term.begin
    ratio = 1.0 + step * periods * period / whole
    for p in (period * ratio, period, period / ratio):
        for phase in (-QUARTER * step, 0.0, QUARTER * step):
            if p != period or phase:
                begin = (term.begin / period + phase) * p
                found.append(replace(term, begin=begin, end=begin + p))
    return found


def _moved_ripple(term: SymbolicTerm, step: float, relative: float) -> list[SymbolicTerm]:
    """Return the term with wavelength and crest changed in all combinations.

    Args:
        term: A term with a pattern in space.
        step: Size of the change, relative to the step of the grammar.
        relative: Step of the grammar as a share of the wavelength.
    """
    found, ratio = [], 1.0 + relative * step
    for factor in (ratio, 1.0, 1.0 / ratio):
        for shift in (-QUARTER * step, 0.0, QUARTER * step):
            if factor != 1.0 or shift:
                wavelength = term.wavelength * factor
                crest = float(np.remainder(term.crest + shift * wavelength, wavelength))
                found.append(replace(term, wavelength=wavelength, crest=crest))
    return found
