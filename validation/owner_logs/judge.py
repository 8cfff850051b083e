"""Evaluation of one case: the commands an owner gives in sequence, and their results."""

import json
import re
import shutil
from dataclasses import asdict, dataclass, field
from pathlib import Path

from validation.owner_logs.cases import Case, make
from validation.owner_logs.causes import CAUSES
from validation.owner_logs.commands import (
    CommandResult,
    Finding,
    add_to_notes,
    parse_findings,
    parse_limits,
    run_boatsim,
)
from validation.owner_logs.faults import FAULTS
from validation.owner_logs.formats.log import WrittenLog
from validation.owner_logs.owner import correct_lines, correct_map

HORIZON = 8.0  # [s] free runs of the second log, boat of 2 m
POSITION = re.compile(r"position_rms_m: ([\d.e+-]+)")
HALF = 0.5  # goal: error relative to the vessel from particulars
PLAIN_SIGHT = 4.0  # sd of a fix; a smaller error of that vessel leaves nothing to improve
# every simulated gyro has an offset, and every antenna is off the mass centre
TRUE_OF_INSTRUMENTS = ("yaw_rate_offset", "position_frame_error")
# power of the command that the revolutions are where thrust is proportional to it, as the vessel
# from particulars assumes
PROPORTIONAL = 0.5
LIMITS = {"never_turned": "turn", "saturated": "full|limit|saturat|highest", "one_speed": "speed"}


@dataclass
class Result:
    """Result of a case."""

    number: int
    kind: str
    boat: str
    form: str
    fault: str
    cause: str
    strength: str
    read: bool = False
    need: str = ""  # message if the log could not be read
    edits: list[str] = field(default_factory=list)
    found: list[str] = field(default_factory=list)  # by check
    fault_named: bool | None = None
    mended: bool | None = None  # corrected by the advised lines; None: no line can
    accused: bool = False  # false alarm on a good log
    verdict: str = ""
    effects: list[str] = field(default_factory=list)
    right: list[str] = field(default_factory=list)  # names of effects that are true of the case
    false_names: int = 0  # effects that are not true of the case, nor tied with one that is
    first_named: bool | None = None  # whether the first effect is the cause
    physics_named: bool | None = None
    called_physics: bool | None = None
    nominal_m: float = float("nan")  # second log, vessel from particulars
    answer_m: float = float("nan")  # second log, vessel of the answer
    possible: bool | None = None
    seconds: float = 0.0
    trouble: str = ""

    @property
    def ratio(self) -> float:
        """Ratio of the errors on the second log."""
        return self.answer_m / self.nominal_m


def right_names(case: Case) -> set[str]:
    """Return the names of effects that are true of a case."""
    names = set(TRUE_OF_INSTRUMENTS)
    if case.boat.curve != PROPORTIONAL:
        names.add("thrust_exponent")
    if case.cause:
        names.update(CAUSES[case.cause].named)
    if case.fault:
        names.update(FAULTS[case.fault].named, FAULTS[case.fault].entries)
    return names


