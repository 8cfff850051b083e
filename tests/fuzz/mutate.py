"""Mutations of a file as hypothesis draws them: bytes changed, cut, doubled, and tokens that
readers have to bear."""

from dataclasses import dataclass

from hypothesis import strategies as st

VALUES = [
    text.encode()
    for text in (
        "nan",
        "inf",
        "-inf",
        "-1",
        "0",
        "0.0",
        "1e308",
        "1e-308",
        "1e400",
        "9" * 30,
        "9" * 400,
        "true",
        "1979-05-27",
        "[]",
        "{}",
        "[[]]",
        "[1, 2]",
        "{a = 1}",
        '""',
        '"x"',
        '"../x"',
        '"x.py"',
        '"\\u0000"',
        '"current"',
        "surge",
        "name",
        "100000000",
        "keyframe",
        "replicate",
        "freejoint",
        "hfield",
        "pipe.stl",
    )
]
LINES = [
    text.encode("utf-8", "surrogatepass")
    for text in (
        "[a]\n",
        "[[effect]]\n",
        'use = "wind"\n',
        "use = 3\n",
        'name = "t_s"\n',
        "on = []\n",
        'on = "x"\n',
        "[" * 40,
        "#",
        "=",
        ",",
        ",,",
        "\n",
        "\r",
        "\r\n",
        "\0",
        "\ufeff",
        "\u202e",
        "\udcff",
        "ü",
        '<replicate count="100000000">',
        "<keyframe><key qpos='0'/></keyframe>",
        '<include file="hull.xml"/>',
        '<mesh name="q" file="pipe.stl"/>',
        "'''",
    )
]
SIZES = [  # what a count or a length of a binary file may say
    number.to_bytes(size, order)
    for size in (2, 4, 8)
    for number in (0, 1, (1 << 8 * size - 1) - 1, 1 << 8 * size - 1, (1 << 8 * size) - 1)
    for order in ("little", "big")
]


@dataclass(frozen=True)
class Edit:
    """One change of a file: what it does, where (shares of its length), and what it puts there."""

    kind: str
    at: float
    to: float
    content: bytes
    between: bytes = b""  # what stands between words

    def of(self, file: bytes) -> bytes:
        """The file, changed."""
        a, b = (int(share * len(file)) for share in sorted((self.at, self.to)))
        if self.kind == "word":  # a whole word is another
            return _other_word(file, a, self.content, self.between)
        if self.kind == "line":  # a line is doubled elsewhere
            lines = file.split(b"\n")
            i, k = int(self.at * len(lines)) % len(lines), int(self.to * len(lines)) % len(lines)
            return b"\n".join([*lines[:i], lines[k], *lines[i:]])
        changed = {
            "put": file[:a] + self.content + file[a:],
            "cut": file[:a] + file[b:],
            "end": file[:a],
        }
        return changed.get(self.kind, file[:a] + self.content + file[a + len(self.content) :])


def _other_word(file: bytes, at: int, word: bytes, between: bytes) -> bytes:
    begin = end = at
    while end < len(file) and file[end] not in between:
        end += 1
    while begin and file[begin - 1] not in between:
        begin -= 1
    return file[:begin] + word + file[end:]


def edits(between: bytes) -> st.SearchStrategy[list[Edit]]:
    """A few changes: of a text mostly of whole words and lines, so that it gets past the parser."""
    share = st.floats(0.0, 1.0, allow_nan=False)
    raw = st.binary(min_size=1, max_size=8) | st.sampled_from(SIZES)
    bytewise = st.builds(
        Edit, st.sampled_from(["put", "cut", "end", "over", "over"]), share, share, raw
    )
    if not between:
        return st.lists(bytewise, min_size=1, max_size=3)
    word = st.builds(Edit, st.just("word"), share, share, st.sampled_from(VALUES), st.just(between))
    line = st.builds(Edit, st.sampled_from(["line", "put"]), share, share, st.sampled_from(LINES))
    return st.lists(st.one_of(word, word, word, line), min_size=1, max_size=2) | st.lists(
        bytewise, min_size=1, max_size=2
    )
