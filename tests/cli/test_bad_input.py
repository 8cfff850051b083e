"""Whatever the files say: exit code 0 and whole output, or exit code 2, one line that names the
file, and no output."""

import json
import math
import random
from collections.abc import Callable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest
import typer
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from hypothesis.errors import InvalidArgument
from typer.testing import CliRunner

from boatsim.cli import app
from boatsim.cli.commands import COMMAND_GROUPS
from boatsim.errors import unknown_name_message
from boatsim.physics.content import content_root

DIAGNOSIS = {"diagnosis.json", "report.html", "report.md", "patched.toml", "diagnosis.rrd"}
WRITTEN = {
    "diagnose": DIAGNOSIS,
    "replay": {"replay.csv"},
    "compare": {"compare.csv", "compare.rrd"},
    "run": {
        "recording.csv",
        "camera.csv",
        "recording.toml",
        "norms.json",
        "run.rrd",
        "report.html",
    },
}
COMMON = {
    "deadline": None,
    "derandomize": True,
    "suppress_health_check": list(HealthCheck),
    "database": None,
}
quick, few = settings(max_examples=60, **COMMON), settings(max_examples=25, **COMMON)  # type: ignore[arg-type]

Table = tuple[list[str], list[list[str]]]  # header, rows


# A decay in roll and a boat on the water: small files that are right
# ------------------------------------------------


def decay(rows: int = 75) -> Table:
    rng = np.random.default_rng(0)
    t = 0.2 * np.arange(rows)
    phi = 0.15 * np.exp(-0.03 * t) * np.cos(2.46 * t) + 1e-4 * rng.standard_normal(rows)
    return ["t_s", "phi_rad"], [[f"{a:.3f}", f"{b:.6f}"] for a, b in zip(t, phi, strict=True)]


def cruise(rows: int = 60) -> Table:
    """A boat at half a metre a second; it need not make sense, only be possible."""
    t = np.arange(rows) / 6.0
    columns = [
        t,
        0.5 * t,
        0.02 * np.sin(t),
        0.1 * np.sin(t),
        0 * t + 1.0,
        0 * t + 0.9,
        0.1 * np.cos(t),
        0 * t,
    ]
    header = "t_s x_m y_m psi_rad thrust_port_N thrust_starboard_N steer_port_rad steer_starboard_rad".split()
    return header, [[f"{x:.6f}" for x in row] for row in zip(*columns, strict=True)]


def csv_text(table: Table) -> str:
    return "".join(",".join(cells) + "\n" for cells in (table[0], *table[1]))


NOTES = """
vessel = "kvlcc2_roll"
load = []
scale = 68.0
use = [0.0, 100.0]
[columns]
phi_rad = "phi_rad"
[noise]
roll_sd_rad = 1e-4
[ambient]
axes = ["roll"]
force_rms = [0.2]
time_constant_s = 1.0
[coefficient_uncertainty]
damping = 1.0
[facts]
forward_speed_mps = 0.0
walls_m = [-5.0, 5.0, -5.0, 5.0]
[set.linear_damping]
roll = 6.7
[runs.run]
use = [0.2, 14.8]
"""
SCENARIO = """
about = "Half a second to starboard."
vessel = "joystick_boat"
load = ["light", "narrow"]
duration = 0.5
step = 0.01
seed = 1
[start]
x_m = 1.0
psi_rad = 0.1
[tank]
length = 3.6
[controller]
use = "l1_joystick"
[[goal]]
t = 0.0
sway_mps = 0.07
[[effect]]
use = "weak_reverse"
astern_factor = 0.694
[[check]]
signal = "v_mps"
norm = "inf"
below = 1.0
"""


# What may be wrong with them
# ----------------------------------------------------------------------------------------

CELLS = [
    "",
    " ",
    "nan",
    "inf",
    "-inf",
    "1e400",
    "1e300",
    "-1e9",
    "abc",
    "1_000",
    "0x10",
    "1,5",
    '"1',
    "١",
    "9" * 400,
]
NAMES = [
    "t_s",
    "phi_rad",
    "psi_rad",
    "phi_deg",
    "x_m",
    "p_radps",
    "",
    '"',
    "phi rad",
    "a,b",
    "φ_rad",
    "thrust_port_N",
]


def at(draw: Any, rows: list[list[str]]) -> list[str]:
    return rows[draw(st.integers(0, len(rows) - 1))]


def column(draw: Any, table: Table) -> int:
    return int(draw(st.integers(0, len(table[0]) - 1)))


