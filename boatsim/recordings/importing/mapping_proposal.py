"""Proposal of a map for a log, and the list of its signals."""

import re
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from itertools import filterfalse, repeat
from typing import NamedTuple

import numpy as np

from boatsim.files import toml_key, toml_value
from boatsim.physics.signals import RATES
from boatsim.recordings.expression import UNITS, parse
from boatsim.recordings.importing.channels import VesselChannel as VesselChannel
from boatsim.recordings.importing.drive_evidence import MotionOfLog, motion_of_log
from boatsim.recordings.importing.effort_allocation import (
    EFFORTS,
    USUAL_PULSE,
    allocation_lines,
    lines_of_mixer,
    mixing_lines,
)
from boatsim.recordings.importing.foreign_words import english_unit
from boatsim.recordings.importing.log import Log, Signal, median_sampling_rate
from boatsim.recordings.importing.motion_begin import begins_by_motion
from boatsim.recordings.importing.motion_evidence import correct_classification_by_motion
from boatsim.recordings.importing.several_logs import (
    begins_by_shared_clock,
    file_spans,
    files_with_unrelated_clocks,
)
from boatsim.recordings.importing.signal_classification import (
    FROM_EAST,
    HELM,
    ORDERED,
    PULSE,
    UNKNOWN_BODY,
    Body,
    Classification,
    classify_signals,
    has_opposite_sense,
    has_stated_unit,
    may_be_course,
    side_from_tokens,
    tokenize_name,
)
from boatsim.recordings.importing.single_axis import is_load_of_channel, names_load
from boatsim.recordings.importing.track import (
    Track,
    reason_not_measured,
    reason_poses_unusable,
    speed_unit,
    track_of,
    unit_of_rate,
    values_in_si,
)
from boatsim.recordings.importing.turning import MIN_CORRELATION, Turning, held_values
from boatsim.recordings.importing.unnamed_drives import (
    MAX_OUTPUTS,
    TO_PORT,
    TO_STARBOARD,
    MatchByMotion,
    is_called_an_output,
    kind_of_drive,
    match_by_motion,
    numbered_outputs,
)
from boatsim.recordings.notes import unit_of
from boatsim.recordings.order_signs import (
    EFFORT_COLUMNS,
    laws_of_unsigned_orders,
    rows_without_sign,
)
from boatsim.recordings.raw_table import file_error

MAX_ROW_RATE = 50.0  # [Hz] a higher rate of rows is not needed for the motion of boats
MAX_LISTED = 400
# Revolutions without a unit: the sizes relative to the range of the channel that a unit must have,
# and the largest ratio of speeds that a vessel file, a current and acceleration may cause
MIN_UNIT_EXCESS, MIN_UNIT_SHARE, MAX_UNIT_EXCESS = 3.0, 0.1, 1.5
MAX_SPEED_RATIO = 3.0
MANY_DRIVES = 3  # from which on drives are matched by number: sides no longer tell them apart
SPEED_PERCENTILE = 75.0  # [%] of revolutions and speeds that are compared
ALL_AROUND = 3.1  # [rad] to each side: a thruster that turns around, whose angle may be counted on
HELM_EXCESS = 1.05  # a wheel that turns farther than the rudder by more than this is geared to it
# Column -> column of the signal and sign, for logs with z up (ROS, REP 103: x east, y north; x
# forward, y port)
FROM_ENU = {
    "x_m": ("y_m", ""),
    "y_m": ("x_m", ""),
    "v_mps": ("v_mps", "-"),
    "theta_rad": ("theta_rad", "-"),
    "q_radps": ("q_radps", "-"),
    "r_radps": ("r_radps", "-"),
    "psi_rad": ("psi_rad", "-"),
}
QUARTER_TURN = " + 90 * deg"  # heading from north = 90 degrees - yaw from east
BY_ITS_RANGE = "by its range"  # end of the note on a unit that the range only suggests
MOTION_COLUMNS = ("phi_rad", "theta_rad", *RATES)  # that a track may contradict
POSE_COLUMNS = ("x_m", "y_m", "psi_rad", "r_radps", "u_mps", "v_mps")
KINDS = {
    "angle": ("rad", "deg"),
    "turning": ("rad/s", "deg/s", "1/s", "1/min", "rpm"),
    "force": ("N", "kN"),
}
SIDED = ("port", "starboard")
BY_ORDER = "; CHECK: by order only"
BY_NUMBER = "; CHECK: by number, in the order of the vessel's drives"
# Numbers of a helm are degrees if the largest is at least this share of full helm
MIN_HELM_SHARE = 0.6
INCLINATIONS = {"phi_rad": "roll", "p_radps": "roll", "theta_rad": "pitch", "q_radps": "pitch"}


def signal_table(log: Log, body: Body = UNKNOWN_BODY) -> list[str]:
    """Return a table of the signals of a log: name, unit, rate, samples, range, classification.

    Args:
        log: The log.
        body: The vessel.
    """
    columns: dict[str, str] = {}
    for g in correct_classification_by_motion(classify_signals(log, body), log):
        columns[g.name] = g.column
    rows = [("signal", "unit", "Hz", "samples", "lowest", "highest", "probably")]
    listed = list(log.signals)
    if len(listed) > MAX_LISTED:
        listed = list(filter(columns.__contains__, listed))
    for name in listed:
        signal = log.signals[name]
        probably = ", ".join(filter(None, (columns.get(name), signal.about)))
        rows.append((_without_control_characters(name), *_signal_figures(signal), probably))
    lines = _aligned(rows)
    if len(listed) < len(log.signals):
        lines.append(f"and {len(log.signals) - len(listed)} unknown signals")
    return lines


def _signal_figures(signal: Signal) -> tuple[str, str, str, str, str]:
    values = signal.values[np.isfinite(signal.values)]
    low = high = ""
    if len(values):
        low, high = f"{values.min():.6g}", f"{values.max():.6g}"
    return (
        _without_control_characters(signal.unit)[:12],
        f"{_sampling_rate(signal):.3g}",
        str(len(values)),
        low,
        high,
    )


