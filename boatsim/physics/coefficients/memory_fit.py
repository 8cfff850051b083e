"""Identification of a passive state-space model of the memory of the radiation force.

Cummins' equation has the radiation force -A_inf nu' - integral k(t - s) nu(s) ds. The response of
its memory is K(j w) = B(w) + j w (A(w) - A_inf) (T. F. Ogilvie, 5th Symposium on Naval
Hydrodynamics, 1964). The model is a sum of sections of second order,

K(s) = sum_k (s M_k + N_k) / (s^2 + a_k s + b_k),  a_k, b_k > 0,  sum_k N_k / b_k = 0,

with symmetric matrices M_k and N_k, so that it is 0 at the frequency 0 and falls as 1 / s, as K
does (T. Perez and T. I. Fossen, Modeling, Identification and Control 29(1), 2008). The poles are
found by separable least squares, in which the matrices are linear. It is passive if the real part
of K(j w) is positive semidefinite at all frequencies; this is a linear constraint of the matrices
for each frequency and direction at which it is violated (B. Gustavsen and A. Semlyen, IEEE
Transactions on Power Systems 16(1), 2001). A hull that is symmetric to port and starboard has two
independent sets of axes.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares, nnls

from boatsim.physics.signals import Array

# Places of the axes that a symmetric hull couples: surge, heave, pitch and sway, roll, yaw
SETS = ((0, 2, 4), (1, 3, 5))
UPPER = np.triu_indices(3)  # entries of a symmetric matrix, in the order of the sections
TWICE = np.where(UPPER[0] == UPPER[1], 1.0, np.sqrt(2.0))  # weights of the entries in its norm
# Axes whose response, in the scale of the largest of its set, is smaller have no memory: their
# values are errors of the panels
LEAST = 1e-4
GOOD = 0.01  # rms error of the model over the rms of K at which no section is added
MOST_SECTIONS = 7  # of a set of axes; each adds two states to each axis
GAIN = 0.15  # an additional section is kept if it reduces the error by this share
SOFT = 1e-4  # weight of small matrices relative to the error, which keeps poles from cancelling
MOST_EVALUATIONS = 200  # of the poles of a model; it converges in some 30
# Passivity is enforced on a grid from a fraction to a multiple of the frequencies of the data, with
# a margin [-] of K scaled to 1 that covers what lies between its points
BELOW, BEYOND, GRID, MARGIN = 0.05, 300.0, 600, 2e-4
FINER = 8  # points of the last check for each point of the grid
PEAK = 25  # further points about the frequency of each section
ROUNDS = 30  # of enforcement
ASYMPTOTE_SECTIONS = 4  # of the model by which an unknown A_inf is extrapolated


@dataclass(frozen=True)
class MemoryModel:
    """State-space model of the memory of the radiation force.

    Attributes:
        sections: One array (S, 14) for each of `SETS`: b [1/s^2], a [1/s], then the upper triangles
            of M and N, in SI units of the forces per velocity, times 1/s and 1/s^2.
        error: Rms error of each set over the rms of its K, both scaled by axis [-].
    """

    sections: tuple[Array, Array]
    error: tuple[float, float]

    @property
    def states(self) -> int:
        """Number of states: two for each section and axis."""
        return 6 * sum(map(len, self.sections))

    def response(self, frequency: Array) -> Array:
        """Return K(j w) of the model.

        Args:
            frequency: Angular frequencies (N,) [rad/s].

        Returns:
            Complex matrices (N, 6, 6) [N s/m, N s, N m s].
        """
        s = 1j * np.asarray(frequency, dtype=float)
        found = np.zeros((len(s), 6, 6), dtype=complex)
        for axes, sections in zip(SETS, self.sections, strict=True):
            for one in sections:
                below = s * s + one[1] * s + one[0]
                total = np.outer(s / below, one[2:8]) + np.outer(1.0 / below, one[8:])
                for value, i, j in zip(total.T, *UPPER, strict=True):
                    found[:, axes[i], axes[j]] += value
                    if i != j:
                        found[:, axes[j], axes[i]] += value
        return found


def memory_response(
    frequency: Array, added_mass: Array, damping: Array, infinite_added_mass: Array
) -> Array:
    """Return the frequency response K(j w) of the memory of the radiation force.

    Args:
        frequency: Angular frequencies (N,) [rad/s].
        added_mass: A (N, 6, 6) [kg, kg m, kg m^2].
        damping: B (N, 6, 6) [N s/m, N s, N m s].
        infinite_added_mass: A at infinite frequency (6, 6).

    Returns:
        Complex matrices (N, 6, 6), symmetric.
    """
    w = np.asarray(frequency)[:, None, None]
    response = damping + 1j * w * (added_mass - infinite_added_mass)
    return np.asarray(0.5 * (response + np.swapaxes(response, 1, 2)))


def estimated_infinite_added_mass(frequency: Array, added_mass: Array, damping: Array) -> Array:
    """Return the added mass at infinite frequency that a model of finite frequencies leads to.

    B(w) + j w A(w) = K(j w) + j w A_inf is fitted with A_inf as a further unknown. It agrees with
    the data at the given frequencies; its own error is that of an extrapolation.

    Args:
        frequency: Angular frequencies (N,) [rad/s], increasing.
        added_mass: A (N, 6, 6) [kg, kg m, kg m^2].
        damping: B (N, 6, 6) [N s/m, N s, N m s].
    """
    response = memory_response(frequency, added_mass, damping, np.zeros((6, 6)))
    found = np.zeros((6, 6))
    for axes in SETS:
        place = np.ix_(range(len(frequency)), axes, axes)
        size = np.sqrt(np.abs(np.einsum("nii->ni", response[place])).max(axis=0))
        size[size == 0.0] = 1.0
        entries = (response[place] / (size[:, None] * size))[:, UPPER[0], UPPER[1]] * TWICE
        target = np.concatenate([entries.real, entries.imag])
        damping_, stiffness = _fitted_poles(frequency, entries, ASYMPTOTE_SECTIONS, True)
        rows = _regressors(damping_, stiffness, frequency, True)
        mass = _soft_solution(rows, target)[0][-1:] / TWICE
        found[np.ix_(axes, axes)] = _symmetric(mass)[0] * (size[:, None] * size)
    return found


def fit_memory(frequency: Array, response: Array) -> MemoryModel:
    """Fit a passive state-space model to the memory of the radiation force.

    The number of sections grows until the error is below `GOOD`, or no further one helps.

    Args:
        frequency: Angular frequencies (N,) [rad/s], increasing.
        response: K(j w) (N, 6, 6), from `memory_response`.
    """
    sections: list[Array] = []
    errors: list[float] = []
    for axes in SETS:
        own = response[:, axes, :][:, :, axes]
        found, error = _fit_set(np.asarray(frequency, dtype=float), own)
        sections.append(found)
        errors.append(error)
    return MemoryModel((sections[0], sections[1]), (errors[0], errors[1]))


def _fit_set(frequency: Array, response: Array) -> tuple[Array, float]:
    """Fit the sections of one set of axes (S, 14); return them and the relative rms error."""
    size = np.abs(np.einsum("nii->ni", response)).max(axis=0)
    active = size > LEAST * size.max(initial=0.0)
    if not active.any():
        return np.zeros((0, 14)), 0.0
    scale = np.sqrt(np.where(active, size, 1.0))
    data = response / (scale[:, None] * scale)
    data[:, ~active, :] = 0.0
    data[:, :, ~active] = 0.0
    entries = data[:, UPPER[0], UPPER[1]] * TWICE
    best, best_error = np.zeros((0, 14)), 1.0
    for count in range(1, MOST_SECTIONS + 1):
        found, error = _fit_sections(frequency, entries, count)
        if error < best_error * (1.0 - GAIN):
            best, best_error = found, error
        if best_error < GOOD:
            break
    units = (scale[:, None] * scale)[UPPER]
    best[:, 2:8] *= units
    best[:, 8:] *= units
    return best, best_error


def _fit_sections(frequency: Array, entries: Array, count: int) -> tuple[Array, float]:
    """Fit a number of sections to scaled entries (N, 6); return them (count, 14), and the error."""
    target = np.concatenate([entries.real, entries.imag])
    damping, stiffness = _fitted_poles(frequency, entries, count)
    rows = _regressors(damping, stiffness, frequency)
    free, _ = _soft_solution(rows, target)
    matrices = _passive_matrices(damping, stiffness, frequency, rows, free)
    error = np.linalg.norm(rows @ matrices - target) / np.linalg.norm(target)
    rate = matrices[:count] / TWICE
    level = np.zeros((count, 6))
    # the matrices N of all sections but the last are free; the sum of N / b is zero
    level[:-1] = matrices[count:] * stiffness[:-1, None] / TWICE
    level[-1] = -np.sum(matrices[count:], axis=0) * stiffness[-1] / TWICE
    return np.column_stack([stiffness, damping, rate, level]), float(error)


def _fitted_poles(
    frequency: Array, entries: Array, count: int, mass: bool = False
) -> tuple[Array, Array]:
    """Fit the poles of a number of sections to scaled entries (N, 6); return all a and all b.

    With `mass` the entries contain an unknown added mass in addition.
    """
    energy = np.maximum(entries[:, [0, 3, 5]].real.sum(axis=1), 0.0)
    share = np.cumsum(energy) / np.sum(energy)
    middle = np.interp((np.arange(count) + 0.5) / count, share, frequency)
    # a and b of all sections in logarithms, within generous bounds
    begin = np.log(np.concatenate([0.7 * middle, middle**2]))
    first, last = frequency[0], frequency[-1]
    low = np.log(np.repeat([0.02 * first, (0.5 * first) ** 2], count))
    high = np.log(np.repeat([6.0 * last, (3.0 * last) ** 2], count))
    begin = np.clip(begin, low + 1e-6, high - 1e-6)
    target = np.concatenate([entries.real, entries.imag])

    def residual(poles: Array) -> Array:
        rows = _regressors(np.exp(poles[:count]), np.exp(poles[count:]), frequency, mass)
        return _soft_solution(rows, target)[1].ravel()

    found = least_squares(residual, begin, bounds=(low, high), max_nfev=MOST_EVALUATIONS)
    return np.exp(found.x[:count]), np.exp(found.x[count:])


def _responses(damping: Array, stiffness: Array, frequency: Array) -> Array:
    """Return the responses (N, 2 count - 1) of the free entries of all sections."""
    s = 1j * frequency[:, None]
    below = s * s + damping * s + stiffness
    level = stiffness / below
    return np.concatenate([s / below, level[:, :-1] - level[:, -1:]], axis=1)


def _regressors(damping: Array, stiffness: Array, frequency: Array, mass: bool = False) -> Array:
    """Return real and imaginary parts of the responses as rows (2 N, 2 count - 1).

    With `mass` a last column is added, of an added mass.
    """
    complex_rows = _responses(damping, stiffness, frequency)
    if mass:
        complex_rows = np.column_stack([complex_rows, 1j * frequency])
    return np.concatenate([complex_rows.real, complex_rows.imag])


def _soft_solution(rows: Array, target: Array) -> tuple[Array, Array]:
    """Return the least-squares solution with a small weight of its own size, and the residual."""
    size = np.linalg.norm(rows, axis=0)
    soft = np.concatenate([rows / size, SOFT * np.eye(len(size))])
    wanted = np.concatenate([target, np.zeros((len(size), target.shape[1]))])
    solution = np.linalg.lstsq(soft, wanted, rcond=None)[0]
    return solution / size[:, None], soft @ solution - wanted


def _passive_matrices(
    damping: Array, stiffness: Array, frequency: Array, rows: Array, free: Array
) -> Array:
    """Return the entries (2 count - 1, 6) nearest to the free fit of which the sum is passive."""
    first, last = BELOW * frequency[0], BEYOND * frequency[-1]
    peaks = np.sqrt(stiffness) + damping * np.linspace(-3.0, 3.0, PEAK)[:, None]
    grid = np.geomspace(first, last, GRID)
    grid = np.sort(np.append(grid, peaks[(first < peaks) & (peaks < last)]))
    real = _responses(damping, stiffness, grid).real
    middle = np.sqrt(stiffness.mean())
    # it has the order of the real part of a section at low and at high frequency
    margin = MARGIN * (grid * middle) ** 2 / (grid * grid + middle * middle) ** 2
    size = np.linalg.norm(rows, axis=0)
    factor = np.linalg.qr(np.concatenate([rows / size, SOFT * np.eye(len(size))]), mode="r")
    inverse = np.linalg.inv(factor) / size[:, None]  # (p, p) of entries by whitened changes
    found, constraints, limits = free, [], []
    for _ in range(ROUNDS):
        values, vectors = np.linalg.eigh(_symmetric(real @ (found / TWICE)))
        bad = np.argwhere(values < margin[:, None] * 0.5)
        if not len(bad):
            break
        for i, k in bad:
            direction = np.outer(vectors[i, :, k], vectors[i, :, k])[UPPER] * TWICE
            row = np.outer(real[i], direction)
            weight = 1.0 / margin[i]
            constraints.append(weight * (inverse.T @ row).ravel())
            limits.append(weight * (margin[i] - np.sum(row * free)))
        change = _least_distance(np.array(constraints), np.array(limits))
        found = free + inverse @ change.reshape(free.shape)
    # what is left of a violation is covered by a larger M of the section with most damping, whose
    # real part is positive at all frequencies
    broad = int(np.argmax(damping))
    grid = np.geomspace(first, last, FINER * GRID)
    real = _responses(damping, stiffness, grid).real
    margin = 0.1 * MARGIN * (grid * middle) ** 2 / (grid * grid + middle * middle) ** 2
    lowest = np.linalg.eigvalsh(_symmetric(real @ (found / TWICE)))[:, 0] - margin
    found = found.copy()
    found[broad, [0, 3, 5]] += max(0.0, float(np.max(-lowest / real[:, broad])))
    return found


def _least_distance(constraints: Array, limits: Array) -> Array:
    """Return the shortest x with constraints @ x >= limits.

    C. L. Lawson and R. J. Hanson, Solving Least Squares Problems, 1974, chapter 23.
    """
    rows = np.vstack([constraints.T, limits])
    goal = np.zeros(len(rows))
    goal[-1] = 1.0
    weights, _ = nnls(rows, goal, maxiter=50 * rows.shape[1])
    rest = rows @ weights - goal
    return np.asarray(-rest[:-1] / rest[-1])


def _symmetric(entries: Array) -> Array:
    """Return symmetric matrices (N, 3, 3) of upper triangles (N, 6)."""
    found = np.zeros((len(entries), 3, 3))
    found[:, UPPER[0], UPPER[1]] = entries
    found[:, UPPER[1], UPPER[0]] = entries
    return found


def lowest_damping(model: MemoryModel, frequency: Array) -> float:
    """Return the least eigenvalue of the damping of a model, each axis scaled by its largest one.

    The model is passive if it is not negative at any frequency.

    Args:
        model: The model.
        frequency: Angular frequencies (N,) [rad/s].
    """
    real = model.response(frequency).real
    size = np.sqrt(np.einsum("nii->ni", real).max(axis=0))
    size[size == 0.0] = 1.0
    return float(np.linalg.eigvalsh(real / (size[:, None] * size)).min())
