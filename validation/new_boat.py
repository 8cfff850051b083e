"""Accuracy of vessels from `boatsim new` with logs: `python -m validation.new_boat`.

Each boat is made by `boatsim new ... --from-log` from its particulars, fitted to some logs and
evaluated by free runs on other logs. The hand-made vessel is evaluated on the same logs as written,
and after the same fit. Boats without recordings are skipped.
"""

import json
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from boatsim.newboat.from_log import FittedBoat, fit_boat
from boatsim.newboat.particulars import Options, Particulars, parse_particulars
from boatsim.newboat.write import VESSEL, boat_files
from boatsim.physics.base import Array
from boatsim.physics.content import find_content_file
from tests import pushed_three_metre
from validation.real import esso_osaka_pond, esso_osaka_vessel
from validation.real.common import RECORDINGS, print_table

GOAL = 1.3  # largest ratio to the hand-made vessel's error
UNITS = {
    "position_rms_m": ("position [m]", np.sqrt(2.0)),
    "heading_rms_rad": ("heading [deg]", 57.29578),
}
# K_T of a propeller of P/D 0.7: M. M. Bernitsas et al. 1981, Wageningen B-series at J =
# 0.35
THRUST_COEFFICIENT = 0.2
LONGEST = 150.0  # [s] longest run of the tanker, to limit the computing time
MOST = 17.0  # [1/s] fastest shaft of the manoeuvres used for fit and evaluation


@dataclass(frozen=True)
class Case:
    """A boat as its owner knows it, its logs by name, and the hand-made vessel."""

    boat: Particulars
    logs: Mapping[str, Mapping[str, Array]]  # columns
    held_out: Sequence[str]
    hand_made: Callable[[Path], Path]  # returns its file, written into the folder if needed
    # columns under the hand-made vessel's names
    its_logs: Callable[[Mapping[str, Array]], Mapping[str, Array]] = dict


def three_metre_case(folder: Path) -> Case:
    """Return the case of the 3 m boat of the independent integrator."""
    logs = {}
    for seed in (1, 2, 3):
        pushed_three_metre.write(folder / f"run_{seed}.csv", seed)
        logs[f"run_{seed}"] = dict(read_columns(folder / f"run_{seed}.csv"))
    thrusters = Options(thrusters=["-1.2,-0.6,60", "-1.2,0.6,60"])
    boat = parse_particulars("three_metre", 3.0, 1.6, 90.0, thrusters)

    def hand_made(where: Path) -> Path:
        where.mkdir(exist_ok=True)
        (where / VESSEL).write_text(pushed_three_metre.HAND_MADE, encoding="utf-8")
        return where / VESSEL

    return Case(boat, logs, ("run_3",), hand_made)


def blueboat_case(_: Path) -> Case:
    """Return the case of the catamaran on the lake.

    Sizes are from the maker's page, thrusters from its source.
    """
    boat = parse_particulars(
        "blueboat_new",
        1.2,
        0.77,
        15.0,
        Options(thrusters=["-0.45,-0.285,55.2,27.6", "-0.45,0.285,55.2,27.6"], hulls=2),
    )
    logs = {}
    for path in recordings_of_set("blueboat_lake"):
        read = read_columns(path)
        names = {"x_m": "north_m", "y_m": "east_m", "psi_rad": "heading_rad"}
        names |= {
            "thrust_port_N": "force_right_N",
            "thrust_starboard_N": "force_left_N",
        }  # its README: exchanged
        logs[path.stem] = {"t_s": read["t_s"]} | {
            ours: read[theirs] for ours, theirs in names.items()
        }
    held_out = sorted(logs)[2::4]
    return Case(boat, logs, held_out, lambda _: find_content_file("vessel", "blueboat"))


def esso_osaka_case(_: Path) -> Case:
    """Return the case of the 3 m tanker model: zig-zags and turns.

    Thrust is proportional to the square of the shaft speed.
    """
    data = json.loads((RECORDINGS / "esso_osaka" / "vessel.json").read_text(encoding="utf-8"))
    ahead, propeller, rudder = data["x_G_m"], data["propeller"], data["rudder"]
    per = THRUST_COEFFICIENT * data["density_water_kgm3"] * propeller["D_m"] ** 4  # [N s^2]
    at = propeller["x_over_Lpp"] * data["Lpp_m"] - ahead
    boat = parse_particulars(
        "esso_osaka_new",
        data["Lpp_m"],
        data["beam_m"],
        data["mass_kg"],
        Options(
            thrusters=[f"{at},0,{per * MOST**2}"],
            rudder=f"{rudder['x_from_midship_m'] - ahead},{rudder['area_m2']}",
            draught=data["draught_m"],
        ),
    )
    logs = {}
    for path in [
        p for p in recordings_of_set("esso_osaka") if p.stem.startswith(("zigzag", "turn"))
    ]:
        read = read_columns(path)
        kept = {n: read[n] for n in ("t_s", "x_m", "y_m", "psi_rad", "rudder_rad")}
        kept["thrust_motor_N"] = per * read["shaft_rps"] * np.abs(read["shaft_rps"])
        bridged, leaps = esso_osaka_pond.defective_rows(
            np.genfromtxt(path, delimiter=",", names=True)
        )
        begin, end = longest_stretch(read["t_s"], read["t_s"][leaps])
        inside = (read["t_s"] >= begin) & (read["t_s"] <= min(end, begin + LONGEST))
        logs[path.stem] = {n: x[inside & ~bridged] for n, x in kept.items()}

    def theirs(log: Mapping[str, Array]) -> Mapping[str, Array]:
        shaft = np.sqrt(np.abs(log["thrust_motor_N"]) / per) * np.sign(log["thrust_motor_N"])
        kept = {n: log[n] for n in ("t_s", "x_m", "y_m", "psi_rad")}
        return {**kept, "delta_rad": log["rudder_rad"], "n_rps": shaft}

    return Case(boat, logs, sorted(logs)[2::4], esso_osaka_vessel.write_vessel, theirs)


