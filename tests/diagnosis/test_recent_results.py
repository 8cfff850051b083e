"""Cache of the most recent results of a function."""

import tracemalloc

from boatsim.diagnosis.recent_results import RecentResults


def test_results_are_kept_without_the_memory_of_their_arguments() -> None:
    kept = RecentResults[int](8)
    tracemalloc.start()
    for number in range(8):
        kept.result(bytes([number]) + bytes(1_000_000), lambda number=number: number)
    memory, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert memory < 100_000


def test_the_least_recently_used_result_is_computed_again() -> None:
    kept, computed = RecentResults[str](2), list[str]()

    def compute(name: str) -> str:
        computed.append(name)
        return name

    for name in ("a", "b", "a", "c", "a", "b"):
        assert kept.result(name.encode(), lambda name=name: compute(name)) == name
    assert computed == ["a", "b", "c", "b"]
