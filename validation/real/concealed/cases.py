"""Sets of recordings and the causes that are concealed in each."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from operator import attrgetter
from pathlib import Path

from boatsim.diagnosis import loading, priors
from boatsim.diagnosis.checks.position_outliers import drop_position_outliers
from boatsim.diagnosis.checks.repeated_values import drop_repeated_values
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.physics.base import Effect
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording
from validation.real import esso_osaka_pond, kvlcc2_roll_decay
from validation.real.common import RECORDINGS
from validation.real.concealed import alterations as a
from validation.real.concealed.alterations import Alteration
from validation.real.concealed.judging import Cause
from validation.real.esso_osaka_vessel import NAME as ESSO
from validation.real.esso_osaka_vessel import SOURCE, write_vessel


@dataclass(frozen=True)
class Case:
    """One alteration and the cause that it imitates."""

    name: str
    truth: tuple[Cause, ...] = ()  # empty for what no recording shows
    alter: Alteration = a.unaltered
    without: str = ""  # effect that is removed from the patched vessel
    # use the vessel as published, which lacks all that was found in the unaltered recordings
    plain: bool = False


# opens altered recordings, with the file of a patched vessel or with the published vessel
Opener = Callable[[str | None, Alteration], LoadedRecordings]


@dataclass(frozen=True)
class Study:
    """A set of recordings with its cases."""

    name: str
    about: str
    runs: Path  # recordings, or another file without which the set cannot be used
    open: Opener
    cases: Callable[[Vessel], Sequence[Case]]  # for the patched vessel


# ---- recordings of each set


def split(
    fitted: Sequence[Recording], held_out: Sequence[Recording], vessel: Vessel
) -> LoadedRecordings:
    """Return recordings of one vessel as a diagnosis takes them."""
    paths = map(attrgetter("path"), (*fitted, *held_out))
    return LoadedRecordings(fitted, held_out, dict.fromkeys(paths, vessel), "one recording")


def planar_opener(
    name: str,
    fitted: Mapping[str, float],
    held_out: Mapping[str, float],
    published: str | None,
    hertz: float = 0.0,
) -> Opener:
    """Return an opener of runs in the plane.

    Args:
        name: Name of the set.
        fitted: Runs with the seconds that are used of each at most, from its beginning.
        held_out: The same for held-out runs.
        published: Published vessel, None if the recordings name it.
        hertz: Largest rate of the rows [Hz], 0 for the vessel's usual one.
    """

    def open_runs(patched: str | None, alter: Alteration) -> LoadedRecordings:
        runs = []
        for run, seconds in (*fitted.items(), *held_out.items()):
            path = RECORDINGS / name / "runs" / f"{run}.csv"
            whole, vessel = loading.open_recording(path, patched or published, ())
            altered = alter(whole.between(whole.t[0], whole.t[0] + seconds))
            rate = priors.downsampling_rate(vessel)
            thin = altered.thinned(min(rate, hertz or rate))
            runs.append(replace(clean_recording(thin, vessel), name=run))
        return split(runs[: len(fitted)], runs[len(fitted) :], vessel)

    return open_runs


def clean_recording(recording: Recording, vessel: Vessel) -> Recording:
    """Return a recording without repeated positions and outliers."""
    return drop_position_outliers(drop_repeated_values(recording), vessel)


def open_release_at_rest(patched: str | None, alter: Alteration) -> LoadedRecordings:
    """Return windows of 20 s of the release at rest, every second one held out."""
    parts, vessel = _release(
        kvlcc2_roll_decay.AT_REST, patched, alter, kvlcc2_roll_decay.windows_of
    )
    return split(parts[::2], parts[1::2], vessel)


def open_release_at_speed(patched: str | None, alter: Alteration) -> LoadedRecordings:
    """Return thirds of the release at 15.5 kn, the middle one held out."""
    parts, vessel = _release(
        kvlcc2_roll_decay.AT_SPEED, patched, alter, kvlcc2_roll_decay.thirds_of
    )
    return split(parts[::2], parts[1:2], vessel)


def _release(
    name: str,
    patched: str | None,
    alter: Alteration,
    cut: Callable[[Recording], list[Recording]],
) -> tuple[list[Recording], Vessel]:
    path = kvlcc2_roll_decay.DATA / f"{name}.csv"
    whole, vessel = loading.open_recording(path, patched, ())
    return cut(replace(alter(whole).thinned(priors.downsampling_rate(vessel)), name=name)), vessel


ESSO_FITTED = ("random_0806_1624_4", "zigzag_0731_1350")
ESSO_HELD_OUT = "zigzag_0731_1403"
ESSO_LONGEST = 150.0  # [s] of a stretch, to limit the computing time


def open_esso_osaka(patched: str | None, alter: Alteration) -> LoadedRecordings:
    """Return the longest sound stretch of three runs, one of them held out.

    Runs are cut where positions jump, before they are altered.
    """
    vessel_name = patched or str(write_vessel())
    found = []
    for run in (*ESSO_FITTED, ESSO_HELD_OUT):
        path = RECORDINGS / ESSO / "runs" / f"{run}.csv"
        whole, vessel = loading.open_recording(path, vessel_name, ())
        stretches = esso_osaka_pond.sound_stretches(whole, path, esso_osaka_pond.SHORTEST)
        longest = max(stretches, key=lambda r: float(r.t[-1] - r.t[0]))
        part = alter(longest.between(longest.t[0], longest.t[0] + ESSO_LONGEST))
        thin = drop_position_outliers(part.thinned(priors.downsampling_rate(vessel)), vessel)
        found.append(replace(thin, name=run))
    return split(found[:-1], found[-1:], vessel)


# ---- concealed causes

THRUSTS = ("thrust_port_N", "thrust_starboard_N")
RUDDER = ("delta_rad",)


def removal_cases(found: Sequence[Cause]) -> list[Case]:
    """Return cases in which each effect of the patched vessel is removed."""
    return [Case(f"{cause.name} removed", (cause,), without=cause.name) for cause in found]


def effect_parameter(effect: Effect | None, name: str) -> float:
    """Return a parameter of an effect of a vessel."""
    return float(getattr(effect, name))


def delay_case(channels: Sequence[str], seconds: float) -> Case:
    """Return a case of delayed commands, or early ones if the delay is negative."""
    when = "late" if seconds > 0.0 else "early"
    alter = a.delay_commands(channels, seconds)
    return Case(f"commands {when} by {abs(seconds):g} s", (delay_cause(seconds),), alter)


def delay_cause(seconds: float) -> Cause:
    """Return the cause of delayed commands.

    For poses and commands alone a delay is equivalent to a delayed clock. Early commands can only
    be explained by the clock.
    """
    clock = Cause("clock_offset", {"pose_late_s": seconds})
    if seconds <= 0.0:
        return clock
    return Cause("command_delay", {"delay_s": seconds}, (clock,))


def current_case(north: float, east: float, digits: str = "g") -> Case:
    """Return a case of a current [m/s]."""
    cause = Cause("current", {"north_mps": north, "east_mps": east})
    name = f"current of {north:{digits}}, {east:{digits}} m/s"
    return Case(name, (cause,), a.add_current(north, east))


def compass_case(offset: float) -> Case:
    """Return a case of a compass with a constant error [rad]."""
    cause = Cause("heading_offset", {"offset_rad": offset})
    return Case(f"compass off by {offset:g} rad", (cause,), a.add_compass_error(offset))


def rudder_case(offset: float) -> Case:
    """Return a case of a rudder with a constant error [rad]."""
    cause = Cause("steering_offset", {"middle_rad": offset})
    name = f"rudder off by {offset:.5f}".rstrip("0") + " rad"
    return Case(name, (cause,), a.offset_commands(RUDDER, offset))


def motor_cause(factor: float, side: str) -> Cause:
    """Return the cause of a motor that gives a factor of its thrust.

    It is an imbalance together with a slightly lower thrust of both motors.
    """
    fraction = (1.0 - factor) / (1.0 + factor)
    if side != "starboard":
        fraction = -fraction
    return Cause("thrust_imbalance", {"fraction": fraction})


def motor_case(side: str, factor: float) -> Case:
    """Return a case of a motor that gives a factor of its thrust."""
    alter = a.weaken_motors((f"thrust_{side}_N",), factor)
    return Case(f"{side} motor gives {factor:g}", (motor_cause(factor, side),), alter)


def blueboat_cases(vessel: Vessel) -> list[Case]:
    """Return the cases of two motors, satellite fixes and a compass."""
    band = Cause("thrust_deadband", {"width_N": 4.0})
    astern = Cause("weak_reverse", {"astern_factor": 0.65})
    fixes = Cause("late_fixes", {"latency_s": 0.4})
    deviation = Cause("heading_deviation", {"cos_rad": 0.15, "sin_rad": -0.1})
    frame = a.chain(a.shift_origin(80.0, -30.0), a.shift_clock(500.0))
    return [
        motor_case("starboard", 0.8),
        Case("dead band of 4 N", (band,), a.add_dead_band(THRUSTS, 4.0)),
        Case("both give 0.65 astern", (astern,), a.weaken_motors_astern(THRUSTS, 0.65)),
        delay_case(THRUSTS, 0.4),
        current_case(0.25, -0.15),
        compass_case(0.12),
        Case("origin 80, -30 m away, clock 500 s on", (), frame),
        Case("fixes late by 0.4 s", (fixes,), a.delay_positions(0.4)),
        Case(
            "compass deviates by 0.15, -0.1 rad", (deviation,), a.add_compass_error(0.0, 0.15, -0.1)
        ),
        motor_case("port", 0.99),
        delay_case(THRUSTS, -0.4),
        motor_case("port", 0.85),
    ]


def release_cases(vessel: Vessel) -> list[Case]:
    """Return the cases of roll alone, without commands.

    A roll offset b is equivalent to a constant moment of the restoring stiffness times b only if
    the restoring moment is linear. The more the righting arm bends, the better the two are
    distinguished; where it does not bend, either is right. If the arm bends, no closed form turns a
    recording without a moment into one with it. Roll readings s times as large divide the cubic
    coefficients by s^2, exactly. A clock that counts k times as many seconds divides stiffness per
    inertia by k^2, damping by k, and multiplies cubic damping by k.
    """
    arm, damping = vessel.effect("righting_arm"), vessel.effect("cubic_damping")
    stiffness = effect_parameter(arm, "stiffness")
    slower, scale = 1.5, 0.75
    growth = scale**-2 - 1.0
    bent = [
        Cause("righting_arm_stiffening", {"cubic_perrad2": effect_parameter(arm, "cubic") * growth})
    ]
    if damping is not None:
        bent.append(
            Cause("cubic_damping", {"roll_Nms3": effect_parameter(damping, "roll") * growth})
        )
    slow = Cause("metacentric_height_error", {"factor": slower**-2})
    moment = 0.0
    for effect in vessel.effects:
        if type(effect).type_name() == "steady_force":
            moment += effect_parameter(effect, "roll")
    reversed_roll: tuple[Cause, ...] = ()
    if moment:
        steady = Cause("steady_force", {"roll_Nm": -2.0 * moment})
        offset = {"offset_rad": -2.0 * moment / stiffness}
        reversed_roll = (Cause("roll_offset", offset, (steady,)),)

    def more(name: str, offset: float, plain: bool = False) -> Case:
        steady = Cause("steady_force", {"roll_Nm": stiffness * offset})
        cause = Cause("roll_offset", {"offset_rad": offset}, (steady,))
        return Case(f"roll reading {name}", (cause,), a.alter_roll(offset), plain=plain)

    return [
        more("0.012 rad more", 0.012),
        more("0.012 rad less", -0.012),
        more("0.05 rad more", 0.05),
        more("0.012 rad more, vessel as published", 0.012, plain=True),
        more("0.05 rad more, vessel as published", 0.05, plain=True),
        Case(f"roll reading {scale:g} times as large", tuple(bent), a.alter_roll(0.0, scale)),
        Case(f"clock {slower:g} times as fast", (slow,), a.scale_clock(slower)),
        Case("roll sensor reversed", reversed_roll, a.alter_roll(0.0, -1.0)),
        more("0.00001 rad more", 1e-5),
        Case("clock 500 s on", (), a.shift_clock(500.0)),
    ]


def tank_cases(vessel: Vessel) -> list[Case]:
    """Return the cases of one rudder, with recorded positions and speeds over the ground."""
    U = effect_parameter(vessel.effect("approach_balance"), "speed")
    step = 0.5 * vessel.length / U  # [s] half a length
    delay: float = round(0.2 * step)
    if vessel.length < 100.0:
        delay = round(0.2 * step, 1)
    shaft = "n_rps"
    if "n_rpm" in vessel.commands:
        shaft = "n_rpm"
    commands = (*RUDDER, shaft)
    gain = Cause("steering_asymmetry", {"gain": 0.25})
    scale = Cause("camera_scale", {"x_fraction": 0.06, "y_fraction": -0.05})
    return [
        rudder_case(0.03),
        Case(
            "rudder steers harder to starboard by 0.25",
            (gain,),
            a.steer_harder_to_one_side(RUDDER, 0.25),
        ),
        delay_case(commands, delay),
        delay_case(commands, -delay),
        current_case(0.04 * U, 0.03 * U, ".2g"),
        compass_case(0.05),
        Case("positions 1.06, 0.95 as far", (scale,), a.stretch_positions(0.06, -0.05)),
        rudder_case(1e-5),
    ]


def pond_cases(vessel: Vessel) -> list[Case]:
    """Return the cases of rudder and shaft, ahead and astern, in wind."""
    band = Cause("shaft_deadband", {"width_pers": 1.5})
    return [
        rudder_case(0.06),
        Case("shaft's dead band of 1.5 1/s", (band,), a.add_dead_band(("n_rps",), 1.5)),
        delay_case(("delta_rad", "n_rps"), 1.0),
        current_case(0.06, -0.04),
        compass_case(0.1),
        rudder_case(1e-5),
    ]


STUDIES = (
    Study(
        "roll_at_rest",
        "tanker released at rest, windows of 20 s",
        kvlcc2_roll_decay.DATA,
        open_release_at_rest,
        release_cases,
    ),
    Study(
        "roll_at_speed",
        "tanker released at 15.5 kn, thirds",
        kvlcc2_roll_decay.DATA,
        open_release_at_speed,
        release_cases,
    ),
    Study(
        "blueboat",
        "two motors on a lake: 45 and 79 s of two runs at 5 Hz, one held out",
        RECORDINGS / "blueboat_lake" / "runs",
        planar_opener(
            "blueboat_lake",
            {"run_218": 45.0, "run_232": 79.0},
            {"run_222": 50.0},
            "blueboat",
            5.0,
        ),
        blueboat_cases,
    ),
    Study(
        "marin",
        "tanker at full scale, 1 Hz: the first 500 s of two zig-zags, one held out",
        RECORDINGS / "kvlcc2_marin_free" / "runs",
        planar_opener(
            "kvlcc2_marin_free", {"zz_10": 500.0, "zz_m20": 500.0}, {"zz_m10": 500.0}, None
        ),
        tank_cases,
    ),
    Study(
        "hsva",
        "tanker model: the first 80 s of two zig-zags at 4 Hz, one held out",
        RECORDINGS / "kvlcc2_hsva_zigzag" / "runs",
        planar_opener(
            "kvlcc2_hsva_zigzag", {"Z_20_05": 80.0, "Z_20_10_P": 80.0}, {"Z_15_05": 80.0}, None, 4.0
        ),
        tank_cases,
    ),
    Study(
        "esso_osaka",
        "tanker model on a pond: 150 s of two runs, one held out",
        SOURCE,
        open_esso_osaka,
        pond_cases,
    ),
)
