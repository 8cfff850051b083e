"""Kalman filter over a recording with one slowly varying unmodelled force per freedom, and its smoother.

State z = (positions, earth-axes rates, body-axes latent forces), n = 3 NQ. Measured channels are coded: 0 .. NQ-1 a
position, NQ .. 2 NQ-1 a body-axes rate. Measurements are taken one at a time, so any of them may be missing (nan).
"""

from math import cos, exp, log, sin, sqrt
from typing import Any

import numpy as np
from numba import njit

from boatsim.base import Array
from boatsim.kernels.common import settle
from boatsim.kernels.laws import HELD, MEMORY, actuate, pause
from boatsim.kernels.planar import NQ, K, constants, slopes, step_in_place

NY = 2 * NQ
NZ = 3 * NQ
GATE = 5.0  # [sd] a measurement further off is taken for an outlier: no update, a bounded penalty
IN_A_ROW = 2  # outliers of one channel; a further one means that the filter has lost track and must follow


@njit(error_model="numpy", cache=True)
def predict(
    t: float, h: float, substeps: int, y: Array, command: Array, memory: Array, p: Array, on: Any, k: Array,
    force: Array, act: Array,
) -> None:  # fmt: skip
    """Carry y (2 NQ,) over one sample interval h with the command held and the latent force constant, in place."""
    done = 0.0
    while h - done > 1e-9:
        dt = min(h / substeps, h - done, max(pause(memory, p, on), 1e-9))
        actuate(command, memory, dt, p, on, act)
        step_in_place(t + done, y, dt, act, p, on, k, force)
        done += dt


@njit(error_model="numpy", cache=True)
def transition(
    t: float, h: float, z: Array, act: Array, p: Array, on: Any, k: Array, decay: float, F: Array, work: Array
) -> None:
    """Linearised transition F (n, n) over h: third-order exponential of the numerical Jacobian of the accelerations."""
    base, moved = work[0, :NQ], work[1, :NQ]
    y, force = z[:NY].copy(), z[NY:].copy()
    slopes(t, y, act, p, on, k, force, base)
    A, B = np.zeros((NZ, NZ)), np.zeros((NZ, NZ))
    for i in range(NQ):
        A[i, NQ + i] = 1.0
    for j in range(NZ):
        step = 1e-6
        if j < NY:
            y[j] += step
            slopes(t, y, act, p, on, k, force, moved)
            y[j] -= step
        else:
            # forces enter linearly; a step of their own size would vanish beside large ones
            step = 1e-3 * (1.0 + abs(force[j - NY]))
            force[j - NY] += step
            slopes(t, y, act, p, on, k, force, moved)
            force[j - NY] -= step
        for i in range(NQ):
            A[NQ + i, j] = (moved[i] - base[i]) / step
    # exp(A h) to third order; only the rows of the rates and, above them, their own integrals are not trivial
    for i in range(NZ):
        for j in range(NZ):
            A[i, j] *= h
    multiply(A, A, B)
    multiply(B, A, F)
    for i in range(NZ):
        for j in range(NZ):
            F[i, j] = A[i, j] + 0.5 * B[i, j] + F[i, j] / 6.0
        F[i, i] += 1.0
    for i in range(NY, NZ):
        F[i, i] = decay


@njit(error_model="numpy", cache=True)
def multiply(A: Array, B: Array, out: Array) -> None:
    """Out = A B for the filter's small matrices, most of A's rows zero: faster here than a library call."""
    out[:] = 0.0
    for i in range(NZ):
        for k in range(NZ):
            x = A[i, k]
            if x != 0.0:
                for j in range(NZ):
                    out[i, j] += x * B[k, j]


@njit(error_model="numpy", cache=True)
def carry(F: Array, P: Array, work: Array) -> None:
    """P = F P F', symmetric, in place."""
    multiply(F, P, work)
    for i in range(NZ):
        for j in range(i + 1):
            x = 0.0
            for k in range(NZ):
                x += work[i, k] * F[j, k]
            P[i, j] = P[j, i] = x


@njit(error_model="numpy", cache=True)
def observe(z: Array, code: int, row: Array) -> float:
    """Expected value of one channel; fills its row (n,) of the measurement matrix."""
    row[:] = 0.0
    if code < NQ:
        row[code] = 1.0
        return float(z[code])
    if NQ == 1 or code == NY - 1:
        row[code] = 1.0
        return float(z[code])
    c, s = cos(z[2]), sin(z[2])
    xd, yd = z[NQ], z[NQ + 1]
    if code == NQ:  # u
        row[NQ], row[NQ + 1], row[2] = c, s, c * yd - s * xd
        return float(c * xd + s * yd)
    row[NQ], row[NQ + 1], row[2] = -s, c, -s * yd - c * xd
    return float(c * yd - s * xd)


@njit(error_model="numpy", cache=True)
def weigh(P: Array, row: Array, noise: float, gain: Array, Ph: Array) -> float:
    """Gain (n,) of one measurement and P row' (n,), in place; returns the inverse sd of its prediction error."""
    variance = noise
    for a in range(NZ):
        Ph[a] = 0.0
        for b in range(NZ):
            Ph[a] += P[a, b] * row[b]
        variance += row[a] * Ph[a]
    for a in range(NZ):
        gain[a] = Ph[a] / variance
    return float(1.0 / sqrt(variance))


