"""Terms of symbolic regression: products of factors that have names, and their course in time.

Files contain the names of factors, courses and directions; a program uses a number for each
(`factor_codes`), so that one compiled law serves all of them. The same functions work on single
numbers and on arrays over the rows of a recording.
"""

from collections.abc import Sequence
from math import pi
from typing import Any

import numpy as np
from numba import njit

from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.kernel.compiling import apart
from boatsim.physics.signals import SignalSegment, Wrench, first_order_lag, longest_lag_step, wrench

# through the water
SPEEDS = ("surge_speed", "sway_speed", "heave_speed", "roll_rate", "pitch_rate", "yaw_rate")
SIZES = tuple(map("abs_{}".format, SPEEDS))
SENSES = tuple(map("sign_{}".format, SPEEDS))
BEARINGS = ("cos_heading", "sin_heading", "cos_twice_heading", "sin_twice_heading")
PLACES = ("north", "east", "depth", "roll_angle", "pitch_angle")
RIPPLES = ("ripple_north", "ripple_east")  # a pattern that is fixed in the water, along an axis
BEYOND = tuple(map("beyond_{}".format, SPEEDS))  # excess of a speed over a threshold, with its sign
# The number of a factor is its place in this list.
FACTORS = ("", *SPEEDS, *SIZES, *SENSES, *BEARINGS, *PLACES, *RIPPLES, *BEYOND)
# In front of the name of an actuator signal: the signal behind a first-order lag, and the signal
# less that
HISTORIES = ("recent", "changed")
RECALLED = 90  # number of the lagged signal of a term; 91: its absolute value
FIRST_HELD = 100  # number of actuator signal k less 2 k; one more: its absolute value
MOST_FACTORS = 3  # in a term
COURSES = ("always", "within", "rising", "fading", "swinging")
# north and east on level axes
DIRECTIONS = ("surge", "sway", "heave", "roll", "pitch", "yaw", "north", "east")
SPEED_UNITS = 3 * ("m/s",) + 3 * ("rad/s",)
UNITS = dict(zip(SPEEDS, SPEED_UNITS, strict=True))
for _names in (SIZES, BEYOND):
    UNITS |= dict(zip(_names, SPEED_UNITS, strict=True))
UNITS |= dict(zip(PLACES, 3 * ("m",) + 2 * ("rad",), strict=True))

# First number of each group of factors
SINGLE, SIZE, SENSE = FACTORS.index(SPEEDS[0]), FACTORS.index(SIZES[0]), FACTORS.index(SENSES[0])
BEARING, PLACE = FACTORS.index(BEARINGS[0]), FACTORS.index(PLACES[0])
RIPPLE, ABOVE = FACTORS.index(RIPPLES[0]), FACTORS.index(BEYOND[0])
# wavelength and crest [m] of a ripple, little and beyond [SI] of a speed
Detail = tuple[float, float, float, float]
WITHIN, RISING, FADING, SWINGING = map(float, range(1, len(COURSES)))


@apart
def factor_value(m: Any, act: Any, at: Any, own: Any, number: float, detail: Detail) -> Any:
    """Return one factor of a term of symbolic regression, such as a velocity or its sign.

    Args:
        m: `Motion` of the hull.
        act: Values of the actuators.
        at: Index in `act` of the first value to use.
        own: Index, counted from `at`, of the term's lagged signal.
        number: Code of the factor, see `factor_codes`.
        detail: Wavelength and crest of a ripple, which is 1 at its crest; speed `little` within
            which a sense changes; threshold `beyond`.
    """
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
def time_profile(t: Any, acts: float, begin: float, end: float) -> Any:
    """Return the time-dependent factor of a term of symbolic regression at one time.

    Args:
        t: Time [s].
        acts: Code of the time dependence: always 1; 1 between begin and end; a ramp from begin to
            end; an exponential decay from begin, or a sine, with end - begin as time constant or
            period.
        begin: Time [s].
        end: Time [s].
    """
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
def term_value(m: Any, q: Any, act: Any, at: Any, own: Any) -> Any:
    """Return a term of symbolic regression without its coefficient.

    It is the product of up to three factors of the state and a function of time.

    Args:
        m: `Motion` of the hull.
        q: Parameters of the effect.
        act: Values of the actuators.
        at: Index in `act` of the first value to use.
        own: Index, counted from `at`, of the term's lagged signal.
    """
    detail = (q.wavelength, q.crest, q.little, q.beyond)
    # most terms have one or two factors; a hull with many drives evaluates a term for each
    return (
        factor_value(m, act, at, own, q.first, detail)
        * (factor_value(m, act, at, own, q.second, detail) if q.second != 0.0 else 1.0)
        * (factor_value(m, act, at, own, q.third, detail) if q.third != 0.0 else 1.0)
        * (time_profile(m.t, q.course, q.begin, q.end) if q.course != 0.0 else 1.0)
    )