def _sampling_rate(signal: Signal) -> float:
    """Rate [Hz] of the values of a signal, without the rows of a table in which it is empty."""
    return median_sampling_rate(np.sort(signal.t[np.isfinite(signal.values)]))


def _aligned(rows: Sequence[tuple[str, ...]]) -> list[str]:
    """Lines of a table of seven columns, of which four are numbers."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines: list[str] = []
    for row in rows:
        cells = [row[0].ljust(widths[0]), row[1].ljust(widths[1])]
        cells += map(str.rjust, row[2:6], widths[2:6])
        lines.append("  ".join([*cells, row[6]]).rstrip())
    return lines


def _without_control_characters(name: str) -> str:
    """A name without control characters."""
    safe = ""
    for character in name[:120]:
        if not character.isprintable():
            character = "?"
        safe += character
    return safe


def propose_map(
    log: Log,
    vessel: str | None = None,
    drives: Sequence[VesselChannel] = (),
    dof: Sequence[str] = (),
    stated: Mapping[str, str] | None = None,
    approach_speed: Callable[[], float] = lambda: 0.0,
    turns_over: bool = False,
) -> str:
    """Return the text of a map: the most probable signals, with others in comments.

    Args:
        log: The log.
        vessel: Name or path of the vessel.
        drives: Command channels of the vessel.
        dof: Degrees of freedom of the vessel.
        stated: Column -> expression of a signal, by the vessel's file.
        approach_speed: Speed of the vessel at the commands `ahead` of its channels [m/s], which is
            computed only where the unit of revolutions is not known; 0 if unknown.
        turns_over: Whether the vessel may roll to any angle.

    Raises:
        BadInput: The log has no poses.
    """
    known, used_signals = _stated_columns(log, stated or {})
    best: dict[str, list[Classification]] = {}
    stated_motion: dict[str, list[Classification]] = {}
    classified = classify_signals(log, Body([d.name for d in drives], dof, turns_over))
    numbered = numbered_outputs(log, classified)
    for g in correct_classification_by_motion(classified, log):
        if g.column not in known and g.name not in used_signals:
            best.setdefault(g.column, []).append(g)
        elif known.get(g.column) == _expression(g):
            stated_motion.setdefault(g.column, []).append(g)
    if reason := reason_poses_unusable(log, best, "yaw" in dof):
        raise file_error(log.path, reason)
    track = track_of(best)
    best = _with_speed_units(_with_rate_unit(best), track)
    best, doubtful = _without_contradictions(best, track)
    body, used = _motion_lines(log, best, dof, known)
    body += doubtful
    for column, expression in known.items():
        body.append(f"{toml_key(column)} = {toml_value(expression)}  # by the vessel's file")
    open_drives = [d for d in drives if d.name not in known]
    driven: list[Classification] = []
    if drives and not open_drives:
        commands = ["# all are above"]
    else:
        enu = log.frame == "ENU"
        seen = {**best, **stated_motion}
        turning, unit = Turning(seen, enu), _RevolutionUnit(track, approach_speed)
        motion = motion_of_log(seen, turning, track or track_of(seen), enu)
        unnamed = _Unnamed(numbered, motion)
        commands, driven = _command_lines(best, open_drives, turning, unit, unnamed)
        if not drives and numbered:
            names = ", ".join(_without_control_characters(g.name) for g in numbered)
            commands.append(f"# {names} may be outputs to drives: --vessel shows which")
    # a measured force acts between the rows, too: its samples are all kept
    measured = any(names_load(tokenize_name(drive.name)) for drive in drives)
    lines = [
        "# Proposed from the names, units and ranges of the signals in the log: check every line.",
        f'vessel = "{vessel}"' if vessel else '# vessel = "NAME"',
        *([] if measured else _rate_lines((*used, *driven))),
        "# use = [0.0, 60.0]  # [s] since the log begins, the part to convert",
        *_time_lines(log),
        *_begin_lines(log, best),
        "",
        *body,
        "",
        "# commands: what was sent to the drives",
        *(commands or ["# none was found"]),
        *_unused_lines(best),
    ]
    return "\n".join(lines) + "\n"


def _stated_columns(log: Log, stated: Mapping[str, str]) -> tuple[dict[str, str], set[str]]:
    """Columns that the vessel's file states and the log has, and the signals that they use."""
    known: dict[str, str] = {}
    used_signals: set[str] = set()
    for column, expression in stated.items():
        signal = parse(expression, log.signals.keys()).signal
        if signal in log.signals:
            known[column] = expression
            used_signals.add(signal)
    return known, used_signals


def _rate_lines(used: Sequence[Classification]) -> list[str]:
    """A line that limits the rate of the rows, if a signal is faster."""
    fastest = max((_sampling_rate(g.signal) for g in used), default=0.0)
    if fastest <= 1.01 * MAX_ROW_RATE:
        return []
    return [f"rate = {MAX_ROW_RATE:g}  # [Hz] of rows; the fastest signal has {fastest:.3g}"]


def _unused_lines(best: Mapping[str, list[Classification]]) -> list[str]:
    """Lines for measured states of the drives and the pilot's sticks, which no effect needs."""
    lines: list[str] = []
    for kind, about in (
        ("actual", "measured state of the drives"),
        ("stick", "the pilot's sticks, recorded with the commands"),
    ):
        moving = list(filterfalse(_is_constant, best.get(kind, [])))
        if moving:
            further = _further_columns(kind, sorted(moving, key=lambda g: g.name))
            lines += ["", f"# {about}", *further]
    return lines


