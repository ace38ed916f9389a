"""Slices merged by what they say: where lines conflict, where both sides contradict, and what a merge must not lose."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from archgen.git.object_reader import merge_lines
from archgen.merge.slice_merge import SliceVersions, UnmergedSlice, merge_slices
from archgen.merge.tree_merge import MergeConflictError, MergedValue, merge_values, read_merged_value
from archgen.syntax import yaml_parser
from archgen.syntax.yaml_writer import format_flow, write_yaml
from tests.property_sizes import count_examples

GROUP = """\
groups:
  g:
    components:
      a: {outputs: {o: T}}
"""


def merge(base: str, ours: str, theirs: str) -> str | UnmergedSlice:
    return merge_slices(SliceVersions(*(textwrap.dedent(text) for text in (base, ours, theirs))))


@pytest.mark.parametrize(
    ("base", "ours", "theirs", "merged"),
    [
        pytest.param(
            GROUP,
            GROUP + "      b: {outputs: {p: T}}\n",
            GROUP + "      # The new one.\n      c:\n        outputs: {q: T}\n",
            GROUP + "      b: {outputs: {p: T}}\n      # The new one.\n      c:\n        outputs: {q: T}\n",
            id="both append a component",
        ),
        pytest.param(
            "nodes:\n  n: {rate: 10 Hz, wcet: 5 ms}\n",
            "nodes:\n  n: {rate: 20 Hz, wcet: 5 ms}\n",
            "nodes:\n  n: {rate: 10 Hz, wcet: 6 ms}\n",
            "nodes:\n  n: {rate: 20 Hz, wcet: 6 ms}\n",
            id="two keys of one line",
        ),
        pytest.param(
            "nodes:\n  n: {rate: 10 Hz}\n",
            "nodes:\n  n: {rate: 10 Hz, host: pc}\n",
            "nodes:\n  n: {rate: 10 Hz, wcet: 6 ms}\n",
            "nodes:\n  n: {rate: 10 Hz, host: pc, wcet: 6 ms}\n",
            id="both add a key in braces",
        ),
        pytest.param("n: {}\n", "n: {a: 1}\n", "n: {b: 2}\n", "n: {a: 1, b: 2}\n", id="both fill empty braces"),
        pytest.param(
            "review: {passes: [x, y]}\n",
            "review: {passes: [x, z]}\n",
            "review: {passes: [w, x, y]}\n",
            "review: {passes: [w, x, z]}\n",
            id="passes",
        ),
        pytest.param("", "a: 1\n", "b: 2\n", "a: 1\nb: 2\n", id="both begin a file"),
        pytest.param("g: 1", "g: 1\nb: 2", "g: 1\nc: 3", "g: 1\nb: 2\nc: 3\n", id="no line end at the end"),
        pytest.param(
            "a: 1\n", "a: 1\nh: {p: 1}\n", "a: 1\nh:\n  q: 2\n", "a: 1\nh:\n  q: 2\n  p: 1\n", id="one new id"
        ),
        pytest.param(
            "a:\n  p: 1\n  q: 2\n", "a:\n  q: 2\n", "a:\n  p: 1\n  q: 3\n", "a:\n  q: 3\n", id="removed beside changed"
        ),
        pytest.param(
            "review: {main: m}\n",
            "review: {main: m, passes: [p]}\n",
            "review: {main: m, passes: [q]}\n",
            "review: {main: m, passes: [p, q]}\n",
            id="new passes",
        ),
        pytest.param(
            "sources:\n  - a.yaml\n",
            "sources:\n  - a.yaml\n  - b.yaml\n",
            'sources:\n  - a.yaml\n  - "c/*.yaml"   # all\n',
            'sources:\n  - a.yaml\n  - b.yaml\n  - "c/*.yaml"   # all\n',
            id="both add a source",
        ),
        pytest.param(
            "nodes:\n  n: {kind: driver, package: p}\n",
            "nodes:\n  n: {kind: [driver, lifecycle], package: p}\n",
            "nodes:\n  n: {kind: driver, package: q}\n",
            "nodes:\n  n: {kind: [driver, lifecycle], package: q}\n",
            id="a list of kinds",
        ),
        pytest.param(
            "g:\n  inputs:   # from where?\n  x: 1\n",
            "g:\n  inputs:   # from where?\n    a: b.c\n  x: 1\n",
            "g:\n  inputs: {d: e.f}   # from where?\n  x: 1\n",
            "g:\n  inputs: {d: e.f, a: b.c}   # from where?\n  x: 1\n",
            id="both fill in a blank",
        ),
        pytest.param(
            "types:\n  T: p/msg/A\n",
            "types:\n  T: {message: p/msg/A, comment: in metres}\n",
            "types:\n  T: p/msg/B\n",
            "types:\n  T: {message: p/msg/B, comment: in metres}\n",
            id="short form against long form",
        ),
        pytest.param(
            "types:\n  T: p/msg/A\n",
            "types:\n  T: {message: p/msg/A, comment: in metres}\n",
            "types:\n  T: {message: p/msg/A, size: 8 B}\n",
            "types:\n  T: {message: p/msg/A, size: 8 B, comment: in metres}\n",
            id="both write the long form",
        ),
        pytest.param(
            "a: 1\r\nb: 2\r\n",
            "a: 1\r\nb: 2\r\nc: 3\r\n",
            "a: 1\r\nb: 2\r\nd: 4\r\n",
            "a: 1\r\nb: 2\r\nc: 3\r\nd: 4\r\n",
            id="line ends of Windows",
        ),
        pytest.param(
            "a: {p: 1}\nb: 2\n",
            "a: {p: 1}\r\nb: 2\r\n",
            "a: {p: 1}\nb: 2\nc:\n  - 3\n",
            "a: {p: 1}\r\nb: 2\r\nc:\r\n  - 3\r\n",
            id="one side changed the line ends",
        ),
        pytest.param(
            "a: 1  # why\n", "a: 2  # why\n", "a: 1  # because\n", "a: 2  # because\n", id="a comment changed"
        ),
    ],
)
def test_what_both_sides_say_is_merged_where_lines_conflict(base: str, ours: str, theirs: str, merged: str) -> None:
    assert merge_lines(base.encode(), ours.encode(), theirs.encode()).conflict_count
    assert merge(base, ours, theirs) == merged


REFORMATTED = """\
g:
  b:
    rate: 3 Hz
  # The camera.
  a:
    rate: 1 Hz
    wcet: 2 ms
