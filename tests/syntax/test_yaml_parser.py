"""Trees with places, and mistakes with theirs."""

from __future__ import annotations

import pytest
import yaml as pyyaml
from hypothesis import given, settings
from hypothesis import strategies as st

from archgen.diagnostics.source_span import Span
from archgen.syntax import yaml_parser
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, SequenceNode, YamlDocument, YamlNode, node_to_data
from tests.property_sizes import count_examples
from tests.quiet_seconds import measure_quiet_seconds


def read(text: str) -> YamlDocument:
    """Parse text that has nothing wrong."""
    document, found = yaml_parser.parse_yaml("f", text)
    assert found == ()
    assert document is not None
    return document


def at(document: YamlDocument, *path: str | int) -> YamlNode:
    """Walk down to a value."""
    value: YamlNode = document.root
    for step in path:
        if isinstance(value, SequenceNode) and isinstance(step, int):
            value = value.items[step]
        elif isinstance(value, MappingNode) and isinstance(step, str):
            value = value.entries[step].value
    return value


def findings(text: str) -> list[str]:
    """Parse, and give what is wrong as `line:column rule: message | help`."""
    return [
        f"{d.span.line}:{d.span.column} {d.rule}: {d.message} | {d.help}" for d in yaml_parser.parse_yaml("f", text)[1]
    ]


def test_data() -> None:
    text = "a: 1\nb: [x, 'y', {c: no}]\nd: |\n  one\n  two\ne:\n1: 0x10\ntrue: ~\n"
    expected = {"a": 1, "b": ["x", "y", {"c": "no"}], "d": "one\ntwo\n", "e": None, "1": 16, "true": None}
    assert node_to_data(read(text).root) == expected


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_places(newline: str) -> None:
    text = newline.join(["a: ä 1", "b:", "  - x", "  - {c: yes, d: [e]}", "f: 2", ""])
    document = read(text)
    assert document.root.entries["b"].key_span == Span("f", 2, 1, 2, 2)
    assert at(document, "a").span == Span("f", 1, 4, 1, 7)
    assert at(document, "b").span == Span("f", 3, 3, 4, 21)
    assert at(document, "b", 1).span == Span("f", 4, 5, 4, 21)
    assert at(document, "b", 1, "d").span == Span("f", 4, 17, 4, 20)
    assert at(document, "f").span == Span("f", 5, 4, 5, 5)
    assert document.root.span == Span("f", 1, 1, 5, 5)


def test_columns_count_characters_beyond_the_basic_plane() -> None:
    assert at(read("a: {b: '🤖🤖', c: 1}"), "a", "c").span == Span("f", 1, 17, 1, 18)


def test_what_is_no_line_break_in_yaml_1_2_stays_in_the_text() -> None:
    document = read('a: "x\u2028y"\nb: p\x85q\nc: 1\n')
    assert node_to_data(document.root) == {"a": "x\u2028y", "b": "p\x85q", "c": 1}
    assert at(document, "c").span == Span("f", 3, 4, 3, 5)


def test_text_as_written() -> None:
    version = at(read("v: 1.10"), "v")
    assert version == ScalarNode(1.1, "1.10", Span("f", 1, 4, 1, 8))


def test_anchors_are_expanded_into_copies() -> None:
    document = read("a: &x {b: 1}\nc: *x\n")
    first, second = at(document, "a"), at(document, "c")
    assert node_to_data(document.root) == {"a": {"b": 1}, "c": {"b": 1}}
    assert first is not second
    assert second.span == Span("f", 2, 4, 2, 6)
    assert at(document, "a", "b") is not at(document, "c", "b")


@pytest.mark.parametrize("text", ["", "# nothing\n", "---\n", "null"])
def test_empty(text: str) -> None:
    assert read(text).root.entries == {}


