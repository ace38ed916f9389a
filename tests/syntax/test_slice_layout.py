"""`slice_layout`: one style, whatever the layout was; no value, key or comment is lost or moved."""

from __future__ import annotations

import random
import re
from itertools import pairwise
from pathlib import Path

import pytest

from archgen.edit.formatted_slices import format_text
from archgen.syntax import yaml_parser
from archgen.syntax.slice_layout import MAX_LINE, UnformattableError, format_slice
from archgen.syntax.yaml_tree import YamlDocument, node_to_data

REPOSITORY = Path(__file__).parents[2]
LONG = "x" * 60
CASES = {
    "indents": ("a:\n    b:\n         c: 1\n", "a:\n  b:\n    c: 1\n"),
    "lists below their key": ("a:\n- 1\n- b: 2\n  c: 3\n", "a:\n  - 1\n  - b: 2\n    c: 3\n"),
    "lists in lists": ("a:\n -  - 1\n    - 2\n -  - 3\n", "a:\n  - - 1\n    - 2\n  - - 3\n"),
    "braces": ("a: { b:   1,c: [ 2,3 ] }\n", "a: {b: 1, c: [2, 3]}\n"),
    "braces over lines": ("a: {\n  b: 1,\n  c: 2,\n}\n", "a: {b: 1, c: 2}\n"),
    "braces that do not fit": (
        f"a: {{b: {LONG}, c: {{d: {LONG}, e: [1, 2]}}}}\n",
        f"a:\n  b: {LONG}\n  c: {{d: {LONG}, e: [1, 2]}}\n",
    ),
    "brackets that do not fit": (f"a: [{LONG}, {{b: {LONG}}}]\n", f"a:\n  - {LONG}\n  - {{b: {LONG}}}\n"),
    "braces with a comment": ("a: {b: 1,  # one\n  c: 2}\n", "a:\n  b: 1  # one\n  c: 2\n"),
    "a comment behind braces that open": (
        f"a: {{b: {LONG}, c: {LONG}}} # why\nd: 1\n",
        f"a:  # why\n  b: {LONG}\n  c: {LONG}\nd: 1\n",
    ),
    "an item in braces that opens": (
        f"a:\n- {{b: {LONG}, c: {LONG}}} # why\n",
        f"a:\n  - b: {LONG}  # why\n    c: {LONG}\n",
    ),
    "an anchor": ("a: &x   {b: 1}\nc:   *x\nd: &y\n   e: 1\n", "a: &x {b: 1}\nc: *x\nd: &y\n  e: 1\n"),
    "a pair in brackets": ("a: [b: 1,   c]\n", "a: [b: 1, c]\n"),
    "quotes": ('a:   \'b\'\n"c":   "d\\""\n', 'a: \'b\'\n"c": "d\\""\n'),
    "a block of text": (
        "a: |\n       b\n         c\n\n\n       d\nb: >-\n x\n",
        "a: |\n  b\n    c\n\n\n  d\nb: >-\n  x\n",
    ),
    "a block that keeps its last lines": ("a:\n   b: |+\n     x\n\n\nc: 1\n", "a:\n  b: |+\n    x\n\n\nc: 1\n"),
    "a text over lines": ("a:    b\n       c\nd:\n      'e\n\n      f'\n", "a: b\n  c\nd:\n  'e\n\n  f'\n"),
    "a word below its key": ("a:\n   b\n", "a: b\n"),
    "nothing": ("a:\nb:   \n-1:\n  - \n", "a:\nb:\n-1:\n  -\n"),
    "blank lines": ("\n\na: 1\n\n\n\nb: 2\n\n\n", "a: 1\n\nb: 2\n"),
    "comments": (
        "# top\n\n\n# more\na:\n      # of b\n      b: 1 # behind\n      # last of a\n  # of d\nd: 1\n# end\n",
        "# top\n\n# more\na:\n  # of b\n  b: 1  # behind\n  # last of a\n# of d\nd: 1\n# end\n",
    ),
    "a comment left of dashes below their key": ("a:\n- 1\n# of b\nb: 2\n", "a:\n  - 1\n# of b\nb: 2\n"),
    "a comment between key and value": ("a:   # why\n     # more\n   b\n", "a:  # why\n  # more\n  b\n"),
    "a comment between dash and value": ("a:\n  -  # why\n     b: 1\n", "a:\n  -  # why\n    b: 1\n"),
    "a hash in a text": ("a: 'b # c'   # d\ne: f#g\n", "a: 'b # c'  # d\ne: f#g\n"),
    "a document's begin": ("# x\n---\na:   1\n", "# x\n---\na: 1\n"),
    "only comments": ("\n# x\n\n\n# y", "# x\n\n# y\n"),
}


