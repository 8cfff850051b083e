"""Progress of long work: a callback that the library calls and the caller may display.

The default displays nothing.
"""

from typing import Protocol


class Report(Protocol):
    """Callback that receives the progress of long work."""

    def __call__(self, stage: str, share: float = 0.0, detail: str = "") -> None:
        """Receive the progress.

        Args:
            stage: What is being done, always in the same words.
            share: Estimated part of the whole work that is done, 0 to 1.
            detail: Details of the stage.
        """


def ignore_progress(stage: str, share: float = 0.0, detail: str = "") -> None:
    """Ignore the progress."""


def report_part_of(report: Report, begin: float, end: float) -> Report:
    """Return the report of a part of the work.

    Args:
        report: Report of the whole work.
        begin: Share of the whole at which the part begins.
        end: Share of the whole at which it ends.
    """

    def report_part(stage: str, share: float = 0.0, detail: str = "") -> None:
        report(stage, begin + (end - begin) * min(max(share, 0.0), 1.0), detail)

    return report_part
