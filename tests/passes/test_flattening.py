"""Hierarchy taken away: leaves say themselves what was around them, and other programs see what they saw."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from archgen.model.architecture import Architecture
from archgen.passes.flattening import name_flat_components
from archgen.pipeline import CheckedProject, transform_project
from archgen.timing.chains.chain_bounds import bound_all_chains
from tests.judged_projects import judge_shipped
from tests.passes.random_projects import RandomProject
from tests.passes.same_meaning import EXAMPLES, check_packed, pack, transform_alike, write_project
from tests.property_sizes import list_seeds

CONNECTING = ("connect_components", "connect_ports", "connect_types")


def list_flat_ids(checked: CheckedProject) -> dict[str, str]:
    """Return the ids that leaves get, by those that they have: by the names that nodes have in any case."""
    nodes = [node.id for node in checked.architecture.nodes.values()]
    written = checked.merged_table.get("nodes")
    written_names = list(written.entries) if written is not None else []  # type: ignore[union-attr]
    leaves = list(checked.architecture.components)
    deep_names = {each.rpartition(".")[2] for each in leaves if each.count(".") > 1}
    assert nodes
    all_ids = [*dict.fromkeys([*leaves, *checked.architecture.shells])]
    return name_flat_components(leaves, all_ids, [name for name in written_names if name not in deep_names])


def list_writers(architecture: Architecture) -> set[tuple[str, ...]]:
    """Return which nodes write each topic that somebody writes."""
    topics = architecture.topics.items()
    return {(name, *sorted(each.node for each in topic.writers)) for name, topic in topics if topic.writers}


def flatten_alike(checked: CheckedProject, *, finds_same: bool = True) -> CheckedProject:
    """Return a flat project of which the same holds as before, but for the paths of components.

    `finds_same`: whether the same is found, too, at the same places: nothing in it is half designed.
    """
    transformed = transform_project(checked, ["flatten"])
    before, after = checked.architecture, transformed.architecture
    flat_ids = list_flat_ids(checked)
    assert set(after.components) == set(flat_ids.values())
    assert after.shells == {}

    def rename(port: str) -> str:
        component_id, _, name = port.rpartition(".")
        return f"{flat_ids[component_id]}.{name}"

    assert {(each.output, each.input, each.at) for each in after.edges} == {
        (rename(each.output), rename(each.input), each.at) for each in before.edges
    }
    found_before = {(each.rule, str(each.span)) for each in checked.findings}
    assert {(each.rule, str(each.span)) for each in transformed.findings} == found_before or not finds_same
    # What other programs see stays: ids and names of nodes, and who uses which topic.
    node_keys = ("name", "namespace", "package", "executable", "host", "container", "status", "written", "parameters")
    for node_id, node in before.nodes.items():
        for key in node_keys:
            assert getattr(after.nodes[node_id], key) == getattr(node, key), (node_id, key)
        assert after.nodes[node_id].implements == tuple(flat_ids[each] for each in node.implements)
    assert list_writers(after) == list_writers(before)
    if checked.analysis is not None:
        assert transformed.analysis is not None
        bounds = bound_all_chains(checked.analysis, before)
        flat_bounds = bound_all_chains(transformed.analysis, after)
        assert {name: (each.bound, each.verdict) for name, each in flat_bounds.items()} == {
            name: (each.bound, each.verdict) for name, each in bounds.items()
        }
    assert pack(transform_project(transformed, ["flatten"])) == pack(transformed)
    return transformed


@pytest.mark.parametrize("seed", list_seeds(40))
def test_random_projects(seed: int, tmp_path: Path) -> None:
    checked = write_project(tmp_path / "robot", RandomProject(seed).text)
    if any(str(each.severity) == "error" for each in checked.findings):
        # A connection between ports of two types, mostly.
        assert transform_project(checked, ["flatten"]).architecture.shells == {}
        return
    transform_alike(checked, *CONNECTING, "resolve_instances", "remove_generics", finds_same=False)
    check_packed(flatten_alike(checked, finds_same=False), tmp_path / "flat")


@pytest.mark.parametrize("example", ["cleaning_robot", "arm", "vehicle/scenario", "bringup", "first_robot"])
def test_the_examples(example: str, tmp_path: Path) -> None:
    transformed = flatten_alike(judge_shipped(EXAMPLES / example))
    check_packed(transformed, tmp_path)


def test_the_middle_of_figure_2(tmp_path: Path) -> None:
    transformed = transform_project(judge_shipped(EXAMPLES / "cleaning_robot"), ["flatten"])
    components = yaml.safe_load(pack(transformed))["groups"]["cleaning"]["components"]
    arm = ("planner", "shoulder", "elbow", "watch")
    assert list(components) == [
        "lidar",
        "gps",
        "pose_fusion",
        "smooth",
        "navigation",
        "controller",
        *(f"left_arm_{name}" for name in arm),
        *(f"right_arm_{name}" for name in arm),
    ]
    connections = {
        f"{name}.{port}": body["from"]
        for name, component in components.items()
        for port, body in component["inputs"].items()
        if "from" in body
    }
    assert connections == {
        "pose_fusion.lp": ["lidar.p"],
        "pose_fusion.gp": ["gps.p"],
        "smooth.raw": ["pose_fusion.p"],
        "navigation.pose": ["smooth.clean"],
        "controller.map": ["navigation.map"],
        "controller.way": ["navigation.way"],
        "controller.arms": ["left_arm_watch.state", "right_arm_watch.state"],
        **{
            f"{side}_arm_{reader}": [
                f"{side}_arm_{source}" if source.partition(".")[0] in arm else source for source in sources
            ]
            for side in ("left", "right")
            for reader, sources in {
                "planner.target": [f"controller.{side}"],
                "shoulder.target": ["planner.shoulder"],
                "elbow.target": ["planner.elbow"],
                "watch.joints": ["shoulder.state", "elbow.state"],
            }.items()
        },
    }
    # The surroundings come in from outside of the system, now at the leaf; the arm's side is known.
    assert components["lidar"]["inputs"]["surroundings"] == {
        "type": "Light",
        "medium": "physical",
        "external": "The rooms",
    }
    assert components["right_arm_elbow"]["parameters"]["joint"]["value"] == "right_elbow"
    del tmp_path


ON_TYPE = """\
component_types:
  robot:
    owner: certh
    autoconnect: ports
    inputs: {goal: {type: Goal}}
    outputs: {pose: {type: Pose}}
    tags: [moving]
    components: [drive, watch]
  drive: {inputs: {goal: Goal}, outputs: {pose: Pose, seen: Pose}, tags: [safe]}
  watch: {inputs: {seen: Pose}}
