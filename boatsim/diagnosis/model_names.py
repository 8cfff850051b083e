"""Names of the vessel models that a diagnosis compares, and the words that a report has for them.

diagnosis.json and the code call them nominal, recalibrated and patched; a report calls them before,
retuned and corrected.
"""

from collections.abc import Iterable, Mapping

# models that are compared, and the nominal one refitted to a part of the data alone
MODELS = ("nominal", "recalibrated", "patched")
ALONE = "alone"
MODEL_WORDS: Mapping[str, str] = {
    "recorded": "recorded",
    "nominal": "before",  # the vessel file as given
    "recalibrated": "retuned",  # its own coefficients refitted
    "patched": "corrected",  # with the identified effects as well
}


def model_names_in_words(models: Iterable[str]) -> list[str]:
    """Return the words by which a reader knows these vessel models.

    Args:
        models: Keys of diagnosis.json, such as "recalibrated".
    """
    return [MODEL_WORDS[model] for model in models]
