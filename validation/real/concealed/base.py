"""The vessel that cases begin with: the published one, patched until nothing is named of the unaltered recordings."""

from functools import cached_property
from pathlib import Path

import tomlkit

from boatsim.diagnosis import pipeline
from boatsim.diagnosis.candidates import called
from boatsim.diagnosis.loading import Loaded
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.diagnosis.report import patched_vessel
from boatsim.physics.base import Release
from boatsim.physics.content import load_class
from boatsim.physics.vessel import Vessel, load
from validation.real.concealed.alterations import unaltered
from validation.real.concealed.cases import Case, Laid, Study, taken_out
from validation.real.concealed.judging import Cause, Verdict, judged, meant

ROUNDS = 3  # of patching a vessel with what is still named with it


def diagnosed(laid: Laid) -> Diagnosis:
    """What the vessel leaves out of some recordings."""
    boats = {r.path: laid.vessel for r in (*laid.fitted, *laid.held_out)}
    return pipeline.diagnose_loaded(Loaded(laid.fitted, laid.held_out, boats, "one recording"))


def causes_of(found: Diagnosis) -> list[Cause]:
    """The effects that an answer stands for, with their sizes."""
    effects = found.findings.answer["effects"]
    return [Cause(e["name"], {k: p["value"] for k, p in e["parameters"].items()}) for e in effects]


class Patched:
    """What a set's vessel lacks by its unaltered recordings, found once; with it the vessel of the cases."""

    def __init__(self, study: Study, folder: Path) -> None:
        self.study, self.folder = study, folder / study.name
        self.folder.mkdir(parents=True, exist_ok=True)
        self.rounds = [diagnosed(study.open(None, unaltered))]
        while True:
            self.file = self._written(self.rounds[-1], f"patched_{len(self.rounds)}.toml")
            self.before = diagnosed(study.open(str(self.file), unaltered))
            if not self.before.ranking.named or len(self.rounds) == ROUNDS:
                break
            self.rounds.append(self.before)

    @cached_property
    def vessel(self) -> Vessel:
        """That of the cases."""
        return load(str(self.file))

    @property
    def found(self) -> list[Cause]:
        """The effects that it was given, with their sizes; of one found in several rounds the last."""
        return list({c.name: c for found in self.rounds for c in causes_of(found)}.values())

    def cases(self) -> list[Case]:
        """Those of the set, and each effect found taken out again."""
        return [
            *self.study.cases(self.vessel),
            *taken_out(self.vessel, [c for c in self.found if self._there(c.name)]),
        ]

    def verdict(self, case: Case) -> Verdict:
        """Of one case."""
        if case.plain:
            beside = [c for c in causes_of(self.rounds[0]) if c.name not in meant(case.truth)]
            return judged(
                diagnosed(self.study.open(None, case.alter)), case.truth, self.rounds[0], beside
            )
        file = self.without(case.without) if case.without else self.file
        return judged(diagnosed(self.study.open(str(file), case.alter)), case.truth, self.before)

    def without(self, name: str) -> Path:
        """The patched vessel with everything that was found but one effect."""
        document = tomlkit.parse(self.file.read_text(encoding="utf-8"))
        gone = [n for n in document["found"] if called(n) == name]
        for one in gone:
            blocks = document["effect"]
            blocks.remove(next(b for b in blocks if b.get("name", b["use"]) == one))
            document["found"].remove(one)
        if not gone:
            self._restore(document, name)
        path = self.folder / f"without_{name}.toml"
        path.write_text(tomlkit.dumps(document), encoding="utf-8")
        return path

    def _there(self, name: str) -> bool:
        """Whether an effect can be taken out: it stands in the file, or a release of numbers was found in one round."""
        times = sum(c.name == name for found in self.rounds for c in causes_of(found))
        return times == 1 or name in {called(n) for n in self.vessel.found}

    def _restore(self, document: tomlkit.TOMLDocument, name: str) -> None:
        """Put numbers that a release changed back to what they were."""
        release = load_class("effect", name)
        fit = next(f.ranking.best for f in self.rounds if name in {c.name for c in causes_of(f)})
        fitted = [f.name for f in fit.free if f.effect == name and not f.relative]
        made = release.from_settings({n: fit.value(name, n)[0] for n in fitted})
        assert isinstance(made, Release)
        for change in made.changes(self.vessel):
            if change.how == "sets":
                raise ValueError(f"{name}: what its numbers were is not kept")
            value = getattr(made, change.parameter)
            undone = 1.0 / value if change.how == "scales" else -value
            place = (
                [e.name for e in self.vessel.effects].index(change.owner)
                if change.owner != "body"
                else -1
            )
            table = document["body"] if place < 0 else document["effect"][place]
            owner = self.vessel.body if place < 0 else self.vessel.effects[place]
            table[change.key] = change.of(float(getattr(owner, change.key)), undone)

    def _written(self, found: Diagnosis, name: str) -> Path:
        """A diagnosis as a vessel's file."""
        path = self.folder / name
        patched_vessel.write(
            found.problem, found.vessel, found.ranking.best, path, found.ranking.laws
        )
        return path
