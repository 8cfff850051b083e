"""Kalman filter over a recording with one slowly varying unmodelled force per freedom, and its smoother.

State z = (positions, earth-axes rates, body-axes latent forces), CALM = 3 NQ, then, where a swell acts, an oscillating
force and its rate per axis, then, where instruments wander, the error of each position. Measured channels are coded:
0 .. NQ-1 a position, NQ .. 2 NQ-1 a body-axes rate. Measurements are taken one at a time, so any of them may be missing
(nan).
"""

from math import cos, exp, sin, sqrt
from typing import Any

import numpy as np

from boatsim.physics.kernel.compiling import compiled, lean
from boatsim.physics.kernel.correction import take
from boatsim.physics.kernel.matrices import carry, copy, copy_square, exponential, multiply, solve
from boatsim.physics.signals import Array, Swell, Wander

from .inertia import constants
from .laws import HAS_SWELL, HAS_WANDER, HELD, MEMORY, distorted, late, shown, swell, wander
from .motion import (
    BESIDE,
    FREE,
    NQ,
    SHOWS,
    TILTS,
    K,
    force_slopes,
    moved,
    observe_level,
    slopes,
    step_in_place,
)
from .run import SHORTEST, actuate_in_place, least_after, settle, until_bend

# not plain integers: those count as types, and what is called with several would be compiled for
# each
NY, CALM = np.int64(2 * NQ), np.int64(3 * NQ)
NZ = np.int64(CALM + (2 * NQ if HAS_SWELL else 0) + (NQ if HAS_WANDER else 0))
STEADY = 1.4  # a step in time constants of the quickest motion: half of what Runge-Kutta bears
LEAST = 0.01  # of an interval, which a step is at least: a boat quicker than that has run away
# rounds of the inversion of what the instruments show, which is never far from the truth
INVERT = 10


@lean
def predict(
    times: Array,
    i: int,
    lateness: float,
    row: int,
    y: Array,
    given: Array,
    commands: Array,
    memory: Array,
    max_step: float,
    p: Array,
    on: Any,
    k: Array,
    force: Array,
    act: Array,
) -> int:
    """Carry y (2 NQ,) from row i - 1 to row i in place, the latent force constant.

    The motion of row i happened `lateness` before its time; commands hold from the times on at which they were `given`.
    `row` is the last command used so far; returns the one used last. No step reaches beyond a change of an actuator's
    signal.
    """
    h = times[i] - times[i - 1]
    longest = h / max(1, int(np.ceil(h / max_step - 1e-9)))
    begin, done, least, before = times[i - 1] - lateness, 0.0, SHORTEST, 0.0
    while h - done > 1e-9:
        while row + 1 < len(given) and given[row + 1] <= begin + done + 1e-9:
            row += 1
        left = min(longest, h - done)
        dt = until_bend(commands[row], memory, left, least, p, on)
        least, before = least_after(dt, before, least), dt
        if row + 1 < len(given):
            dt = min(dt, given[row + 1] - begin - done)
        actuate_in_place(commands[row], memory, dt, p, on, act)
        step_in_place(begin + done, y, dt, act, p, on, k, force)
        done += dt
    return row


@lean
def transition(
    t: float,
    h: float,
    z: Array,
    act: Array,
    p: Array,
    on: Any,
    k: Array,
    force: Array,
    F: Array,
    A: Array,
    B: Array,
) -> float:
    """Linearised transition F of motion and lasting forces over h: exponential of the Jacobian of the accelerations.

    Returns the rate at which the quickest motion dies out there [1/s].
    """
    for i in range(CALM):
        for j in range(CALM):
            A[i, j] = 0.0
    for i in range(NQ):
        A[i, NQ + i] = 1.0
    slopes(t, z, act, p, on, k, force, A[NQ:NY])
    force_slopes(z, k, A, np.int64(NQ), NY)
    rate, level = 0.0, 0.0
    for i in range(NQ):
        if FREE[i] < 2:  # of a turned hull each has a part of both: their sum stays
            level += abs(A[NQ + i, NQ + i])
        rate = max(rate, level, abs(A[NQ + i, NQ + i]))
    exponential(A, h, F, B, CALM)
    return rate


