"""A 3 m tanker on a pond in wind, at low speed: `python -m validation.real.esso_osaka_pond`.

The nominal is the MMG model of captive tests of the same hull, the baseline the same with its
coefficients refitted. The diagnosis does not know that there was wind: it has to identify the wind
from positions and commands, and the result is then compared with the anemometer.

Random and zig-zag runs are fitted; turns and berthing are judged by free runs of 60 s. Wind is not
a property of a ship, so for each judged minute it is estimated from the rest of that run, with all
else as fitted. Recorded velocities are not used. Position fixes that were held over are not fitted,
and fitted runs are cut at jumps, for the reasons that are printed first. Judged runs are used as
recorded.
"""

import json
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import astuple, dataclass, replace
from functools import cache
from itertools import chain
from operator import attrgetter, itemgetter
from pathlib import Path

import numpy as np

from boatsim.diagnosis import loading, pipeline, priors
from boatsim.diagnosis.checks.position_outliers import drop_position_outliers
from boatsim.diagnosis.coordinate_search import maximize
from boatsim.diagnosis.filter import MappedRecording, free_run_segments
from boatsim.diagnosis.fit import converge, fit, unfitted_hypothesis
from boatsim.diagnosis.free_runs import FreeRun, free_runs, rms_errors
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.diagnosis.prior_noise import shared_noise
from boatsim.diagnosis.problem import Fit, Problem, free_parameter_values
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording
from validation.real.common import (
    DEG,
    OUT,
    RECORDINGS,
    format_fixed,
    print_table,
    print_verdict,
    runs_named,
    runs_of,
    scale_errors,
    write_report,
)
from validation.real.esso_osaka_vessel import NAME, SOURCE, write_vessel

FITTED = ("random", "zigzag")
JUDGED = ("turn", "berthing")
# of the kinds that are fitted: held out from the diagnosis
HELD_OUT = ("random_0731_1248", "random_0806_1624_6", "zigzag_0731_1403")
WINDOW = 300.0  # [s] of each run that are diagnosed at most, to limit the computing time
HORIZON = 60.0  # [s] of a free run
TITLE = f"fitted on {' and '.join(FITTED)} runs, judged on {' and '.join(JUDGED)}"
ERRORS_FILE = OUT / NAME / "judged.json"
GOALS = {"nominal": 0.75, "recalibrated": 0.9}  # position error of the patched model over this one
UNITS = {
    "position_rms_m": ("position [m]", np.sqrt(2.0)),
    "heading_rms_rad": ("heading [deg]", DEG),
}
LONG = 250.0  # [s] of a run in which a ship of 3 m has met the wind from several sides
NEAR_DIRECTION = 30.0  # [deg]
NEAR_SPEED = 0.3  # relative
SHARE = 0.75  # of the runs
WEATHER = ("force", "toward")  # parameters of the wind; its others describe the hull
ROUNDS = 3  # of fitting ship and winds in turn
START_DIRECTIONS = (0.0, 0.5 * np.pi, np.pi, -0.5 * np.pi)  # [rad] to which the wind may blow
START_FORCE = 0.5  # [N] of a breeze
TOLERANCE = 0.1  # [nats] of the search for a wind
SHORTEST = 15.0  # [s] of a stretch that is used
SMOOTH = 2.0  # [s] over which a rate is estimated
AROUND = 5.0  # [s] about a defect that are not compared
# [m], [rad] in a row of 0.1 s: twice the largest speed and yaw rate of the ship
JUMP = 0.1
TURN_JUMP = 0.03
# [s] before a jump in which fixes are delayed (the longest gap is as long), and after it
BEFORE_JUMP = 2.5
AFTER_JUMP = 0.2


# ---- quality of the recordings


@dataclass(frozen=True)
class Consistency:
    """Agreement of positions, headings and recorded velocities of a run."""

    bridged: float  # share of rows whose fix was held over
    jumps: int  # rows in which position or heading moves further than the ship can
    delay_s: float  # of recorded velocities after the rates of x and y
    aft_m: float  # distance of their reference point aft of that of x and y
    sway_ratio: float  # recorded sway velocity over that of x and y


