"""What linking remembers: indexes and names are found again where nothing of them changed."""

from __future__ import annotations

import pytest

from archgen.compose import expand_project
from archgen.link.data_types.field_types import TypeSources
from archgen.link.declare.type_declaration import declare_types
from archgen.link.element_outline import build_outline
from archgen.link.link_memory import LinkMemory
from archgen.link.project_linking import link_project
from archgen.link.slice_merging import merge_documents
from archgen.model.known_interfaces import Interfaces
from archgen.syntax import yaml_parser


def test_an_index_is_found_again_for_the_same_ids_alone() -> None:
    memory = LinkMemory()
    first = memory.index_paths("component", ["sensing.camera", "sensing.lidar"])
    assert first.ends["lidar"] == ["sensing.lidar"]
    assert memory.index_paths("component", ["sensing.camera", "sensing.lidar"]) is first
    other = memory.index_paths("component", ["sensing.camera"])
    assert "lidar" not in other.ends
    assert memory.index_paths("node", ["sensing.camera", "sensing.lidar"]) is not first
    assert memory.index_paths("component", ["sensing.camera", "sensing.lidar"]) is first


def test_names_are_the_same_object_where_no_name_came_or_went() -> None:
    memory = LinkMemory()
    names = memory.recall_names({"component": ["a.b"]}, {"host": ["pc"]})
    assert memory.recall_names({"component": ["a.b"]}, {"host": ["pc"]}) is names
    assert memory.recall_names({"component": ["a.b"]}, {"host": []}) is not names


@pytest.mark.parametrize(
    ("lost_keys", "damaged_elements", "remembered"),
    [
        ((), (), ["eye"]),
        (("lidar",), (), []),
        ((), ("g.lidar",), []),
        (("lidar",), ("g.lidar",), []),
    ],
)
def test_only_a_project_that_was_read_whole_is_remembered(
    lost_keys: tuple[str, ...], damaged_elements: tuple[str, ...], remembered: list[str]
) -> None:
    document, _ = yaml_parser.parse_yaml("a.yaml", "groups: {g: {components: {eye: {outputs: {image: Image}}}}}\n")
    assert document is not None
    table, _ = merge_documents([document])
    expansion = expand_project(table)
    outline, memory = build_outline(expansion), LinkMemory()
    link_project(
        expansion,
        outline,
        default_id="r",
        default_title="R",
        declared_types=declare_types(table, outline, TypeSources("r", {}, "jazzy")),
        interfaces=Interfaces("jazzy"),
        lost_keys=frozenset(lost_keys),
        damaged_elements=frozenset(damaged_elements),
        memory=memory,
    )
    assert [known.component.name for known in memory.leaves.list_known("g.eye")] == remembered
