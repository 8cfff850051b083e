"""Which documented faults are reported: `python -m validation.real.documented SET=OUTPUT...`.

Each OUTPUT is a text file with what a command on a SET printed, such as that of
`python -m validation.real.holohover runs > holohover.txt 2>&1`. `documented.toml` lists what the
authors of the sets document as wrong or missing. It follows the READMEs; those who wrote it knew
the answers. A fact counts as reported if one statement of the outputs of its set matches it:

- stated: by an import, a check of the log, a named effect or a refined number,
- in the corrected vessel: as an effect that held-out recordings confirm, or that was added for
  predictions; the answer says that such an effect may stand in for another cause.
"""

import argparse
import re
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

LIST = Path(__file__).with_name("documented.toml")
# words of lines that report nothing
NO_REPORT = ("held out: ", "nothing wrong", "columns not used", "candidate effects tested", "s CPU")
# words of the sentences on effects that are no statement about causes
NOT_SURE = ("stand in for", "For predictions")
STATED, CONTAINED, ABSENT = "stated", "in the corrected vessel", "not reported"


class Fact(NamedTuple):
    """Something that the source of a set documents.

    Attributes:
        set: Name of the set of recordings.
        says: What is wrong or missing.
        source: Where the source says it.
        words: Regular expressions of statements that report it.
    """

    set: str
    says: str
    source: str
    words: tuple[str, ...]


def documented_facts() -> list[Fact]:
    """Return the documented facts of all sets, in the order of the list."""
    found = []
    for entry in tomllib.loads(LIST.read_text(encoding="utf-8"))["fact"]:
        found.append(Fact(entry["set"], entry["says"], entry["source"], tuple(entry["words"])))
    return found


def statements_of(output: str) -> list[str]:
    """Return the statements of one output: its lines, the sentences of an answer one by one."""
    found = list[str]()
    for line in output.splitlines():
        found += re.split(r"(?<=\.) (?=[A-Z])", line.strip())
    return found


def how_reported(fact: Fact, outputs: Sequence[tuple[str, str]]) -> str:
    """Return how sure the outputs of the set of a fact report it.

    Args:
        fact: The documented fact.
        outputs: Set and printed output of commands.
    """
    how = ABSENT
    for name, output in outputs:
        if name != fact.set:
            continue
        for statement in statements_of(output):
            if any(words in statement for words in NO_REPORT):
                continue
            if any(re.search(words, statement) for words in fact.words):
                if not any(words in statement for words in NOT_SURE):
                    return STATED
                how = CONTAINED
    return how


def print_report(facts: Sequence[Fact], reported: Mapping[Fact, str]) -> None:
    """Print one row for each fact, and how many are reported in each set and in all."""
    for fact in facts:
        print(f"| `{fact.set}` | {fact.says} | {fact.source} | {reported[fact]} |")
    for name in [*dict.fromkeys(fact.set for fact in facts), None]:
        own = [reported[fact] for fact in facts if name in (None, fact.set)]
        stated, contained = own.count(STATED), own.count(CONTAINED)
        print(
            f"{name or 'all'}: {stated} of {len(own)} stated, {contained} in the corrected vessel, "
            f"{(stated + contained) / len(own):.0%} together"
        )


def main(arguments: Sequence[str] | None = None) -> None:
    """Print which documented facts the given outputs report."""
    parser = argparse.ArgumentParser(description="Documented faults that the diagnosis reports")
    parser.add_argument("outputs", nargs="+", metavar="SET=OUTPUT", help="text file of a set")
    known = list(dict.fromkeys(fact.set for fact in documented_facts()))
    outputs = list[tuple[str, str]]()
    for text in parser.parse_args(arguments).outputs:
        name, _, file = text.partition("=")
        if name not in known or not file:
            parser.error(f"{text}: allowed is SET=OUTPUT with a set of {', '.join(known)}")
        outputs.append((name, Path(file).read_text(encoding="utf-8")))
    sets = {name for name, _ in outputs}
    facts = [fact for fact in documented_facts() if fact.set in sets]
    print_report(facts, {fact: how_reported(fact, outputs) for fact in facts})


if __name__ == "__main__":
    main()
