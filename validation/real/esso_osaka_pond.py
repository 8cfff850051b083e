"""A 3 m tanker on a pond, at low speed ahead and astern, in wind: `python -m validation.real.esso_osaka_pond`.

The nominal is the MMG model of captive tests of the same hull, the baseline the same with its coefficients refitted.
Nobody says that there was wind: positions and commands have to show it, and the anemometer is then laid beside what
they showed. Fitted on random and zig-zag runs, judged on turns and berthing by free runs of 60 s. Wind is no property
of a ship: for each minute that is judged it is found in the rest of that run, with all else as fitted. Recorded
velocities are not used; nor, in what is fitted, fixes held over, and runs are cut at leaps, for the reasons that are
printed first. What is judged is judged as it was recorded.
"""

import json
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

from boatsim.diagnosis import loading, pipeline, priors
from boatsim.diagnosis.checks.position_outliers import drop_position_outliers
from boatsim.diagnosis.coordinate_search import maximize
from boatsim.diagnosis.filter import MappedRecording, segments, shared_noise
from boatsim.diagnosis.fit import converge, fit
from boatsim.diagnosis.free_runs import FreeRun, errors, free_runs
from boatsim.diagnosis.loading import Loaded
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.diagnosis.problem import Fit, FreeParameter, Problem
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording
from validation.real.common import OUT, RECORDINGS, report, runs_of, table
from validation.real.esso_osaka_vessel import NAME, SOURCE, written

FITTED, JUDGED = ("random", "zigzag"), ("turn", "berthing")
UNSEEN = (
    "random_0731_1248",
    "random_0806_1624_6",
    "zigzag_0731_1403",
)  # of the fitted days, for the diagnosis itself
WINDOW = 300.0  # [s] of each run that the diagnosis is given at most, for the time it takes
HORIZON = 60.0  # [s] of a free run
MODELS = ("nominal", "recalibrated", "patched")
TITLE = f"fitted on {' and '.join(FITTED)} runs, judged on {' and '.join(JUDGED)}"
KEPT = OUT / NAME / "judged.json"
GOALS = {"nominal": 0.75, "recalibrated": 0.9}  # position, patched over this one
UNITS = {
    "position_rms_m": ("position [m]", np.sqrt(2.0)),
    "heading_rms_rad": ("heading [deg]", 57.29578),
}
LONG = 250.0  # [s] of a run in which a ship of 3 m has met the wind from several sides
NEAR_DIRECTION, NEAR_SIZE, SHARE = 30.0, 0.3, 0.75  # [deg], relative, of the runs
WEATHER = ("force", "toward")  # of the wind: the rest says how the hull takes it
ROUNDS = 3  # of ship and winds in turn
STARTS = (0.0, 0.5 * np.pi, np.pi, -0.5 * np.pi)  # [rad] the wind may blow to
USUAL = 0.5  # [N] of a breeze, to begin with
NEARLY = 0.1  # [nats] that a wind is near enough its best
SHORTEST = 15.0  # [s] of a stretch that is used
SMOOTH, AROUND = 2.0, 5.0  # [s] over which a rate is taken; about a defect not compared
LEAP, STEP = 0.1, 0.03  # [m], [rad] in a row of 0.1 s: twice as fast as the ship ever goes or turns
LATE, SOON = (
    2.5,
    0.2,
)  # [s] before a leap back, and behind it, in which fixes are late: the longest gap is as long


# ---- the recordings themselves


@dataclass(frozen=True)
class Checked:
    """How far positions, headings and recorded velocities of a run agree."""

    bridged: float  # share of rows whose fix was held over
    leaps: int  # rows in which position or heading moves further than the ship
    late_s: float  # recorded velocities behind the rates of x and y
    aft_m: float  # their point aft of the one whose x and y are recorded
    drift: float  # recorded sway velocity per that of x and y


