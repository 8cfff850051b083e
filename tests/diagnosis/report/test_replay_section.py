"""The first screen of a report: a picture and a film of recorded, retuned and corrected boats,
and what stays."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest

from boatsim.diagnosis.answer.findings import Findings, FreeRun, MissingForceCurve
from boatsim.diagnosis.loading import recording_order
from boatsim.diagnosis.report import page as report
from boatsim.diagnosis.report.animation import FRAMES
from boatsim.diagnosis.report.replay_section import LARGEST, MOST_PATHS, SMALLEST, animated_replay
from boatsim.diagnosis.report.sentences import mean_force_paragraph
from boatsim.view.replay import LONGEST_REPLAY
from tests import chrome
from tests.diagnosis.report.test_page import MODELS, described, nothing, planar, rolling, unknown

LIMIT = 2_000_000  # bytes of a page


def film_of(f: Findings):
    found = animated_replay(f)
    assert found is not None
    return found, {boat["look"]: boat for boat in found.film["boats"]}


def test_the_picture_is_of_held_out_data_and_comes_before_everything_else(tmp_path):
    f = planar()
    report.write_report(f, tmp_path)
    html = (tmp_path / "report.html").read_text("utf-8")
    first = html[: html.index("<nav")]
    assert f.held_out[0] in re.findall(r"<figcaption>(.*?)</figcaption>", first)[0]
    for look in ("recorded", "recalibrated", "patched"):
        assert re.search(rf'class="line {look}" d="M', first)
    assert first.count("<figure") == 1 and 'type="range"' in first and "<button" in first
    film = json.loads(
        re.search(r'<script type="application/json">(.*?)</script>', first, re.DOTALL)[1]
    )
    assert [b["look"] for b in film["boats"]] == ["recorded", "recalibrated", "patched"] and film[
        "plan"
    ]


def test_north_is_up_east_is_right_and_a_boat_on_heading_zero_points_up():
    f = planar()
    found, boats = film_of(f)
    run = f.free_runs[0].channels["recorded"]
    assert boats["recorded"]["x"][:5] == pytest.approx(run["y_m"][:5], abs=1e-3)
    assert boats["recorded"]["y"][:5] == pytest.approx(run["x_m"][:5], abs=1e-3)
    assert boats["recorded"]["turned"][:5] == pytest.approx(run["psi_rad"][:5], abs=1e-3)
    bow = min(found.film["outline"], key=lambda corner: corner[1])  # the second number points down
    assert bow[0] == 0.0 and bow[1] < 0.0


def test_the_film_shows_what_was_run_and_begins_where_the_recalibrated_boat_errs_most():
    f = planar()
    found, boats = film_of(f)
    off = {
        m: np.hypot(
            np.subtract(boats[m]["x"], boats["recorded"]["x"]),
            np.subtract(boats[m]["y"], boats["recorded"]["y"]),
        )
        for m in ("recalibrated", "patched")
    }
    largest = max(
        np.hypot(
            *(r.channels["recalibrated"][n] - r.channels["recorded"][n] for n in ("x_m", "y_m"))
        ).max()
        for r in f.free_runs
    )
    assert off["recalibrated"].max() == pytest.approx(largest, abs=1e-3)
    start = found.film["start"]
    assert abs(found.film["t"][start] - found.film["t"][int(off["recalibrated"].argmax())]) < 1e-6
    assert (np.diff(found.film["t"]) >= 0).all()


@pytest.mark.parametrize(("size", "drawn"), [((0.05, 0.02), SMALLEST), ((30.0, 5.0), LARGEST)])
def test_a_boat_is_drawn_so_that_it_can_be_seen_and_its_scale_is_said(size, drawn):
    found, _ = film_of(replace(planar(), size=size))
    low, high = map(float, re.search(r'data-y="(\S+) (\S+)"', found.picture).groups())
    long = np.ptp([corner[1] for corner in found.film["outline"]])
    assert long == pytest.approx(drawn * (high - low), rel=0.02)
    assert "times their size" in found.about or "smaller than they are, 1 :" in found.about


def test_a_boat_that_only_rolls_shows_its_roll_over_time():
    f = rolling()
    found, boats = film_of(f)
    assert (
        not found.film["plan"]
        and found.film["unit"] == "°"
        and found.title.startswith("Roll on held-out data")
    )
    run = f.free_runs[0]
    shown = np.interp(found.film["t"], run.t, np.degrees(run.channels["patched"]["phi_rad"]))
    assert (
        boats["patched"]["y"] == pytest.approx(shown, abs=1e-2)
        and boats["patched"]["x"] == found.film["t"]
    )
    assert 'data-across="time [s]"' in found.picture and 'data-up="roll [°]"' in found.picture


def test_a_boat_whose_heading_nobody_knows_is_a_mark_that_points_nowhere():
    f = planar()
    headless = tuple(
        replace(
            r,
            channels={
                m: {n: v for n, v in c.items() if n != "psi_rad"} for m, c in r.channels.items()
            },
        )
        for r in f.free_runs
    )
    found, boats = film_of(replace(f, free_runs=headless))
    assert len({round(float(np.hypot(*corner)), 3) for corner in found.film["outline"]}) == 1
    assert found.film["plan"] and set(boats["recorded"]["turned"]) == {0.0}


def test_a_boat_that_only_yaws_shows_its_heading_over_time():
    f = planar()
    yawing = tuple(
        replace(r, channels={m: {"psi_rad": c["psi_rad"]} for m, c in r.channels.items()})
        for r in f.free_runs
    )
    found, boats = film_of(replace(f, free_runs=yawing))
    assert not found.film["plan"] and found.title.startswith("Heading on held-out data")
    assert np.degrees(boats["patched"]["turned"]) == pytest.approx(
        np.array(boats["patched"]["y"]), abs=0.1
    )


def test_without_a_patch_no_patched_boat_is_shown_and_without_free_runs_no_picture(tmp_path):
    found, boats = film_of(nothing())
    assert list(boats) == ["recorded", "recalibrated"] and "before" not in found.legend
    assert animated_replay(unknown()) is None
    report.write_report(unknown(), tmp_path)
    assert '<figure class="chart replay' not in (tmp_path / "report.html").read_text("utf-8")


def test_gaps_of_the_recording_are_gaps_of_the_film_and_rare_fixes_are_not(tmp_path):
    f = planar()
    seen = np.isin(
        np.arange(37), [1, 7, 13, 32, 35]
    )  # 6 a second: a fix a second, then none for 3.2 s
    gap = {n: np.where(seen, v, np.nan) for n, v in f.free_runs[0].channels["recorded"].items()}
    run = replace(f.free_runs[0], channels=f.free_runs[0].channels | {"recorded": gap})
    _, boats = film_of(replace(f, free_runs=(run,)))
    shown = np.array([v is not None for v in boats["recorded"]["x"]])
    assert np.flatnonzero(shown).tolist() == [*range(1, 14), *range(32, 36)]
    assert boats["recorded"]["x"][4] == pytest.approx((gap["y_m"][1] + gap["y_m"][7]) / 2, abs=1e-3)
    assert None not in boats["patched"]["x"]
    report.write_report(replace(f, free_runs=(run,)), tmp_path)
    film = re.search(
        r'"application/json">(.*?)</script>',
        (tmp_path / "report.html").read_text("utf-8"),
        re.DOTALL,
    )
    json.loads(film[1], parse_constant=lambda name: pytest.fail(name))


def hour(runs: int = 3, horizon: float = 6.0, rate: float = 10.0) -> Findings:
    """Findings from logs of an hour each, several of them held out."""
    f, n = planar(), round(3600 * rate)
    t = np.arange(n) / rate
    rng = np.random.default_rng(1)
    noise = np.cumsum(rng.normal(size=n)) / 30
    band = {a: np.full(n, 1.0) for a in ("surge", "sway", "yaw")}
    unit = {"surge": "N", "sway": "N", "yaw": "N m"}
    missing = tuple(
        MissingForceCurve(
            f"log_{i}", t, dict.fromkeys(band, noise), band, unit, dict.fromkeys(band, 0.1 * noise)
        )
        for i in range(runs + 3)
    )
    rows = round(horizon * rate) + 1
    free = []
    for i in range(runs):
        for k in range(0, n - rows, rows - 1):
            s, tau = t[k : k + rows], t[:rows]
            path = {
                "x_m": 300 * np.sin(0.003 * s),
                "y_m": 200 * np.sin(0.007 * s),
                "psi_rad": 0.01 * s,
            }
            models = {
                m: {c: v + a * 0.01 * tau**2 for c, v in path.items()}
                for m, a in zip(MODELS, (2, 1, 0.1), strict=True)
            }
            free.append(FreeRun(f"held_out_{i}", float(s[0]), s, {"recorded": path} | models))
    intervals = [
        {"run": f"log_{i}", "from_s": 9.0 * k, "to_s": 9.0 * k + 5.0, "axis": axis}
        for i in range(runs)
        for k in range(400)
        for axis in band
    ]
    answer = f.answer | {"where": f.answer["where"] | {"intervals": intervals}}
    return replace(
        f, answer=answer, missing=missing, free_runs=tuple(free), held_out=("held_out_0",)
    )


def test_the_page_of_logs_of_an_hour_stays_small_and_its_film_can_be_watched(tmp_path):
    f = hour()
    report.write_report(f, tmp_path)
    assert (tmp_path / "report.html").stat().st_size < LIMIT
    found, _ = film_of(f)
    seconds = found.film["t"][-1] - found.film["t"][0]
    assert seconds / found.film["rate"] <= LONGEST_REPLAY and len(found.film["t"]) <= 1.1 * FRAMES
    assert f"The figure shows {MOST_PATHS} of" in found.about


def test_every_line_can_be_read_back_with_its_quantity_and_unit(tmp_path):
    report.write_report(planar(), tmp_path)
    html = (tmp_path / "report.html").read_text("utf-8")
    plots = re.findall(r'<div class="plot[^>]*>', html)
    assert plots
    for plot in plots:
        low, high = map(float, re.search(r'data-x="(\S+) (\S+)"', plot).groups())
        assert low < high and re.search(r'data-up="[^"]*\[[^"\]]+\]', plot)
        assert re.search(r'data-across="(time \[s\]|y, [^"]*\[m\])"', plot)
    first = html[: html.index("<nav")]
    for d, times in re.findall(r'class="line \w+" d="M([^"]*)" data-t="([^"]*)"', first):
        assert len(d.split("L")) == len(times.split())


def test_parts_of_one_run_come_in_the_order_of_time():
    thirds = [f"run ({n} third)" for n in ("first", "last", "middle")]
    assert recording_order(thirds, [0.0, 2.0, 1.0]) == [0, 2, 1]
    assert recording_order(["run_2", "run_1", "run_3"], [5.0, 0.0, 3.0]) == [0, 1, 2]


MEAN = {"sway": {"mean": -0.21, "sd": 0.02, "unit": "N", "share_of_full_thrust": 0.105}}


def test_a_mean_force_that_stays_is_said_first_with_its_axis_its_side_and_its_share(tmp_path):
    f = planar()
    report.write_report(replace(f, answer=f.answer | {"mean_left": MEAN}), tmp_path)
    said = "0.210 ± 0.020 N to port in sway (10 % of full thrust)"
    html = (tmp_path / "report.html").read_text("utf-8").replace("\u00a0", " ")
    assert said in html[: html.index("<nav")] and said in (tmp_path / "report.md").read_text(
        "utf-8"
    )
    assert "remains in the corrected vessel" in html


@pytest.mark.parametrize("made", [planar, rolling, nothing, unknown, described])
def test_where_none_stays_nothing_is_said_of_it(made, tmp_path):
    f = made()
    report.write_report(replace(f, answer=f.answer | {"mean_left": {}}), tmp_path)
    assert "mean force" not in (tmp_path / "report.html").read_text("utf-8").lower()
    assert mean_force_paragraph(f.answer, True) == []


def test_the_share_of_belief_says_what_it_is(tmp_path):
    report.write_report(planar(), tmp_path)
    text = (tmp_path / "report.md").read_text("utf-8")
    assert "probability alone" not in text and "probability, if only one effect is missing" in text
    assert (
        "The probability assumes that exactly one of these candidates is missing, or none." in text
    )


@pytest.mark.skipif(chrome.PROGRAM is None, reason="there is no Chromium on this machine")
@pytest.mark.parametrize(("wide", "replay_first"), [(390, True), (1200, False)])
def test_a_phone_shows_the_replay_first_and_nothing_is_wider_than_it(tmp_path, wide, replay_first):
    report.write_report(planar(), tmp_path)
    with chrome.chromium() as browser:
        page = browser((tmp_path / "report.html").as_uri())
        page.picture(tmp_path / "page.png", wide, 900)
        top = "document.querySelector('{}').getBoundingClientRect().top"
        replay, title = page.run(top.format(".replay")), page.run(top.format("h1"))
        assert (replay < title - 100) == replay_first
        if not replay_first:  # beside it
            assert replay < title + 100
        assert page.run("document.documentElement.scrollWidth") <= wide
        assert page.run("document.querySelector('output').textContent.includes('retuned')")
