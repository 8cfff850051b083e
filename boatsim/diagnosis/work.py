"""Count of the computing work of a diagnosis, in a unit that no clock influences."""

from dataclasses import dataclass

import numpy as np

from boatsim.physics.base import Array

# The constants define the unit of all budgets of work and are no settings. The unit is one
# integration step of one degree of freedom, 0.1 to 0.2 microseconds. CORRECTION, COVARIANCE,
# DERIVATIVES and CALL follow from the CPU times of passes over the recordings of a boat, a ferry, a
# ship, a hovercraft and a ship section; the others are rough estimates.
# Work per row, degree of freedom, and mean of the numbers of degrees of freedom and channels:
CORRECTION = 1.0  # corrections of the state by the recorded signals, with known gains
COVARIANCE = 0.8  # covariances of the filter, which give its gains
DERIVATIVES = 1.3  # derivatives of the motion, for the covariances
SMOOTHER = 4.0  # a pass backwards
SIMULATED_STEP = 1.4  # work of a step of a free run and degree of freedom
SCORING = 0.7  # work per row, degree of freedom and term of a description that is scored
CALL = 2000  # work of one pass that does not depend on the rows
MOST_PARTS = 1e4  # of the time between two rows, so that the count stays finite


def integration_count(times: Array, steps: Array) -> float:
    """Return the total number of integration steps over all intervals between the rows of a log.

    Args:
        times: (N,) times of the rows [s].
        steps: (N,) longest integration steps used before each row [s]; the first is not used.
    """
    with np.errstate(divide="ignore", invalid="ignore"):  # of a vessel that diverges
        parts = np.ceil(np.diff(times) / steps[1:] - 1e-9)
    return float(np.clip(np.nan_to_num(parts), 1.0, MOST_PARTS).sum())


@dataclass
class WorkCount:
    """Count of the computing work that was done: integration steps times degrees of freedom."""

    work: int = 0

    def add_pass(self, integrations: float, shape: tuple[int, int], dof: int, rows: float) -> None:
        """Count one pass of the filter over a recording.

        Args:
            integrations: Integration steps of the pass.
            shape: Numbers of rows and of channels of the recording.
            dof: Degrees of freedom.
            rows: Sum of `CORRECTION` and, where the pass computes them, of `COVARIANCE`,
                `DERIVATIVES` and `SMOOTHER`.
        """
        size = shape[0] * dof * 0.5 * (dof + shape[1])
        self.work += CALL + round(dof * integrations + rows * size)

    def add_free_runs(self, integrations: float, dof: int) -> None:
        """Count the free runs over a recording.

        Args:
            integrations: Integration steps of the free runs.
            dof: Degrees of freedom.
        """
        self.work += CALL + round(SIMULATED_STEP * dof * integrations)

    def add_scores(self, terms: int, rows: int, dof: int) -> None:
        """Count the approximate evidence of terms of a description, over one recording.

        Args:
            terms: Number of terms.
            rows: Number of rows.
            dof: Degrees of freedom.
        """
        self.work += round(SCORING * terms * rows * dof)
