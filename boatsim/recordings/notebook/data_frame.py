"""Arrow tables as data frames of pandas, with the units of the columns."""

from typing import TYPE_CHECKING

from boatsim.errors import BadInput
from boatsim.recordings.notebook.arrow import UNIT

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa

NEEDED = 'to_pandas needs pandas: pip install "boatsim[notebook]"'


def data_frame(table: "pa.Table") -> "pd.DataFrame":
    """Return an Arrow table as a data frame with the same columns.

    Args:
        table: The table; nulls become nan.

    Returns:
        The data frame. `attrs` has the metadata of the table, and in `attrs["units"]` the unit of
        each column that has one.

    Raises:
        BadInput: If pandas is not installed.
    """
    try:
        import pandas  # noqa: F401  # pyarrow imports it by itself
    except ImportError:
        raise BadInput(NEEDED) from None
    frame = table.to_pandas()
    units = {}
    for field in table.schema:
        unit = (field.metadata or {}).get(UNIT, b"").decode()
        if unit:
            units[field.name] = unit
    for key, text in (table.schema.metadata or {}).items():
        frame.attrs[key.decode()] = text.decode()
    frame.attrs["units"] = units
    return frame