def _with_rate_unit(
    best: Mapping[str, list[Classification]],
) -> dict[str, list[Classification]]:
    """Classified signals, in which the heading shows the unit of a rate of turn without one."""
    if not best.get("psi_rad"):
        return dict(best)
    heading, rates = best["psi_rad"][0], []
    for g in best.get("r_radps", []):
        unit = unit_of_rate(g, heading) if g.why.endswith(BY_ITS_RANGE) else None
        if unit is not None:
            name = {"degps": "degrees", "": "radians", "degpmin": "degrees per minute"}[unit]
            g = replace(g, word=unit, why=f"{name} by the changes of the heading")
        rates.append(g)
    kept = dict(best)
    if rates:
        kept["r_radps"] = rates
    return kept


def _with_speed_units(
    best: Mapping[str, list[Classification]], track: Track | None
) -> dict[str, list[Classification]]:
    """Classified signals, in which the track shows the unit of speeds without one."""
    kept = dict(best)
    heading = next(iter(best.get("psi_rad", [])), None)
    for column in ("u_mps", "v_mps"):
        speeds = []
        for g in best.get(column, []):
            unit = ""
            if not has_stated_unit(g.name, g.signal):
                unit = speed_unit(column, g, track, heading)
            if unit:
                g = replace(g, word=unit, why=f"CHECK: in {unit} by the speed of the track")
            speeds.append(g)
        if speeds:
            kept[column] = speeds
    return kept


def _without_contradictions(
    best: Mapping[str, list[Classification]], track: Track | None
) -> tuple[dict[str, list[Classification]], list[str]]:
    """Classified signals without those that the track contradicts, and comments on these."""
    kept = dict(best)
    lines = []
    for column in ("psi_rad", *MOTION_COLUMNS):
        for g in best.get(column, []):
            heading = next(iter(kept.get("psi_rad", [])), None)
            if reason := reason_not_measured(column, g, track, heading):
                kept[column] = [other for other in kept[column] if other is not g]
                lines.append(f"# {column} is not {_without_control_characters(g.name)}: {reason}")
        if column in kept and not kept[column]:
            del kept[column]
    return kept, lines


def _time_lines(log: Log) -> list[str]:
    """A line for the times of a table in which no column holds them."""
    lines = []
    for source in dict.fromkeys(signal.source for signal in log.signals.values()):
        t = next(signal.t for signal in log.signals.values() if signal.source == source)
        if np.array_equal(t, np.arange(len(t))):
            is_clock = any(np.array_equal(signal.values, t) for signal in log.signals.values())
            key = f"time.{toml_key(source)}" if source else "time"
            if not is_clock:
                why = "no column holds times; rows are taken as 1 s apart"
                lines.append(f'# {key} = "..."  # CHECK: {why}')
    return lines


def _begin_lines(log: Log, best: Mapping[str, Sequence[Classification]]) -> list[str]:
    """Lines that state when the further files of a run begin, if their times are no UTC."""
    spans = file_spans(log)
    if len(spans) < 2:
        return []
    first = next(iter(spans))
    unrelated = files_with_unrelated_clocks(spans, {})
    if not unrelated:
        return []
    shared = begins_by_shared_clock(spans)
    by_motion = begins_by_motion(best, {name: span.begin for name, span in spans.items()})
    lines = [f"# begin of each file in s after that of {first}; UTC needs no line"]
    for name in unrelated:
        seconds, why = 0.0, "CHECK: no common clock, 0 is a guess"
        if name in shared:
            seconds, why = (
                shared[name],
                f"by its times, which are of one clock with those of {first}",
            )
        elif name in by_motion:
            seconds = by_motion[name].seconds
            why = (
                "CHECK: by the turning that both files show (correlation "
                f"{by_motion[name].correlation:.2f})"
            )
        lines.append(f"begins.{toml_key(name)} = {seconds!r}  # {why}")
    return lines


def _motion_lines(
    log: Log, best: Mapping[str, list[Classification]], dof: Sequence[str], known: Collection[str]
) -> tuple[list[str], list[Classification]]:
    """Lines of the position and the columns of motion, and their signals."""
    lines: list[str] = []
    used: list[Classification] = []
    pair = _latitude_and_longitude(best.get("latitude", []), best.get("longitude", []))
    if pair:
        used += pair
        lines.append("[position]")
        for g in pair:
            lines.append(f"{g.column} = {toml_value(_expression(g))}{_comment(g, best[g.column])}")
        if pair[0].word == "deg":
            middle = ", ".join(f"{np.nanmedian(g.signal.values):.4f}" for g in pair)
            lines.append(f"# origin = [{middle}]  # [deg]; else the first fix")
        lines.append("")
    lines.append("[columns]")
    enu = log.frame == "ENU"
    if enu and not pair and best.get("x_m"):
        lines.append(
            "# x east, y north, z up, hull x forward, y port, as in ROS; recordings have x "
            "north, y east, angles clockwise"
        )
    if not log.frame and best.get("psi_rad"):
        lines.append(
            "# assumed: x north or ahead, y east or to starboard, heading and its rate clockwise"
        )
    for column in (*POSE_COLUMNS, *INCLINATIONS):
        source, sign = column, ""
        if enu:
            source, sign = FROM_ENU.get(column, (column, ""))
        if column in ("x_m", "y_m") and pair or source not in best:
            continue
        g = best[source][0]
        quarter = ""
        if column == "psi_rad" and "yaw" not in g.tokens:
            sign = ""  # a compass heading is clockwise from north
        elif column == "psi_rad" and enu:
            quarter = QUARTER_TURN
        elif not enu and has_opposite_sense(column, g.tokens):
            sign = "-"
            if column == "psi_rad" and g.tokens & FROM_EAST:
                quarter = QUARTER_TURN
        expression = toml_value(sign + _expression(g) + quarter)
        line = f"{column} = {expression}{_comment(g, best[source])}"
        if column in INCLINATIONS and (INCLINATIONS[column] not in dof or _is_constant(g)):
            lines.append(f"# {line}")
        else:
            lines.append(line)
            used.append(g)
    if "psi_rad" not in {*best, *known} and (not dof or "yaw" in dof):
        lines.append(
            '# psi_rad = "..."  # no heading was found; it is needed for a vessel that turns'
        )
    return lines, used


