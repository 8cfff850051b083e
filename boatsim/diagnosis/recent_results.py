"""Keeps the last results of a function that is often called again with the same arguments."""

from collections import OrderedDict
from collections.abc import Callable
from typing import Generic, TypeVar

Result = TypeVar("Result")


class RecentResults(Generic[Result]):
    """Cache of the most recent results of a function without side effects.

    Results are stored by the function's arguments, and the least recently used one is dropped.
    """

    def __init__(self, most: int) -> None:
        """Start without results.

        Args:
            most: Number of results that are kept.
        """
        self._most = most
        self._kept: OrderedDict[bytes, Result] = OrderedDict()

    def result(self, key: bytes, compute: Callable[[], Result]) -> Result:
        """Return a cached result, or compute and store it in place of the least recently used one.

        Args:
            key: The function's arguments as bytes.
            compute: Computes the result, which must not be changed afterwards.
        """
        if key in self._kept:
            self._kept.move_to_end(key)
            return self._kept[key]
        found = self._kept[key] = compute()
        if len(self._kept) > self._most:
            self._kept.popitem(last=False)
        return found
