"""The table of a campaign: Parquet, a row for each task in the order of their numbers; same rows, same bytes."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from boatsim.files import replacing

if TYPE_CHECKING:
    import pyarrow as pa

Columns = Mapping[str, Sequence[Any]]


def write(columns: Columns, units: Mapping[str, str], about: str, path: Path) -> None:
    """Columns of numbers, texts or truths, None where there is nothing; `about` goes along as `boatsim`.

    A column's unit stands in its field's metadata. Raises OSError.
    """
    import pyarrow as pa
    from pyarrow import parquet

    fields = [
        pa.field(n, _kind(values), metadata={"unit": units[n]} if n in units else None)
        for n, values in columns.items()
    ]
    arrays = [
        pa.array(values, field.type) for values, field in zip(columns.values(), fields, strict=True)
    ]
    made = pa.Table.from_arrays(arrays, schema=pa.schema(fields, {"boatsim": about}))
    with replacing(path) as temporary:
        parquet.write_table(made, temporary)


def _kind(values: Sequence[Any]) -> "pa.DataType":
    """Type of a column: that which holds all its values."""
    import pyarrow as pa

    there = {type(value) for value in values if value is not None}
    if there <= {bool} and there:
        return pa.bool_()
    if there == {int}:
        return pa.int64()
    return pa.float64() if there <= {int, float, bool} else pa.string()
