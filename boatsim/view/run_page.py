"""report.html of a run: replay, metrics, signals over time, and how to repeat the run."""

import shlex
from collections.abc import Mapping
from pathlib import Path

from boatsim.files import replace_file
from boatsim.recordings.table import Recording
from boatsim.simulate.evaluation import MISSED, NO_TOLERANCE, REPRODUCED, MetricEntry, RunEntry
from boatsim.simulate.scenario import Scenario
from boatsim.view.formatting import format_number
from boatsim.view.html_page import TEMPLATES, render_template
from boatsim.view.page_blocks import Figures, Items, Section, Table, Text
from boatsim.view.run_facts import run_facts
from boatsim.view.run_figures import run_figures
from boatsim.view.run_replay import run_replay
from boatsim.view.run_sentence import explain_name_endings, run_sentence, run_verdict
from boatsim.view.scene import Scene
from boatsim.view.thinned_log import Samples, ThinnedLog

NAME = "report.html"
TEMPLATE = TEMPLATES / "run.html.j2"
VERDICTS = {REPRODUCED: "the same", MISSED: "differs", NO_TOLERANCE: "no tolerance stated"}
FILES = (
    ("recording.csv", "the true motion, commands and sensor readings at every logged step"),
    ("camera.csv", "what a camera above the water measures, a recording as an owner has one"),
    ("norms.json", "the metrics"),
    ("recording.toml", "vessel, load, noise and facts for a later diagnosis"),
    ("run.rrd", "the run in 3-D for the rerun viewer: rerun run.rrd"),
    ("scenario.toml", "the scenario with the goals of a driver"),
)


def run_command(address: str, controller: str | None = None, seed: int | None = None) -> str:
    """Return the command that repeats a run.

    Args:
        address: Name or path of the scenario.
        controller: Controller in place of the scenario's own, by name or path.
        seed: Random seed; None for the scenario's own.
    """
    words = ["boatsim", "run", address]
    if controller is not None:
        words += ["--controller", controller]
    if seed is not None:
        words += ["--seed", str(seed)]
    return shlex.join(words)


class RunPage:
    """Observer of a run that writes report.html at its end."""

    def __init__(self, folder: Path, scene: Scene, scenario: Scenario, command: str) -> None:
        """Begin to follow a run.

        Args:
            folder: Folder of the run's files.
            scene: Shape of the vessel, and the water.
            scenario: The scenario.
            command: Command that repeats the run; "" if there is none.
        """
        self._folder, self._scene, self._scenario = folder, scene, scenario
        self._command = command
        self._log = ThinnedLog()

    def add_rows(self, rows: Recording) -> None:
        """Receive the new rows of the log of a run in progress.

        Args:
            rows: Rows that follow those received before.
        """
        self._log.add_rows(rows)

    def finish(self, result: RunEntry) -> None:
        """Write the page report.html at the end of the run.

        Args:
            result: Content of norms.json.

        Raises:
            OSError: If the file cannot be written.
        """
        samples = self._log.samples()
        page = run_html(self._scenario, result, samples, self._scene, self._command, self._files())
        with replace_file(self._folder / NAME) as temporary:
            temporary.write_text(page, encoding="utf-8", errors="replace")

    def _files(self) -> list[tuple[str, str]]:
        """Return the files of the run with their contents; norms.json is written after the page."""
        found = []
        for name, words in FILES:
            if name == "norms.json" or (self._folder / name).exists():
                found.append((name, words))
        return found


def run_html(
    scenario: Scenario,
    result: RunEntry,
    samples: Samples | None,
    scene: Scene,
    command: str,
    files: list[tuple[str, str]],
) -> str:
    """Return the page of a run as HTML.

    Args:
        scenario: The scenario.
        result: Content of norms.json.
        samples: Samples of the log; None for a run without rows.
        scene: Shape of the vessel, and the water.
        command: Command that repeats the run; "" if there is none.
        files: Files of the run with their contents.
    """
    replay = None
    sections = [Section("metrics", "Metrics", [*_metric_blocks(result)])]
    if samples is not None:
        replay = run_replay(samples, scene)
        figures = run_figures(samples, scenario.vessel.commands)
        note = Text(_signal_note(samples))
        sections.append(Section("signals", "Signals over time", [note, Figures("", figures)]))
    sections.append(Section("files", "Files of this run", [Items(tuple(files))]))
    return render_template(
        TEMPLATE,
        title=result["scenario"],
        about=scenario.file.about,
        verdict=run_verdict(result),
        sentence=run_sentence(result),
        facts=_length_first(run_facts(scenario, result), samples),
        command=command,
        sections=sections,
        replay=replay,
    )


