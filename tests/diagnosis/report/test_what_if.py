"""The section of a report that repeats free runs in the browser while sliders move."""

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import chrome
import numpy as np
import pytest
from typer.testing import CliRunner

import boatsim
from boatsim.cli import diagnosis as commands
from boatsim.cli.commands import app
from boatsim.diagnosis.filter_arguments import rigid_body_values
from boatsim.diagnosis.model_names import MODELS
from boatsim.diagnosis.output.files import write_diagnosis
from boatsim.diagnosis.output.what_if import collect_what_if
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.diagnosis.report.what_if import WhatIf, template_values, within_size
from boatsim.physics.kernel.records import VesselNumbers
from boatsim.webassembly.compiler import NoWasmCompiler, find_compiler
from boatsim.webassembly.packing import MOST_BYTES

PAGE = "document.querySelector('#what-if')"
BLOCKED = """
window.blocked = [];
addEventListener("securitypolicyviolation", e => blocked.push(e.violatedDirective + " " + e.blockedURI));
addEventListener("error", e => blocked.push(e.message));
addEventListener("unhandledrejection", e => blocked.push(String(e.reason)));
"""
RUNS = (
    f"{PAGE}.whatIf.runs.map(run => Object.fromEntries("
    "Object.entries(run.channels).map(([name, x]) => [name, [...x]])))"
)
ERRORS = f"[...{PAGE}.querySelectorAll('tbody tr')].map(row => row.cells[1].textContent)"
FRAMES_PER_SECOND = 30


@dataclass(frozen=True)
class Made:
    """A diagnosis of simulated recordings, its section and the folder of its files."""

    diagnosis: boatsim.Diagnosis
    what_if: WhatIf
    folder: Path

    @property
    def found(self) -> Diagnosis:
        return self.diagnosis.result

    @property
    def page(self) -> Path:
        return self.folder / "report.html"


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Made:
    try:
        compiler = find_compiler()
    except NoWasmCompiler as error:
        pytest.skip(str(error))
    folder = tmp_path_factory.mktemp("what_if")
    recordings = []
    for name in ("sway_1", "yaw_1", "yaw_3"):
        boatsim.run(f"joystick_boat/{name}_as_published", out=folder / name)
        recordings.append(folder / name / "camera.csv")
    diagnosis = boatsim.diagnose(recordings[:2], hold_out=recordings[2:])
    what_if = collect_what_if(diagnosis.result, compiler)
    assert what_if is not None
    write_diagnosis(diagnosis.result, folder / "out", what_if)
    return Made(diagnosis, what_if, folder / "out")


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    if chrome.PROGRAM is None:
        pytest.skip("there is no Chromium on this machine")
    with chrome.chromium() as opened:
        yield opened


def shown_page(browser: Any, path: Path) -> Any:
    page = browser(path.as_uri(), BLOCKED)
    page.until(f"{PAGE}.whatIf || blocked.length")
    return page


@pytest.fixture(scope="module")
def page(made: Made, browser: Any) -> Any:
    return shown_page(browser, made.page)


def click(page: Any, words: str) -> None:
    page.run(
        f"[...{PAGE}.querySelectorAll('button')].find(b => b.textContent === '{words}').click()"
    )
    page.run(f"{PAGE}.whatIf.update()")


@pytest.mark.slow
def test_free_runs_of_the_page_are_those_of_the_compiled_engine(made: Made, page: Any) -> None:
    click(page, "As found")
    of_engine = [run.channels["patched"] for run in made.found.findings.free_runs]
    of_page = page.run(RUNS)
    assert len(of_page) == len(of_engine) > 0
    for channels, wanted in zip(of_page, of_engine, strict=True):
        assert channels.keys() == wanted.keys()
        for name, x in wanted.items():
            assert np.abs(np.array(channels[name]) - x).max() < 1e-9, name


@pytest.mark.slow
def test_the_vessel_of_the_file_is_simulated_as_the_compiled_engine_does(
    made: Made, page: Any
) -> None:
    click(page, "As in the file")
    problem, mapped = made.found.problem, made.found.held_out[0]
    nominal = made.found.ranking.nominal
    values = problem.parameter_vector(mapped, nominal.free, np.ones(len(nominal.free)))
    out = np.full(
        (len(made.what_if.recordings[0].starts), len(mapped.times), 2 * made.what_if.nq), np.nan
    )
    on = problem.program.effect_switches()
    one = made.what_if.recordings[0]
    problem.program.estimation_functions.simulate_intervals(
        mapped.times_and_commands,
        made.what_if.max_step,
        VesselNumbers(rigid_body_values(values), values, on),
        np.array(one.starts),
        np.array(one.ends),
        one.states,
        out,
    )
    for j, channels in enumerate(page.run(RUNS)):
        rows = slice(one.starts[j], one.ends[j] + 1)
        for name, code in made.what_if.signals.items():
            assert np.abs(np.array(channels[name]) - out[j, rows, code]).max() < 1e-9, name


