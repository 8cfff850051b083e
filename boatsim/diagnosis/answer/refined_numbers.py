"""Refined numbers of the vessel file in words: before, after, and the one that matters most."""

from boatsim.diagnosis.answer.findings import setting_of
from boatsim.diagnosis.answer.schema import Answer, RefinedEntry
from boatsim.view.formatting import format_quantity

NOT_IN_FILE = "not in the file"  # change of a number that the vessel file does not have


def refined_number_rows(answer: Answer) -> list[list[str]]:
    """Return the rows of the report's table of refined numbers of the vessel file.

    A refined number is an estimate of the vessel file to which the recordings give a better value.

    Args:
        answer: Content of diagnosis.json.

    Returns:
        For each number: its words, its value before and after, and the relative change.
    """
    rows = []
    for entry in answer.get("refined", []):
        before, after = _before_and_after(entry)
        off = NOT_IN_FILE
        if entry["off"] is not None:
            off = f"{100.0 * entry['off']:+.0f} %".replace("-", "−")
        rows.append([entry["number"], before, after, off])
    return rows


def main_refinement(answer: Answer) -> str:
    """Return the refined number with the most evidence, with its values, or "" if none is sure.

    It must belong to an identified effect that held-out data confirm and whose probability would
    suffice for a name.

    Args:
        answer: Content of diagnosis.json.
    """
    least = setting_of(answer, "decide.least_probability")
    best: RefinedEntry | None = None
    for entry in answer.get("refined", []):
        if not entry.get("confirmed") or entry.get("probability", 0.0) < least:
            continue
        if best is None or entry["gain_nats"] > best["gain_nats"]:
            best = entry
    if best is None:
        return ""
    before, after = _before_and_after(best)
    if best["before"] != 0.0:
        after = f"{after} instead of {before}"
    return f"{best['number']} ({after})"


def _before_and_after(entry: RefinedEntry) -> tuple[str, str]:
    """Both values of a refined number, in one unit."""
    largest = max(abs(entry["before"]), abs(entry["after"]))
    before = format_quantity(entry["before"], entry["unit"], largest=largest)
    if entry["before"] == 0.0:
        before = "0"
    return before, format_quantity(entry["after"], entry["unit"], entry["sd"], largest=largest)
