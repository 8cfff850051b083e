"""Imports between our own modules point down the layers, never round in a ring, and heavy libraries
stay in place."""

import re
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

from benchmarks.arrows import (
    HOME,
    OURS,
    count_imports,
    draw_imports,
    imported_modules,
    layer_of,
    main,
    module_or_plugin_folder,
    modules_of_boatsim,
)

FOR_CONTROLLERS = set(  # plain laws, ready to move to a boat
    "errors physics.base control.base control.adaptive control.adaptive_loop control.allocation control.jet "
    "control.identification control.helm control.compiled control.axis control.gradient_adaptation control.joystick"
    " control.differential "
    "control.motor_check control.operating_points control.passive_observer control.quadratic_program "
    "control.reference_motion control.thrust_allocation control.vessel_model control.dynamic_positioning "
    "control.guidance control.lag_design control.lag_joystick control.linear_model control.linear_quadratic control.paths "
    "control.planned_path control.receding_horizon "
    # of trained policies: what they observe, computed from a motion
    "learn.policy learn.hull learn.tasks.base learn.tasks.berth learn.tasks.follow_path learn.tasks.hold_station "
    "learn.tasks.joystick".split()
)
HEAVY = {  # library -> the only modules that may import it
    "mujoco": {f"simulate.{name}" for name in ("world", "hull_assets", "engine", "env")}
    | {"warp.on_mujoco", "physics.compiler_internals"},
    "mujoco_warp": {"warp.on_mujoco"},
    "warp": {"warp.runtime"},
    "dm_control": {"simulate.env"},
    "dm_env": {"simulate.env"},
    "gymnasium": {
        f"learn.{name}" for name in ("registration", "single", "spaces", "train", "vector")
    },
    "stable_baselines3": {"learn.sb3", "learn.train"},
    "torch": {"learn.train"},
    "onnx": {"learn.policy_export"},
    "onnxruntime": {"learn.policy"},
    "rerun": {"view.rerun_log", "view.blueprint", "view.stream", "recordings.readers.rrd"},
    "jinja2": {"view.html_page"},
    "ray": {"sweeps.workers.ray_cluster"},
    "pymavlink": {"recordings.logs.ardupilot"},
    "mcap": {"recordings.logs.mcap", "recordings.exporting.mcap"},
    "rosbags": {"recordings.logs.rosbag", "recordings.exporting.mcap"},
    "pyulog": {"recordings.logs.ulog"},
    "pynmea2": {"recordings.logs.nmea"},
    "websockets": {"drive.server"},
    "wavespectra": {"hydrodynamics.wave_spectra"},
    "xarray": {"hydrodynamics.wave_spectra"},
    "pandas": {"recordings.notebook.data_frame", "recordings.table", "api"},
    "matplotlib": {
        "recordings.notebook.figures",
        "recordings.notebook.views",
        "recordings.table",
        "diagnosis.report.notebook_views",
        "api",
    },
}
BY_ANY_NAME = {
    "physics.content",
    "physics.cache",
}  # what files name, and programs composed on the spot
DIAGNOSIS_FOLDERS = sorted(
    {".".join(name.split(".")[:2]) for name in OURS if re.match(r"diagnosis\.\w+\.", name)}
)
IMPORTERS_IN_DIAGNOSIS = {  # upper folder of the diagnosis -> what else there may import from it
    "diagnosis.answer": {
        "diagnosis.pipeline",
        "diagnosis.log_check",
        "diagnosis.report",
        "diagnosis.output",
    },
    "diagnosis.report": {"diagnosis.output"},
    "diagnosis.output": set[str](),
}
READ_BY_REPORT = {  # what a report imports from the diagnosis: the answer, its curves, and words
    f"boatsim.diagnosis.{name}"
    for name in (
        *(
            "answer.schema",
            "answer.findings",
            "answer.families",
            "answer.formulas",
            "answer.verdict",
        ),
        *("answer.confirmation", "answer.described_terms", "answer.incomplete", "answer.log_entry"),
        "answer.refined_numbers",
        *("model_names", "description.FittedTerm", "free_runs.FreeRun", "report"),
    )
}
CONTROLLERS = sorted((HOME / "controllers").glob("*.py"))


@pytest.mark.parametrize("name", OURS)
def test_a_module_imports_from_its_own_layer_and_lower_ones_only(name: str) -> None:
    above = [other for other in modules_of_boatsim(OURS[name]) if layer_of(other) > layer_of(name)]
    assert not above, f"{name} imports {above} from a layer above its own"


