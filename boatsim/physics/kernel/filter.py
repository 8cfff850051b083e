"""Extended Kalman filter and smoother, with a latent force per degree of freedom.

State z = (positions, earth-axes rates, body-axes latent forces), LASTING = 3 NQ entries. Where an
oscillating force acts, the force and its rate per axis follow; where instruments have slowly
varying errors, the error of each position follows. Measurements are taken one at a time, so that
any of them may be missing (nan).
"""

from math import cos, exp, sin, sqrt
from typing import Any

import numpy as np

from boatsim.physics.kernel.compiling import compiled, lean, merged
from boatsim.physics.kernel.correction import update_by_measurement
from boatsim.physics.kernel.matrices import (
    cholesky_solve,
    complete_propagation,
    copy_square_matrix,
    copy_vector,
    matrix_exponential,
    multiply_matrices,
    propagate_covariance,
)
from boatsim.physics.kernel.records import (
    FilterHistory,
    FilterPass,
    FilterWorkspace,
    InitialState,
    Inputs,
    LatentForce,
    LawArguments,
    Measurement,
    MeasurementResults,
    Measurements,
    PassArrays,
    PassOptions,
    ProcessNoise,
    SmootherWorkspace,
    StateEstimate,
    VesselNumbers,
    VesselState,
)
from boatsim.physics.signals import Array, InstrumentDrift, OscillatingForce

from .inertia import compute_mass_constants
from .laws import (
    HAS_ADVANCE_MOTION_MEMORY,
    HAS_INSTRUMENT_DRIFT,
    HAS_OSCILLATING_FORCE,
    HELD,
    MEMORY,
    apply_measurement_errors,
    has_measurement_errors,
    instrument_drift,
    motion_latency,
    oscillating_force,
)
from .motion import (
    DIFFERENCE,
    FREE,
    HULL_FIXED_AXES,
    NQ,
    SHOWS,
    K,
    acceleration_jacobian,
    acceleration_per_force,
    advance_memory_of_motion,
    expected_measurement_of_level_hull,
    pose_and_velocities,
    step_in_place,
)
from .run import SHORTEST, advance_actuators, minimum_substep, settle_actuators, substep_length

# As 64-bit integers: numba takes plain integers for types and would compile a function for each of
# their values.
NY, LASTING = np.int64(2 * NQ), np.int64(3 * NQ)
NZ = np.int64(
    LASTING + (2 * NQ if HAS_OSCILLATING_FORCE else 0) + (NQ if HAS_INSTRUMENT_DRIFT else 0)
)
# Integration step in time constants of the quickest motion: half of Runge-Kutta's limit of
# stability
STEADY = 1.4
# Shortest integration step as a share of an interval; a vessel that needs a shorter one has
# diverged
LEAST = 0.01
# Iterations that invert the errors of the instruments, which are always small
INVERT = 10


# Prediction
# ------------------------------------------------------------------------------------------------


@lean
def predict_motion(
    inputs: Inputs,
    i: int,
    delay: float,
    row: int,
    max_step: float,
    laws: LawArguments,
    plant: VesselState,
    moves: bool,
) -> tuple[int, np.int64]:
    """Integrate the vessel's motion from row i - 1 to row i of a recording, in place.

    The filter uses it for its prediction. Unless `moves` is true, only the actuators are advanced.
    The motion of row i happened `delay` before its time. `row` is the last row of
    commands used so far; returns the one used last, and the number of steps. No step extends
    beyond a change of an actuator's signal.
    """
    times, given, commands = inputs
    p, on, k = laws
    y, memory, act, force = plant
    h = times[i] - times[i - 1]
    longest = h / max(1, int(np.ceil(h / max_step - 1e-9)))
    begin, done, least, before = times[i - 1] - delay, 0.0, SHORTEST, 0.0
    steps = np.int64(0)
    while h - done > 1e-9:
        while row + 1 < len(given) and given[row + 1] <= begin + done + 1e-9:
            row += 1
        left = min(longest, h - done)
        dt = substep_length(commands[row], memory, left, least, p, on)
        least, before = minimum_substep(dt, before, least), dt
        if row + 1 < len(given):
            dt = min(dt, given[row + 1] - begin - done)
        advance_actuators(commands[row], memory, dt, p, on, act)
        if HAS_ADVANCE_MOTION_MEMORY:
            advance_memory_of_motion(begin + done, y, dt, memory, act, p, on)
        if moves:
            step_in_place(begin + done, y, dt, act, p, on, k, force)
        done += dt
        steps += 1
    return row, steps


