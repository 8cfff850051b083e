"""Terms of a described law: products of factors that a sailor knows, and how it acts in time.

Files name factors, courses and directions; a program knows each by a number (`codes`), so that one compiled law is any
of them. The same functions work on single numbers and on arrays over the rows of a recording.
"""

from collections.abc import Sequence
from math import pi
from typing import Any

import numpy as np
from numba import njit

from boatsim.errors import BadInput, unknown_name
from boatsim.physics.kernel.compiling import apart
from boatsim.physics.signals import Course, Wrench, followed, lagged, wrench

SPEEDS = (
    "surge_speed",
    "sway_speed",
    "heave_speed",
    "roll_rate",
    "pitch_rate",
    "yaw_rate",
)  # through the water
SIZES, SENSES = tuple(f"abs_{s}" for s in SPEEDS), tuple(f"sign_{s}" for s in SPEEDS)
BEARINGS = ("cos_heading", "sin_heading", "cos_twice_heading", "sin_twice_heading")
PLACES = ("north", "east", "depth", "roll_angle", "pitch_angle")
RIPPLES = ("ripple_north", "ripple_east")  # a pattern that lies still, along north or east
BEYOND = tuple(
    f"beyond_{s}" for s in SPEEDS
)  # what a speed is above a threshold either way, with its sign
FACTORS = (
    "",
    *SPEEDS,
    *SIZES,
    *SENSES,
    *BEARINGS,
    *PLACES,
    *RIPPLES,
    *BEYOND,
)  # a factor's number is its place here;
HISTORIES = (
    "recent",
    "changed",
)  # in front of an actuator signal: what it was of late, and by how much it is beyond
RECALLED = 90  # number of what a term recalls, of its size one more
FIRST_HELD = 100  # that of a vessel's k-th actuator signal this and 2 k, of its size one more
MOST = 3  # factors of a term
COURSES = ("always", "within", "rising", "fading", "swinging")
DIRECTIONS = (
    "surge",
    "sway",
    "heave",
    "roll",
    "pitch",
    "yaw",
    "north",
    "east",
)  # the last two on level axes
SPEED_UNITS = dict(zip(SPEEDS, 3 * ("m/s",) + 3 * ("rad/s",), strict=True))
UNITS = SPEED_UNITS | {
    f"{mark}_{s}": unit for s, unit in SPEED_UNITS.items() for mark in ("abs", "beyond")
}
UNITS |= dict(zip(PLACES, 3 * ("m",) + 2 * ("rad",), strict=True))

SINGLE, SIZE, SENSE, BEARING, PLACE, RIPPLE, ABOVE = (
    FACTORS.index(names[0]) for names in (SPEEDS, SIZES, SENSES, BEARINGS, PLACES, RIPPLES, BEYOND)
)
Detail = tuple[
    float, float, float, float
]  # wavelength and crest [m] of a ripple, little and beyond [SI] of a speed
WITHIN, RISING, FADING, SWINGING = (float(COURSES.index(c)) for c in COURSES[1:])


