"""Tests of what a missing force depends on: the score test of known shapes in it, under the filter's own statistics."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtrc

from boatsim.diagnosis.locate.smoothing import information
from boatsim.physics.base import Array

SMALL = 1e-9  # share of its information that a shape must keep beside others to be told from them


@dataclass(frozen=True)
class Result:
    """Factors of the shapes of one idea, the p-value of all of them together, and how much force they make."""

    factors: Array  # (S,)
    p_value: float
    rms: Array  # (axes,) of the force that the factors stand for


@dataclass(frozen=True)
class Evidence:
    """What recordings say about the factors of ideas' shapes."""

    at: Mapping[str, slice]  # columns of each idea
    information: Array  # (S, S)
    score: Array  # (S,)
    squares: Array  # (axes, S, S) sum over rows of shape times shape
    rows: int

    @classmethod
    def of(
        cls,
        shapes: Mapping[str, Sequence[Array]],
        found: Array,
        times: Array,
        covariances: Array,
        gains: Array,
        part: slice,
        rms: Array,
        first: Array,
        time_constant: float,
    ) -> "Evidence":
        """Evidence of one recording: shapes (N, axes) of every idea, the rest as in `smoothing.information`."""
        ends = np.cumsum([0, *(len(s) for s in shapes.values())]).tolist()
        S = np.stack([s for each in shapes.values() for s in each], axis=-1)
        learnt, score = information(
            S, found, times, covariances, gains, part, rms, first, time_constant
        )
        at = {n: slice(a, b) for n, a, b in zip(shapes, ends, ends[1:], strict=False)}
        return cls(at, learnt, score, np.einsum("nka,nkb->kab", S, S), len(times))

    def speaks_of(self, name: str) -> bool:
        """Whether the recordings came where an idea makes a difference."""
        return bool(np.diag(self.information)[self.at[name]].any())

    def only(self, names: Sequence[str]) -> "Evidence":
        """The same of these ideas alone, in this order."""
        columns = self.columns(names)
        ends = np.cumsum([0, *(len(self.columns([n])) for n in names)]).tolist()
        at = {n: slice(a, b) for n, a, b in zip(names, ends, ends[1:], strict=False)}
        both = np.ix_(columns, columns)
        return Evidence(
            at,
            self.information[both],
            self.score[columns],
            self.squares[:, columns][:, :, columns],
            self.rows,
        )

    def columns(self, names: Sequence[str]) -> list[int]:
        """Columns of several ideas."""
        return [i for n in names for i in range(self.at[n].start, self.at[n].stop)]

    def test(self, name: str, beside: Sequence[str]) -> Result:
        """An idea on top of others, whose factors are free."""
        a, b = self.columns([name]), self.columns(beside)
        inner, cross = self.information[np.ix_(b, b)], self.information[np.ix_(a, b)]
        take = np.linalg.lstsq(inner, np.column_stack([cross.T, self.score[b]]), rcond=SMALL)[0]
        own = self.information[np.ix_(a, a)]
        left, score = own - cross @ take[:, :-1], self.score[a] - cross @ take[:, -1]
        clear = np.diag(left) > SMALL * np.diag(
            own
        )  # neither nothing nor what the others already say
        if not clear.any():
            return Result(np.zeros(len(a)), 1.0, np.zeros(len(self.squares)))
        factors = np.zeros(len(a))
        factors[clear] = np.linalg.solve(left[np.ix_(clear, clear)], score[clear])
        squares = np.array([factors @ s[np.ix_(a, a)] @ factors for s in self.squares])
        p_value = float(chdtrc(int(clear.sum()), max(0.0, float(score @ factors))))
        return Result(factors, p_value, np.sqrt(squares / self.rows))


def joint(several: Sequence[Evidence], names: Sequence[str]) -> Evidence:
    """Evidence of independent recordings about ideas that all of them have."""
    same = [e.only(names) for e in several]
    return Evidence(
        same[0].at,
        np.sum([e.information for e in same], axis=0),
        np.sum([e.score for e in same], axis=0),
        np.sum([e.squares for e in same], axis=0),
        sum(e.rows for e in same),
    )
