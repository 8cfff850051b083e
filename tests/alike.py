"""Cases that are alike: the default tests try the first few, the slow and long ones all of them."""

from collections.abc import Iterable
from typing import Any

import pytest


def few(cases: Iterable[Any], kept: int = 3, slow_cases: int | None = None) -> list[Any]:
    """Mark the parameters of a test whose cases are alike.

    Args:
        cases: Parameters, each a value or a tuple of them.
        kept: Number of cases, the first ones, that stay default tests.
        slow_cases: Number of the other cases that are slow tests, evenly spaced among them; the
            rest are long tests. None: all other cases are slow tests.

    Returns:
        The parameters in the same order.
    """
    cases = list(cases)
    others = len(cases) - kept
    marked: list[Any] = []
    for i, case in enumerate(cases):
        if i < kept:
            marked.append(case)
        elif slow_cases is None or (i - kept) * slow_cases % others < slow_cases:
            marked.append(slow(case))
        else:
            marked.append(long(*case) if isinstance(case, tuple) else long(case))
    return marked


def slow(case: Any) -> Any:
    """One case among the slow tests."""
    return pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=pytest.mark.slow)


def long(*case: Any) -> Any:
    """One case among the long tests, which are run before a release."""
    return pytest.param(*case, marks=[pytest.mark.slow, pytest.mark.long])
