"""Errors of windows linearised: what each window's own start can do about them is projected out of a step."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol, TypeVar

import numpy as np
from scipy.optimize import lsq_linear

from boatsim.physics.base import Array

RIDGE = 1e-5  # of a column's length, so that what nothing depends on stays
LEAST_GAIN = 1e-3  # of the sum of squares, from which another step is worth it


class Squared(Protocol):
    """What a fit has reached."""

    @property
    def square(self) -> float:
        """Weighted sum of squares, those of the prior included."""


S = TypeVar("S", bound=Squared)


def nothing() -> Array:
    """No columns yet."""
    return np.zeros((0, 0))


@dataclass(frozen=True)
class Linear:
    """Weighted errors (R,) of all windows in one row, and their derivatives."""

    weights: Array  # (C,)
    masks: tuple[Array, ...]  # (M C,) of each window, where something was recorded
    bases: tuple[Array, ...]  # (M C, 2 NQ) orthonormal, of what its start can do
    triangles: tuple[Array, ...]  # (2 NQ, 2 NQ): derivatives by the start = basis @ triangle
    errors: Array  # (R,)
    raw: Array = field(default_factory=nothing)  # (R, F) by the parameters, starts held
    # (R + N,) errors without what starts can do, then those of the prior
    rest: Array = field(default_factory=nothing)
    columns: Array = field(default_factory=nothing)  # (R + N, F) the same of derivatives

    @classmethod
    def of(cls, errors: Sequence[Array], weights: Array, by_starts: Sequence[Array]) -> "Linear":
        """Of errors (M, C) and their derivatives (M, C, 2 NQ) by the starts, window by window."""
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

    def about(self, errors: Sequence[Array]) -> "Linear":
        """The same about other errors."""
        return replace(self, errors=self.flat(errors))

    def flat(self, errors: Sequence[Array]) -> Array:
        """Errors (M, C) of all windows, weighted, in one row; 0 where nothing was recorded."""
        rows = [
            np.nan_to_num((e * self.weights).ravel()) * m
            for e, m in zip(errors, self.masks, strict=True)
        ]
        return np.concatenate(rows)

    def projected(self, rows: Array) -> Array:
        """Rows (R, ...) without what the windows' starts could do about them."""
        return np.concatenate(
            [part - q @ (q.T @ part) for part, q in zip(self.cut(rows), self.bases, strict=True)]
        )

    def cut(self, rows: Array) -> list[Array]:
        """Window by window."""
        return np.split(rows, np.cumsum([len(m) for m in self.masks])[:-1])

    def joined(self, columns: Sequence[Array], prior: tuple[Array, Array]) -> "Linear":
        """With columns (R,) of parameters, and the rows (N, F) and errors (N,) of their prior."""
        raw = np.column_stack(columns) if columns else np.zeros((len(self.errors), 0))
        rest = np.concatenate([self.projected(self.errors), prior[1]])
        return replace(self, raw=raw, rest=rest, columns=np.vstack([self.projected(raw), prior[0]]))

    def by_window(self, move: Array) -> list[Array]:
        """(2 NQ,) how each window's start moves along with a step (F,) of the parameters."""
        left = self.cut(self.errors + self.raw @ move)
        pairs = zip(self.bases, self.triangles, left, strict=True)
        return [-np.linalg.lstsq(t, q.T @ e, rcond=1e-9)[0] for q, t, e in pairs]


def descended(state: S, step: Callable[[S], S | None], rounds: int) -> S:
    """After at most so many steps, until one gains next to nothing or none is for the better."""
    for _ in range(rounds):
        after = step(state)
        if after is None:
            break
        done = state.square - after.square < LEAST_GAIN * state.square
        state = after
        if done:
            break
    return state


def solved(
    J: Array, errors: Array, low: Sequence[float], high: Sequence[float], theta: Array
) -> Array:
    """(F,) step of theta (F,) to the least squares of errors + J step, within bounds; what does nothing stays."""
    if not len(theta):
        return theta
    size = np.linalg.norm(J, axis=0)
    size[size == 0.0] = 1.0
    ridged, ridge = np.vstack([J / size, RIDGE * np.eye(len(theta))]), np.zeros(len(theta))
    least = np.minimum((np.array(low) - theta) * size, -1e-12)
    most = np.maximum((np.array(high) - theta) * size, 1e-12)
    R = np.asarray(np.linalg.qr(np.column_stack([ridged, np.append(-errors, ridge)]), mode="r"))
    return np.asarray(lsq_linear(R[:, :-1], R[:, -1], (least, most), method="bvls").x) / size