def consistency_of(path: Path) -> Consistency:
    """Compare the velocities of a run's positions with its recorded velocities."""
    d = np.genfromtxt(path, delimiter=",", names=True)
    psi, dt = d["psi_rad"], float(np.median(np.diff(d["t_s"])))
    n = round(0.5 * SMOOTH / dt)
    bridged, jumps = defective_rows(d)
    wide = np.ones(2 * round(AROUND / dt) + 1)
    good = np.convolve(bridged | jumps, wide, "same") < 0.5
    good[: 4 * n] = good[-4 * n :] = False
    derivative = _derivative(n, dt)
    north = np.convolve(d["x_m"], derivative, "same")
    east = np.convolve(d["y_m"], derivative, "same")
    u = np.cos(psi) * north + np.sin(psi) * east
    v = np.cos(psi) * east - np.sin(psi) * north
    mean = np.ones(2 * n + 1) / (2 * n + 1)
    recorded_u = np.convolve(d["u_mps"], mean, "same")
    recorded_v = np.convolve(d["v_mps"], mean, "same")
    recorded_r = np.convolve(d["r_radps"], mean, "same")

    def misfit(k: int) -> tuple[float, Array]:
        """Return the misfit with velocities k rows earlier, and the regression of v on v, r, 1."""
        along, across = np.roll(recorded_u, -k)[good], np.roll(recorded_v, -k)[good]
        A = np.column_stack([across, recorded_r[good], np.ones(int(good.sum()))])
        x = np.linalg.lstsq(A, v[good], rcond=None)[0]
        return float(np.var(u[good] - along) + np.var(v[good] - A @ x)), x

    shift = min(range(-10, 16), key=lambda k: misfit(k)[0])
    sway, yaw, _ = misfit(shift)[1].tolist()
    filled = float(np.mean(d["filled"] > 0.0))
    return Consistency(filled, int(jumps.sum()), shift * dt, yaw, 1.0 / sway)


def _derivative(n: int, dt: float) -> Array:
    """Return weights of the slope of a straight line through 2 n + 1 rows."""
    k = np.arange(n, -n - 1, -1)
    return np.asarray(k / (dt * float(np.sum(k**2))))


def defective_rows(d: Array) -> tuple[Array, Array]:
    """Return the rows with a bridged fix, and those before a jump of position or heading.

    Args:
        d: Structured array of a recording's columns.

    Returns:
        Two boolean arrays (N,).
    """

    def steps(name: str) -> Array:
        return np.asarray(np.diff(d[name], append=d[name][-1]))

    turned = steps("psi_rad") - d["r_radps"] * steps("t_s")
    far = np.hypot(steps("x_m"), steps("y_m")) > JUMP
    return d["filled"] > 0.0, far | (np.abs(turned) > TURN_JUMP)


def sound_stretches(recording: Recording, path: Path, shortest: float) -> list[Recording]:
    """Return the stretches of a recording between jumps.

    Bridged fixes are nan. The rows just before a jump, whose fixes are delayed, are left out.

    Args:
        recording: The recording.
        path: Its file.
        shortest: Shortest stretch that is returned [s].
    """
    d = np.genfromtxt(path, delimiter=",", names=True)
    bridged, jumps = defective_rows(d)
    gone = bridged[np.searchsorted(d["t_s"], recording.t - 1e-6)]
    fixes = {n: np.where(gone, np.nan, recording[n]) for n in ("x_m", "y_m", "psi_rad")}
    whole = replace(recording, signals={**recording.signals, **fixes})
    at = d["t_s"][jumps]
    begins = [whole.t[0], *(at + AFTER_JUMP)]
    ends = [*(at - BEFORE_JUMP), whole.t[-1]]
    stretches = []
    for a, b in zip(begins, ends, strict=True):
        if b - a >= shortest:
            stretches.append(whole.between(float(a), float(b)))
    return stretches


def print_consistency(runs: Mapping[str, Path]) -> None:
    """Print the defects of the recordings by kind of run, medians over runs."""
    rows = []
    for kind in (*FITTED, *JUDGED):
        found = [consistency_of(path) for name, path in runs.items() if name.startswith(kind)]
        bridged, jumps, *others = np.transpose(list(map(astuple, found)))
        row = [kind, str(len(found)), f"{100 * np.mean(bridged):.1f} %", f"{sum(jumps):.0f}"]
        rows.append([*row, *format_fixed(2, *np.median(others, axis=1))])
    header = ["", "runs", "bridged", "jumps"]
    header += ["delay of u, v [s]", "v's point aft [m]", "v / that of x, y"]
    print_table("defects of the recordings (medians over runs)", header, rows)
    print(
        "(Bridged fixes were held over and are not fitted. After some of them position or\n"
        " heading jumps, by up to 10 deg that the yaw rate does not show; runs are cut there.\n"
        " Recorded u, v are delayed against x, y and belong to another point of the ship; they\n"
        " are not used.)"
    )


# ---- wind of each run


