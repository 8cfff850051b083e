"""The report of a diagnosis: an HTML page and the same text as Markdown, from the same sections."""

from collections.abc import Sequence
from pathlib import Path

from boatsim.diagnosis.answer.described_terms import axis_force_words
from boatsim.diagnosis.answer.findings import Findings
from boatsim.diagnosis.answer.formulas import is_stated
from boatsim.diagnosis.answer.verdict import (
    blames_log,
    finds_only_measurement_errors,
    tested_any_candidate,
    verdict_sentences,
)
from boatsim.diagnosis.report.replay_section import animated_replay
from boatsim.diagnosis.report.sections import report_sections
from boatsim.diagnosis.report.sentences import held_out_improvement_sentence, mean_force_paragraph
from boatsim.diagnosis.report.what_if import (
    LAYOUT_BYTES,
    SCRIPT,
    TOO_LARGE,
    WhatIf,
    template_values,
    within_size,
)
from boatsim.files import replace_file
from boatsim.view.formatting import capitalize, first_sentence, join_words, name_in_words
from boatsim.view.html_page import render_template
from boatsim.view.page_blocks import Section, escape_markup, markdown_lines
from boatsim.webassembly.packing import LOADER, MOST_BYTES

TEMPLATE = Path(__file__).parent / "templates" / "report.html.j2"
VERDICTS = {  # verdict of the answer -> words at the top of the report
    "named": "Effect identified",
    "ambiguous": "Effect identified, with look-alikes",
    "described": "Described by a formula",
    "unknown": "Cause outside the candidates",
    "nothing_missing": "Nothing missing",
}
LOG_PROBLEM = "Probably the log"  # a certain problem of the whole recording
NONE_TESTED = "Something missing, no candidates tested"
REFINED = "No physics missing, numbers refined"  # only numbers of a rough model were improved
MEASUREMENT_ERROR = "Measurement error"  # all identified effects are errors of measurement
CORRECT_FIRST = "Correct the log as stated below, then diagnose it again."
LONGEST_HEADLINE = 200  # characters; a longer sentence is not used as the headline


def write_report(findings: Findings, folder: Path, what_if: WhatIf | None = None) -> None:
    """Write the report of a diagnosis as report.html (one self-contained page) and as report.md.

    Args:
        findings: Findings of a diagnosis.
        folder: Folder of the two files.
        what_if: Content of the section of report.html that repeats free runs; None for none.

    Raises:
        OSError: The files cannot be written; existing reports remain unchanged.
    """
    sections = [s for s in report_sections(findings) if s.blocks]
    texts = {
        "report.html": report_html(findings, sections, what_if),
        "report.md": report_markdown(findings, sections),
    }
    for name, text in texts.items():
        with replace_file(folder / name) as temporary:
            temporary.write_text(text, encoding="utf-8")


def report_html(
    findings: Findings, sections: Sequence[Section], what_if: WhatIf | None = None
) -> str:
    """Return the report of a diagnosis as an HTML page.

    Args:
        findings: Findings of a diagnosis.
        sections: Sections of the report that have content.
        what_if: Content of the section that repeats free runs; None for none. As many free runs of
            it are shown as keep the page below `MOST_BYTES`.
    """
    script, values, note = "", None, ""
    if what_if is not None:
        size = len(report_html(findings, sections).encode())
        shown = within_size(what_if, MOST_BYTES - size - LAYOUT_BYTES)
        if shown is None:
            note = TOO_LARGE
        else:
            script = "".join(part.read_text(encoding="utf-8") for part in (LOADER, SCRIPT))
            values = template_values(shown, sum(len(one.starts) for one in what_if.recordings))
    return render_template(
        TEMPLATE,
        script,
        what_if=values,
        what_if_note=note,
        f=findings,
        verdict=_verdict(findings),
        answer=findings.answer,
        headline=_headline(findings),
        lead=_lead(findings),
        sections=sections,
        proof=held_out_improvement_sentence(findings),
        facts=_facts(findings),
        mean_force=mean_force_paragraph(findings.answer, findings.has_added_effects),
        replay=animated_replay(findings),
    )


def report_markdown(findings: Findings, sections: Sequence[Section]) -> str:
    """Return the report of a diagnosis as Markdown text.

    Args:
        findings: Findings of a diagnosis.
        sections: Sections of the report that have content.
    """
    lines = [f"# {escape_markup(_headline(findings))}", ""]
    if lead := _lead(findings):
        lines += [escape_markup(lead), ""]
    lines += [
        f"**{_verdict(findings)}.** {escape_markup(held_out_improvement_sentence(findings))}",
        "",
    ]
    for paragraph in mean_force_paragraph(findings.answer, findings.has_added_effects):
        lines += [escape_markup(paragraph), ""]
    for name, value in _facts(findings):
        lines.append(f"- {name}: {escape_markup(value)}")
    for section in sections:
        lines += ["", f"## {section.title}"]
        for block in section.blocks:
            lines += markdown_lines(block)
    return "\n".join(lines) + "\n"


def _headline(f: Findings) -> str:
    """Return the answer, or names of effects and forces or its first sentence where it is long."""
    whole = _sentence(f)
    if blames_log(f.answer):
        return first_sentence(whole)
    if len(whole) <= LONGEST_HEADLINE:
        return whole
    if names := [name_in_words(e["name"]) for e in f.answer["effects"]]:
        rest = ""
        if f.answer["unknown"]["flag"]:
            subject = "they do" if len(names) > 1 else "it does"
            rest = f", and a force that {subject} not explain"
        return f"{capitalize(join_words(names))}{rest}."
    forces: list[str] = []
    for law in f.answer["described"]:
        force = axis_force_words(law["axis"])
        if force not in forces and is_stated(f.answer, law):
            forces.append(force)
    if not forces:
        return first_sentence(whole)
    return f"{capitalize(join_words(forces))} that no candidate effect explains."


def _lead(f: Findings) -> str:
    """Return the paragraph below the headline; "" if the headline has all of the answer."""
    headline, whole = _headline(f), _sentence(f)
    if whole == headline:
        return ""
    rest = whole.removeprefix(headline).strip()
    return f"{CORRECT_FIRST} {rest}" if blames_log(f.answer) else rest


def _sentence(f: Findings) -> str:
    return f.answer["sentence"] or verdict_sentences(f.answer, f.words)


def _verdict(f: Findings) -> str:
    """Return the verdict in a few words."""
    verdict = f.answer["verdict"]
    if blames_log(f.answer):
        return LOG_PROBLEM
    if verdict == "unknown" and not tested_any_candidate(f.answer):
        return NONE_TESTED
    if finds_only_measurement_errors(f.answer):
        return MEASUREMENT_ERROR
    if verdict == "nothing_missing" and f.answer.get("refined"):
        return REFINED
    return VERDICTS[verdict]


def _facts(f: Findings) -> list[tuple[str, str]]:
    """Return vessel, fitted and held-out recordings, and version."""
    return [
        ("Vessel", f.vessel),
        ("Fitted to", join_words(f.runs)),
        ("Held out", f.held_out_note or join_words(f.held_out) or "nothing"),
        ("Version", f"boatsim {f.answer['version']}"),
    ]