@apart
def write_signal_history(
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
    """Compute the lagged value of an actuator signal over a step, for a term that uses its past.

    The value (or the signal less the lagged value) at begin, middle and end is written to `act`.

    Args:
        act: Values of the actuators.
        held: Number of values that describe the actuators at one time.
        own: Index of the result in `act`.
        kept: States of the actuators.
        at: Index of the state of the lag in `kept`.
        dt: Length of the step [s].
        looks_at: Code of the signal, see `history_codes`.
        beyond: 1 for the signal less the lagged one, else 0.
        memory: Time constant of the lag [s].
    """
    if looks_at < FIRST_HELD:
        return
    k, sign = (int(looks_at) - FIRST_HELD) // 2, 1.0 - 2.0 * beyond
    begin, middle, end = act[k], act[held + k], act[2 * held + k]
    if int(looks_at) % 2:
        begin, middle, end = abs(begin), abs(middle), abs(end)
    late = first_order_lag(SignalSegment(begin, middle, end), memory, kept, at, dt)
    act[own] = beyond * begin + sign * late.begin
    act[held + own] = beyond * middle + sign * late.middle
    act[2 * held + own] = beyond * end + sign * late.end


@njit(inline="always")
def update_signal_history(
    act: Any, held: Any, own: Any, kept: Any, at: Any, dt: float, q: Any
) -> None:
    """Compute the lagged actuator signal that an effect's law uses, over one step.

    It applies `write_signal_history` with the parameters of the effect.

    Args:
        act: Values of the actuators.
        held: Number of values that describe the actuators at one time.
        own: Index of the result in `act`.
        kept: States of the actuators.
        at: Index of the state of the lag in `kept`.
        dt: Length of the step [s].
        q: Parameters of the effect.
    """
    write_signal_history(act, held, own, kept, at, dt, q.looks_at, q.looks, q.memory)


@njit(inline="always")
def longest_history_step(q: Any) -> float:
    """Return the longest step [s] over which three points describe a lagged actuator signal."""
    return longest_lag_step(q.memory) if q.looks_at > 0.0 else np.inf


@apart
def wrench_along(m: Any, direction: float, force: float) -> Wrench:
    """Return the force and moment on the hull of a force along one axis of hull or earth.

    Args:
        m: `Motion` of the hull.
        direction: Code of the axis: index in `DIRECTIONS`.
        force: Force [N] or moment [N m].
    """
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


def factor_names(held: Sequence[str]) -> tuple[str, ...]:
    """Return the names of all factors that symbolic regression may use for a vessel.

    They are quantities of its motion and of its actuators.

    Args:
        held: Names of the vessel's actuator signals.
    """
    signals: list[str] = []
    for name in held:
        signals += [name, f"abs_{name}"]
    histories: list[str] = []
    for how in HISTORIES:
        histories += map(f"{how}_{{}}".format, signals)
    for how in HISTORIES:
        histories += map(f"abs_{how}_{{}}".format, held)
    return (*FACTORS[1:], *signals, *histories)


def split_history_name(name: str, held: Sequence[str]) -> tuple[str, str]:
    """Return the kind of past value that a factor's name denotes, and the actuator signal.

    The result is "", "" for a factor that uses no past values.

    Args:
        name: Name of the factor.
        held: Names of the vessel's actuator signals.
    """
    bare = name.removeprefix("abs_")
    for how in HISTORIES:
        if bare.startswith(f"{how}_") and bare not in held:
            return how, bare.removeprefix(f"{how}_")
    return "", ""


def history_codes(what: str, of: Sequence[str], held: Sequence[str]) -> tuple[float, float]:
    """Return the numeric codes of the past actuator signal that a regression term uses.

    They are the code of the signal and that of the kind of history; 0, 0 without one.

    Args:
        what: Name of the effect, for the message.
        of: Names of the factors.
        held: Names of the vessel's actuator signals.

    Raises:
        BadInput: The factors use more than one history.
    """
    found = sorted({split_history_name(name, held) for name in of} - {("", "")})
    if len(found) > 1:
        raise BadInput(
            f"{what}: of = {list(of)}; allowed is the history of one signal, of one kind"
        )
    for how, signal in found:
        return factor_codes(what, (signal,), held)[0], float(HISTORIES.index(how))
    return 0.0, 0.0


def factor_codes(what: str, of: Sequence[str], held: Sequence[str]) -> tuple[float, ...]:
    """Return the numeric codes (MOST_FACTORS,) of the factors of a regression term.

    Args:
        what: Name of the effect, for the message.
        of: Names of the factors.
        held: Names of the vessel's actuator signals.

    Raises:
        BadInput: A factor does not exist, or there are too many.
    """
    if len(of) > MOST_FACTORS:
        raise BadInput(f"{what}: of = {list(of)}; allowed are at most {MOST_FACTORS} factors")
    found = []
    for name in of:
        size = name.removeprefix("abs_")
        if name in held or size in held:
            absolute = name not in held
            signal = size if absolute else name
            found.append(float(FIRST_HELD + 2 * list(held).index(signal) + absolute))
        elif name and name in FACTORS:
            found.append(float(FACTORS.index(name)))
        elif name in factor_names(held):
            found.append(float(RECALLED + name.startswith("abs_")))
        else:
            raise BadInput(unknown_name_message(f"{what}: of", name, factor_names(held)))
    return (*found, *[0.0] * (MOST_FACTORS - len(found)))


def index_code(what: str, word: str, words: Sequence[str]) -> float:
    """Return the numeric code of a name: its index in a list of allowed names.

    It is used for axes and time dependences of regression terms.

    Args:
        what: Name of the effect and key, for the message.
        word: The name.
        words: All allowed names.

    Raises:
        BadInput: The name is not allowed.
    """
    if word not in words:
        raise BadInput(unknown_name_message(what, word, words))
    return float(words.index(word))