@pytest.mark.parametrize("name", OURS)
def test_only_content_and_programs_are_imported_by_a_name_that_is_found_in_a_run(name: str) -> None:
    assert name in BY_ANY_NAME or "" not in imported_modules(OURS[name])


def test_an_import_by_name_counts_as_one(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text(
        'from importlib import import_module\nimport_module("boatsim.view.scene")\n'
    )
    assert modules_of_boatsim(tmp_path / "a.py") == {"view.scene"}


def test_no_imports_form_a_ring() -> None:
    order = TopologicalSorter(
        {name: modules_of_boatsim(path) - {name} for name, path in OURS.items()}
    )
    assert set(order.static_order()) >= set(OURS)  # raises CycleError, which names the ring


def folder_in_diagnosis(name: str) -> str:
    """The folder of a module of the diagnosis, or the module itself if it lies in none."""
    return ".".join(name.split(".")[:2])


def test_the_folders_of_a_diagnosis_form_no_ring() -> None:
    imported: dict[str, set[str]] = {folder: set() for folder in DIAGNOSIS_FOLDERS}
    for name, path in OURS.items():
        if (folder := folder_in_diagnosis(name)) in imported:
            others = {folder_in_diagnosis(other) for other in modules_of_boatsim(path)}
            imported[folder] |= (others & imported.keys()) - {folder}
    order = TopologicalSorter(imported)
    assert {*order.static_order()} == {*DIAGNOSIS_FOLDERS}  # raises CycleError


@pytest.mark.parametrize("folder", IMPORTERS_IN_DIAGNOSIS)
def test_only_the_last_stages_of_a_diagnosis_know_its_answer_and_its_report(folder: str) -> None:
    importers = set()
    for name, path in OURS.items():
        imported = {folder_in_diagnosis(other) for other in modules_of_boatsim(path)}
        if name.startswith("diagnosis.") and folder in imported:
            importers.add(folder_in_diagnosis(name))
    assert importers - {folder} <= IMPORTERS_IN_DIAGNOSIS[folder]


@pytest.mark.parametrize("name", [name for name in OURS if name.startswith("diagnosis.report.")])
def test_a_report_reads_the_answer_and_its_curves_only(name: str) -> None:
    imported = {full for full in imported_modules(OURS[name]) if "boatsim.diagnosis" in full}
    assert not [full for full in imported if not readable_by_report(full)]


def readable_by_report(full: str) -> bool:
    """Whether a name, or the module or folder that contains it, may be imported by a report."""
    parts = full.split(".")
    return any(".".join(parts[:n]) in READ_BY_REPORT for n in range(1, len(parts) + 1))


def test_a_report_may_not_import_a_fit_or_a_stage() -> None:
    assert readable_by_report("boatsim.diagnosis.free_runs.FreeRun")
    for name in (
        *("fit.converge", "search.ranking", "filter", "locate.regions", "pipeline", "open_set"),
        *("free_runs.free_runs", "evaluation.Evaluation", "answer.compose.compose_answer"),
    ):
        assert not readable_by_report(f"boatsim.diagnosis.{name}")


@pytest.mark.parametrize("path", CONTROLLERS, ids=lambda path: path.stem)
def test_a_controller_knows_nothing_of_the_simulator(path: Path) -> None:
    assert modules_of_boatsim(path) <= FOR_CONTROLLERS


@pytest.mark.parametrize("library", HEAVY)
def test_a_heavy_library_is_imported_in_its_place_only(library: str) -> None:
    files = OURS | {f"controllers/{path.stem}": path for path in CONTROLLERS}
    users = {
        name
        for name, path in files.items()
        if library in {full.split(".")[0] for full in imported_modules(path)}
    }
    assert users <= HEAVY[library]


def test_the_picture_in_the_documents_is_up_to_date(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--check"]) == 0, capsys.readouterr().out


def test_the_picture_shows_every_import_from_folder_to_folder_once() -> None:
    found = count_imports()
    shown = re.findall(r'class="count".*>(\d+)<', draw_imports(found))
    left_out = {
        "__init__",
        "__main__",
        "api",
        "arguments",
        "errors",
        "files",
        "atomic_folder",
        "quiet",
        "interruption",
        "progress",
        "version",
    }  # of no folder
    assert sorted(map(int, shown)) == sorted(
        n for pair, n in found.items() if not left_out & set(pair)
    )


def test_a_further_file_on_a_shelf_leaves_the_picture_as_it_is() -> None:
    assert (
        module_or_plugin_folder("physics.effects.made_up")
        == module_or_plugin_folder("physics.effects.fan_wind")
        == "physics.effects"
    )
    assert module_or_plugin_folder("physics.param") == "physics.param"
