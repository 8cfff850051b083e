"""Progress of long work: a callback that the library calls and the caller may display.

The default displays nothing.
"""

from typing import Protocol


class Report(Protocol):
    """Type of callbacks that receive the progress of long work: stage, fraction done, detail."""

    def __call__(self, stage: str, share: float = 0.0, detail: str = "") -> None:
        """Receive the progress.

        Args:
            stage: What is being done, always in the same words.
            share: Estimated part of the whole work that is done, 0 to 1.
            detail: Details of the stage.
        """


def ignore_progress(stage: str, share: float = 0.0, detail: str = "") -> None:
    """Do nothing: the progress callback that ignores all reports."""


def report_part_of(report: Report, begin: float, end: float) -> Report:
    """Return a callback that scales the progress of a part of the work to that of the whole work.

    Args:
        report: Progress callback of the whole work.
        begin: Fraction of the whole work, 0 to 1, at which the part begins.
        end: Fraction of the whole work at which the part ends.
    """

    def report_part(stage: str, share: float = 0.0, detail: str = "") -> None:
        report(stage, begin + (end - begin) * min(max(share, 0.0), 1.0), detail)

    return report_part