QUOTE = 'put the text in quotes: "..."'


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("t: Robot: eyes", f"1:9 syntax-error: a second `: ` in one line: text that holds `: ` must be quoted | {QUOTE}"),
        ("a: 1\nt: @b", f"2:4 syntax-error: text cannot begin with `@` | {QUOTE}"),
        ("t: %b", f"1:4 syntax-error: text cannot begin with `%` | {QUOTE}"),
        ("t: `b`", f"1:4 syntax-error: text cannot begin with a backtick | {QUOTE}"),
        ("t: >= 3", f"1:4 syntax-error: text cannot begin with `>` or `|`: these open a block of lines | {QUOTE}"),
        ("t: & b", f"1:4 syntax-error: text cannot begin with `&` | {QUOTE}"),
        ("t: **b**", f"1:4 syntax-error: text cannot begin with `*` | {QUOTE}"),
        ("t: *b*", f"1:4 syntax-error: text cannot begin with `*` | {QUOTE}"),
        ("t: *b", f"1:4 syntax-error: no anchor `&b` stands above | if it is text, {QUOTE}"),
        ("t: !b c", f"1:4 syntax-error: the tag `!b` is not read | take it out; if it is text, {QUOTE}"),
        ("t: !!str c", f"1:4 syntax-error: the tag `tag:yaml.org,2002:str` is not read | take it out; if it is text, {QUOTE}"),
        ("t:\n\tb: 1", "2:1 syntax-error: a tab cannot stand in the indentation | indent with blanks"),
        ('t: "b" c', "1:8 syntax-error: the value ends before this | put the whole text in one pair of quotes"),
        ("t: 'b", "1:4 syntax-error: this quote is never closed | write `'` at its end"),
        ("t: [1, 2\nb: 3", "1:4 syntax-error: this `[` is not closed | write `]` at its end"),
        ("t: {a, b: 1}", "1:5 syntax-error: the key `a` has no `:` | write `key: value`; a list stands in brackets: [a, b]"),
        (
            "t: {j: Timed<A, B>}",
            '1:17 syntax-error: the key `B>` has no `:` | within braces a generic type of two stands in quotes, since its comma ends the value: "Pair<A, B>"',
        ),
        ("t: {b: 1, a}", "1:11 syntax-error: the key `a` has no `:` | write `key: value`; a list stands in brackets: [a, b]"),
        ("t: [a]\n[b]: 1", "2:1 syntax-error: a key is a word, not a list or a mapping | text in braces or brackets must be quoted"),
        ("<<: {a: 1}", "1:1 syntax-error: merge keys (`<<`) are not read | write the keys out, or share a whole value with `*name`"),
        ("a: {'': 1}", "1:5 syntax-error: a key is missing before `:` | write `key: value`"),
        ("a: {: 1}", "1:5 syntax-error: a key is missing before `:` | write `key: value`"),
        ("a: 1\n---\nb: 2", "2:1 syntax-error: a second YAML document begins here | a file is one document: put the second into its own"),
        ("a: x\x07", "1:5 syntax-error: the control character U+0007 cannot stand in YAML | delete it"),
        ("a:\n  b: 1\n c: 2", "3:2 syntax-error: this line does not belong to anything above it | keys of one mapping begin in the same column, and so do the entries of one list"),
        ("a: 1\n- b", "2:1 syntax-error: a list entry stands where a key is expected | indent the list below its key"),
        ("key\nb: 1", "1:1 syntax-error: a `:` is missing after `key` | write `key:`"),
        ('a: "C:\\q"', "1:7 syntax-error: an unknown escape in double quotes | write `\\\\` for a backslash, or use single quotes"),
        ("- a", "1:1 wrong-type: the file is a list, not a mapping | write sections: `groups:`, `nodes:`, `types:`, ..."),
    ],
)  # fmt: skip
def test_mistakes(text: str, expected: str) -> None:
    document, _ = yaml_parser.parse_yaml("f", text)
    assert document is None
    assert findings(text) == [expected]


def test_a_value_left_out_is_no_key_without_colon() -> None:
    assert node_to_data(read("{a: , b: 1, c:  }").root) == {"a": None, "b": 1, "c": None}


def test_duplicate_keys_show_both_places_and_cost_only_the_second() -> None:
    document, found = yaml_parser.parse_yaml("f", "a: 1\nb: 2\na: {c: 3}\nd: 4\n")
    assert document is not None
    assert node_to_data(document.root) == {"a": 1, "b": 2, "d": 4}
    assert [(d.rule, d.message, d.span, d.labels[0].span) for d in found] == [
        ("duplicate-key", "the key `a` is written twice", Span("f", 3, 1, 3, 2), Span("f", 1, 1, 1, 2))
    ]


def test_recursion() -> None:
    document, found = yaml_parser.parse_yaml("f", "a: &x\n  b: [1, *x]\n  c: *x\nd: 2\n")
    assert document is not None
    assert node_to_data(document.root) == {"a": {"b": [1]}, "d": 2}
    assert [(d.rule, d.span.line, d.span.column) for d in found] == [
        ("recursive-alias", 2, 10),
        ("recursive-alias", 3, 6),
    ]


