"""False names with further abilities: `python -m validation.calibration.abilities --out DIR`.

The campaign of `validation.calibration` has planar boats with poses and commands. Candidates and
checks that need groups of recordings, a craft without water, more than two drives, recorded
velocities, a measured wave or torque, bearings, a kept place, or a logged force are not tested
there. Each trial here is one of the bodies in `bodies/` with two fitted runs and a held-out one.
Nothing is missing in its vessel file: only ambient forces, noise, and damping and thrust that
differ within the stated uncertainty. Every name is therefore a false one.

The motion is integrated from formulas in earth-fixed and body axes, without boatsim. Each trial
writes one JSON file; an interrupted campaign goes on where it stopped.
"""

import argparse
import json
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import tomlkit

from boatsim.diagnosis import pipeline
from boatsim.diagnosis.answer.schema import Answer
from boatsim.errors import BadInput
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording, write_csv
from validation.calibration.bodies.body import Array, Body, Rng
from validation.calibration.bodies.bucket_jet import bucket_jet
from validation.calibration.bodies.clipped_orders import clipped_orders
from validation.calibration.bodies.driven_pendulum import driven_pendulum
from validation.calibration.bodies.four_thrusters import four_thrusters
from validation.calibration.bodies.guided_section import guided_section
from validation.calibration.bodies.heaving_drives import heaving_drives
from validation.calibration.bodies.hovercraft import hovercraft
from validation.calibration.bodies.kept_place import kept_place
from validation.calibration.bodies.rudder_ship import rudder_ship
from validation.calibration.bodies.turning_drives import turning_drives
from validation.calibration.table import share

CALIBRATION = 0.03  # relative sd of damping and thrust about the vessel file
RUNS = 3
BODIES = {
    make.__name__: make
    for make in (
        hovercraft,
        four_thrusters,
        guided_section,
        kept_place,
        clipped_orders,
        driven_pendulum,
        turning_drives,
        heaving_drives,
        bucket_jet,
        rudder_ship,
    )
}


def write_trial(body: Body, rng: Rng, folder: Path) -> list[Path]:
    """Write the runs of a trial with their notes, and return their files.

    The first run belongs to another group, such as a day, than the others.
    """
    vessel = body.vessel.save(folder / body.vessel.name).file
    factors = 1.0 + CALIBRATION * rng.standard_normal(body.coefficients)
    files = []
    runs: dict[str, object] = {}
    for i in range(RUNS):
        name = f"run_{i + 1}"
        files.append(folder / f"{name}.csv")
        recording = Recording(name, body.times, body.run(rng, factors))
        write_csv(without_gap(recording, body.longest_gap, rng), files[-1])
        runs[name] = {"group": ["first" if i == 0 else "second"]}
    kinds = sorted(pipeline_kinds(body.vessel))
    notes: dict[str, object] = {"vessel": str(vessel), "noise": dict(body.noise)}
    notes["coefficient_uncertainty"] = dict.fromkeys(kinds, CALIBRATION)
    notes["runs"] = runs
    (folder / "recording.toml").write_text(tomlkit.dumps(notes), encoding="utf-8")
    return files


def without_gap(recording: Recording, longest: float, rng: Rng) -> Recording:
    """Return a recording in which the rows of a random time, up to the longest [s], are missing."""
    if not longest:
        return recording
    begin = rng.uniform(0.2, 0.8) * recording.t[-1]
    kept: Array = np.abs(recording.t - begin) > 0.5 * rng.uniform(0.0, longest)
    signals = {name: values[kept] for name, values in recording.signals.items()}
    return Recording(recording.name, recording.t[kept], signals)


def pipeline_kinds(vessel: Vessel) -> set[str]:
    """Return the kinds of coefficients that differ from the file: damping and thrust."""
    kinds = set()
    for effect in vessel.effects:
        for param in type(effect).params().values():
            if param.calibrates in ("damping", "thrust"):
                kinds.add(param.calibrates)
    return kinds


def record(out: Path, seed: int, number: int, bodies: Sequence[str]) -> None:
    """Make a trial of one of the bodies, in turns, diagnose it, and write its record."""
    file = out / f"S{seed}_T{number:05d}.json"
    if file.is_file():
        return
    kind = bodies[number % len(bodies)]
    rng = np.random.default_rng([seed, number])
    start = time.process_time()
    with tempfile.TemporaryDirectory() as name:
        files = write_trial(BODIES[kind](), rng, Path(name))
        try:
            diagnosis = pipeline.diagnose(files[:2], files[2:])
            found = answer_record(diagnosis.findings.answer)
        except BadInput as error:
            found = {"refused": str(error)}
    found |= {"kind": kind, "cpu_s": time.process_time() - start}
    part = file.with_suffix(".part")
    part.write_text(json.dumps(found), encoding="utf-8")
    part.replace(file)


def answer_record(answer: Answer) -> dict[str, object]:
    """Return what is kept of an answer."""
    return {
        "candidates": len(answer["tried"]),
        "effects": [[e["name"], e["probability"]] for e in answer["effects"]],
        "possible": [[e["name"], e["probability"]] for e in answer["also_possible"]],
        "unknown": answer["unknown"]["flag"],
        "log": [[entry["name"], entry["kind"]] for entry in answer["log"]],
    }


def print_rates(out: Path) -> None:
    """Print the shares of logs that were refused, or got a name, an unknown cause, or a finding."""
    by_kind: dict[str, list[dict[str, object]]] = {}
    for file in sorted(out.glob("S*_T*.json")):
        found = json.loads(file.read_text(encoding="utf-8"))
        by_kind.setdefault(found["kind"], []).append(found)
    everything = [found for some in by_kind.values() for found in some]
    for kind, some in (*by_kind.items(), ("all", everything)):
        read = [found for found in some if "refused" not in found]
        print(f"{kind}: {len(some)} trials, {len(some) - len(read)} of them refused")
        some = read
        print(f"  with a name       {share([bool(found['effects']) for found in some])}")
        print(f"  called unknown    {share([bool(found['unknown']) for found in some])}")
        print(f"  a finding of the log {share([bool(found['log']) for found in some])}")
    for what in ("effects", "log"):
        names = Counter[str]()
        for found in everything:
            entries = found.get(what, [])
            assert isinstance(entries, list)
            names.update(entry[0] for entry in entries)
        for name, count in names.most_common():
            print(f"  {count} times: {name}")


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--out", type=Path, required=True, help="folder of the records")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--trials", type=int, default=1000)
    parser.add_argument(
        "--bodies", nargs="+", choices=list(BODIES), default=list(BODIES), help="default: all"
    )
    parser.add_argument("--tables", action="store_true", help="only print the rates")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    if not given.tables:
        for number in range(given.trials):
            record(given.out, given.seed, number, given.bodies)
    print_rates(given.out)


if __name__ == "__main__":
    main()
