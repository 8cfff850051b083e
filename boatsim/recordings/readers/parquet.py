"""Parquet: columns of numbers; nulls are empty cells."""

from pathlib import Path

from boatsim.recordings.raw import Raw, no_twins, numbers, refuse


def read(path: Path) -> Raw:
    """Columns of a Parquet file; nulls are empty cells."""
    from pyarrow import ArrowException, parquet  # 60 ms, comes with rerun-sdk

    try:
        table = parquet.read_table(path)
    except (ArrowException, OSError, ValueError) as error:
        raise refuse(path, f"is not a Parquet file ({error})") from error
    raw = Raw(path, {}, range(1, table.num_rows + 1))
    no_twins(path, table.column_names)
    for name, column in zip(table.column_names, table.columns, strict=True):
        raw.columns[name] = numbers(raw, name, ["" if cell is None else cell for cell in column.to_pylist()])
    return raw
