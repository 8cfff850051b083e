"""Whether two halves of a set give the same answer: `python -m validation.real.halves NAME`.

The runs of a set, in the order of their names, are dealt alternately to two halves, and each half
is diagnosed alone; a single run is divided at its middle. Printed are the effects that each half
names with their parameters, the distance of two values in standard deviations, and the share of
names that the other half gives too.

In place of a set, NAME may be a folder of recordings, such as the folder of prepared ones that
another command of this package has written; `--vessel` and `--horizon` state what its notes do not.
"""

from argparse import ArgumentParser
from collections.abc import Sequence
from math import hypot, nan
from pathlib import Path

from boatsim.diagnosis import loading, pipeline
from boatsim.diagnosis.answer.schema import EffectEntry
from boatsim.recordings.table import write_csv
from validation.real import esso_osaka_pond, esso_osaka_vessel, twin_usv_paths
from validation.real.common import OUT, effects_of, print_table, runs_of
from validation.real.floor import SPLITS

NEAR = 2.0  # [sd] distance up to which two values agree: 95 % of normally distributed errors
TEXT = "{:.3g} +- {:.2g}"
Effects = dict[str, EffectEntry]
# set -> vessel, None for that of its notes, and length of free runs [s]
SETS: dict[str, tuple[str | None, float]] = {
    esso_osaka_vessel.NAME: (None, esso_osaka_pond.HORIZON),
    twin_usv_paths.NAME: (twin_usv_paths.VESSEL, twin_usv_paths.HORIZON),
} | {name: (None, split.horizon) for name, split in SPLITS.items()}


def diagnosed_halves(
    halves: Sequence[Sequence[Path]], vessel: str | None, horizon: float | None
) -> tuple[Effects, Effects]:
    """Diagnose two halves and return the effects that each names.

    Args:
        halves: Recordings of either half.
        vessel: Name or file of the vessel; None: that of the notes.
        horizon: Length of free runs [s]; None: the usual one.
    """
    found = []
    for half in halves:
        diagnosis = pipeline.diagnose(half, vessel=vessel, horizon=horizon)
        print(diagnosis.findings.answer["sentence"])
        found.append({effect["name"]: effect for effect in effects_of(diagnosis)})
    return found[0], found[1]


def halves_of(runs: Sequence[Path], vessel: str | None, out: Path) -> list[list[Path]]:
    """Deal recordings alternately to two halves, or divide a single one at its middle.

    The parts of a single recording are written to a folder, without its notes.

    Args:
        runs: The recordings, in the order of their names.
        vessel: Name or file of the vessel; None: that of the notes.
        out: Folder of the parts.
    """
    if len(runs) > 1:
        return [list(runs[::2]), list(runs[1::2])]
    whole, _ = loading.open_recording(runs[0], vessel, ())
    middle = 0.5 * float(whole.t[0] + whole.t[-1])
    out.mkdir(parents=True, exist_ok=True)
    halves = []
    for name, span in {"first": (-float("inf"), middle), "second": (middle, float("inf"))}.items():
        halves.append([out / f"{name}.csv"])
        write_csv(whole.between(*span), halves[-1][0])
    return halves


def pond_stretches(out: Path) -> list[Path]:
    """Write the stretches of the pond's runs that its own command diagnoses to a folder.

    Args:
        out: The folder.
    """
    runs = esso_osaka_pond.open_runs(
        runs_of(esso_osaka_vessel.NAME), str(esso_osaka_vessel.write_vessel())
    )[0]
    out.mkdir(parents=True, exist_ok=True)
    files = []
    for name, run in runs.items():
        if name.startswith(esso_osaka_pond.FITTED):
            files.append(out / f"{name}.csv")
            write_csv(run.longest, files[-1])
    return files


def distances(first: Effects, second: Effects) -> dict[tuple[str, str], float]:
    """Return how far the parameters of common names are apart, in standard deviations.

    Args:
        first: Effects of one half by name.
        second: Effects of the other half.
    """
    found = {}
    for name in sorted(set(first) & set(second)):
        for parameter, one in first[name]["parameters"].items():
            other = second[name]["parameters"].get(parameter)
            if other is None:
                continue
            sd = hypot(one["sd"], other["sd"])
            apart = abs(one["value"] - other["value"])
            found[name, parameter] = apart / sd if sd > 0.0 else nan
    return found


def print_halves(title: str, halves: tuple[Effects, Effects]) -> None:
    """Print what the effects of two halves have in common.

    Args:
        title: Name of the set.
        halves: Effects of each half by name.
    """
    apart = distances(*halves)
    rows = []
    for effect in sorted({*halves[0], *halves[1]}):
        parameters = sorted(
            {p for half in halves if effect in half for p in half[effect]["parameters"]}
        )
        for parameter in parameters:
            cells = []
            for half in halves:
                given = half[effect]["parameters"].get(parameter) if effect in half else None
                cells.append(TEXT.format(given["value"], given["sd"]) if given else "-")
            distance = apart.get((effect, parameter))
            cells.append("-" if distance is None else f"{distance:.1f}")
            rows.append([f"{effect} {parameter}", *cells])
    print_table(title, ["effect and parameter", "first half", "second half", "apart [sd]"], rows)
    common = len(set(halves[0]) & set(halves[1]))
    print(f"names of the first half that the second gives too: {common} of {len(halves[0])}")
    print(f"names of the second half that the first gives too: {common} of {len(halves[1])}")
    near = sum(distance <= NEAR for distance in apart.values())
    print(f"parameters of common names within {NEAR:g} sd: {near} of {len(apart)}")


def main() -> None:
    """Read the arguments, diagnose and print."""
    parser = ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("name", help=f"folder of recordings, or of {', '.join(sorted(SETS))}")
    parser.add_argument("--vessel", help="name or file of the vessel (default: that of the notes)")
    parser.add_argument("--horizon", type=float, help="length of free runs [s]")
    given = parser.parse_args()
    vessel, horizon, title = given.vessel, given.horizon, given.name
    if given.name in SETS:
        vessel, horizon = SETS[given.name]
        runs = list(runs_of(given.name).values())
    elif Path(given.name).is_dir():
        title = Path(given.name).name
        runs = sorted(Path(given.name).glob("*.csv"))
    else:
        parser.error(f"{given.name} is no folder and no set; allowed are {', '.join(sorted(SETS))}")
    out = OUT / title / "halves"
    if given.name == esso_osaka_vessel.NAME:
        runs, vessel = pond_stretches(out), str(esso_osaka_vessel.write_vessel())
    halves = halves_of(runs, vessel, out)
    print_halves(title, diagnosed_halves(halves, vessel, horizon))


if __name__ == "__main__":
    main()
