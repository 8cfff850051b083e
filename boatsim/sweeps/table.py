"""Table of a campaign as Parquet, a row for each task; equal rows give equal bytes."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from boatsim.files import replace_file

if TYPE_CHECKING:
    import pyarrow as pa

Columns = Mapping[str, Sequence[Any]]


def write_parquet(columns: Columns, units: Mapping[str, str], about: str, path: Path) -> None:
    """Write the table of a campaign, such as a sweep, to a Parquet file.

    Args:
        columns: Columns of numbers, texts or truth values; None where a value is missing.
        units: Units of columns, stored in the metadata of their fields.
        about: Definition of the campaign, stored as metadata `boatsim`.
        path: The file.

    Raises:
        OSError: The file cannot be written.
    """
    import pyarrow as pa
    from pyarrow import parquet

    fields = []
    arrays = []
    for name, values in columns.items():
        metadata = None
        if name in units:
            metadata = {"unit": units[name]}
        field = pa.field(name, _type_of(values), metadata=metadata)
        fields.append(field)
        arrays.append(pa.array(values, field.type))
    table = pa.Table.from_arrays(arrays, schema=pa.schema(fields, {"boatsim": about}))
    with replace_file(path) as temporary:
        parquet.write_table(table, temporary)


def _type_of(values: Sequence[Any]) -> "pa.DataType":
    """Type that holds all values of a column."""
    import pyarrow as pa

    types = set(map(type, values)) - {type(None)}
    if types == {bool}:
        return pa.bool_()
    if types == {int}:
        return pa.int64()
    if types <= {int, float, bool}:
        return pa.float64()
    return pa.string()