class Judge:
    """Evaluation of one case in a separate folder."""

    def __init__(self, case: Case, folder: Path, log_only: bool = False) -> None:
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        self.folder, self.log_only = folder, log_only
        self.logs, self.case = make(case, folder)
        c = self.case
        self.result = Result(c.number, c.kind, c.boat.name, c.form, c.fault, c.cause, c.strength)
        self.vessel = folder / c.boat.name
        self.history: list[str] = []

    def call(self, *arguments: str | Path) -> CommandResult:
        """Run a command and record it in history.txt."""
        result = run_boatsim(*arguments)
        shown = " ".join(str(a) for a in arguments)
        self.history.append(
            f"$ boatsim {shown}\n{result.out}{result.err}[exit {result.code}, "
            f"{result.seconds:.1f} s]\n"
        )
        (self.folder / "history.txt").write_text("\n".join(self.history), encoding="utf-8")
        self.result.seconds += result.seconds
        return result

    def judge(self) -> Result:
        """Run all commands and write result.json."""
        made = self.call("new", self.vessel, *self.case.boat.options)
        if made.code:
            self.result.trouble = f"new: {made.last}"
        elif run := self.recording(self.logs.first, 1):
            self.log(run)
            if not self.log_only:
                self.physics(run)
        (self.folder / "result.json").write_text(
            json.dumps(asdict(self.result), indent=1), encoding="utf-8"
        )
        return self.result

    def recording(self, log: WrittenLog, number: int) -> Path | None:
        """Return the log as a recording; a table in boatsim's own names already is one."""
        home = self.folder / f"run_{number}"
        home.mkdir()
        if self.case.form.startswith("plain."):
            run = home / log.path.name
            shutil.copy(log.path, run)
            add_to_notes(
                home / "recording.toml", [f"vessel = {json.dumps('../' + self.case.boat.name)}"]
            )
            self.result.read = True
            return run
        return self.imported(log, home, number)

    def imported(self, log: WrittenLog, home: Path, number: int) -> Path | None:
        """Import the log with the proposed map."""
        map, run = home / "map.toml", home / "run.csv"
        asked = self.call("import", log.path, "--vessel", self.vessel, "--propose", map)
        if asked.code:
            return self._refused(asked, number)
        lines = correct_lines(self.case.boat, self.vessel / "vessel.toml", log.orders)
        text, edits = correct_map(map.read_text(encoding="utf-8"), lines)
        map.write_text(text, encoding="utf-8")
        made = self.call("import", log.path, "--map", map, "--out", run, "--vessel", self.vessel)
        if made.code or "a diagnosis would refuse it" in made.err:
            return self._refused(made, number)
        if number == 1:
            self.result.read, self.result.edits = True, edits
        return run

    def _refused(self, result: CommandResult, number: int) -> None:
        if number == 1:
            self.result.need = result.last if result.code != 99 else ""
        self.result.trouble = f"import {number}: {result.last}"

    def log(self, run: Path) -> None:
        """Record the findings of `boatsim check` and whether its advice corrects the log."""
        r, wrong = self.result, self.case.wrong
        result = self.call("check", run)
        found = parse_findings(result)
        r.found = [f.name for f in found] + [f"limit: {text[:40]}" for text in parse_limits(result)]
        if result.code == 2 or result.code == 99:
            r.trouble = f"check: {result.last}"
        if wrong is None:
            r.accused = any(f.name not in ("position_held",) for f in found)
            return
        r.fault_named = bool({f.name for f in found} & set(wrong.named)) or any(
            re.search(LIMITS[n], text.lower())
            for n in wrong.named
            if n in LIMITS
            for text in parse_limits(result)
        )
        advice = [f for f in found if f.lines]
        if not wrong.mendable:
            return
        r.mended = any(f.allowed and f.name in wrong.named for f in found)
        if advice:
            self._follow(run, advice[0])
            left = [f for f in parse_findings(self.call("check", run)) if f.lines]
            r.mended = r.fault_named and not left
            r.found += [f"then {f.name}" for f in left]

    def _follow(self, run: Path, first: Finding) -> None:
        add_to_notes(run.parent / "recording.toml", first.lines)

    def physics(self, run: Path) -> None:
        """Record the effects that diagnose names and the prediction of the second log."""
        r, out = self.result, self.folder / "diagnosis"
        result = self.call("diagnose", run, "--out", out)
        if result.code:
            r.trouble = "" if r.fault_named and result.code == 2 else f"diagnose: {result.last}"
            r.need = result.last
            r.physics_named = False if self.case.cause else None
            r.called_physics = False if self.case.fault else None
            return
        answer = json.loads((out / "diagnosis.json").read_text(encoding="utf-8"))
        r.verdict = answer["verdict"]
        r.effects = [
            n for e in answer["effects"] for n in dict.fromkeys([e["name"], *e["tied_with"]])
        ]
        right = right_names(self.case)
        r.right = sorted(right)
        meant = [{e["name"], *e["tied_with"]} for e in answer["effects"]]
        r.false_names = sum(not names & right for names in meant)
        if self.case.cause:
            r.first_named = bool(meant and meant[0] & set(CAUSES[self.case.cause].named))
            known = {*r.effects, *(e["name"] for e in answer.get("refined", ()))}
            r.physics_named = bool(known & set(CAUSES[self.case.cause].named))
        if self.case.wrong:
            identified = r.fault_named or any(
                e["name"] in self.case.wrong.named for e in answer.get("log", [])
            )
            identified = r.fault_named = bool(
                identified or set(r.effects) & set(self.case.wrong.entries)
            )
            r.called_physics = not identified and r.verdict != "nothing_missing"
        self.foretell(out / "patched.toml")

    def foretell(self, patched: Path) -> None:
        """Simulate the second log with both vessels."""
        r = self.result
        second = self.recording(self.logs.second, 2)
        if second is None:
            return
        horizon = f"{HORIZON * self.case.boat.scale:.0f}"
        r.nominal_m = self.error(second, self.vessel, horizon)
        r.answer_m = self.error(second, patched, horizon)
        r.possible = r.nominal_m > PLAIN_SIGHT * self.logs.truth["fix_sd"]

    def error(self, run: Path, vessel: Path, horizon: str) -> float:
        """Return the rms error [m] of free runs."""
        result = self.call(
            "replay", run, "--vessel", vessel, "--horizon", horizon, "--out", self.folder / "replay"
        )
        match = POSITION.search(result.out)
        if not match:
            self.result.trouble = f"replay: {result.last}"
        if match:
            return float(match[1])
        return float("nan")