def checked(path: Path) -> Checked:
    """The same run by its positions and by its velocities."""
    d = np.genfromtxt(path, delimiter=",", names=True)
    psi, dt = d["psi_rad"], float(np.median(np.diff(d["t_s"])))
    n = round(0.5 * SMOOTH / dt)
    bridged, leaps = defects(d)
    wide = np.ones(2 * round(AROUND / dt) + 1)
    good = np.convolve(bridged | leaps, wide, "same") < 0.5
    good[: 4 * n] = good[-4 * n :] = False

    def slope(x: Array) -> Array:
        return np.asarray(np.convolve(x, _derivative(n, dt), "same"))

    north, east = slope(d["x_m"]), slope(d["y_m"])
    u, v = np.cos(psi) * north + np.sin(psi) * east, np.cos(psi) * east - np.sin(psi) * north
    mean = np.ones(2 * n + 1) / (2 * n + 1)
    said_u, said_v, said_r = (
        np.convolve(d[c], mean, "same") for c in ("u_mps", "v_mps", "r_radps")
    )

    def off(k: int) -> tuple[float, Array]:
        """Misfit with the velocities taken k rows earlier, and sway velocity by positions as v, r and 1 make it."""
        along, across = np.roll(said_u, -k)[good], np.roll(said_v, -k)[good]
        A = np.column_stack([across, said_r[good], np.ones(int(good.sum()))])
        made = np.linalg.lstsq(A, v[good], rcond=None)[0]
        return float(np.var(u[good] - along) + np.var(v[good] - A @ made)), made

    shift = min(range(-10, 16), key=lambda k: off(k)[0])
    made = off(shift)[1]
    return Checked(
        float(np.mean(d["filled"] > 0.0)),
        int(leaps.sum()),
        shift * dt,
        float(made[1]),
        1.0 / float(made[0]),
    )


def _derivative(n: int, dt: float) -> Array:
    """Weights of the slope of a straight line through 2 n + 1 rows."""
    k = np.arange(n, -n - 1, -1)
    return np.asarray(k / (dt * float(np.sum(k**2))))


def defects(d: Array) -> tuple[Array, Array]:
    """Rows whose fix is bridged, rows from which position or heading leaps to the next (booleans)."""
    moved = np.hypot(np.diff(d["x_m"], append=d["x_m"][-1]), np.diff(d["y_m"], append=d["y_m"][-1]))
    turned = np.diff(d["psi_rad"], append=d["psi_rad"][-1]) - d["r_radps"] * np.diff(
        d["t_s"], append=d["t_s"][-1]
    )
    return d["filled"] > 0.0, (moved > LEAP) | (np.abs(turned) > STEP)


def sound(recording: Recording, path: Path, shortest: float) -> list[Recording]:
    """Stretches of a recording between leaps, without fixes that are bridged, or late before the leap (nan)."""
    d = np.genfromtxt(path, delimiter=",", names=True)
    bridged, leaps = defects(d)
    gone = bridged[np.searchsorted(d["t_s"], recording.t - 1e-6)]
    fixes = {n: np.where(gone, np.nan, recording[n]) for n in ("x_m", "y_m", "psi_rad")}
    whole = replace(recording, signals={**recording.signals, **fixes})
    at = d["t_s"][leaps]
    begins, ends = [whole.t[0], *(at + SOON)], [*(at - LATE), whole.t[-1]]
    return [
        whole.between(float(a), float(b))
        for a, b in zip(begins, ends, strict=True)
        if b - a >= shortest
    ]


def print_recordings(runs: Mapping[str, Path]) -> None:
    """What is wrong with them, by kind of run, medians."""
    rows = []
    for kind in (*FITTED, *JUDGED):
        found = [checked(p) for n, p in runs.items() if n.startswith(kind)]
        middle = [
            float(np.median([getattr(c, f) for c in found])) for f in ("late_s", "aft_m", "drift")
        ]
        bridged = float(np.mean([c.bridged for c in found]))
        cells = (
            f"{100 * bridged:.1f} %",
            str(sum(c.leaps for c in found)),
            *(f"{x:.2f}" for x in middle),
        )
        rows.append([kind, str(len(found)), *cells])
    header = [
        "",
        "runs",
        "bridged",
        "leaps",
        "u, v late [s]",
        "v's point aft [m]",
        "v / that of x, y",
    ]
    table("what is wrong with the recordings (medians over runs)", header, rows)
    print(
        "(fixes held over are bridged: left out; behind some of them position or heading leaps, by up to 10 deg that"
    )
    print(
        " the yaw rate has not got: runs are cut there; recorded u, v lag behind x, y and are those of another point of"
    )
    print(" the ship in turns: not used)")


# ---- wind, run by run


@cache
def per_square() -> float:
    """Side force beam-on per square of the wind's speed [N s^2/m^2], by what is stated beside the recordings."""
    stated = json.loads(SOURCE.read_text(encoding="utf-8"))
    area, density = stated["above_water"]["lateral_area_m2"], stated["density_air_kgm3"]
    return float(0.5 * density * area * stated["mmg"]["wind"]["Y1"])


