"""The budget of a search: a limit of its work, and what was not tried after it was spent.

The work is counted in integration steps times degrees of freedom: a pass of the filter with 1,000
steps of a vessel in surge, sway and yaw counts 3,000, and more with actuators and covariances. The
count never depends on the speed of the machine, so that a diagnosis of the same recordings with the
same settings gives the same answer everywhere.

A pass is counted when it is computed, not when its cached result is used again. The count of a
stage therefore also depends on the stages before it: near the end of the budget, a stage that is
called alone may try less than the same stage of a whole diagnosis.
"""

from collections.abc import Iterable

from boatsim.diagnosis.candidates import name_without_prefixes
from boatsim.diagnosis.work import WorkCount


class BudgetSpentError(Exception):
    """A search for candidate effects has spent its budget of computing work before its end.

    It is raised only in searches that have to be complete.
    """


class SearchBudget:
    """Limit of the computing work of a search for candidate effects, and what it skipped.

    Work is counted in integration steps times degrees of freedom, so that the result does not
    depend on the speed of the machine.
    """

    def __init__(self, count: WorkCount, work: int, *, complete: bool = False) -> None:
        """Start with the whole budget.

        Args:
            count: Count of the work that has been done.
            work: Work that may be done from now on [steps x dof].
            complete: Whether the search has to end at once when the budget is spent.
        """
        self._count = count
        self._first = count.work
        self._last = count.work + work
        self._complete = complete
        self._omitted: dict[str, int] = {}
        self._statements: list[str] = []

    @property
    def remaining_work(self) -> int:
        """Computing work that the search may still do, at least 0 [steps x dof]."""
        return max(self._last - self._count.work, 0)

    def remaining_budget(self) -> "SearchBudget":
        """Return the budget of a further search that has to be complete, with the rest of the work.

        What this search has skipped is not taken over.
        """
        other = SearchBudget(self._count, self.remaining_work, complete=True)
        other._first = self._first
        return other

    def part(self, share: float) -> "SearchBudget":
        """Return the budget of a search that may do a part of the remaining work.

        Args:
            share: Share of the remaining work, 0 to 1.
        """
        return SearchBudget(self._count, round(share * self.remaining_work))

    @property
    def used_work(self) -> int:
        """Computing work that the search has done, with those that it continues [steps x dof]."""
        return self._count.work - self._first

    @property
    def is_spent(self) -> bool:
        """Whether the search has used its whole budget of computing work."""
        return self.remaining_work == 0

    @property
    def skipped_work_statements(self) -> tuple[str, ...]:
        """Clauses on the candidates and attempts that were skipped because the budget was spent."""
        found = []
        for how, number in self._omitted.items():
            candidates = "1 candidate was" if number == 1 else f"{number} candidates were"
            found.append(f"{candidates} not {how}")
        return (*found, *self._statements)

    def record_skipped_candidates(self, number: int, how: str) -> None:
        """Record that the search skipped some candidate effects because its budget is spent.

        A later record of the same kind of attempt replaces an earlier one.

        Args:
            number: Number of candidates; 0 records nothing.
            how: How they would have been tried, such as "refitted in place of wind".

        Raises:
            BudgetSpentError: The search has to be complete.
        """
        if number == 0:
            return
        if self._complete:
            raise BudgetSpentError
        self._omitted[how] = number

    def record_skipped_attempt(self, what: str) -> None:
        """Record, as a clause in words, what the search did not try because its budget is spent.

        Args:
            what: A clause, such as "wind was not added".

        Raises:
            BudgetSpentError: The search has to be complete.
        """
        if self._complete:
            raise BudgetSpentError
        if what not in self._statements:
            self._statements.append(what)


def in_addition_to_phrase(effects: Iterable[str]) -> str:
    """Return the words "in addition to wind, current" for a set of effects; "alone" for none.

    Args:
        effects: Names of the effects of a set.
    """
    names = ", ".join(dict.fromkeys(map(name_without_prefixes, effects)))
    return f"in addition to {names}" if names else "alone"
