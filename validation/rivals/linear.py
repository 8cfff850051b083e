"""Linearised errors of windows, with the influence of each window's start projected out."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol, TypeVar

import numpy as np
from scipy.optimize import lsq_linear

from boatsim.physics.base import Array

RIDGE = 1e-5  # relative to a column's norm; keeps undetermined parameters unchanged
LEAST_GAIN = 1e-3  # smallest relative decrease of the sum of squares for a further step


class Squared(Protocol):
    """A fit with a sum of squares."""

    @property
    def square(self) -> float:
        """Weighted sum of squares, including the prior."""


S = TypeVar("S", bound=Squared)


def no_columns() -> Array:
    """Return an empty matrix of columns."""
    return np.zeros((0, 0))


@dataclass(frozen=True)
class LinearisedErrors:
    """Weighted errors (R,) of all windows as one vector, and their derivatives."""

    weights: Array  # (C,)
    masks: tuple[Array, ...]  # (M C,) of each window, where values were recorded
    bases: tuple[Array, ...]  # (M C, 2 NQ) orthonormal basis of the start's influence
    triangles: tuple[Array, ...]  # (2 NQ, 2 NQ): derivatives by the start = basis @ triangle
    errors: Array  # (R,)
    raw: Array = field(default_factory=no_columns)  # (R, F) by the parameters, starts held
    # (R + N,) errors with the starts projected out, then those of the prior
    rest: Array = field(default_factory=no_columns)
    columns: Array = field(default_factory=no_columns)  # (R + N, F) derivatives, projected likewise

    @classmethod
    def of(
        cls, errors: Sequence[Array], weights: Array, by_starts: Sequence[Array]
    ) -> "LinearisedErrors":
        """Build from errors (M, C) and derivatives (M, C, 2 NQ) by the starts, by window."""
        masks = tuple(np.isfinite(e).ravel() for e in errors)
        bases, triangles = [], []
        for slope, mask in zip(by_starts, masks, strict=True):
            flat = (
                np.nan_to_num((slope * weights[:, None]).reshape(-1, slope.shape[2]))
                * mask[:, None]
            )
            basis, triangle = np.linalg.qr(flat)
            bases.append(basis)
            triangles.append(triangle)
        return cls(weights, masks, tuple(bases), tuple(triangles), np.zeros(0)).about(errors)

    def about(self, errors: Sequence[Array]) -> "LinearisedErrors":
        """Return the same linearisation about other errors."""
        return replace(self, errors=self.flat(errors))

    def flat(self, errors: Sequence[Array]) -> Array:
        """Return errors (M, C) of all windows, weighted, as one vector; missing values are 0."""
        rows = []
        for e, m in zip(errors, self.masks, strict=True):
            rows.append(np.nan_to_num((e * self.weights).ravel()) * m)
        return np.concatenate(rows)

    def projected(self, rows: Array) -> Array:
        """Return rows (R, ...) with the influence of the windows' starts projected out."""
        return np.concatenate(
            [part - q @ (q.T @ part) for part, q in zip(self.cut(rows), self.bases, strict=True)]
        )

    def cut(self, rows: Array) -> list[Array]:
        """Split rows by window."""
        return np.split(rows, np.cumsum([len(m) for m in self.masks])[:-1])

    def with_columns(
        self, columns: Sequence[Array], prior: tuple[Array, Array]
    ) -> "LinearisedErrors":
        """Add columns (R,) of parameters, and rows (N, F) and errors (N,) of their prior."""
        raw = np.column_stack(columns) if columns else np.zeros((len(self.errors), 0))
        rest = np.concatenate([self.projected(self.errors), prior[1]])
        return replace(self, raw=raw, rest=rest, columns=np.vstack([self.projected(raw), prior[0]]))

    def by_window(self, move: Array) -> list[Array]:
        """Return the shift (2 NQ,) of each window's start for a step (F,) of the parameters."""
        left = self.cut(self.errors + self.raw @ move)
        pairs = zip(self.bases, self.triangles, left, strict=True)
        return [-np.linalg.lstsq(t, q.T @ e, rcond=1e-9)[0] for q, t, e in pairs]


def iterate_steps(state: S, step: Callable[[S], S | None], rounds: int) -> S:
    """Take at most `rounds` steps, until one does not improve or improves little."""
    for _ in range(rounds):
        after = step(state)
        if after is None:
            break
        done = state.square - after.square < LEAST_GAIN * state.square
        state = after
        if done:
            break
    return state


def bounded_least_squares_step(
    J: Array, errors: Array, low: Sequence[float], high: Sequence[float], theta: Array
) -> Array:
    """Return the step (F,) to the least squares of errors + J step, within bounds.

    Parameters without influence are unchanged.
    """
    if not len(theta):
        return theta
    size = np.linalg.norm(J, axis=0)
    size[size == 0.0] = 1.0
    ridged, ridge = np.vstack([J / size, RIDGE * np.eye(len(theta))]), np.zeros(len(theta))
    least = np.minimum((np.array(low) - theta) * size, -1e-12)
    most = np.maximum((np.array(high) - theta) * size, 1e-12)
    R = np.asarray(np.linalg.qr(np.column_stack([ridged, np.append(-errors, ridge)]), mode="r"))
    return np.asarray(lsq_linear(R[:, :-1], R[:, -1], (least, most), method="bvls").x) / size