groups:
  fleet:
    title: Fleet
    components:
      one: {is: robot, owner: certh, inputs: {goal: desk.goal}, node: {namespace: one, whole: true, package: p, executable: e}}
      two: {is: robot, owner: certh, inputs: {goal: desk.goal}, node: {namespace: two}}
      desk: {inputs: {poses: fleet}, outputs: {goal: Goal}}
      later: {inputs: {a: one.pose}, outputs: {b: Pose}, components: {stub: Stub}}
nodes:
  desk: {implements: desk, package: p, executable: desk}
partners: {certh: CERTH}
types: {Goal: geometry_msgs/msg/Pose, Pose: geometry_msgs/msg/PoseStamped}
"""


def test_types_wholes_groups_as_sources_and_what_is_not_designed_yet(tmp_path: Path) -> None:
    checked = write_project(tmp_path, ON_TYPE)
    transformed = flatten_alike(checked, finds_same=False)
    check_packed(transformed, tmp_path / "packed")
    data = yaml.safe_load(pack(transformed))
    components = data["groups"]["fleet"]["components"]
    assert list(components) == ["one_drive", "one_watch", "two_drive", "two_watch", "desk", "later", "stub"]
    assert components["one_drive"]["tags"] == ["safe", "moving"]
    # The group stood for what stands directly in it.
    assert components["desk"]["inputs"]["poses"]["from"] == ["one_drive.pose", "two_drive.pose", "later.b"]
    # Ports that nothing inside carries are still there; the one process of the first robot is a node of two components.
    assert components["later"]["inputs"] == {"a": {"from": ["one_drive.pose"]}}
    assert data["nodes"]["one"]["implements"] == ["fleet.one_drive", "fleet.one_watch"]


@pytest.mark.parametrize(
    ("component_ids", "flat_names"),
    [
        (["g.a", "g.b.a"], ["a", "b_a"]),
        (["g.a.x", "g.b.x", "g.a.y"], ["a_x", "b_x", "y"]),
        (["g.a", "h.a"], ["a", "h_a"]),
        (["g.b_x", "g.b.x", "h.x"], ["b_x", "g_b_x", "x"]),
        (["g.used.x"], ["used_x"]),
    ],
)
def test_names_that_fall_together_are_told_apart(component_ids: list[str], flat_names: list[str]) -> None:
    all_ids = [*component_ids, *(each.rpartition(".")[0] for each in component_ids if each.count(".") > 1)]
    flat_ids = name_flat_components(component_ids, all_ids, ["x"] if component_ids == ["g.used.x"] else [])
    assert [each.partition(".")[2] for each in flat_ids.values()] == flat_names


def test_long_paths_still_give_ids() -> None:
    parts = ["a" * 40, "b" * 40]
    ids = [f"g.{parts[0]}.{parts[1]}", f"g.{parts[1]}.{parts[1]}", f"g.{parts[1]}.{parts[0]}.{parts[1]}"]
    flat_ids = name_flat_components(ids, ids, [])
    assert len(set(flat_ids.values())) == len(ids)
    assert all(len(each.partition(".")[2]) <= 64 for each in flat_ids.values())


def test_selectors_name_what_they_selected(tmp_path: Path) -> None:
    views = (
        'views: {a: {show: "2+is:drive -desk tag:safe"}, b: {show: one.**}, c: {show: one}}\n'
        "policies: {p: {forbid: {from: two, to: desk}}}\n"
    )
    checked = write_project(tmp_path, ON_TYPE + views)
    flat = yaml.safe_load(pack(transform_project(checked, ["flatten"])))
    assert flat["views"] == {
        "a": {"show": "2+fleet.one_drive 2+fleet.two_drive -desk tag:safe"},
        "b": {"show": "fleet.one_drive fleet.one_watch"},
        "c": {"show": "fleet.one_drive fleet.one_watch"},
    }
    assert flat["policies"]["p"]["forbid"] == {"from": "fleet.two_drive fleet.two_watch", "to": "desk"}
