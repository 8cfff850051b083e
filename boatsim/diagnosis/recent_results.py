"""Keeps the last results of a function that is often called again with the same arguments."""

from collections import OrderedDict
from collections.abc import Callable
from hashlib import blake2b
from typing import Generic, TypeVar

Result = TypeVar("Result")

DIGEST = 16  # [bytes] two of a diagnosis' keys have the same digest with a probability below 1e-20


class RecentResults(Generic[Result]):
    """Cache of the most recent results of a function without side effects.

    Results are stored by a digest of the function's arguments, which can hold tables of megabytes,
    and the least recently used one is dropped.
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
        digest = blake2b(key, digest_size=DIGEST).digest()
        if digest in self._kept:
            self._kept.move_to_end(digest)
            return self._kept[digest]
        found = self._kept[digest] = compute()
        if len(self._kept) > self._most:
            self._kept.popitem(last=False)
        return found
