"""The vessel of the cases: the published one, patched until nothing more is identified."""

from functools import cached_property
from itertools import chain
from pathlib import Path

import tomlkit

from boatsim.diagnosis import pipeline
from boatsim.diagnosis.candidates import name_without_prefixes
from boatsim.diagnosis.output import patched_vessel
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.physics.base import CoefficientRelease
from boatsim.physics.content import load_class
from boatsim.physics.vessel import Vessel, load_vessel
from validation.real.common import by_name, effects_of, names_of, values_of
from validation.real.concealed.alterations import Alteration, unaltered
from validation.real.concealed.cases import Case, Study, removal_cases
from validation.real.concealed.judging import (
    Cause,
    Verdict,
    accepted_names,
    identified_names,
    judge,
)

MAX_ROUNDS = 3  # of patching a vessel with what is still identified with it


def causes_of(diagnosis: Diagnosis) -> list[Cause]:
    """Return the identified effects of an answer with their sizes."""
    return [Cause(effect["name"], values_of(effect)) for effect in effects_of(diagnosis)]


class PatchedVesselStudy:
    """The effects missing in a set's unaltered recordings, found once, and the patched vessel."""

    def __init__(self, study: Study, folder: Path) -> None:
        """Diagnose and patch the vessel of a set.

        Args:
            study: The set.
            folder: Folder of the patched vessels.
        """
        self.study, self.folder = study, folder / study.name
        self.folder.mkdir(parents=True, exist_ok=True)
        self.rounds = [self._diagnose(None)]
        while True:
            self.file = self._write(self.rounds[-1], f"patched_{len(self.rounds)}.toml")
            self.before = self._diagnose(self.file)
            if not self.before.ranking.named or len(self.rounds) == MAX_ROUNDS:
                break
            self.rounds.append(self.before)

    def _diagnose(self, file: Path | None, alter: Alteration = unaltered) -> Diagnosis:
        """Return the diagnosis of altered recordings with a vessel's file, or the published one."""
        vessel = str(file) if file else None
        return pipeline.diagnose_loaded(self.study.open(vessel, alter))

    @cached_property
    def vessel(self) -> Vessel:
        """The vessel of the cases."""
        return load_vessel(str(self.file))

    @property
    def found(self) -> list[Cause]:
        """Effects of the patched vessel; the last sizes of one that was found in several rounds."""
        causes = chain.from_iterable(map(causes_of, self.rounds))
        return list(by_name(list(causes)).values())

    def cases(self) -> list[Case]:
        """Return the cases of the set, and those with one identified effect removed."""
        removable = [cause for cause in self.found if self._is_removable(cause.name)]
        return [*self.study.cases(self.vessel), *removal_cases(removable)]

    def verdict(self, case: Case) -> Verdict:
        """Return the verdict of one case."""
        if case.plain:
            accepted = accepted_names(case.truth)
            others = [c for c in causes_of(self.rounds[0]) if c.name not in accepted]
            altered = self._diagnose(None, case.alter)
            return judge(altered, case.truth, self.rounds[0], others)
        file = self.file
        if case.without:
            file = self.without(case.without)
        return judge(self._diagnose(file, case.alter), case.truth, self.before)

    def without(self, name: str) -> Path:
        """Write the patched vessel without one of its identified effects; return the file."""
        document = tomlkit.parse(self.file.read_text(encoding="utf-8"))
        gone = [found for found in document["found"] if name_without_prefixes(found) == name]
        for found in gone:
            blocks = document["effect"]
            names = [block.get("name", block["use"]) for block in blocks]
            blocks.remove(blocks[names.index(found)])
            document["found"].remove(found)
        if not gone:
            self._restore(document, name)
        path = self.folder / f"without_{name}.toml"
        path.write_text(tomlkit.dumps(document), encoding="utf-8")
        return path

    def _rounds_with(self, name: str) -> list[Diagnosis]:
        return [d for d in self.rounds if name in identified_names(d)]

    def _is_removable(self, name: str) -> bool:
        """Whether an effect is in the vessel file, or its changes come from one round only."""
        return len(self._rounds_with(name)) == 1 or name in map(
            name_without_prefixes, self.vessel.found
        )

    def _restore(self, document: tomlkit.TOMLDocument, name: str) -> None:
        """Restore the numbers that a release changed."""
        release = load_class("effect", name)
        fit = self._rounds_with(name)[0].ranking.best
        settings = {}
        for f in fit.free:
            if f.effect == name and not f.relative:
                settings[f.name] = fit.value(name, f.name)[0]
        effect = release.from_settings(settings)
        assert isinstance(effect, CoefficientRelease)
        names = names_of(self.vessel.effects)
        for change in effect.changes(self.vessel):
            if change.how == "sets":
                raise ValueError(f"{name}: the numbers before the change are not known")
            value = getattr(effect, change.parameter)
            undone = 1.0 / value if change.how == "scales" else -value
            if change.owner == "body":
                table, owner = document["body"], self.vessel.body
            else:
                place = names.index(change.owner)
                table, owner = document["effect"][place], self.vessel.effects[place]
            table[change.key] = change.changed_value(float(getattr(owner, change.key)), undone)

    def _write(self, diagnosis: Diagnosis, name: str) -> Path:
        """Write the patched vessel of a diagnosis; return the file."""
        path = self.folder / name
        ranking = diagnosis.ranking
        patched_vessel.write_patched_vessel(
            diagnosis.problem, diagnosis.vessel, ranking.best, path, ranking.described_terms
        )
        return path