@pytest.mark.parametrize("name", CASES)
def test_lays_out(name: str) -> None:
    text, expected = CASES[name]
    assert format_slice(text) == expected
    assert format_text(text) == expected


@pytest.mark.parametrize("name", CASES)
def test_what_is_laid_out_stays(name: str) -> None:
    assert format_slice(CASES[name][1]) == CASES[name][1]


@pytest.mark.parametrize(
    ("text", "line", "reason"),
    [
        ("a: 1\n? b\n: 2\n", 2, "`?`"),
        ("%YAML 1.2\n---\na: 1\n", 1, "directive"),
        ("a: 1\n...\n", 2, "end of a document"),
        ("a:\n  b: |2\n      x\n", 2, "indentation"),
        ("a: |\n  x\n      \n  y\n", 1, "blanks"),
        ("a: 1\na: 2\n", 2, "a"),
        ("a: {b\n", 1, ""),
        ("a: 1\rb: 2\n", 1, "CR"),
        ("<<<<<<< a\na: 1\n=======\na: 2\n>>>>>>> b\n", 1, "merge"),
    ],
)
def test_what_is_not_laid_out_is_named(text: str, line: int, reason: str) -> None:
    with pytest.raises(UnformattableError) as caught:
        format_text(text)
    assert caught.value.line == line
    assert reason in caught.value.reason


QUICK_BYTES = 6000
"""In larger files comments are tried by the slow tests: each is read forty times."""


def _list_slices() -> list[Path]:
    return sorted([*REPOSITORY.glob("example_ramcip/**/*.yaml"), *REPOSITORY.glob("examples/**/*.yaml")])


def _loosen(text: str, draw: random.Random) -> str:
    """Return a text that says the same with other indents, blanks and blank lines."""
    lines: list[str] = []
    block_indent: int | None = None
    for line in text.split("\n"):
        indent = len(line) - len(line.lstrip(" "))
        if block_indent is not None and line.strip() and indent <= block_indent:
            block_indent = None
        if block_indent is None and line.strip() and draw.random() < 0.1:
            lines += [""] * (2 if lines and not lines[-1] else 0)
        lines.append(" " * (indent if block_indent is None else block_indent + 2) + line if line.strip() else "")
        is_plain = not re.search("['\"|>#&*]", line)
        head, brace, braced = (
            re.split(r"(?<=: )([{\[])", lines[-1], maxsplit=1) if re.search(r": [{\[]", line) else ("",) * 3
        )
        if block_indent is None and is_plain and brace:
            braced = re.sub(r"([{,\[]) ?", lambda sign: sign[1] + " " * draw.randrange(1, 4), braced)
            lines[-1] = f"{head}{brace}{' ' * draw.randrange(3)}{braced}"
        if block_indent is None and re.search(r"[|>][+-]?\s*$", line):
            block_indent = indent
    return "\n".join(lines)


@pytest.mark.parametrize("path", _list_slices(), ids=lambda path: str(path.relative_to(REPOSITORY)))
def test_says_the_same_whatever_the_layout_was(path: Path) -> None:
    text = path.read_text()
    formatted = format_text(text)
    for seed in range(3):
        assert format_text(_loosen(text, random.Random(seed))) == formatted  # noqa: S311 - no secret
    assert all(not (above == below == "") for above, below in pairwise(formatted.split("\n")[:-1])) or "|" in formatted
    assert all(len(line) <= MAX_LINE for line in formatted.split("\n") if re.search(r"[\]}]$", line))


@pytest.mark.parametrize(
    "path",
    [
        pytest.param(path, marks=pytest.mark.slow if path.stat().st_size > QUICK_BYTES else ())
        for path in _list_slices()
    ],
    ids=lambda path: str(path.relative_to(REPOSITORY)),
)
def test_comments_anywhere_stay_where_they_are(path: Path) -> None:
    draw = random.Random(1)  # noqa: S311 - no secret
    text = path.read_text()
    data = node_to_data(_read(text).root)
    for _ in range(40):
        lines = text.split("\n")
        line = draw.randrange(len(lines))
        if draw.random() < 0.5 or not lines[line].strip():
            lines.insert(line, " " * draw.randrange(9) + f"# comment {line}")
        else:
            lines[line] += f" # behind {line}"
        changed_text = "\n".join(lines)
        # Some places are within a text.
        if yaml_parser.parse_yaml("", changed_text)[0] and node_to_data(_read(changed_text).root) == data:
            text = changed_text
    formatted = format_text(text)
    assert format_text(formatted) == formatted
    assert format_text(text.replace("\n", "\r\n")) == formatted.replace("\n", "\r\n")


def _read(text: str) -> YamlDocument:
    document, _ = yaml_parser.parse_yaml("", text)
    assert document is not None
    return document