@lean
def state_transition(
    t: float, h: float, z: Array, laws: LawArguments, plant: VesselState, work: FilterWorkspace
) -> float:
    """Compute the filter's transition matrix of motion and latent forces over a time h.

    Fills the matrix F of `work` and returns the decay rate of the quickest motion there [1/s].
    """
    A = work.A
    for i in range(LASTING):
        for j in range(LASTING):
            A[i, j] = 0.0
    for i in range(NQ):
        A[i, NQ + i] = 1.0
    acceleration_jacobian(t, z, plant.act, laws.p, laws.on, laws.k, plant.force, A[NQ:NY])
    acceleration_per_force(z, laws.k, A, np.int64(NQ), NY)
    rate, level = 0.0, 0.0
    for i in range(NQ):
        if FREE[i] < 2:  # both axes of a turned hull share the damping: their sum does not change
            level += abs(A[NQ + i, NQ + i])
        rate = max(rate, level, abs(A[NQ + i, NQ + i]))
    matrix_exponential(A, h, work.F, work.B, LASTING)
    return rate


@lean
def oscillator_transition(
    h: float, s: OscillatingForce
) -> tuple[float, float, float, float, float, float]:
    """Return the transition matrix of a random oscillating force over a time h.

    The last two of the six numbers are the mean force over h per unit of the two states at its
    begin. The force is the rate divided by the frequency, w s / (s^2 + 2 damping w s + w^2): waves
    have no energy at zero frequency.
    """
    w, damped = s.frequency, s.frequency * sqrt(1.0 - s.damping * s.damping)
    e, share = exp(-s.damping * w * h), s.damping * w / damped
    f11, f12 = e * (cos(damped * h) + share * sin(damped * h)), e * sin(damped * h) / damped
    f21, f22 = -w * w * f12, e * (cos(damped * h) - share * sin(damped * h))
    mean1, mean2 = (f11 - 1.0) / (w * h), f12 / (w * h)
    return f11, f12, f21, f22, mean1, mean2


@lean
def add_oscillators(h: float, s: OscillatingForce, F: Array) -> None:
    """Add the random oscillating forces to the filter's transition matrix F.

    Rows of the oscillators and their effect on the motion are added.
    """
    f11, f12, f21, f22, mean1, mean2 = oscillator_transition(h, s)
    for i in range(NZ):
        for j in range(LASTING, NZ):
            F[i, j] = F[j, i] = 0.0
    for j in range(NQ):
        a = LASTING + 2 * j
        for i in range(NY):
            F[i, a], F[i, a + 1] = F[i, NY + j] * mean1, F[i, NY + j] * mean2
        F[a, a], F[a, a + 1], F[a + 1, a], F[a + 1, a + 1] = f11, f12, f21, f22


@lean
def state_sizes(s: OscillatingForce, w: InstrumentDrift) -> tuple[Any, Any]:
    """Return how many entries of the filter's state are in use: without and with instrument drift.

    The first number counts motion, latent forces and oscillators, the second one also the slowly
    varying errors of instruments.
    """
    m = NZ if not HAS_INSTRUMENT_DRIFT else NZ - NQ
    if s.frequency == 0.0:
        m = LASTING
    return m, m + NQ if w.position > 0.0 or w.heading > 0.0 else m


@lean
def instrument_drift_rms(w: InstrumentDrift, j: int) -> float:
    """Return the rms of an instrument's slowly varying error of coordinate j of a state."""
    if FREE[j] < 2:
        return float(w.position)
    return float(w.heading) if FREE[j] == 5 else 0.0


@lean
def add_process_noise(h: float, noise: ProcessNoise, decay: float, P: Array, F: Array) -> None:
    """Add the process noise of a time h to the filter's covariance P.

    It is that of latent forces, which decay by the factor `decay`, oscillators, instrument errors
    and the noise of measured forces. The mean of the latter over h acts like a constant force, as
    in the transition matrix F.
    """
    s, w, m = noise.oscillating_force, noise.instrument_drift, noise.m
    for j in range(NQ):
        P[NY + j, NY + j] += noise.force.variances[j] * (1.0 - decay * decay)
    for j in range(NQ):
        if noise.force.white[j] > 0.0:
            variance = noise.force.white[j] / h
            for i in range(NY):
                for k in range(NY):
                    P[i, k] += F[i, NY + j] * F[k, NY + j] * variance
    for j in range(noise.n - m):
        kept = exp(-h / w.time)
        P[m + j, m + j] += instrument_drift_rms(w, j) ** 2 * (1.0 - kept * kept)
    if m > LASTING:
        f11, f12, f21, f22, _, _ = oscillator_transition(h, s)
        w2 = s.frequency * s.frequency
        for j in range(NQ):
            v, a = s[FREE[j]] ** 2, LASTING + 2 * j
            P[a, a] += v * (1.0 - f11 * f11 - w2 * f12 * f12)
            P[a + 1, a + 1] += v * (w2 - f21 * f21 - w2 * f22 * f22)
            cross = v * (f11 * f21 + w2 * f12 * f22)
            P[a, a + 1] -= cross
            P[a + 1, a] -= cross


