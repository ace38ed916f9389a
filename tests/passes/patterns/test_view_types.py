"""What rules see of conceptual types, and of values in the tree."""

from __future__ import annotations

from pathlib import Path

from archgen.passes.patterns.pattern_shapes import PortReference
from archgen.passes.patterns.view_elements import ConceptualTypes
from archgen.passes.patterns.view_values import read_scalar, read_view_value
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, YamlNode
from tests.passes.patterns.transforming import tree_of

ROBOT = """\
archgen: 1
project: {id: robot}
libraries:
  parts:
    types: {Pose: {message: geometry_msgs/msg/Pose}, Scan: {message: sensor_msgs/msg/LaserScan}}
groups: {g: {components: {eye: {outputs: {seen: {type: Pose, external: true}}}}}}
types: {Robot pose: {message: geometry_msgs/msg/PoseStamped}, Pose: {message: geometry_msgs/msg/Pose2D}}
"""


def test_types_of_the_project_hide_those_of_libraries(tmp_path: Path) -> None:
    types = ConceptualTypes(tree_of(ROBOT, tmp_path))
    assert types.list_names() == ("Robot pose", "Pose", "Scan")
    assert types.get_body("Pose") == {"message": "geometry_msgs/msg/Pose2D"}
    assert types.get_body("Map") is None


def test_a_type_is_written_where_it_stands_and_a_new_one_into_the_project(tmp_path: Path) -> None:
    types = ConceptualTypes(tree_of(ROBOT, tmp_path))
    assert types.find_path("Scan") == ("libraries", "parts", "types", "Scan")
    assert types.find_path("Pose") == ("types", "Pose")
    assert types.find_path("Map") == ("types", "Map")


def test_an_edit_is_seen_once_the_types_are_read_again(tmp_path: Path) -> None:
    tree = tree_of(ROBOT, tmp_path)
    types = ConceptualTypes(tree)
    assert "Scan" in types.list_names()
    tree.drop(("libraries", "parts", "types", "Scan"))
    assert "Scan" in types.list_names()
    types.forget_bodies()
    assert "Scan" not in types.list_names()


def test_scalars_are_texts_and_what_is_left_empty_is_nothing(tmp_path: Path) -> None:
    port = tree_of(ROBOT, tmp_path).get(("groups", "g", "components", "eye", "outputs", "seen"))
    assert isinstance(port, MappingNode)
    assert read_view_value(port, lambda _: None, {}) == {"type": "Pose", "external": "true"}
    assert read_scalar(ScalarNode(None, "", port.span)) is None


def test_references_to_what_stands_in_a_type_move_to_what_is_made_from_it(tmp_path: Path) -> None:
    node = tree_of(ROBOT, tmp_path).get(("types", "Pose", "message"))
    assert node is not None

    def move(reference: PortReference) -> tuple[str, str | None, str | None]:
        def find_reference(_node: YamlNode) -> PortReference:
            return reference

        moved = read_view_value(node, find_reference, {"station": "robot.head"})
        assert isinstance(moved, PortReference)
        return moved.component, moved.port, moved.holder

    assert move(PortReference("station.eye", "image")) == ("robot.head.eye", "image", None)
    assert move(PortReference("station", "order", holder="station")) == ("robot.head", "order", "robot.head")
    assert move(PortReference("robot.left", "image")) == ("robot.left", "image", None)