@njit(error_model="numpy", cache=True)
def kalman(
    times: Array, measured: Array, codes: Any, commands: Array, max_step: float, body: Array, p: Array, on: Any,
    sigma: Array, tau: float, noise: Array, z0: Array, P0: Array, full: bool, gains: Array, scale: Array, white: Array,
    keep: bool, means: Array, covariances: Array, transitions: Array, predicted: Array,
) -> float:  # fmt: skip
    """One pass. measured (N, C), nan where missing; noise (C,) and sigma (NQ,) are variances of sensors and force.

    full: compute gains (N, C, n) and inverse innovation sd `scale` (N, C), 0 where missing or an outlier; otherwise
    reuse them. white (N, C) gets the whitened innovations. keep: store what the smoother needs. Returns log likelihood.
    """
    k, act, memory = np.zeros(K), np.zeros(HELD), np.zeros(MEMORY)
    constants(body, p, on, k)
    settle(commands[0], memory, p, on, act)
    z, P = z0.copy(), P0.copy()
    F, row, work, work2 = np.zeros((NZ, NZ)), np.zeros(NZ), np.zeros((2, NQ)), np.zeros((NZ, NZ))
    y, force, Ph = np.zeros(NY), np.zeros(NQ), np.zeros(NZ)
    likelihood, outliers = 0.0, np.zeros(measured.shape[1])
    if keep:
        means[0], covariances[0], predicted[0] = z, P, z
    for i in range(1, len(times)):
        h = times[i] - times[i - 1]
        decay = exp(-h / tau)
        for a in range(NY):
            y[a] = z[a]
        for a in range(NQ):
            force[a] = z[NY + a]
        predict(
            times[i - 1], h, max(1, int(np.ceil(h / max_step - 1e-9))), y, commands[i - 1], memory, p, on, k, force, act
        )
        if full:  # linearised about the state before, with the actuators of this interval
            transition(times[i - 1], h, z, act, p, on, k, decay, F, work)
            carry(F, P, work2)
            for j in range(NQ):
                P[NY + j, NY + j] += sigma[j] * (1.0 - decay * decay)
        for a in range(NY):
            z[a] = y[a]
        for a in range(NY, NZ):
            z[a] *= decay
        if keep:
            predicted[i], transitions[i] = z, F
        for c in range(measured.shape[1]):
            if np.isnan(measured[i, c]):
                scale[i, c] = white[i, c] = 0.0
                continue
            error = measured[i, c] - observe(z, codes[c], row)
            if full:
                scale[i, c] = weigh(P, row, noise[c], gains[i, c], Ph)
                likelihood += log(scale[i, c])
                far = abs(error) * scale[i, c] > GATE and outliers[c] < IN_A_ROW
                outliers[c] = outliers[c] + 1.0 if far else 0.0
                if far:
                    scale[i, c] = 0.0
            white[i, c] = error * scale[i, c]
            if scale[i, c] == 0.0:
                likelihood -= 0.5 * GATE * GATE
                continue
            likelihood -= 0.5 * white[i, c] ** 2
            for a in range(NZ):
                z[a] += gains[i, c, a] * error
            if full:
                for a in range(NZ):
                    for b in range(NZ):
                        P[a, b] -= gains[i, c, a] * Ph[b]
        if keep:
            means[i], covariances[i] = z, P
    return likelihood


@njit(error_model="numpy", cache=True)
def smooth(
    means: Array, covariances: Array, transitions: Array, predicted: Array, sigma: Array, times: Array, tau: float
) -> None:  # fmt: skip
    """Rauch-Tung-Striebel smoother, in place on means (N, n) and covariances (N, n, n)."""
    for i in range(len(times) - 2, -1, -1):
        F = transitions[i + 1]
        decay = exp(-(times[i + 1] - times[i]) / tau)
        ahead = F @ covariances[i] @ F.T
        for j in range(NQ):
            ahead[NY + j, NY + j] += sigma[j] * (1.0 - decay * decay)
        for j in range(NZ):
            ahead[j, j] *= 1.0 + 1e-9  # positions and rates are driven through the force alone: keep it invertible
            ahead[j, j] += 1e-18
        G = np.linalg.solve(ahead, F @ covariances[i]).T
        means[i] += G @ (means[i + 1] - predicted[i + 1])
        covariances[i] += G @ (covariances[i + 1] - ahead) @ G.T


@njit(error_model="numpy", cache=True)
def free_runs(
    times: Array, commands: Array, max_step: float, body: Array, p: Array, on: Any, starts: Any, ends: Any,
    states: Array, out: Array,
) -> None:  # fmt: skip
    """Free runs from row starts[j] to ends[j] out of states[j] (2 NQ,), driven by the commands alone.

    Actuator memory runs from the first row on, latent forces are zero. Fills out (runs, N, 2 NQ).
    """
    k, act, memory = np.zeros(K), np.zeros(HELD), np.zeros(MEMORY)
    constants(body, p, on, k)
    settle(commands[0], memory, p, on, act)
    nothing = np.zeros(NQ)
    saved = np.zeros((len(times), MEMORY))
    for i in range(len(times) - 1):
        saved[i] = memory
        h = times[i + 1] - times[i]
        n = max(1, int(np.ceil(h / max_step - 1e-9)))
        for _j in range(n):
            actuate(commands[i], memory, h / n, p, on, act)
    for run in range(len(starts)):
        y = states[run].copy()
        memory[:] = saved[starts[run]]
        out[run, starts[run]] = y
        for i in range(starts[run], ends[run]):
            h = times[i + 1] - times[i]
            predict(
                times[i], h, max(1, int(np.ceil(h / max_step - 1e-9))), y, commands[i], memory, p, on, k, nothing, act
            )
            out[run, i + 1] = y
