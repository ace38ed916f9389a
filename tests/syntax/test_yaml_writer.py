"""Plain data as YAML: every value comes back the same from readers of YAML 1.1 and of 1.2."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import yaml as pyyaml
from hypothesis import given
from hypothesis import strategies as st

from archgen.syntax import yaml_writer
from archgen.syntax.yaml_parser import parse_yaml
from archgen.syntax.yaml_tree import node_to_data

_TEXT = st.text(st.characters(exclude_categories=["Cs"]), max_size=40)


def test_form() -> None:
    data = {
        "a": {"title": "No", "m": 3, "on": True, "list": ["x y", {"k": "1:30"}], "none": None},
        "empty": {},
        "l": [],
    }
    assert yaml_writer.write_yaml(data) == (
        "a:\n"
        '  title: "No"\n'
        "  m: 3\n"
        '  "on": true\n'
        "  list:\n"
        "    - x y\n"
        "    -\n"
        '      k: "1:30"\n'
        "  none: null\n"
        "empty: {}\n"
        "l: []\n"
    )


def test_a_key_may_be_longer_than_yaml_takes_one_in_a_line() -> None:
    data = {"k" * 1500: {"n: " * 400: [1], "c" * 1100: "a\nb\n"}}
    text = yaml_writer.write_yaml(data, {("k" * 1500,): "said"})
    assert pyyaml.safe_load(text) == data
    document, diagnostics = parse_yaml("f", text)
    assert not diagnostics
    assert document is not None
    assert node_to_data(document.root) == data


def test_a_comment_stays_on_its_line_whatever_it_holds() -> None:
    text = yaml_writer.write_yaml({"a": {"b": 1}}, {("a",): "only if \0\nb: injected\u2028c: injected\x1b"})
    assert text == "a:  # only if ␀␊b: injected\ufffdc: injected␛\n  b: 1\n"


def test_comments_stand_behind_their_element() -> None:
    data = {"a": {"b": ["x", "z"]}, "t": "one\ntwo\n"}
    comments = {("a",): "first", ("a", "b", 1): "second", ("t",): "third"}
    assert (
        yaml_writer.write_yaml(data, comments)
        == "a:  # first\n  b:\n    - x\n    - z  # second\nt: |  # third\n  one\n  two\n"
    )


_ODD = """no|On|1:30|1e3|0x1F|~|null|.inf|-|- a|# x|a: b|a #b| a|a ||=|<<|2001-01-01|1_000|+1|.5|0o17|%d|@x|!tag|&a|*a|y|N
true|12:30:45|1.|0b1|'|"|{a}|[a]|?|a?|a,b|--- |...|>x|a:"""
_CONTROLS = [
    "\ttab",
    "a\tb",
    "one\ntwo",
    "one\n\n",
    "\n",
    "\n x",
    " x\ny",
    "\u00e9\x85",
    "\x1b[31m",
    "a\u2028b",
    "\ufeff",
]


@pytest.mark.parametrize("text", [*_ODD.replace("\n", "|").split("|"), *_CONTROLS])
def test_text_stays_text(text: str) -> None:
    assert pyyaml.safe_load(yaml_writer.write_yaml({"key": text})) == {"key": text}


@pytest.mark.parametrize("text", [*_ODD.replace("\n", "|").split("|"), *_CONTROLS])
def test_text_in_braces_stays_text(text: str) -> None:
    value = {"key": text, "list": [text, {text: "x"}]}
    assert pyyaml.safe_load(yaml_writer.format_flow(value)) == value


@given(
    st.dictionaries(
        _TEXT,
        st.recursive(
            _TEXT | st.booleans() | st.integers() | st.none(),
            lambda inner: st.lists(inner, max_size=3) | st.dictionaries(_TEXT, inner, max_size=3),
            max_leaves=8,
        ),
        max_size=4,
    )
)
def test_everything_comes_back(data: dict[str, object]) -> None:
    assert json.dumps(pyyaml.safe_load(yaml_writer.write_yaml(data))) == json.dumps(data)


def test_reads_the_same_by_our_own_reader(tmp_path: Path) -> None:
    from archgen.syntax import yaml_parser as reader
    from archgen.syntax.yaml_tree import node_to_data

    data = {"a": "yes", "b": "1.10", "c": [1, 2.5, "2"], "d": "x\ny", "e": {"f": True, "g": "12e4", "h": ".nan"}}
    document, found = reader.parse_yaml(str(tmp_path), yaml_writer.write_yaml(data))
    assert not found
    assert document is not None
    assert node_to_data(document.root) == data
