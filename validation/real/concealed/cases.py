"""The sets of recordings and what is concealed in each: a list of our own."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from boatsim.diagnosis import loading, priors
from boatsim.diagnosis.checks.position_outliers import drop_position_outliers
from boatsim.diagnosis.checks.repeated_positions import drop_repeated_positions
from boatsim.physics.base import Effect
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording
from validation.real import esso_osaka_pond, kvlcc2_roll_decay
from validation.real.common import RECORDINGS
from validation.real.concealed import alterations as a
from validation.real.concealed.alterations import Alteration
from validation.real.concealed.judging import Cause
from validation.real.esso_osaka_vessel import NAME as ESSO
from validation.real.esso_osaka_vessel import SOURCE, written


@dataclass(frozen=True)
class Case:
    """One alteration, and what it looks like; `without`: an effect of the patched vessel that is taken out again."""

    name: str
    truth: tuple[Cause, ...] = ()  # nothing: what no recording can tell
    alter: Alteration = a.unaltered
    without: str = ""
    # with the vessel as published, which lacks all that was found of the unaltered ones besides
    plain: bool = False


@dataclass(frozen=True)
class Laid:
    """Recordings of a set, altered, thinned and split, with their vessel."""

    fitted: Sequence[Recording]
    held_out: Sequence[Recording]
    vessel: Vessel


@dataclass(frozen=True)
class Study:
    """A set of recordings with its cases."""

    name: str
    about: str
    there: Callable[[], bool]
    open: Callable[
        [str | None, Alteration], Laid
    ]  # with a vessel's file, or the one that the recordings name
    cases: Callable[[Vessel], Sequence[Case]]  # by the patched vessel


# ---- what is used of each set


def planar(
    name: str,
    fitted: Mapping[str, float],
    held_out: Mapping[str, float],
    vessel: str | None,
    hertz: float = 0.0,
) -> Callable[[str | None, Alteration], Laid]:
    """Runs of a set, each so many seconds from its beginning at most, at the usual rate or a lower one [Hz]."""

    def laid(patched: str | None, alter: Alteration) -> Laid:
        runs, boats = [], []
        for run, seconds in (*fitted.items(), *held_out.items()):
            path = RECORDINGS / name / "runs" / f"{run}.csv"
            whole, boat = loading.open_recording(path, patched or vessel, ())
            altered = alter(whole.between(whole.t[0], whole.t[0] + seconds))
            rate = min(priors.rate(boat), hertz or priors.rate(boat))
            thin = drop_position_outliers(drop_repeated_positions(altered.thinned(rate)), boat)
            runs.append(replace(thin, name=run))
            boats.append(boat)
        return Laid(runs[: len(fitted)], runs[len(fitted) :], boats[0])

    return laid


def roll_at_rest(patched: str | None, alter: Alteration) -> Laid:
    """Windows of 20 s of the release at rest, every second one unseen."""
    return _release(
        kvlcc2_roll_decay.AT_REST, patched, alter, kvlcc2_roll_decay.cut_windows, slice(1, None, 2)
    )


def roll_at_speed(patched: str | None, alter: Alteration) -> Laid:
    """Thirds of the release at 15.5 kn, the middle one unseen."""
    return _release(
        kvlcc2_roll_decay.AT_SPEED, patched, alter, kvlcc2_roll_decay.thirds, slice(1, 2)
    )


def _release(
    name: str,
    patched: str | None,
    alter: Alteration,
    cut: Callable[[Recording], list[Recording]],
    held_out: slice,
) -> Laid:
    whole, boat = loading.open_recording(kvlcc2_roll_decay.DATA / f"{name}.csv", patched, ())
    parts = cut(replace(alter(whole).thinned(priors.rate(boat)), name=name))
    apart = parts[held_out]
    return Laid([p for p in parts if all(p is not q for q in apart)], apart, boat)


ESSO_FITTED = ("random_0806_1624_4", "zigzag_0731_1350")
ESSO_UNSEEN = ("zigzag_0731_1403",)
ESSO_LONGEST = 150.0  # [s] of a stretch, for the time that it takes


def esso(patched: str | None, alter: Alteration) -> Laid:
    """The longest sound stretch of two runs, and of one unseen; cut where positions leap, before they are altered."""
    vessel, found = patched or str(written()), list[Recording]()
    boat: Vessel | None = None
    for run in (*ESSO_FITTED, *ESSO_UNSEEN):
        path = RECORDINGS / ESSO / "runs" / f"{run}.csv"
        whole, boat = loading.open_recording(path, vessel, ())
        stretches = esso_osaka_pond.sound(whole, path, esso_osaka_pond.SHORTEST)
        longest = max(stretches, key=lambda r: float(r.t[-1] - r.t[0]))
        part = alter(longest.between(longest.t[0], longest.t[0] + ESSO_LONGEST))
        found.append(
            replace(drop_position_outliers(part.thinned(priors.rate(boat)), boat), name=run)
        )
    assert boat is not None
    return Laid(found[: len(ESSO_FITTED)], found[len(ESSO_FITTED) :], boat)


# ---- what is concealed


def taken_out(vessel: Vessel, found: Sequence[Cause]) -> list[Case]:
    """Each effect that the patched vessel was given, taken out again."""
    return [Case(f"{c.name} taken out again", (c,), without=c.name) for c in found]


def number(effect: Effect | None, name: str) -> float:
    """A parameter of an effect that a vessel has."""
    return float(getattr(effect, name))


def late_by(seconds: float) -> Cause:
    """Late commands; to poses and commands alone the same as a clock that is late. Early ones are but that."""
    clock = Cause("clock_offset", {"pose_late_s": seconds})
    return Cause("command_delay", {"delay_s": seconds}, (clock,)) if seconds > 0.0 else clock


def flow(north: float, east: float) -> Cause:
    """A current."""
    return Cause("current", {"north_mps": north, "east_mps": east})


def uneven(factor: float, side: str) -> Cause:
    """A motor that gives `factor` of its thrust: so much less than the other, and of both a little less."""
    fraction = (1.0 - factor) / (1.0 + factor) * (1.0 if side == "starboard" else -1.0)
    return Cause("thrust_imbalance", {"fraction": fraction})


THRUSTS = ("thrust_port_N", "thrust_starboard_N")


def of_blueboat(vessel: Vessel) -> list[Case]:
    """Two motors, satellite fixes, a compass."""
    band = 4.0  # [N]
    return [
        Case("starboard motor gives 0.8", (uneven(0.8, "starboard"),), a.weaker(THRUSTS[1:], 0.8)),
        Case(
            f"dead band of {band:g} N",
            (Cause("thrust_deadband", {"width_N": band}),),
            a.dead_band(THRUSTS, band),
        ),
        Case(
            "both give 0.65 astern",
            (Cause("weak_reverse", {"astern_factor": 0.65}),),
            a.weaker_astern(THRUSTS, 0.65),
        ),
        Case("commands late by 0.4 s", (late_by(0.4),), a.late(THRUSTS, 0.4)),
        Case("current of 0.25, -0.15 m/s", (flow(0.25, -0.15),), a.current(0.25, -0.15)),
        Case(
            "compass off by 0.12 rad",
            (Cause("heading_offset", {"offset_rad": 0.12}),),
            a.heading_off(0.12),
        ),
        Case(
            "origin 80, -30 m away, clock 500 s on",
            (),
            a.chained(a.moved(80.0, -30.0), a.begun_later(500.0)),
        ),
        Case("fixes late by 0.4 s", (Cause("late_fixes", {"latency_s": 0.4}),), a.late_fixes(0.4)),
        Case(
            "compass deviates by 0.15, -0.1 rad",
            (Cause("heading_deviation", {"cos_rad": 0.15, "sin_rad": -0.1}),),
            a.heading_off(0.0, 0.15, -0.1),
        ),
        Case("port motor gives 0.99", (uneven(0.99, "port"),), a.weaker(THRUSTS[:1], 0.99)),
        Case("commands early by 0.4 s", (late_by(-0.4),), a.late(THRUSTS, -0.4)),
        Case("port motor gives 0.85", (uneven(0.85, "port"),), a.weaker(THRUSTS[:1], 0.85)),
    ]


def of_release(vessel: Vessel) -> list[Case]:
    """Roll alone, no commands.

    Roll shown b more is a constant moment of the restoring stiffness times b in a linear law alone: the further a
    righting arm bends, the better the two are told apart, and where they are not either is right. No closed form
    makes the roll of a moment out of one without where the arm bends. Roll shown s times as large has its cubic laws
    divided by s^2, exactly. Seconds shown k times as long divide stiffness per inertia by k^2, damping by k, and
    multiply cubic damping by k.
    """
    arm, damping = vessel.effect("righting_arm"), vessel.effect("cubic_damping")
    stiffness, cubic = (number(arm, n) for n in ("stiffness", "cubic"))
    heel, much, slower, scale = 0.012, 0.05, 1.5, 0.75  # [rad], [rad], ratios
    bent = [Cause("righting_arm_stiffening", {"cubic_perrad2": cubic * (scale**-2 - 1.0)})]
    if damping is not None:
        bent.append(
            Cause("cubic_damping", {"roll_Nms3": number(damping, "roll") * (scale**-2 - 1.0)})
        )
    slow = Cause("metacentric_height_error", {"factor": slower**-2})
    moment = sum(number(e, "roll") for e in vessel.effects if type(e).idea() == "steady_force")

    def askew(offset: float) -> tuple[Cause, ...]:
        return (Cause("roll_offset", {"offset_rad": offset}, (moment_of(stiffness * offset),)),)

    def moment_of(roll: float) -> Cause:
        return Cause("steady_force", {"roll_Nm": roll})

    turned = Cause(
        "roll_offset", {"offset_rad": -2.0 * moment / stiffness}, (moment_of(-2.0 * moment),)
    )
    return [
        Case(f"roll shown {heel:g} rad more", askew(heel), a.rolled(heel)),
        Case(f"roll shown {heel:g} rad less", askew(-heel), a.rolled(-heel)),
        Case(f"roll shown {much:g} rad more", askew(much), a.rolled(much)),
        Case(
            f"roll shown {heel:g} rad more, vessel as published",
            askew(heel),
            a.rolled(heel),
            plain=True,
        ),
        Case(
            f"roll shown {much:g} rad more, vessel as published",
            askew(much),
            a.rolled(much),
            plain=True,
        ),
        Case(f"roll shown {scale:g} times as large", tuple(bent), a.rolled(0.0, scale)),
        Case(f"seconds shown {slower:g} times as long", (slow,), a.ticking(slower)),
        Case("roll sensor the wrong way round", (turned,) if moment else (), a.rolled(0.0, -1.0)),
        Case("roll shown 0.00001 rad more", askew(1e-5), a.rolled(1e-5)),
        Case("clock 500 s on", (), a.begun_later(500.0)),
    ]


RUDDER = ("delta_rad",)


def of_tank(vessel: Vessel) -> list[Case]:
    """One rudder, speeds over the ground recorded beside positions."""
    U = number(vessel.effect("approach_balance"), "speed")
    step = 0.5 * vessel.length / U  # [s] half a length
    late = round(0.2 * step, 1) if vessel.length < 100.0 else round(0.2 * step)
    north, east = 0.04 * U, 0.03 * U
    return [
        Case(
            "rudder off by 0.03 rad",
            (Cause("steering_offset", {"middle_rad": 0.03}),),
            a.off_by(RUDDER, 0.03),
        ),
        Case(
            "rudder steers harder to starboard by 0.25",
            (Cause("steering_asymmetry", {"gain": 0.25}),),
            a.steering_harder(RUDDER, 0.25),
        ),
        Case(
            f"commands late by {late:g} s",
            (late_by(late),),
            a.late((*RUDDER, *_shafts(vessel)), late),
        ),
        Case(
            f"commands early by {late:g} s",
            (late_by(-late),),
            a.late((*RUDDER, *_shafts(vessel)), -late),
        ),
        Case(
            f"current of {north:.2g}, {east:.2g} m/s", (flow(north, east),), a.current(north, east)
        ),
        Case(
            "compass off by 0.05 rad",
            (Cause("heading_offset", {"offset_rad": 0.05}),),
            a.heading_off(0.05),
        ),
        Case(
            "positions 1.06, 0.95 as far",
            (Cause("camera_scale", {"x_fraction": 0.06, "y_fraction": -0.05}),),
            a.stretched(0.06, -0.05),
        ),
        Case(
            "rudder off by 0.00001 rad",
            (Cause("steering_offset", {"middle_rad": 1e-5}),),
            a.off_by(RUDDER, 1e-5),
        ),
    ]


def _shafts(vessel: Vessel) -> tuple[str, ...]:
    """The shaft's channel by which the recordings know it."""
    return ("n_rpm",) if "n_rpm" in vessel.commands else ("n_rps",)


