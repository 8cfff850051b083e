"""The report of a diagnosis: all the answer says is in it, it needs nothing else, and it cannot be
broken into."""

import os
import re
import tomllib
from base64 import b64encode
from dataclasses import replace
from hashlib import sha256
from html import unescape
from html.parser import HTMLParser

import numpy as np
import pytest

from boatsim.diagnosis.answer.findings import Findings, FreeRun, MissingForceCurve
from boatsim.diagnosis.answer.schema import Answer, IntervalEntry
from boatsim.diagnosis.answer.verdict import NONE_TESTED, verdict_sentences
from boatsim.diagnosis.description import Curve, FittedTerm
from boatsim.diagnosis.locate.residual_structure import CONSTANT
from boatsim.diagnosis.report import page as report
from boatsim.diagnosis.report.figures import part_with_largest_error
from boatsim.diagnosis.report.force_section import missing_force_section
from boatsim.diagnosis.report.page import LONGEST_HEADLINE
from boatsim.diagnosis.report.sections import report_sections
from boatsim.physics.content import load_class, shipped_content_names
from boatsim.physics.effects.described_force import DescribedForce
from boatsim.physics.effects.described_thrust import DescribedThrust
from boatsim.view.formatting import (
    format_in_one_unit,
    format_nats,
    format_number,
    format_parameter,
    format_probability,
    format_quantity,
    format_sentence,
    format_upper_limit,
    format_with_sd,
    name_and_unit,
    sentence_in_per_cent,
)
from boatsim.view.page_blocks import Table, Text
from boatsim.view.svg_plots import round_ticks, rows_of_extremes

VOID = {"meta", "br", "hr", "img", "input", "link"}
MODELS = ("nominal", "recalibrated", "patched")


def planar() -> Findings:
    """A twin-motor boat whose propellers are weak astern, with a look-alike."""
    missing, intervals = planar_missing()
    answer = planar_answer(intervals)
    answer["sentence"] = verdict_sentences(answer)
    words = {
        "weak_reverse": "the propellers push less astern than commanded",
        "prop_walk": "a propeller pushes sideways as well, mostly astern",
        "thrust_gain_error": "all thrust is stronger or weaker than stated by one factor",
        "wind": "a steady wind pushes the hull in one direction of the world",
        "weak_reverse.astern_factor": "astern thrust per commanded thrust",
    }
    return Findings(
        answer,
        "trial_boat",
        ("run_1", "run_2"),
        ("run_3",),
        "the last run, run_3",
        tuple(missing),
        planar_runs(),
        ("The boat never went astern for longer than 6 s.",),
        {"linear_damping.surge": (1.034, 0.021), "thrust": (0.987, 0.018)},
        (("Runs", ["run", "seconds"], [["run_1", "80.0"], ["run_2", "80.0"]]),),
        words,
    )


def planar_missing() -> tuple[list[MissingForceCurve], list[IntervalEntry]]:
    """Missing force of two runs, most of it while the thrust is astern, and where surge and yaw are
    flagged."""
    rng = np.random.default_rng(1)
    t = np.arange(0.0, 80.0, 1 / 6)
    astern = np.sin(0.35 * t) > 0.2
    intervals, missing = [], []
    for run in ("run_1", "run_2"):
        size = np.convolve(np.where(astern, 0.34, 0.01), np.ones(9) / 9, "same")
        wave = {
            a: k * size + 0.02 * np.cumsum(rng.normal(size=len(t))) / 9
            for a, k in (("surge", 1), ("sway", 0.2))
        }
        wave["yaw"] = 0.1 * wave["surge"] + 0.002 * np.sin(t)
        sd = {a: np.full(len(t), s) for a, s in (("surge", 0.05), ("sway", 0.06), ("yaw", 0.006))}
        left = {a: 0.03 * s[0] / 0.05 * np.sin(0.6 * t + 1) for a, s in sd.items()}
        missing.append(
            MissingForceCurve(run, t, wave, sd, {"surge": "N", "sway": "N", "yaw": "N m"}, left)
        )
        edges = np.flatnonzero(np.diff(np.r_[0, astern, 0]))
        for axis in ("surge", "yaw"):
            intervals += [
                {"run": run, "from_s": float(t[a]), "to_s": float(t[b - 1]), "axis": axis}
                for a, b in zip(edges[::2], edges[1::2], strict=True)
            ]
    return missing, intervals


def planar_answer(intervals: list[IntervalEntry]) -> Answer:
    """Its diagnosis.json, without the sentence."""
    return {
        "verdict": "ambiguous", "sentence": "", "seconds": 1.37, "version": "0.1.0",
        "effects": [{
            "name": "weak_reverse", "kind": "physics", "probability": 0.873, "gain_nats": 63.4,
            "words": "the propellers push less astern than commanded", "tied_with": ["prop_walk"],
            "parameters": {"astern_factor": {"value": 0.6943, "sd": 0.0118, "unit": ""}},
        }],
        "unknown": {"flag": False, "gain_nats": 1.21, "told_from_nats": 6.0}, "described": [],
        "candidates": [
            {"name": n, "gain_nats": g, "probability": p}
            for n, g, p in (
                ("weak_reverse", 63.4, 0.873), ("prop_walk", 61.5, 0.127), ("thrust_gain_error", 41.7, 3e-10),
                ("thrust_imbalance", 12.3, 1e-22), ("current", 8.91, 1e-24), ("wind", 3.04, 1e-26),
                ("steering_offset", 0.42, 1e-28), ("thrust_lag", -1.73, 1e-29), ("cross_flow_drag", -2.26, 1e-29),
            )
        ],
        "upper_limits": {
            "wind": {"force_N": 0.0412}, "steering_offset": {"port_rad": 0.0218, "starboard_rad": 0.0194},
            "current": {"north_mps": 0.0067, "east_mps": 0.0081}, "thrust_lag": {"time_constant_s": 0.113},
        },
        "where": {
            "axes": {"surge": {"rms": 0.214, "sd": 0.051, "unit": "N"},
                     "sway": {"rms": 0.0471, "sd": 0.0612, "unit": "N"},
                     "yaw": {"rms": 0.0223, "sd": 0.00617, "unit": "N m"}},
            "intervals": intervals,
            "region": [{"variable": "thrust", "p_value": 3.2e-9,
                        "statement": "while thrust is astern, about 30 % of the commanded thrust is missing"}],
        },
        "fit": {"horizon_s": 6.0, "held_out": ["run_3"],
                "position_rms_m": {"nominal": 0.142, "recalibrated": 0.0957, "patched": 0.0139},
                "heading_rms_rad": {"nominal": 0.0881, "recalibrated": 0.0523, "patched": 0.0112}},
        "next_experiment": {"manoeuvre": "multi-level astern steps at two steering angles", "scenario": "next.toml",
                            "separates": ["weak_reverse", "prop_walk"], "expected_gain_nats": 9.63},
        "patch": "patched.toml",
    }  # fmt: skip


