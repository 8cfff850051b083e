"""Blocks of a report: paragraphs, lists, tables and figures, and their text in Markdown."""

import re
from dataclasses import dataclass, field, replace
from typing import ClassVar

STATISTICS = "Statistics behind this"  # title of a note


@dataclass(frozen=True)
class Text:
    """A paragraph of a report."""

    kind: ClassVar[str] = "text"
    words: str


@dataclass(frozen=True)
class Note:
    """A paragraph that the page shows on request only, under its title."""

    kind: ClassVar[str] = "note"
    title: str
    words: str


@dataclass(frozen=True)
class Heading:
    """A heading within a section of a report, with a line of facts below it."""

    kind: ClassVar[str] = "heading"
    words: str
    facts: str = ""


@dataclass(frozen=True)
class Items:
    """A list in a report: pairs of a term and its meaning, or of "" and a line of text."""

    kind: ClassVar[str] = "items"
    lines: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class FileLines:
    """Lines that the reader shall copy into a file, under a title that names the file."""

    kind: ClassVar[str] = "lines"
    title: str
    lines: tuple[str, ...]


@dataclass(frozen=True)
class Table:
    """A table of a report: its caption, header and cells, and how the HTML page shows it.

    Attributes:
        caption: Title of the table.
        header: Titles of the columns.
        rows: Cells of each row.
        prose: Columns of words in addition to the first one; all others are numbers.
        bars: Length of the bar behind the second column of each row, 0 to 1.
        folded: Whether the page shows the table on request only.
        aside: Whether the last column is omitted on narrow screens.
    """

    kind: ClassVar[str] = "table"
    caption: str
    header: list[str]
    rows: list[list[str]]
    prose: tuple[int, ...] = ()
    bars: tuple[float, ...] = ()
    folded: bool = False
    aside: bool = False


def without_empty_columns(table: Table) -> Table:
    """Return a table without its columns of words that are empty in every row.

    Args:
        table: The table.
    """
    kept: list[int] = []
    prose: list[int] = []
    for i in range(len(table.header)):
        if i in table.prose:
            if not any(row[i] for row in table.rows):
                continue
            prose.append(len(kept))
        kept.append(i)
    header, *rows = [_select_columns(row, kept) for row in (table.header, *table.rows)]
    aside = table.aside and len(table.header) - 1 in kept
    return replace(table, header=header, rows=rows, prose=tuple(prose), aside=aside)


def _select_columns(row: list[str], columns: list[int]) -> list[str]:
    return [row[i] for i in columns]


@dataclass(frozen=True)
class Figures:
    """Figures of a report's HTML page; the Markdown version contains the tables only."""

    kind: ClassVar[str] = "figures"
    legend: str
    pictures: list[str]


Block = Text | Note | Heading | Items | FileLines | Table | Figures


@dataclass(frozen=True)
class Section:
    """A section of a report: its title and its blocks; `key` is its anchor on the HTML page."""

    key: str
    title: str
    blocks: list[Block] = field(default_factory=list)


def escape_markup(words: str) -> str:
    """Escape characters in text from files that Markdown would read as mark-up, by a backslash.

    A "<" before a space and an "&" before a space begin neither a tag nor an entity and stay.
    """
    words = words.replace("\n", " ")
    return re.sub(r"([|*`]|<(?=[\w/!?])|&(?=[\w#])|(?<=\])\()", r"\\\1", words)


def markdown_lines(block: Block) -> list[str]:
    """Return the Markdown lines of one block of a report, such as a table; figures have none.

    Args:
        block: The block.
    """
    match block:
        case Text():
            return ["", escape_markup(block.words)]
        case Note():
            return ["", f"*{escape_markup(block.title)}*: {escape_markup(block.words)}"]
        case Heading():
            lines = ["", f"### {escape_markup(block.words)}"]
            if block.facts:
                lines += ["", escape_markup(block.facts)]
            return lines
        case Items():
            return ["", *map(_item, block.lines)]
        case FileLines():
            code = [f"    {line}" for line in block.lines]
            return ["", f"{escape_markup(block.title)}:", "", *code]
        case Table():
            rule = ["---:"] * len(block.header)
            for i in (0, *block.prose):
                rule[i] = "---"
            lines = [_table_line(block.header), f"| {' | '.join(rule)} |"]
            lines += map(_table_line, block.rows)
            return ["", escape_markup(block.caption), "", *lines]
        case Figures():
            return []


def _item(line: tuple[str, str]) -> str:
    term, meaning = line
    if not term:
        return f"- {escape_markup(meaning)}"
    return f"- **{escape_markup(term)}**: {escape_markup(meaning)}"


def _table_line(row: list[str]) -> str:
    return f"| {' | '.join(map(escape_markup, row))} |"