@pytest.mark.slow
def test_errors_as_found_are_those_of_the_diagnosis(made: Made, page: Any) -> None:
    click(page, "As found")
    fit = made.found.findings.answer["fit"]
    shown = dict(zip(("position", "heading"), page.run(ERRORS), strict=True))
    number, unit = shown["position"].split("\u00a0")
    metres = float(number) * {"mm": 1e-3, "cm": 1e-2, "m": 1.0}[unit]
    assert metres == pytest.approx(fit["position_rms_m"]["patched"], rel=0.01)
    degrees = float(shown["heading"].removesuffix("°"))
    assert degrees == pytest.approx(np.degrees(fit["heading_rms_rad"]["patched"]), rel=0.01)
    assert set(fit["position_rms_m"]) == set(MODELS)


@pytest.mark.slow
def test_one_click_takes_an_effect_away_and_a_slider_changes_the_error(page: Any) -> None:
    click(page, "As found")
    found = page.run(ERRORS)
    click(page, "Without weak reverse")
    without = page.run(ERRORS)
    assert found != without
    slider = f"[...{PAGE}.querySelectorAll('.found input[type=range]')].pop()"
    click(page, "As found")
    page.run(f"(s => {{ s.value = 900; s.dispatchEvent(new Event('input')); }})({slider})")
    page.until(f"{json.dumps(found)}.join() !== {ERRORS}.join()")
    # with the keys, as a slider of the browser: one step to the right
    click(page, "As found")
    page.run(f"{slider}.focus()")
    before = page.run(f"{slider}.value")
    for kind in ("keyDown", "keyUp"):
        page.say(
            "Input.dispatchKeyEvent",
            type=kind,
            key="ArrowRight",
            code="ArrowRight",
            windowsVirtualKeyCode=39,
        )
    page.until(f"{slider}.value === String({before} + 1)")


@pytest.mark.slow
def test_a_candidate_that_was_not_found_can_be_tried(page: Any) -> None:
    click(page, "As found")
    found = page.run(ERRORS)
    others = f"{PAGE}.querySelector('.others')"
    assert page.run(f"{others}.querySelectorAll('fieldset').length") > 10
    assert page.run(f"[...{others}.querySelectorAll('output')].every(o => o.textContent === 'off')")
    # of the wind, whose sliders move the boat
    wind = f"[...{others}.querySelectorAll('fieldset')].find(f => f.textContent.startsWith('wind'))"
    page.run(
        f"(s => {{ s.value = s.max; s.dispatchEvent(new Event('input')); }})({wind}.querySelector('input[type=range]'))"
    )
    page.run(f"{PAGE}.whatIf.update()")
    assert page.run(f"{wind}.querySelector('input[type=checkbox]').checked")
    assert page.run(ERRORS) != found


@pytest.mark.slow
def test_the_page_obeys_its_content_security_policy(made: Made, page: Any) -> None:
    assert page.run("blocked") == []
    text = made.page.read_text(encoding="utf-8")
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', text)
    assert policy
    assert re.fullmatch(
        "default-src 'none'; script-src 'sha256-[^']+' 'sha256-[^']+' 'wasm-unsafe-eval'; "
        "style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'",
        policy[1].replace("&#39;", "'"),
    )
    page.run(
        "document.body.append(Object.assign(document.createElement('script'), {textContent: 'window.ran = 1'}))"
    )
    assert page.run("window.ran") is None
    page.until("blocked.length === 1")
    page.run("blocked.length = 0")
    assert "http://" not in text.replace("http://www.w3.org/", "") and "src=" not in text


@pytest.mark.slow
def test_the_page_fits_a_phone_and_labels_its_controls(page: Any) -> None:
    for wide in (360, 390):
        page.resize(wide, 844, mobile=True)
        page.run(f"{PAGE}.querySelectorAll('details').forEach(d => d.open = true)")
        assert page.run("document.documentElement.scrollWidth") <= wide
        inside = f"[...{PAGE}.querySelectorAll('button, input, select, canvas, output')]"
        assert page.run(f"{inside}.every(e => e.getBoundingClientRect().right <= {wide})")
    controls = f"[...{PAGE}.querySelectorAll('input, select')]"
    assert page.run(
        f"{controls}.every(e => e.labels.length === 1 && e.labels[0].textContent.trim())"
    )
    assert page.run(
        f"[...{PAGE}.querySelectorAll('input[type=range]')].every(e => e.getAttribute('aria-valuetext'))"
    )