@lean
def oscillation(h: float, s: Swell) -> tuple[float, float, float, float, float, float]:
    """Transition of the oscillator over h, row by row, and its mean force over h per state and rate at the start.

    The force is the rate over the frequency, w s / (s^2 + 2 damping w s + w^2): waves have nothing at zero frequency.
    """
    w, damped = s.frequency, s.frequency * sqrt(1.0 - s.damping * s.damping)
    e, share = exp(-s.damping * w * h), s.damping * w / damped
    f11, f12 = e * (cos(damped * h) + share * sin(damped * h)), e * sin(damped * h) / damped
    f21, f22 = -w * w * f12, e * (cos(damped * h) - share * sin(damped * h))
    mean1, mean2 = (f11 - 1.0) / (w * h), f12 / (w * h)
    return f11, f12, f21, f22, mean1, mean2


@lean
def add_swell(h: float, s: Swell, F: Array) -> None:
    """The oscillators' own rows and what they do to the motion, to F."""
    f11, f12, f21, f22, mean1, mean2 = oscillation(h, s)
    for i in range(NZ):
        for j in range(CALM, NZ):
            F[i, j] = F[j, i] = 0.0
    for j in range(NQ):
        a = CALM + 2 * j
        for i in range(NY):
            F[i, a], F[i, a + 1] = F[i, NY + j] * mean1, F[i, NY + j] * mean2
        F[a, a], F[a, a + 1], F[a + 1, a], F[a + 1, a + 1] = f11, f12, f21, f22


@lean
def sizes(s: Swell, w: Wander) -> tuple[Any, Any]:
    """How many entries of a state are motion and forces, and how many it has with the errors of instruments."""
    m = NZ if not HAS_WANDER else NZ - NQ
    if s.frequency == 0.0:
        m = CALM
    return m, m + NQ if w.position > 0.0 or w.heading > 0.0 else m


@lean
def wandering(w: Wander, j: int) -> float:
    """Rms of the wandering error of position j of a state."""
    if FREE[j] < 2:
        return float(w.position)
    return float(w.heading) if FREE[j] == 5 else 0.0


@lean
def diffuse(
    h: float, m: int, n: int, sigma: Array, tau: float, s: Swell, w: Wander, P: Array
) -> None:
    """Add to P what the noise behind latent forces and instruments does over h."""
    decay = exp(-h / tau)
    for j in range(NQ):
        P[NY + j, NY + j] += sigma[j] * (1.0 - decay * decay)
    for j in range(n - m):
        kept = exp(-h / w.time)
        P[m + j, m + j] += wandering(w, j) ** 2 * (1.0 - kept * kept)
    if m > CALM:
        f11, f12, f21, f22, _, _ = oscillation(h, s)
        w2 = s.frequency * s.frequency
        for j in range(NQ):
            v, a = s[FREE[j]] ** 2, CALM + 2 * j
            P[a, a] += v * (1.0 - f11 * f11 - w2 * f12 * f12)
            P[a + 1, a + 1] += v * (w2 - f21 * f21 - w2 * f22 * f22)
            cross = v * (f11 * f21 + w2 * f12 * f22)
            P[a, a + 1] -= cross
            P[a + 1, a] -= cross


@lean
def shows(y: Array, code: int, p: Array, on: Any) -> float:
    """What the recording shows of one channel in a state y (2 NQ,)."""
    return float(shown(moved(y), p, on)[SHOWS[code]])


@lean
def look(z: Array, codes: Any, H: Array, p: Array, on: Any) -> None:
    """Fill H (C, 2 NQ): how each channel that is shown changes with the motion z, where that takes differences."""
    if not TILTS and not distorted(on):
        return
    seen = shown(moved(z), p, on)
    for c in range(len(codes)):
        H[c, 0] = seen[SHOWS[codes[c]]]
    for j in range(
        NY - 1, -1, -1
    ):  # the first column last: until then it keeps what is seen from z itself
        here = z[j]
        z[j] = here + BESIDE
        beside = shown(moved(z), p, on)
        for c in range(len(codes)):
            H[c, j] = (beside[SHOWS[codes[c]]] - H[c, 0]) / BESIDE
        z[j] = here


@lean
def observe(z: Array, code: int, slope: Array, row: Array, p: Array, on: Any) -> float:
    """Expected value of one channel; fills its row (n,) of the measurement matrix, from `look` if that filled it."""
    if not TILTS and not distorted(on):
        for j in range(NZ):
            row[j] = 0.0
        return observe_level(z, code, row)
    copy(slope, row[:NY])
    return shows(z, code, p, on)


