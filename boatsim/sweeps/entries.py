"""Forms of the journal's entries: results of runs and of diagnoses."""

from typing import Self

from pydantic import ConfigDict, Field, model_validator

from boatsim.files import Table


class AnyEntry(Table):
    """Result of a task of a campaign, of whatever kind.

    Attributes:
        run: Number of the task.
        failure: Why it failed; None if it did not.
    """

    model_config = ConfigDict(extra="allow", frozen=True, allow_inf_nan=False)

    run: int = Field(ge=0)
    failure: str | None


class RunEntry(AnyEntry):
    """Result of a run of a sweep.

    Attributes:
        met: Whether all regression bands are met; None where there is none.
        norms: Metric -> value and unit.
    """

    met: bool | None = None
    norms: dict[str, tuple[float | None, str]] = {}


class DiagnosisEntry(AnyEntry):
    """Result of the diagnosis of one recording.

    Attributes:
        verdict: Verdict of the diagnosis.
        causes: Names of the identified effects.
        values: Parameter, or parameter with " sd" -> value and unit.
        rms: Error and model -> value on held-out data.
    """

    verdict: str | None = None
    causes: list[str] = []
    values: dict[str, tuple[float, str]] = {}
    rms: dict[str, float | None] = {}

    @model_validator(mode="after")
    def _check_complete(self) -> Self:
        if self.failure is None:
            for key in ("verdict", "causes", "values"):
                if key not in self.model_fields_set:
                    raise ValueError(f"{key} is missing")
        return self