def _is_constant(g: Classification) -> bool:
    """Whether a signal is constant."""
    return float(np.ptp(g.signal.values[np.isfinite(g.signal.values)])) == 0.0


def _latitude_and_longitude(
    latitudes: Sequence[Classification], longitudes: Sequence[Classification]
) -> list[Classification]:
    """The most probable latitude with the longitude of its stream."""
    for lat in latitudes:
        stream = lat.name.rpartition(".")[0]
        for lon in longitudes:
            if lon.name.rpartition(".")[0] == stream and len(lon.signal.t) == len(lat.signal.t):
                return [lat, lon]
    return []


def _expression(g: Classification) -> str:
    if not g.word:
        return g.name
    return f"{g.name} * {g.word}"


def _comment(g: Classification, others: Sequence[Classification]) -> str:
    """A comment with the rate, the assumption and further possible signals."""
    parts = [f"{_sampling_rate(g.signal):.3g} Hz"]
    if g.why:
        parts.append(g.why)
    if g.column == "psi_rad" and may_be_course(g.name):
        parts.append("CHECK: a heading, or a course over ground, which is none?")
    if also := [_without_control_characters(o.name) for o in others if o is not g][:4]:
        parts.append(f"also {', '.join(also)}")
    return "  # " + "; ".join(parts)


class _Unnamed(NamedTuple):
    """Outputs without telling names, and the motion that may show what they are."""

    outputs: Sequence[Classification]
    motion: MotionOfLog


def _command_lines(
    best: Mapping[str, Sequence[Classification]],
    drives: Sequence[VesselChannel],
    turning: Turning,
    unit: "_RevolutionUnit",
    unnamed: _Unnamed,
) -> tuple[list[str], list[Classification]]:
    """Lines of the vessel's channels, or without a vessel of all outputs that are not constant."""
    channels = [drive.name for drive in drives]
    moving: list[Classification] = []
    for g in best.get("command", []):
        if g.name in channels or not _is_constant(g):
            moving.append(g)
    moving.sort(key=lambda g: _natural_sort_key(g.name))
    lines: list[str] = []
    if not drives:
        for name, g in zip(_unique_names(list(map(_column_name, moving))), moving, strict=True):
            lines.append(_channel_line(name, g, None))
        return lines, moving
    taken: list[Classification] = []
    allocated, mixed = mixing_lines(drives, moving or best.get("stick", []), turning)
    taken += mixed
    chosen: dict[str, tuple[Classification, str]] = {}
    questions: list[str] = []
    if not allocated:
        chosen = _match_channels(best, drives, moving, turning)
        by_motion = _match_unnamed(drives, chosen, moving, turning, unnamed)
        is_open = bool(by_motion.questions) or len(by_motion.found) < len(drives)
        if not chosen and is_open and allocation_lines(drives, best):  # orders that have names
            named_only = unnamed._replace(outputs=())
            by_motion = _match_unnamed(drives, chosen, moving, turning, named_only)
        chosen, questions = by_motion.found, by_motion.questions
        if by_motion.throttle and by_motion.steering and not chosen:
            pair = (by_motion.throttle, by_motion.steering)
            allocated = lines_of_mixer(drives, *pair, turning)
            taken += pair
    if not chosen and not allocated:
        allocated = allocation_lines(drives, best)
        taken += [best[kind][0] for kind in EFFORTS if allocated and kind in best]
    for drive in drives:
        if drive.name in allocated:
            lines.append(allocated[drive.name])
            continue
        if drive.name not in chosen:
            lines.append(
                f'# {drive.name} = "..."  # {drive.low:g} to {drive.high:g}; no signal has a '
                "similar name"
            )
            continue
        g, why = chosen[drive.name]
        sense = 0.0
        if _steers(drive) and g.name != drive.name:
            sense = drive.turns * turning.correlation((g, 1.0))
        taken.append(g)
        g, unit_note = unit.with_unit(g, drive)
        lines.append(_channel_line(drive.name, g, drive, sense) + unit_note + why)
    lines += questions
    lines += _side_lines(drives, chosen, turning)
    unsigned, efforts = _unsigned_order_lines(drives, chosen, best)
    lines += unsigned
    taken += efforts
    for g in moving:
        if g not in taken:
            lines.append(_unused_line(g, drives))
    return lines, taken


def _side_lines(
    drives: Sequence[VesselChannel],
    chosen: Mapping[str, tuple[Classification, str]],
    turning: Turning,
) -> list[str]:
    """A comment if the boat turns to the other side than the commands of fixed drives ask for."""
    terms = []
    for drive in drives:
        if drive.lever and drive.name in chosen:
            terms.append((chosen[drive.name][0], float(np.sign(drive.lever))))
    if len({sign for _, sign in terms}) < len(SIDED):
        return []
    sense = turning.correlation(*terms)
    if sense > -MIN_CORRELATION:
        return []
    return [
        "# CHECK: the boat turns to the other side than these commands ask for (correlation "
        f"{sense:+.2f}): are two drives exchanged, or is the heading counted counterclockwise?"
    ]


def _unsigned_order_lines(
    drives: Sequence[VesselChannel],
    chosen: Mapping[str, tuple[Classification, str]],
    best: Mapping[str, Sequence[Classification]],
) -> tuple[list[str], list[Classification]]:
    """Lines of the force and moment from which orders that lost their sign were computed."""
    efforts = {kind: best[kind][0] for kind in EFFORT_COLUMNS if best.get(kind)}
    if len(chosen) < len(drives) or len(efforts) < len(EFFORT_COLUMNS):
        return [], []
    signals = {name: values_in_si(g) for name, (g, _) in chosen.items()}
    t = next(iter(signals.values()))[0]
    if len(t) == 0:
        return [], []
    orders = {name: held_values(at, values, t) for name, (at, values) in signals.items()}
    asked = [held_values(*values_in_si(efforts[kind]), t) for kind in EFFORT_COLUMNS]
    laws = laws_of_unsigned_orders(orders, *asked)
    if not laws:
        return [], []
    share = rows_without_sign(laws).mean()
    names = [_without_control_characters(g.name) for g, _ in chosen.values()]
    lines = [
        f"# CHECK: {', '.join(names)} follow from the force and moment below, but are never",
        f"# negative, where these ask for it in {100.0 * share:.2g} % of the rows. Did the drives",
        "# push astern? A diagnosis decides by the motion and restores the signs.",
    ]
    for kind, g in efforts.items():
        lines.append(f"{EFFORT_COLUMNS[kind]} = {toml_value(_expression(g))}")
    return lines, list(efforts.values())