def longest_stretch(t: Array, leaps: Array) -> tuple[float, float]:
    """Return begin and end [s] of the longest stretch between jumps of a run.

    The cuts are those of esso_osaka_pond.
    """
    begins = [float(t[0]), *(leaps + esso_osaka_pond.AFTER_JUMP)]
    ends = [*(leaps - esso_osaka_pond.BEFORE_JUMP), float(t[-1])]
    return max(zip(begins, ends, strict=True), key=lambda span: span[1] - span[0])


CASES: Mapping[str, Callable[[Path], Case]] = {
    "three_metre": three_metre_case,
    "blueboat": blueboat_case,
    "esso_osaka": esso_osaka_case,
}
SETS = {"blueboat": "blueboat_lake", "esso_osaka": "esso_osaka"}


def recordings_of_set(name: str) -> list[Path]:
    """Return the recordings of a set."""
    return sorted((RECORDINGS / name / "runs").glob("*.csv"))


def read_columns(path: Path) -> dict[str, Array]:
    """Return every column of a CSV file."""
    read = np.genfromtxt(path, delimiter=",", names=True)
    return {name: read[name] for name in read.dtype.names or ()}


def judge_case(case: Case, folder: Path) -> Iterator[tuple[str, FittedBoat]]:
    """Return the errors of the new boat, then of the hand-made one."""
    own = folder / case.boat.name
    own.mkdir()
    for name, text in boat_files(case.boat).items():
        (own / name).write_text(text, encoding="utf-8")
    yield "new", _fit_vessel(own / VESSEL, case, folder / "new_logs", dict)
    yield (
        "hand-made",
        _fit_vessel(case.hand_made(folder / "hand_made"), case, folder / "its_logs", case.its_logs),
    )


def _fit_vessel(
    file: Path,
    case: Case,
    folder: Path,
    taken: Callable[[Mapping[str, Array]], Mapping[str, Array]],
) -> FittedBoat:
    folder.mkdir()
    for name, log in case.logs.items():
        _write(folder / f"{name}.csv", taken(log))
    fit = [folder / f"{n}.csv" for n in case.logs if n not in case.held_out]
    return fit_boat(file, fit, [folder / f"{n}.csv" for n in case.held_out])


def _write(file: Path, log: Mapping[str, Array]) -> None:
    """A recording."""
    np.savetxt(
        file, np.column_stack(list(log.values())), "%.9g", ",", header=",".join(log), comments=""
    )


def table_lines(name: str) -> Iterator[list[str]]:
    """Return the lines of the table for one boat."""
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        case = CASES[name](folder)
        found = dict(judge_case(case, folder))
    for family, (words, scale) in UNITS.items():
        new, hand = found["new"], found["hand-made"]
        cells = []
        for x in (
            new.before[family],
            new.after[family],
            hand.before[family],
            hand.after[family],
        ):
            cells.append(scale * x)
        ratios = [cells[1] / cells[2], cells[1] / cells[3]]
        verdict = "yes" if ratios[0] <= GOAL else "no"
        yield [
            name,
            words,
            f"{new.judge.horizon:g}",
            *(f"{c:.3g}" for c in cells),
            *(f"{r:.2f}" for r in ratios),
            verdict,
        ]
    print(
        f"{name}: {', '.join(found['new'].best.effects) or 'nothing'} found in addition to "
        "its coefficients",
        file=sys.stderr,
    )


def main(names: Sequence[str]) -> None:
    """Print the table."""
    lines = []
    for name in names or CASES:
        if name in SETS and not recordings_of_set(SETS[name]):
            print(f"{name}: skipped, no recordings in ../shared/recordings/{SETS[name]}/runs")
            continue
        lines += list(table_lines(name))
    header = [
        "boat",
        "",
        "free run [s]",
        "particulars",
        "fitted",
        "hand-made",
        "and fitted",
        "ratio",
        "to fitted",
        "goal",
    ]
    print_table(
        f"errors of free runs on held-out logs; goal: at most {GOAL:g} times the hand-made",
        header,
        lines,
    )


if __name__ == "__main__":
    main(sys.argv[1:])