def planar_runs() -> tuple[FreeRun, ...]:
    """Free runs over one held-out recording, each model drifting off at its own pace."""
    rng = np.random.default_rng(2)
    found = []
    for i in range(13):
        t = 6.0 * i + np.arange(0.0, 6.01, 1 / 6)
        tau = t - t[0]
        path = {
            "x_m": 1.2 * np.sin(0.11 * t) + 0.2 * np.sin(0.5 * t),
            "y_m": 0.9 * np.sin(0.22 * t),
            "psi_rad": 0.3 * t,
        }
        drift = {"x_m": 0.009, "y_m": -0.006, "psi_rad": 0.004}
        off = {"nominal": 1.5, "recalibrated": 1.0, "patched": 0.12}
        turn = rng.normal(size=3)
        channels = {
            m: {
                n: v + k * drift[n] * abs(turn[j]) * tau**2 * np.sign(turn[j])
                for j, (n, v) in enumerate(path.items())
            }
            for m, k in off.items()
        }
        recorded = {n: v + rng.normal(0, 0.003, len(t)) for n, v in path.items()}
        found.append(FreeRun("run_3", float(t[0]), t, {"recorded": recorded} | channels))
    return tuple(found)


def rolling() -> Findings:
    """A ship model rolling to rest, with damping and righting arm not linear."""

    def decay(t, cubic, stiff):
        amplitude = 0.26 * np.exp(-0.012 * t) / np.sqrt(1 + cubic * (1 - np.exp(-0.024 * t)))
        return amplitude * np.cos(1.31 * t * (1 + stiff * amplitude**2))

    thirds = {"zero_speed (first third)": (8.2, 69.5), "zero_speed (last third)": (130.7, 192.0)}
    missing, intervals = [], []
    for name, (a, b) in thirds.items():
        t = np.arange(a, b, 0.1)
        force = 5.2 * (decay(t, 2.0, 0.0) / 0.26) ** 3
        missing.append(
            MissingForceCurve(
                name,
                t,
                {"roll": force},
                {"roll": 0.2 + 0 * t},
                {"roll": "N m"},
                {"roll": 0.1 * np.sin(t)},
            )
        )
        outside = np.abs(force) > 0.4
        edges = np.flatnonzero(np.diff(np.r_[0, outside, 0]))
        intervals += [
            {"run": name, "from_s": float(t[i]), "to_s": float(t[j - 1]), "axis": "roll"}
            for i, j in zip(edges[::2], edges[1::2], strict=True)
            if t[j - 1] - t[i] > 0.5
        ]
    t = np.arange(69.5, 130.7, 0.1)
    channels = {
        "recorded": {"phi_rad": decay(t, 2.0, -0.02)},
        "nominal": {"phi_rad": decay(t, 0.0, 0.0)},
        "recalibrated": {"phi_rad": decay(t, 1.4, -0.004)},
        "patched": {"phi_rad": decay(t, 1.97, -0.0199)},
    }
    answer = {
        "verdict": "named", "sentence": "", "seconds": 0.84, "version": "0.1.0",
        "effects": [
            {"name": "quadratic_damping", "kind": "physics", "probability": 0.99994, "gain_nats": 812.0,
             "tied_with": [], "words": "damping grows with the square of the speed",
             "parameters": {"roll_Nms2": {"value": 31.42, "sd": 0.87, "unit": "N m s^2"}}},
            {"name": "righting_arm_stiffening", "kind": "physics", "probability": 0.9962, "gain_nats": 214.0,
             "tied_with": [], "words": "the righting arm bends with heel",
             "parameters": {"cubic": {"value": -0.381, "sd": 0.0217, "unit": ""}}},
        ],
        "unknown": {"flag": False, "gain_nats": 0.0, "told_from_nats": 6.0}, "described": [],
        "candidates": [{"name": "quadratic_damping", "gain_nats": 812.0, "probability": 0.99994},
                       {"name": "cubic_damping", "gain_nats": 788.0, "probability": 2.9e-5},
                       {"name": "righting_arm_stiffening", "gain_nats": 196.0, "probability": 1e-90},
                       {"name": "damping_error", "gain_nats": -0.71, "probability": 1e-99}],
        "upper_limits": {"cubic_damping": {"roll_Nms3": 4.13}}, "patch": "patched.toml", "next_experiment": {},
        "where": {"axes": {"roll": {"rms": 1.94, "sd": 0.213, "unit": "N m"}}, "intervals": intervals, "region": []},
        "fit": {"horizon_s": 61.2, "held_out": ["zero_speed (middle third)"],
                "position_rms_m": {}, "heading_rms_rad": {},
                "roll_rms_rad": {"nominal": 0.0521, "recalibrated": 0.0183, "patched": 0.00203}},
    }  # fmt: skip
    answer["sentence"] = verdict_sentences(answer)
    remark = "In the last third the roll is small: there the linear vessel is already right, and no model beats it clearly."
    return Findings(
        answer,
        "kvlcc2_roll",
        tuple(thirds),
        ("zero_speed (middle third)",),
        "the only run's middle third, 69.5 to 130.7 s",
        tuple(missing),
        (FreeRun("zero_speed (middle third)", 69.5, t, channels),),
        (remark,),
        {"linear_damping.roll": (0.613, 0.024)},
    )


def nothing() -> Findings:
    """A vessel that is right."""
    f = planar()
    rms = {
        "position_rms_m": dict.fromkeys(MODELS, 0.0121),
        "heading_rms_rad": dict.fromkeys(MODELS, 0.0104),
    }
    answer = f.answer | {
        "verdict": "nothing_missing",
        "effects": [],
        "next_experiment": {},
        "fit": f.answer["fit"] | rms,
    }
    answer["where"] = f.answer["where"] | {"intervals": [], "region": []}
    answer["sentence"] = verdict_sentences(answer)
    return replace(f, answer=answer, remarks=())


