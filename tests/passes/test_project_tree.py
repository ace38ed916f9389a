"""The tree that passes edit: what is written, and what each made value says of where it comes from."""

from __future__ import annotations

import pytest

from archgen.diagnostics.element_origins import Origin
from archgen.diagnostics.source_span import Span
from archgen.passes.project_tree import ProjectTree, have_same_content
from archgen.syntax.yaml_parser import parse_yaml
from archgen.syntax.yaml_tree import MappingNode, node_to_data


def grow(text: str, maker: str = "grow") -> ProjectTree:
    """Return the tree of a text, edited by a pass."""
    document, _ = parse_yaml("a.yaml", text)
    assert document is not None
    tree = ProjectTree(document.root)
    tree.maker = maker
    return tree


def line_of(origin: Origin) -> int:
    assert origin.at.file == "a.yaml"
    return origin.at.line


TEXT = """\
groups:
  g:
    components:
      a: {outputs: {x: {type: T}}}
      b:
        tags: [fast]
        inputs: {y: }
"""
B = ("groups", "g", "components", "b")
OUTPUT = ("groups", "g", "components", "a", "outputs", "x")


def test_the_tree_that_it_is_made_from_stays_as_it_is() -> None:
    document, _ = parse_yaml("a.yaml", TEXT)
    assert document is not None
    tree = ProjectTree(document.root)
    tree.set((*B, "title"), "B", B)
    tree.append((*B, "tags"), "new", B)
    assert "title" not in str(node_to_data(document.root))
    assert "new" not in str(node_to_data(document.root))


def test_what_is_set_carries_the_place_and_the_path_of_its_source() -> None:
    tree = grow(TEXT)
    tree.set((*B, "inputs", "y", "from"), ["a.x"], OUTPUT)
    assert node_to_data(tree.root)["groups"]["g"]["components"]["b"]["inputs"] == {"y": {"from": ["a.x"]}}  # type: ignore[index]
    origin = tree.trace((*B, "inputs", "y", "from", 0))
    # `y` held nothing: the mapping in its place was made with what is in it.
    assert origin.passes == ("grow",)
    assert line_of(origin) == 4
    assert origin.path == OUTPUT
    assert tree.trace((*B, "tags")) == Origin((), Span("a.yaml", 6, 9, 6, 13), (*B, "tags"))


def test_a_key_that_is_set_again_keeps_its_place_and_equal_values_change_nothing() -> None:
    tree = grow(TEXT)
    tree.set((*OUTPUT, "type"), "T", OUTPUT)
    assert (tree.edit_count, tree.provenance) == (0, {})
    tree.set((*OUTPUT, "type"), "Envelope<T>", (*OUTPUT, "type"))
    assert tree.get_text((*OUTPUT, "type")) == "Envelope<T>"
    assert tree.find_place((*OUTPUT, "type")) == Span("a.yaml", 4, 25, 4, 29)
    node = tree.get((*OUTPUT, "type"))
    assert node is not None
    assert node.span == Span("a.yaml", 4, 31, 4, 32)
    assert tree.edit_count == 1


def test_what_several_passes_make_of_one_another_names_all_of_them_and_the_first_source() -> None:
    tree = grow(TEXT)
    tree.set((*B, "outputs", "z"), {"type": "T"}, OUTPUT)
    tree.maker = "wrap"
    made = (*B, "outputs", "z", "type")
    tree.set(made, "Envelope<T>", made)
    origin = tree.trace(made)
    assert origin.passes == ("grow", "wrap")
    assert origin.path == OUTPUT
    assert tree.trace((*B, "outputs", "z")).passes == ("grow",)
    # The same pass again is not named twice.
    tree.set(made, "Envelope<Envelope<T>>", made)
    assert tree.trace(made).passes == ("grow", "wrap")


def test_mappings_merge_and_everything_else_is_replaced() -> None:
    tree = grow(TEXT)
    tree.merge(B, {"tags": ["slow"], "inputs": {"z": {"type": "T"}}, "title": "B"}, OUTPUT)
    assert node_to_data(tree.root)["groups"]["g"]["components"]["b"] == {  # type: ignore[index]
        "tags": ["slow"],
        "inputs": {"y": None, "z": {"type": "T"}},
        "title": "B",
    }
    assert tree.trace((*B, "inputs", "y")).passes == ()
    assert tree.trace((*B, "inputs", "z")).passes == ("grow",)


def test_items_are_appended_once_and_origins_follow_the_items_that_stay() -> None:
    tree = grow(TEXT)
    tags = (*B, "tags")
    for text in ("new", "fast", "newer"):
        tree.append(tags, text, OUTPUT)
    assert node_to_data(tree.root)["groups"]["g"]["components"]["b"]["tags"] == ["fast", "new", "newer"]  # type: ignore[index]
    assert [len(tree.trace((*tags, number)).passes) for number in range(3)] == [0, 1, 1]
    tree.drop((*tags, 0))
    assert [len(tree.trace((*tags, number)).passes) for number in range(2)] == [1, 1]
    tree.drop((*tags, 0))
    assert node_to_data(tree.root)["groups"]["g"]["components"]["b"]["tags"] == ["newer"]  # type: ignore[index]
    assert set(tree.provenance) == {(*tags, 0)}


def test_a_scalar_in_the_place_of_a_list_is_its_first_item() -> None:
    tree = grow("a: {from: x}\nb: {}\n")
    tree.append(("a", "from"), "x", ("b",))
    assert node_to_data(tree.root) == {"a": {"from": "x"}, "b": {}}
    tree.append(("a", "from"), "y", ("b",))
    tree.append(("b", "from"), "z", ("a",))
    assert node_to_data(tree.root) == {"a": {"from": ["x", "y"]}, "b": {"from": ["z"]}}
    assert tree.trace(("a", "from", 0)).passes == ()


def test_what_is_dropped_takes_its_origins_along() -> None:
    tree = grow(TEXT)
    tree.set((*B, "outputs", "z", "type"), "T", OUTPUT)
    tree.drop((*B, "outputs"))
    tree.drop((*B, "nothing"))
    tree.drop((*B, "tags", 7))
    assert tree.provenance == {}
    assert tree.edit_count == 2


def test_edits_where_nothing_can_stand_are_mistakes_of_the_pass() -> None:
    tree = grow(TEXT)
    with pytest.raises(TypeError, match="no mapping"):
        tree.set((*OUTPUT, "type", "deeper"), "T", OUTPUT)
    with pytest.raises(TypeError, match="no list"):
        tree.set((*OUTPUT, 0), "T", OUTPUT)


def test_places_of_what_is_missing_are_those_of_what_is_around() -> None:
    tree = grow(TEXT)
    assert tree.find_place((*B, "outputs", "z")).line == 5
    assert tree.find_place((*B, "tags", 0)) == Span("a.yaml", 6, 16, 6, 20)
    assert tree.find_place(()) == tree.root.span


def test_contents_are_compared_by_text_and_order_of_lists_alone() -> None:
    first, second, third = (grow(text).root for text in ("{a: 1, b: [x, y]}", "{b: [x, y], a: 1}", "{b: [y, x], a: 1}"))
    assert have_same_content(first, second)
    assert not have_same_content(first, third)
    assert not have_same_content(first, MappingNode({}, first.span))
