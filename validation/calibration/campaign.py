"""The trials of a campaign: specified by seed and number, made, diagnosed, and recorded as JSON."""

import gzip
import json
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from rich.progress import Progress

from boatsim.diagnosis.config import DEFAULT, DecideConfig
from boatsim.diagnosis.open_set.log_signs import LogSigns
from boatsim.diagnosis.open_set.probability import (
    probability_beside_unknown,
    probability_of_true_cause,
)
from boatsim.errors import BadInput
from validation.calibration.unknown_causes import UNKNOWN
from validation.calibration.vessels import BOATS, PLANS
from validation.calibration.weights import recorded_features
from validation.practice.cause import Maker, Rng
from validation.practice.make import CALIBRATION, Trial, make_trial

# share of the trials of each kind
KINDS = {
    "none": 0.28,
    "single": 0.25,
    "pair": 0.08,
    "unknown": 0.24,
    "mixed": 0.09,  # a cause of the library and one outside it
    "several": 0.06,
}
KNOWN = {"single": 1, "pair": 2, "several": 3}  # number of causes of the library
ROUGH_SHARE = 0.4  # of trials whose vessel file is rough
FARTHEST = 1e5  # [m, s, N] beyond which a recorded value belongs to a simulation that diverges
CAPSIZED = np.pi / 2.0  # [rad] of roll or pitch
ROUGH = 0.2  # relative sd of its damping and thrust, which recording.toml states
# of trials whose single effect is diagnosed again with the effect removed from the candidates
REMOVED_SHARE = 0.3
OUTLIER_SHARE = 0.2  # of trials whose instruments have outliers
# share of the usual number of trials: six degrees of freedom, and a polynomial with forty
# coefficients, take longer
SLOW = {"otter": 0.12, "mariner": 0.6}
# with an unstated disturbance: largest level over the usual one, and largest number of weak causes
# outside the library, as every model of a real boat has errors of form
STRONGEST_DISTURBANCE = 10.0
MOST_BACKGROUND = 2
RECORD_FILES = "[SU]*_T*.json"

Record = dict[str, Any]


@dataclass(frozen=True)
class Job:
    """One trial of a campaign."""

    seed: int
    number: int
    unstated: bool = False  # whether the disturbance is larger than usual and not stated

    @property
    def name(self) -> str:
        """Name of its record."""
        return f"{'U' if self.unstated else 'S'}{self.seed}_T{self.number:05d}"

    def trial(self) -> Trial:
        """Return its specification, a function of seed and number alone."""
        rng = np.random.default_rng([self.seed, self.number, 4])
        weights = np.array([SLOW.get(vessel, 1.0) for vessel in PLANS])
        vessel = list(PLANS)[rng.choice(len(PLANS), p=weights / weights.sum())]
        kind = str(rng.choice(list(KINDS), p=list(KINDS.values())))
        plan = PLANS[vessel]
        known, unknown = plan.single, UNKNOWN[vessel]
        causes = sample(unknown, 1, rng) if kind == "unknown" else ()
        if kind in KNOWN:
            causes = sample(known, min(KNOWN[kind], len(known)), rng)
        if kind == "mixed":
            causes = sample(known, 1, rng) + sample(unknown, 1, rng)
        rough = bool(rng.random() < ROUGH_SHARE)
        trial = Trial(
            f"T{self.number:05d}_{vessel}",
            vessel,
            kind,
            concealed=plan.kept and bool(rng.random() < 0.5),
            outliers=bool(rng.random() < OUTLIER_SHARE),
            makers=causes,
            plan=plan,
            boat=BOATS[vessel],
            calibration=ROUGH if rough else CALIBRATION,
            stated=rough,
        )
        if not self.unstated:
            return trial
        background = int(rng.integers(MOST_BACKGROUND + 1))
        others = [maker for maker in unknown if maker not in causes]
        return replace(
            trial,
            makers=causes + sample(others, min(background, len(others)), rng),
            background=min(background, len(others)),
            disturbance=float(np.exp(rng.uniform(0.0, np.log(STRONGEST_DISTURBANCE)))),
            level_stated=False,
        )