@lean
def set_plant_from_state(z: Array, h: float, noise: ProcessNoise, plant: VesselState) -> None:
    """Set a vessel's motion to a filter state, and its extra force to the mean latent force.

    The mean is that over the next h seconds.
    """
    force = plant.force
    copy_vector(z, plant.y)
    for a in range(NQ):
        force[a] = z[NY + a]
    if noise.m > LASTING:
        _, _, _, _, mean1, mean2 = oscillator_transition(h, noise.oscillating_force)
        for a in range(NQ):
            force[a] += mean1 * z[LASTING + 2 * a] + mean2 * z[LASTING + 2 * a + 1]


@merged
def predict_covariance(
    h: float, noise: ProcessNoise, decay: float, P: Array, F: Array, work: Array, n: int
) -> None:
    """Predict the filter's covariance P over a time h, of the n entries of the state in use.

    The transition matrix F is extended from motion and latent forces, which decay by the factor
    `decay`, to the whole state.
    """
    m = noise.m
    for a in range(NY, LASTING):
        F[a, a] = decay
    if m > LASTING:
        add_oscillators(h, noise.oscillating_force, F)
    for j in range(m, n):
        for i in range(n):
            F[i, j] = F[j, i] = 0.0
        F[j, j] = exp(-h / noise.instrument_drift.time)
    propagate_covariance(F, P, work, n)
    add_process_noise(h, noise, decay, P, F)


@lean
def predict_mean(h: float, noise: ProcessNoise, decay: float, y: Array, z: Array) -> None:
    """Predict the mean of the filter's state over a time h, given the motion y at its end.

    Latent forces decay by the factor `decay`.
    """
    m = noise.m
    for a in range(NY):
        z[a] = y[a]
    for a in range(NY, LASTING):
        z[a] *= decay
    for a in range(m, noise.n):
        z[a] *= exp(-h / noise.instrument_drift.time)
    if m > LASTING:
        f11, f12, f21, f22, _, _ = oscillator_transition(h, noise.oscillating_force)
        for a in range(LASTING, m, 2):
            z[a], z[a + 1] = f11 * z[a] + f12 * z[a + 1], f21 * z[a] + f22 * z[a + 1]


@lean
def propagate_deviation(F: Array, z: Array, about: Array, y: Array) -> None:
    """Add to a predicted motion y the effect of a deviation of the initial state from `about`.

    F is the transition matrix and y the motion that follows from `about`.
    """
    for a in range(NY):
        for b in range(NY):
            y[a] += F[a, b] * (z[b] - about[b])


@lean
def predict_motion_and_transition(
    f: FilterPass, i: int, row: int, z: Array, max_step: float, steps: Array
) -> int:
    """Integrate the motion to row i of a recording and compute the transition matrix over it.

    The matrix is linearised about the state z at the begin. The integration steps are adapted to
    the quickest motion: those of the row before may be too long. Fills steps[i] and a first guess
    for the next row, and adds the number of steps to steps[0].
    """
    inputs, plant, times = f.inputs, f.plant, f.inputs.times
    h = times[i] - times[i - 1]
    if i == 1:
        steps[i] = max_step
    copy_vector(plant.memory, f.work.memory)
    last, count = predict_motion(inputs, i, f.delay, row, steps[i], f.laws, plant, True)
    steps[0] += count
    rate = state_transition(times[i - 1] - f.delay, h, z, f.laws, plant, f.work)
    longest = max(min(max_step, STEADY / max(rate, 1e-9)), LEAST * h)
    if longest < 0.5 * steps[i]:
        steps[i] = longest
        set_plant_from_state(z, h, f.noise, plant)
        copy_vector(f.work.memory, plant.memory)
        last, count = predict_motion(inputs, i, f.delay, row, longest, f.laws, plant, True)
        steps[0] += count
    if i + 1 < len(times):
        steps[i + 1] = longest
    return last


