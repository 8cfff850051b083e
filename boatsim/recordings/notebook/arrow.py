"""Recordings as Arrow tables, which pandas, polars, DuckDB and others read without a copy."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from boatsim.physics.base import Array
from boatsim.recordings.notes import unit_of

if TYPE_CHECKING:
    import pyarrow as pa

UNIT = b"unit"  # key of the metadata of a column


def signal_table(t: Array, signals: Mapping[str, Array], metadata: Mapping[str, str]) -> "pa.Table":
    """Return signals as an Arrow table with the columns of their file, `t_s` first.

    Args:
        t: Times (N,) [s].
        signals: Name with the unit as suffix -> values (N,); nan becomes null.
        metadata: Texts on the whole table, such as the name of the vessel.

    Returns:
        Table of float64 in SI units and radians. The metadata of each column has its `unit`.
    """
    import pyarrow as pa  # 60 ms, comes with rerun-sdk

    fields, columns = [], []
    for name, values in {"t_s": t, **signals}.items():
        fields.append(pa.field(name, pa.float64(), metadata={UNIT: unit_of(name).encode()}))
        columns.append(pa.array(values, pa.float64(), from_pandas=True))
    encoded = {key.encode(): text.encode() for key, text in metadata.items()}
    return pa.Table.from_arrays(columns, schema=pa.schema(fields, metadata=encoded))