@cache
def side_force_per_square() -> float:
    """Return the side force beam-on per square of the wind's speed [N s^2/m^2], by vessel.json."""
    data = json.loads(SOURCE.read_text(encoding="utf-8"))
    area, density = data["above_water"]["lateral_area_m2"], data["density_air_kgm3"]
    return float(0.5 * density * area * data["mmg"]["wind"]["Y1"])


@dataclass(frozen=True)
class Wind:
    """A steady force of the wind."""

    force: float  # [N] beam-on
    toward: float  # [rad] from the x axis, clockwise

    @property
    def speed(self) -> float:
        """Speed of the steady wind with this force [m/s]."""
        return float(np.sqrt(self.force / side_force_per_square()))


def wind_of_force(force: Array) -> Wind:
    """Return the wind with a force (2,) to north and east [N]."""
    return Wind(float(np.hypot(*force)), float(np.arctan2(force[1], force[0])))


def measured_wind(name: str) -> Wind:
    """Return the steady wind with the mean force of the wind that the anemometer measured."""
    d = np.genfromtxt(RECORDINGS / NAME / "wind" / f"{name}.csv", delimiter=",", names=True)
    square, comes_from = d["true_speed_mps"] ** 2, d["true_direction_rad"]
    north = -float(np.nanmean(square * np.cos(comes_from)))
    east = -float(np.nanmean(square * np.sin(comes_from)))
    force = side_force_per_square() * float(np.hypot(north, east))
    return Wind(force, float(np.arctan2(east, north)))


# maps recordings on the only compiled program
Mapper = Callable[[Sequence[Recording]], list[MappedRecording]]


class Weather:
    """A fit of a ship in which each run may have a different wind."""

    def __init__(self, problem: Problem, ship: Fit) -> None:
        """Begin with a fit of the ship, with or without a wind common to all runs."""
        names = ship.effects
        if "wind" not in names:
            names = (*names, "wind")
        free = problem.free_parameters(names)
        theta = free_parameter_values(free, ship.values())
        self.rest = []  # positions of all parameters but those of the wind
        for i, f in enumerate(free):
            if f.effect != "wind" or f.name not in WEATHER:
                self.rest.append(i)
            elif f.name == "force":
                self.prior_sd = f.sd  # of the wind's force [N]
        self.problem = problem
        self.ship = unfitted_hypothesis(names, free, theta, ship.levels)

    def _without_wind(self) -> Fit:
        free = itemgetter(*self.rest)(self.ship.free)
        theta = self.ship.theta[self.rest]
        return unfitted_hypothesis(self.ship.effects, free, theta, self.ship.levels)

    def find_wind(self, recordings: Sequence[MappedRecording]) -> Wind:
        """Return the wind common to some recordings, with the ship as fitted.

        The prior is a normal distribution of the force to north and of that to east. A prior of
        force and direction would prefer calm to any single wind.
        """
        part = self._without_wind()
        fixed_ship = []
        for run in recordings:
            values = self.problem.parameter_vector(run, part.free, part.theta)
            fixed_ship.append(replace(run, values=values))
        on = self.problem.program.effect_switches(self.ship.effects)

        def score(x: Array) -> float:
            wind = wind_of_force(x)
            problem = self.problem.with_recordings(self.in_wind(fixed_ship, wind))
            likelihood = problem.log_likelihood((), np.zeros(0), on, self.ship.levels)
            return likelihood - 0.5 * float(x @ x) / self.prior_sd**2

        found = []
        for angle in START_DIRECTIONS:
            start = START_FORCE * np.array([np.cos(angle), np.sin(angle)])
            found.append(maximize(score, start, START_FORCE, TOLERANCE))
        return wind_of_force(max(found, key=lambda best: best[0])[1])

    def in_wind(self, recordings: Sequence[MappedRecording], wind: Wind) -> list[MappedRecording]:
        """Return recordings with a wind among their own values."""
        found = []
        for recording in recordings:
            values = recording.values.copy()
            for name in WEATHER:
                values[self.problem.program.parameter_index("wind", name)] = getattr(wind, name)
            found.append(replace(recording, values=values))
        return found

    def refit(self, runs: Sequence[Sequence[MappedRecording]]) -> None:
        """Fit the winds of all runs and the ship in turn."""
        for _ in range(ROUNDS):
            recordings = []
            for stretches, wind in zip(runs, list(map(self.find_wind, runs)), strict=True):
                recordings += self.in_wind(stretches, wind)
            found = fit(self.problem.with_recordings(recordings), self._without_wind())
            self.ship.theta[self.rest] = found.theta
            self.ship = replace(self.ship, levels=found.levels)

    def free_runs(self, recording: MappedRecording, wind: Wind) -> list[FreeRun]:
        """Return free runs of the ship over a recording in a wind."""
        models = {"patched": self._without_wind()}
        return free_runs(self.problem, models, self.in_wind([recording], wind), HORIZON)


