"""A map proposed for a log, as text to be saved and checked, and the list of its signals."""

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from boatsim.recordings.expression import parse
from boatsim.recordings.importing.log import Log, Signal, rate_of
from boatsim.recordings.importing.signal_classification import (
    HELM,
    PULSE,
    Guess,
    guesses,
    side_of,
    tokens_of,
)
from boatsim.recordings.importing.turning import MIN_CORRELATION, Turning
from boatsim.recordings.notes import unit_of

USUAL_PULSE = (
    1100.0,
    1500.0,
    1900.0,
)  # [us] low, neutral, high of most motor controllers of small boats
QUICKEST = 50.0  # [Hz] beyond it rows are proposed at a stated rate: no boat moves so fast
MOST_LISTED = 400
# from z up, as ROS has it (REP 103: x east, y north, z up; x forward, y port), to ours: column ->
# signal's column, sign
FROM_ENU = {
    "x_m": ("y_m", ""),
    "y_m": ("x_m", ""),
    "v_mps": ("v_mps", "-"),
    "theta_rad": ("theta_rad", "-"),
    "q_radps": ("q_radps", "-"),
    "r_radps": ("r_radps", "-"),
    "psi_rad": ("psi_rad", "-"),
}
QUARTER = " + 90 * deg"  # heading from north = a quarter turn less the yaw from east
SURE = ("x_m", "y_m", "psi_rad", "r_radps", "u_mps", "v_mps")
KINDS = {
    "angle": ("rad", "deg"),
    "turning": ("rad/s", "deg/s", "1/s", "1/min", "rpm"),
    "force": ("N", "kN"),
}
SIDED = ("port", "starboard")
LEANS = {"phi_rad": "roll", "p_radps": "roll", "theta_rad": "pitch", "q_radps": "pitch"}


@dataclass(frozen=True)
class Drive:
    """A vessel's channel, as far as a proposal needs it."""

    name: str
    low: float
    high: float
    turns: int = 0  # 1: what is positive turns the boat to starboard, -1: to port, 0: nobody says


def listing(log: Log) -> list[str]:
    """A line for each signal: name, unit, rate, samples, range, what it probably is."""
    found = {g.name: g for g in guesses(log)}
    rows = [("signal", "unit", "Hz", "samples", "lowest", "highest", "probably")]
    shown = (
        list(log.signals)
        if len(log.signals) <= MOST_LISTED
        else [n for n in log.signals if n in found]
    )
    for name in shown:
        rows.append(
            (_safe(name), *_figures(log.signals[name]), _words(found.get(name), log.signals[name]))
        )
    widths = [max(len(row[i]) for row in rows) for i in range(6)]
    lines = [
        "  ".join(
            [
                row[0].ljust(widths[0]),
                row[1].ljust(widths[1]),
                *(c.rjust(w) for c, w in zip(row[2:6], widths[2:], strict=True)),
                row[6],
            ]
        ).rstrip()
        for row in rows
    ]
    if len(shown) < len(log.signals):
        lines.append(f"and {len(log.signals) - len(shown)} signals more, of which nothing is known")
    return lines


def _figures(signal: Signal) -> tuple[str, str, str, str, str]:
    values = signal.values[np.isfinite(signal.values)]
    low, high = (f"{values.min():.6g}", f"{values.max():.6g}") if len(values) else ("", "")
    return (
        _safe(signal.unit)[:12],
        f"{rate_of(signal.t[np.isfinite(signal.values)]):.3g}",
        str(len(values)),
        low,
        high,
    )


def _words(guess: Guess | None, signal: Signal) -> str:
    return ", ".join(text for text in (guess.column if guess else "", signal.about) if text)


def _safe(name: str) -> str:
    """A name without characters that a terminal would act on."""
    return "".join(c if c.isprintable() else "?" for c in name)[:120]


