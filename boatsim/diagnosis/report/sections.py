"""Sections of the report of a diagnosis."""

import math
from collections.abc import Iterator, Sequence
from itertools import repeat

from boatsim.diagnosis.answer.findings import Findings
from boatsim.diagnosis.answer.log_entry import alternative_correction_lines
from boatsim.diagnosis.answer.schema import (
    LogEntry,
)
from boatsim.diagnosis.answer.verdict import reason_none_tested, tested_any_candidate
from boatsim.diagnosis.report.candidate_sections import (
    candidate_ranking_section,
    limits_of_effects_not_found,
    upper_limits_section,
)
from boatsim.diagnosis.report.effect_sections import (
    added_effects_section,
    identified_effect_sections,
    possible_effects_section,
    refined_numbers_section,
    unexplained_force_section,
)
from boatsim.diagnosis.report.experiment_section import next_experiment_section
from boatsim.diagnosis.report.force_section import missing_force_section
from boatsim.diagnosis.report.glossary import glossary
from boatsim.diagnosis.report.sentences import assumption_sentences
from boatsim.diagnosis.report.validation_section import validation_section
from boatsim.view.formatting import (
    capitalize,
    format_probability,
    format_sentence,
    format_with_sd,
    join_words,
    name_in_words,
)
from boatsim.view.page_blocks import (
    Block,
    FileLines,
    Heading,
    Items,
    Section,
    Table,
    Text,
)


def report_sections(f: Findings) -> list[Section]:
    """Return all sections of the report of a diagnosis, in their order.

    Args:
        f: Findings of a diagnosis.

    Returns:
        The sections; those without content have no blocks.
    """
    return [
        Section("log", "Problems of the recordings", list(_log_problems(f))),
        Section("what", "Missing physics", list(_missing_physics(f))),
        Section("refined", "Numbers refined", list(refined_numbers_section(f))),
        Section("possible", "Also possible", list(possible_effects_section(f))),
        Section("added", "Added for predictions", list(added_effects_section(f))),
        Section("taken", "Candidates and assumptions", list(_assumptions(f))),
        Section("where", "Where and when a force is missing", list(missing_force_section(f))),
        Section("ranking", "Ranking of the candidate effects", list(candidate_ranking_section(f))),
        Section("proof", "Validation on held-out recordings", list(validation_section(f))),
        Section("next", "What to record next", list(next_experiment_section(f))),
        Section("cannot", "What these recordings cannot show", list(_limitations(f))),
        Section(
            "limits", "Upper limits of effects that were not found", list(upper_limits_section(f))
        ),
        Section("coefficients", "Coefficients of the model", list(_coefficients(f))),
        Section("files", "Files", list(_files(f))),
        Section("reading", "How to read this report", [Items(glossary(f))]),
    ]


def _log_problems(f: Findings) -> Iterator[Block]:
    """Yield the problems of the recordings with their corrections, and the measurement errors."""
    for e in f.answer.get("log", ()):
        cause = e.get("words", "corrected or allowed for by the diagnosis")
        facts = f"{f.recording_name(e['run'])} · {cause}"
        if e["kind"] != "unchecked":
            facts += f" · probability {format_probability(e['sure'])}"
        yield Heading(capitalize(name_in_words(e["name"])), facts)
        yield Text(f"{capitalize(e['evidence'])}.")
        yield from _corrections(e)
        if "remedy" in e:
            yield Text(f"{capitalize(e['remedy'])}.")
    yield from identified_effect_sections(f, "measurement")


def _corrections(e: LogEntry) -> Iterator[Block]:
    if e["lines"]:
        yield FileLines("Write into recording.toml", tuple(e["lines"]))
    for other in e["alternatives"]:
        yield FileLines(
            f"Or, if {other['words']}", tuple(alternative_correction_lines(other["lines"]))
        )


