"""What is driven: a vessel in open water or in the water of a scenario, and the file by which the run goes again."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import tomlkit

from boatsim.drive.stick_mapping import Dials, dials_of
from boatsim.errors import BadInput
from boatsim.files import MAX_TOML_BYTES, Value
from boatsim.physics.content import find, load_class, names
from boatsim.simulate.cases import Place, content, meant
from boatsim.simulate.scenario import OFF, Scenario, from_table

FILE = "scenario.toml"
LONGEST = 3600.0  # [s] of a run that nobody ends
SHORTEST = 1.01e-4  # [s] of a step, with which any controller can be made
STEP = 0.02  # [s] of physics, or the controller's period where that is shorter
PASSED_ON = "open_loop"  # hands on the channels themselves
ASKED = (
    "goal",
    "until",
    "measure",
    "norms",
    "noise_widens_guards",
    "check",
    "duration",
)  # a scenario's own task
Goals = Sequence[tuple[float, Mapping[str, float] | None]]  # from when [s], None: nobody's hands


class Task:
    """A scenario to be driven, what the sticks set in it, and what it says."""

    def __init__(
        self,
        vessel: str,
        scenario: str | None = None,
        controller: str | None = None,
        load: Sequence[str] = (),
        seconds: float = LONGEST,
    ) -> None:
        """By names as on the command line. Raises BadInput."""
        said, place = _around(vessel, scenario, load)
        said |= {"controller": _steering(said.get("controller"), controller), "duration": seconds}
        made = from_table({"step": SHORTEST, **said}, place)
        self.vessel, use = made.vessel, str(made.file.controller["use"])
        said = {"step": min(STEP, made.controller.period), **said}
        said["about"] = f"{made.vessel.name} driven by hand" + (
            f", in {place.name}." if scenario else "."
        )
        self.dials: Dials = dials_of(made.vessel, made.controller, Path(use).stem)
        self._said = said
        self.scenario: Scenario = replace(
            from_table({**said, "goal": [{**self.dials.neutral}]}, place),
            name=f"{made.vessel.name}/drive",
            address="",
        )

    def in_folder(self, folder: Path) -> Scenario:
        """The scenario as it is found again in the folder of its run."""
        return replace(self.scenario, address=str(folder.resolve() / FILE))

    def toml(self, goals: Goals, duration: float) -> str | None:
        """Its file with the goals that hands have asked for; None where no file of ours may be so large."""
        said = {k: v for k, v in self._said.items() if k != "goal"}
        head = tomlkit.dumps({**said, "duration": duration})
        rows = "".join(f"  {_row(t, goal)},\n" for t, goal in goals)
        own, _, tables = head.partition(
            "\n["
        )  # an array of a file itself stands in front of its tables
        text = f"{own.rstrip()}\ngoal = [\n{rows}]\n" + (f"\n[{tables}" if tables else "")
        return text if len(text.encode()) <= MAX_TOML_BYTES else None


def _row(t: float, goal: Mapping[str, float] | None) -> str:
    said = (
        f"{OFF} = true"
        if goal is None
        else ", ".join(f"{key} = {value!r}" for key, value in goal.items())
    )
    return f"{{ from = {round(t, 9)!r}, {said} }}"


def _around(
    vessel: str, scenario: str | None, load: Sequence[str]
) -> tuple[dict[str, Value], Place]:
    """What is said of boat and water: by a scenario, of which the task is left out, or open water."""
    path = find("vessel", vessel)
    if scenario is None:
        aboard: dict[str, Value] = {
            "vessel": _vessel(vessel, path),
            "load": list(load),
            "sensors": {"ideal": True},
        }
        return aboard, Place(Path("drive"))
    said, place = content(_meant(vessel, scenario))
    given = said.get("vessel")
    if (
        not isinstance(given, str)
        or find("vessel", given, place.path.parent).resolve() != path.resolve()
    ):
        raise BadInput(f"--scenario {scenario} is of {given}, not of {vessel}")
    kept = {key: value for key, value in said.items() if key not in ASKED}
    return {**kept, **({"load": list(load)} if load else {})}, place


def _vessel(name: str, path: Path) -> str:
    """A vessel as a file says it that may lie anywhere."""
    return name if name in names("vessel") else str(path.resolve())


def _meant(vessel: str, scenario: str) -> str:
    """A scenario by its name, by that of the vessel's own (berth), or by its file. Raises BadInput."""
    own = f"{vessel}/{scenario}"
    if own in names("scenario"):
        return own
    found = meant(scenario)
    if len(found) > 1:
        raise BadInput(
            f"--scenario {scenario} names {len(found)}: {', '.join(found[:3])} ...; one can be driven"
        )
    return found[0]


def _steering(own: Value, controller: str | None) -> Mapping[str, Value]:
    """The [controller] table: the one named, else the scenario's own, else hands on the channels."""
    if controller is None:
        return own if isinstance(own, Mapping) else {"use": PASSED_ON}
    load_class("controller", controller, named=True)
    use = controller if controller in names("controller") else str(find("controller", controller))
    return own if isinstance(own, Mapping) and own.get("use") == use else {"use": use}