@dataclass(frozen=True)
class Wind:
    """A steady push."""

    force: float  # [N] beam-on
    toward: float  # [rad] from the x axis, clockwise

    @property
    def speed(self) -> float:
        """The steady wind that pushes so [m/s]."""
        return float(np.sqrt(self.force / per_square()))


def towards(push: Array) -> Wind:
    """The wind that pushes so far north and east [N]."""
    return Wind(float(np.hypot(*push)), float(np.arctan2(push[1], push[0])))


def measured(name: str) -> Wind:
    """By the anemometer: the steady wind with the mean push of the gusts."""
    d = np.genfromtxt(RECORDINGS / NAME / "wind" / f"{name}.csv", delimiter=",", names=True)
    speed, comes_from = d["true_speed_mps"], d["true_direction_rad"]
    north, east = (-float(np.nanmean(speed**2 * f(comes_from))) for f in (np.cos, np.sin))
    return Wind(per_square() * float(np.hypot(north, east)), float(np.arctan2(east, north)))


def of_weather(free: FreeParameter) -> bool:
    """Whether a parameter belongs to the day and not to the ship."""
    return free.effect == "wind" and free.name in WEATHER


Laid = Callable[
    [Sequence[Recording]], list[MappedRecording]
]  # recordings laid on the one compiled program


class Weather:
    """A fit of a ship in which every run may have a wind of its own."""

    def __init__(self, problem: Problem, ship: Fit) -> None:
        """`ship` with or without a wind of all runs."""
        names = ship.effects if "wind" in ship.effects else (*ship.effects, "wind")
        free = problem.parameters(names)
        known = {(f.effect, f.name): x for f, x in zip(ship.free, ship.theta, strict=True)}
        theta = np.array([known.get((f.effect, f.name), f.mean) for f in free])
        self.problem = problem
        self.own = [i for i, f in enumerate(free) if of_weather(f)]
        self.rest = [i for i, f in enumerate(free) if not of_weather(f)]
        self.ship = Fit(names, free, theta, np.diag([f.sd**2 for f in free]), ship.levels, -np.inf)

    def _part(self, at: Sequence[int], theta: Array | None = None) -> Fit:
        free = tuple(self.ship.free[i] for i in at)
        x = self.ship.theta[at] if theta is None else theta
        return Fit(
            self.ship.effects, free, x, np.diag([f.sd**2 for f in free]), self.ship.levels, -np.inf
        )

    def wind(self, tracks: Sequence[MappedRecording]) -> Wind:
        """The wind common to some tracks, with the ship as fitted.

        Sought as a push north and one east, each as likely either way: a force and its bearing would make calm likelier
        than any one wind, though there always is some.
        """
        part = self._part(self.rest)
        held = [replace(t, values=self.problem.values(t, part.free, part.theta)) for t in tracks]
        on = self.problem.program.switches(self.ship.effects)
        usual = next(self.ship.free[i].sd for i in self.own if self.ship.free[i].name == "force")

        def score(x: Array) -> float:
            blown = self.problem.on([self.blown(t, towards(x)) for t in held])
            likelihood = blown.log_likelihood((), np.zeros(0), on, self.ship.levels)
            return likelihood - 0.5 * float(x @ x) / usual**2

        begun = [USUAL * np.array([np.cos(a), np.sin(a)]) for a in STARTS]
        return towards(
            max((maximize(score, x, USUAL, NEARLY) for x in begun), key=lambda found: found[0])[1]
        )

    def blown(self, one: MappedRecording, wind: Wind) -> MappedRecording:
        """A track with that wind among its own values."""
        values = one.values.copy()
        for name in WEATHER:
            values[self.problem.program.index("wind", name)] = getattr(wind, name)
        return replace(one, values=values)

    def refit(self, runs: Sequence[Sequence[MappedRecording]]) -> None:
        """The ship again, each run in its own wind, and the winds again."""
        for _ in range(ROUNDS):
            winds = [self.wind(tracks) for tracks in runs]
            pairs = zip(runs, winds, strict=True)
            on = self.problem.on([self.blown(t, wind) for tracks, wind in pairs for t in tracks])
            found = fit(on, self._part(self.rest))
            self.ship.theta[self.rest] = found.theta
            self.ship = replace(self.ship, levels=found.levels)

    def free_runs(self, one: MappedRecording, wind: Wind) -> list[FreeRun]:
        """Free runs of the ship over a run in that wind."""
        return free_runs(
            self.problem, {"patched": self._part(self.rest)}, [self.blown(one, wind)], HORIZON
        )


