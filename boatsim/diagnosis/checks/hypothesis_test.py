"""Lays a log on its vessel as it is and as it may have been meant: what sails like the boat is what was meant.

Nothing is tried where the vessel explains the log: where the force that it leaves unexplained is a small part of what
its drives push with, and its bow points where it goes. A meaning is accepted only if it makes the log far likelier than
it is as written and than any other meaning makes it, all of them with coefficients refitted.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from threadpoolctl import threadpool_limits

from boatsim.diagnosis.checks.finding import Change, Finding, applied
from boatsim.diagnosis.checks.reinterpretations import Meaning, meanings, points_aside, turned_by
from boatsim.diagnosis.checks.steering_sense import turned
from boatsim.diagnosis.filter import MappedRecording, axes_of
from boatsim.diagnosis.locate import nominal_forces
from boatsim.diagnosis.noise_levels import fit_noise
from boatsim.diagnosis.priors import rate
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.ranking import baseline
from boatsim.errors import BadInput
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

UNEXPLAINED = 0.6  # of what the drives push with, from which meanings are tried
FLOOR = 0.02  # of the largest push, times the length for a moment: drives that do not turn the hull
NATS, SHARE = 60.0, 0.05  # that a meaning must gain, at least; of the rows
# nats by which it must be ahead of what the log as written, or another meaning, would be
CLEAR = 25.0
# nats within which meanings are one: a boat alike on both sides can not tell a mirror from
# exchanged drives
TIED = 3.0
MOST_ROWS, MOST_RUNS = 1200, 3  # that are laid on
CROWDED = 1.5  # times the usual rows a second, from which each instrument has its own
REFITTED = 6  # meanings, of all that are tried roughly
ROUND = np.radians(
    np.delete(np.arange(-165.0, 181.0, 15.0), [5, 11, 17, 23])
)  # [rad] turns, but for quarters
STEPS = np.arange(
    -16.0, 17.0, 4.0
)  # [deg] beside a turned heading, between which the best is looked for
NEAR = np.radians(35.0)  # by which turns of the heading are no rivals
ABOUT = 4.0  # [deg] by which a quarter turn may be missed
ROUNDS = 2  # faults one upon the other
LEVEL = ("surge", "sway", "yaw")
Lay = Callable[[Recording], MappedRecording]


def tried(recordings: Sequence[Recording], lay: Lay, problem: Problem) -> list[Finding]:
    """Findings on recordings that are opened and thinned; `problem` has them on the vessel as written.

    `lay` lays one on the same program. Raises BadInput where the log can not be laid on it.
    """
    short = _short(recordings, problem.program.vessel)
    with threadpool_limits(1, "blas"):
        laid = _laid(short, lay, problem)
        explained = unexplained(laid, fit_noise(laid, laid.nominal())) < UNEXPLAINED
        if explained and not points_aside(recordings, problem.program.vessel):
            return []
        return _tried([_unturned(r) for r in short], lay, problem)


def unexplained(problem: Problem, nominal: Fit) -> float:
    """Largest share that the slow force of a fit is of what the drives push with, over surge, sway and yaw."""
    vessel = problem.program.vessel
    axes = axes_of(vessel)
    pushed = np.zeros(len(axes))
    for laid in problem.recordings:
        held = nominal_forces.actuators(laid)[:: max(1, len(laid.times) // 100)]
        rest = np.zeros((len(held), 2 * problem.program.module.NQ))
        pushed = np.maximum(
            pushed,
            np.sqrt(np.mean(nominal_forces.along(laid, rest, held, laid.values) ** 2, axis=0)),
        )
    push = max((pushed[i] for i, a in enumerate(axes) if a in LEVEL[:2]), default=0.0)
    if not push > 0.0:
        return 0.0
    shares = []
    for i, axis in enumerate(axes):
        if axis in LEVEL:
            least = FLOOR * push * vessel.length
            scale = push if axis != "yaw" else max(float(pushed[i]), 4.0 * least)
            shares.append(float(nominal.levels.force[i]) / scale)
    return max(shares, default=0.0)


def _short(recordings: Sequence[Recording], vessel: Vessel) -> list[Recording]:
    """The first rows of the first recordings: meanings differ in all of them.

    Instruments that each have rows of their own would fill them within seconds: they are thinned to a common count.
    """
    runs = list(recordings)[:MOST_RUNS]
    usual = rate(vessel)
    for k, r in enumerate(runs):
        if (crowd := len(r) / float(r.t[-1] - r.t[0]) / usual) > CROWDED:
            runs[k] = r.thinned(usual / crowd)
    return [
        r.between(float(r.t[0]), float(r.t[min(len(r), MOST_ROWS // len(runs)) - 1])) for r in runs
    ]


def _unturned(recording: Recording) -> Recording:
    """The recording with rudders as they are in its file."""
    return applied(recording, [Change(n, n, -1.0) for n in turned(recording)])


def _tried(recordings: list[Recording], lay: Lay, problem: Problem) -> list[Finding]:
    found: list[Finding] = []
    done: tuple[Change, ...] = ()
    for _ in range(ROUNDS):
        now = [applied(r, done) for r in recordings]
        best = _best(now, lay, problem)
        if best is None:
            break
        finding, meaning = best
        found.append(finding)
        if {c.ours for c in meaning.changes} & {c.ours for c in done}:
            break
        done = (*done, *meaning.changes)
        again = _laid([applied(r, meaning.changes) for r in now], lay, problem)
        if unexplained(again, fit_noise(again, again.nominal())) < UNEXPLAINED:
            break
    return found


def _best(
    recordings: list[Recording], lay: Lay, problem: Problem
) -> tuple[Finding, Meaning] | None:
    meant = _likeliest(meanings(recordings, problem.program.vessel), recordings, lay, problem)
    if not meant:
        return None
    written = _score(recordings, (), lay, problem)
    scored = [(m, _score(recordings, m.changes, lay, problem)) for m in meant]
    scored = [(m, s) for m, s in scored if np.isfinite(s[0])]
    if not scored or not np.isfinite(written[0]):
        return None
    top = max(s[0] for _, s in scored)
    scored = _apart(scored)
    ties = [(m, s) for m, s in scored if top - s[0] < TIED]
    rest = max((s[0] for m, s in scored if top - s[0] >= TIED), default=-np.inf)
    rows = sum(len(r) for r in recordings)
    gain, ahead = top - written[0], top - max(written[0], rest)
    meaning, (_, left) = ties[0]
    if gain < max(NATS, SHARE * rows) or ahead < CLEAR:
        return None
    if meaning.name == "heading_turned":
        meaning = _nearest(meaning, recordings, lay, problem)
    evidence = (
        f"{meaning.words}: laid on {problem.program.vessel.name} so, the log is likelier by {gain:.0f} nats, "
        "coefficients refitted"
    )
    if left < written[1]:
        sizes = (f"{100.0 * share:.2g} %" for share in (left, written[1]))
        evidence += ", and the force left unexplained is {} of what the drives push with instead of {}".format(
            *sizes
        )
    others = [*meaning.alternatives, *((m.words, m.changes) for m, _ in ties[1:])]
    if len(ties) > 1:
        evidence += (
            f"; this boat is alike on both sides, so that it fits as well that {ties[1][0].words}"
        )
    sure = 1.0 - float(np.exp(-min(ahead, 50.0) / 4.0))
    found = Finding(meaning.name, evidence, sure=sure, changes=meaning.changes, words=meaning.words)
    return replace(found, alternatives=tuple(others)), meaning


def _apart(
    scored: list[tuple[Meaning, tuple[float, float]]],
) -> list[tuple[Meaning, tuple[float, float]]]:
    """Without turns of the heading near a likelier one: a few degrees beside what was meant is no rival to it."""
    kept: list[tuple[Meaning, tuple[float, float]]] = []
    for m, s in sorted(scored, key=lambda x: -x[1][0]):
        turns = [n.changes[0].offset for n, _ in kept if n.name == m.name == "heading_turned"]
        if all(abs(np.angle(np.exp(1j * (m.changes[0].offset - a)))) > NEAR for a in turns):
            kept.append((m, s))
    return sorted(kept, key=scored.index)


def _likeliest(
    meant: list[Meaning], recordings: list[Recording], lay: Lay, problem: Problem
) -> list[Meaning]:
    """Those to which coefficients are refitted: likelier than the log as written, with its own noise and forces.

    With them the likeliest turn of the heading among many.
    """
    written = _laid(recordings, lay, problem)
    levels = fit_noise(written, written.nominal()).levels
    nominal, on = written.nominal(), written.program.switches()

    def roughly(m: Meaning) -> float:
        try:
            laid = _laid([applied(r, m.changes) for r in recordings], lay, problem)
        except BadInput:
            return -np.inf
        found = laid.likelihood(nominal.free, nominal.theta, on, levels)
        return found if np.isfinite(found) else -np.inf

    if any(m.name == "heading_turned" for m in meant):
        meant = [*meant, max((turned_by(float(a)) for a in ROUND), key=roughly)]
    scores = {m.words: roughly(m) for m in meant}
    least = roughly(Meaning("as written", "", ()))
    better = sorted((m for m in meant if scores[m.words] > least), key=lambda m: -scores[m.words])
    return sorted(better[:REFITTED], key=meant.index)


def _nearest(meaning: Meaning, recordings: list[Recording], lay: Lay, problem: Problem) -> Meaning:
    """The same to the degree: the best of some angles, and the top of the parabola through it and those beside."""
    around = np.degrees(meaning.changes[0].offset) + STEPS
    scores = np.array(
        [
            _score(recordings, turned_by(float(np.radians(a))).changes, lay, problem)[0]
            for a in around
        ]
    )
    top = int(np.clip(np.argmax(scores), 1, len(STEPS) - 2))
    bent, slope, _ = np.polyfit(STEPS[top - 1 : top + 2], scores[top - 1 : top + 2], 2)
    best = around[top] if not bent < 0.0 else around[top] - STEPS[top] - 0.5 * slope / bent
    quarter = 90.0 * np.round(best / 90.0)
    return turned_by(float(np.radians(quarter if abs(best - quarter) < ABOUT else np.round(best))))


def _laid(recordings: list[Recording], lay: Lay, problem: Problem) -> Problem:
    """The same question to recordings with other columns."""
    return problem.on([lay(r) for r in recordings])


def _score(
    recordings: list[Recording], changes: tuple[Change, ...], lay: Lay, problem: Problem
) -> tuple[float, float]:
    """Evidence of a log as it may have been meant, coefficients refitted, and what is left unexplained."""
    try:
        laid = _laid([applied(r, changes) for r in recordings], lay, problem)
        _, recalibrated = baseline(laid)
    except (BadInput, np.linalg.LinAlgError, FloatingPointError):
        return -np.inf, np.inf
    return recalibrated.evidence, unexplained(laid, recalibrated)