def a_cell(draw: Any, table: Table) -> None:
    at(draw, table[1])[column(draw, table)] = draw(st.sampled_from(CELLS) | st.text(max_size=5))


def a_column_scaled(draw: Any, table: Table) -> None:
    j, factor = column(draw, table), draw(st.sampled_from([57.3, 1e3, 1e6, 1e15, -1.0, 0.0, 1e-9]))
    for row in table[1]:
        row[j] = f"{float(row[j]) * factor:.6g}"


def a_column_shifted(draw: Any, table: Table) -> None:
    j, by = column(draw, table), draw(st.sampled_from([1.7e9, -1e3, 1e12, 6.2831853]))
    for row in table[1]:
        row[j] = f"{float(row[j]) + by:.3f}"


def a_column_less(draw: Any, table: Table) -> None:
    j = column(draw, table)
    for row in (table[0], *table[1]):
        del row[j]


def a_column_twice(draw: Any, table: Table) -> None:
    j = column(draw, table)
    for row in (table[0], *table[1]):
        row.append(row[j])


def a_name(draw: Any, table: Table) -> None:
    table[0][column(draw, table)] = draw(st.sampled_from(NAMES) | st.text(max_size=5))


def rows_swapped(draw: Any, table: Table) -> None:
    i, j = (draw(st.integers(0, len(table[1]) - 1)) for _ in range(2))
    table[1][i], table[1][j] = table[1][j], table[1][i]


def a_row_twice(draw: Any, table: Table) -> None:
    i = draw(st.integers(0, len(table[1]) - 1))
    table[1].insert(i, list(table[1][i]))


def a_row_ragged(draw: Any, table: Table) -> None:
    at(draw, table[1]).append("1.0") if draw(st.booleans()) else at(draw, table[1]).pop()


def few_rows(draw: Any, table: Table) -> None:
    del table[1][draw(st.integers(0, 25)) :]


def rows_missing(draw: Any, table: Table) -> None:
    i = draw(st.integers(1, len(table[1]) - 2))
    del table[1][i : i + draw(st.integers(1, 40))]


def a_constant(draw: Any, table: Table) -> None:
    j = column(draw, table)
    for row in table[1]:
        row[j] = "0.1"