@apart
def factor(m: Any, act: Any, at: Any, own: Any, number: float, detail: Detail) -> Any:
    """One factor; a sense turns within `little`, a ripple is one at its crest, act[at + own] is what is recalled."""
    k, (wavelength, crest, little, beyond) = int(number), detail
    if k >= RECALLED:
        value = act[at + (own if k < FIRST_HELD else (k - FIRST_HELD) // 2)]
        return abs(value) if k % 2 else value
    if RIPPLE <= k < ABOVE:
        return np.cos(2.0 * pi / wavelength * ((m.x if k == RIPPLE else m.y) - crest))
    if PLACE <= k < ABOVE:
        return (m.x, m.y, m.z, m.phi, m.theta)[k - PLACE]
    if BEARING <= k < ABOVE:
        c, s = m.cos_psi, m.sin_psi
        return (c, s, c * c - s * s, 2.0 * c * s)[k - BEARING]
    if k >= SINGLE:
        first = ABOVE if k >= ABOVE else SINGLE
        speed = (m.ur, m.vr, m.wr, m.p, m.q, m.r)[(k - first) % len(SPEEDS)]
        if k >= ABOVE:
            return np.sign(speed) * np.maximum(np.abs(speed) - beyond, 0.0)
        return speed if k < SIZE else abs(speed) if k < SENSE else np.tanh(speed / little)
    return 0.0 * m.t + 1.0


@apart
def course(t: Any, acts: float, begin: float, end: float) -> Any:
    """How a law acts in time: always; within two instants; rising between them; fading, swinging over their span."""
    if acts == WITHIN:
        return 1.0 * ((t >= begin) & (t < end))
    if acts == RISING:
        return np.minimum(np.maximum((t - begin) / (end - begin), 0.0), 1.0)
    if acts == FADING:
        return np.exp(-np.maximum(t - begin, 0.0) / (end - begin))
    if acts == SWINGING:
        return np.sin(2.0 * pi * (t - begin) / (end - begin))
    return 0.0 * t + 1.0


@njit(inline="always")
def term(m: Any, q: Any, act: Any, at: Any, own: Any) -> Any:
    """The product of a described law's factors and its course."""
    detail = (q.wavelength, q.crest, q.little, q.beyond)
    return (
        factor(m, act, at, own, q.first, detail)
        * factor(m, act, at, own, q.second, detail)
        * factor(m, act, at, own, q.third, detail)
        * course(m.t, q.course, q.begin, q.end)
    )


@apart
def recalled(
    act: Any,
    held: Any,
    own: Any,
    kept: Any,
    at: Any,
    dt: float,
    looks_at: float,
    beyond: float,
    memory: float,
) -> None:
    """What a term recalls over a step, to act: a signal or its size as it was of late, by a lag, or by how much beyond.

    `looks_at` and `beyond` are by `looks`; kept[at] is the lag's own.
    """
    if looks_at < FIRST_HELD:
        return
    k, sign = (int(looks_at) - FIRST_HELD) // 2, 1.0 - 2.0 * beyond
    begin, middle, end = act[k], act[held + k], act[2 * held + k]
    if int(looks_at) % 2:
        begin, middle, end = abs(begin), abs(middle), abs(end)
    late = lagged(Course(begin, middle, end), memory, kept, at, dt)
    act[own] = beyond * begin + sign * late.begin
    act[held + own] = beyond * middle + sign * late.middle
    act[2 * held + own] = beyond * end + sign * late.end


@njit(inline="always")
def recall(act: Any, held: Any, own: Any, kept: Any, at: Any, dt: float, q: Any) -> None:
    """`recalled` of a described law."""
    recalled(act, held, own, kept, at, dt, q.looks_at, q.looks, q.memory)


@njit(inline="always")
def reach(q: Any) -> float:
    """For how many s three points tell what a described law recalls."""
    return followed(q.memory) if q.looks_at > 0.0 else np.inf


@apart
def along(m: Any, direction: float, force: float) -> Wrench:
    """A force or moment along one of `DIRECTIONS`."""
    k = int(direction)
    if k == 6:
        return wrench(X=force * m.cos_psi, Y=-force * m.sin_psi)
    if k == 7:
        return wrench(X=force * m.sin_psi, Y=force * m.cos_psi)
    return wrench(
        X=force * (k == 0),
        Y=force * (k == 1),
        Z=force * (k == 2),
        K=force * (k == 3),
        M=force * (k == 4),
        N=force * (k == 5),
    )


def names_for(held: Sequence[str]) -> tuple[str, ...]:
    """Names of all factors on a vessel with these actuator signals."""
    signals = [name for h in held for name in (h, f"abs_{h}")]
    late = [f"{how}_{signal}" for how in HISTORIES for signal in signals]
    return (*FACTORS[1:], *signals, *late, *(f"abs_{how}_{h}" for how in HISTORIES for h in held))


def looking(name: str, held: Sequence[str]) -> tuple[str, str]:
    """How a factor looks back, and at which signal or its size, ("recent", "abs_thrust_N"); "", "" if it does not."""
    bare = name.removeprefix("abs_")
    how = next((h for h in HISTORIES if bare.startswith(f"{h}_") and bare not in held), "")
    return (how, bare.removeprefix(f"{how}_")) if how else ("", "")


def looks(what: str, of: Sequence[str], held: Sequence[str]) -> tuple[float, float]:
    """Numbers of the signal that a term looks back at, and how; 0, 0 where it does not. Raises BadInput for several."""
    found = sorted({looking(name, held) for name in of} - {("", "")})
    if len(found) > 1:
        raise BadInput(
            f"{what}: of = {list(of)}; allowed is to look back at one signal, in one way"
        )
    for how, signal in found:
        return codes(what, (signal,), held)[0], float(HISTORIES.index(how))
    return 0.0, 0.0


def codes(what: str, of: Sequence[str], held: Sequence[str]) -> tuple[float, ...]:
    """(MOST,) numbers of a term's factors. Raises BadInput for a name that does not exist, or too many."""
    if len(of) > MOST:
        raise BadInput(f"{what}: of = {list(of)}; allowed are at most {MOST} factors")
    found = []
    for name in of:
        size = name.removeprefix("abs_")
        if name in held or size in held:
            of_size = name not in held
            found.append(
                float(FIRST_HELD + 2 * list(held).index(size if of_size else name) + of_size)
            )
        elif name and name in FACTORS:
            found.append(float(FACTORS.index(name)))
        elif name in names_for(held):
            found.append(float(RECALLED + name.startswith("abs_")))
        else:
            raise BadInput(unknown_name(f"{what}: of", name, names_for(held)))
    return (*found, *[0.0] * (MOST - len(found)))


def code_of(what: str, word: str, words: Sequence[str]) -> float:
    """Number of a course or direction. Raises BadInput."""
    if word not in words:
        raise BadInput(unknown_name(what, word, words))
    return float(words.index(word))
