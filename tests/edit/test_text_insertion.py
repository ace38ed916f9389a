"""Elements put into texts of every form: what comes out is shown whole."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from archgen.edit import edit_proof, element_edit
from archgen.edit.edit_proof import NewElement
from archgen.syntax import yaml_parser
from archgen.syntax.yaml_tree import node_to_data

X = NewElement("x", {"title": "X", "inputs": None}, {"inputs": "what it needs"})
PATH = ("groups", "g", "components")


def inserted(text: str, path: tuple[str, ...] = PATH, element: NewElement = X) -> str:
    """Give the first text that is proved."""
    return next(
        found
        for found in element_edit.propose_texts("a.yaml", text, path, element)
        if edit_proof.adds_only_element(text, found, path, element)
    )


def test_behind_the_last_in_its_indentation() -> None:
    text = "groups:\n    g:\n        components:\n            a:\n                title: A   # kept\n\nnodes: {}\n"
    new = "            x:\n                title: X\n                inputs:  # what it needs\n"
    assert inserted(text) == text.replace("\n\nnodes", f"\n{new}\nnodes")


def test_blank_lines_stand_between_where_they_did() -> None:
    text = "groups:\n  g:\n    components:\n\n      # the first\n      a: A\n\n      # the second\n      b: B\n"
    assert inserted(text) == text + "\n      x:\n        title: X\n        inputs:  # what it needs\n"


def test_comments_below_the_last_stay_with_it() -> None:
    text = "groups:\n  g:\n    components:\n      a:\n        title: A\n        # todo: inputs\n      # c: C\n# nodes\nnodes: {}\n"
    new = "      x:\n        title: X\n        inputs:  # what it needs\n"
    assert inserted(text) == text.replace("# nodes\n", f"{new}# nodes\n")


def test_windows_line_ends_and_no_last_one() -> None:
    text = "groups:\r\n  g:\r\n    components:\r\n      a: A"
    assert inserted(text) == text + "\r\n      x:\r\n        title: X\r\n        inputs:  # what it needs\r\n"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("groups: {g: {components: {a: A}}}\n", "groups: {g: {components: {a: A, x: {title: X}}}}\n"),
        ("groups: {g: {components: {a: A,}}}\n", "groups: {g: {components: {a: A, x: {title: X}}}}\n"),
        (
            "groups: {g: {components: {\n  a: A  # one, two\n  }}}\n",
            "groups: {g: {components: {\n  a: A,\n  x: {title: X}  # one, two\n  }}}\n",
        ),
        (
            f"groups: {{g: {{components: {{\n  a: A  {'#' * 2_000}\n  }}}}}}\n",
            f"groups: {{g: {{components: {{\n  a: A,\n  x: {{title: X}}  {'#' * 2_000}\n  }}}}}}\n",
        ),
        ("groups: {g: {components: {}}} # c\n", "groups: {g: {components: {x: {title: X}}}} # c\n"),
        ("groups: {g: {title: G}}\n", "groups: {g: {title: G, components: {x: {title: X}}}}\n"),
        (
            "groups: {g: {components: {\n  a: A,\n  b: B  # c\n}}}\n",
            "groups: {g: {components: {\n  a: A,\n  b: B,\n  x: {title: X}  # c\n}}}\n",
        ),
        (
            "groups:\n  g:\n    components: {a: {title: A}} # c\n",
            "groups:\n  g:\n    components: {a: {title: A}, x: {title: X}} # c\n",
        ),
    ],
)
def test_in_braces(text: str, expected: str) -> None:
    assert inserted(text) == expected


def test_lines_of_braces_get_one_more() -> None:
    text = "nodes:\n  a: {implements: a}\n  b: b\n  c: {implements: c}\n"
    assert inserted(text, ("nodes",)) == text + "  x: {title: X}\n"


def test_below_a_key_without_a_value() -> None:
    text = "groups:\n  g:\n    components:   # none yet\n    title: G\n"
    new = "      x:\n        title: X\n        inputs:  # what it needs\n"
    assert inserted(text) == text.replace("    title", f"{new}    title")


@pytest.mark.parametrize(
    "text", ["", "# only a comment", "archgen: 1\n", "archgen: 1\ngroups:\n", "groups:\n  g: {}\n"]
)
def test_what_is_missing_above_is_written_too(text: str) -> None:
    found = yaml_parser.parse_yaml("a.yaml", inserted(text))[0]
    assert found is not None
    data = node_to_data(found.root)
    assert isinstance(data, dict)
    assert data["groups"]["g"]["components"]["x"]["title"] == "X"
    assert inserted(text).startswith(text.removesuffix("{}\n"))


def test_a_block_text_at_the_end_keeps_its_blank_lines() -> None:
    for sign in ("|", "|-", "|+", ">", ">+"):
        text = f"groups:\n  g:\n    components:\n      a:\n        functionality: {sign}\n          One.\n\n          Two.\n\n\n"
        found = inserted(text)
        assert "      x:\n        title: X\n" in found
        assert found.replace("      x:\n        title: X\n        inputs:  # what it needs\n", "") == text


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("groups:\n  g: Group\n", "`g` is not a mapping that is written out (a.yaml:2:3)"),
        ("groups:\n  g:\n    components: ~\n", "`components` is not a mapping that is written out (a.yaml:3:5)"),
        ("groups:\n  g:\n    components: [a]\n", "`components` is not a mapping that is written out (a.yaml:3:5)"),
        (
            "groups:\n  a: &g {components: {}}\n  g: *g\n",
            "`g` is written once and used here by its anchor (a.yaml:3:6)",
        ),
        ("groups:\n\tg: 1\n", "a.yaml cannot be parsed: `archgen check` says where"),
        ("groups:\r  g:\r    title: G\r", "a.yaml holds line breaks that editors and parsers see differently"),
    ],
)
def test_what_is_refused(text: str, said: str) -> None:
    with pytest.raises(element_edit.CannotInsertError) as refused:
        inserted(text)
    assert str(refused.value) == said


def test_what_an_anchor_shares_would_change_elsewhere_and_is_not_proved() -> None:
    text = "groups:\n  g: &g\n    components:\n      a: A\n  h: *g\n"
    assert [
        t for t in element_edit.propose_texts("a.yaml", text, PATH, X) if edit_proof.adds_only_element(text, t, PATH, X)
    ] == []


LINES = st.sampled_from(["", "# note", "      # inside", "    # out", "  ", "        # deep"])
VALUES = st.sampled_from(
    ["A", "'a: b'", "{title: A}", "\n        title: A", "|\n          t\n", "&a {title: A}", "[]", ""]
)


@given(
    st.lists(st.tuples(st.lists(LINES, max_size=2), VALUES), min_size=1, max_size=4),
    st.lists(LINES, max_size=3),
    st.sampled_from(["\n", "\r\n"]),
    st.sampled_from(["", "\nnodes: {n: a}"]),
)
def test_any_layout_keeps_all_its_lines(
    entries: list[tuple[list[str], str]], after: list[str], ending: str, below: str
) -> None:
    lines = ["groups:", "  g:", "    components:"]
    for number, (before, value) in enumerate(entries):
        lines += [*before, f"      c{number}: {value}"]
    text = "\n".join([*lines, *after]) + below
    text = text.replace("\n", ending)
    if yaml_parser.parse_yaml("a.yaml", text)[0] is None:
        return
    found = inserted(text)
    old, rest = text.splitlines(), iter(found.splitlines())
    assert all(line in rest for line in old), "the old lines are there in their order"
    assert ("\n" in found.replace("\r\n", "")) == (ending == "\n")