@pytest.mark.slow
def test_the_drawing_follows_the_colour_scheme(page: Any) -> None:
    def middle() -> list[int]:
        drawn = f"(c => [...c.getContext('2d').getImageData(0, 0, c.width, c.height).data])({PAGE}.querySelector('canvas'))"
        return list(page.run(drawn))

    found = []
    for scheme in ("light", "dark"):
        page.say(
            "Emulation.setEmulatedMedia",
            features=[{"name": "prefers-color-scheme", "value": scheme}],
        )
        page.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
        found.append(middle())
    assert found[0] != found[1]


@pytest.mark.slow
def test_a_minute_is_simulated_and_drawn_thirty_times_a_second(
    made: Made, browser: Any, tmp_path: Path
) -> None:
    one, rows = made.what_if.recordings[0], 601
    use = np.arange(rows) % len(one.commands)
    times = 0.1 * np.arange(rows)
    minute = replace(
        one,
        times=times,
        command_times=times,
        commands=one.commands[use],
        measured={name: np.sin(0.1 * times) for name in one.measured},
        starts=(0,),
        ends=(rows - 1,),
        states=one.states[:1],
    )
    write_diagnosis(made.found, tmp_path / "out", replace(made.what_if, recordings=(minute,)))
    page = shown_page(browser, tmp_path / "out" / "report.html")
    slider = f"[...{PAGE}.querySelectorAll('.found input[type=range]')].pop()"
    # the shortest of many, because other processes of the machine interrupt a browser
    shortest = page.run(
        f"(() => {{ const slider = {slider}; let least = Infinity; for (let i = 0; i < 100; i++) {{"
        "const begin = performance.now(); slider.value = 300 + i; slider.dispatchEvent(new Event('input'));"
        f"{PAGE}.whatIf.update(); least = Math.min(least, performance.now() - begin); }} return least; }})()"
    )
    page.close()
    assert shortest < 1000.0 / FRAMES_PER_SECOND


@pytest.mark.slow
def test_the_report_stays_below_one_megabyte_and_equal_results_give_equal_bytes(
    made: Made, tmp_path: Path
) -> None:
    assert made.page.stat().st_size < MOST_BYTES
    made.diagnosis.write(tmp_path / "again", what_if=True)
    assert (tmp_path / "again" / "report.html").read_bytes() == made.page.read_bytes()
    write_diagnosis(made.found, tmp_path / "plain")
    plain = (tmp_path / "plain" / "report.html").read_text(encoding="utf-8")
    assert "what-if" not in plain and "wasm" not in plain
    # recordings that are too long are shown in part, and the page says so
    random, one = np.random.default_rng(0), made.what_if.recordings[0]
    noisy = []
    for _ in range(150):  # noise, because copies would be compressed to nothing
        measured = {name: x + random.normal(0.0, 1e-3, len(x)) for name, x in one.measured.items()}
        noisy.append(replace(one, measured=measured))
    long = replace(made.what_if, recordings=tuple(noisy))
    write_diagnosis(made.found, tmp_path / "long", long)
    page = tmp_path / "long" / "report.html"
    assert 0.7 * MOST_BYTES < page.stat().st_size < MOST_BYTES
    assert "stays below 1 MB" in page.read_text(encoding="utf-8")


@pytest.mark.slow
def test_where_the_compiler_fails_on_a_vessel_the_other_files_are_written(
    made: Made, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise NoWasmCompiler("zig: this law is too long")

    monkeypatch.setattr(commands, "analyse", lambda *_, **__: made.found)
    monkeypatch.setattr(commands, "collect_what_if", fail)
    log = made.folder.parent / "yaw_1" / "camera.csv"
    given = ["diagnose", str(log), "--what-if", "--out", str(tmp_path / "out")]
    done = CliRunner().invoke(app, given)
    assert done.exit_code == 2 and "zig: this law is too long" in done.stderr
    assert (tmp_path / "out" / "patched.toml").is_file()
    assert "what-if" not in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")


@pytest.mark.slow
def test_a_recording_is_cut_at_the_end_of_a_free_run(made: Made) -> None:
    assert within_size(made.what_if, 1000) is None
    one = made.what_if.recordings[0]
    assert len(one.starts) > 1
    first = one.first_runs(1)
    assert len(first.times) == one.ends[0] + 1 and first.starts == one.starts[:1]
    assert first.command_times[-1] <= first.times[-1] < one.command_times[-1]
    shorter = replace(made.what_if, recordings=(first,))
    size = len(str(template_values(shorter, 1)["numbers"]))
    assert size < len(str(template_values(made.what_if, 1)["numbers"]))
