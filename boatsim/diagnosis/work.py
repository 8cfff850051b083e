"""Count of the computing work of a diagnosis, in a unit that no clock influences."""

from dataclasses import dataclass

import numpy as np

from boatsim.physics.base import Array

# The constants define the unit of `select.budget` and `describe.budget` and are no settings.
# Work per row and degree of freedom squared, relative to an integration step and degree of freedom:
# matrices of the covariance, derivatives of the motion, and the smoother. Fitted to the CPU times
# of passes over the recordings of a hovercraft, a ship and a ship section.
COVARIANCE = 0.25
DERIVATIVES = 0.5
SMOOTHER = 1.0
SCORING = 0.25  # work per row, degree of freedom and term of a description that is scored
CALL = 500  # work of one pass that does not depend on the rows
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

    def add_pass(self, integrations: float, rows: int, dof: int, matrices: float) -> None:
        """Count one pass of the filter over a recording.

        Args:
            integrations: Integration steps of the pass.
            rows: Rows of the recording.
            dof: Degrees of freedom.
            matrices: Work on matrices per row and degree of freedom squared, in integration steps.
        """
        self.work += CALL + round(dof * integrations + matrices * dof * dof * rows)

    def add_scores(self, terms: int, rows: int, dof: int) -> None:
        """Count the approximate evidence of terms of a description, over one recording.

        Args:
            terms: Number of terms.
            rows: Number of rows.
            dof: Degrees of freedom.
        """
        self.work += round(SCORING * terms * rows * dof)
