"""Parquet: columns of numbers; nulls are empty cells."""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from boatsim.recordings.limits import check_memory, check_shape
from boatsim.recordings.raw_table import Raw, no_twins, numbers, refuse

if TYPE_CHECKING:
    from pyarrow import ChunkedArray
    from pyarrow.parquet import FileMetaData

LONGEST_CELL = 64  # characters of a text; no number has more


def read(path: Path) -> Raw:
    """Columns of a Parquet file; nulls are empty cells."""
    from pyarrow import ArrowException, parquet, types  # 60 ms, comes with rerun-sdk

    try:
        _check(path, parquet.read_metadata(path))
        fields = parquet.read_schema(path)
        no_twins(path, fields.names)
        texts = [f.name for f in fields if types.is_string(f.type) or types.is_binary(f.type)]
        flat = [f.name for f in fields if not types.is_nested(f.type)]
        table = parquet.read_table(
            path, columns=flat, read_dictionary=texts
        )  # a text that repeats stays one
        raw = Raw(path, {}, range(1, table.num_rows + 1))
        for name in (n for n in fields.names if n not in flat):
            raw.columns[name], raw.text[name] = (
                np.full(table.num_rows, np.nan),
                (1, "a list or table"),
            )
        for name, column in zip(table.column_names, table.columns, strict=True):
            if types.is_integer(column.type) or types.is_floating(column.type):
                raw.columns[name] = np.array(
                    column.cast("float64", safe=False).to_numpy(), dtype=float
                )
            else:
                raw.columns[name] = numbers(
                    raw, name, ["" if cell is None else cell for cell in _cells(column)]
                )
    except (ArrowException, OSError, ValueError, LookupError) as error:
        raise refuse(path, f"is not a Parquet file ({error})") from error
    return raw


def _check(path: Path, about: "FileMetaData") -> None:
    """Refuse, by what the file says of itself, what is larger than it looks: runs of one value take no room in it."""
    check_shape(path, about.num_columns)
    check_shape(path, about.num_columns, about.num_rows * about.num_columns)
    check_memory(
        path, 2 * sum(about.row_group(i).total_byte_size for i in range(about.num_row_groups))
    )


def _cells(column: "ChunkedArray") -> list[object]:
    """Cells of a column that is no column of plain numbers, texts cut to what a number may have."""
    found: list[object] = []
    for chunk in column.chunks:
        if not hasattr(chunk, "dictionary"):
            found += [
                str(cell)[:LONGEST_CELL] if isinstance(cell, str | bytes) else cell
                for cell in chunk.to_pylist()
            ]
            continue
        words = [str(word)[:LONGEST_CELL] for word in chunk.dictionary.to_pylist()]
        found += [None if at is None else words[at] for at in chunk.indices.to_pylist()]
    return found
