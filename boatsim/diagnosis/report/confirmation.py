"""Words for what held-out recordings show: of each effect, and of the refitted coefficients."""

from collections.abc import Mapping, Sequence

from boatsim.diagnosis.answer.confirmation import error_changes
from boatsim.diagnosis.answer.families import FAMILIES
from boatsim.diagnosis.answer.findings import Findings
from boatsim.diagnosis.answer.schema import EffectEntry, Family
from boatsim.view.formatting import (
    format_in_one_unit,
    join_words,
    name_in_words,
)

# Delay of a sensor -> its columns
LATE_COLUMNS = {
    "late_fixes": ("x_m", "y_m"),
    "heading_delay": ("psi_rad",),
    "roll_delay": ("phi_rad",),
    "pitch_delay": ("theta_rad",),
    "heave_delay": ("z_m",),
}
OPEN = (
    "Held-out recordings neither confirm nor contradict it: they are too short, do not excite it, "
    "or require it only if other numbers of the vessel change too."
)


def effect_sentences(effect: EffectEntry) -> list[str]:
    """Return sentences on how an identified effect changes the errors on held-out recordings.

    They also say whether these recordings confirm the effect.

    Args:
        effect: Entry of an identified effect.
    """
    found = []
    if changes := error_changes(effect.get("alone", {})):
        found.append(f"On held-out data adding it {join_words(changes)}.")
    if not effect.get("confirmed", True):
        found.append(OPEN)
    if effect["name"] in LATE_COLUMNS:
        found.append(_latency_line(effect))
    return found


def _latency_line(effect: EffectEntry) -> str:
    """The lines of recording.toml that remove the delay of a sensor."""
    [delay] = effect["parameters"].values()
    columns = LATE_COLUMNS[effect["name"]]
    lines = " / ".join(f"{column} = {delay['value']:.3g}" for column in columns)
    return f"Write into recording.toml: [latency] / {lines}"


def recalibration_sentences(f: Findings) -> list[str]:
    """Return sentences on coefficients that keep their values and effects that are not adopted.

    Args:
        f: Findings of a diagnosis.
    """
    found = f.answer.get("recalibration")
    if found is None:
        return []
    sentences = []
    if not found["adopted"]:
        sentences += _not_adopted(f, found["refitted"])
    elif found["undetermined"]:
        sentences.append(
            "The retuned vessel keeps these numbers of the vessel file, because the recordings do "
            "not determine them well enough: "
            f"{join_words(_grouped_names(found['undetermined']))}."
        )
    if found.get("by_free_runs") or f.answer.get("by_free_runs"):
        sentences.append(_fitted_to_free_runs(f))
    possible = f.answer.get("also_possible", [])
    dropped = [name_in_words(e["name"]) for e in possible if e.get("in_patch") is False]
    if dropped and f.answer.get("by_free_runs"):
        sentences.append(
            f"It does not have {join_words(dropped)}: simulations are at least as good without "
            f"{'it' if len(dropped) == 1 else 'them'}."
        )
    elif dropped:
        sentences.append(
            "The corrected vessel is the retuned one: it would predict the held-out recordings "
            f"worse with what is also possible ({join_words(dropped)})."
        )
    return sentences


def _fitted_to_free_runs(f: Findings) -> str:
    """Return the sentence on the vessels whose numbers were fitted to simulations."""
    vessels = []
    if f.answer.get("recalibration", {}).get("by_free_runs"):
        vessels.append("retuned")
    if f.answer.get("by_free_runs"):
        vessels.append("corrected")
    return (
        f"Because the cause of a force is unknown, the numbers of the {join_words(vessels)} vessel "
        "were fitted to simulations of the fitted recordings with the recorded commands alone; "
        "held-out recordings are predicted better so."
    )


def _not_adopted(f: Findings, refitted: Mapping[Family, float]) -> list[str]:
    """Return the sentences on coefficients that would be worse on held-out data."""
    errors = []
    for family, (words, unit) in FAMILIES.items():
        if family in refitted and family in f.answer["fit"]:
            pair = [f.answer["fit"][family]["nominal"], refitted[family]]
            before, after = format_in_one_unit(pair, unit)
            errors.append(f"{after} in {words} instead of {before}")
    sentences = [
        "The retuned vessel has the coefficients of the vessel file, because refitted ones are "
        f"worse on held-out data: {join_words(errors)}."
    ]
    if f.has_added_effects:
        sentences.append("The corrected vessel has coefficients fitted together with its effects.")
    return sentences


def _grouped_names(coefficients: Sequence[str]) -> list[str]:
    """Return coefficients by the effect that has them, such as surge drag (linear, quadratic)."""
    by_effect: dict[str, list[str]] = {}
    for name in coefficients:
        effect, _, key = name.rpartition(".")
        by_effect.setdefault(effect, []).append(name_in_words(key))
    groups = []
    for effect, keys in by_effect.items():
        if effect:
            groups.append(f"{name_in_words(effect)} ({', '.join(keys)})")
        else:
            groups += keys
    return groups
