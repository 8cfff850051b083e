"""The report of a diagnosis: an HTML page and the same text as Markdown, from the same sections."""

from collections.abc import Sequence
from pathlib import Path

from boatsim.diagnosis.checks.finding import LOG_NOT_BOAT
from boatsim.diagnosis.report.blocks import Section, as_text, safe
from boatsim.diagnosis.report.described_terms import what_of
from boatsim.diagnosis.report.findings import Findings
from boatsim.diagnosis.report.formatting import capital, listed, plain
from boatsim.diagnosis.report.html_page import TEMPLATES, rendered
from boatsim.diagnosis.report.replay_section import replay
from boatsim.diagnosis.report.sections import sections_of
from boatsim.diagnosis.report.sentences import (
    any_tested,
    mean_force,
    only_measurement_errors,
    proof,
    sentence,
)
from boatsim.files import replacing

VERDICTS = {  # verdict of the answer -> words at the top of the report
    "named": "Effect identified",
    "ambiguous": "Effect identified, with look-alikes",
    "described": "Described by a formula",
    "unknown": "Cause outside the candidates",
    "nothing_missing": "Nothing missing",
}
LOG_PROBLEM = "Probably the log"  # a certain problem of the whole recording
NONE_TESTED = "Something missing, no candidates tested"
MEASUREMENT_ERROR = "Measurement error"  # all identified effects are errors of measurement
LONGEST_HEADLINE = 200  # characters; a longer sentence is not used as the headline


def write(findings: Findings, folder: Path) -> None:
    """Write report.html (one page that fetches nothing) and report.md (the same text).

    Args:
        findings: Findings of a diagnosis.
        folder: Folder of the two files.

    Raises:
        OSError: The files cannot be written; existing reports remain unchanged.
    """
    sections = [s for s in sections_of(findings) if s.blocks]
    texts = {"report.html": page(findings, sections), "report.md": markdown(findings, sections)}
    for name, text in texts.items():
        with replacing(folder / name) as temporary:
            temporary.write_text(text, encoding="utf-8")


def page(findings: Findings, sections: Sequence[Section]) -> str:
    """Return the HTML page.

    Args:
        findings: Findings of a diagnosis.
        sections: Its sections that have content.
    """
    return rendered(
        TEMPLATES / "report.html.j2",
        f=findings,
        verdict=_verdict(findings),
        answer=findings.answer,
        headline=_headline(findings),
        sentence=_sentence(findings),
        sections=sections,
        proof=proof(findings),
        facts=_facts(findings),
        mean_force=mean_force(findings.answer, findings.patched),
        replay=replay(findings),
    )


def markdown(findings: Findings, sections: Sequence[Section]) -> str:
    """Return the report as Markdown.

    Args:
        findings: Findings of a diagnosis.
        sections: Its sections that have content.
    """
    headline, whole = _headline(findings), _sentence(findings)
    lines = [f"# {safe(headline)}", ""]
    if whole != headline:
        lines += [safe(whole), ""]
    lines += [f"**{_verdict(findings)}.** {safe(proof(findings))}", ""]
    for paragraph in mean_force(findings.answer, findings.patched):
        lines += [safe(paragraph), ""]
    for name, value in _facts(findings):
        lines.append(f"- {name}: {safe(value)}")
    for section in sections:
        lines += ["", f"## {section.title}"]
        for block in section.blocks:
            lines += as_text(block)
    return "\n".join(lines) + "\n"


def _headline(f: Findings) -> str:
    """Return the sentence of the answer, or only names of effects and forces where it is long."""
    whole = _sentence(f)
    if _log_problem(f):
        return f"{whole.partition('. ')[0]}."
    if len(whole) <= LONGEST_HEADLINE:
        return whole
    if names := [plain(e["name"]) for e in f.answer["effects"]]:
        rest = ""
        if f.answer["unknown"]["flag"]:
            rest = ", and a force that they do not explain"
        return f"{capital(listed(names))}{rest}."
    forces: list[str] = []
    for law in f.answer["described"]:
        force = what_of(law["axis"])
        if force not in forces:
            forces.append(force)
    if not forces:
        return whole
    return f"{capital(listed(forces))} that no candidate effect explains."


def _sentence(f: Findings) -> str:
    return f.answer["sentence"] or sentence(f.answer, f.words)


def _log_problem(f: Findings) -> bool:
    """Return whether the answer begins with a certain problem of the whole recording."""
    return f.answer["sentence"].startswith(capital(LOG_NOT_BOAT))


def _verdict(f: Findings) -> str:
    """Return the verdict in a few words."""
    verdict = f.answer["verdict"]
    if _log_problem(f):
        return LOG_PROBLEM
    if verdict == "unknown" and not any_tested(f.answer):
        return NONE_TESTED
    if only_measurement_errors(f.answer):
        return MEASUREMENT_ERROR
    return VERDICTS[verdict]


def _facts(f: Findings) -> list[tuple[str, str]]:
    """Return vessel, fitted and held-out recordings, and version."""
    return [
        ("Vessel", f.vessel),
        ("Fitted to", listed(f.runs)),
        ("Held out", f.held_out_note or listed(f.held_out) or "nothing"),
        ("Version", f"boatsim {f.answer['version']}"),
    ]
