"""Operations on small dense matrices, in place.

Products are inlined where they are called: with a size n that is a constant there, the compiler
unrolls their loops.
"""

from math import sqrt

from boatsim.physics.kernel.compiling import lean, merged
from boatsim.physics.signals import Array

# Smallest share of a step over which the series of an exponential is taken; a matrix that needs a
# smaller one belongs to a model that has diverged.
SMALLEST = 2.0**-40


@lean
def copy_vector(source: Array, out: Array) -> None:
    """Fill a vector `out` with the first entries of another vector.

    An assignment of slices would take numba seconds to compile.
    """
    for i in range(len(out)):
        out[i] = source[i]


@lean
def copy_square_matrix(source: Array, out: Array, n: int) -> None:
    """Copy the upper left n by n part of a matrix to another matrix."""
    for i in range(n):
        for j in range(n):
            out[i, j] = source[i, j]


@merged
def multiply_matrices(A: Array, B: Array, out: Array, n: int) -> None:
    """Compute the matrix product out = A B of n by n matrices, skipping zeros of A.

    A has many zeros, so that this is faster than a library call.
    """
    for i in range(n):
        for j in range(n):
            out[i, j] = 0.0
        for k in range(n):
            x = A[i, k]
            if x != 0.0:
                for j in range(n):
                    out[i, j] += x * B[k, j]


@merged
def propagate_covariance(F: Array, P: Array, work: Array, n: int) -> None:
    """Compute the covariance P = F P F' of a linear transition F, symmetric, in place.

    The many zeros of F are skipped.
    """
    multiply_matrices(F, P, work, n)
    complete_propagation(F, work, P, n)


@merged
def complete_propagation(F: Array, work: Array, out: Array, n: int) -> None:
    """Compute the covariance out = F P F' from work = F P, which is transposed in place."""
    for i in range(n):
        for j in range(i):
            work[i, j], work[j, i] = work[j, i], work[i, j]
    multiply_matrices(F, work, out, n)
    for i in range(n):
        for j in range(i):
            out[j, i] = out[i, j]


@merged
def matrix_exponential(A: Array, h: float, F: Array, B: Array, n: int) -> None:
    """Compute the matrix exponential F = exp(A h) by scaling and squaring.

    A and B are overwritten. The series of third order is taken over a part of h that is small
    enough for stiff damping.
    """
    part, stiffest = h, 0.0
    for i in range(n):
        stiffest = max(stiffest, abs(A[i, i]))
    while part * stiffest > 1.0 and part > SMALLEST * h:
        part *= 0.5
    for i in range(n):
        for j in range(n):
            A[i, j] *= part
    multiply_matrices(A, A, B, n)
    multiply_matrices(B, A, F, n)
    for i in range(n):
        for j in range(n):
            F[i, j] = A[i, j] + 0.5 * B[i, j] + F[i, j] / 6.0
        F[i, i] += 1.0
    while part < 0.75 * h:
        multiply_matrices(F, F, B, n)
        copy_square_matrix(B, F, n)
        part *= 2.0


@merged
def cholesky_solve(A: Array, B: Array, n: int) -> None:
    """Compute B = A^-1 B for a symmetric positive definite matrix A.

    The upper triangle of A is replaced by its Cholesky factor. The inner loops run along rows,
    whose entries lie side by side.
    """
    for j in range(n):
        for k in range(j):
            x = A[k, j]
            for i in range(j, n):
                A[j, i] -= A[k, i] * x
        root = sqrt(max(A[j, j], 1e-300))
        for i in range(j, n):
            A[j, i] /= root
    for i in range(n):
        for k in range(i):
            x = A[k, i]
            for c in range(n):
                B[i, c] -= x * B[k, c]
        x = A[i, i]
        for c in range(n):
            B[i, c] /= x
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            x = A[i, k]
            for c in range(n):
                B[i, c] -= x * B[k, c]
        x = A[i, i]
        for c in range(n):
            B[i, c] /= x