def of_pond(vessel: Vessel) -> list[Case]:
    """Rudder and shaft, ahead and astern, in wind."""
    both = ("delta_rad", "n_rps")
    return [
        Case(
            "rudder off by 0.06 rad",
            (Cause("steering_offset", {"middle_rad": 0.06}),),
            a.off_by(RUDDER, 0.06),
        ),
        Case(
            "shaft's dead band of 1.5 1/s",
            (Cause("shaft_deadband", {"width_pers": 1.5}),),
            a.dead_band(("n_rps",), 1.5),
        ),
        Case("commands late by 1 s", (late_by(1.0),), a.late(both, 1.0)),
        Case("current of 0.06, -0.04 m/s", (flow(0.06, -0.04),), a.current(0.06, -0.04)),
        Case(
            "compass off by 0.1 rad",
            (Cause("heading_offset", {"offset_rad": 0.1}),),
            a.heading_off(0.1),
        ),
        Case(
            "rudder off by 0.00001 rad",
            (Cause("steering_offset", {"middle_rad": 1e-5}),),
            a.off_by(RUDDER, 1e-5),
        ),
    ]


def _recorded(name: str) -> Callable[[], bool]:
    return lambda: any((RECORDINGS / name / "runs").glob("*.csv"))


def _always() -> bool:
    return True