@compiled
def undistorted(z: Array, p: Array, on: Any) -> None:
    """Turn positions as recorded into those of the boat, in place."""
    if distorted(on):
        recorded, y = np.zeros(NQ), np.zeros(NY)
        copy(z, recorded)
        copy(z, y)
        for _ in range(INVERT):
            for j in range(NQ):
                z[j] += recorded[j] - shows(y, j, p, on)
            copy(z, y)


@lean
def begin(z0: Array, P0: Array, m: int, n: int, s: Swell, w: Wander, z: Array, P: Array) -> None:
    """State and covariance of the first row, the swell anywhere in its cycle."""
    for a in range(CALM):
        z[a] = z0[a]
    copy_square(P0, P, CALM)
    for j in range(
        n - m
    ):  # the first fix was off by an error as large as any: the boat is the other way by as much
        variance = wandering(w, j) ** 2
        P[m + j, m + j] = variance
        P[j, j] += variance
        P[j, m + j] = P[m + j, j] = -variance
    if m > CALM:
        for j in range(NQ):
            P[CALM + 2 * j, CALM + 2 * j] = s[FREE[j]] ** 2
            P[CALM + 2 * j + 1, CALM + 2 * j + 1] = (s.frequency * s[FREE[j]]) ** 2


@lean
def felt(z: Array, h: float, s: Swell, m: int, y: Array, force: Array) -> None:
    """The motion y (2 NQ,) in a state, and the mean of its latent forces over the next h seconds."""
    copy(z, y)
    for a in range(NQ):
        force[a] = z[NY + a]
    if m > CALM:
        _, _, _, _, mean1, mean2 = oscillation(h, s)
        for a in range(NQ):
            force[a] += mean1 * z[CALM + 2 * a] + mean2 * z[CALM + 2 * a + 1]


@lean
def spread(
    F: Array,
    h: float,
    tau: float,
    s: Swell,
    w: Wander,
    m: int,
    n: int,
    sigma: Array,
    P: Array,
    work: Array,
) -> None:
    """Carry P over h; F comes as the transition of motion and lasting forces, and leaves with that of all forces."""
    for a in range(NY, CALM):
        F[a, a] = exp(-h / tau)
    if m > CALM:
        add_swell(h, s, F)
    for j in range(m, n):
        for i in range(n):
            F[i, j] = F[j, i] = 0.0
        F[j, j] = exp(-h / w.time)
    carry(F, P, work, n)
    diffuse(h, m, n, sigma, tau, s, w, P)


@lean
def arrived(y: Array, h: float, tau: float, s: Swell, w: Wander, m: int, n: int, z: Array) -> None:
    """The state h later, its motion now y: lasting forces and errors decay, the swell goes on in its cycle."""
    for a in range(NY):
        z[a] = y[a]
    for a in range(NY, CALM):
        z[a] *= exp(-h / tau)
    for a in range(m, n):
        z[a] *= exp(-h / w.time)
    if m > CALM:
        f11, f12, f21, f22, _, _ = oscillation(h, s)
        for a in range(CALM, m, 2):
            z[a], z[a + 1] = f11 * z[a] + f12 * z[a + 1], f21 * z[a] + f22 * z[a + 1]


@lean
def across(F: Array, z: Array, about: Array, y: Array) -> None:
    """To y, where the motion `about` leads, what the motion of state z differs by along the transition F."""
    for a in range(NY):
        for b in range(NY):
            y[a] += F[a, b] * (z[b] - about[b])


@lean
def follow(
    times: Array,
    i: int,
    lateness: float,
    row: int,
    z: Array,
    y: Array,
    given: Array,
    commands: Array,
    memory: Array,
    remembered: Array,
    max_step: float,
    steps: Array,
    p: Array,
    on: Any,
    k: Array,
    force: Array,
    act: Array,
    s: Swell,
    m: int,
    F: Array,
    A: Array,
    B: Array,
) -> int:
    """`predict`, with the transition F linearised about the state z before, with the actuators at this interval's end.

    In steps that follow the quickest motion there: those that suited the row before may be too long. Fills steps[i] and
    a first guess for the row after; `remembered` is room for the actuators' memory.
    """
    h = times[i] - times[i - 1]
    if i == 1:
        steps[i] = max_step
    copy(memory, remembered)
    last = predict(
        times, i, lateness, row, y, given, commands, memory, steps[i], p, on, k, force, act
    )
    rate = transition(times[i - 1] - lateness, h, z, act, p, on, k, force, F, A, B)
    longest = max(min(max_step, STEADY / max(rate, 1e-9)), LEAST * h)
    if longest < 0.5 * steps[i]:
        steps[i] = longest
        felt(z, h, s, m, y, force)
        copy(remembered, memory)
        last = predict(
            times, i, lateness, row, y, given, commands, memory, longest, p, on, k, force, act
        )
    if i + 1 < len(times):
        steps[i + 1] = longest
    return last