# Measurements
# ------------------------------------------------------------------------------------------------


@lean
def predicted_measurement(y: Array, t: float, code: int, p: Array, on: Any) -> float:
    """Return the value that a recording shows of one channel for a given motion y (2 NQ,).

    It includes measurement errors, t after the first row.
    """
    return float(apply_measurement_errors(pose_and_velocities(y), t, p, on)[SHOWS[code]])


@lean
def compute_measurement_jacobian(
    z: Array, t: float, codes: Any, H: Array, p: Array, on: Any
) -> None:
    """Fill H (C, 2 NQ) with finite-difference derivatives of measured channels by the motion z.

    Nothing is done if the derivatives of all channels are known in closed form.
    """
    if not HULL_FIXED_AXES and not has_measurement_errors(on):
        return
    seen = apply_measurement_errors(pose_and_velocities(z), t, p, on)
    for c in range(len(codes)):
        H[c, 0] = seen[SHOWS[codes[c]]]
    # The first column is written last: until then it holds the values at z itself.
    for j in range(NY - 1, -1, -1):
        here = z[j]
        z[j] = here + DIFFERENCE
        displaced = apply_measurement_errors(pose_and_velocities(z), t, p, on)
        for c in range(len(codes)):
            H[c, j] = (displaced[SHOWS[codes[c]]] - H[c, 0]) / DIFFERENCE
        z[j] = here


@lean
def expected_measurement(
    z: Array, t: float, code: int, slope: Array, row: Array, p: Array, on: Any
) -> float:
    """Return the expected value of one measured channel and fill its row of the measurement matrix.

    The row has n entries. `slope` is its row by `compute_measurement_jacobian`, where that filled
    it.
    """
    if not HULL_FIXED_AXES and not has_measurement_errors(on):
        for j in range(NZ):
            row[j] = 0.0
        return expected_measurement_of_level_hull(z, code, row)
    copy_vector(slope, row[:NY])
    return predicted_measurement(z, t, code, p, on)


@compiled
def remove_position_errors(z: Array, t: float, p: Array, on: Any) -> None:
    """Replace recorded positions by the true ones, inverting the measurement errors, in place.

    They were recorded t after the first row.
    """
    if has_measurement_errors(on):
        positions, y = np.zeros(NQ), np.zeros(NY)
        copy_vector(z, positions)
        copy_vector(z, y)
        for _ in range(INVERT):
            for j in range(NQ):
                z[j] += positions[j] - predicted_measurement(y, t, j, p, on)
            copy_vector(z, y)


@lean
def update_by_row(
    f: FilterPass,
    estimate: StateEstimate,
    measured: Measurements,
    i: int,
    gains: bool,
    out: PassArrays,
) -> float:
    """Update the filter's state by all measurements in row i of a recording.

    The covariance is updated if `gains` is true. Returns the log likelihood of the row.
    """
    likelihood, z, codes = 0.0, estimate.z, measured.codes
    p, on, m, work = f.laws.p, f.laws.on, f.noise.m, f.work
    values, scale, white = measured.values[i], out.scale[i], out.whitened[i]
    t = f.inputs.times[i] - f.inputs.times[0]
    if gains:
        compute_measurement_jacobian(z, t, codes, work.H, p, on)
    for c in range(len(values)):
        if np.isnan(values[c]):
            scale[c] = white[c] = 0.0
            continue
        error = values[c] - expected_measurement(z, t, codes[c], work.H[c], work.row, p, on)
        own = np.int64(-1)
        if estimate.n > m and codes[c] < NQ:
            own = m + codes[c]
            error -= z[own]
        one = Measurement(error, work.row, measured.variances[c], NY, own)
        channel = MeasurementResults(work.outliers[c:], out.gains[i, c], scale[c:], white[c:])
        likelihood += update_by_measurement(one, estimate, gains, channel, work.Ph)
    return likelihood


# Filter and smoother
# ------------------------------------------------------------------------------------------------