def parts_outside(stretches: Sequence[Recording], a: float, b: float) -> list[Recording]:
    """Return the parts of a run's stretches before a [s] and after b [s]."""
    parts = []
    for whole in stretches:
        for begin, end in ((float(whole.t[0]), a), (b, float(whole.t[-1]))):
            inside = (whole.t > begin - 1e-9) & (whole.t < end + 1e-9)
            if inside.any() and float(np.ptp(whole.t[inside])) >= SHORTEST:
                parts.append(whole.between(begin, end))
    return parts


def _signed_deg(angle: float) -> float:
    """Return an angle [rad] in degrees between -180 and 180."""
    return float(np.degrees(np.angle(np.exp(1j * angle))))


def print_winds(found: Mapping[str, Wind], seconds: Mapping[str, float]) -> None:
    """Print the estimated wind of each whole run and the measured one."""
    rows = []
    near = set()
    for name, wind in found.items():
        truth = measured_wind(name)
        off = _signed_deg(wind.toward - truth.toward)
        ratio = wind.speed / truth.speed
        verdict = "-"
        if abs(off) <= NEAR_DIRECTION and abs(ratio - 1.0) <= NEAR_SPEED:
            near.add(name)
            verdict = "yes"
        directions = format_fixed(0, _signed_deg(wind.toward), _signed_deg(truth.toward))
        speeds = format_fixed(2, wind.speed, truth.speed, ratio)
        rows.append([name, *directions, f"{off:+.0f}", *speeds, verdict])
    header = ["run", "blows to [deg]", "measured", "off"]
    header += ["speed [m/s]", "measured", "ratio", "both near"]
    print_table("steady wind per run, estimated without the anemometer", header, rows)
    near_to = f"{NEAR_DIRECTION:g} deg and {100 * NEAR_SPEED:g} %"
    print(f"within {near_to}: {len(near)} of {len(rows)} runs (goal: {SHARE:g} of them);")
    long = {name for name in found if seconds[name] >= LONG}
    print(f"of the runs of {LONG:g} s or longer {len(near & long)} of {len(long)}")


# ---- judgement


def runs_of_kind(runs: Sequence[FreeRun], kind: str) -> list[FreeRun]:
    """Return the free runs over recordings of one kind; all of them for ""."""
    return [run for run in runs if run.run.startswith(kind)]


def print_judged(runs: Sequence[FreeRun], title: str) -> None:
    """Print the errors of the three models by kind of run and over all runs."""
    rows = []
    for kind in (*JUDGED, ""):
        some = runs_of_kind(runs, kind)
        off = rms_errors(some)
        for family, (what, factor) in UNITS.items():
            goals = ["", ""]
            if not kind and family.startswith("position"):
                goals = list(map("<= {:g}".format, GOALS.values()))
            a, b, c = scale_errors(off[family], factor)
            row = [f"{kind or 'all'}, {what}", str(len(some)), *format_fixed(3, a, b, c)]
            rows.append([*row, f"{c / a:.2f}", goals[0], f"{c / b:.2f}", goals[1]])
    header = ["rms", "free runs", "captive", "retuned", "corrected"]
    header += ["/ captive", "goal", "/ retuned", "goal"]
    print_table(title, header, rows)


def write_errors(runs: Sequence[FreeRun]) -> None:
    """Write the errors by kind of run, for the comparison in `esso_osaka_wind`."""
    found = {kind: rms_errors(runs_of_kind(runs, kind)) for kind in (*JUDGED, "")}
    ERRORS_FILE.parent.mkdir(parents=True, exist_ok=True)
    ERRORS_FILE.write_text(json.dumps(found, indent=1), encoding="utf-8")


def in_wind_of_rest(
    weather: Weather, whole: MappedRecording, stretches: Sequence[Recording], mapper: Mapper
) -> list[FreeRun]:
    """Return free runs over each minute of a run, in the wind estimated from the rest of it."""
    out = []
    for a, b in zip(*free_run_segments(whole.times, HORIZON), strict=True):
        rest = mapper(parts_outside(stretches, float(whole.times[a]), float(whole.times[b])))
        for run in weather.free_runs(whole, weather.find_wind(rest)):
            if run.start_s == whole.times[a]:
                out.append(run)
                break
    return out


