"""Reader of Parquet: columns of numbers; nulls are empty cells."""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from boatsim.recordings.limits import check_free_memory, check_table_size
from boatsim.recordings.raw_table import Raw, check_unique_names, file_error, parse_numbers

if TYPE_CHECKING:
    from pyarrow import ChunkedArray
    from pyarrow.parquet import FileMetaData

MAX_CELL = 64  # characters of a text; no number is longer


def read(path: Path) -> Raw:
    """Return the table of a Parquet file; nulls are empty cells. Raises BadInput."""
    from pyarrow import ArrowException, parquet, types  # 60 ms, comes with rerun-sdk

    try:
        _check(path, parquet.read_metadata(path))
        fields = parquet.read_schema(path)
        check_unique_names(path, fields.names)
        texts = [f.name for f in fields if types.is_string(f.type) or types.is_binary(f.type)]
        flat = [f.name for f in fields if not types.is_nested(f.type)]
        # A dictionary holds a repeated text once
        table = parquet.read_table(path, columns=flat, read_dictionary=texts)
        raw = Raw(path, {}, range(1, table.num_rows + 1))
        for name in fields.names:
            if name not in flat:
                raw.columns[name] = np.full(table.num_rows, np.nan)
                raw.text[name] = (1, "a list or table")
        for name, column in zip(table.column_names, table.columns, strict=True):
            if types.is_integer(column.type) or types.is_floating(column.type):
                raw.columns[name] = np.array(
                    column.cast("float64", safe=False).to_numpy(), dtype=float
                )
            else:
                raw.columns[name] = parse_numbers(raw, name, _cells(column))
    except (ArrowException, OSError, ValueError, LookupError) as error:
        raise file_error(path, f"is not a Parquet file ({error})") from error
    return raw


def _check(path: Path, about: "FileMetaData") -> None:
    """Check the size by the metadata, for repeated values are compressed in the file.

    Raises BadInput.
    """
    check_table_size(path, about.num_columns)
    check_table_size(path, about.num_columns, about.num_rows * about.num_columns)
    groups = map(about.row_group, range(about.num_row_groups))
    check_free_memory(path, 2 * sum(group.total_byte_size for group in groups))


def _cells(column: "ChunkedArray") -> list[object]:
    """Cells of a column that is not a column of plain numbers.

    "" where empty, texts cut to the length of numbers.
    """
    cells: list[object] = []
    for chunk in column.chunks:
        if hasattr(chunk, "dictionary"):
            words = [str(word)[:MAX_CELL] for word in chunk.dictionary.to_pylist()]
            words.append("")  # for null
            cells += map(words.__getitem__, chunk.indices.fill_null(len(words) - 1).to_pylist())
        else:
            cells += map(_cell, chunk.to_pylist())
    return cells


def _cell(value: object) -> object:
    if value is None:
        return ""
    if isinstance(value, str | bytes):
        return str(value)[:MAX_CELL]
    return value