def unknown() -> Findings:
    """A cause outside the library."""
    f = nothing()
    answer = f.answer | {
        "verdict": "unknown",
        "unknown": {"flag": True, "gain_nats": 37.4, "told_from_nats": 6.0},
        "fit": {},
    }
    answer["sentence"] = verdict_sentences(answer)
    return replace(f, answer=answer, free_runs=(), held_out=(), held_out_note="")


def described() -> Findings:
    """A cause outside the library with two laws written down for it, one of them an event of a
    run."""
    f = unknown()
    fit = {
        "horizon_s": 6.0,
        "held_out": ["run_3"],
        "position_rms_m": dict(zip(MODELS, (0.2, 0.1, 0.03), strict=True)),
    }
    laws = [
        {
            "axis": "sway",
            "statement": "a side force that no candidate effect explains: 1.20 N s² times yaw rate squared",
            "terms": [
                {
                    "of": "yaw rate squared",
                    "value": 1.2,
                    "sd": 0.05,
                    "unit": "N s^2",
                    "gain_nats": 39.3,
                }
            ],
            "carries_over": True,
        },
        {
            "axis": "thrust",
            "statement": "a change of thrust that no candidate effect explains: 15 % less, from 3 to 9 s",
            "terms": [
                {
                    "of": "thrust, from 3 to 9 s of run_1",
                    "value": -0.15,
                    "sd": 0.02,
                    "unit": "",
                    "gain_nats": 12.1,
                    "run": "run_1",
                }
            ],
            "carries_over": False,
        },
    ]
    answer = f.answer | {"verdict": "described", "described": laws, "fit": fit}
    answer["sentence"] = verdict_sentences(answer)
    x = np.linspace(0.0, 0.6, 12)
    curve = Curve("yaw_rate", x, 1.2 * x**2, 0.05 * x**2, 1.2 * x**2 + 0.01)
    terms = (
        FittedTerm(
            DescribedForce(name="described_1", axis="sway", of=("yaw_rate", "yaw_rate")),
            0.05,
            39.3,
            True,
            curve,
        ),
        FittedTerm(
            DescribedThrust(name="described_thrust_1", acts="within", begin=3.0, end=9.0),
            0.02,
            12.1,
            False,
        ),
    )
    return replace(f, answer=answer, described=terms, held_out=("run_3",), held_out_note="run_3")


