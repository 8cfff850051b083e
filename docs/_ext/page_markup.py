"""Pieces of Markdown for pages that are written from the library."""

import re
from collections.abc import Iterable, Sequence


def row(cells: Iterable[str]) -> str:
    """Return a row of a table."""
    return f"| {' | '.join(cells)} |"


def table_rows(rows: Sequence[Sequence[str]]) -> list[str]:
    """Return a table whose first row holds the headings, with everything else escaped."""
    head, *others = rows
    lines = [row(head), row(["---"] * len(head))]
    for one in others:
        lines.append(row(map(escaped, one)))
    return lines


def bullet_list(facts: Iterable[tuple[str, str]]) -> list[str]:
    """Return a list of labels and texts."""
    return [f"- **{label}**: {escaped(text)}" for label, text in facts]


def sentence(text: str) -> str:
    """Return a text that begins with a capital letter, escaped."""
    return escaped(text[:1].upper() + text[1:])


def escaped(text: str) -> str:
    """Escape what Markdown would interpret, except in backticks."""
    parts = []
    for part in re.split(r"(`[^`]*`)", text):
        if part.startswith("`"):
            parts.append(part)
        else:
            parts.append(re.sub(r"([\\*_<>|\[\]$])", r"\\\1", part))
    return "".join(parts)
