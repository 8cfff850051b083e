"""Result table: one line for each case, and the goals."""

from collections.abc import Callable, Iterable, Iterator, Sequence

from validation.owner_logs.judge import HALF, Result


def case_line(r: Result) -> str:
    """Return the line of one case."""
    fault = f"{r.fault or '-'}: {_mark(r.fault_named)}" + (
        "" if r.mended is None else f", mended {_mark(r.mended)}"
    )
    cause = f"{r.cause or '-'}: {_mark(r.physics_named)}"
    if r.nominal_m != r.nominal_m:
        ratio = "-"
    else:
        ratio = f"{r.nominal_m:.2f} -> {r.answer_m:.2f} m ({r.ratio:.2f})"
    answer = ", ".join(r.effects) or r.verdict or r.need or r.trouble
    found = "" if not r.found else f" [{'; '.join(r.found)}]"
    return (
        f"{r.number:3d} {r.kind:5s} {r.boat:16s} {r.form:13s} {fault}; {cause}; {answer}; "
        f"{ratio}{found}"
    )


def _mark(value: bool | None) -> str:
    if value is None:
        return "-"
    if value:
        return "yes"
    return "NO"


def goal_rows(results: Sequence[Result]) -> Iterator[str]:
    """Yield a row for each goal: the criterion, its rate, the goal."""
    yield f"{'goal':58s} {'reached':>14s} {'of':>4s} {'asked':>7s}"
    for title, asked, counts, hit in _rows():
        there = [r for r in results if counts(r)]
        n = sum(hit(r) for r in there)
        share = f"{n} ({100.0 * n / len(there):.0f} %)" if there else "-"
        yield f"{title:58s} {share:>14s} {len(there):4d} {asked:>7s}"
    if asked_of := [r for r in results if r.verdict]:
        for kind, there in (
            ("without a cause", [r for r in asked_of if not r.cause]),
            ("with a cause", [r for r in asked_of if r.cause]),
        ):
            mean = f"{sum(r.false_names for r in there) / len(there):.2f}" if there else "-"
            yield f"false names per log, {kind}: {mean}"


Test = Callable[[Result], bool]


def _rows() -> Iterable[tuple[str, str, Test, Test]]:
    return (
        (
            "log read, or its need stated in one line",
            "all",
            lambda r: True,
            lambda r: r.read or bool(r.need),
        ),
        (
            "map of the commands proposed whole and right",
            "-",
            _through_a_map,
            lambda r: not r.edits,
        ),
        ("the log's fault named", "80 %", lambda r: bool(r.fault), lambda r: bool(r.fault_named)),
        (
            "of faults that a line corrects: corrected by the advice",
            "-",
            lambda r: r.mended is not None,
            lambda r: bool(r.mended),
        ),
        (
            "a fault of the log called physics",
            "<= 5 %",
            lambda r: r.called_physics is not None,
            lambda r: bool(r.called_physics),
        ),
        ("good logs accused", "-", lambda r: not r.fault, lambda r: r.accused),
        (
            "the cause is the first name",
            "80 %",
            lambda r: r.first_named is not None,
            lambda r: bool(r.first_named),
        ),
        (
            "the physics named, or refined in the vessel file",
            "75 %",
            lambda r: r.physics_named is not None,
            lambda r: bool(r.physics_named),
        ),
        (
            "physics described, not named",
            "-",
            lambda r: r.physics_named is False,
            lambda r: r.verdict in ("described", "unknown"),
        ),
        (
            "good log and boat: nothing wrong named",
            "-",
            lambda r: r.kind == "good" and bool(r.verdict),
            lambda r: not r.false_names,
        ),
        (
            "second log predicted with at most half the error",
            "85 %",
            lambda r: bool(r.possible),
            lambda r: r.ratio <= HALF,
        ),
        ("trouble: a command failed", "0", lambda r: True, lambda r: bool(r.trouble)),
    )


def _through_a_map(r: Result) -> bool:
    return r.read and not r.form.startswith("plain.")
