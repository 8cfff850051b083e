"""A diagnosis of recordings made in a test, and what must be said of it where the truth is
known."""

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

from boatsim.diagnosis import pipeline
from boatsim.recordings import table as recording
from boatsim.recordings.table import Recording


def diagnosed(
    runs: Sequence[Recording],
    folder: Path,
    vessel: str,
    library: Sequence[str] = (),
    horizon: float | None = None,
) -> dict[str, Any]:
    """The answer for runs written to files; the last one is held out."""
    files = [folder / f"{run.name}.csv" for run in runs]
    for file, run in zip(files, runs, strict=True):
        recording.write_csv(run, file)
    return pipeline.diagnose(
        files[:-1], files[-1:], vessel, library=library, horizon=horizon
    ).findings.answer


def named(
    answer: Mapping[str, Any],
    name: str,
    true: Mapping[str, float],
    more: bool = False,
    also: Collection[str] = (),
) -> None:
    """This effect and no other, none tied with it; every true value within 3.5 sd, and known to 30
    %.

    With `more` there is a force besides that is no effect's, and the answer must say so. Effects
    of `also` may be named, too.
    """
    entries = {e["name"]: e for e in answer["effects"]}
    assert {name} <= set(entries) <= {name, *also} and not entries[name]["tied_with"]
    assert answer["unknown"]["flag"] == more and (more or answer["verdict"] == "named"), answer[
        "sentence"
    ]
    found = entries[name]["parameters"]
    for key, value in true.items():
        assert abs(found[key]["value"] - value) < 3.5 * found[key]["sd"] < 3.5 * 0.3 * abs(value), (
            key,
            found[key],
        )


def nothing_missing(answer: Mapping[str, Any]) -> None:
    """No effect, none outside the library."""
    assert answer["verdict"] == "nothing_missing" and not answer["effects"], answer["sentence"]