STUDIES = (
    Study(
        "roll_at_rest",
        "tanker released at rest, windows of 20 s",
        _always,
        roll_at_rest,
        of_release,
    ),
    Study(
        "roll_at_speed", "tanker released at 15.5 kn, thirds", _always, roll_at_speed, of_release
    ),
    Study(
        "blueboat",
        "two motors on a lake: 45 and 79 s of two runs at 5 Hz, one unseen",
        _recorded("blueboat_lake"),
        planar(
            "blueboat_lake",
            {"run_218": 45.0, "run_232": 79.0},
            {"run_222": 50.0},
            "blueboat",
            5.0,
        ),
        of_blueboat,
    ),
    Study(
        "marin",
        "tanker at full scale, 1 Hz: the first 500 s of two zig-zags, one unseen",
        _recorded("kvlcc2_marin_free"),
        planar("kvlcc2_marin_free", {"zz_10": 500.0, "zz_m20": 500.0}, {"zz_m10": 500.0}, None),
        of_tank,
    ),
    Study(
        "hsva",
        "tanker model: the first 80 s of two zig-zags at 4 Hz, one unseen",
        _recorded("kvlcc2_hsva_zigzag"),
        planar(
            "kvlcc2_hsva_zigzag", {"Z_20_05": 80.0, "Z_20_10_P": 80.0}, {"Z_15_05": 80.0}, None, 4.0
        ),
        of_tank,
    ),
    Study(
        "esso_osaka",
        "tanker model on a pond: 150 s of two runs, one unseen",
        SOURCE.is_file,
        esso,
        of_pond,
    ),
)