def sample(makers: Sequence[Maker], count: int, rng: Rng) -> tuple[Maker, ...]:
    """Return different causes, sampled without replacement."""
    return tuple(makers[i] for i in rng.choice(len(makers), count, replace=False))


def run(out: Path, seed: int, count: int, jobs: int, unstated: bool = False) -> None:
    """Make and diagnose the trials that have no record yet.

    Args:
        out: Folder of the records.
        seed: Seed of the campaign.
        count: Number of trials.
        jobs: Number of processes.
        unstated: Whether the disturbance is larger than usual and not stated.
    """
    out.mkdir(parents=True, exist_ok=True)
    waiting = []
    for number in range(1, count + 1):
        job = Job(seed, number, unstated)
        if not record_file(out, job).is_file():
            waiting.append(job)
    if not waiting:
        return
    with ProcessPoolExecutor(jobs) as pool, Progress() as progress:
        task = progress.add_task("trials", total=len(waiting))
        futures = [pool.submit(record, out, job) for job in waiting]
        for future in as_completed(futures):
            future.result()
            progress.advance(task)


def record_file(out: Path, job: Job) -> Path:
    """Return the file with the record of a trial."""
    return out / f"{job.name}.json"


def records(out: Path, odds_beside_unknown: float | None = None) -> Iterator[Record]:
    """Yield recorded diagnoses in the order of their trials.

    Args:
        out: Folder of the records, or a file that `pack` wrote.
        odds_beside_unknown: Log odds added beside an unknown cause; None: those in use. Records are
            decided by it again, so that another value needs no new campaign.
    """
    config = DEFAULT.decide
    if odds_beside_unknown is not None:
        config = replace(config, odds_beside_unknown=odds_beside_unknown)
    for found in _recorded(out):
        yield decided_again(found, config)


def _recorded(out: Path) -> Iterator[Record]:
    """Yield diagnoses as they were recorded."""
    if out.is_file():
        with gzip.open(out, "rt", encoding="utf-8") as lines:
            yield from map(json.loads, lines)
        return
    for file in sorted(out.glob(RECORD_FILES)):
        yield from json.loads(file.read_text())


def pack(out: Path, packed: Path) -> None:
    """Write the recorded diagnoses of a folder into one compressed file, one in each line.

    Args:
        out: The folder.
        packed: The file, whose content depends on the records alone.
    """
    lines = [json.dumps(found) + "\n" for found in _recorded(out)]
    packed.write_bytes(gzip.compress("".join(lines).encode(), mtime=0))


def decided_again(record: Record, config: DecideConfig) -> Record:
    """Return a record whose effects have the probabilities and names of a given configuration."""
    signs = {one["name"]: one for one in record["signs"]["effects"] if not one["refines"]}
    of_log = LogSigns(**record["signs"]["log"])
    beside_unknown = record["unknown"]["flag"] and not of_log.estimated
    named, possible = [], []
    for effect in (*record["effects"], *record["also_possible"]):
        own = signs.get(effect["name"])
        if own is None:
            (named if effect in record["effects"] else possible).append(effect)
            continue
        found = recorded_features(own, of_log, config)
        probability = probability_of_true_cause(found, config)
        if beside_unknown:
            probability = probability_beside_unknown(probability, config)
        # the part of the effect itself among its look-alikes stays
        own_part = effect["probability"] / own["probability"] if own["probability"] else 0.0
        # an effect whose size the recordings do not determine is not confirmed
        confirmed = effect.get("confirmed", False) or effect in record["effects"]
        is_named = confirmed and probability >= config.least_probability
        tied = {"tied_with": own["tied_with"]}  # which an entry of a possible effect lacks
        stated = {**effect, **tied, "probability": probability * own_part}
        (named if is_named else possible).append(stated)
    return {**record, "effects": named, "also_possible": possible}