"""


@pytest.mark.parametrize(
    ("edited", "merged"),
    [
        pytest.param(
            "g:\n  # The camera.\n  a: {rate: 1 Hz, wcet: 4 ms}\n  b: {rate: 3 Hz}\n",
            REFORMATTED.replace("2 ms", "4 ms"),
            id="a value",
        ),
        pytest.param(
            "g:\n  # The camera.\n  a: {rate: 1 Hz, wcet: 2 ms}\n  b: {rate: 3 Hz, host: pc}\n",
            REFORMATTED.replace("3 Hz\n", "3 Hz\n    host: pc\n"),
            id="a new key",
        ),
        pytest.param(
            "g:\n  # The camera.\n  a: {rate: 1 Hz}\n  b: {rate: 3 Hz}\n",
            REFORMATTED.replace("    wcet: 2 ms\n", ""),
            id="a key removed",
        ),
        pytest.param(
            "g:\n  b: {rate: 3 Hz}\n",
            "g:\n  b:\n    rate: 3 Hz\n",
            id="an element removed with its comment",
        ),
        pytest.param(
            "g:\n  # The camera.\n  a: {rate: 1 Hz, wcet: 2 ms}\n  b: {rate: 3 Hz}\n  # New.\n  c:\n    o: [x]\n",
            REFORMATTED.replace("3 Hz\n", "3 Hz\n  # New.\n  c:\n    o: [x]\n"),
            id="an element added with its comment",
        ),
    ],
)
@pytest.mark.parametrize("is_ours_reformatted", [True, False])
def test_a_small_change_is_carried_into_a_reformatted_text(
    edited: str, merged: str, *, is_ours_reformatted: bool
) -> None:
    base = "g:\n  # The camera.\n  a: {rate: 1 Hz, wcet: 2 ms}\n  b: {rate: 3 Hz}\n"
    sides = (REFORMATTED, edited) if is_ours_reformatted else (edited, REFORMATTED)
    assert merge(base, *sides) == merged


LISTED = """\
review:
  passes:
    - R-1
    - R-2   # since March
    - "No dust, ever"
  text: >-
    One line,
    and another.