@lean
def initialise_filter(start: InitialState, noise: ProcessNoise, estimate: StateEstimate) -> None:
    """Set the filter's mean and covariance at the first row, with oscillators at any phase."""
    s, w, m, z, P = noise.oscillating_force, noise.instrument_drift, noise.m, estimate.z, estimate.P
    for a in range(LASTING):
        z[a] = start.mean[a]
    copy_square_matrix(start.covariance, P, LASTING)
    # The first position has an error of the instrument: the vessel is off by as much in the other
    # direction.
    for j in range(noise.n - m):
        variance = instrument_drift_rms(w, j) ** 2
        P[m + j, m + j] = variance
        P[j, j] += variance
        P[j, m + j] = P[m + j, j] = -variance
    if m > LASTING:
        for j in range(NQ):
            P[LASTING + 2 * j, LASTING + 2 * j] = s[FREE[j]] ** 2
            P[LASTING + 2 * j + 1, LASTING + 2 * j + 1] = (s.frequency * s[FREE[j]]) ** 2


@compiled
def kalman_filter(
    inputs: Inputs,
    measured: Measurements,
    model: VesselNumbers,
    force: LatentForce,
    start: InitialState,
    options: PassOptions,
    out: PassArrays,
    history: FilterHistory,
) -> float:
    """Run the extended Kalman filter once over a recording; return its log likelihood.

    Fills `out` and, on demand, `history`.
    """
    body, p, on = model
    k, act, memory = np.zeros(K), np.zeros(3 * HELD), np.zeros(MEMORY)
    compute_mass_constants(body, p, on, k)
    settle_actuators(inputs.commands[0], memory, p, on, act)
    s, w, delay = oscillating_force(p, on), instrument_drift(p, on), motion_latency(p, on)
    m, n = state_sizes(s, w)
    noise, estimate = (
        ProcessNoise(force, s, w, m, n),
        StateEstimate(np.zeros(NZ), np.zeros((NZ, NZ)), n),
    )
    plant = VesselState(np.zeros(NY), memory, act, np.zeros(NQ))
    square, channels = (NZ, NZ), len(measured.codes)
    work = FilterWorkspace(
        np.zeros(square),
        np.zeros(square),
        np.zeros(square),
        np.zeros(NZ),
        np.zeros(NZ),
        np.zeros((channels, NY)),
        np.zeros(channels),
        np.zeros(MEMORY),
    )
    f = FilterPass(inputs, LawArguments(p, on, k), delay, noise, plant, work)
    z, P, F, y, times = estimate.z, estimate.P, work.F, plant.y, inputs.times
    about = np.zeros(NZ)
    initialise_filter(start, noise, estimate)
    remove_position_errors(z, 0.0, p, on)
    if options.gains and options.linearise:
        out.steps[0] = 0.0
    likelihood, last = 0.0, np.int64(0)  # with a plain 0 `predict_motion` would be compiled twice
    if options.history:
        copy_vector(z, history.means[0])
        copy_vector(z, history.predicted[0])
        copy_square_matrix(P, history.covariances[0], n)
    for i in range(1, len(times)):
        h = times[i] - times[i - 1]
        decay = exp(-h / force.time_constant)
        copy_vector(z, about)
        if i == 1:
            copy_vector(start.rates, about[NQ:NY])
        set_plant_from_state(about, h, noise, plant)
        if options.gains and options.linearise:
            last = predict_motion_and_transition(f, i, last, about, options.max_step, out.steps)
            copy_square_matrix(F, out.transitions[i], LASTING)
        else:
            last, _ = predict_motion(inputs, i, delay, last, out.steps[i], f.laws, plant, True)
            if options.gains or i == 1:
                copy_square_matrix(out.transitions[i], F, LASTING)
        if i == 1:
            propagate_deviation(F, z, about, y)
        if options.gains:
            if n == LASTING:  # the loops of the usual size are unrolled
                predict_covariance(h, noise, decay, P, F, work.B, LASTING)
            else:
                predict_covariance(h, noise, decay, P, F, work.B, n)
        predict_mean(h, noise, decay, y, z)
        if options.history:
            copy_vector(z, history.predicted[i])
            copy_square_matrix(F, history.transitions[i], n)
        likelihood += update_by_row(f, estimate, measured, i, options.gains, out)
        if options.history:
            copy_vector(z, history.means[i])
            copy_square_matrix(P, history.covariances[i], n)
    return likelihood