def _length_first(facts: list[tuple[str, str]], samples: Samples | None) -> list[tuple[str, str]]:
    """Return the facts of a run with its length in front."""
    length = "nothing was logged"
    if samples is not None:
        length = f"{format_number(samples.end - float(samples.t[0]))} s"
    return [("Simulated", length), *facts]


def _signal_note(samples: Samples) -> str:
    """Return how the signals are shown."""
    note = (
        "Angles are in degrees; recording.csv has radians. Forces and velocities are in the "
        "axes of the boat: surge forward, sway to starboard, yaw clockwise."
    )
    if samples.rows > len(samples.t):
        each = format_number(samples.rows / len(samples.t), 2)
        note += (
            f" The log has {samples.rows:,} rows; a curve shows the smallest and the largest value "
            f"of each {each} rows."
        )
    return note


def _metric_blocks(result: RunEntry) -> list[Table | Text]:
    """Return the table of the metrics, and why some have no value."""
    metrics = result["norms"]
    blocks: list[Table | Text] = []
    if metrics:
        blocks.append(_metric_table(metrics))
        for line in explain_name_endings(metrics):
            blocks.append(Text(f"Endings of the names: {line}."))
    else:
        blocks.append(Text("This scenario has no metrics."))
    reasons: dict[str, list[str]] = {}
    for name, entry in metrics.items():
        if entry["lacking"]:
            reasons.setdefault(entry["lacking"], []).append(name)
    for reason, names in reasons.items():
        blocks.append(Text(f"Without a value: {', '.join(names)}: {reason}."))
    if saturated := result["saturated_steps"]:
        steps = []
        for channel, number in saturated.items():
            steps.append(f"{channel} in {number:,} of {result['steps']:,} steps")
        blocks.append(
            Text(f"Commands beyond the range of their channel were limited: {', '.join(steps)}.")
        )
    return blocks


def _metric_table(metrics: Mapping[str, MetricEntry]) -> Table:
    """Return the table of metrics; a column without entries is left out."""
    published = any(entry["published"] is not None for entry in metrics.values())
    bands = any(entry["guard"] for entry in metrics.values())
    header, prose = ["Metric", "Value"], []
    if bands:
        header += ["Within band", "Regression band"]
        prose.append(2)
    if published:
        header += ["Published", "Compared"]
        prose.append(len(header) - 1)
    rows = []
    for name, entry in metrics.items():
        row = [name, _quantity(entry["value"], entry["unit"])]
        if bands:
            row += [{None: "", True: "yes", False: "no"}[entry["ok"]], _band(entry)]
        if published:
            number = ""
            if entry["published"] is not None:
                number = _quantity(entry["published"], entry["unit"])
            row += [number, VERDICTS.get(entry["verdict"] or "", "")]
        rows.append(row)
    caption = "Metrics of this run. "
    if bands:
        caption += (
            "The regression band shows whether a change of the program changed the result; it "
            "promises no accuracy."
        )
    return Table(caption.strip(), header, rows, tuple(prose))


def _quantity(value: float | None, unit: str) -> str:
    if value is None:
        return "none"
    unit = unit.replace("deg", "°")
    space = "" if unit.startswith("°") else "\u00a0"
    return f"{_number(value)}{space}{unit}".rstrip()


def _number(value: float) -> str:
    """Return a number as the terminal prints it."""
    return f"{value:.4g}".replace("-", "−")


def _band(entry: MetricEntry) -> str:
    """Return the regression band of a metric in words."""
    low, high = entry["guard"] or (None, None)
    if low is not None and high is not None:
        return f"{_number(low)} to {_quantity(high, entry['unit'])}"
    if low is not None:
        return f"at least {_quantity(low, entry['unit'])}"
    if high is not None:
        return f"at most {_quantity(high, entry['unit'])}"
    return ""