class _RevolutionUnit:
    """Unit of revolutions that a log does not state, by their size and by the speed of the vessel.

    Two independent signs are needed: revolutions in rad/s would be far beyond the range of the
    channel and those in rpm are not, and the speed over ground is that of the vessel with
    revolutions in rpm and not in rad/s. With one sign the unit is left to the owner.
    """

    def __init__(self, track: Track | None, approach_speed: Callable[[], float]) -> None:
        self.track, self.approach_speed = track, approach_speed

    def with_unit(self, g: Classification, drive: VesselChannel) -> tuple[Classification, str]:
        """Return a signal with the unit that it shows, and what the owner must check."""
        stated = g.signal.unit or g.word or _unit(g)
        values = g.signal.values[np.isfinite(g.signal.values)]
        if stated or g.name == drive.name or not len(values):
            return g, ""
        size = float(np.max(np.abs(values)))
        limit = max(abs(drive.low), abs(drive.high))
        unit = unit_of(drive.name)
        excess = size > MAX_UNIT_EXCESS * limit and _scale(g, values, drive) is None
        if unit in KINDS["force"] and excess:
            return g, f"; CHECK: as {unit} up to {size / limit:.2g} times the vessel's range"
        if unit != "rad/s" or size < MIN_UNIT_EXCESS * limit:
            return g, ""
        rpm = UNITS["rpm"]
        by_size = MIN_UNIT_SHARE * limit < size * rpm < MAX_UNIT_EXCESS * limit
        ratio = self._speed_ratio(g, drive)
        by_speed = ratio > MAX_SPEED_RATIO and 1.0 / MAX_SPEED_RATIO < ratio * rpm < MAX_SPEED_RATIO
        as_it_is = f"as rad/s up to {size / limit:.2g} times the vessel's range"
        if by_size and by_speed:
            note = f"; in rpm: {as_it_is}, and for {ratio:.2g} times the speed of the track"
            return replace(g, word="rpm"), note
        signs = []
        if by_size:
            called = _without_control_characters(g.name)
            signs.append(f'; CHECK: {as_it_is}; in rpm it would be "{called} * rpm"')
        return g, "".join(signs) or f"; CHECK: {as_it_is}"

    def _speed_ratio(self, g: Classification, drive: VesselChannel) -> float:
        """Speed by the signal in rad/s, relative to that of the track; 0 if unknown.

        The speed of a vessel is about proportional to her revolutions.
        """
        if self.track is None or not self.track.moves or not drive.ahead:
            return 0.0
        usual = float(np.nanpercentile(np.abs(g.signal.values), SPEED_PERCENTILE))
        over_ground = float(np.percentile(self.track.speed, SPEED_PERCENTILE))
        return usual / abs(drive.ahead) * self.approach_speed() / max(over_ground, 1e-9)


def _unused_line(g: Classification, drives: Sequence[VesselChannel]) -> str:
    """A comment on a command that is not used, with the line of revolutions of a thruster."""
    for drive in drives:
        same_side = side_from_tokens(frozenset(tokenize_name(drive.name))) == side_from_tokens(
            g.tokens
        )
        if same_side and _is_thrust_by_revolutions(drive, g):
            return f"# or by revolutions: {_channel_line(drive.name, g, drive)}"
    return f"# not used: {_without_control_characters(g.name)}"


def _match_channels(
    best: Mapping[str, Sequence[Classification]],
    drives: Sequence[VesselChannel],
    moving: Sequence[Classification],
    turning: Turning,
) -> dict[str, tuple[Classification, str]]:
    """Signals of the channels by number and name, and of a helm by the turning, with checks."""
    exact = {g.name: g for g in moving}
    found = _with_note({d.name: exact[d.name] for d in drives if d.name in exact}, "")
    for steers in (True, False):
        group = [d for d in drives if d.name not in found and _steers(d) is steers]
        found |= _match_by_number(group, _unassigned(moving, found))
    unnumbered = [d for d in drives if d.name not in found]
    found |= _with_note(_match_by_name(unnumbered, _unassigned(moving, found)), "")
    helms = [d for d in drives if d.name not in found and _steers(d)]
    if helms:
        named: list[Classification] = []
        for name, (g, _) in found.items():
            if frozenset(tokenize_name(name)) & HELM and not side_from_tokens(g.tokens):
                named.append(g)
        measured = list(filterfalse(_is_constant, best.get("actual", [])))
        found |= _match_steering_channels(
            helms, named, _unassigned(moving, found), measured, turning
        )
    return found