"""


@pytest.mark.parametrize(
    ("old", "new"),
    [
        pytest.param("    - R-1\n", "", id="an item removed"),
        pytest.param('ever"\n', 'ever"\n    - R-3   # since May\n', id="an item added with its comment"),
        pytest.param("and another.\n", "and another,\n    and a third.\n", id="a folded text"),
    ],
)
@pytest.mark.parametrize("is_ours_reformatted", [True, False])
def test_a_change_of_a_few_lines_is_carried_into_a_text_indented_anew(
    old: str, new: str, *, is_ours_reformatted: bool
) -> None:
    reindented, edited = LISTED.replace("    ", "      "), LISTED.replace(old, new)
    sides = (reindented, edited) if is_ours_reformatted else (edited, reindented)
    assert merge(LISTED, *sides) == edited.replace("    ", "      ")


def test_a_list_whose_order_counts_is_carried_into_a_text_where_lines_conflict() -> None:
    base = "nodes:\n  a:\n    arguments:\n      - x\n  b: {package: p}\n"
    theirs = base.replace("- x", "- x\n      - z").replace("  b: {package: p}\n", "  c: {package: q}\n")
    ours = base.replace("      - x", "    - x").replace("  b: {package: p}\n", "  d: {package: r}\n")
    merged = merge(base, ours, theirs)
    assert isinstance(merged, str)
    assert "    arguments:\n    - x\n    - z\n" in merged
    in_brackets = merge(base, ours.replace("arguments:\n    - x", "arguments: [x]"), theirs)
    assert isinstance(in_brackets, str)
    assert "    arguments: [x, z]\n" in in_brackets


def test_a_comment_of_what_the_other_side_took_out_stays() -> None:
    base = "nodes:\n  a:\n    host: pc\n  b: {package: p}\n"
    merged = merge(
        base, base.replace("host: pc", "host: pc  # the small one"), base.replace("    host: pc\n", "    package: q\n")
    )
    assert merged == "nodes:\n  a:\n    # the small one\n    package: q\n  b: {package: p}\n"


def test_an_item_is_added_to_a_list_that_now_stands_in_brackets() -> None:
    base = "sources:\n  - R-1\n  - R-2\n"
    ours, theirs = 'sources: [R-1, R-2, "a b"]\n', base + "  - R-3\n"
    assert merge(base, ours, theirs) == 'sources: [R-1, R-2, "a b", R-3]\n'


@pytest.mark.parametrize(
    ("base", "ours", "theirs", "path"),
    [
        ("a: {rate: 1 Hz}\n", "a: {rate: 2 Hz}\n", "a: {rate: 3 Hz}\n", ("a", "rate")),
        ("a: {r: 1}\nb: 1\n", "b: 1\n", "a: {r: 2}\nb: 1\n", ("a",)),
        ("a: 1\n", "a: 1\nn: {r: 1}\n", "a: 1\nn: {r: 2}\n", ("n", "r")),
        ("c: {through: [a, b]}\n", "c: {through: [a, x, b]}\n", "c: {through: [a, y, b]}\n", ("c", "through")),
        ("v: 1.1\n", "v: 1.10\n", "v: 1.2\n", ("v",)),
        ("chains: {from: [a]}\n", "chains: {from: [a, b]}\n", "chains: {from: [a, c]}\n", ("chains", "from")),
        ("l: 1\n", "l: 1\nk: {connects: [a, b]}\n", "l: 1\nk: {connects: [a, c]}\n", ("k", "connects")),
        ("types: {T: p/msg/A}\n", "types: {T: {message: p/msg/B}}\n", "types: {T: p/msg/C}\n", ("types", "T")),
        (
            "parameters: {tags: [1]}\n",
            "parameters: {tags: [1, 2]}\n",
            "parameters: {tags: [1, 3]}\n",
            ("parameters", "tags"),
        ),
    ],
)
def test_what_both_sides_changed_in_their_own_way_is_named(
    base: str, ours: str, theirs: str, path: tuple[str, ...]
) -> None:
    assert merge(base, ours, theirs) == UnmergedSlice(path)


@pytest.mark.parametrize("broken", ["a: [\n", "a: 1\na: 2\n", "<<<<<<< ours\n", "a: \t- x\n"])
def test_what_cannot_be_read_as_a_whole_is_left_to_git(broken: str) -> None:
    for versions in ((broken, "a: 1\n", "a: 1\n"), ("a: 1\n", broken, "a: 2\n"), ("a: 1\n", "a: 2\n", broken)):
        assert merge(*versions) == UnmergedSlice()


def test_lines_that_merge_into_something_else_are_refused() -> None:
    # git puts the key twice: both sides added it, at two places.
    base = "a:\n  p: 1\n  q: 2\n  r: 3\n  s: 4\n  t: 5\n"
    ours, theirs = base.replace("  p", "  tags: [x]\n  p"), base + "  tags: [x]\n"
    assert merge_lines(base.encode(), ours.encode(), theirs.encode()).content.count(b"tags") == 2
    merged = merge(base, ours, theirs)
    assert isinstance(merged, str)
    assert merged.count("tags") == 1


def test_a_comment_is_never_lost() -> None:
    # The comment between the keys cannot stand within braces on one line, so nothing is proposed that drops it.
    base = "a: {p: 1, q: 2}\n"
    merged = merge(base, "a: {p: 1, q: 2, r: 3}\n", "a:\n  # Why.\n  p: 1\n  q: 2\n  s: 4\n")
    assert isinstance(merged, str)
    assert "# Why." in merged


KEYS = st.sampled_from(["a", "b", "c", "tags", "from"])
SCALARS = st.sampled_from([1, 2, "x", "y z", "10 Hz", True, None, "# no comment"])
LISTS = st.lists(st.sampled_from(["x", "y", "z"]), max_size=3)
TREES = st.recursive(SCALARS | LISTS, lambda inner: st.dictionaries(KEYS, inner, max_size=4), max_leaves=12)
ROOTS = st.dictionaries(KEYS, TREES, max_size=4)


@st.composite
def edited_trees(draw: st.DrawFn, tree: object) -> object:
    """Draw a tree that differs from another one here and there."""
    if not isinstance(tree, dict) or draw(st.integers(0, 9)) == 0:
        return draw(TREES) if draw(st.booleans()) else tree
    edited = {key: draw(edited_trees(value)) if draw(st.booleans()) else value for key, value in tree.items()}
    if edited and draw(st.integers(0, 3)) == 0:
        edited.pop(draw(st.sampled_from(sorted(edited))))
    return edited | draw(st.dictionaries(KEYS, TREES, max_size=1))


def write(data: Mapping[str, object], *, in_braces: bool) -> str:
    return f"{format_flow(data)}\n" if in_braces and data else write_yaml(data)


@given(st.data())
@settings(max_examples=count_examples(400), deadline=None)
def test_whatever_is_merged_says_what_both_sides_say(data: st.DataObject) -> None:
    base = data.draw(ROOTS)
    ours, theirs = (
        tree if isinstance(tree, dict) else {}
        for tree in (data.draw(edited_trees(base)), data.draw(edited_trees(base)))
    )
    texts = [write(tree, in_braces=data.draw(st.booleans())) for tree in (base, ours, theirs)]
    values = []
    for text in texts:
        document, _ = yaml_parser.parse_yaml("slice", text)
        if document is None:  # an empty file
            return
        values.append(read_merged_value(document.root))
    merged = merge_slices(SliceVersions(*texts))
    expected = _merge_or_conflict(*values)
    if not isinstance(merged, str):
        assert merged == (expected if isinstance(expected, UnmergedSlice) else UnmergedSlice(is_settled=True))
        return
    document, _ = yaml_parser.parse_yaml("slice", merged)
    assert document is not None
    assert read_merged_value(document.root) == expected


def _merge_or_conflict(base: MergedValue, ours: MergedValue, theirs: MergedValue) -> MergedValue | UnmergedSlice | None:
    try:
        return merge_values(base, ours, theirs)
    except MergeConflictError as conflict:
        return UnmergedSlice(conflict.path)


TYPE = "types:\n  Pose:\n    fields:\n      x: float64\n      y: float64\n"


def test_the_order_of_fields_is_merged_and_nothing_of_it_is_guessed() -> None:
    turned = "types:\n  Pose:\n    fields:\n      y: float64\n      x: float64\n"
    commented = TYPE.replace("x: float64", "x: {type: float64, unit: m}")
    assert merge(TYPE, turned, commented) == turned.replace("x: float64", "x: {type: float64, unit: m}")
    added = TYPE.replace("      x:", "      before: bool\n      x:")
    appended = TYPE + "      after: bool\n"
    assert merge(TYPE, added, appended) == added + "      after: bool\n"
    assert merge(TYPE, appended, TYPE + "      other: bool\n") == UnmergedSlice(("types", "Pose", "fields", "(order)"))
