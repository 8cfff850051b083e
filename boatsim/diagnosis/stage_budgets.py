"""Budgets of the long stages of a diagnosis, which share the work of the whole one.

Each stage has a budget of its own. It gets less where the stages before it have used so much of
`work.total` that later stages, which decide what the answer states and predicts, would get nothing.
"""

from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.search.budget import SearchBudget


def search_budget(problem: Problem, most: int | None = None) -> SearchBudget:
    """Return the budget of a search for candidate effects.

    Args:
        problem: The estimation problem, with the count of the work so far.
        most: Largest work of the search [steps x dof]; None: `select.budget`.
    """
    work = problem.config.work
    later = work.for_description + work.for_simulations
    return _budget(problem, most or problem.config.select.budget, later)


def pair_budget(problem: Problem) -> SearchBudget:
    """Return the budget of the search for a spring and the force that it balances.

    Free runs find both, so that it may use a part of the work that is left to the fit to free runs.

    Args:
        problem: The estimation problem, with the count of the work so far.
    """
    work, most = problem.config.work, problem.config.simulate.pair_budget
    later = work.for_description + max(work.for_simulations - most, 0)
    return _budget(problem, most, later)


def description_budget(problem: Problem) -> SearchBudget:
    """Return the budget of the description of an unexplained force by a formula.

    Args:
        problem: The estimation problem, with the count of the work so far.
    """
    config = problem.config
    return _budget(problem, config.describe.budget, config.work.for_simulations)


def simulation_budget(problem: Problem, *, has_unsure: bool = False) -> SearchBudget:
    """Return the budget of the fit to free runs.

    Args:
        problem: The estimation problem, with the count of the work so far.
        has_unsure: Whether effects are stated that are only probably causes, so that a search
            without them follows.
    """
    simulate = problem.config.simulate
    return _budget(problem, simulate.budget, simulate.unsure_budget if has_unsure else 0)


def unsure_budget(problem: Problem) -> SearchBudget:
    """Return the budget of the fit to free runs without effects that are only probably causes.

    Args:
        problem: The estimation problem, with the count of the work so far.
    """
    return _budget(problem, problem.config.simulate.unsure_budget, 0)


def _budget(problem: Problem, most: int, later: int) -> SearchBudget:
    """A budget of at most some work, which leaves some to later stages [steps x dof]."""
    left = problem.config.work.total - problem.work_count.work - later
    return SearchBudget(problem.work_count, max(min(most, left), 0))
