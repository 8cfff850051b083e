"""Tables of HTML for notebooks; all texts are escaped."""

from collections.abc import Sequence
from html import escape


def html_facts_table(title: str, facts: Sequence[tuple[str, str]]) -> str:
    """Return a title and a two-column table of facts as HTML.

    Args:
        title: Text above the table.
        facts: Name and value of each row.
    """
    rows = []
    for name, value in facts:
        rows.append(f"<tr><th style='text-align:left'>{escape(name)}</th>{_cell(value)}</tr>")
    return f"<p><b>{escape(title)}</b></p><table>{''.join(rows)}</table>"


def html_table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a table with a header as HTML; without rows the result is "".

    Args:
        header: Texts of the header.
        rows: Texts of each row.
    """
    if not rows:
        return ""
    lines = []
    for row in rows:
        lines.append(f"<tr>{''.join(map(_cell, row))}</tr>")
    heads = "".join(f"<th style='text-align:left'>{escape(text)}</th>" for text in header)
    return f"<table><tr>{heads}</tr>{''.join(lines)}</table>"


def _cell(text: str) -> str:
    return f"<td style='text-align:left'>{escape(text)}</td>"