class Outline(HTMLParser):
    """Checks that tags close in order, and keeps what a browser would look at."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.attributes: list[tuple[str, str, str | None]] = []
        self.headings: list[str] = []
        self.words: list[str] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.attributes += [(tag, name, value) for name, value in attrs]
        if re.fullmatch("h[1-6]", tag):
            self.headings.append(tag)
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.attributes += [(tag, name, value) for name, value in attrs]

    def handle_endtag(self, tag):
        assert self.open and self.open.pop() == tag, f"</{tag}> at {self.getpos()}"

    def handle_data(self, data):
        if not self.open or self.open[-1] not in ("style", "title"):
            self.words.append(data)


CASES = {
    "planar": planar,
    "rolling": rolling,
    "nothing": nothing,
    "unknown": unknown,
    "described": described,
}


@pytest.fixture(scope="module", params=CASES)
def written(request, tmp_path_factory):
    folder, findings = tmp_path_factory.mktemp(request.param), CASES[request.param]()
    report.write_report(findings, folder)
    return (
        findings,
        (folder / "report.html").read_text("utf-8"),
        (folder / "report.md").read_text("utf-8"),
    )


def expected_numbers(answer) -> list[str]:
    """Every number of the answer as a reader meets it."""
    found: list[
        str
    ] = []  # all but the seconds, which would make the same diagnosis differ from run to run
    for e in answer["effects"]:
        found += [format_nats(e["gain_nats"]), format_probability(e["probability"])]
        found += [
            format_parameter(k, p["value"], p["unit"], p["sd"])[1]
            for k, p in e["parameters"].items()
        ]
    for c in answer["candidates"]:
        found += [format_nats(c["gain_nats"]), format_probability(c["probability"])]
    found += [
        format_upper_limit(k, v)[1] for e in answer["upper_limits"].values() for k, v in e.items()
    ]
    for a in answer["where"]["axes"].values():
        found += format_in_one_unit([a["rms"], a["sd"]], a["unit"])
    found += [f"{i[k]:.1f}" for i in answer["where"]["intervals"] for k in ("from_s", "to_s")]
    found += [format_number(r["p_value"], 1) for r in answer["where"]["region"]]
    for key, unit in (("position_rms_m", "m"), ("heading_rms_rad", "rad"), ("roll_rms_rad", "rad")):
        rms = answer["fit"].get(key, {})
        found += format_in_one_unit([rms[m] for m in MODELS], unit) if rms else []
    found += (
        [format_nats(answer["next_experiment"]["expected_gain_nats"])]
        if answer["next_experiment"]
        else []
    )
    return found + (
        [format_nats(answer["unknown"]["gain_nats"])] if answer["unknown"]["flag"] else []
    )


def test_every_number_of_the_answer_and_every_remark_is_in_both_texts(written):
    findings, html, text = written
    words = " ".join(Outline(html).words).replace("\u00a0", " ")
    told = [
        *expected_numbers(findings.answer),
        *findings.remarks,
        *findings.runs,
        *findings.held_out,
    ]
    told += [format_with_sd(*v) for v in findings.coefficients.values()]
    told += [cell for _, _, rows in findings.extra_tables for row in rows for cell in row]
    assert [t for t in told if t not in words] == []
    assert [t for t in told if t not in text] == []


def test_the_page_says_its_sentence_first_and_fetches_nothing(written):
    findings, html, text = written
    outline = Outline(html)
    assert outline.open == [] and outline.headings[0] == "h1" and outline.headings.count("h1") == 1
    assert all(
        int(b[1]) - int(a[1]) <= 1
        for a, b in zip(outline.headings, outline.headings[1:], strict=False)
    )
    sentence = findings.answer["sentence"]
    assert sentence in html.replace("\u00a0", " ") and sentence in text[: text.index("\n- ")]
    if len(sentence) <= LONGEST_HEADLINE:
        assert text.startswith(f"# {sentence}")
    links = [
        value
        for _, name, value in outline.attributes
        if name in ("src", "href", "srcset", "action", "xlink:href")
    ]
    assert links and all(link.startswith("#") for link in links)
    policy = re.search(r'<meta http-equiv="Content-Security-Policy" content="([^"]*)">', html)
    assert policy and html.index(policy[0]) < html.index("<style>")
    assert not re.search(
        r"https?:|//[a-z]|url\(|@import|<script src|<link|\bon[a-z]+=|fetch\(|import\(",
        html.replace(policy[0], ""),
    )
    scripts = re.findall(r"<script>(.*?)</script>", html, re.DOTALL)
    allowed = {f"'sha256-{b64encode(sha256(s.encode()).digest()).decode()}'" for s in scripts}
    assert len(scripts) == 1 and f"default-src 'none'; script-src {allowed.pop()}; " in policy[
        1
    ].replace("&#39;", "'")
    assert len(html.encode()) < 1_000_000
    ids = [value for _, name, value in outline.attributes if name == "id"]
    assert len(ids) == len(set(ids)) and {link[1:] for link in links} <= set(ids)


def test_curves_have_finite_coordinates_and_words_for_who_can_not_see_them(written):
    _, html, _ = written
    drawn = re.findall(r'<path class="(?!grid)[^"]*" d="([^"]*)"', html)
    assert drawn and all(
        re.fullmatch(r"M-?\d+ -?\d+([LHV]-?\d+( -?\d+)?)*Z?", d) for d in drawn if d
    )
    assert all(
        re.search(r'role="img" aria-label="[^"]+"', svg)
        for svg in re.findall(r"<svg viewBox=\"0 0 2000[^>]*>", html)
    )


def test_names_and_words_from_files_do_not_become_markup(tmp_path):
    nasty = "<script>alert('x')</script>|*a*"
    f = planar()
    answer = f.answer | {
        "sentence": nasty,
        "effects": [f.answer["effects"][0] | {"words": nasty, "name": nasty}],
    }
    missing = tuple(replace(m, run=nasty) for m in f.missing)
    runs = tuple(replace(r, run=nasty) for r in f.free_runs)
    tables = ((nasty, [nasty], [[nasty]]),)
    report.write_report(
        replace(
            f,
            answer=answer,
            vessel=nasty,
            runs=(nasty,),
            held_out_note=nasty,
            missing=missing,
            free_runs=runs,
            remarks=(nasty,),
            coefficients={nasty: (1.0, 0.1)},
            extra_tables=tables,
        ),
        tmp_path,
    )
    html, text = ((tmp_path / n).read_text("utf-8") for n in ("report.html", "report.md"))
    assert Outline(html).open == [] and "<script>alert" not in html
    assert "\\<script" in text and not re.search(r"(?<!\\)<script", text)
    assert (
        html.count("<script") == 2 and "|*a*" not in text
    )  # the film, which is data, and the page's own


def test_nothing_missing_says_so_and_gives_the_upper_limits(tmp_path):
    f = nothing()
    report.write_report(f, tmp_path)
    text = (tmp_path / "report.md").read_text("utf-8")
    assert text.startswith("# No missing effect was found") and "**Nothing missing.**" in text
    assert (
        "## Upper limits of effects that were not found" in text
        and "## What to record next" not in text
        and "smaller)" not in text
    )


def test_sentence_is_made_of_the_words_of_the_effects():
    assert planar().answer["sentence"] == (
        "The model leaves out one effect: the propellers push less astern than commanded (astern factor 0.694 ± 0.012). "
        "These recordings cannot distinguish weak reverse from prop walk."
    )
    roll = rolling().answer
    assert roll["sentence"].startswith(
        "The model leaves out two effects: damping grows with the square of the speed (roll "
    )
    assert (
        "cannot distinguish" not in roll["sentence"]
        and "N m s²), and the righting arm" in roll["sentence"]
    )


LATE = {
    "name": "clock_offset",
    "kind": "measurement",
    "words": "the clock runs late (not physics)",
    "tied_with": [],
    "probability": 0.99,
    "gain_nats": 80.0,
    "parameters": {"pose_late_s": {"value": 0.21, "sd": 0.013, "unit": "s"}},
}
MEANT = {"clock_offset.pose_late_s": "poses late by"}
DAMPED = {
    "name": "quadratic_damping",
    "kind": "physics",
    "words": "damping grows",
    "tied_with": [],
    "parameters": {},
    "probability": 0.99,
    "gain_nats": 80.0,
}
CLOCK = "the clock runs late (poses late by 0.210 ± 0.013 s)"
MISSING = "A force is missing that no candidate effect explains (0.21 N rms in surge)"


@pytest.mark.parametrize(
    ("verdict", "effects", "text"),
    [
        ("named", [DAMPED], "The model leaves out one effect: damping grows."),
        (
            "named",
            [DAMPED] * 3,
            "The model leaves out three effects: damping grows, damping grows, and damping grows.",
        ),
        (
            "named",
            [DAMPED] * 4,
            "The model leaves out four effects: " + "damping grows, " * 3 + "and damping grows.",
        ),
        (
            "named",
            [LATE],
            f"No missing physics was found, but the recordings contain a measurement error: {CLOCK}.",
        ),
        (
            "named",
            [DAMPED, LATE],
            "The model leaves out one effect: damping grows. In addition, the recordings contain a "
            f"measurement error: {CLOCK}.",
        ),
        (
            "ambiguous",
            [DAMPED | {"tied_with": ["cubic_damping", "damping_error"]}],
            "The model leaves out one effect: damping grows. These recordings cannot distinguish "
            "quadratic damping from cubic damping or damping error.",
        ),
        ("unknown", [], f"{MISSING}."),
        (
            "unknown",
            [DAMPED],
            f"{MISSING}. In addition, the model leaves out one effect: damping grows.",
        ),
        (
            "unknown",
            [LATE],
            f"{MISSING}. In addition, the recordings contain a measurement error: {CLOCK}.",
        ),
        (
            "unknown",
            [DAMPED | {"tied_with": ["wind"]}],
            f"{MISSING}. In addition, the model leaves out one effect: damping "
            "grows. These recordings cannot distinguish quadratic damping from wind.",
        ),
        (
            "nothing_missing",
            [],
            "No missing effect was found: the vessel model explains these recordings to within their "
            "noise.",
        ),
    ],
)
def test_every_verdict_has_its_sentences(verdict, effects, text):
    where = {"axes": {"surge": {"rms": 0.214, "sd": 0.05, "unit": "N"}}}
    answer = {
        "verdict": verdict,
        "effects": effects,
        "where": where,
        "candidates": [{"name": "wind"}],
        "described": [],
        "unknown": {"flag": verdict == "unknown"},
    }
    assert verdict_sentences(answer, MEANT) == text


def formula(statement, value, carries_over, **event):
    """Return a formula of an answer with one term of standard deviation 1."""
    term = {"of": "yaw rate", "value": value, "sd": 1.0, "unit": "N s", "gain_nats": 40.0} | event
    return {
        "axis": "sway",
        "statement": statement,
        "terms": [term],
        "carries_over": carries_over,
    }


LAW = formula("a side force of 2 N", 20.0, True)
EVENT = formula("a push at 3 s of run_1", 20.0, False, run="run_1")
UNCONFIRMED = formula("a side force of 3 N", 20.0, False)
UNDETERMINED = formula("a side force of 4 N", 1.9, True)


@pytest.mark.parametrize(
    ("effects", "described", "text"),
    [
        ([], [LAW], "The model lacks a side force of 2 N."),
        (
            [],
            [EVENT, EVENT],
            "The model lacks a push at 3 s of run_1. The model lacks a push at 3 s of run_1.",
        ),
        (
            [DAMPED],
            [LAW],
            "The model leaves out one effect: damping grows. In addition, the model lacks a side force of 2 N.",
        ),
        (
            [LATE],
            [EVENT],
            "The recordings contain a measurement error: "
            f"{CLOCK}. In addition, one further force remains: a push at 3 s of run_1.",
        ),
        (
            [DAMPED],
            [EVENT, LAW, EVENT],
            "The model leaves out one effect: damping grows. In addition, the model lacks a side force of 2 N. "
            "2 further forces remain, the first is a push at 3 s of run_1.",
        ),
        (
            [],
            [UNCONFIRMED],
            f"{MISSING}. A formula describes a side force in the fitted recordings, but held-out "
            "recordings do not confirm it.",
        ),
        (
            [DAMPED],
            [UNCONFIRMED, UNDETERMINED, UNCONFIRMED | {"axis": "yaw"}],
            f"{MISSING}. In addition, the model leaves out one effect: damping grows. Formulas "
            "describe a side force and a yaw moment in the fitted recordings, but held-out "
            "recordings do not confirm them. A formula describes a side force in the fitted "
            "recordings, but these recordings do not determine its coefficients.",
        ),
    ],
)
def test_effects_come_before_formulas_and_events_are_counted(effects, described, text):
    answer = {
        "verdict": "described",
        "effects": effects,
        "where": {"axes": {"surge": {"rms": 0.214, "sd": 0.05, "unit": "N"}}},
        "candidates": [{"name": "wind"}],
        "unknown": {"flag": True},
        "described": described,
        "fit": {"held_out": ["run_3"]},
    }
    assert verdict_sentences(answer, MEANT) == text


def test_what_held_out_recordings_confirm_comes_before_a_formula_that_they_do_not() -> None:
    possible = {"words": "waves push", "in_patch": True, "confirmed": True}
    answer = {
        "verdict": "described",
        "effects": [],
        "where": {"axes": {}},
        "candidates": [{"name": "wind"}],
        "unknown": {"flag": True, "rest": {"sway": {"rms": 0.5, "sd": 0.1, "unit": "N"}}},
        "described": [UNCONFIRMED],
        "fit": {"held_out": ["run_3"]},
        "also_possible": [possible, possible | {"words": "no", "confirmed": False}],
    }
    assert verdict_sentences(answer, MEANT) == (
        "A force is missing that no candidate effect explains (0.50 N rms in sway). The corrected "
        "vessel contains “waves push”: held-out recordings confirm it, but it may stand in for "
        "another cause. A formula describes a side force in the fitted recordings, but held-out "
        "recordings do not confirm it."
    )


def test_an_unexplained_force_that_varies_with_nothing_is_called_constant() -> None:
    structure = {
        "axis": "heave",
        "goes_with": CONSTANT,
        "gain_nats": 9.0,
        "p_value": 1e-3,
        "tried": 5,
    }
    answer = {
        "verdict": "unknown",
        "effects": [],
        "where": {"axes": {"heave": {"rms": 7.1, "sd": 0.1, "unit": "N"}}},
        "candidates": [{"name": "wind"}],
        "unknown": {"flag": True, "structure": structure},
        "described": [],
    }
    assert verdict_sentences(answer, MEANT).endswith(" In heave it is constant.")
    answer["unknown"]["structure"] = structure | {"goes_with": "the heading"}
    assert verdict_sentences(answer, MEANT).endswith(" In heave it varies with the heading.")


def test_two_possible_effects_that_balance_each_other_are_stated_together() -> None:
    possible = {"probability": 0.1, "gain_nats": 40.0, "in_patch": True, "confirmed": True}
    stiffness = {"value": 50.0, "sd": 5.0, "unit": "N/m"}
    spring = possible | {
        "name": "ground_spring",
        "words": "a spring pulls",
        "parameters": {"stiffness_east": stiffness},
        "together_with": "wave_drift",
    }
    drift = possible | {
        "name": "wave_drift",
        "words": "waves push",
        "together_with": "ground_spring",
    }
    answer = {
        "verdict": "unknown",
        "effects": [],
        "where": {"axes": {}},
        "candidates": [{"name": "wind"}],
        "unknown": {"flag": True, "rest": {"sway": {"rms": 0.5, "sd": 0.1, "unit": "N"}}},
        "described": [],
        "also_possible": [spring, drift],
    }
    together = (
        "Simulations require two effects together: a spring pulls (stiffness east 50.0 ± 5.0 N/m)"
    )
    assert together in verdict_sentences(answer, MEANT)
    answer["also_possible"] = [spring, drift | {"confirmed": False}]
    assert "together" not in verdict_sentences(answer, MEANT)


@pytest.mark.parametrize(
    ("verdict", "begins"),
    [
        (
            "unknown",
            "Something is missing (0.21 N rms in surge), but ",
        ),
        (
            "nothing_missing",
            "No force beyond the assumed disturbance is missing, but ",
        ),
    ],
)
def test_a_diagnosis_with_nothing_to_try_says_so(verdict: str, begins: str) -> None:
    where = {"axes": {"surge": {"rms": 0.214, "sd": 0.05, "unit": "N"}}}
    unknown = {"flag": verdict == "unknown"}
    nothing = {
        "verdict": verdict,
        "effects": [],
        "where": where,
        "candidates": [],
        "unknown": unknown,
        "described": [],
    }
    said = verdict_sentences(nothing)
    assert said == f"{begins}{NONE_TESTED}."


def test_the_setting_of_the_answer_decides_what_is_stated_as_probable():
    answer = planar_answer([])
    answer["signs"] = {"effects": [{"name": "weak_reverse", "probability": 0.85}]}
    for sure, probable in ((0.8, False), (0.9, True)):
        answer["config"] = {"decide.sure_probability": sure}
        assert ("probably" in verdict_sentences(answer)) == probable


def test_a_sentence_leaves_out_what_may_be_zero_and_all_but_the_first_few_numbers():
    values = {
        "surge_N": 0.2,
        "sway_N": 0.001,
        "yaw_Nm": 0.1,
        "north_mps": 0.3,
        "east_mps": 0.3,
        "astern_factor": 0.005,
    }
    effect = DAMPED | {
        "parameters": {
            k: {"value": v, "sd": 0.01, "unit": name_and_unit(k)[1]} for k, v in values.items()
        }
    }
    said = verdict_sentences(
        {
            "verdict": "named",
            "effects": [effect],
            "candidates": [effect],
            "where": {"axes": {}},
            "unknown": {"flag": False},
            "described": [],
        }
    )
    assert (
        "surge 0.200 ± 0.010 N, yaw" in said
        and "north" in said
        and "sway" not in said
        and "east" not in said
    )
    effect["parameters"] = {
        "astern_factor": effect["parameters"]["astern_factor"]
    }  # a factor is something at zero too
    assert "astern factor 0.005 ± 0.010" in verdict_sentences(
        {
            "verdict": "named",
            "effects": [effect],
            "candidates": [effect],
            "unknown": {"flag": False},
            "described": [],
        }
    )


def test_an_error_of_measurement_is_told_from_physics(tmp_path):
    f = planar()
    answer = f.answer | {"verdict": "named", "effects": [LATE], "sentence": ""}
    report.write_report(replace(f, answer=answer, words=f.words | MEANT), tmp_path)
    text = (tmp_path / "report.md").read_text("utf-8")
    assert text.startswith(
        "# No missing physics was found, but the recordings contain a measurement error: the clock "
        "runs late (poses late by 0.210"
    )
    assert "**Measurement error.**" in text and "clock_offset · measurement error" in text
    assert "These forces are not real" in text


def test_what_is_tied_has_no_upper_limit_and_what_has_none_is_said(tmp_path):
    f = planar()
    limits = f.answer["upper_limits"] | {"prop_walk": {"side_force_per_thrust": 0.77}, "tether": {}}
    report.write_report(replace(f, answer=f.answer | {"upper_limits": limits}), tmp_path)
    text = (tmp_path / "report.md").read_text("utf-8")
    assert (
        "0.77" not in text
        and "How strong tether could be at most: no limit could be computed" in text
    )


def test_the_next_experiment_says_what_to_command_and_how_to_run_it(tmp_path):
    steps = (
        (0.0, {"thrust_port_N": -0.4, "steer_port_rad": 0.0}),
        (6.0, {"thrust_port_N": -0.9}),
        (9.0, {}),
    )
    report.write_report(replace(planar(), steps=steps), tmp_path)
    text = (tmp_path / "report.md").read_text("utf-8")
    assert (
        "**Distinguishes**: Weak reverse or prop walk." in text and "boatsim run next.toml" in text
    )
    assert re.search(
        r"\| 0 s \| −0\.4\d* N \| 0° \|\n\| 6 s \| −0\.9\d* N \|  \|\n\| 9 s \| end \|  \|", text
    )


def test_how_a_deviation_is_made_is_said_once(written):
    findings, html, text = written
    said = "includes 5 % of the effect's own size"
    assert (
        text.count(said)
        == html.replace("\u00a0", " ").count(said.replace("'", "&#39;"))
        == bool(findings.answer["effects"])
    )


def test_a_roll_decay_is_drawn_where_the_model_errs_most_and_not_as_a_comb():
    run = rolling().free_runs[0]
    look = part_with_largest_error(run, "phi_rad")
    error = np.abs(run.channels["recalibrated"]["phi_rad"] - run.channels["recorded"]["phi_rad"])
    assert look.t[0] <= run.t[error.argmax()] <= look.t[-1] and np.ptp(look.t) < 0.7 * np.ptp(run.t)
    assert np.count_nonzero(np.diff(np.sign(look.channels["recorded"]["phi_rad"]))) <= 15


def test_an_rms_by_run_is_that_of_the_coordinates_as_in_the_answer():
    f = planar()
    two = (*f.free_runs, *(replace(r, run="run_4") for r in f.free_runs))
    tables = [
        b
        for s in report_sections(replace(f, free_runs=two))
        if s.key == "proof"
        for b in s.blocks
        if b.kind == "table"
    ]
    off = [
        r.channels["patched"][n] - r.channels["recorded"][n]
        for r in f.free_runs
        for n in ("x_m", "y_m")
    ]
    rms = float(np.sqrt(np.mean(np.concatenate(off) ** 2)))
    row = next(r for r in tables[1].rows if r[0] == "run_4, position")
    assert row[3] == f"{format_number(100 * rms)} cm"


def test_a_failed_write_leaves_the_old_report_whole(tmp_path, monkeypatch):
    report.write_report(planar(), tmp_path)
    before = {p.name: p.read_bytes() for p in tmp_path.iterdir()}
    assert set(before) == {"report.html", "report.md"}

    def full(*_):
        raise OSError("disk full")

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(OSError, match="disk full"):
        report.write_report(rolling(), tmp_path)
    assert {p.name: p.read_bytes() for p in tmp_path.iterdir()} == before


def test_the_same_findings_give_the_same_bytes(tmp_path):
    for name in "ab":
        report.write_report(planar(), tmp_path / name)
    assert (tmp_path / "a" / "report.html").read_bytes() == (
        tmp_path / "b" / "report.html"
    ).read_bytes()


def test_gaps_in_a_recording_and_runs_without_anything_to_draw_are_no_obstacle(tmp_path):
    f = planar()
    gap = {
        n: np.where(np.arange(len(v)) % 3, np.nan, v)
        for n, v in f.free_runs[0].channels["recorded"].items()
    }
    run = replace(f.free_runs[0], channels=f.free_runs[0].channels | {"recorded": gap})
    none = {axis: 0 * force for axis, force in f.missing[0].force.items()}
    report.write_report(
        replace(f, missing=(replace(f.missing[0], force=none, sd=none),), free_runs=(run,)),
        tmp_path,
    )
    for name in ("report.html", "report.md"):
        assert not re.search(r"\bnan\b", (tmp_path / name).read_text("utf-8"))


@pytest.mark.parametrize(
    ("value", "sd", "text"),
    [
        (0.69431, 0.0118, "0.694 ± 0.012"),
        (-3.0, 12.0, "−3 ± 12"),
        (31.42, 0.87, "31.42 ± 0.87"),
        (5.0, 0.0, "5.00"),
        (2.3e7, 4e5, "(2.300 ± 0.040) × 10⁷"),
        (0.0, 0.5, "0.00 ± 0.50"),
    ],
)
def test_a_value_has_the_digits_its_deviation_allows(value, sd, text):
    assert format_with_sd(value, sd) == text


def test_nothing_is_written_as_minus_nothing():
    assert (format_number(-0.0), format_number(-0.71), format_number(4.0e7)) == (
        "0",
        "−0.710",
        "4.00 × 10⁷",
    )


def test_readers_get_degrees_and_handy_units():
    assert format_quantity(np.pi / 2, "rad", 0.01) == "90.00° ± 0.57°"
    assert (
        format_quantity(0.0434, "m", 0.0078) == "4.34 ± 0.78 cm"
        and format_quantity(0.00392, "m/s", digits=2) == "3.9 mm/s"
    )
    assert format_parameter("toward_rad", -0.1076, "rad", 0.052) == ("toward", "353.8° ± 3.0°")
    assert format_parameter("x_fraction", -0.0884, "", 0.0098) == ("x", "−8.84 ± 0.98 %")
    assert (
        format_parameter("frequency_radps", 2.0, "rad/s", 0.1)[1]
        == "2.00 ± 0.10 rad/s, a period of 3.14 s"
    )
    assert (
        format_upper_limit("astern_factor", 0.0301) == ("astern factor", "3.0 %")
        and format_upper_limit("delay_s", 0.0533)[1] == "53 ms"
    )
    assert format_in_one_unit([0.142, 0.0139], "m") == ["14.2 cm", "1.39 cm"]
    assert format_in_one_unit([2.4e6, 1e5], "N m") == ["2.40 MN m", "0.100 MN m"]
    assert (
        format_sentence("it stays behind as with 0.1 rad of play; p = 0.008")
        == "it stays behind as with 5.7° of play"
    )
    assert (
        format_sentence("0.075 N toward 353 deg; p < 1e-6") == "0.075 N toward 353°"
        and format_sentence("2 rad/s") == "2 rad/s"
    )
    assert (
        format_probability(0.99999),
        format_probability(0.973),
        format_probability(1e-9),
        format_probability(0.004),
    ) == (
        "> 99.9 %",
        "97 %",
        "< 0.1 %",
        "0.4 %",
    )
    assert name_and_unit("toward_rad", "rad") == ("toward", "rad") and name_and_unit(
        "astern_factor"
    ) == (
        "astern factor",
        "",
    )
    assert name_and_unit("roll_Nms3") == ("roll", "N m s^3") and name_and_unit("x_Ns2pm2") == (
        "x",
        "N s^2/m^2",
    )
    assert (
        name_and_unit("cubic_perrad2")
        == name_and_unit("cubic_perrad2", "1/rad^2")
        == ("cubic", "1/rad^2")
    )
    assert name_and_unit("rate_radps") == ("rate", "rad/s") and name_and_unit("mass_kg") == (
        "mass",
        "kg",
    )
    assert name_and_unit("surge_quadratic_Ns2pm2", "N s^2/m^2") == ("surge quadratic", "N s^2/m^2")


@pytest.mark.parametrize(
    ("low", "high"), [(0.0, 80.0), (-0.3, 0.31), (1e5, 3e6), (-1e-5, 2e-5), (69.5, 130.7)]
)
def test_ticks_are_round_numbers_within_the_limits(low, high):
    found = np.array(round_ticks(low, high, 6))
    assert 3 <= len(found) <= 7 and found.min() >= low - 1e-12 and found.max() <= high * (1 + 1e-12)
    step = found[1] - found[0]
    assert np.allclose(np.diff(found), step) and round(
        step / 10 ** np.floor(np.log10(step) + 1e-9), 6
    ) in (1, 2, 5)


def test_a_long_curve_keeps_its_peaks():
    y = np.sin(np.arange(60_000) * 0.5)
    y[31_111] = 7.0
    rows = rows_of_extremes(y)
    assert (
        len(rows) < 600
        and y[rows].max() == 7.0
        and y[rows].min() == y.min()
        and rows[-1] == len(y) - 1
    )


def test_a_described_law_is_drawn_over_what_it_goes_with_and_said_to_carry_over_or_not(tmp_path):
    report.write_report(described(), tmp_path)
    page, text = ((tmp_path / f"report.{end}").read_text("utf-8") for end in ("html", "md"))
    assert "A side force, over yaw rate [rad/s]" in page and "band of 2 standard deviations" in page
    assert (
        "it is part of the corrected vessel" in text and "no part of the corrected vessel" in text
    )
    assert "1.200 ± 0.050 N s²" in text and "−15.0 ± 2.0 %" in text
    assert "| error in | before | retuned | corrected |" in text


def test_a_person_reads_before_retuned_and_corrected_and_the_keys_are_explained_once(written):
    _, html, text = written
    words = " ".join(Outline(re.sub(r"<script.*?</script>", "", html, flags=re.DOTALL)).words)
    explained = "diagnosis.json calls the three nominal, recalibrated and patched."
    for whole in (words, text):
        assert "retuned" in whole and "Before is the vessel file as given." in whole
        assert whole.count(explained) == 1
        whole = whole.replace(explained, "")
        assert not re.search(r"(?i)nominal|recalibrat|patched(?!\.toml)", whole)


def test_the_markdown_text_has_no_entities(written):
    _, _, text = written
    assert not re.search(r"&(lt|gt|amp|#\d+);", text)


def test_evidence_is_stated_as_odds_and_nats_stand_behind_an_explanation(written):
    findings, html, _ = written
    shown = re.sub(r"<details.*?</details>|<script.*?</script>", "", html, flags=re.DOTALL)
    shown = shown[: shown.index('id="reading"')]  # the glossary explains the unit
    assert not re.search(r"\d nats", shown)
    for effect in findings.answer["effects"]:
        assert "that the better fit is chance" in html
        assert f"{format_nats(effect['gain_nats'])} nats" in html


@pytest.mark.parametrize(
    ("template", "value", "sd", "inactive", "text"),
    [
        (
            "astern thrust is {share} of it",
            0.6939,
            0.0155,
            1.0,
            "astern thrust is 69 % (± 1.6) of it",
        ),
        ("{share}", 0.6939, 0.0035, 1.0, "69.4 % (± 0.35)"),
        (
            "port pushes {more}, starboard {opposite}",
            -0.08,
            0.012,
            0.0,
            "port pushes 8 % (± 1.2) less, starboard more",
        ),
        ("it is {larger}", 0.21, 0.02, 0.0, "it is 21 % (± 2.0) larger"),
        ("", 0.5, 0.1, 1.0, ""),
    ],
)
def test_a_ratio_is_said_in_per_cent_with_its_deviation(template, value, sd, inactive, text):
    assert sentence_in_per_cent(template, value, sd, inactive) == text


def test_every_sentence_in_per_cent_of_the_library_can_be_made():
    made = 0
    for name in shipped_content_names("effect"):
        for param in load_class("effect", name).params().values():
            for value in (0.5, 1.5):
                if param.in_per_cent:
                    sentence = sentence_in_per_cent(param.in_per_cent, value, 0.02, 1.0)
                    assert "%" in sentence and not re.search(r"[{}]", sentence)
                    assert param.fit and not param.unit, name
                    made += 1
    assert made > 20


def test_a_ratio_has_a_sentence_of_its_own_in_the_verdict():
    answer = planar_answer([])
    parameter = answer["effects"][0]["parameters"]["astern_factor"]
    parameter["statement"] = "astern thrust is 69 % (± 1.2) of the commanded thrust"
    assert verdict_sentences(answer).startswith(
        "The model leaves out one effect: the propellers push less astern than commanded. "
        "Astern thrust is 69 % (± 1.2) of the commanded thrust. "
    )


def test_a_cause_that_only_held_out_recordings_show_has_a_sentence_of_its_own():
    answer = unknown().answer
    answer["unknown"] = answer["unknown"] | {"held_out_only": True}
    assert verdict_sentences(answer).startswith(
        "The cause is unknown only because of the held-out recordings: the model explains the "
        "fitted recordings"
    )


def test_flags_lie_above_all_curves(tmp_path):
    report.write_report(planar(), tmp_path)
    html = (tmp_path / "report.html").read_text("utf-8")
    drawn = html[html.index('id="where"') : html.index('id="ranking"')]
    panels = re.findall(r"<svg viewBox=\"0 0 2000.*?</svg>", drawn, re.DOTALL)
    flagged = 0
    for panel in panels:
        bottoms = re.findall(r'class="flag" d="M\d+ 0H\d+V(\d+)', panel)
        curves = re.findall(r'class="(?:line|band)[^"]*" d="([^"]*)"', panel)
        heights = [int(y) for d in curves for y in re.findall(r"-?\d+ (-?\d+)", d)]
        flagged += len(bottoms)
        assert all(int(bottom) < min(heights) for bottom in bottoms)
    assert flagged == len(planar().answer["where"]["intervals"])


def test_an_experiment_that_tests_none_of_the_effects_says_so():
    f = planar()
    other = f.answer["next_experiment"] | {"separates": ["wind", "current"]}
    sections = report_sections(replace(f, answer=f.answer | {"next_experiment": other}))
    text = report.report_markdown(f, sections)
    assert "It is no test of weak reverse" in text
    assert "It is no test of" not in report.report_markdown(f, report_sections(f))


def test_a_fault_of_the_log_is_answered_with_lines_to_copy_into_recording_toml() -> None:
    findings = planar()
    fault = {
        "run": "run_1",
        "name": "heading_counterclockwise",
        "kind": "fault",
        "sure": 0.999,
        "words": "probably your log, not your boat",
        "evidence": "the heading is counted to port",
        "spans_s": [],
        "lines": ["[columns]", 'psi_rad = "-psi_rad"'],
        "alternatives": [],
    }
    first = "Probably your log, not your boat: the heading is counted to port."
    whole = f"{first} If the log is used unchanged: the model leaves out one effect."
    findings = replace(findings, answer=findings.answer | {"log": [fault], "sentence": whole})
    sections = [section for section in report_sections(findings) if section.blocks]
    html = report.report_html(findings, sections)
    assert html.count(first) == 1
    assert "Correct the log as stated below" in html.split(first)[1].split("</header>")[0]
    copied = unescape(re.search(r"<pre>(.*?)</pre>", html, re.DOTALL)[1])
    assert tomllib.loads(copied) == {"columns": {"psi_rad": "-psi_rad"}}
    assert '    [columns]\n    psi_rad = "-psi_rad"' in report.report_markdown(findings, sections)


def test_the_missing_force_is_that_of_the_vessel_as_written_with_what_is_left_beside_it() -> None:
    found = nothing()
    answer = found.answer | {"recalibration": {"adopted": True, "undetermined": [], "refitted": {}}}
    intervals = {"intervals": [{"run": "run_1", "from_s": 1.0, "to_s": 2.0, "axis": "surge"}]}
    answer["where"] = found.answer["where"] | intervals
    retuned = replace(found, answer=answer)
    table, *_, text, _, _ = missing_force_section(retuned)
    assert isinstance(table, Table) and table.caption.endswith("the vessel as written lacks")
    curves = [m.left["surge"] for m in found.missing]
    rms = float(np.sqrt(np.mean(np.concatenate(curves) ** 2)))
    at = table.header.index("left with refitted coefficients, rms")
    assert table.rows[0][at] == format_in_one_unit([0.214, rms], "N")[1]
    assert isinstance(text, Text) and "coefficients of the vessel file cause" in text.words
    assert "with refitted coefficients, the vessel model" in verdict_sentences(answer)


@pytest.mark.parametrize(("value", "text"), [(0.02, "to starboard"), (-0.02, "to port")])
def test_a_signed_value_is_stated_as_a_size_with_its_direction(value: float, text: str) -> None:
    found = planar().answer
    parameter = {"value": value, "sd": 0.004, "unit": "N"}
    effect = found["effects"][0] | {"name": "steady_force", "parameters": {"sway_N": parameter}}
    meaning = {"steady_force.sway_N": "constant side force, positive to starboard"}
    assert f"0.0200 ± 0.0040 N {text})" in verdict_sentences(found | {"effects": [effect]}, meaning)