@merged
def smooth_row(
    i: int,
    history: FilterHistory,
    gains: Array,
    h: float,
    noise: ProcessNoise,
    work: SmootherWorkspace,
    n: int,
) -> None:
    """Smooth the mean and the covariance of row i, h before the next row, which is smooth already.

    Fills the gains of the row. The n entries of the state that are in use are smoothed.
    """
    means, covariances, transitions, predicted = history
    ahead, cross, G, B, off = work
    F = transitions[i + 1]
    multiply_matrices(F, covariances[i], cross, n)  # F P
    copy_square_matrix(cross, B, n)
    complete_propagation(F, B, ahead, n)
    add_process_noise(h, noise, exp(-h / noise.force.time_constant), ahead, F)
    # Positions and rates are driven by the force alone: this keeps the matrix invertible.
    for j in range(n):
        ahead[j, j] *= 1.0 + 1e-9
        ahead[j, j] += 1e-18
    copy_square_matrix(ahead, B, n)
    cholesky_solve(B, cross, n)
    for j in range(n):
        off[j] = means[i + 1, j] - predicted[i + 1, j]
        for k in range(n):
            G[j, k] = gains[i, j, k] = cross[k, j]
            ahead[j, k] = covariances[i + 1, j, k] - ahead[j, k]
    propagate_covariance(G, ahead, B, n)
    for j in range(n):
        for k in range(n):
            means[i, j] += G[j, k] * off[k]
            covariances[i, j, k] += ahead[j, k]


@compiled
def smooth_states(
    history: FilterHistory, gains: Array, times: Array, force: LatentForce, p: Array, on: Any
) -> None:
    """Smooth the filtered means and covariances of a recording in place (Rauch, Tung, Striebel).

    Fills the smoother gains (N, n, n) of the n entries of the state in use.
    """
    s, w = oscillating_force(p, on), instrument_drift(p, on)
    m, n = state_sizes(s, w)
    noise = ProcessNoise(force, s, w, m, n)
    square = (NZ, NZ)
    work = SmootherWorkspace(
        np.zeros(square), np.zeros(square), np.zeros(square), np.zeros(square), np.zeros(NZ)
    )
    for i in range(len(times) - 2, -1, -1):
        h = times[i + 1] - times[i]
        if n == LASTING:  # the loops of the usual size are unrolled
            smooth_row(i, history, gains, h, noise, work, LASTING)
        else:
            smooth_row(i, history, gains, h, noise, work, n)


@compiled
def simulate_intervals(
    inputs: Inputs,
    max_step: float,
    model: VesselNumbers,
    starts: Any,
    ends: Any,
    states: Array,
    out: Array,
) -> float:
    """Simulate intervals of a recording from given states, under the recorded commands.

    Run j extends from row starts[j] to row ends[j] and begins at states[j] (2 NQ,). The actuators
    are simulated from the first row on, latent forces are zero. Fills out (runs, N, 2 NQ) with
    every channel as the recording would show it. States of all rows of the recording may follow
    those of the runs: from them effects remember the motion before a run; else it is rest.
    Returns the number of integration steps.
    """
    times, (body, p, on) = inputs.times, model
    k, act, memory = np.zeros(K), np.zeros(3 * HELD), np.zeros(MEMORY)
    compute_mass_constants(body, p, on, k)
    settle_actuators(inputs.commands[0], memory, p, on, act)
    y, delay, at_start = np.zeros(NY), motion_latency(p, on), np.zeros(MEMORY)
    laws, plant = LawArguments(p, on, k), VesselState(y, memory, act, np.zeros(NQ))
    path = np.int64(len(starts))  # index of the state of the first row
    moves = HAS_ADVANCE_MOTION_MEMORY and len(states) > path
    # `memory` is that of row `known`, at which the last row of commands used so far is `last`
    known, last, total = np.int64(0), np.int64(0), 0.0
    for run in range(len(starts)):
        start, end = starts[run], ends[run]
        if start < known:
            for j in range(MEMORY):
                memory[j] = 0.0
            settle_actuators(inputs.commands[0], memory, p, on, act)
            known, last = np.int64(0), np.int64(0)
        for i in range(known + 1, start + 1):
            for j in range(NY):
                y[j] = states[path + i - 1, j] if moves else 0.0
            last, steps = predict_motion(inputs, i, delay, last, max_step, laws, plant, moves)
            total += steps
        copy_vector(memory, at_start)
        known, last_at_start = start, last
        copy_vector(states[run], y)
        for i in range(start, end + 1):
            if i > start:
                last, steps = predict_motion(inputs, i, delay, last, max_step, laws, plant, True)
                total += steps
            for code in range(NY):
                t = times[i] - times[0]
                out[run, i, code] = predicted_measurement(y, t, code, p, on)
        # After the run the actuators are where they would be without it; other memory is not.
        if HAS_ADVANCE_MOTION_MEMORY or (run + 1 < len(starts) and starts[run + 1] < end):
            copy_vector(at_start, memory)
            last = last_at_start
        else:
            known = end
    return total