def _match_unnamed(
    drives: Sequence[VesselChannel],
    named: Mapping[str, tuple[Classification, str]],
    moving: Sequence[Classification],
    turning: Turning,
    unnamed: _Unnamed,
) -> MatchByMotion:
    """Signals of the channels that no name tells, by the motion or by order."""
    found, questions = _corrected_by_motion(drives, named, unnamed.motion)
    left = _unassigned(moving, found)
    missing = [d for d in drives if d.name not in found]
    ordered = _signals_of_matching_stream(left, len(missing))
    is_decided = len(missing) == 1 == len(ordered) or _are_two_sides(missing, ordered)
    mixer: MatchByMotion | None = None
    if missing and not is_decided:
        outputs = [*left, *unnamed.outputs][:MAX_OUTPUTS]
        match = match_by_motion(missing, outputs, unnamed.motion)
        if match.throttle:
            mixer = match
        for drive in missing:
            if drive.name in match.found and _may_be(drive, match.found[drive.name][0]):
                g, why = match.found[drive.name]
                found[drive.name] = (_with_unit_of_helm(g, drive), why)
        questions += match.questions
    if mixer is not None:
        return mixer
    left = _unassigned(moving, found)
    missing = [d for d in drives if d.name not in found]
    ordered = _signals_of_matching_stream(left, len(missing))
    called = _unassigned([*left, *filter(is_called_an_output, unnamed.outputs)], found)
    if not ordered and not questions:
        ordered = _signals_of_matching_stream(called, len(missing))
    by_order = _match_by_order(missing, ordered, turning)
    guessed = [d for d in missing if by_order.get(d.name, ("", BY_ORDER))[1] == BY_ORDER]
    if guessed and called and not questions:
        questions.append(_question_of_order(guessed, called))
    found |= by_order
    return MatchByMotion(found, questions)


def _question_of_order(missing: Sequence[VesselChannel], ordered: Sequence[Classification]) -> str:
    """A line that asks which signal is which drive, where neither name nor motion shows it."""
    signals = ", ".join(_without_control_characters(g.name) for g in ordered)
    names = " and ".join(drive.name for drive in missing)
    verb = "is" if len(missing) == 1 else "are"
    return f"# CHECK: which of {signals} {verb} {names}? Neither names nor the motion show it"


def _are_two_sides(missing: Sequence[VesselChannel], ordered: Sequence[Classification]) -> bool:
    """Whether two channels of the two sides are left for two signals; their difference decides."""
    sides = [side_from_tokens(frozenset(tokenize_name(d.name))) for d in missing]
    return len(ordered) == 2 and sorted(sides) == list(SIDED)


def _may_be(drive: VesselChannel, g: Classification) -> bool:
    return _units_are_compatible(drive, g) or _is_thrust_by_revolutions(drive, g)


def _with_unit_of_helm(g: Classification, drive: VesselChannel) -> Classification:
    """A signal in degrees, if its numbers are the degrees of the range of a channel that steers."""
    if unit_of(drive.name) != "rad" or g.word or g.signal.unit:
        return g
    span = max(abs(drive.low), abs(drive.high))
    largest = float(np.radians(np.nanmax(np.abs(g.signal.values))))
    if MIN_HELM_SHARE * span < largest <= HELM_EXCESS * span and span < ALL_AROUND:
        return replace(g, word="deg")
    return g


def _corrected_by_motion(
    drives: Sequence[VesselChannel],
    named: Mapping[str, tuple[Classification, str]],
    motion: MotionOfLog,
) -> tuple[dict[str, tuple[Classification, str]], list[str]]:
    """Signals by number, in another order if the motion contradicts it, and questions."""
    found = dict(named)
    group = [d for d in drives if d.name in named and named[d.name][1] == BY_NUMBER]
    kinds = {d.name: kind_of_drive(d) for d in group}
    if len(set(kinds.values()) & {TO_STARBOARD, TO_PORT}) < len(SIDED):
        return found, []
    match = match_by_motion(group, [named[d.name][0] for d in group], motion)
    if len(match.found) < len(group):
        return found, []
    by_kind: dict[str, list[set[str]]] = {kind: [set(), set()] for kind in kinds.values()}
    for name, kind in kinds.items():
        by_kind[kind][0].add(named[name][0].name)
        by_kind[kind][1].add(match.found[name][0].name)
    if all(by_number == by_motion for by_number, by_motion in by_kind.values()):
        return found, []
    return found | match.found, match.questions


def _unassigned(
    signals: Sequence[Classification], found: Mapping[str, tuple[Classification, str]]
) -> list[Classification]:
    used = [g for g, _ in found.values()]
    return [g for g in signals if g not in used]


def _match_steering_channels(
    helms: Sequence[VesselChannel],
    named: Sequence[Classification],
    left: Sequence[Classification],
    measured: Sequence[Classification],
    turning: Turning,
) -> dict[str, tuple[Classification, str]]:
    """Signals of channels that steer: by name, by the turning, or a measured angle."""
    if named:
        return _assign_to_all(helms, named[0], "; CHECK: one helm is used for all")
    if steers := turning.steering_signal([g for g in left if _units_are_compatible(helms[0], g)]):
        why = f"; CHECK: chosen because the boat turns with it (correlation {steers[1]:+.2f})"
        return _assign_to_all(helms, steers[0], why)
    why = "; CHECK: the measured angle is used as the command"
    rudders = [g for g in measured if g.tokens & HELM and _units_are_compatible(helms[0], g)]
    if len(rudders) == 1:
        return _assign_to_all(helms, rudders[0], why)
    return _with_note(_match_by_name(helms, rudders), why)


def _with_note(
    matched: Mapping[str, Classification], note: str
) -> dict[str, tuple[Classification, str]]:
    """The signals of channels, each with the same note."""
    return dict(zip(matched, zip(matched.values(), repeat(note)), strict=True))


def _assign_to_all(
    helms: Sequence[VesselChannel], g: Classification, why: str
) -> dict[str, tuple[Classification, str]]:
    return dict.fromkeys([helm.name for helm in helms], (g, why))


def _steers(drive: VesselChannel) -> bool:
    """Whether a channel is an angle or has the name of one."""
    unit = unit_of(drive.name)
    if unit:
        return unit == "rad"
    return not HELM.isdisjoint(tokenize_name(drive.name))