TABLES: list[Callable[[Any, Table], None]] = [
    a_cell,
    a_column_scaled,
    a_column_shifted,
    a_column_less,
    a_column_twice,
    a_name,
    rows_swapped,
    a_row_twice,
    a_row_ragged,
    few_rows,
    rows_missing,
    a_constant,
]
TEXTS: list[Callable[[str], bytes]] = [
    lambda text: text.encode(),
    lambda text: b"\xef\xbb\xbf" + text.encode(),
    lambda text: text.replace("\n", "\r\n").encode(),
    lambda text: text.replace("\n", "\r").encode(),
    lambda text: text.replace("\n", "\n\n").encode(),
    lambda text: text.replace(",", ";").encode(),
    lambda text: text.replace(",", "\t").encode(),
    lambda text: text.replace(",", " ").encode(),
    lambda text: text.replace(".", ",").replace(",", ";", 1).encode(),
    lambda text: text.replace(",", '","').replace("\n", '"\n"').encode(),
    lambda text: b"# made by hand\n" + text.encode(),
    lambda text: text.encode("utf-16"),
    lambda text: text[: len(text) // 2].encode(),
    lambda text: text.replace("\n", "\0\n").encode(),
    lambda text: text[: text.index("\n")].encode(),
    lambda text: random.Random(len(text)).randbytes(500),
    lambda text: b"",
]


@st.composite
def recordings(draw: Any, right: Table) -> bytes:
    """A recording with one or two mistakes in its table, and perhaps one in how it is written."""
    table = (list(right[0]), [list(row) for row in right[1]])
    for wrong in draw(st.lists(st.sampled_from(TABLES), min_size=0, max_size=2)):
        try:
            wrong(draw, table)
        except (ValueError, IndexError, InvalidArgument):  # nothing left to spoil
            break
    return bytes(draw(st.one_of(st.just(TEXTS[0]), st.sampled_from(TEXTS)))(csv_text(table)))


ODD = [
    "-1",
    "0",
    "0.5",
    "1e400",
    "nan",
    "-inf",
    "true",
    '"x"',
    '""',
    "[]",
    "[1, 2]",
    '["x"]',
    "{}",
    "{ a = 1 }",
]
ODD += [
    "1" + 400 * "0",
    "1979-05-27",
    "'''\n'''",
    "1e308",
    "[[1]]",
    "[nan, 1.0]",
    "= 2",
    "[1.0, 1e30]",
]


@st.composite
def tomls(draw: Any, right: str, end: str = "\0", kept: tuple[str, ...] = ()) -> bytes:
    """A TOML file with one mistake; it is cut off only before `end`, and lines that begin with a
    `kept` word stay."""
    lines = right.split("\n")
    settable = [
        i
        for i, line in enumerate(lines)
        if " = " in line and not line.startswith(("#", " ", *kept))
    ]
    i = draw(st.sampled_from(settable))
    key, _, value = lines[i].partition(" = ")
    way = draw(st.integers(0, 8))
    if way <= 3:
        lines[i] = f"{key} = {draw(st.sampled_from(ODD))}"
    elif way == 4:
        lines[i] = (
            f"{draw(st.sampled_from([key + 's', key[:-1] or 'q', '1', 'a.b', 'ü']))} = {value}"
        )
    elif way == 5:
        del lines[i]
    elif way == 6:
        lines.insert(
            i, draw(st.sampled_from([lines[i], "q = 1", "[q]", "[", "\x07", "é", "[[q]]\na = 1"]))
        )
    elif way == 7:
        cut = draw(st.integers(0, right.find(end) % (len(right) + 1)))
        return right[:cut].encode()
    else:
        return draw(st.binary(max_size=40)) + right.encode()
    return "\n".join(lines).encode()


# The law
# -------------------------------------------------------------------------------------------------------------


def assert_used_or_refused(
    out: Path, files: tuple[str, ...], command: str, *arguments: object
) -> Any:
    """Run a command; check that it succeeds or refuses with one line that names one of `files`."""
    given = [command, *(str(a) for a in arguments), "--out", str(out)]
    result = CliRunner().invoke(app, given, catch_exceptions=False)
    left = {f.name for f in out.rglob("*")} if out.exists() else set()
    said = [
        line for line in result.stderr.splitlines() if not line.startswith(("note: ", "progress: "))
    ]
    if result.exit_code == 2:
        assert len(said) == 1 and said[0].startswith("boatsim: "), result.stderr
        assert any(name in said[0] for name in files), said[0]
        assert not left and not result.stdout, (left, result.stdout)
        return said[0]
    assert result.exit_code in ((0, 1) if command == "run" else (0,)) and not said, result.stderr
    assert WRITTEN[command] <= left <= WRITTEN[command] | {"next.toml"}
    assert all((out / name).stat().st_size for name in left) and "nan" not in result.stdout, (
        result.stdout
    )
    if command == "diagnose":
        strict_json(out / "diagnosis.json")
    return None


def strict_json(path: Path) -> None:
    """JSON without the NaN that Python writes and others do not read."""

    def refuse(word: str) -> float:
        raise AssertionError(f"{path.name}: {word}")

    json.loads(path.read_text(encoding="utf-8"), parse_constant=refuse)


@pytest.fixture(scope="module")
def place() -> Iterator[Callable[..., Path]]:
    """A new folder with these files in it."""
    with TemporaryDirectory() as base:
        made = iter(range(10**6))

        def new(**files: bytes | str) -> Path:
            folder = Path(base) / f"{next(made)}"
            folder.mkdir()
            for name, content in files.items():
                path = folder / name.replace("__", ".")
                path.write_bytes(content.encode() if isinstance(content, str) else content)
            return folder

        yield new


# ---- recordings


@pytest.mark.slow
@pytest.mark.parametrize("command", ["diagnose", "replay", "compare"])
def test_a_recording_that_is_right_is_used(command: str, place: Callable[..., Path]) -> None:
    folder = place(run__csv=csv_text(decay()), recording__toml=NOTES)
    short = ["--horizon", "3"] if command == "replay" else []
    assert (
        assert_used_or_refused(folder / "out", ("run.csv",), command, folder / "run.csv", *short)
        is None
    )


@few
@given(content=recordings(decay()))
@pytest.mark.slow
def test_a_diagnosis_uses_a_recording_or_says_why_not(
    content: bytes, place: Callable[..., Path]
) -> None:
    folder = place(run__csv=content)
    assert_used_or_refused(
        folder / "out", ("run.csv",), "diagnose", folder / "run.csv", "--vessel", "kvlcc2_roll"
    )


@quick
@given(content=recordings(decay()), command=st.sampled_from(["replay", "compare"]))
@pytest.mark.slow
def test_a_replay_uses_a_recording_or_says_why_not(
    content: bytes, command: str, place: Callable[..., Path]
) -> None:
    folder = place(run__csv=content)
    short = ["--horizon", "3"] if command == "replay" else []
    assert_used_or_refused(
        folder / "out", ("run.csv",), command, folder / "run.csv", "--vessel", "kvlcc2_roll", *short
    )


@pytest.mark.slow
@few
@given(content=recordings(cruise()))
def test_a_recording_with_commands_is_used_or_the_line_says_why_not(
    content: bytes, place: Callable[..., Path]
) -> None:
    folder = place(run__csv=content)
    assert_used_or_refused(
        folder / "out",
        ("run.csv",),
        "replay",
        folder / "run.csv",
        "--vessel",
        "trial_boat",
        "--horizon",
        "2",
    )


@pytest.mark.parametrize("command", ["diagnose", "replay", "compare"])
@pytest.mark.parametrize("what", ["folder", "nothing", "parquet", "rrd"])
def test_what_is_no_recording_is_refused(
    command: str, what: str, place: Callable[..., Path]
) -> None:
    folder = place(bad__parquet=b"PAR1 no", bad__rrd=b"RRF2 no")
    (folder / "run.csv").mkdir()
    name = {"folder": "run.csv", "nothing": "other.csv"}.get(what, f"bad.{what}")
    assert assert_used_or_refused(
        folder / "out", (name,), command, folder / name, "--vessel", "kvlcc2_roll"
    )


def test_a_command_beyond_its_limits_is_refused_with_row_and_column(
    place: Callable[..., Path],
) -> None:
    header, rows = cruise()
    rows[30][header.index("steer_port_rad")] = "9.9"
    folder = place(run__csv=csv_text((header, rows)))
    line = assert_used_or_refused(
        folder / "out", ("run.csv",), "diagnose", folder / "run.csv", "--vessel", "trial_boat"
    )
    assert "row 32" in line and "steer_port_rad" in line and "9.9 rad" in line


# ---- notes, vessels, scenarios


@quick
@given(content=tomls(NOTES))
@example(content=NOTES.replace("force_rms = [0.2]", "force_rms = [0.0]").encode())
@example(content=NOTES.replace("roll_sd_rad = 1e-4", "roll_sd_rad = 0.0").encode())
@pytest.mark.slow
def test_notes_beside_a_recording_are_used_or_the_line_says_why_not(
    content: bytes, place: Callable[..., Path]
) -> None:
    folder = place(run__csv=csv_text(decay()), recording__toml=content)
    assert_used_or_refused(
        folder / "out",
        ("recording.toml", "run.csv"),
        "replay",
        folder / "run.csv",
        "--horizon",
        "3",
    )


@few
@given(content=tomls(NOTES))
@pytest.mark.slow
def test_a_diagnosis_uses_notes_or_says_why_not(content: bytes, place: Callable[..., Path]) -> None:
    folder = place(run__csv=csv_text(decay()), recording__toml=content)
    assert_used_or_refused(
        folder / "out", ("recording.toml", "run.csv"), "diagnose", folder / "run.csv"
    )


ROLLER = (content_root() / "models" / "kvlcc2_roll" / "vessel.toml").read_text(encoding="utf-8")
HULL = (content_root() / "models" / "kvlcc2_roll" / "hull.xml").read_bytes()


@pytest.mark.slow
@quick
@given(content=tomls(ROLLER, "[body]", ("suspects", "use")))
@example(content=ROLLER.replace("draught", 'hull = "x"\ndraught', 1).encode())
def test_a_vessel_file_is_used_or_the_line_says_why_not(
    content: bytes, place: Callable[..., Path]
) -> None:
    folder = place(run__csv=csv_text(decay()), vessel__toml=content, hull__xml=HULL)
    found = "vessel.toml", "run.csv", "hull.xml"
    assert_used_or_refused(
        folder / "out", found, "compare", folder / "run.csv", "--vessel", folder / "vessel.toml"
    )


PATCHED = 'based_on = "kvlcc2_roll"\n' + ROLLER.replace(
    "[diagnosis]", '[[effect]]\nuse = "quadratic_damping"\nroll = 30.0\n\n[diagnosis]'
)


@pytest.mark.slow
@quick
@given(content=tomls(PATCHED, "[body]", ("suspects", "use")))
def test_a_patched_file_is_used_or_the_line_says_why_not(
    content: bytes, place: Callable[..., Path]
) -> None:
    folder = place(run__csv=csv_text(decay()), patched__toml=content)
    given = folder / "run.csv", "--vessel", folder / "patched.toml", "--horizon", "3"
    assert_used_or_refused(folder / "out", ("patched.toml", "run.csv"), "replay", *given)


@few
@given(content=tomls(SCENARIO, "[controller]", ("use",)))
def test_a_scenario_is_run_or_the_line_says_why_not(
    content: bytes, place: Callable[..., Path]
) -> None:
    folder = place(next__toml=content)
    assert_used_or_refused(folder / "out", ("next",), "run", folder / "next.toml")


# ---- the command line


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["run"], "'SCENARIO'"),
        (["run", "--jobs", "0", "x"], "'--jobs'"),
        (["nothing"], "'nothing'"),
        (["diagnos", "x.csv"], "'diagnose'"),
        (["list", "boats"], "'vessels'"),
        (["replay"], "'RUN'"),
        (["replay", "a.csv", "--horizon", "long"], "'--horizon'"),
        (["diagnose", "a.csv", "--vesel", "x"], "--vessel"),
        (["--nothing"], "--nothing"),
    ],
)
def test_wrong_usage_is_one_line(arguments: list[str], said: str) -> None:
    result = CliRunner().invoke(app, arguments, catch_exceptions=False)
    assert result.exit_code == 2 and not result.stdout
    assert (
        result.stderr.count("\n") == 1
        and result.stderr.startswith("boatsim: ")
        and said in result.stderr
    )


