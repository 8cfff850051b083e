"""Small strictly convex quadratic programs, solved by a dual active-set method in compiled code.

D. Goldfarb, A. Idnani, A numerically stable dual method for solving strictly convex quadratic
programs, Mathematical Programming 27, 1983.
"""

from math import sqrt

import numpy as np

from boatsim.physics.base import Array
from boatsim.physics.kernel.compiling import compiled

# A constraint that is exceeded by less counts as met. Constraints have unit rows and the variables
# are of the order of 1, so that it is some hundred times the rounding error.
VIOLATION = 1e-11
# A direction that is shorter, relative to the normal of the constraint, counts as none: the normal
# depends linearly on those of the active constraints.
DEPENDENT = 1e-10
SOLVED, INFEASIBLE, NOT_CONVERGED = 0, 1, 2


@compiled
def dot(a: Array, b: Array) -> float:
    """Return the scalar product of two vectors; a loop compiles faster than operations on arrays.

    Args:
        a: Vector (n,).
        b: Vector (n,).
    """
    total = 0.0
    for k in range(len(a)):
        total += a[k] * b[k]
    return total


@compiled
def cholesky(matrix: Array) -> Array:
    """Return the lower Cholesky factor (n, n) of a positive definite matrix.

    Args:
        matrix: Symmetric positive definite matrix (n, n).
    """
    n = len(matrix)
    factor = np.zeros((n, n))
    for i in range(n):
        for j in range(i + 1):
            rest = matrix[i, j]
            for k in range(j):
                rest -= factor[i, k] * factor[j, k]
            if i == j:
                factor[i, i] = sqrt(rest)
            else:
                factor[i, j] = rest / factor[j, j]
    return factor


@compiled
def forward_substitution(factor: Array, right: Array) -> Array:
    """Return the solution y (n,) of L y = c for a lower triangular matrix L.

    Args:
        factor: Lower triangular matrix (n, n).
        right: Right-hand side (n,).
    """
    n = len(right)
    y = np.zeros(n)
    for i in range(n):
        rest = right[i]
        for k in range(i):
            rest -= factor[i, k] * y[k]
        y[i] = rest / factor[i, i]
    return y


@compiled
def back_substitution(factor: Array, right: Array) -> Array:
    """Return the solution x (n,) of L' x = y for a lower triangular matrix L.

    Args:
        factor: Lower triangular matrix (n, n).
        right: Right-hand side (n,).
    """
    n = len(right)
    x = np.zeros(n)
    for i in range(n - 1, -1, -1):
        rest = right[i]
        for k in range(i + 1, n):
            rest -= factor[k, i] * x[k]
        x[i] = rest / factor[i, i]
    return x


@compiled
def split_normal(active: Array, count: int, normal: Array) -> tuple[Array, Array]:
    """Split a vector into a combination of other vectors and the part orthogonal to them.

    It uses the modified Gram-Schmidt method with one repetition.

    Args:
        active: Linearly independent vectors, the first `count` rows of an array (m, n).
        count: Number of vectors.
        normal: Vector (n,).

    Returns:
        Coefficients (count,) of the combination, and the orthogonal part (n,).
    """
    n = len(normal)
    basis = np.zeros((count, n))
    upper = np.zeros((count, count))
    for j in range(count):
        for k in range(n):
            basis[j, k] = active[j, k]
        for _ in range(2):
            for i in range(j):
                share = 0.0
                for k in range(n):
                    share += basis[i, k] * basis[j, k]
                upper[i, j] += share
                for k in range(n):
                    basis[j, k] -= share * basis[i, k]
        length = 0.0
        for k in range(n):
            length += basis[j, k] * basis[j, k]
        upper[j, j] = sqrt(length)
        for k in range(n):
            basis[j, k] /= upper[j, j]
    rest = np.zeros(n)
    for k in range(n):
        rest[k] = normal[k]
    shares = np.zeros(count)
    for _ in range(2):
        for i in range(count):
            share = 0.0
            for k in range(n):
                share += basis[i, k] * rest[k]
            shares[i] += share
            for k in range(n):
                rest[k] -= share * basis[i, k]
    for i in range(count - 1, -1, -1):
        for j in range(i + 1, count):
            shares[i] -= upper[i, j] * shares[j]
        shares[i] /= upper[i, i]
    return shares, rest


@compiled
def solve_quadratic_program(
    hessian: Array, gradient: Array, rows: Array, bounds: Array
) -> tuple[Array, int]:
    """Return the minimum of 0.5 x' H x + g' x subject to A x <= b.

    The constraint that is violated most is made active in each iteration, and constraints whose
    multiplier would become negative are released. Intermediate points minimise the function subject
    to the active constraints, so that no feasible start is needed.

    Args:
        hessian: H, symmetric and positive definite (n, n).
        gradient: g (n,).
        rows: A (m, n), each row of unit length.
        bounds: b (m,).

    Returns:
        x (n,), and SOLVED, INFEASIBLE (no point meets all constraints) or NOT_CONVERGED.
    """
    n, m = len(gradient), len(bounds)
    factor = cholesky(hessian)
    # in y = L' x the Hessian is the identity
    y = forward_substitution(factor, gradient)
    for k in range(n):
        y[k] = -y[k]
    normals = np.zeros((m, n))
    for i in range(m):
        right = forward_substitution(factor, rows[i])
        for k in range(n):
            normals[i, k] = right[k]
    active = np.zeros((n + 1, n))
    members = np.zeros(n + 1, dtype=np.int64)
    multipliers = np.zeros(n + 1)
    is_active = np.zeros(m, dtype=np.bool_)
    count, status = 0, NOT_CONVERGED
    for _ in range(10 * (m + n)):  # usually about as many as constraints are active in the end
        x = back_substitution(factor, y)
        worst, at = VIOLATION, -1
        for i in range(m):
            excess = -bounds[i]
            for k in range(n):
                excess += rows[i, k] * x[k]
            if not is_active[i] and excess > worst:
                worst, at = excess, i
        if at < 0:
            status = SOLVED
            break
        normal = np.zeros(n)  # into the feasible side
        for k in range(n):
            normal[k] = -normals[at, k]
        length = sqrt(dot(normal, normal))
        own = 0.0  # multiplier of the new constraint
        added = False
        while not added:
            shares, direction = split_normal(active, count, normal)
            slope = dot(direction, normal)
            dual, drop = np.inf, -1
            for j in range(count):
                if shares[j] > 0.0 and multipliers[j] < dual * shares[j]:
                    dual, drop = multipliers[j] / shares[j], j
            if sqrt(dot(direction, direction)) > DEPENDENT * length:
                missing = bounds[at] + dot(normal, y)
                primal = max(-missing, 0.0) / slope
            else:
                primal = np.inf
            step = min(dual, primal)
            if step == np.inf:
                return back_substitution(factor, y), INFEASIBLE
            if primal < np.inf:
                for k in range(n):
                    y[k] += step * direction[k]
            for j in range(count):
                multipliers[j] -= step * shares[j]
            own += step
            if primal <= dual:
                for k in range(n):
                    active[count, k] = normal[k]
                members[count], multipliers[count] = at, own
                is_active[at] = True
                count += 1
                added = True
            else:
                is_active[members[drop]] = False
                for j in range(drop, count - 1):
                    for k in range(n):
                        active[j, k] = active[j + 1, k]
                    members[j], multipliers[j] = members[j + 1], multipliers[j + 1]
                count -= 1
    return back_substitution(factor, y), status
