"""What was found wrong with a log: its name, the evidence, and the change of columns that would put it right."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.expression import UNITS, Expression
from boatsim.recordings.table import Recording

Kind = Literal["fault", "mended", "limit"]
PROBABLY = "probably your log, not your boat"
CERTAIN = 0.99  # from this probability on, the verdict of a diagnosis begins with the log
LONG_WORDS = (
    "deg",
    "percent",
    "ms",
    "us",
    "ns",
    "rpm",
    "rev",
)  # units by which a line is easier to read than a number


@dataclass(frozen=True)
class Change:
    """A column as it should be: `ours` is made of the column `of`, times a factor, plus an offset, all in our names."""

    ours: str
    of: str
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True)
class Finding:
    """One fault of a log.

    `fault`: the file must be put right; `mended`: a diagnosis leaves those rows out by itself; `limit`: nothing is
    wrong, but something can not be told from it.
    """

    name: str
    evidence: str  # in numbers
    kind: Kind = "fault"
    sure: float = 1.0  # probability
    spans: tuple[tuple[float, float], ...] = ()  # [s] where it shows; empty: all along
    changes: tuple[Change, ...] = ()  # what puts it right
    alternatives: tuple[
        tuple[str, tuple[Change, ...]], ...
    ] = ()  # what explains the same: its name, its changes
    use: tuple[float, float] | None = None  # [s] the part that is sound
    remedy: str = ""  # in words, where no line of a recording.toml does it
    words: str = ""  # what is wrong in a clause, where the name does not say it
    run: str = ""  # file of the recording; several: that of the first

    @property
    def said(self) -> str:
        """What is wrong, in a clause."""
        return self.words or self.name.replace("_", " ")

    @property
    def of_the_whole_log(self) -> bool:
        """Whether a diagnosis of the log as it is would blame the boat for it."""
        return self.kind == "fault" and bool(self.changes) and self.sure >= CERTAIN


def applied(recording: Recording, changes: Sequence[Change]) -> Recording:
    """The recording with its columns changed, its commands at their own times too; what it has not got is left out."""

    def changed(columns: Mapping[str, Array]) -> dict[str, Array]:
        made = {c.ours: columns[c.of] * c.factor + c.offset for c in changes if c.of in columns}
        return {**columns, **made}

    orders = recording.orders
    if orders is not None:
        orders = replace(orders, signals=changed(orders.signals))
    whole = changed({"t_s": recording.t, **recording.signals})
    t = whole.pop("t_s")
    return replace(recording, t=t, signals=whole, orders=orders)


def lines(changes: Sequence[Change], sources: Mapping[str, Expression]) -> list[str]:
    """Lines of `[columns]`; `sources` is what our columns are made of so far."""
    found = []
    for c in changes:
        source = sources.get(c.of, Expression(c.of))
        made = Expression(
            source.signal, c.factor * source.factor, c.factor * source.offset + c.offset
        )
        found.append(f'{c.ours} = "{_words(made, c.ours)}"')
    return found


def _words(e: Expression, ours: str) -> str:
    """The text of an expression, with the name of a unit where the factor is one, and degrees for an offset in rad."""
    size, sign = abs(e.factor), "-" if e.factor < 0.0 else ""
    unit = next((u for u in LONG_WORDS if abs(size / UNITS[u] - 1.0) < 1e-9), "")
    text = f"{sign}{e.signal}" + ("" if size == 1.0 else f" * {unit or f'{size:.10g}'}")
    if e.offset == 0.0:
        return text
    way, off = "-" if e.offset < 0.0 else "+", abs(e.offset)
    return (
        f"{text} {way} {f'{np.degrees(off):.4g} * deg' if ours.endswith('_rad') else f'{off:.12g}'}"
    )


def to_write(finding: Finding, sources: Mapping[str, Expression]) -> list[str]:
    """What is to be written into a recording.toml, line by line; of alternatives the first."""
    written = lines(finding.changes, sources)
    use = [f"use = [{finding.use[0]:.9g}, {finding.use[1]:.9g}]"] if finding.use else []
    return [*use, *(["[columns]", *written] if written else [])]
