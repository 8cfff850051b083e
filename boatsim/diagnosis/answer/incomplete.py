"""The sentence of an answer on what a diagnosis skipped because its computing budget was spent."""

from collections.abc import Sequence

# what is skipped after all candidates were compared
TIME_NOT_CHOSEN = "the correlation time of the latent force was not chosen by the recordings"
NOT_SELECTED_AGAIN = (
    "the effects were not selected again with the correlation time that predicts best"
)
TERMS_NOT_SOUGHT = "further terms of the description were not sought"
AFTER_COMPARISON = (TIME_NOT_CHOSEN, NOT_SELECTED_AGAIN, TERMS_NOT_SOUGHT)

INCOMPLETE = (
    "The search ended before it had compared all candidates, because its budget was spent; "
    "shorter recordings, or a larger select.budget, complete it."
)
COMPARED = "All candidates were compared, but the computing budget did not suffice for more:"


def incomplete_sentence(skipped: Sequence[str]) -> str:
    """Return the sentence that closes an answer whose computing budget was spent.

    Args:
        skipped: Statements of what was skipped; none: the sentence is "".
    """
    if not skipped:
        return ""
    if any(statement not in AFTER_COMPARISON for statement in skipped):
        return INCOMPLETE
    return f"{COMPARED} {', and '.join(skipped)}."
