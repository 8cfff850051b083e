"""What a report is made of: paragraphs, lists, tables and figures under headings, and how each reads as plain text."""

import re
from dataclasses import dataclass, field, replace
from typing import ClassVar


@dataclass(frozen=True)
class Text:
    """A paragraph."""

    kind: ClassVar[str] = "text"
    words: str


@dataclass(frozen=True)
class Heading:
    """A heading within a section, with a line of facts under it."""

    kind: ClassVar[str] = "heading"
    words: str
    facts: str = ""


@dataclass(frozen=True)
class Items:
    """A list; pairs of a term and what it means, or plain lines with no term."""

    kind: ClassVar[str] = "items"
    lines: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Table:
    """A table; the first column is text, so are those named in `prose`, the rest are numbers."""

    kind: ClassVar[str] = "table"
    caption: str
    header: list[str]
    rows: list[list[str]]
    prose: tuple[int, ...] = ()
    bars: tuple[float, ...] = ()  # share of a row's bar, 0 to 1, behind its second column
    folded: bool = False  # on the page, shown on request
    aside: bool = False  # the last column is left out where the screen is narrow


def without_empty(table: Table) -> Table:
    """The table without prose columns that say nothing in any row."""
    kept = [
        i
        for i in range(len(table.header))
        if i not in table.prose or any(row[i] for row in table.rows)
    ]
    prose = tuple(new for new, old in enumerate(kept) if old in table.prose)
    header, *rows = ([row[i] for i in kept] for row in (table.header, *table.rows))
    aside = table.aside and len(table.header) - 1 in kept
    return replace(table, header=header, rows=rows, prose=prose, aside=aside)


@dataclass(frozen=True)
class Figures:
    """Pictures of the page; the text has the tables beside them."""

    kind: ClassVar[str] = "figures"
    legend: str
    pictures: list[str]


Block = Text | Heading | Items | Table | Figures


@dataclass(frozen=True)
class Section:
    """What one heading stands over."""

    key: str
    title: str
    blocks: list[Block] = field(default_factory=list)


def safe(words: str) -> str:
    """Names from files do not become mark-up."""
    words = words.replace("&", "&amp;").replace("<", "&lt;").replace("\n", " ")
    return re.sub(r"([|*`]|(?<=\])\()", r"\\\1", words)


def as_text(block: Block) -> list[str]:
    """Lines of a block in Markdown; figures have none."""
    match block:
        case Text():
            return ["", safe(block.words)]
        case Heading():
            return [
                "",
                f"### {safe(block.words)}",
                *(["", safe(block.facts)] if block.facts else []),
            ]
        case Items():
            return ["", *(f"- {f'**{safe(a)}**: ' if a else ''}{safe(b)}" for a, b in block.lines)]
        case Table():
            head, *rows = ([safe(cell) for cell in row] for row in (block.header, *block.rows))
            rule = ["---" if i in (0, *block.prose) else "---:" for i in range(len(head))]
            return [
                "",
                safe(block.caption),
                "",
                *(f"| {' | '.join(row)} |" for row in (head, rule, *rows)),
            ]
        case Figures():
            return []