def test_no_arguments_ask_for_help() -> None:
    assert "diagnose" in CliRunner().invoke(app, []).stdout


def test_help_has_every_command_once_with_its_whole_first_sentence() -> None:
    text = " ".join(CliRunner().invoke(app, ["--help"]).stdout.split())
    listed = [name for names in COMMAND_GROUPS.values() for name in names]
    commands = typer.main.get_command(app).commands
    assert sorted(listed) == sorted(commands)
    for command in commands.values():
        assert " ".join(command.help.partition("\n\n")[0].split()) in text


@pytest.mark.parametrize(
    "word, meant", [("simulate", "run"), ("daignose", "diagnose"), ("convert", "import")]
)
def test_a_command_that_does_not_exist_is_answered_by_the_one_that_is_meant(
    word: str, meant: str
) -> None:
    result = CliRunner().invoke(app, [word], catch_exceptions=False)
    assert result.exit_code == 2
    assert result.stderr.strip() == (
        f"boatsim: command '{word}' does not exist; did you mean '{meant}'? See boatsim --help"
    )


def test_a_word_of_users_is_answered_by_the_name() -> None:
    assert "did you mean 'psi_rad'?" in unknown_name_message(
        "key", "heading", ["psi_rad", "sway_mps"]
    )


@pytest.mark.parametrize(
    "load", [["--load", "heavy", "--load", "light"], ["--load", "narrow,wide"]]
)
def test_loads_that_contradict_each_other_are_refused(
    load: list[str], place: Callable[..., Path]
) -> None:
    folder = place(run__csv=csv_text(cruise()))
    given = folder / "run.csv", "--vessel", "joystick_boat", *load
    line = assert_used_or_refused(folder / "out", ("vessel.toml",), "replay", *given)
    assert all(name in line for name in ",".join(load[1::2]).split(","))


@pytest.mark.parametrize("horizon", ["0.1", "1e9", "nan", "inf"])
def test_any_horizon_is_used_or_refused(horizon: str, place: Callable[..., Path]) -> None:
    folder = place(run__csv=csv_text(decay()))
    given = folder / "run.csv", "--vessel", "kvlcc2_roll", "--horizon", horizon
    assert (
        assert_used_or_refused(folder / "out", ("run.csv", "--horizon"), "replay", *given) is None
    ) == math.isclose(float(horizon), 0.1)


@pytest.mark.parametrize("command", ["diagnose", "replay", "compare"])
def test_a_file_where_the_folder_should_be_is_left_alone(
    command: str, place: Callable[..., Path]
) -> None:
    folder = place(run__csv=csv_text(decay()), out="mine")
    given = [
        command,
        str(folder / "run.csv"),
        "--vessel",
        "kvlcc2_roll",
        "--out",
        str(folder / "out"),
    ]
    result = CliRunner().invoke(app, given, catch_exceptions=False)
    assert result.exit_code == 2 and (folder / "out").read_text() == "mine"
    assert [line for line in result.stderr.splitlines() if str(folder / "out") in line]
