"""The grammar of described laws: all terms that are weighed on a vessel, and what lies next to one.

A term is a described effect without a coefficient. Forces go with powers and products of speeds, commands, what these
were of late, heading and place, changes of thrust with the drives; either may act for a while: within a stretch,
rising, fading, swinging. What acts within a stretch of one recording is an event of that run.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from boatsim.diagnosis.filter import MappedRecording, axes_of
from boatsim.physics.base import Array
from boatsim.physics.described_laws import EVER, Described
from boatsim.physics.effects.described_force import DescribedForce
from boatsim.physics.effects.described_thrust import SENSES, SIDES, DescribedThrust
from boatsim.physics.terms import BEYOND, RIPPLES, SPEEDS
from boatsim.physics.vessel import Vessel

PARTS = 16  # of a recording, at whose ends a stretch may begin and end
LENGTHS = (1, 2, 4, 8)  # of a stretch, in such parts
SPANS = (1.0, 0.5, 0.25, 0.125)  # of a recording, in which a law rises or fades
SWINGS, OF_THRUST = (
    60,
    8,
)  # what swings does so up to so many times in a recording, what changes the thrust less often
SHORTEST_SWING = 6  # rows
BELOW = (0.2, 0.4, 0.6, 0.8)  # shares of the rows that lie below a threshold
WAVES, SHORTEST_WAVE = (
    24,
    0.5,
)  # lengths of a pattern on the water: so many, from so many boat lengths to what was seen
MEMORIES, SHORTEST_MEMORY, LONGEST_MEMORY = (
    6,
    2,
    0.25,
)  # time constants from so many rows to a share of a recording
LEVEL = (SPEEDS[0], SPEEDS[1], SPEEDS[5])  # speeds of a hull on level water
PUSHES = ("thrust", "shaft")  # roles of actuators that drive
# How near neighbours of a term lie: of a part, a span, the step between periods or wavelengths, a
# threshold, a memory
FINER, FINEST = (0.5, 0.25), (0.12, 0.06, 0.03, 0.015)


def terms(
    vessel: Vessel,
    tracks: Sequence[MappedRecording],
    moves: Mapping[str, Array],
    given: Sequence[str],
) -> Iterator[Described]:
    """All terms that are weighed: `moves` are the speeds [SI], `given` the actuators that vary in the recordings."""
    lasting, swinging, memories = (
        list(_lasting(tracks)),
        list(_swinging(tracks, SWINGS)),
        _memories(tracks),
    )
    axes = axes_of(vessel)
    level = ("north", "east") if {"surge", "sway"} <= set(axes) else ()
    for axis in axes:
        for of in _products(vessel, list(moves), given):
            yield DescribedForce(axis=axis, of=of)
        for of in _histories(list(moves), given):
            for memory in memories:
                yield DescribedForce(axis=axis, of=of, memory=memory)
        for speed, beyond in _thresholds(moves):
            yield DescribedForce(axis=axis, of=(speed,), beyond=beyond)
            yield DescribedForce(axis=axis, of=(speed, speed), beyond=beyond)
    for axis in level or axes:  # what lies still on the water pushes in directions that lie still
        for place, wavelength, crest in _ripples(vessel, tracks):
            yield DescribedForce(axis=axis, of=(place,), wavelength=wavelength, crest=crest)
        for place in ("north", "east")[: len(level)]:
            yield DescribedForce(axis=axis, of=(place,))
    for axis in (*axes, *level):
        for run, acts, begin, end in (*lasting, *swinging):
            yield DescribedForce(axis=axis, acts=acts, begin=begin, end=end, run=run)
    if vessel.effects_of(DescribedThrust.per_instance_of):
        for side in SIDES if _sided(vessel) else ("all",):
            for sense in SENSES:
                for run, acts, begin, end in (*lasting, *_swinging(tracks, OF_THRUST)):
                    yield DescribedThrust(
                        side=side, sense=sense, acts=acts, begin=begin, end=end, run=run
                    )
                for speed in moves:
                    yield DescribedThrust(side=side, sense=sense, of=(f"abs_{speed}",))
                for drive in (c for c in given if _pushes(vessel, c, SIDES[side])):
                    for memory in memories:
                        yield DescribedThrust(
                            side=side, sense=sense, of=(f"recent_abs_{drive}",), memory=memory
                        )


def _pushes(vessel: Vessel, signal: str, side: float) -> bool:
    """Whether a signal is of drives on this side; 0: of all together, or of the only one."""
    (first, *others) = vessel.sums.get(signal, (signal,))
    if vessel.roles[first] not in PUSHES:
        return False
    return (
        vessel.side(signal) == side
        if side
        else bool(others) or vessel.roles[first] not in vessel.sums
    )


def _sided(vessel: Vessel) -> bool:
    """Whether a drive lies to one side."""
    return any(
        getattr(e, "y", 0.0) != 0.0 for e in vessel.effects_of(DescribedThrust.per_instance_of)
    )


def _products(
    vessel: Vessel, moves: Sequence[str], given: Sequence[str]
) -> Iterator[tuple[str, ...]]:
    """Factors of forces that act always."""
    yield ()
    for s in moves:
        yield from ((s,), (s, f"abs_{s}"), (s, s, s), (f"abs_{s}",), (s, s), (f"sign_{s}",))
    for a, b in combinations(moves, 2):
        yield from ((a, b), (a, f"abs_{b}"), (f"abs_{a}", b), (a, b, b), (a, a, b))
    for c in given:
        yield from ((c,), (f"abs_{c}",), (c, f"abs_{c}"))
        for s in moves:
            yield from ((c, s), (f"abs_{c}", s), (c, f"abs_{s}"))
    for a, b in combinations((c for c in given if c in vessel.actuators), 2):
        yield (a, b)
    if "yaw" in vessel.dof:
        for bearing in ("cos_heading", "sin_heading", "cos_twice_heading", "sin_twice_heading"):
            yield (bearing,)
            yield from ((bearing, s) for s in moves if s in LEVEL)
    if "heave" in vessel.dof:
        yield ("depth",)
    for axis, angle in (("roll", "roll_angle"), ("pitch", "pitch_angle")):
        if axis in vessel.dof:
            yield from ((angle,), (angle, angle), (angle, angle, angle))
            yield from ((angle, s) for s in moves)
    if {"surge", "sway"} <= set(vessel.dof):
        yield from ((place, s) for place in ("north", "east") for s in moves if s in LEVEL)


def _histories(moves: Sequence[str], given: Sequence[str]) -> Iterator[tuple[str, ...]]:
    """Factors of forces that go with what was commanded of late, or with a change of it that dies out."""
    for c in given:
        yield from ((f"recent_{c}",), (f"recent_abs_{c}",), (f"changed_{c}",))
        for s in moves:
            yield from ((f"recent_{c}", s), (f"recent_abs_{c}", s))


def _memories(tracks: Sequence[MappedRecording]) -> list[float]:
    """Time constants [s] of what was commanded of late: what is shorter no row shows, what is longer looks constant."""
    rows = max(float(np.median(np.diff(t.times))) for t in tracks)
    whole = max(float(t.times[-1] - t.times[0]) for t in tracks)
    shortest, longest = (
        SHORTEST_MEMORY * rows,
        max(LONGEST_MEMORY, SHORTEST_MEMORY * rows / whole) * whole,
    )
    return [_memory(x) for x in np.geomspace(shortest, longest, MEMORIES).tolist()]


def _memory(seconds: float) -> float:
    """The nearest time constant [s] that a law may have."""
    about = Described.params()["memory"]
    return min(max(seconds, about.low), about.high)


def _thresholds(moves: Mapping[str, Array]) -> Iterator[tuple[str, float]]:
    """Thresholds [SI] of a speed, by the share of the rows that lie below: factor and threshold."""
    for speed, values in moves.items():
        for share in BELOW:
            yield f"beyond_{speed}", float(np.quantile(np.abs(values), share))


def _ripples(
    vessel: Vessel, tracks: Sequence[MappedRecording]
) -> Iterator[tuple[str, float, float]]:
    """Patterns that lie still on the water: factor, wavelength [m] up to what was sailed through, and crest [m]."""
    for axis, place, signal in (("surge", "north", "x_m"), ("sway", "east", "y_m")):
        columns = [t.measured[:, t.signals.index(signal)] for t in tracks if signal in t.signals]
        if axis not in vessel.dof or not columns:
            continue
        extent = float(np.nanmax(np.concatenate(columns)) - np.nanmin(np.concatenate(columns)))
        shortest = SHORTEST_WAVE * vessel.length
        if extent > 2.0 * shortest:
            for wavelength in np.geomspace(shortest, extent, WAVES).tolist():
                yield f"ripple_{place}", wavelength, 0.0
                yield f"ripple_{place}", wavelength, 0.25 * wavelength


def _lasting(tracks: Sequence[MappedRecording]) -> Iterator[tuple[str, str, float, float]]:
    """How a law may act for a while: recording or "" for all of them, course, begin, end [s]."""
    begin, end = _clock(tracks)
    for span in SPANS:
        yield "", "fading", begin, begin + span * (end - begin)
    yield "", "rising", begin, end
    for track in tracks:
        first, last = float(track.times[0]), float(track.times[-1])
        part = (last - first) / PARTS
        for a, b in _stretches():
            yield track.name, "within", first + a * part, first + b * part
        for k in range(PARTS - LENGTHS[-1] + 1, PARTS):  # from then on
            yield track.name, "within", first + k * part, EVER
    if len(tracks) > 1:
        part = (end - begin) / PARTS
        for a, b in _stretches():
            yield "", "within", begin + a * part, begin + b * part


def _stretches() -> Iterator[tuple[int, int]]:
    """Begin and end of the stretches of a recording, in its parts."""
    for length in LENGTHS:
        for k in range(PARTS - length + 1):
            yield k, k + length


def _swinging(
    tracks: Sequence[MappedRecording], most: int
) -> Iterator[tuple[str, str, float, float]]:
    """What swings, in all recordings alike or in one of them, with its cosine and its sine."""
    for run, near in (("", tracks), *((t.name, [t]) for t in tracks if len(tracks) > 1)):
        begin, end = _clock(near)
        shortest = SHORTEST_SWING * max(float(np.median(np.diff(t.times))) for t in near)
        for half in range(2, 2 * most + 1):
            period = 2.0 * (end - begin) / half
            if period > shortest:
                yield run, "swinging", 0.0, period
                yield run, "swinging", 0.25 * period, 1.25 * period


def _clock(tracks: Sequence[MappedRecording]) -> tuple[float, float]:
    """First and last time [s] of recordings."""
    return min(float(t.times[0]) for t in tracks), max(float(t.times[-1]) for t in tracks)


def neighbours(term: Described, tracks: Sequence[MappedRecording], by: float) -> list[Described]:
    """The same term a little otherwise: begin, end, wavelength or period moved by a share `by` of the grid's step."""
    found: list[Described] = []
    near = [t for t in tracks if term.run in ("", t.name)]
    whole = max(float(t.times[-1] - t.times[0]) for t in near)
    if term.acts == "within":
        step = by * whole / PARTS
        edges = [
            (term.begin + a * step, term.end + b * step)
            for a in (-1, 0, 1)
            for b in (-1, 0, 1)
            if a or b
        ]
        edges = [(a, EVER if term.end >= EVER else b) for a, b in edges]
        found += [replace(term, begin=a, end=b) for a, b in edges if b > a]
    if term.acts in ("rising", "fading"):
        span = term.end - term.begin
        found += [replace(term, end=term.begin + span * x) for x in (2.0**by, 2.0**-by)]
    if term.acts == "swinging":
        period, ratio = term.end - term.begin, 1.0 + by * 0.5 * (term.end - term.begin) / whole
        for p in (period * ratio, period, period / ratio):
            for phase in (-by / 4, 0.0, by / 4):
                if p != period or phase:
                    begin = (term.begin / period + phase) * p
                    found.append(replace(term, begin=begin, end=begin + p))
    if set(term.of) & set(RIPPLES):
        for step in (1.0 + 0.15 * by, 1.0, 1.0 / (1.0 + 0.15 * by)):
            for shift in (-0.25 * by, 0.0, 0.25 * by):
                if step != 1.0 or shift:
                    wavelength = term.wavelength * step
                    crest = float(np.remainder(term.crest + shift * wavelength, wavelength))
                    found.append(replace(term, wavelength=wavelength, crest=crest))
    if set(term.of) & set(BEYOND):
        found += [replace(term, beyond=term.beyond * x) for x in (1.0 + by, 1.0 / (1.0 + by))]
    if term.looks_back:
        found += [
            replace(term, memory=_memory(term.memory * x)) for x in (1.0 + by, 1.0 / (1.0 + by))
        ]
    return found
