"""Cases that are alike: the default tests try the first few, the slow and long ones all of them."""

from collections.abc import Iterable
from typing import Any

import pytest


def few(cases: Iterable[Any], kept: int = 3) -> list[Any]:
    """Parameters of a test, each a value or a tuple of them; those beyond the first `kept` are slow
    tests."""
    return [case if i < kept else slow(case) for i, case in enumerate(cases)]


def slow(case: Any) -> Any:
    """One case among the slow tests."""
    return pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=pytest.mark.slow)


def long(*case: Any) -> Any:
    """One case among the long tests, which are run before a release."""
    return pytest.param(*case, marks=[pytest.mark.slow, pytest.mark.long])