def proposal(
    log: Log,
    vessel: str | None = None,
    drives: Sequence[Drive] = (),
    dof: Sequence[str] = (),
    stated: Mapping[str, str] | None = None,
) -> str:
    """Text of a map: the likeliest signal of each column, the others beside it in comments.

    `stated` is what the vessel's file says of the columns of its recordings: our name, and the expression of theirs.
    """
    known = {
        ours: e
        for ours, e in (stated or {}).items()
        if parse(e, log.signals.keys()).signal in log.signals
    }
    spoken_for = {parse(e, log.signals.keys()).signal for e in known.values()}
    found = guesses(log, [d.name for d in drives])
    found = [g for g in found if g.column not in known and g.name not in spoken_for]
    best: dict[str, list[Guess]] = {}
    for g in found:
        best.setdefault(g.column, []).append(g)
    lines = [
        "# Proposed from the names, units and ranges of the signals in the log: check every line."
    ]
    lines += [f'vessel = "{vessel}"'] if vessel else ['# vessel = "NAME"']
    body, used = _poses(log, best, dof, known)
    body += [f"{_key(n)} = {_text(e)}  # as the vessel's file says" for n, e in known.items()]
    open_drives = [d for d in drives if d.name not in known]
    turning = Turning(best, log.frame == "ENU")
    commands, driven = (
        _commands(best, open_drives, turning) if open_drives or not drives else ([], [])
    )
    commands = ["# all are above"] if drives and not open_drives else commands
    if (
        quickest := max((rate_of(g.signal.t) for g in (*used, *driven)), default=0.0)
    ) > 1.01 * QUICKEST:
        lines.append(f"rate = {QUICKEST:g}  # [Hz] of rows; the quickest signal has {quickest:.3g}")
    lines += [
        "# use = [0.0, 60.0]  # [s] since the log begins, to leave out what was before and after",
        "",
        *body,
    ]
    lines += ["", "# commands: what was sent to the drives", *(commands or ["# none was found"])]
    for kind, said in (
        ("actual", "what the drives did"),
        ("stick", "the pilot's hand, kept beside the commands"),
    ):
        moving = [g for g in best.get(kind, []) if not _still(g)]
        if moving:
            lines += ["", f"# {said}", *_kept(kind, sorted(moving, key=lambda g: g.name))]
    return "\n".join(lines) + "\n"


def _poses(
    log: Log, best: Mapping[str, list[Guess]], dof: Sequence[str], known: Collection[str]
) -> tuple[list[str], list[Guess]]:
    """Lines of position and columns of motion, and the guesses in them."""
    lines, used = [], list[Guess]()
    pair = _pair(best.get("latitude", []), best.get("longitude", []))
    if pair:
        used += pair
        lines += [
            "[position]",
            *(f"{g.column} = {_text(_expression(g))}{_note(g, best[g.column])}" for g in pair),
        ]
        middle = ", ".join(f"{np.nanmedian(g.signal.values):.4f}" for g in pair)
        lines += (
            [f"# origin = [{middle}]  # [deg]; else the first fix"] if pair[0].word == "deg" else []
        )
        lines.append("")
    lines.append("[columns]")
    enu = log.frame == "ENU"
    if enu and not pair and best.get("x_m"):
        lines.append(
            "# x east, y north, z up, hull x forward, y port, as ROS has it; ours is north, east, clockwise"
        )
    if not log.frame and best.get("psi_rad"):
        lines.append(
            "# taken for granted: x north or ahead, y east or to starboard, heading and its rate clockwise"
        )
    for column in (*SURE, *LEANS):
        source, sign = FROM_ENU.get(column, (column, "")) if enu else (column, "")
        if column in ("x_m", "y_m") and pair or source not in best:
            continue
        g = best[source][0]
        held = column in LEANS and (LEANS[column] not in dof or _still(g))
        compass = (
            column == "psi_rad" and "yaw" not in g.tokens
        )  # which counts from north, clockwise
        sign, quarter = (
            ("", "") if compass else (sign, QUARTER if enu and column == "psi_rad" else "")
        )
        lines.append(
            f"{'# ' if held else ''}{column} = {_text(sign + _expression(g) + quarter)}{_note(g, best[source])}"
        )
        used += [] if held else [g]
    if "psi_rad" not in {*best, *known}:
        lines.append(
            '# psi_rad = "..."  # no heading was found; a vessel that turns can not be followed without one'
        )
    return lines, used


def _still(g: Guess) -> bool:
    """Whether a signal has one value throughout."""
    return float(np.ptp(g.signal.values[np.isfinite(g.signal.values)])) == 0.0


