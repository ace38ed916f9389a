"""What a robot knows, written into the design: each difference that a rule's name asks for is gone, or told as left out."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from archgen.conformance.endpoint_comparison import ModelRemedy
from archgen.conformance.robot_comparison import ComparedPart
from archgen.edit.adopted_remedies import Adoption, FindingNames, plan_adoption
from archgen.importers.robot_observation import ObservationOptions, observe_robot
from archgen.pipeline import CheckedProject, check_project
from archgen.products.robot_conformance import adopt_remedies, hold_against_robots
from tests.conformance.rovers import ROVER, check_rover, compare_with_graph, print_graph, show_findings
from tests.conformance.test_robot_comparison import FAULTS

FOLLOWED = {"other-type", "other-qos", "other-name", "other-parameter", "not-latched"}
"""Rules that the design can follow: a node that is gone or strange it cannot."""

WITHOUT_REMEDY = {
    *(
        "reliability that no longer fits",
        "durability that no longer fits",
    ),  # both ends as they are would not fit in the design
    "parameter that nobody declares",
}


@pytest.fixture(scope="module")
def graph(tmp_path_factory: pytest.TempPathFactory) -> str:
    return print_graph(check_rover(tmp_path_factory.mktemp("rover")).architecture)


def adopt(checked_project: CheckedProject, graph: str, rules: Sequence[str]) -> Adoption:
    """Plan what a graph tells, and write it."""
    (checked_project.root / "graph.txt").write_text(graph, encoding="utf-8")
    robot = observe_robot(checked_project.root / "graph.txt", checked_project.root, ObservationOptions())
    adoption = adopt_remedies(checked_project, [robot], ComparedPart(), rules)
    for edit in adoption.edits:
        (checked_project.root / edit.file).write_bytes(edit.new_content)
    return adoption


@pytest.mark.parametrize("name", FAULTS)
def test_a_difference_is_followed_where_its_rule_is_named_and_never_otherwise(
    tmp_path: Path, graph: str, name: str
) -> None:
    checked_project = check_rover(tmp_path)
    planted = FAULTS[name][0](graph)
    before = {each.rule for each in compare_with_graph(checked_project, planted).reported.findings}
    assert adopt(checked_project, planted, ()).adopted == ()
    adoption = adopt(checked_project, planted, sorted(before))
    after = compare_with_graph(check_rover(tmp_path, (tmp_path / "archgen.yaml").read_text()), planted)
    left = {each.rule for each in after.reported.findings}
    refused = {remedy.rule for remedy, reason in adoption.left_out if reason}
    assert left <= before
    assert bool((left & FOLLOWED) - refused) is (name in WITHOUT_REMEDY)


def test_a_difference_is_written_where_the_design_says_it(tmp_path: Path, graph: str) -> None:
    planted = graph.replace("    /image: sensor_msgs/msg/Image\n", "    /image: sensor_msgs/msg/CompressedImage\n")
    planted = planted.replace("rate: 12.5", "rate: 15.0").replace(
        "Topic type: sensor_msgs/msg/Image", "Topic type: x/msg/X"
    )
    planted = planted.replace("ros2 topic info -v /cmd_vel", "ros2 topic info -v /velocity").replace(
        "    /cmd_vel: ", "    /velocity: "
    )
    adoption = adopt(check_rover(tmp_path), planted, ["other-parameter", "other-name"])
    assert [each.message for each in adoption.adopted]
    lines = zip(ROVER.splitlines(), (tmp_path / "archgen.yaml").read_text(encoding="utf-8").splitlines(), strict=True)
    assert [new for old, new in lines if old != new] == [
        "    parameters: {rate: 15.0}",
        "    publishes: {cmd_vel: /velocity}",
        "  base: {implements: motion.base, host: base, status: existing, subscribes: {cmd_vel: /velocity}, publishes: {odom: odom}}",
    ]


def test_what_the_design_leaves_open_is_filled_and_proven(tmp_path: Path) -> None:
    """Names, types and policies of which nobody wrote anything; a remedy that breaks the project is left out alone."""
    text = (
        ROVER.replace("subscribes: {odom: odom}, calls", "subscribes: {odom: {}}, calls")
        .replace("odom: nav_msgs/msg/Odometry", "odom: ")
        .replace("publishes: {image: /image}}\n", "publishes: {image: {own_name: /image}}}\n")
    )
    graph = print_graph(check_rover(tmp_path / "whole").architecture)
    node = "Node name: {}\nNode namespace: /\nTopic type: sensor_msgs/msg/Image\nEndpoint type: {}\nQoS profile:\n  Reliability: RELIABLE"
    for name, end in (("camera", "PUBLISHER"), ("planner", "SUBSCRIPTION")):
        assert node.format(name, end) in graph
        graph = graph.replace(node.format(name, end), node.format(name, end).replace("RELIABLE", "BEST_EFFORT"))
    checked_project = check_rover(tmp_path / "open", text)
    adoption = adopt(checked_project, graph, ())
    assert [reason for _, reason in adoption.left_out] == []
    new_text = (checked_project.root / "archgen.yaml").read_text(encoding="utf-8")
    assert "publishes: {image: {own_name: /image, qos: {reliability: best_effort}}}" in new_text
    assert (
        "subscribes: {scan: {topic: /scan, qos: sensor_data}, image: {topic: /image, qos: {reliability: best_effort}}}"
        in new_text
    )
    assert "publishes: {odom: {topic: odom, message: nav_msgs/msg/Odometry}}" in new_text
    again = compare_with_graph(check_rover(tmp_path / "open", new_text), graph)
    assert show_findings(again.reported.findings) == []
    assert not again.comparisons[0].remedies


def test_what_the_project_accepts_or_silences_is_not_followed(tmp_path: Path, graph: str) -> None:
    accepted = "conform: {accepted: {lidar: {rule: other-parameter, reason: it is tuned}}}\n"
    checked_project = check_rover(tmp_path, ROVER + accepted)
    assert adopt(checked_project, graph.replace("rate: 12.5", "rate: 10.0"), ["other-parameter"]) == Adoption()
    robot = observe_robot(checked_project.root / "graph.txt", checked_project.root, ObservationOptions())
    assert hold_against_robots(checked_project, [robot], ComparedPart()).accepted_count == 1


_MANY = 32


@pytest.mark.parametrize(("wrong", "most_trials"), [((), 1), ((20,), 13), ((0, 31), 19), (range(_MANY), _MANY + 5)])
def test_few_wrong_remedies_of_many_are_found_in_few_trials(
    tmp_path: Path, wrong: Sequence[int], most_trials: int
) -> None:
    nodes = "".join(f"  n{number}: {{parameters: {{rate: 1}}}}\n" for number in range(_MANY))
    (tmp_path / "archgen.yaml").write_text(f"archgen: 1\nnodes:\n{nodes}", encoding="utf-8")
    remedies = [
        ModelRemedy("other-parameter", f"n{number}", "", f"n{number}", ("parameters",), {"rate": 2})
        for number in range(_MANY)
    ]
    tried: list[set[int]] = []

    def compare(project: CheckedProject) -> FindingNames:
        nodes = project.architecture.nodes
        tried.append({number for number in range(_MANY) if nodes[f"n{number}"].parameters["rate"] == 2})
        return frozenset(
            ("other-parameter", f"n{number}") for number in range(_MANY) if number not in tried[-1] or number in wrong
        )

    adoption = plan_adoption(check_project(tmp_path), remedies, compare)
    assert [each.node for each in adoption.adopted] == [f"n{number}" for number in range(_MANY) if number not in wrong]
    assert [each.node for each, _ in adoption.left_out] == [f"n{number}" for number in wrong]
    assert len(tried) - 1 <= most_trials  # the first one is of the project as it is
    text = "".join(edit.new_content.decode() for edit in adoption.edits)
    assert text.count("rate: 2") == _MANY - len(wrong)