def _match_by_order(
    missing: Sequence[VesselChannel], left: Sequence[Classification], turning: Turning
) -> dict[str, tuple[Classification, str]]:
    """Signals of channels by order; two sides are exchanged if the turning shows it."""
    why = "; CHECK: the only signal that is left"
    if len(left) > 1:
        why = BY_ORDER
    sides = [side_from_tokens(frozenset(tokenize_name(d.name))) for d in missing]
    if len(left) == 2 and sorted(sides) == list(SIDED):
        port = sides.index(SIDED[0])
        sense = turning.correlation((left[port], 1.0), (left[1 - port], -1.0))
        if abs(sense) > MIN_CORRELATION:
            if sense < 0.0:
                left = [left[1], left[0]]
            why = f"; CHECK: side by the turning of the boat (correlation {abs(sense):.2f})"
    found: dict[str, tuple[Classification, str]] = {}
    for drive, g in zip(missing, left, strict=False):
        if _units_are_compatible(drive, g) or _is_thrust_by_revolutions(drive, g):
            found[drive.name] = (g, why)
    return found


def _match_by_number(
    drives: Sequence[VesselChannel], signals: Sequence[Classification]
) -> dict[str, tuple[Classification, str]]:
    """Signals of many drives of one kind that differ in one number, in the order of the drives.

    Orders go before what a drive reports. Names with a side, and one or two drives, are matched
    otherwise.
    """
    if len(drives) < MANY_DRIVES:
        return {}
    own = [re.findall(r"\d+", drive.name) for drive in drives]
    if all(len(numbers) == 1 for numbers in own) and len({*map(tuple, own)}) == len(drives):
        drives = sorted(drives, key=lambda drive: int(re.findall(r"\d+", drive.name)[0]))
    families: dict[str, dict[int, Classification]] = {}
    for g in signals:
        numbers = re.findall(r"\d+", g.name)
        if len(numbers) == 1 and not side_from_tokens(g.tokens):
            families.setdefault(re.sub(r"\d+", "#", g.name), {})[int(numbers[0])] = g
    best: list[list[Classification]] = []
    for family in families.values():
        order = [family[number] for number in sorted(family)]
        consecutive = max(family) - min(family) == len(drives) - 1
        alike = all(bool(g.tokens & HELM) == _steers(drives[0]) for g in order)
        matching = len(order) == len(drives) and consecutive and alike
        if matching and all(map(_units_are_compatible, drives, order)):
            best.append(order)
    ordered = [order for order in best if order[0].tokens & ORDERED] or best
    if len(ordered) != 1:
        return {}
    found = {}
    for drive, g in zip(drives, ordered[0], strict=True):
        found[drive.name] = (g, BY_NUMBER)
    return found


def _signals_of_matching_stream(
    moving: Sequence[Classification], count: int
) -> list[Classification]:
    """The signals of the stream with this number of signals; [] if no stream has it."""
    streams: dict[str, list[Classification]] = {}
    for g in moving:
        streams.setdefault(g.name.rpartition(".")[0], []).append(g)
    for signals in (*streams.values(), list(moving)):
        if len(signals) == count:
            return signals
    return []


def _natural_sort_key(name: str) -> list[tuple[int, str]]:
    """Sort key by which output 10 comes after output 9."""
    key = []
    for part in filter(None, re.split(r"(\d+)", name)):
        if part.isdigit():
            key.append((int(part), ""))
        else:
            key.append((-1, part))
    return key


def _match_by_name(
    drives: Sequence[VesselChannel], moving: Sequence[Classification]
) -> dict[str, Classification]:
    """The signal with the most similar name of each channel; no signal is used twice."""
    pairs = []
    for drive in drives:
        for i, g in enumerate(moving):
            pairs.append((_name_similarity(drive, g), -i, drive.name, g))
    pairs.sort(key=lambda pair: pair[:2], reverse=True)
    found: dict[str, Classification] = {}
    for score, _, name, g in pairs:
        if score < 1.0 or name in found or g in found.values():
            continue
        best_rival = 0.0
        for rival_score, _, rival_name, rival in pairs:
            if rival_name == name and rival is not g and rival not in found.values():
                best_rival = max(best_rival, rival_score)
        if score > best_rival:
            found[name] = g
    return found


def _name_similarity(drive: VesselChannel, g: Classification) -> float:
    if drive.name == g.name:
        return 10.0
    theirs = g.tokens | frozenset(tokenize_name(g.signal.about))
    ours = frozenset(tokenize_name(drive.name))
    mine, other = side_from_tokens(ours), side_from_tokens(theirs)
    opposite = mine != other and "" not in (mine, other)
    if opposite or not _units_are_compatible(drive, g) or bool(ours & HELM) != bool(theirs & HELM):
        return 0.0
    special = (mine == other and mine != "") + bool(ours & HELM) + is_load_of_channel(theirs, ours)
    return 1.0 * special + 0.5 * len(ours & theirs)


def _units_are_compatible(drive: VesselChannel, g: Classification) -> bool:
    """Whether channel and signal may be of one kind: angle, rate or force.

    Pulses and plain numbers fit any kind.
    """
    kinds = (_kind_of(unit_of(drive.name)), _kind_of(_unit(g)))
    return "" in kinds or kinds[0] == kinds[1]


def _kind_of(unit: str) -> str:
    for kind, units in KINDS.items():
        if unit in units:
            return kind
    return ""


def _is_thrust_by_revolutions(drive: VesselChannel, g: Classification) -> bool:
    """Whether the channel is a thrust and the signal revolutions."""
    return unit_of(drive.name) in KINDS["force"] and _unit(g) in KINDS["turning"]


def _unit(g: Classification) -> str:
    if g.signal.unit:
        return english_unit(g.signal.unit) or g.signal.unit
    return {"deg": "deg", "rpm": "rpm", "degps": "deg/s"}.get(g.word, unit_of(g.name))


