"""How far long work has come: the library tells a report, and whoever called shows it; by default nobody does."""

from typing import Protocol


class Report(Protocol):
    """Told of each stage as it begins, and of what is done meanwhile."""

    def __call__(self, stage: str, share: float = 0.0, detail: str = "") -> None:
        """`stage` is what is being done, always in the same words, `detail` how it goes.

        `share` is how much of the whole work is done, 0 to 1, by experience.
        """


def silent(stage: str, share: float = 0.0, detail: str = "") -> None:
    """The report of work that nobody watches."""


def part(report: Report, begin: float, end: float) -> Report:
    """The report of a part of the work, from one share of the whole to another."""

    def told(stage: str, share: float = 0.0, detail: str = "") -> None:
        report(stage, begin + (end - begin) * min(max(share, 0.0), 1.0), detail)

    return told