def record(out: Path, job: Job) -> None:
    """Make one trial, diagnose it, and write the records of its diagnoses."""
    trial = job.trial()
    found = []
    with tempfile.TemporaryDirectory() as folder:
        answer = make_trial(trial, job.seed, Path(folder))
        files = Path(folder) / trial.name
        if diverges(files):
            save(out, job, [])
            return
        try:
            first = diagnosed(files, trial, answer, ())
        except BadInput as error:  # for example a boat that nearly capsizes
            print(f"{job.name} is refused: {error}")
            save(out, job, [])
            return
        found.append(first)
        alike = look_alikes(answer, first)
        removes = np.random.default_rng([job.seed, job.number, 5]).random() < REMOVED_SHARE
        if trial.kind == "single" and answer["visible"] and alike and removes:
            found.append(diagnosed(files, trial, answer, alike))
    save(out, job, found)


def diverges(files: Path) -> bool:
    """Whether the simulated boat of a trial runs away or capsizes, so that it is no trial."""
    for file in sorted(files.glob("run_*.csv")):
        table = np.genfromtxt(file, delimiter=",", names=True)
        for name in table.dtype.names:
            farthest = CAPSIZED if name in ("phi_rad", "theta_rad") else FARTHEST
            if not np.all(np.abs(table[name]) < farthest):
                return True
    return False


def save(out: Path, job: Job, found: Sequence[Record]) -> None:
    """Write the records of a trial; an interrupted write leaves no file."""
    part = record_file(out, job).with_suffix(".part")
    part.write_text(json.dumps(found))
    part.replace(record_file(out, job))


def look_alikes(answer: Mapping[str, Any], found: Record) -> tuple[str, ...]:
    """Return the true effect of a trial with its equivalents and look-alikes.

    None are returned if the diagnosis did not name it.
    """
    truth = [effect["name"] for effect in answer["effects"]]
    same = set(truth)
    for name in truth:
        same.update(answer.get("equivalent", {}).get(name, []))
    for effect in found["effects"]:
        if effect["name"] in same:
            return tuple(sorted(same | set(effect["tied_with"])))
    return ()


def causes_of(answer: Mapping[str, Any], background: int) -> list[str]:
    """Return the causes of a trial, without those of the background.

    Args:
        answer: Its answer.json.
        background: Number of weak causes outside the library, its last ones.
    """
    names = [effect["name"] for effect in answer["effects"]]
    return names[: len(names) - background]


def diagnosed(
    files: Path, trial: Trial, answer: Mapping[str, Any], without: Sequence[str]
) -> Record:
    """Diagnose a trial and return its record.

    Args:
        files: Folder of the trial.
        trial: Its specification.
        answer: Its answer.json.
        without: Candidates that are excluded.
    """
    from boatsim.diagnosis import pipeline

    runs = [files / "run_1.csv", files / "run_2.csv"]
    # the program is compiled once for all recordings of a vessel, whatever is excluded
    diagnosis = pipeline.diagnose(runs, [files / "run_3.csv"], trial.vessel, without=without)
    given = dict(diagnosis.findings.answer)
    kind = trial.kind
    if without:
        kind = "removed"
    kept = (
        "verdict",
        "effects",
        "unknown",
        "signs",
        "fit",
        "seconds",
        "refined",
        "also_possible",
    )
    return {
        "trial": trial.name,
        "vessel": trial.vessel,
        "kind": kind,
        "concealed": trial.concealed,
        "rough": trial.stated,
        "disturbance": trial.disturbance,
        "background": trial.background,
        "causes": causes_of(answer, trial.background),
        "equivalent": answer.get("equivalent", {}),
        "visible": answer.get("visible", False),
        "borderline": answer.get("borderline", False),
        "gains": answer.get("marginal_gain_nats", []),
        "reference": answer.get("reference_position_rms_m", {}),
        **{key: given[key] for key in kept},
    }