def around(stretches: Sequence[Recording], a: float, b: float) -> list[Recording]:
    """What stretches of a run lie before and behind one minute."""
    out = []
    for whole in stretches:
        for begin, end in ((float(whole.t[0]), a), (b, float(whole.t[-1]))):
            inside = (whole.t > begin - 1e-9) & (whole.t < end + 1e-9)
            if inside.any() and float(np.ptp(whole.t[inside])) >= SHORTEST:
                out.append(whole.between(begin, end))
    return out


def print_winds(found: Mapping[str, Wind], seconds: Mapping[str, float]) -> None:
    """Found in each run, all of it, beside what the anemometer says."""
    rows, near = [], list[str]()
    for name, wind in found.items():
        truth = measured(name)
        turned = np.degrees(np.angle(np.exp(1j * (wind.toward - truth.toward))))
        size = wind.speed / truth.speed
        good = abs(turned) <= NEAR_DIRECTION and abs(size - 1.0) <= NEAR_SIZE
        near += [name] if good else []
        said = [f"{np.degrees(np.angle(np.exp(1j * w.toward))):.0f}" for w in (wind, truth)]
        cells = (
            *said,
            f"{turned:+.0f}",
            f"{wind.speed:.2f}",
            f"{truth.speed:.2f}",
            f"{size:.2f}",
            "yes" if good else "-",
        )
        rows.append([name, *cells])
    header = [
        "run",
        "blows to [deg]",
        "measured",
        "off",
        "speed [m/s]",
        "measured",
        "ratio",
        "both near",
    ]
    table("steady wind per run, found without the anemometer", header, rows)
    near_to = f"{NEAR_DIRECTION:g} deg and {100 * NEAR_SIZE:g} %"
    print(f"within {near_to}: {len(near)} of {len(rows)} runs (goal {SHARE:g} of them);")
    long = [n for n in found if seconds[n] >= LONG]
    print(f"of the runs of {LONG:g} s or longer {sum(n in near for n in long)} of {len(long)}")


# ---- judged


def print_judged(stretches: Sequence[FreeRun], title: str) -> None:
    """Errors of the three models by kind of run and together."""
    rows = []
    for kind in (*JUDGED, ""):
        some = [s for s in stretches if s.run.startswith(kind)]
        off = errors(some)
        for family, (what, factor) in UNITS.items():
            a, b, c = (off[family][m] * factor for m in MODELS)
            goals = [
                f"<= {GOALS[m]:g}" if not kind and family.startswith("position") else ""
                for m in GOALS
            ]
            cells = [
                f"{a:.3f}",
                f"{b:.3f}",
                f"{c:.3f}",
                f"{c / a:.2f}",
                goals[0],
                f"{c / b:.2f}",
                goals[1],
            ]
            rows.append([f"{kind or 'all'}, {what}", str(len(some)), *cells])
    header = [
        "rms",
        "free runs",
        "captive",
        "recalibrated",
        "patched",
        "/ captive",
        "goal",
        "/ recalibrated",
        "goal",
    ]
    table(title, header, rows)


def keep(stretches: Sequence[FreeRun]) -> None:
    """What was judged, for the second mode to be laid beside it."""
    found = {
        kind: errors([s for s in stretches if s.run.startswith(kind)]) for kind in (*JUDGED, "")
    }
    KEPT.parent.mkdir(parents=True, exist_ok=True)
    KEPT.write_text(json.dumps(found, indent=1), encoding="utf-8")


def with_model(stretches: Sequence[FreeRun], patched: Sequence[FreeRun]) -> list[FreeRun]:
    """The same stretches with what another boat does in them."""
    return [
        replace(s, channels={**s.channels, "patched": p.channels["patched"]})
        for s, p in zip(stretches, patched, strict=True)
    ]


def in_rests_wind(
    weather: Weather, whole: MappedRecording, stretches: Sequence[Recording], laid: Laid
) -> list[FreeRun]:
    """Free runs over each minute of a run, in the wind found in the rest of that run."""
    out = []
    for a, b in zip(*segments(whole.times, HORIZON), strict=True):
        rest = laid(around(stretches, float(whole.times[a]), float(whole.times[b])))
        found = weather.free_runs(whole, weather.wind(rest))
        out.append(next(s for s in found if s.start_s == whole.times[a]))
    return out


