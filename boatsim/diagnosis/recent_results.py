"""Keeps the last results of a function that is often called again with the same arguments."""

from collections import OrderedDict
from collections.abc import Callable
from typing import Generic, TypeVar

Result = TypeVar("Result")


class RecentResults(Generic[Result]):
    """The last few results of a function without side effects, by its arguments."""

    def __init__(self, most: int) -> None:
        """Start without results.

        Args:
            most: Number of results that are kept.
        """
        self._most = most
        self._kept: OrderedDict[bytes, Result] = OrderedDict()

    def result(self, key: bytes, compute: Callable[[], Result]) -> Result:
        """Return a kept result, or compute it and keep it in the place of the oldest.

        Args:
            key: The arguments.
            compute: Computes the result, which must not be changed afterwards.
        """
        if key in self._kept:
            self._kept.move_to_end(key)
            return self._kept[key]
        found = self._kept[key] = compute()
        if len(self._kept) > self._most:
            self._kept.popitem(last=False)
        return found
