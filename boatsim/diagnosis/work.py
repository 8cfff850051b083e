"""Count of the computing work of a diagnosis, in a unit that no clock influences."""

from dataclasses import dataclass

# The constants define the unit of all budgets of work and are no settings. The unit is one
# integration step of one degree of freedom, about a tenth of a microsecond. They follow from the
# CPU times of passes and free runs over the recordings of a boat, a ferry, a ship, a hovercraft and
# a ship section; SMOOTHER, SCORING, ACTUATOR and FILTER are rough.
ACTUATOR = 0.25  # degrees of freedom that cost as much as an actuator
FILTER = 0.5  # the same for an effect that filters an input, such as a measured wave
# Work per row, degree of freedom, and mean of the numbers of degrees of freedom and channels:
CORRECTION = 1.0  # corrections of the state by the recorded signals, with known gains
COVARIANCE = 0.8  # covariances of the filter, which give its gains
DERIVATIVES = 1.3  # derivatives of the motion, for the covariances
SMOOTHER = 4.0  # a pass backwards
SIMULATED_STEP = 2.0  # work of a step of a free run and degree of freedom
SCORING = 0.7  # work per row, degree of freedom and term of a description that is scored
CALL = 2000  # work of one pass that does not depend on the rows


@dataclass(frozen=True)
class RecordingSize:
    """Numbers on which the work of a pass over a recording depends.

    Attributes:
        rows: Number of rows.
        channels: Number of recorded signals.
        dof: Number of degrees of freedom.
        actuators: Number of commands and other inputs.
        filters: Number of effects that filter an input.
    """

    rows: int
    channels: int
    dof: int
    actuators: int
    filters: int

    @property
    def work_of_step(self) -> float:
        """Work of an integration step."""
        return self.dof + ACTUATOR * self.actuators + FILTER * self.filters

    @property
    def work_of_rows(self) -> float:
        """Work in all rows that counts as one."""
        return self.rows * self.work_of_step * 0.5 * (self.dof + self.channels)


@dataclass
class WorkCount:
    """Count of the computing work that was done: integration steps times degrees of freedom."""

    work: int = 0

    def add_pass(self, steps: float, size: RecordingSize, rows: float) -> None:
        """Count one pass of the filter over a recording.

        Args:
            steps: Number of integration steps.
            size: Size of the recording.
            rows: Sum of `CORRECTION` and, where the pass computes them, of `COVARIANCE`,
                `DERIVATIVES` and `SMOOTHER`.
        """
        self.work += CALL + round(steps * size.work_of_step + rows * size.work_of_rows)

    def add_free_runs(self, steps: float, size: RecordingSize) -> None:
        """Count the free runs over a recording.

        Args:
            steps: Number of integration steps.
            size: Size of the recording.
        """
        self.work += CALL + round(SIMULATED_STEP * steps * size.work_of_step)

    def add_scores(self, terms: int, rows: int, dof: int) -> None:
        """Count the approximate evidence of terms of a description, over one recording.

        Args:
            terms: Number of terms.
            rows: Number of rows.
            dof: Degrees of freedom.
        """
        self.work += round(SCORING * terms * rows * dof)