def _channel_line(
    name: str, g: Classification, drive: VesselChannel | None, sense: float = 0.0
) -> str:
    """A line of the map.

    Args:
        name: Name of the column.
        g: The signal.
        drive: Channel of the vessel.
        sense: Correlation of the signal with turning to the side of the channel, -1 for the
            opposite side.
    """
    values = g.signal.values[np.isfinite(g.signal.values)]
    low, high = -1.0, 1.0
    if drive:
        low, high = drive.low, drive.high
    note = f"  # {_sampling_rate(g.signal):.3g} Hz"
    if g.signal.about:
        note += f"; {_without_control_characters(g.signal.about)}"
    if drive and is_load_of_channel(g.tokens, tokenize_name(name)) and not _unit(g):
        note += f"; CHECK: assumed to be in {unit_of(name) or 'the unit of the channel'}"
    turned = sense < -MIN_CORRELATION
    if turned:
        note += (
            "; CHECK: sign inverted, for the boat turns to the opposite side (correlation "
            f"{sense:+.2f})"
        )
    scale = _scale(g, values, drive)
    if scale is None:
        expression = _expression_with_unit(g, name)
        if drive and _is_raw_command(g, values, drive):
            expression = g.name
        if turned:
            expression = f"-{expression}"
        return f"{toml_key(name)} = {toml_value(expression)}{note}"
    if turned:
        low, high = high, low
    given = "low = {:g}, neutral = {:g}, high = {:g}".format(*scale.ends)
    if scale.why:
        note += f"; {scale.why}"
    if drive and unit_of(drive.name) == "rad":
        note += (
            f"; CHECK: full helm is assumed to be {np.degrees(max(abs(low), abs(high))):.0f} deg"
        )
    law = ""
    if scale.exponent != 1.0:
        law = f", exponent = {scale.exponent:g}"
    return (
        f"{toml_key(name)} = {{ signal = {toml_value(g.name)}, {given}, least = {low:g}, most = "
        f"{high:g}{law} }}{note}"
    )


class _Scale(NamedTuple):
    """Conversion of a signal to a share of full command.

    Low, neutral and high value of the signal, the source of these, and the exponent.
    """

    ends: tuple[float, float, float]
    why: str
    exponent: float = 1.0


def _scale(
    g: Classification,
    values: "np.ndarray[tuple[int, ...], np.dtype[np.float64]]",
    drive: VesselChannel | None,
) -> _Scale | None:
    """The scale of a signal that is a share of full command; None for another signal."""
    share = "in proportion to full command"
    if drive and (g.name == drive.name or _is_raw_command(g, values, drive)):
        return None
    if g.signal.pulse:
        why = ""
        if drive:
            why = share
        return _Scale(g.signal.pulse, why)
    if PULSE[0] <= values.min() and values.max() <= PULSE[1]:
        return _Scale(USUAL_PULSE, f"usual pulses of 1100 to 1900 us are assumed, {share}")
    largest = float(np.max(np.abs(values)))
    if drive is None or is_load_of_channel(g.tokens, tokenize_name(drive.name)):
        return None
    if _is_thrust_by_revolutions(drive, g):
        why = "thrust by the square of the revolutions; CHECK: those of full thrust, here the most"
        return _Scale((-largest, 0.0, largest), why, 2.0)
    span = max(abs(drive.low), abs(drive.high))
    if g.word == "deg" and unit_of(drive.name) == "rad":
        if span > ALL_AROUND or np.radians(largest) <= HELM_EXCESS * span:
            return None
        why = "the wheel turns farther than the rudder; CHECK: full wheel, here the largest angle"
        return _Scale((-largest, 0.0, largest), why)
    if unit_of(drive.name) and g.word and g.word != "percent":
        return None
    if g.word == "percent" and (span != 100.0 or unit_of(drive.name)):
        return _Scale((-100.0, 0.0, 100.0), f"per cent, {share}")
    if g.name != drive.name and 1.5 < largest <= 100.0 and not 0.3 < largest / span < 1.01:
        return _Scale((-100.0, 0.0, 100.0), f"per cent by its range, {share}")
    if largest <= 1.01 and span > 2.0:
        return _Scale((-1.0, 0.0, 1.0), f"-1 to 1, {share}")
    return None


def _is_raw_command(
    g: Classification,
    values: "np.ndarray[tuple[int, ...], np.dtype[np.float64]]",
    drive: VesselChannel,
) -> bool:
    """Whether a signal is the raw command of a channel without a unit, such as per cent or pulses.

    The file of the vessel converts it to thrust.
    """
    if unit_of(drive.name) or g.word not in ("percent", "us"):
        return False
    if g.word == "percent" and max(abs(drive.low), abs(drive.high)) != 100.0:
        return False
    return bool(drive.low <= values.min() and values.max() <= drive.high)


def _expression_with_unit(g: Classification, name: str) -> str:
    """An expression in the unit of the column."""
    if g.name == name or g.word == "rpm" and name.endswith("_rpm"):
        return g.name
    if g.word == "rpm" and name.endswith("_rps"):
        return f"{g.name} / 60"
    return _expression(g)


def _column_name(g: Classification) -> str:
    words = g.tokens | frozenset(tokenize_name(g.signal.about))
    name = "throttle"
    if words & HELM:
        name = "steer"
    if side := side_from_tokens(words):
        name += f"_{side}"
    return name + {"deg": "_rad", "rpm": "_radps"}.get(g.word, "")


def _unique_names(names: Sequence[str]) -> list[str]:
    """The names, numbered where several are equal."""
    found: list[str] = []
    seen: dict[str, int] = {}
    for name in names:
        seen[name] = seen.get(name, 0) + 1
        if names.count(name) > 1:
            stem, separator, unit = name.partition("_rad")
            name = f"{stem}_{seen[name]}{separator}{unit}"
        found.append(name)
    return found


def _further_columns(kind: str, found: Sequence[Classification]) -> list[str]:
    """Lines of further columns, named by kind and signal."""
    names = []
    for g in found:
        plain = re.sub(r"[^a-z0-9]+", "_", g.name.lower()).strip("_")
        names.append(f"{kind}_{plain}")
    lines = []
    for name, g in zip(_unique_names(names), found, strict=True):
        expression = _expression(g)
        if g.word == "us":
            expression = g.name
        lines.append(f"{toml_key(name)} = {toml_value(expression)}")
    return lines
