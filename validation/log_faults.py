"""Detection rate of log faults and false alarms on good logs: `python -m validation.log_faults`.

The option `--seeds N` sets the number of logs. Logs are simulated with the compiled engine under
random step commands and written with noise as CSV files. Each fault is written into them as a
logger would produce it, and `boatsim check` is run. A log without findings is diagnosed; if the
diagnosis attributes the fault to the boat, the log counts as "called physics".
"""

import argparse
import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

import numpy as np

from boatsim.diagnosis.log_check import check_files
from boatsim.diagnosis.pipeline import diagnose
from boatsim.diagnosis.priors import froude_time_scale
from boatsim.errors import BadInput
from boatsim.physics import vessel as vessels
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording, write_csv
from boatsim.simulate.batch import Batch

VESSELS = ("trial_boat", "blueboat", "otter", "mariner")
LASTS, HOLDS = 80.0, 4.0  # [s] duration of a log and of a command, boat of 1.2 m
RATE, SUBSTEPS = 6.0, 10  # [Hz] row rate at 1.2 m, integration steps per row
PLACE_SD, HEADING_SD = 0.002, 0.009  # [lengths], [rad] noise of a camera or good receiver
Columns = dict[str, Array]  # columns of a log, including `t_s`
EARTH = 111_320.0  # [m] a degree of latitude, the common approximation
LATITUDE, LONGITUDE = 63.44, 10.35  # [deg] a place in Norway


@dataclass(frozen=True)
class Fault:
    """A fault of a log and the findings that identify it."""

    apply: Callable[[Columns, Vessel], Columns]
    named: tuple[str, ...]
    needs: Callable[[Vessel], bool] = lambda _: True