@dataclass(frozen=True)
class Opened:
    """A run as a diagnosis takes it up: whole, and its sound stretches."""

    whole: Recording
    stretches: list[Recording]

    @property
    def longest(self) -> Recording:
        """The first part of its longest stretch: what the diagnosis is given."""
        found = max(self.stretches, key=lambda r: float(np.ptp(r.t)))
        return found.between(float(found.t[0]), float(found.t[0]) + WINDOW)


def as_recorded(name: str, recording: Recording) -> Recording:
    """A run with nothing laid beside it."""
    return recording


def opened(
    runs: Mapping[str, Path],
    vessel: str,
    completed: Callable[[str, Recording], Recording] = as_recorded,
) -> tuple[dict[str, Opened], Vessel]:
    """Every run, thinned, once what there is beside it is laid there."""
    boat = loading.vessel_for(next(iter(runs.values())), vessel, ())
    rate, found = priors.rate(boat), {}
    for name, path in runs.items():
        recording = completed(name, loading.open_recording(path, vessel, ())[0])
        parts = [r.thinned(rate) for r in sound(recording, path, SHORTEST)]
        found[name] = Opened(drop_position_outliers(recording.thinned(rate), boat), parts)
    return found, boat


def diagnosed(recordings: Mapping[str, Opened], boat: Vessel) -> Diagnosis:
    """What is missing, by a stretch of each random and zig-zag run."""
    some = {n: one for n, one in recordings.items() if n.startswith(FITTED)}
    fitted = [one.longest for n, one in some.items() if n not in UNSEEN]
    held_out = [some[n].whole for n in UNSEEN]
    boats = {r.path: boat for r in (*fitted, *held_out)}
    note = f"{', '.join(UNSEEN)}; of the others the longest stretch without a leap, {WINDOW:g} s at most"
    return pipeline.diagnose_loaded(Loaded(fitted, held_out, boats, note, horizon=HORIZON))


def print_named(found: Diagnosis) -> None:
    """The verdict and what is named."""
    answer = found.findings.answer
    print(f"\nverdict: {answer['verdict']}")
    for e in answer["effects"]:
        values = ", ".join(
            f"{k} {p['value']:.3g} +- {p['sd']:.2g}" for k, p in e["parameters"].items()
        )
        tied = f"; hardly to be told from {', '.join(e['tied_with'])}" if e["tied_with"] else ""
        print(f"  {e['kind']}: {e['name']} ({e['gain_nats']:.0f} nats): {values}{tied}")


def main() -> None:
    """Diagnose, find each run's wind, judge."""
    begin = time.perf_counter()
    runs = runs_of(NAME)
    print_recordings(runs)
    recordings, boat = opened(runs, str(written()))
    found = diagnosed(recordings, boat)
    report(found, NAME)
    print_named(found)
    stated = shared_noise(boat, [r for one in recordings.values() for r in one.stretches])

    def laid(some: Sequence[Recording]) -> list[MappedRecording]:
        return [found.map_recording(r, stated) for r in some]

    tracks = {n: laid(one.stretches) for n, one in recordings.items()}
    fitted = {n: some for n, some in tracks.items() if n.startswith(FITTED)}
    judged = {n: laid([one.whole])[0] for n, one in recordings.items() if n.startswith(JUDGED)}
    problem = found.problem.on([t for some in fitted.values() for t in some])
    ranking = found.ranking
    recalibrated = converge(problem, ranking.recalibrated)
    weather = Weather(problem, ranking.best)
    weather.refit(list(fitted.values()))
    seconds = {n: float(np.ptp(one.whole.t)) for n, one in recordings.items()}
    print_winds({n: weather.wind(some) for n, some in tracks.items()}, seconds)
    fits = {"nominal": ranking.nominal, "recalibrated": recalibrated}
    before = free_runs(problem, fits, list(judged.values()), HORIZON)
    after = [
        s
        for n, t in judged.items()
        for s in in_rests_wind(weather, t, recordings[n].stretches, laid)
    ]
    judgement = with_model(before, after)
    print_judged(judgement, TITLE)
    keep(judgement)
    print(f"\n{time.perf_counter() - begin:.0f} s")


if __name__ == "__main__":
    main()