@lean
def correct(
    measured: Array,
    codes: Any,
    p: Array,
    on: Any,
    noise: Array,
    full: bool,
    m: int,
    n: int,
    z: Array,
    P: Array,
    H: Array,
    row: Array,
    Ph: Array,
    outliers: Array,
    gains: Array,
    scale: Array,
    white: Array,
) -> float:
    """Correct z, and P if `full`, by one row of the recording (C,); returns what it adds to the log likelihood."""
    likelihood = 0.0
    if full:
        look(z, codes, H, p, on)
    for c in range(len(measured)):
        if np.isnan(measured[c]):
            scale[c] = white[c] = 0.0
            continue
        error = measured[c] - observe(z, codes[c], H[c], row, p, on)
        own = np.int64(-1)
        if n > m and codes[c] < NQ:
            own = m + codes[c]
            error -= z[own]
        likelihood += take(
            error,
            row,
            noise[c],
            full,
            outliers[c:],
            z,
            P,
            Ph,
            n,
            NY,
            own,
            gains[c],
            scale[c:],
            white[c:],
        )
    return likelihood


@compiled
def kalman(
    times: Array,
    measured: Array,
    codes: Any,
    given: Array,
    commands: Array,
    max_step: float,
    body: Array,
    p: Array,
    on: Any,
    sigma: Array,
    tau: float,
    noise: Array,
    z0: Array,
    P0: Array,
    rates: Array,
    full: bool,
    fresh: bool,
    linear: Array,
    steps: Array,
    gains: Array,
    scale: Array,
    white: Array,
    keep: bool,
    means: Array,
    covariances: Array,
    transitions: Array,
    predicted: Array,
) -> float:
    """One pass. measured (N, C), nan where missing; noise (C,) and sigma (NQ,) are variances of sensors and force.

    commands (M, K): each row is in force from when it was given (M,).
    rates (NQ,): earth-axes rates about which the first interval is linearised, where z0 and P0 know little of them.
    full: compute gains (N, C, n) and inverse innovation sd `scale` (N, C), 0 where missing, both less for an outlier;
    otherwise reuse them. fresh: linearise, and keep it in `linear` (N, CALM, CALM), and in `steps` (N,) the longest
    that follow the quickest motion; otherwise take both from there.
    white (N, C) gets the whitened innovations. keep: store what the smoother needs. Returns log likelihood.
    """
    k, act, memory, remembered = np.zeros(K), np.zeros(3 * HELD), np.zeros(MEMORY), np.zeros(MEMORY)
    constants(body, p, on, k)
    settle(commands[0], memory, p, on, act)
    s, w, lateness = swell(p, on), wander(p, on), late(p, on)
    m, n = sizes(s, w)
    z, P = np.zeros(NZ), np.zeros((NZ, NZ))
    begin(z0, P0, m, n, s, w, z, P)
    undistorted(z, p, on)
    F, row, work, work2 = np.zeros((NZ, NZ)), np.zeros(NZ), np.zeros((NZ, NZ)), np.zeros((NZ, NZ))
    y, force, about = np.zeros(NY), np.zeros(NQ), np.zeros(NZ)
    Ph, H, outliers = np.zeros(NZ), np.zeros((len(codes), NY)), np.zeros(len(codes))
    likelihood, held = 0.0, np.int64(0)  # a plain 0 would have `predict` compiled twice
    if keep:
        copy(z, means[0])
        copy(z, predicted[0])
        copy_square(P, covariances[0], NZ)
    for i in range(1, len(times)):
        h = times[i] - times[i - 1]
        copy(z, about)
        if i == 1:
            copy(rates, about[NQ:NY])
        felt(about, h, s, m, y, force)
        if full and fresh:
            held = follow(
                times,
                i,
                lateness,
                held,
                about,
                y,
                given,
                commands,
                memory,
                remembered,
                max_step,
                steps,
                p,
                on,
                k,
                force,
                act,
                s,
                m,
                F,
                work,
                work2,
            )
            copy_square(F, linear[i], CALM)
        else:
            held = predict(
                times, i, lateness, held, y, given, commands, memory, steps[i], p, on, k, force, act
            )
            if full or i == 1:
                copy_square(linear[i], F, CALM)
        if i == 1:
            across(F, z, about, y)
        if full:
            spread(F, h, tau, s, w, m, n, sigma, P, work2)
        arrived(y, h, tau, s, w, m, n, z)
        if keep:
            copy(z, predicted[i])
            copy_square(F, transitions[i], NZ)
        likelihood += correct(
            measured[i],
            codes,
            p,
            on,
            noise,
            full,
            m,
            n,
            z,
            P,
            H,
            row,
            Ph,
            outliers,
            gains[i],
            scale[i],
            white[i],
        )
        if keep:
            copy(z, means[i])
            copy_square(P, covariances[i], NZ)
    return likelihood