def simulate_log(boat: Vessel, seed: int, lasts: float = LASTS) -> Columns:
    """Return a good log: positions and heading with noise, and the commands."""
    rng, slow = np.random.default_rng(seed), froude_time_scale(boat)
    rows, held = round(lasts * RATE), round(HOLDS * RATE)
    compiled = Batch(boat, step=slow / RATE / SUBSTEPS)
    levels = []
    for c in boat.commands.values():
        low, high = (max(c.low, -c.high) if c.low < 0.0 else c.low), c.high
        levels.append(rng.uniform(0.6 * low, 0.8 * high, -(-rows // held)))
    commands = np.repeat(np.column_stack(levels), held, axis=0)[:rows]
    nq = len(boat.dof)
    states = compiled.rollout(np.zeros(2 * nq), commands, slow / RATE)[:rows]
    x, y, psi = (states[:, boat.dof.index(axis)] for axis in ("surge", "sway", "yaw"))
    noise = rng.standard_normal((3, rows)) * [
        [PLACE_SD * boat.length],
        [PLACE_SD * boat.length],
        [HEADING_SD],
    ]
    t = np.arange(rows) * slow / RATE
    pose = {"x_m": x + noise[0], "y_m": y + noise[1], "psi_rad": psi + noise[2]}
    rounded = {n: np.round(v, 5 if n == "psi_rad" else 4) for n, v in pose.items()}
    return {"t_s": np.round(t, 4), **rounded, **dict(zip(boat.commands, commands.T, strict=True))}


def write(columns: Columns, path: Path) -> None:
    """Write the log to a file."""
    write_csv(
        Recording(path.stem, columns["t_s"], {n: v for n, v in columns.items() if n != "t_s"}), path
    )


def _column_fault(**made: Callable[[Columns], Array]) -> Callable[[Columns, Vessel], Columns]:
    return lambda columns, _: columns | {n: f(columns) for n, f in made.items()}


def _has_two_similar_drives(boat: Vessel) -> bool:
    return any("_port_" in f"_{n}_" for n in boat.commands)


def _exchange_commands(columns: Columns, boat: Vessel) -> Columns:
    swap = {}
    for n in boat.commands:
        swap[n] = n.replace("port", "#").replace("starboard", "port").replace("#", "starboard")
    return columns | {n: columns[other] for n, other in swap.items()}


def _reverse_one_command(columns: Columns, boat: Vessel) -> Columns:
    name = next(n for n in boat.commands if boat.side(n) > 0 and unit_of(n) != "rad")
    return columns | {name: -columns[name]}


def _commands_in_percent(columns: Columns, boat: Vessel) -> Columns:
    drives = [n for n in boat.commands if unit_of(n) != "rad"]
    return columns | {n: 100.0 * columns[n] / boat.commands[n].high for n in drives}


def _rows_at_shares(columns: Columns, *shares: float) -> list[int]:
    return [round(share * len(columns["t_s"])) for share in shares]


def _hold_positions(columns: Columns, _: Vessel) -> Columns:
    row = np.arange(len(columns["t_s"])) // round(RATE) * round(RATE)
    return columns | {n: columns[n][row] for n in ("x_m", "y_m", "psi_rad")}


def _positions_in_bursts(columns: Columns, boat: Vessel) -> Columns:
    off = np.zeros(len(columns["t_s"]))
    for begin in _rows_at_shares(columns, 0.2, 0.6):
        off[begin : begin + 4] = 0.8 * boat.length
    return columns | {n: columns[n] + off for n in ("x_m", "y_m")}


def _positions_in_degrees(columns: Columns, _: Vessel) -> Columns:
    north = LATITUDE + columns["x_m"] / EARTH
    east = LONGITUDE + columns["y_m"] / EARTH / np.cos(np.radians(LATITUDE))
    return columns | {"x_m": np.round(north, 9), "y_m": np.round(east, 9)}


def _interpolate_gaps(columns: Columns, _: Vessel) -> Columns:
    made = dict(columns)
    for name, places in (("x_m", 4), ("y_m", 4), ("psi_rad", 5)):
        values = columns[name].copy()
        for begin in _rows_at_shares(columns, 0.12, 0.3, 0.6, 0.85):
            values[begin : begin + 10] = np.linspace(values[begin], values[begin + 9], 10)
        made[name] = np.round(values, places)
    return made


def _add_position_jumps(columns: Columns, boat: Vessel) -> Columns:
    behind = np.arange(len(columns["t_s"])) > 0.6 * len(columns["t_s"])
    return columns | {"x_m": columns["x_m"] + 1.5 * boat.length * behind}


def _repeat_times(columns: Columns, _: Vessel) -> Columns:
    t = columns["t_s"].copy()
    t[50::40] = t[49::40][: len(t[50::40])]
    return columns | {"t_s": t}


FAULTS: dict[str, Fault] = {
    "y to port, heading too": Fault(
        _column_fault(y_m=lambda c: -c["y_m"], psi_rad=lambda c: -c["psi_rad"]),
        ("mirrored", "thrusters_exchanged", "rudder_sense"),
    ),
    "y to port alone": Fault(_column_fault(y_m=lambda c: -c["y_m"]), ("y_to_port",)),
    "ENU axes": Fault(
        _column_fault(
            x_m=lambda c: c["y_m"],
            y_m=lambda c: c["x_m"],
            psi_rad=lambda c: np.pi / 2 - c["psi_rad"],
        ),
        ("mirrored", "thrusters_exchanged", "rudder_sense"),
    ),
    "x and y exchanged": Fault(
        _column_fault(x_m=lambda c: c["y_m"], y_m=lambda c: c["x_m"]), ("axes_exchanged",)
    ),
    "heading from east": Fault(
        _column_fault(psi_rad=lambda c: np.pi / 2 - c["psi_rad"]), ("heading_from_east",)
    ),
    "thrusters exchanged": Fault(
        _exchange_commands, ("thrusters_exchanged", "mirrored"), _has_two_similar_drives
    ),
    "one thrust reversed": Fault(
        _reverse_one_command, ("thrust_reversed",), _has_two_similar_drives
    ),
    "heading in degrees": Fault(
        _column_fault(psi_rad=lambda c: np.degrees(c["psi_rad"]) % 360.0), ("heading_in_degrees",)
    ),
    "heading turned 90 deg": Fault(
        _column_fault(psi_rad=lambda c: c["psi_rad"] + np.pi / 2), ("heading_turned",)
    ),
    "heading turned 40 deg": Fault(
        _column_fault(psi_rad=lambda c: c["psi_rad"] + np.radians(40.0)), ("heading_turned",)
    ),
    "position held": Fault(_hold_positions, ("position_held",)),
    "outliers in bursts": Fault(_positions_in_bursts, ("outliers",)),
    "latitude as metres": Fault(_positions_in_degrees, ("latitude_as_metres",)),
    "commands in per cent": Fault(
        _commands_in_percent,
        ("command_unit",),
        lambda b: any(
            unit_of(n) != "rad" and not 67.0 < c.high < 150.0 for n, c in b.commands.items()
        ),
    ),
    "time in ms": Fault(_column_fault(t_s=lambda c: 1000.0 * c["t_s"]), ("time_unit",)),
    "gaps bridged": Fault(_interpolate_gaps, ("bridged",)),
    "position leaps": Fault(_add_position_jumps, ("position_leaps",)),
    "clock stalls": Fault(_repeat_times, ("clock_stalls",)),
}


def judge_findings(
    boat: Vessel, columns: Columns, fault: Fault | None, ask: bool
) -> tuple[bool, bool, list[str]]:
    """Return whether the fault is named, whether the boat is blamed instead, and all findings."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "run.csv"
        write(fault.apply(columns, boat) if fault else columns, path)
        found, refused = check_files([path], boat.name)
        names = [e["name"] for e in found[path] if e["kind"] != "limit"]
        named = bool(fault) and bool(set(names) & set(fault.named if fault else ()))
        if named or names or refused or not ask or not fault:
            return named, False, names
        try:
            answer = diagnose([path], vessel=boat.name).findings.answer
        except BadInput:
            return False, False, names
        return False, answer["verdict"] != "nothing_missing", names


def table(names: Sequence[str], seeds: int, ask: bool = True) -> Iterator[str]:
    """Yield the rates for each fault and vessel, then the false alarms on good logs."""
    boats = [vessels.load_vessel(n) for n in names]
    yield f"{'fault':24s}" + "".join(f"{n:>24s}" for n in names)
    yield f"{'':24s}" + f"{'named / physics / of':>24s}" * len(names)
    logs = {b.name: [simulate_log(b, seed) for seed in range(1, seeds + 1)] for b in boats}
    total = np.zeros(3, dtype=int)
    for title, fault in FAULTS.items():
        cells = []
        for boat in boats:
            counts = np.zeros(3, dtype=int)  # named, called physics, all
            instead = set[str]()
            if fault.needs(boat):
                for log in logs[boat.name]:
                    named, physics, found = judge_findings(boat, log, fault, ask)
                    counts += (named, physics, 1)
                    if not named:
                        instead.update(found)
            total += counts
            if counts[2]:
                wrong = ",".join(sorted(instead))[:12]
                cells.append(f"{wrong} {counts[0]} / {counts[1]} / {counts[2]}")
            else:
                cells.append("-")
        yield f"{title:24s}" + "".join(f"{c:>24s}" for c in cells)
    good = []
    for boat in boats:
        accused = [
            found for log in logs[boat.name] if (found := judge_findings(boat, log, None, False)[2])
        ]
        names_found = sorted(set(chain.from_iterable(accused)))
        good.append(f"{len(accused)} of {seeds} {','.join(names_found)}".strip())
    yield f"{'good logs accused':24s}" + "".join(f"{c:>24s}" for c in good)
    yield (
        f"named {total[0]} of {total[2]} ({100.0 * total[0] / total[2]:.0f} %), called "
        f"physics {total[1]}"
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seeds", type=int, default=5, help="logs of each vessel")
    parser.add_argument("--vessels", nargs="*", default=list(VESSELS))
    parser.add_argument(
        "--check-only", action="store_true", help="do not diagnose what is not named"
    )
    given = parser.parse_args()
    for line in table(given.vessels, given.seeds, not given.check_only):
        print(line, flush=True)


if __name__ == "__main__":
    main()
