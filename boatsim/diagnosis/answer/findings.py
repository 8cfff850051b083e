"""Findings: the result of a diagnosis that the report reads, the answer and its curves."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from boatsim.diagnosis.answer.schema import Answer
from boatsim.diagnosis.config import DEFAULT, settings_by_name
from boatsim.diagnosis.description import FittedTerm
from boatsim.diagnosis.free_runs import FreeRun
from boatsim.physics.base import Array


def setting_of(answer: Answer, name: str) -> float:
    """Return the value of a numerical setting of the diagnosis that an answer reports.

    Args:
        answer: Content of diagnosis.json; one without settings has the default ones.
        name: Dotted name, such as "select.alike".
    """
    value = answer.get("config", {}).get(name, settings_by_name(DEFAULT)[name])
    assert not isinstance(value, list)
    return float(value)


@dataclass(frozen=True)
class MissingForceCurve:
    """The force over time in a recording that the vessel model does not explain, for the report.

    Attributes:
        run: Name of the recording.
        t: Times (N,) [s].
        force: Force that the vessel as written lacks (N,) [N, N m] by axis, such as "surge".
        sd: Its standard deviation (N,) [N, N m] by axis.
        unit: "N" or "N m" by axis.
        left: Force that the patched vessel still lacks (N,) [N, N m] by axis.
    """

    run: str
    t: Array
    force: dict[str, Array]
    sd: dict[str, Array]
    unit: dict[str, str]
    left: dict[str, Array]


@dataclass(frozen=True)
class Findings:
    """All results of a diagnosis that the report shows: content of diagnosis.json and its curves.

    Attributes:
        answer: Content of diagnosis.json.
        vessel: Name of the vessel.
        runs: Names of the fitted recordings.
        held_out: Names of the held-out recordings.
        held_out_note: Words that state what was held out.
        missing: Missing force of each recording.
        free_runs: Free runs over the held-out recordings.
        remarks: Sentences on what the recordings cannot show.
        coefficients: Factor on the value in the vessel file, and its standard deviation, of each
            coefficient of the retuned vessel.
        extra_tables: Further tables: title, header, rows.
        words: Meaning of each effect, by name, and of its parameters, by "effect.parameter".
        described: Terms of the formulas, with their curves.
        steps: Commands of the next experiment: the time [s] from which they hold, value by name.
        size: Length and beam of the vessel [m].
        names: Names of the recordings by the paths of their files.
        corrected_coefficients: As `coefficients`, of the corrected vessel.
        further_gains: Evidence [nats] that each candidate gains on top of the identified effects.
        own_effects: Names of candidates that the vessel has already, with numbers of its own.
    """

    answer: Answer
    vessel: str
    runs: tuple[str, ...]
    held_out: tuple[str, ...]
    held_out_note: str
    missing: tuple[MissingForceCurve, ...] = ()
    free_runs: tuple[FreeRun, ...] = ()
    remarks: tuple[str, ...] = ()
    coefficients: dict[str, tuple[float, float]] = field(default_factory=dict)
    extra_tables: tuple[tuple[str, list[str], list[list[str]]], ...] = ()
    words: dict[str, str] = field(default_factory=dict)
    described: tuple[FittedTerm, ...] = ()
    steps: tuple[tuple[float, Mapping[str, float]], ...] = ()
    size: tuple[float, float] = (1.0, 0.3)
    names: Mapping[str, str] = field(default_factory=dict)
    corrected_coefficients: dict[str, tuple[float, float]] = field(default_factory=dict)
    further_gains: Mapping[str, float] = field(default_factory=dict)
    own_effects: frozenset[str] = frozenset()

    @property
    def has_added_effects(self) -> bool:
        """Whether the patched vessel has any effect in addition to those of the vessel file.

        Effects that are only possible, or that were added for better simulations, count too.
        """
        if self.answer["effects"] or self.answer.get("added"):
            return True
        if any(entry.get("in_patch") for entry in self.answer.get("also_possible", ())):
            return True
        for entry in self.answer.get("refined", ()):
            if "parameters" in entry:  # of an effect, not of a coefficient
                return True
        return any(law["carries_over"] for law in self.answer["described"])

    def recording_name(self, path: str) -> str:
        """Return the name of a recording that is given by the path of its file."""
        return self.names.get(path, path)

    def setting(self, name: str) -> float:
        """Return the value of a setting that the diagnosis used, by its name.

        An example of a name is "select.alike".
        """
        return setting_of(self.answer, name)
