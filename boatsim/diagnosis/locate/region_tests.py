"""Score tests of force shapes in the smoothed latent force, with the statistics of the filter."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtrc

from boatsim.diagnosis.locate.smoothing import LatentForce, joint_information
from boatsim.physics.base import Array

# share of its information that a shape must retain next to others, a guard against rounding
MIN_INFORMATION_SHARE = 1e-9


@dataclass(frozen=True)
class ScoreTest:
    """Result of a score test: is a force of given shapes missing in the vessel model?"""

    factors: Array  # (S,) of its shapes
    p_value: float  # of all factors together
    rms: Array  # (axes,) of the force with these factors


@dataclass(frozen=True)
class ScoreStatistics:
    """Fisher information and score of recordings about the factors of given force shapes.

    A shape is a force over time, such as that of a constant wind. Its factor is the size of the
    missing force of this shape.
    """

    columns: Mapping[str, tuple[int, ...]]  # indices of the shapes of each candidate
    information: Array  # (S, S)
    score: Array  # (S,)
    squares: Array  # (axes, S, S) sums over rows of products of shapes
    rows: int

    @classmethod
    def from_latent_force(
        cls, shapes: Mapping[str, Sequence[Array]], force: LatentForce
    ) -> "ScoreStatistics":
        """Compute the score statistics of one recording from its smoothed latent force.

        The shapes of all candidates are forces over time that may be missing in the vessel model.

        Args:
            shapes: Shapes (N, axes) of every candidate.
            force: Smoothed latent force of the recording.
        """
        columns = _consecutive(shapes)
        arrays: list[Array] = []
        for each in shapes.values():
            arrays += each
        S = np.stack(arrays, axis=-1)
        information, score = joint_information(S, force)
        return cls(columns, information, score, np.einsum("nka,nkb->kab", S, S), len(force.times))

    def is_informative(self, name: str) -> bool:
        """Return whether the force shapes of a candidate differ from zero in the recordings."""
        return bool(np.diag(self.information)[list(self.columns[name])].any())

    def select_candidates(self, names: Sequence[str]) -> "ScoreStatistics":
        """Return the score statistics of some candidates only, in the given order."""
        kept = self.shape_indices(names)
        columns = _consecutive(dict(zip(names, map(self.columns.__getitem__, names), strict=True)))
        return ScoreStatistics(
            columns,
            self.information[np.ix_(kept, kept)],
            self.score[kept],
            self.squares[:, kept][:, :, kept],
            self.rows,
        )

    def shape_indices(self, names: Sequence[str]) -> list[int]:
        """Return the positions of some candidates' force shapes in the information matrix."""
        found: list[int] = []
        for name in names:
            found += self.columns[name]
        return found

    def score_test(self, name: str, others: Sequence[str]) -> ScoreTest:
        """Test whether a candidate force is missing in addition to other candidates (score test).

        The factors of the other candidates are estimated together with it.

        Args:
            name: The candidate.
            others: Candidates whose factors are estimated with it.
        """
        a = self.shape_indices([name])
        b = self.shape_indices(others)
        inner = self.information[np.ix_(b, b)]
        cross = self.information[np.ix_(a, b)]
        targets = np.column_stack([cross.T, self.score[b]])
        solution = np.linalg.lstsq(inner, targets, rcond=MIN_INFORMATION_SHARE)[0]
        own = self.information[np.ix_(a, a)]
        remaining = own - cross @ solution[:, :-1]
        score = self.score[a] - cross @ solution[:, -1]
        # shapes that are neither zero nor combinations of the others
        free = np.diag(remaining) > MIN_INFORMATION_SHARE * np.diag(own)
        factors = np.zeros(len(a))
        if not free.any():
            return ScoreTest(factors, 1.0, np.zeros(len(self.squares)))
        factors[free] = np.linalg.solve(remaining[np.ix_(free, free)], score[free])
        squares = [factors @ s[np.ix_(a, a)] @ factors for s in self.squares]
        p_value = float(chdtrc(int(free.sum()), max(0.0, float(score @ factors))))
        return ScoreTest(factors, p_value, np.sqrt(np.array(squares) / self.rows))


def sum_statistics(statistics: Sequence[ScoreStatistics], names: Sequence[str]) -> ScoreStatistics:
    """Return the sum of the score statistics of several independent recordings.

    Args:
        statistics: Statistics of each recording.
        names: Candidates that all recordings have.
    """
    same = [each.select_candidates(names) for each in statistics]
    return ScoreStatistics(
        same[0].columns,
        np.sum([each.information for each in same], axis=0),
        np.sum([each.score for each in same], axis=0),
        np.sum([each.squares for each in same], axis=0),
        sum(each.rows for each in same),
    )


def _consecutive(shapes: Mapping[str, Sequence[object]]) -> dict[str, tuple[int, ...]]:
    """Consecutive indices for the shapes of each candidate."""
    columns = {}
    begin = 0
    for name, own in shapes.items():
        columns[name] = tuple(range(begin, begin + len(own)))
        begin += len(own)
    return columns
