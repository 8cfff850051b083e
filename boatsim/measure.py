"""What a measure is: it turns the log of a run into named numbers that norms.json holds beside the paper's."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from boatsim.base import Checked
from boatsim.recording import Recording


@dataclass(frozen=True)
class Measure(Checked):
    """Base of measures: `measure = { use = "arrival", x = 20.0 }` in a scenario makes one and asks it for its values.

    Numbers that people read are in degrees, their unit says so.
    """

    words: ClassVar[str] = ""  # one line for `boatsim list`
    units: ClassVar[Mapping[str, str]] = {}  # norm -> its unit

    def values(self, log: Recording) -> dict[str, float]:
        """Norms of a run; one that the run never got as far as is left out."""
        raise NotImplementedError
