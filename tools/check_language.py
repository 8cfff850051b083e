#!/usr/bin/env python3
"""Check that the code and the documentation stay readable.

    python tools/check_language.py [--list N] [PATH ...]

CONTRIBUTING.md explains the rules. The script measures the part of them that can be counted, over
`boatsim`, `docs`, `README.md` and `CONTRIBUTING.md` unless paths are given:

- words that this project once used in a private sense, per 1,000 words of prose (docstrings,
  comments, longer string constants, Markdown);
- comprehensions and conditional expressions per 1,000 lines of code;
- lines over 100 characters in Python files;
- openings of docstrings that do not say what a function does or returns;
- function names that do not say what a function does.

It prints one row for each folder and exits with 1 if a limit is exceeded. `--list N` prints the
first N hits of each kind.
"""

import argparse
import ast
import io
import re
import tokenize
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

DEFAULT_PATHS = ("boatsim", "docs", "README.md", "CONTRIBUTING.md")
WORDS = re.compile(
    r"\b(?:told|tells|said|says|saying|besides?|anew|laid|somebody|nobody|anybody|whoever|"
    r"whichever|thereof|to and fro|by the dozen|of its own|of one's own|as it is|as they are|"
    r"at once|goe?s? on with|goes by|(?:what|that) is there|is there|such a one|by itself|"
    r"for itself|the other way|on their way|asks? for it)\b",
    re.IGNORECASE,
)
OPENINGS = re.compile(r"(?:Of|Those|Such|Beside|What|Whose|Wherever|The same)\b")
NAMES = re.compile(r"_*(?:look|told|said|says|laid|asked|given|taken|begun|tried|made|left)\Z")
MAX_WORDS_PER_THOUSAND = 1.0  # over everything; well-known libraries measure 0.3
MAX_WORDS_PER_THOUSAND_IN_PACKAGE = 0.5
MAX_COMPREHENSIONS_PER_THOUSAND = 20.0
MAX_CONDITIONALS_PER_THOUSAND = 10.0
MAX_LINE = 100
SHORTEST_TEXT = 3  # words; shorter string constants are keys and names, not prose
GENERATED = {"_build", "reference", "__pycache__"}
COMPREHENSIONS = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)


@dataclass
class Counts:
    """What was counted in one file or in several."""

    prose_words: int = 0
    code_lines: int = 0
    comprehensions: int = 0
    conditionals: int = 0
    hits: dict[str, list[str]] = field(default_factory=dict)  # kind -> "file:line: text"

    def add(self, other: "Counts") -> None:
        """Add the counts of another file."""
        self.prose_words += other.prose_words
        self.code_lines += other.code_lines
        self.comprehensions += other.comprehensions
        self.conditionals += other.conditionals
        for kind, lines in other.hits.items():
            self.hits.setdefault(kind, []).extend(lines)

    def hit(self, kind: str, file: Path, line: int, text: str) -> None:
        """Record one place that breaks a rule."""
        self.hits.setdefault(kind, []).append(f"{file}:{line}: {text.strip()[:120]}")

    def number(self, kind: str) -> int:
        """Return the number of hits of one kind."""
        return len(self.hits.get(kind, []))

    def words_per_thousand(self) -> float:
        """Return the private words per 1,000 words of prose."""
        return 1000.0 * self.number("word") / max(1, self.prose_words)

    def per_thousand_lines(self, count: int) -> float:
        """Return a count per 1,000 lines of code that are not blank."""
        return 1000.0 * count / max(1, self.code_lines)


def prose_of_python(text: str, tree: ast.Module) -> list[tuple[int, str]]:
    """Return comments, docstrings and longer string constants as (line number, text)."""
    prose = []
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            prose.append((token.start[0], token.string.lstrip("# ")))
    for node in ast.walk(tree):
        if not isinstance(node, ast.Constant) or not isinstance(node.value, str):
            continue
        if len(node.value.split()) > SHORTEST_TEXT:
            prose.extend(enumerate(node.value.splitlines(), node.lineno))
    return prose


def prose_of_markdown(text: str) -> list[tuple[int, str]]:
    """Return the lines outside fenced code as (line number, text)."""
    prose = []
    fenced = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        elif not fenced:
            prose.append((number, line))
    return prose


