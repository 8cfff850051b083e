"""The rehearsal with strangers' logs: its boats obey mechanics, its files hold the truth, its owner
puts maps right."""

import ast
import re
from dataclasses import replace
from math import cos, sin
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from alike import long

from validation.owner_logs import boats, cases, faults
from validation.owner_logs.causes import CAUSES
from validation.owner_logs.commands import (
    add_to_notes,
    parse_findings,
    parse_limits,
    run_boatsim,
)
from validation.owner_logs.formats import earth
from validation.owner_logs.instruments import drive_names, record_voyage, sample_instruments
from validation.owner_logs.judge import LIMITS, Result
from validation.owner_logs.owner import Line, correct_lines, correct_map
from validation.owner_logs.pilot import pilot
from validation.owner_logs.plant import (
    Plant,
    State,
    Surroundings,
    runge_kutta_step,
    state_derivative,
)
from validation.owner_logs.sail import Linkage, simulate_voyage
from validation.owner_logs.table import goal_rows

FOLDER = Path(faults.__file__).parent
JUDGES = {"judge.py", "commands.py", "table.py", "__main__.py"}
STILL = (0.0, 0.0, 0.0)


def bare(boat: boats.Boat) -> Plant:
    """The boat without any force of the water but its inertia."""
    hull = replace(boat.plant.hull, wetted=0.0, section=0.0, lift=0.0, turning=0.0)
    return replace(boat.plant, hull=hull, rudder=None)


def test_the_simulator_imports_nothing_of_the_program_that_it_examines() -> None:
    for file in (f for f in FOLDER.rglob("*.py") if f.name not in JUDGES):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            found = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            found += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            assert not [n for n in found if n.split(".")[0] == "boatsim"], file


@pytest.mark.parametrize("kind", boats.KINDS)
def test_a_hull_in_ideal_water_keeps_its_energy(kind) -> None:  # type: ignore[no-untyped-def]
    boat = kind(np.random.default_rng(5))
    plant = replace(
        bare(boat), around=Surroundings(load=0.2 * boat.plant.hull.mass, load_at=0.2 * boat.length)
    )
    mx, my, mz, myz = plant.masses()
    s: State = (0.0, 0.0, 0.3, 1.5, 0.4, 0.3)

    def energy(s: State) -> float:
        _, _, _, u, v, r = s
        return 0.5 * (mx * u * u + my * v * v + mz * r * r) + myz * v * r

    begin, still = energy(s), (0.0,) * len(plant.propellers)
    for _ in range(500):
        s = runge_kutta_step(plant, s, still, 0.0, 0.02, STILL)
    assert energy(s) == pytest.approx(begin, rel=1e-6)
    assert abs(s[2] - 0.3) > 0.5


@pytest.mark.parametrize("kind", boats.KINDS)
def test_a_hull_in_ideal_water_keeps_its_impulse(kind) -> None:  # type: ignore[no-untyped-def]
    plant = bare(kind(np.random.default_rng(6)))
    mx, my, _, myz = plant.masses()
    s: State = (0.0, 0.0, 0.3, 1.5, 0.4, 0.3)

    def impulse(s: State) -> tuple[float, float]:
        _, _, psi, u, v, r = s
        pu, pv = mx * u, my * v + myz * r
        return pu * cos(psi) - pv * sin(psi), pu * sin(psi) + pv * cos(psi)

    begin = impulse(s)
    for _ in range(500):
        s = runge_kutta_step(plant, s, (0.0,) * len(plant.propellers), 0.0, 0.02, STILL)
    assert impulse(s) == pytest.approx(begin, rel=1e-6)


def test_a_current_only_carries() -> None:
    boat = boats.launch(np.random.default_rng(1))
    s: State = (0.0, 0.0, 0.4, 1.2, 0.2, 0.1)
    carried = state_derivative(
        replace(boat.plant, around=Surroundings(current=(0.3, -0.2))), s, (0.6,), 0.2, STILL
    )
    still = state_derivative(boat.plant, s, (0.6,), 0.2, STILL)
    assert carried[2:] == still[2:]
    assert (carried[0] - still[0], carried[1] - still[1]) == pytest.approx((0.3, -0.2))


@pytest.mark.parametrize("kind", boats.KINDS)
def test_helm_to_starboard_turns_to_starboard_and_full_ahead_reaches_the_top_speed(kind) -> None:  # type: ignore[no-untyped-def]
    boat = kind(np.random.default_rng(2))
    fixed, both = not boat.helm_most, len(boat.plant.propellers)
    s: State = (0.0,) * 6
    for _ in range(10_000):
        s = runge_kutta_step(boat.plant, s, (1.0,) * both, 0.0, 0.02, STILL)
    assert s[3] == pytest.approx(boats.top_speed(boat.plant), rel=0.05)
    revs = (0.8, 0.4) if fixed else (0.6,) * both
    for _ in range(400):
        s = runge_kutta_step(boat.plant, s, revs, boat.helm_most, 0.02, STILL)
    assert s[5] > 0.02


