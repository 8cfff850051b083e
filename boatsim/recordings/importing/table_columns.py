"""Numbers and units of the columns of a table."""

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from boatsim.recordings.importing.cells import Cells, column_of_cells
from boatsim.recordings.importing.coordinates import (
    HEMISPHERES,
    degrees_of_texts,
    kind_of_place,
)
from boatsim.recordings.importing.lost_points import with_lost_points
from boatsim.recordings.importing.missing_values import placeholder_rows
from boatsim.recordings.notes import unit_of

PER_SECOND = re.compile(r"(?:^|[_ ])(rad|deg|m)[_ ](?:per[_ ])?s(?:ec)?$")


def column_of_texts(name: str, cells: Sequence[str], separator: str) -> Cells:
    """Numbers of the text cells of a column; those of a place may have degrees and minutes."""
    found = with_lost_points(column_of_cells(cells, separator), cells)
    if kind_of_place(name) and found.unit.upper() in HEMISPHERES:
        sign = HEMISPHERES[found.unit.upper()]
        return replace(found, values=sign * found.values, unit="")
    if kind_of_place(name) and not np.isfinite(found.values).any():
        degrees = degrees_of_texts(cells)
        if degrees is not None:
            return Cells(degrees, unit="deg")
    return found


def without_placeholders(cells: Cells) -> Cells:
    """A column in which numbers that stand for missing values are empty, with a remark on each."""
    values, remarks = cells.values, list(cells.remarks)
    for number, rows in placeholder_rows(cells.values).items():
        values = np.where(rows, np.nan, values)
        count = int(rows.sum())
        what = "1 cell is" if count == 1 else f"{count} cells are"
        remarks.append(
            (
                f"{what} {number:g}, which stands for a missing value, and left empty",
                int(np.argmax(rows)),
            )
        )
    return replace(cells, values=values, remarks=tuple(remarks))


def unit_by_ending(name: str) -> str:
    """The unit by the end of a name; `yaw_rate_deg_s` is in deg/s."""
    per = PER_SECOND.search(name.lower())
    if per:
        return f"{per[1]}/s"
    return unit_of(name)