def count_prose(counts: Counts, file: Path, prose: list[tuple[int, str]]) -> None:
    """Count the words of some prose and the private words among them."""
    for line, text in prose:
        counts.prose_words += len(text.split())
        for _ in WORDS.finditer(text):
            counts.hit("word", file, line, text)


def count_code(counts: Counts, file: Path, text: str, tree: ast.Module) -> None:
    """Count constructs, long lines, function names and openings of docstrings."""
    for number, line in enumerate(text.splitlines(), 1):
        counts.code_lines += bool(line.strip())
        if len(line) > MAX_LINE:
            counts.hit("long line", file, number, line)
    for node in ast.walk(tree):
        if isinstance(node, COMPREHENSIONS):
            counts.comprehensions += 1
        elif isinstance(node, ast.IfExp):
            counts.conditionals += 1
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            if NAMES.match(node.name):
                counts.hit("name", file, node.lineno, node.name)
            docstring = ast.get_docstring(node) or ""
            if OPENINGS.match(docstring):
                counts.hit("opening", file, node.lineno, docstring.splitlines()[0])


def count_file(file: Path) -> Counts:
    """Return the counts of one Python or Markdown file."""
    counts = Counts()
    text = file.read_text(encoding="utf-8")
    if file.suffix == ".md":
        count_prose(counts, file, prose_of_markdown(text))
        return counts
    tree = ast.parse(text)
    count_prose(counts, file, prose_of_python(text, tree))
    count_code(counts, file, text, tree)
    return counts


def files_below(path: Path) -> list[Path]:
    """Return the Python and Markdown files of a folder, or the file itself."""
    if path.is_file():
        return [path]
    found = []
    for file in sorted(path.rglob("*")):
        if file.suffix in (".py", ".md") and not GENERATED & set(file.parts):
            found.append(file)
    return found


def violations(total: Counts, package: Counts) -> list[str]:
    """Return one line for every limit that is exceeded."""
    limits = [
        ("private words per 1,000", total.words_per_thousand(), MAX_WORDS_PER_THOUSAND),
        (
            "private words per 1,000 in boatsim/",
            package.words_per_thousand(),
            MAX_WORDS_PER_THOUSAND_IN_PACKAGE,
        ),
        (
            "comprehensions per 1,000 lines",
            total.per_thousand_lines(total.comprehensions),
            MAX_COMPREHENSIONS_PER_THOUSAND,
        ),
        (
            "conditional expressions per 1,000 lines",
            total.per_thousand_lines(total.conditionals),
            MAX_CONDITIONALS_PER_THOUSAND,
        ),
    ]
    lines = []
    for name, value, limit in limits:
        if value > limit:
            lines.append(f"{name}: {value:.2f}, allowed are {limit:g}")
    for kind in ("long line", "opening", "name"):
        if total.number(kind):
            lines.append(f"{kind}: {total.number(kind)}, allowed are none")
    return lines


def main() -> int:
    """Print the counts; return 1 if a limit is exceeded, else 0."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("paths", nargs="*", default=DEFAULT_PATHS, type=Path)
    parser.add_argument("--list", type=int, default=0, metavar="N", help="print N hits of a kind")
    arguments = parser.parse_args()
    total = Counts()
    package = Counts()
    by_folder: dict[str, Counts] = {}
    for file in (file for path in map(Path, arguments.paths) for file in files_below(path)):
        counts = count_file(file)
        total.add(counts)
        if file.parts[0] == "boatsim":
            package.add(counts)
        by_folder.setdefault(str(Path(*file.parts[:2])), Counts()).add(counts)
    print(f"{'':36s} words  /1,000  comprehensions  conditionals  long  openings  names")
    for name, counts in [*by_folder.items(), ("all", total)]:
        print(
            f"{name:36s} {counts.prose_words:5d} {counts.words_per_thousand():7.2f}"
            f" {counts.per_thousand_lines(counts.comprehensions):15.1f}"
            f" {counts.per_thousand_lines(counts.conditionals):13.1f}"
            f" {counts.number('long line'):5d} {counts.number('opening'):9d}"
            f" {counts.number('name'):6d}"
        )
    for kind, lines in total.hits.items():
        repeated = Counter(lines)
        for line in list(repeated)[: arguments.list]:
            print(f"  {kind}: {line}")
    exceeded = violations(total, package)
    for line in exceeded:
        print(f"exceeded: {line}")
    return int(bool(exceeded))


if __name__ == "__main__":
    raise SystemExit(main())
