"""Documented faults count as reported only where a statement on their own set names them."""

import re

import pytest

from validation.real.documented import (
    ABSENT,
    CONTAINED,
    STATED,
    Fact,
    documented_facts,
    how_reported,
    main,
    statements_of,
)

ANSWER = (
    "A force is missing. The corrected vessel contains “a spring of the rig”: held-out recordings "
    "confirm it, but it may stand in for another cause. For predictions, the corrected vessel also "
    "contains “a steady wind”: simulations get better by it."
)


@pytest.mark.parametrize(
    ("words", "outputs", "expected"),
    [
        ("force is missing", [("pond", ANSWER)], STATED),
        ("spring", [("pond", ANSWER)], CONTAINED),
        ("steady wind", [("pond", ANSWER)], CONTAINED),
        ("current", [("pond", ANSWER)], ABSENT),
        ("force is missing", [("lake", ANSWER)], ABSENT),
        ("spring", [("pond", ANSWER), ("pond", "log, a.csv: spring (mended): it is held")], STATED),
    ],
)
def test_a_fact_is_reported_as_surely_as_the_statement_that_names_it(
    words: str, outputs: list[tuple[str, str]], expected: str
) -> None:
    fact = Fact("pond", "something", "README", (words,))
    assert how_reported(fact, outputs) == expected


def test_an_answer_is_divided_into_sentences_and_numbers_stay_whole() -> None:
    assert statements_of("It is 0.5 m/s (of 2). In yaw it turns. 3.2 m are left") == [
        "It is 0.5 m/s (of 2).",
        "In yaw it turns. 3.2 m are left",
    ]


def test_the_list_names_only_sets_of_the_protocol_and_has_no_fact_twice() -> None:
    facts = documented_facts()
    with open("docs/protocol.md", encoding="utf-8") as page:
        protocol = page.read()
    for fact in facts:
        assert f"| `{fact.set}` |" in protocol
        assert fact.words
        assert all(re.compile(words) for words in fact.words)
    assert len({(fact.set, fact.says) for fact in facts}) == len(facts)


def test_the_command_prints_shares_of_the_given_sets(tmp_path, capsys) -> None:
    file = tmp_path / "out.txt"
    file.write_text("The model leaves out one effect: dry friction of bearings opposes the motion.")
    main([f"torque_pendulum={file}"])
    printed = capsys.readouterr().out
    assert "| `torque_pendulum` | friction, and of which law |" in printed
    assert "torque_pendulum: 1 of 4 stated, 0 in the corrected vessel, 25% together" in printed
    assert "holohover" not in printed
