"""Values of a map that no measurement has."""

from pathlib import Path

import pytest

from boatsim.errors import BadInput
from boatsim.recordings.importing.convert import convert_log
from boatsim.recordings.importing.log import open_log
from boatsim.recordings.importing.mapping import read_map

MAP = """
vessel = "otter"
rate = 10.0
time = "t"
[columns]
psi_rad = "psi"
n_port_radps = {{ signal = "n", low = -1.0, neutral = 0.0, high = 1.0, least = {0}, most = {1} }}
"""


def converted(folder: Path, least: float, most: float) -> object:
    rows = "".join(f"{0.1 * i},{0.01 * i},{i % 3 - 1}\n" for i in range(60))
    (folder / "log.csv").write_text(f"t,psi,n\n{rows}")
    (folder / "map.toml").write_text(MAP.format(least, most))
    return convert_log(open_log(folder / "log.csv"), read_map(folder / "map.toml"), "map.toml")


def test_a_scale_of_a_command_is_not_larger_than_any_measurement(tmp_path: Path) -> None:
    assert converted(tmp_path, -1e6, 1e6)
    with pytest.raises(BadInput, match=r"map.toml: columns.n_port_radps = 1e\+308; no measurement"):
        converted(tmp_path, -1e308, 1e308)