def _missing_physics(f: Findings) -> Iterator[Block]:
    """Yield the effects that the model lacks, the formulas, and what remains unexplained."""
    yield from identified_effect_sections(f, "physics")
    unknown = f.answer["unknown"]
    if not tested_any_candidate(f.answer):
        yield Text(f"{capitalize(reason_none_tested(f.answer))}.")
    elif unknown["flag"]:
        yield from unexplained_force_section(f)
    elif not f.answer["effects"]:
        yield Text(
            "No candidate effect explains the recordings clearly better than the vessel model "
            "alone. The upper limits below state how strong each effect could be at most."
        )


def _assumptions(f: Findings) -> Iterator[Block]:
    lines = []
    for line in assumption_sentences(f.answer):
        lines.append(f"{capitalize(line)}.")
    yield from _bullets(lines)


def _bullets(lines: Sequence[str]) -> Iterator[Block]:
    if lines:
        yield Items(tuple(zip(repeat(""), lines)))


def _coefficients(f: Findings) -> Iterator[Block]:
    """Yield the factors on the coefficients of the vessel file, on request."""
    rows, corrected = [], f.corrected_coefficients if f.has_added_effects else {}
    refined = {entry["name"] for entry in f.answer.get("refined", ())}
    for name, value in f.coefficients.items():
        if name in refined:  # in the table of refined numbers
            continue
        row = [name_in_words(name.replace(".", ", ")), _factor(*value)]
        if corrected:
            row.append(_factor(*corrected[name]) if name in corrected else "")
        rows.append(row)
    if not rows:
        return
    caption = "Factors on the coefficients of the vessel file, and the change"
    header = ["coefficient", "retuned"]
    if corrected:
        header.append("corrected")
    yield Table(caption, header, rows, folded=True)
    if corrected:
        yield Text(
            "The retuned vessel has none of the effects and formulas above, so that its "
            "coefficients make up for them as far as they can. Those of the corrected vessel were "
            "fitted together with the effects; patched.toml contains them."
        )


def _factor(factor: float, sd: float) -> str:
    """Return a factor with its deviation, and the change in per cent."""
    change = f"{100 * (factor - 1):+.1f} %".replace("-", "−")
    return f"{format_with_sd(factor, sd)} ({change})"


def _limitations(f: Findings) -> Iterator[Block]:
    """Yield what the recordings cannot show."""
    lines = []
    close = f.setting("select.alike")
    for e in f.answer["effects"]:
        if e["tied_with"]:
            causes = join_words(map(name_in_words, (e["name"], *e["tied_with"])), "or")
            lines.append(
                f"Whether the cause is {causes}: they explain these recordings about equally well "
                f"(one at most {math.exp(close):.0f} times as probable as another)."
            )
    if not f.answer["fit"].get("held_out"):
        lines.append("Whether the finding holds on other data: no recording was held out.")
    unlimited = []
    lower = f.answer.get("lower_limits", {})
    for name, limits in limits_of_effects_not_found(f).items():
        if not limits and name not in lower:
            unlimited.append(name_in_words(name))
    if unlimited:
        lines.append(
            f"How strong {join_words(unlimited, 'or')} could be at most: "
            "no limit could be computed."
        )
    lines += map(format_sentence, f.remarks)
    yield from _bullets(lines)


def _files(f: Findings) -> Iterator[Block]:
    lines = {"diagnosis.json": "All results as data."}
    if patch := f.answer["patch"]:
        lines[patch] = (
            "The corrected vessel, with retuned coefficients and the identified effects. boatsim "
            f"manoeuvre, replay and diagnose read it with --vessel {patch}, a scenario with "
            f'vessel = "{patch}".'
        )
    if wanted := f.answer["next_experiment"]:
        lines[wanted["scenario"]] = "The manoeuvre to record next, as a scenario for boatsim run."
    lines["diagnosis.rrd"] = (
        "The recording and the vessel before, retuned and corrected, in one scene of the rerun "
        "viewer."
    )
    yield Items(tuple(lines.items()))