def _pair(latitudes: Sequence[Guess], longitudes: Sequence[Guess]) -> list[Guess]:
    """The likeliest latitude with the longitude of its stream."""
    for lat in latitudes:
        stream = lat.name.rpartition(".")[0]
        for lon in longitudes:
            if lon.name.rpartition(".")[0] == stream and len(lon.signal.t) == len(lat.signal.t):
                return [lat, lon]
    return []


def _expression(g: Guess) -> str:
    return f"{g.name} * {g.word}" if g.word else g.name


def _note(g: Guess, others: Sequence[Guess]) -> str:
    """A comment: rate, what was taken for granted, what else it might be."""
    also = [_safe(o.name) for o in others if o is not g][:4]
    parts = [f"{rate_of(g.signal.t):.3g} Hz", g.why, f"also {', '.join(also)}" if also else ""]
    return "  # " + "; ".join(p for p in parts if p)


def _text(value: str) -> str:
    """A TOML string."""
    plain = value.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(c if c.isprintable() else f"\\u{ord(c):04x}" for c in plain) + '"'


def _commands(
    best: Mapping[str, Sequence[Guess]], drives: Sequence[Drive], turning: Turning
) -> tuple[list[str], list[Guess]]:
    """Lines of the vessel's channels, or of all outputs that moved where there is no vessel."""
    moving = [
        g for g in best.get("command", []) if not _still(g) or g.name in [d.name for d in drives]
    ]
    moving.sort(key=lambda g: _order(g.name))
    if not drives:
        names = _names([_called(g) for g in moving])
        return [_drive_line(n, g, None) for n, g in zip(names, moving, strict=True)], list(moving)
    lines, taken = [], list[Guess]()
    chosen = _chosen(best, drives, moving, turning)
    for drive in drives:
        if drive.name not in chosen:
            lines.append(
                f'# {drive.name} = "..."  # {drive.low:g} to {drive.high:g}; no signal is called like it'
            )
            continue
        g, why = chosen[drive.name]
        sense = (
            drive.turns * turning.by((g, 1.0)) if _steers(drive) and g.name != drive.name else 0.0
        )
        taken.append(g)
        lines.append(_drive_line(drive.name, g, drive, sense) + why)
    return [*lines, *(f"# not used: {_safe(g.name)}" for g in moving if g not in taken)], taken


def _chosen(
    best: Mapping[str, Sequence[Guess]],
    drives: Sequence[Drive],
    moving: Sequence[Guess],
    turning: Turning,
) -> dict[str, tuple[Guess, str]]:
    """A signal for each channel, as far as there is one, and what must be checked of it: by name, by deed, by order."""
    found = {n: (g, "") for n, g in _matched(drives, moving).items()}
    left = [g for g in moving if g not in [h for h, _ in found.values()]]
    helms = [d for d in drives if d.name not in found and _steers(d)]
    named = [
        g for n, (g, _) in found.items() if frozenset(tokens_of(n)) & HELM and not side_of(g.tokens)
    ]
    if helms:
        found |= _helms(
            helms, named, left, [g for g in best.get("actual", []) if not _still(g)], turning
        )
    left = [g for g in left if g not in [h for h, _ in found.values()]]
    missing = [d for d in drives if d.name not in found]
    found |= _by_order(missing, _as_many(left, len(missing)), turning)
    return found


def _helms(
    helms: Sequence[Drive],
    named: Sequence[Guess],
    left: Sequence[Guess],
    measured: Sequence[Guess],
    turning: Turning,
) -> dict[str, tuple[Guess, str]]:
    """Signals of channels that steer: the one helm that has a name, what the boat turns by, or what was measured."""
    if named:
        return {d.name: (named[0], "; CHECK: one helm is taken for all") for d in helms}
    if steers := turning.helm([g for g in left if _fits(helms[0], g)]):
        why = f"; CHECK: taken for it as the boat turns by it (correlation {steers[1]:+.2f})"
        return {d.name: (steers[0], why) for d in helms}
    why = "; CHECK: what was measured is taken for what was ordered"
    rudders = [g for g in measured if g.tokens & HELM and _fits(helms[0], g)]
    if len(rudders) == 1:
        return {d.name: (rudders[0], why) for d in helms}
    return {n: (g, why) for n, g in _matched(helms, rudders).items()}