def test_merge_conflict_names_both_sides() -> None:
    text = "a: 1\n<<<<<<< HEAD\nb: 2\n||||||| base\nb: 0\n=======\nb: [\n>>>>>>> certh/vision\n"
    document, found = yaml_parser.parse_yaml("f", text)
    assert document is None
    assert [(d.rule, d.message, d.span.line) for d in found] == [
        ("merge-conflict", "Git could not merge `HEAD` with `certh/vision` here", 2)
    ]
    assert [label.span.line for label in found[0].labels] == [6, 8]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a: Camera #2", [(1, 11, 1, 13)]),
        ("a: [x #y\n  ]", [(1, 7, 1, 9)]),
        ("colour: #ff0000", [(1, 9, 1, 16)]),
        ("a: Camera # two", []),
        ("a: 'Camera #2' #x", []),
        ("a: #todo\n  b: 1", []),
        ("a: x #archgen: ignore[y] z", []),
        ("a: C#", []),
        ("a: 8 #x", []),
        ("a: 8 Hz #x", [(1, 9, 1, 11)]),
        ("a: |\n  x #y\n", []),
    ],
)
def test_swallowed_text(text: str, expected: list[tuple[int, int, int, int]]) -> None:
    assert [d.span[1:] for d in yaml_parser.parse_yaml("f", text)[1] if d.rule == "swallowed-text"] == expected


def test_ignore_comments() -> None:
    text = (
        "# archgen: ignore[a] at the top\na: 1  # archgen: ignore[b, c-d]  why not \nt: |\n  # archgen: ignore[x]\n"
        'q: "# archgen: ignore[x]"\nz: 1 # archgen: ignore all\n'
    )
    assert [(i.rules, i.why, i.span[1:]) for i in read(text).ignores] == [
        (("a",), "at the top", (1, 1, 1, 32)),
        (("b", "c-d"), "why not", (2, 7, 2, 41)),
        ((), "all", (6, 6, 6, 27)),
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[" * 100_000, "values are nested deeper than 64"),
        ("a: " + "{b: " * 100_000, "values are nested deeper than 64"),
        ("- " * 100_000, "values are nested deeper than 64"),
        # This many take seconds.
        pytest.param(
            "a: [" + "1," * 1_100_000 + "1]", "the file holds more than 1,000,000 values", marks=pytest.mark.slow
        ),
        (
            "a: &a0 [x]\n" + "".join(f"b{n}: &a{n + 1} [{', '.join([f'*a{n}'] * 10)}]\n" for n in range(20)),
            "the file's aliases stand for more than 100,000 values",
        ),
    ],
)  # fmt: skip
def test_hostile_sizes_end_soon(text: str, message: str) -> None:
    answers = []
    assert measure_quiet_seconds(lambda: answers.append(yaml_parser.parse_yaml("f", text))) < 10
    ((document, found),) = answers
    assert document is None
    assert [(d.rule, d.message) for d in found] == [("too-large", message)]


YAMLISH = st.lists(
    st.sampled_from(["a", "b: ", ": ", "- ", "\n", "  ", "\t", "[", "]", "{", "}", ",", "#", " #x", "&x ", "*x", "!t ", "'", '"',
                     "|\n", ">", "%", "@", "`", "? ", "---\n", "...\n", "<<", "\\", "\r\n", "\u2028", "\ufeff", "1e3", "~", "é", "🤖"])
).map("".join)  # fmt: skip


@settings(max_examples=count_examples(400), deadline=None)
@given(st.one_of(YAMLISH, st.text()))
def test_any_text_gives_a_tree_or_a_place(text: str) -> None:
    document, found = yaml_parser.parse_yaml("f", text)
    assert document is not None or found
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    for diagnostic in found:
        assert 1 <= diagnostic.span.line <= len(lines)
        assert 1 <= diagnostic.span.column <= len(lines[diagnostic.span.line - 1]) + 1


@settings(max_examples=count_examples(200), deadline=None)
@given(YAMLISH)
def test_both_parsers_agree_where_both_read(text: str) -> None:
    fast, _ = yaml_parser.parse_yaml("f", text)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(yaml_parser, "HAS_LIBYAML", False)
        slow, found = yaml_parser.parse_yaml("f", text)
    assert slow is not None or found
    if fast is not None and slow is not None:
        assert repr(node_to_data(fast.root)) == repr(node_to_data(slow.root))


@pytest.mark.parametrize(
    "text", ["[{}, {}, 1, [], ~, {a: 1}, x, {b: {}}, [{}], {c: 2}, 3]", "\n- {}\n- a: 1\n- b: 2\n-\n  - {}\n  - 5\n- 6"]
)
def test_lists_of_mappings(text: str) -> None:
    document = read(f"a: {text}\nb: 2")
    assert node_to_data(document.root) == pyyaml.safe_load(f"a: {text}\nb: 2")