def example(boat: boats.Boat, form: str, number: int = 1, lasts: float = 30.0) -> cases.Case:
    return cases.Case(number, "good", boat, form, "", "", "", (lasts, lasts), 4)


FORMS = ["csv", "parquet", "BIN", "mcap", "ros1", "ros2", "ulog", "nmea"]
KINDS = [boats.workboat, boats.survey_catamaran, boats.launch]


def forms_and_kinds() -> list[Any]:
    """All pairs of a form and a kind; those beyond one kind for each form are long tests."""
    pairs: list[Any] = []
    for i, form in enumerate(FORMS):
        for j, kind in enumerate(KINDS):
            if i % len(KINDS) == j:
                pairs.append((form, kind))
            else:
                pairs.append(long(form, kind))
    return pairs


@pytest.mark.parametrize(("form", "kind"), forms_and_kinds())
def test_what_was_written_is_what_a_recording_holds(form: str, kind, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    boat = kind(np.random.default_rng(3))
    rng = np.random.default_rng(7)
    on = replace(
        sample_instruments(boat, rng),
        fix_sd=0.0,
        compass_sd=0.0,
        gyro_sd=0.0,
        gyro_bias=0.0,
        antenna=0.0,
    )
    voyage = simulate_voyage(boat, Linkage(gains=(1.0, 1.0)), pilot(boat, rng, 40.0), 40.0, rng)
    seen = record_voyage(boat, voyage, on, rng)
    log = cases.write(example(boat, form), boat, seen, None, tmp_path, "log")
    assert run_boatsim("new", tmp_path / "boat", *boat.options).code == 0
    proposed = run_boatsim(
        "import", log.path, "--vessel", tmp_path / "boat", "--propose", tmp_path / "map.toml"
    )
    assert proposed.code == 0, proposed.err
    text, _ = correct_map(
        (tmp_path / "map.toml").read_text(),
        correct_lines(boat, tmp_path / "boat" / "vessel.toml", log.orders),
    )
    (tmp_path / "map.toml").write_text(text)
    made = run_boatsim(
        "import", log.path, "--map", tmp_path / "map.toml", "--out", tmp_path / "run.csv"
    )
    assert made.code == 0, made.err
    rows = np.genfromtxt(tmp_path / "run.csv", delimiter=",", names=True)
    for column, i in (("x_m", 0), ("y_m", 1), ("psi_rad", 2)):
        there = np.isfinite(rows[column])
        truth = np.interp(rows["t_s"][there], voyage.t, voyage.states[:, i])
        off = rows[column][there] - truth
        off = np.remainder(off + np.pi, 2 * np.pi) - np.pi if i == 2 else off - np.median(off)
        assert np.abs(off).max() < (0.03 if i == 2 else 0.35), (
            column
        )  # a few tenths of a second at most
    first = rows[boat.channels[0]]
    astern = voyage.throttles[:, 0] < 0.0
    assert np.sign(first[first != 0.0]).min() == (-1.0 if astern.any() else 1.0)
    held = earth.last_values(voyage.t, voyage.throttles[:, 0], rows["t_s"])
    same = np.sign(held) == np.sign(first)
    assert same.mean() > 0.97


def test_a_seed_makes_the_same_bytes(tmp_path: Path) -> None:
    made = []
    for name in ("a", "b"):
        case = replace(cases.cases(4, 9)[5], lasts=(20.0, 20.0))
        (tmp_path / name).mkdir()
        logs, _ = cases.make(case, tmp_path / name)
        made.append(logs.first.path.read_bytes())
    assert made[0] == made[1]


@pytest.mark.parametrize("seed", range(1, 6))
def test_a_third_of_the_logs_is_good_and_what_is_wrong_fits_the_boat(seed: int) -> None:
    found = cases.cases(seed, 36)
    assert sum(c.kind == "good" for c in found) == 12
    assert len({c.boat.name for c in found}) == 3
    assert len({c.form.replace("plain.", "").replace("ros1", "ros2") for c in found}) == 7
    for c in found:
        assert bool(c.fault) == (c.kind in ("fault", "both")) and bool(c.cause) == (
            c.kind in ("cause", "both")
        )
        assert (
            not c.wrong
            or c.wrong.fits(c.boat)
            and (not c.wrong.formats or c.form in c.wrong.formats)
        )
        assert not c.cause or CAUSES[c.cause].fits(c.boat)


@pytest.mark.slow
def test_every_name_that_counts_for_a_cause_is_an_entry_of_the_library() -> None:
    said = run_boatsim("list")
    known = {line.split()[0] for line in said.out.splitlines() if line.startswith("  ")}
    assert not {n for c in CAUSES.values() for n in c.named} - known


def test_the_owner_puts_in_what_is_absent_and_turns_a_sign(tmp_path: Path) -> None:
    boat = boats.workboat(np.random.default_rng(3))
    assert run_boatsim("new", tmp_path / "boat", *boat.options).code == 0
    scales = {
        n: cases.ardupilot.Scale(f"RCOU.C{i}", 1100, 1500, 1900)
        for i, n in enumerate(("helm", *drive_names(boat)), 1)
    }
    lines = correct_lines(boat, tmp_path / "boat" / "vessel.toml", scales)
    flipped = f'{boat.helms[0]} = {{ signal = "RCOU.C1", low = 1100, neutral = 1500, high = 1900, least = -0.7, most = 0.7 }}'
    text, edits = correct_map(
        f'# commands: what was sent to the drives\n{flipped}\n# {boat.channels[0]} = "..."\n', lines
    )
    assert edits == [f"absent {c}" for c in boat.channels] + [
        f"sign {boat.helms[0]}",
        f"absent {boat.helms[1]}",
    ]
    assert all(line.text in text.splitlines() for line in lines)


def test_the_owner_who_corrects_full_scale_keeps_the_square_of_the_revolutions() -> None:
    line = Line(
        "thrust_N",
        'thrust_N = { signal = "RPM", low = -5200, neutral = 0, high = 5200, '
        "least = -400, most = 700 }",
        "RPM",
        -400.0,
        700.0,
        -5200.0,
        5200.0,
    )
    proposed = line.text.replace("5200", "4288").replace(" }", ", exponent = 2 }")
    text, edits = correct_map(proposed, [line])
    assert edits == ["scale thrust_N"]
    assert text == line.text.replace(" }", ", exponent = 2 }")


def test_advice_goes_into_a_recording_toml_beside_what_is_there(tmp_path: Path) -> None:
    file = tmp_path / "recording.toml"
    file.write_text('[runs.run]\nvessel = "../boat"\n[runs.run.facts]\nposition_fix = "gnss"\n')
    add_to_notes(file, ["use = [0, 12.5]", "[columns]", 'psi_rad = "-psi_rad + 90 * deg"'])
    assert file.read_text() == (
        'use = [0, 12.5]\n[runs.run]\nvessel = "../boat"\n[runs.run.facts]\nposition_fix = "gnss"\n'
        '[columns]\npsi_rad = "-psi_rad + 90 * deg"\n'
    )


def test_findings_are_read_from_what_check_prints() -> None:
    from validation.owner_logs.commands import CommandResult

    text = (
        "run.csv: probably your log, not your boat\n"
        "  heading in degrees (probability 99 %): psi_rad goes from 1 to 300\n"
        '    write into recording.toml: [columns] / psi_rad = "psi_rad * deg"\n'
    )
    found = parse_findings(CommandResult(1, text, "", 0.0))
    assert [(f.name, f.sure, f.lines) for f in found] == [
        ("heading_in_degrees", 0.99, ("[columns]", 'psi_rad = "psi_rad * deg"'))
    ]


@pytest.mark.slow
def test_what_a_log_cannot_tell_is_read_from_what_check_prints(tmp_path: Path) -> None:
    boat = boats.launch(np.random.default_rng(4))
    assert run_boatsim("new", tmp_path / "boat", *boat.options).code == 0
    t = np.arange(0.0, 60.0, 0.2)
    still = np.zeros_like(t)
    thrust = np.where(np.remainder(t, 20.0) < 10.0, 0.5, 0.3) * boat.stated[0]
    columns = {"t_s": t, "x_m": 1.5 * t, "y_m": still, "psi_rad": still}
    columns |= dict.fromkeys(boat.channels, thrust) | dict.fromkeys(boat.helms, still)
    np.savetxt(
        tmp_path / "run.csv",
        np.column_stack(list(columns.values())),
        "%.6g",
        ",",
        header=",".join(columns),
        comments="",
    )
    (tmp_path / "recording.toml").write_text('vessel = "./boat"\n')
    checked = run_boatsim("check", tmp_path / "run.csv")
    assert checked.code in (0, 1), checked.err
    limits = parse_limits(checked)
    assert [text for text in limits if re.search(LIMITS["never_turned"], text)]


def test_the_goals_count_what_they_ask_for() -> None:
    good = Result(
        1, "good", "launch", "csv", "", "", "", read=True, verdict="nothing_missing", possible=True
    )
    good.nominal_m, good.answer_m = 2.0, 0.9
    both = Result(
        2,
        "both",
        "launch",
        "nmea",
        "time in ms",
        "wind",
        "",
        read=True,
        edits=["absent rudder_rad"],
    )
    both.fault_named, both.physics_named, both.called_physics = True, False, False
    both.first_named = False
    rows = {row[:58].strip(): row[58:].split() for row in goal_rows([good, both])}
    assert rows["log read, or its need stated in one line"][:2] == ["2", "(100"]
    assert rows["map of the commands proposed whole and right"][:2] == ["1", "(50"]
    assert rows["the log's fault named"][:2] == ["1", "(100"]
    assert rows["the physics named, or refined in the vessel file"][:2] == ["0", "(0"]
    assert rows["the cause is the first name"][:2] == ["0", "(0"]
    assert rows["good logs accused"][:2] == ["0", "(0"]
    assert rows["second log predicted with at most half the error"][:2] == ["1", "(100"]
