"""The sentences of an answer on what a diagnosis skipped.

It skips work if its computing budget is spent, and a late stage if the computation of it fails.
"""

from collections.abc import Sequence

from boatsim.view.formatting import capitalize

# what is skipped after all candidates were compared
TIME_NOT_CHOSEN = "the correlation time of the latent force was not chosen by the recordings"
NOT_SELECTED_AGAIN = (
    "the effects were not selected again with the correlation time that predicts best"
)
TERMS_NOT_SOUGHT = "further terms of the description were not sought"
EFFECTS_NOT_ADDED = "further effects were not added for predictions"
AFTER_COMPARISON = (TIME_NOT_CHOSEN, NOT_SELECTED_AGAIN, TERMS_NOT_SOUGHT, EFFECTS_NOT_ADDED)

INCOMPLETE = (
    "The search ended before it had compared all candidates, because its budget was spent; "
    "shorter recordings, or larger budgets (select.budget, work.total), complete it."
)
FAILED = " failed and was skipped: "  # between a stage and the reason
COMPARED = "All candidates were compared, but the computing budget did not suffice for more:"


def failure_statement(stage: str, error: Exception) -> str:
    """Return the statement that a late stage of a diagnosis failed, with the reason.

    Args:
        stage: The stage in words, such as "the description of the unexplained force".
        error: The error that ended it.
    """
    return f"{stage}{FAILED}{str(error) or type(error).__name__}"


def not_tried_statement(names: Sequence[str]) -> str:
    """Return the statement that candidates which are tried last were not tried.

    Args:
        names: Names of the candidates.
    """
    return f"candidates that are tried last were not tried: {', '.join(names)}"


def is_failure(statement: str) -> bool:
    """Return whether a statement of what was skipped is about a stage that failed.

    All other statements are about work for which the computing budget did not suffice.

    Args:
        statement: One of the statements of what was skipped.
    """
    return FAILED in statement


def incomplete_sentence(skipped: Sequence[str]) -> str:
    """Return the sentences that close an answer of which something was skipped.

    Args:
        skipped: Statements of what was skipped; none: the result is "".
    """
    unaffordable = [statement for statement in skipped if not is_failure(statement)]
    sentences = []
    if any(statement not in AFTER_COMPARISON for statement in unaffordable):
        sentences.append(INCOMPLETE)
    elif unaffordable:
        sentences.append(f"{COMPARED} {', and '.join(unaffordable)}.")
    for statement in skipped:
        if is_failure(statement):
            sentences.append(f"{capitalize(statement)}.")
    return " ".join(sentences)