def _steers(drive: Drive) -> bool:
    """Whether a channel is an angle or called one; two thrusts turn a boat too, each of them in no way alone."""
    return (
        unit_of(drive.name) == "rad"
        or not unit_of(drive.name)
        and bool(frozenset(tokens_of(drive.name)) & HELM)
    )


def _by_order(
    missing: Sequence[Drive], left: Sequence[Guess], turning: Turning
) -> dict[str, tuple[Guess, str]]:
    """Channels and signals one after the other; of two sides that which turns the boat as it should is put right."""
    why = "; CHECK: by its order alone" if len(left) > 1 else "; CHECK: the only one that is left"
    if len(missing) == len(left) == 2 and {
        side_of(frozenset(tokens_of(d.name))) for d in missing
    } == {*SIDED}:
        port = [side_of(frozenset(tokens_of(d.name))) for d in missing].index(SIDED[0])
        sense = turning.by((left[port], 1.0), (left[1 - port], -1.0))
        if abs(sense) > MIN_CORRELATION:
            left = list(left) if sense > 0.0 else [left[1], left[0]]
            why = f"; CHECK: its side is told by how the boat turns (correlation {abs(sense):.2f})"
    pairs = zip(missing, left, strict=False)
    return {d.name: (g, why) for d, g in pairs if _fits(d, g) or _turns_a_screw(d, g)}


def _as_many(moving: Sequence[Guess], count: int) -> list[Guess]:
    """The signals of the one stream that has just so many that move; none where no stream has."""
    streams: dict[str, list[Guess]] = {}
    for g in moving:
        streams.setdefault(g.name.rpartition(".")[0], []).append(g)
    return next((found for found in (*streams.values(), list(moving)) if len(found) == count), [])


def _order(name: str) -> list[tuple[int, str]]:
    """Sorts output 10 behind output 9."""
    return [(int(p), "") if p.isdigit() else (-1, p) for p in re.split(r"(\d+)", name) if p]


def _matched(drives: Sequence[Drive], moving: Sequence[Guess]) -> dict[str, Guess]:
    """Channels and the signals whose words fit them best, each once."""
    pairs = sorted(
        ((_likeness(d, g), -i, d.name, g) for d in drives for i, g in enumerate(moving)),
        key=lambda p: p[:2],
        reverse=True,
    )
    found: dict[str, Guess] = {}
    for score, _, name, g in pairs:
        rivals = [
            s
            for s, _, n, other in pairs
            if n == name and other is not g and other not in found.values()
        ]
        if (
            score >= 1.0
            and name not in found
            and g not in found.values()
            and score > max(rivals, default=0.0)
        ):
            found[name] = g
    return found


def _likeness(drive: Drive, g: Guess) -> float:
    if drive.name == g.name:
        return 10.0
    theirs = g.tokens | frozenset(tokens_of(g.signal.about))
    ours = frozenset(tokens_of(drive.name))
    mine, other = side_of(ours), side_of(theirs)
    if (
        not _fits(drive, g)
        or mine != other
        and mine
        and other
        or bool(ours & HELM) != bool(theirs & HELM)
    ):
        return 0.0
    return 1.0 * (mine == other and mine != "") + 1.0 * bool(ours & HELM) + 0.5 * len(ours & theirs)


def _fits(drive: Drive, g: Guess) -> bool:
    """Whether a channel can be of a signal's kind, as an angle is no force; pulses and plain numbers may be any."""
    kinds = [
        next((k for k, units in KINDS.items() if u in units), "")
        for u in (unit_of(drive.name), _unit(g))
    ]
    return "" in kinds or kinds[0] == kinds[1]


def _turns_a_screw(drive: Drive, g: Guess) -> bool:
    """Whether a force may be told by revolutions alone."""
    return unit_of(drive.name) in KINDS["force"] and _unit(g) in KINDS["turning"]


def _unit(g: Guess) -> str:
    return g.signal.unit or {"deg": "deg", "rpm": "rpm", "degps": "deg/s"}.get(
        g.word, unit_of(g.name)
    )