@compiled
def smooth(
    means: Array,
    covariances: Array,
    transitions: Array,
    predicted: Array,
    gains: Array,
    sigma: Array,
    times: Array,
    tau: float,
    p: Array,
    on: Any,
) -> None:
    """Rauch-Tung-Striebel smoother, in place on means (N, n) and covariances (N, n, n); fills its gains (N, n, n)."""
    s, w = swell(p, on), wander(p, on)
    m, n = sizes(s, w)
    ahead, cross, G, work = (
        np.zeros((NZ, NZ)),
        np.zeros((NZ, NZ)),
        np.zeros((NZ, NZ)),
        np.zeros((NZ, NZ)),
    )
    off = np.zeros(NZ)
    for i in range(len(times) - 2, -1, -1):
        multiply(transitions[i + 1], covariances[i], cross, n)  # F P
        copy_square(covariances[i], ahead, n)
        carry(transitions[i + 1], ahead, work, n)
        diffuse(times[i + 1] - times[i], m, n, sigma, tau, s, w, ahead)
        for j in range(n):
            ahead[j, j] *= (
                1.0 + 1e-9
            )  # positions and rates are driven through the force alone: keep it invertible
            ahead[j, j] += 1e-18
        copy_square(ahead, work, n)
        solve(work, cross, n)
        for j in range(n):
            off[j] = means[i + 1, j] - predicted[i + 1, j]
            for k in range(n):
                G[j, k] = gains[i, j, k] = cross[k, j]
                ahead[j, k] = covariances[i + 1, j, k] - ahead[j, k]
        carry(G, ahead, work, n)
        for j in range(n):
            for k in range(n):
                means[i, j] += G[j, k] * off[k]
                covariances[i, j, k] += ahead[j, k]


@compiled
def free_runs(
    times: Array,
    given: Array,
    commands: Array,
    max_step: float,
    body: Array,
    p: Array,
    on: Any,
    starts: Any,
    ends: Any,
    states: Array,
    out: Array,
) -> None:
    """Free runs from row starts[j] to ends[j] out of states[j] (2 NQ,), driven by the commands alone.

    Actuator memory runs from the first row on, latent forces are zero. Fills out (runs, N, 2 NQ) with every channel
    as the recording would show it.
    """
    k, act, memory = np.zeros(K), np.zeros(3 * HELD), np.zeros(MEMORY)
    constants(body, p, on, k)
    settle(commands[0], memory, p, on, act)
    nothing, y, lateness, held = np.zeros(NQ), np.zeros(NY), late(p, on), np.int64(0)
    saved, rows = np.zeros((len(times), MEMORY)), np.zeros(len(times), dtype=np.int64)
    for i in range(1, len(times)):  # only for the actuators
        copy(memory, saved[i - 1])
        rows[i - 1] = held
        for j in range(NY):
            y[j] = 0.0
        held = predict(
            times, i, lateness, held, y, given, commands, memory, max_step, p, on, k, nothing, act
        )
    for run in range(len(starts)):
        copy(states[run], y)
        copy(saved[starts[run]], memory)
        held = rows[starts[run]]
        for i in range(starts[run], ends[run] + 1):
            if i > starts[run]:
                held = predict(
                    times,
                    i,
                    lateness,
                    held,
                    y,
                    given,
                    commands,
                    memory,
                    max_step,
                    p,
                    on,
                    k,
                    nothing,
                    act,
                )
            for code in range(NY):
                out[run, i, code] = shows(y, code, p, on)