@dataclass(frozen=True)
class OpenedRun:
    """A whole run, and its sound stretches."""

    whole: Recording
    stretches: list[Recording]

    @property
    def longest(self) -> Recording:
        """First part of the longest stretch, which is diagnosed."""
        found = max(self.stretches, key=lambda r: float(np.ptp(r.t)))
        return found.between(float(found.t[0]), float(found.t[0]) + WINDOW)


def as_recorded(name: str, recording: Recording) -> Recording:
    """Return the recording without further columns."""
    return recording


def open_runs(
    runs: Mapping[str, Path],
    vessel_name: str,
    completed: Callable[[str, Recording], Recording] = as_recorded,
) -> tuple[dict[str, OpenedRun], Vessel]:
    """Read all runs at the vessel's rate.

    Args:
        runs: Files by run.
        vessel_name: Name or file of the vessel.
        completed: Adds further columns to a run, given its name and recording.

    Returns:
        Runs by name, and the vessel.
    """
    vessel = loading.vessel_of_recording_file(next(iter(runs.values())), vessel_name, ())
    rate = priors.downsampling_rate(vessel)
    found = {}
    for name, path in runs.items():
        recording = completed(name, loading.open_recording(path, vessel_name, ())[0])
        whole = drop_position_outliers(recording.thinned(rate), vessel)
        stretches = sound_stretches(recording, path, SHORTEST)
        found[name] = OpenedRun(whole, [stretch.thinned(rate) for stretch in stretches])
    return found, vessel


def diagnose(runs: Mapping[str, OpenedRun], vessel: Vessel) -> Diagnosis:
    """Diagnose one stretch of each random and zig-zag run."""
    fitted = []
    for name, run in runs.items():
        if name.startswith(FITTED) and name not in HELD_OUT:
            fitted.append(run.longest)
    held_out = [run.whole for run in runs_named(runs, HELD_OUT)]
    vessels = dict.fromkeys(map(attrgetter("path"), (*fitted, *held_out)), vessel)
    note = f"{', '.join(HELD_OUT)}; of the other runs only the longest stretch without a jump, "
    note += f"{WINDOW:g} s at most"
    return pipeline.diagnose_loaded(
        LoadedRecordings(fitted, held_out, vessels, note, horizon=HORIZON)
    )


def mapper_of(diagnosis: Diagnosis, runs: Mapping[str, OpenedRun]) -> Mapper:
    """Return the mapping of recordings on a diagnosed program, with the noise of all runs."""
    stretches = chain.from_iterable(run.stretches for run in runs.values())
    noise = shared_noise(diagnosis.vessel, list(stretches))

    def mapper(recordings: Sequence[Recording]) -> list[MappedRecording]:
        return [diagnosis.map_recording(recording, noise) for recording in recordings]

    return mapper


def main() -> None:
    """Diagnose, estimate each run's wind, judge."""
    begin = time.perf_counter()
    files = runs_of(NAME)
    print_consistency(files)
    runs, vessel = open_runs(files, str(write_vessel()))
    diagnosis = diagnose(runs, vessel)
    write_report(diagnosis, NAME)
    print_verdict(diagnosis)
    mapper = mapper_of(diagnosis, runs)
    mapped = {name: mapper(run.stretches) for name, run in runs.items()}
    fitted = [stretches for name, stretches in mapped.items() if name.startswith(FITTED)]
    problem = diagnosis.problem.with_recordings(list(chain.from_iterable(fitted)))
    ranking = diagnosis.ranking
    recalibrated = converge(problem, ranking.recalibrated)
    weather = Weather(problem, ranking.best)
    weather.refit(fitted)
    winds, seconds = {}, {}
    for name, stretches in mapped.items():
        winds[name] = weather.find_wind(stretches)
        seconds[name] = float(np.ptp(runs[name].whole.t))
    print_winds(winds, seconds)
    fits = {"nominal": ranking.nominal, "recalibrated": recalibrated}
    judged: list[FreeRun] = []
    for name, run in runs.items():
        if not name.startswith(JUDGED):
            continue
        whole = mapper([run.whole])[0]
        before = free_runs(problem, fits, [whole], HORIZON)
        after = in_wind_of_rest(weather, whole, run.stretches, mapper)
        for one, patched in zip(before, after, strict=True):
            channels = {**one.channels, "patched": patched.channels["patched"]}
            judged.append(replace(one, channels=channels))
    print_judged(judged, TITLE)
    write_errors(judged)
    print(f"\n{time.perf_counter() - begin:.0f} s")


if __name__ == "__main__":
    main()
