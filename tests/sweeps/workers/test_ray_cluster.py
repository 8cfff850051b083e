"""A sweep on a Ray cluster of two nodes of this machine, one of which is lost on the way."""

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from boatsim.errors import BadInput
from boatsim.sweeps.axes import parse_axis
from boatsim.sweeps.execute import run_plan
from boatsim.sweeps.plan import Plan, make_plan
from boatsim.sweeps.sampled_keys import parse_sampled_key

ray = pytest.importorskip("ray")
pytestmark = pytest.mark.slow


@pytest.fixture
def cluster(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """Two nodes of one processor each, which know this boatsim."""
    from ray.cluster_utils import Cluster

    home = str(Path(__file__).parents[3])
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([home, str(Path(__file__).parents[2])]))
    monkeypatch.setenv("RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO", "0")
    made = Cluster(initialize_head=True, head_node_args={"num_cpus": 1, "include_dashboard": False})
    try:
        yield made
    finally:
        ray.shutdown()
        made.shutdown()


def study(runs: int) -> Plan:
    steered = parse_axis("controller.use=pid_autopilot,l1_joystick")
    return make_plan(
        ["joystick_boat/sway_1"],
        [steered],
        [parse_sampled_key("weak_reverse.astern_factor=normal(0.7,0.05)")],
        runs,
        0,
    )


def test_a_node_that_is_lost_costs_no_run_and_the_table_is_that_of_processes(
    cluster: Any, tmp_path: Path
) -> None:
    lost = cluster.add_node(num_cpus=1)
    cluster.wait_for_nodes()
    told: list[str] = []

    def report(stage: str, share: float = 0.0, detail: str = "") -> None:
        told.append(detail)
        if share > 0.3 and len(cluster.list_all_nodes()) == 2:
            cluster.remove_node(lost, allow_graceful=False)

    _, whole = run_plan(study(40), tmp_path / "cluster", ray=cluster.address, report=report)
    assert whole and len(cluster.list_all_nodes()) == 1
    run_plan(study(40), tmp_path / "here", jobs=1)
    one, other = (tmp_path / name / "sweep.parquet" for name in ("cluster", "here"))
    assert one.read_bytes() == other.read_bytes()


def test_no_cluster_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="--ray auto: no cluster answers"):
        run_plan(study(2), tmp_path / "out", ray="auto")


def test_a_command_that_is_killed_on_a_cluster_goes_on_in_processes(
    cluster: Any, tmp_path: Path
) -> None:
    out, whole = tmp_path / "cut", tmp_path / "whole"
    command = [
        sys.executable,
        "-m",
        "boatsim",
        "sweep",
        "joystick_boat/sway_1",
        "--vary",
        "fan_wind.speed=0:0.5:20",
    ]
    running = subprocess.Popen([*command, "--out", str(out), "--ray", cluster.address])
    journal = out / "journal.jsonl"
    while not journal.is_file() or journal.read_bytes().count(b"\n") < 4:
        assert running.poll() is None
        time.sleep(0.02)
    running.kill()
    running.wait()
    for folder in (out, whole):
        subprocess.run(
            [*command, "--out", str(folder), "--jobs", "1"], check=True, stdout=subprocess.DEVNULL
        )
    assert (out / "sweep.parquet").read_bytes() == (whole / "sweep.parquet").read_bytes()
