"""Documents written anew: their form to the letter, and every value the same to readers of YAML 1.1 and of 1.2."""

from __future__ import annotations

import json
from collections.abc import Callable

import pytest
import yaml as pyyaml
from hypothesis import given
from hypothesis import strategies as st
from ruamel.yaml import YAML

from archgen.syntax import yaml_parser
from archgen.syntax.block_documents import BlockMapping, write_document
from archgen.syntax.yaml_tree import node_to_data

WORDS = "The robot keeps its distance. " * 5
ODD_TEXTS = """no|On|1:30|12:30:45|1e3|0123|0x1F|0o17|0b1|1_000|+1|.5|1.|~|null|.inf|true|y|N|=|<<|2001-01-01|- a|# x
a: b|a #b|a |-|%d|@x|!tag|&a|*a|'|"|{a}|[a]|?|a?|a,b|--- |...|>x|a:|""".replace("\n", "|").split("|")
CONTROLS = [
    "\ttab",
    "a\tb",
    "one\ntwo",
    "one\ntwo\n",
    "one\n\n",
    "\n",
    "\n x",
    " x\ny",
    "x \ny",
    "\u00e9\x85",
    "\x1b[31m",
    "a\u2028b",
    "\ufeff",
    "\ufffe",
    "a\u00a0b",
    "\x07",
    "\U0001f600",
    "word " * 40,
    ("word " * 40).strip(),
    "# word " * 40,
    "x" * 300,
    "two  blanks " * 20 + "x",
    f"\x07{WORDS}end",
]


def read_by_archgen(text: str) -> object:
    document, findings = yaml_parser.parse_yaml("new.yaml", text)
    assert not findings
    assert document is not None
    return node_to_data(document.root)


READERS = [pyyaml.safe_load, YAML(typ="safe", pure=True).load, read_by_archgen]


def write_entries(data: dict[str, object]) -> str:
    root = BlockMapping()
    for key, value in data.items():
        root.add_entry(key, value)
    return write_document(root)


def test_a_slice_looks_as_a_person_would_write_it() -> None:
    root = BlockMapping()
    group = root.add_mapping("groups").add_mapping("on")
    group.add_entry("title", "12:30")
    arm = group.add_mapping("components", "# two").add_mapping("arm", is_spaced=True)
    arm.add_entry("functionality", None, "# what it does")
    arm.add_entry("description", f"{WORDS}End.")
    arm.add_entry("inputs", {})
    arm.add_mapping("outputs").add_entry("a", {"from": ["x y", None], "m": 3, "sure": True})
    arm.add_entry("long", {"first": "x" * 60, "second": ["y" * 60, "z" * 60], "third": None})
    root.add_mapping("nodes", is_spaced=True).add_entry("driver", {"implements": "on.arm"})
    expected = f"""\
# head
groups:
  "on":
    title: "12:30"
    components:  # two

      arm:
        functionality:  # what it does
        description: >-
          The robot keeps its distance. The robot keeps its distance. The robot keeps its distance. The robot
          keeps its distance. The robot keeps its distance. End.
        inputs: {{}}
        outputs:
          a: {{from: [x y, null], m: 3, sure: true}}
        long:
          first: {"x" * 60}
          second:
            - {"y" * 60}
            - {"z" * 60}
          third:

nodes:
  driver: {{implements: on.arm}}
"""
    assert write_document(root, "# head\n") == expected


def test_the_same_list_twice_makes_no_alias() -> None:
    shared = ["a"]
    assert write_entries({"one": shared, "two": shared}) == "one: [a]\ntwo: [a]\n"


@pytest.mark.parametrize("read", READERS, ids=["PyYAML", "ruamel.yaml", "archgen"])
@pytest.mark.parametrize("text", [*ODD_TEXTS, *CONTROLS])
def test_text_stays_text(read: Callable[[str], object], text: str) -> None:
    data: dict[str, object] = {"key": text, "list": [text], "braces": {"inner": text}}
    assert read(write_entries(data)) == data


@pytest.mark.parametrize("read", READERS, ids=["PyYAML", "ruamel.yaml", "archgen"])
@pytest.mark.parametrize("key", ["no", "on", "1e3", "0123", "12:30", "a: b", "# x", "k" * 150, "\u2028" * 60])
def test_keys_stay_text(read: Callable[[str], object], key: str) -> None:
    assert read(write_entries({key: "value", "braces": {key: "value"}})) == {key: "value", "braces": {key: "value"}}


def test_lone_surrogates_become_question_marks() -> None:
    assert write_entries({"k": "a\ud800b"}) == "k: a?b\n"


TEXTS = st.text(st.characters(exclude_categories=["Cs"]), max_size=40)
VALUES = st.recursive(
    TEXTS | st.booleans() | st.integers() | st.none() | st.text("ab \n", min_size=100, max_size=150),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(TEXTS, inner, max_size=3),
    max_leaves=8,
)


@given(st.dictionaries(TEXTS, VALUES, min_size=1, max_size=4))
def test_everything_comes_back(data: dict[str, object]) -> None:
    assert json.dumps(pyyaml.safe_load(write_entries(data))) == json.dumps(data)
