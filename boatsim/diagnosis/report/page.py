"""The report of a diagnosis for people: one page and the same as plain text, made from one list of sections."""

from collections.abc import Sequence
from pathlib import Path

from boatsim.diagnosis.checks.finding import LOG_NOT_BOAT
from boatsim.diagnosis.report import mean_force_section
from boatsim.diagnosis.report.blocks import Section, as_text, safe
from boatsim.diagnosis.report.findings import Findings
from boatsim.diagnosis.report.formatting import capital, listed, plain, sentence, tried
from boatsim.diagnosis.report.html_page import TEMPLATES, rendered
from boatsim.diagnosis.report.replay_section import replay
from boatsim.diagnosis.report.sections import proof, sections_of
from boatsim.files import replacing

__all__ = ["sentence", "write"]

VERDICTS = {
    "named": "Named",
    "ambiguous": "Named, with look-alikes",
    "described": "Described: a law that is not in the library",
    "unknown": "Cause not in the library",
    "nothing_missing": "Nothing missing",
}


LOG_FIRST = "Probably the log"  # if what is wrong with it is certain and of all of it
LONG = 200  # characters from which a sentence is no headline
UNTRIED = "Something missing, nothing tried"
NOT_PHYSICS = "Measurement, not physics"  # if all that was named is of that kind


def write(findings: Findings, folder: Path) -> None:
    """Write report.html (one page, nothing fetched) and report.md (the same in text). Raises OSError."""
    sections = [s for s in sections_of(findings) if s.blocks]
    for name, text in (
        ("report.html", page(findings, sections)),
        ("report.md", markdown(findings, sections)),
    ):
        with replacing(folder / name) as temporary:
            temporary.write_text(text, encoding="utf-8")


def page(findings: Findings, sections: Sequence[Section]) -> str:
    """The page, complete in itself."""
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
        stays=mean_force_section.in_words(findings.answer, findings.patched),
        replay=replay(findings),
    )


def markdown(findings: Findings, sections: Sequence[Section]) -> str:
    """The same as text."""
    title, whole = _headline(findings), _sentence(findings)
    lines = [f"# {safe(title)}", "", *([safe(whole), ""] if whole != title else [])]
    lines += [f"**{_verdict(findings)}.** {safe(proof(findings))}", ""]
    for line in mean_force_section.in_words(findings.answer, findings.patched):
        lines += [safe(line), ""]
    lines += [f"- {name}: {safe(value)}" for name, value in _facts(findings)]
    for section in sections:
        lines += ["", f"## {section.title}"]
        for block in section.blocks:
            lines += as_text(block)
    return "\n".join(lines) + "\n"


def _headline(f: Findings) -> str:
    """The sentence of the answer, or the names alone where that would be a paragraph."""
    said = _sentence(f)
    if said.startswith(capital(LOG_NOT_BOAT)):
        return f"{said.partition('. ')[0]}."
    names = [plain(e["name"]) for e in f.answer["effects"]]
    if len(said) <= LONG or not names:
        return said
    rest = "; more is missing than these explain" if f.answer["unknown"]["flag"] else ""
    return f"{capital(listed(names))}{rest}."


def _sentence(f: Findings) -> str:
    return str(f.answer["sentence"]) or sentence(f.answer, f.words)


def _verdict(f: Findings) -> str:
    """The verdict in a word or two."""
    effects, verdict = f.answer["effects"], f.answer["verdict"]
    if str(f.answer["sentence"]).startswith(capital(LOG_NOT_BOAT)):
        return LOG_FIRST
    if verdict == "unknown" and not tried(f.answer):
        return UNTRIED
    measured = verdict == "named" and all(e["kind"] == "measurement" for e in effects)
    return NOT_PHYSICS if measured else VERDICTS[verdict]


def _facts(f: Findings) -> list[tuple[str, str]]:
    """Who, on what, how long."""
    return [
        ("Vessel", f.vessel),
        ("Fitted to", listed(f.runs)),
        (
            "Kept unseen",
            f.held_out_note.removeprefix("kept unseen: ") or listed(f.held_out) or "nothing",
        ),
        ("Made by", f"boatsim {f.answer['version']}"),
    ]
