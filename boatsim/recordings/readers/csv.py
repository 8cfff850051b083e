"""CSV: comma separated, a point in decimal numbers, one header row."""

import csv
from pathlib import Path

from boatsim.recordings.limits import LONGEST_HEADER, check_shape
from boatsim.recordings.raw import Raw, no_twins, numbers, refuse


def read(path: Path) -> Raw:
    """Comma separated, one header row; blank lines are skipped."""
    header, rows, lines = _cells(path)
    for row, cells in zip(lines, rows, strict=True):
        if len(cells) != len(header):
            raise refuse(path, f"has {len(cells)} cells; the header has {len(header)} columns", row)
    raw = Raw(path, {}, lines)
    by_column = list(zip(*rows, strict=True)) or [()] * len(header)
    for name, column in zip(header, by_column, strict=True):
        raw.columns[name] = numbers(raw, name, column)
    return raw


def _cells(path: Path) -> tuple[list[str], list[list[str]], list[int]]:
    """Header, rows of cells, line number of each row."""
    with path.open("rb") as file:
        first = file.readline(LONGEST_HEADER + 1)
    if len(first) > LONGEST_HEADER:
        raise refuse(path, f"the first line has more than {LONGEST_HEADER} bytes", 1)
    check_shape(path, first.count(b",") + 1)
    try:
        text = path.read_bytes().decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise refuse(path, "is not a text file; a recording is CSV, Parquet or the .rrd of a run") from error
    if "\0" in text:
        raise refuse(path, "is not a text file; a recording is CSV, Parquet or the .rrd of a run")
    reader = csv.reader(text.splitlines())
    rows, lines = [], []
    try:
        for cells in reader:
            if any(cells):
                rows.append(cells)
                lines.append(reader.line_num)
    except csv.Error as error:
        raise refuse(path, f"is not CSV ({error})", reader.line_num) from error
    if not rows:
        raise refuse(path, "is empty")
    header = [name.strip() for name in rows[0]]
    for character, called in ((";", "semicolons"), ("\t", "tabs")):
        if len(header) == 1 and character in header[0]:
            raise refuse(path, f"is separated by {called}; allowed are commas, with a point in decimal numbers", 1)
    no_twins(path, header)
    return header, rows[1:], lines[1:]
