"""What a diagnosis hands to those who show it: the answer, and the curves behind it."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from boatsim.diagnosis.description import Written
from boatsim.diagnosis.free_runs import FreeRun
from boatsim.diagnosis.report.schema import Answer
from boatsim.physics.base import Array


@dataclass(frozen=True)
class Missing:
    """The force of a run that the vessel as written has no cause for, by axis, and what the patch leaves of it."""

    run: str  # name of the recording
    t: Array  # (N,) s
    force: dict[str, Array]  # "surge", "sway", "roll", "yaw" -> (N,)
    sd: dict[str, Array]  # standard deviation of `force`, (N,)
    unit: dict[str, str]  # "N" or "N m", by axis
    left: dict[str, Array]  # the same force under the patched vessel, (N,)


@dataclass(frozen=True)
class Findings:
    """A whole diagnosis, as the report shows it."""

    answer: Answer  # exactly what diagnosis.json holds
    vessel: str
    runs: tuple[str, ...]  # what was fitted
    held_out: tuple[str, ...]  # what was kept unseen
    held_out_note: str  # "the middle third of run_1 was kept unseen"
    missing: tuple[Missing, ...] = ()
    free_runs: tuple[FreeRun, ...] = ()  # on unseen data
    remarks: tuple[
        str, ...
    ] = ()  # what the data can not tell, and anything else a reader must know
    # recalibrated coefficient -> factor, sd
    coefficients: dict[str, tuple[float, float]] = field(default_factory=dict)
    extra_tables: tuple[tuple[str, list[str], list[list[str]]], ...] = ()  # title, header, rows
    # what a library entry says, by name; also "entry.parameter"
    words: dict[str, str] = field(default_factory=dict)
    described: tuple[Written, ...] = ()  # terms of described laws, with their curves
    steps: tuple[
        tuple[float, Mapping[str, float]], ...
    ] = ()  # commands of the next experiment from each time [s] on
    size: tuple[float, float] = (1.0, 0.3)  # [m] length and beam of the vessel, for its picture

    @property
    def patched(self) -> bool:
        """Whether the patched boat has anything that the recalibrated one has not."""
        return bool(self.answer["effects"]) or any(
            d["carries_over"] for d in self.answer["described"]
        )