def _drive_line(name: str, g: Guess, drive: Drive | None, sense: float = 0.0) -> str:
    """A line of the map; `sense`: from 1, the boat turns as the channel says, to -1, it turns the other way."""
    values = g.signal.values[np.isfinite(g.signal.values)]
    low, high = (drive.low, drive.high) if drive else (-1.0, 1.0)
    note = f"  # {rate_of(g.signal.t):.3g} Hz" + (
        f"; {_safe(g.signal.about)}" if g.signal.about else ""
    )
    turned = sense < -MIN_CORRELATION
    if turned:
        note += f"; CHECK: sign turned, as the boat turns the other way (correlation {sense:+.2f})"
    scale = _scale(g, values, drive)
    if scale is None:
        made = g.name if g.name == name else _converted(g, name)
        return f"{_key(name)} = {_text(f'-{made}' if turned else made)}{note}"
    ends, why = scale
    if drive is None and g.column == "command" and low >= 0.0:
        low = 0.0
    low, high = (high, low) if turned else (low, high)
    given = ", ".join(f"{k} = {v:g}" for k, v in zip(("low", "neutral", "high"), ends, strict=True))
    note += f"; {why}" if why else ""
    if drive and unit_of(drive.name) == "rad":
        note += f"; CHECK: full helm is taken for {np.degrees(max(abs(low), abs(high))):.0f} deg"
    return f"{_key(name)} = {{ signal = {_text(g.name)}, {given}, least = {low:g}, most = {high:g} }}{note}"


def _scale(
    g: Guess, values: "np.ndarray[tuple[int, ...], np.dtype[np.float64]]", drive: Drive | None
) -> tuple[tuple[float, float, float], str] | None:
    """Low, neutral and high of a signal that is a share of full command, and a word on where they come from."""
    share = "in proportion to full command"
    if drive and g.name == drive.name:
        return None
    if g.signal.pulse:
        return g.signal.pulse, share if drive else ""
    if PULSE[0] <= values.min() and values.max() <= PULSE[1]:
        return USUAL_PULSE, f"usual pulses of 1100 to 1900 us are taken for granted, {share}"
    largest = float(np.max(np.abs(values)))
    if drive and _turns_a_screw(drive, g):
        why = "CHECK: full thrust is taken for the most revolutions here; it goes with their square, not straight"
        return (-largest, 0.0, largest), why
    if drive is None or unit_of(drive.name) and g.word and g.word != "percent":
        return None
    span = max(abs(drive.low), abs(drive.high))
    if g.word == "percent" and (span != 100.0 or unit_of(drive.name)):
        return (-100.0, 0.0, 100.0), f"per cent, {share}"
    if g.name != drive.name and 1.5 < largest <= 100.0 and not 0.3 < largest / span < 1.01:
        return (-100.0, 0.0, 100.0), f"per cent by its range, {share}"
    if largest <= 1.01 and span > 2.0:
        return (-1.0, 0.0, 1.0), f"-1 to 1, {share}"
    return None


def _converted(g: Guess, name: str) -> str:
    """An expression that ends in the unit of the column."""
    if g.word == "rpm" and name.endswith("_rps"):
        return f"{g.name} / 60"
    return g.name if g.word == "rpm" and name.endswith("_rpm") else _expression(g)


def _called(g: Guess) -> str:
    words = g.tokens | frozenset(tokens_of(g.signal.about))
    kind = "steer" if words & HELM else "throttle"
    unit = {"deg": "_rad", "rpm": "_radps"}.get(g.word, "")
    return f"{kind}{'_' + side if (side := side_of(words)) else ''}{unit}"


def _names(names: Sequence[str]) -> list[str]:
    """The same, numbered where there are several of one name."""
    found, seen = [], dict[str, int]()
    for name in names:
        seen[name] = seen.get(name, 0) + 1
        stem, _, unit = name.partition("_rad")
        number = f"_{seen[name]}" if names.count(name) > 1 else ""
        found.append(f"{stem}{number}{f'_rad{unit}' if '_rad' in name else ''}")
    return found


def _kept(kind: str, found: Sequence[Guess]) -> list[str]:
    """Lines of further columns, named by their kind and their own names."""
    names = _names(
        [f"{kind}_{re.sub(r'[^a-z0-9]+', '_', g.name.lower()).strip('_')}" for g in found]
    )
    return [
        f"{_key(n)} = {_text(_expression(g) if g.word != 'us' else g.name)}"
        for n, g in zip(names, found, strict=True)
    ]


def _key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else _text(name)
