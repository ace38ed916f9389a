"""The names that editors offer: which, where, and what is said of them."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from archgen.model.architecture import Architecture
from archgen.views.offered_names import OfferedName, keep_plain_names, list_offered_names

Derived = Callable[[str], Architecture]
ROBOT = """
partners: {lab: The Laboratory}
requirements: {R-1: "It stops\\nin time"}
hosts: {pc: On-board computer}
groups:
  sensing:
    title: The senses
    tags: [safety]
    components:
      lidar:
        title: Lidar
        inputs: {world: {external: Walls, medium: physical}}
        outputs: {scan: Laser scan, state: Robot state}
  driving:
    components:
      planner: {inputs: {scan: lidar.scan}, outputs: {path: Path}}
nodes: {lidar_driver: {implements: lidar, host: pc}}
"""


@pytest.mark.parametrize(
    ("kind", "names"),
    [
        ("partners", [("lab", "The Laboratory")]),
        ("requirements", [("R-1", "It stops in time")]),
        ("hosts", [("pc", "On-board computer")]),
        ("groups", [("sensing", "The senses"), ("driving", "Driving")]),
        ("nodes", [("lidar_driver", "Lidar Driver")]),
        ("tags", [("safety", "")]),
        ("inputs", [("world", "input of Lidar"), ("scan", "input of Planner")]),
        ("selectors", [("sensing", "The senses"), ("driving", "Driving"), ("tag:safety", "what bears this tag"), ("owner:lab", "The Laboratory")]),
        (
            "implemented",
            [("sensing.lidar", "Lidar"), ("lidar", "Lidar"), ("driving.planner", "Planner"), ("planner", "Planner")],
        ),
        (
            "types",
            [
                ("Laser scan", "sensor_msgs/msg/LaserScan"),
                ("Robot state", "no message yet"),
                ("Path", "no message yet"),
            ],
        ),
    ],
)  # fmt: skip
def test_names_stand_with_what_they_mean(kind: str, names: list[tuple[str, str]], derived: Derived) -> None:
    assert sorted(list_offered_names(derived(ROBOT))[kind]) == sorted(OfferedName(*name) for name in names)


def test_outputs_stand_complete_and_without_their_group(derived: Derived) -> None:
    names = [name for name, _ in list_offered_names(derived(ROBOT))["sources"]]
    assert names[:4] == ["sensing.lidar.scan", "lidar.scan", "sensing.lidar.state", "lidar.state"]
    assert names[-2:] == ["sensing", "driving"]


def test_a_short_form_that_means_two_elements_is_not_offered(derived: Derived) -> None:
    twice = "groups: {a: {components: {x: {outputs: {o: T}}}}, b: {components: {x: {outputs: {o: T}}}}}"
    names = list_offered_names(derived(twice))
    assert [name for name, _ in names["sources"]] == ["a.x.o", "b.x.o", "a.x", "b.x", "a", "b"]


def test_a_node_that_is_only_derived_is_no_name_of_the_files(derived: Derived) -> None:
    architecture = derived(ROBOT)
    assert "planner" in {node.id for node in architecture.nodes.values()}
    assert [name for name, _ in list_offered_names(architecture)["nodes"]] == ["lidar_driver"]


def test_a_title_is_one_short_line_without_control_characters(derived: Derived) -> None:
    names = list_offered_names(derived(f'groups: {{a: "x\\e[31m {"y " * 100}"}}'))
    (name,) = names["groups"]
    assert "\x1b" not in name.meaning
    assert name.meaning.startswith("x␛[31m y y")
    assert len(name.meaning) == 100


def test_only_names_that_need_no_quotes_are_plain() -> None:
    names = [OfferedName(word, "") for word in ("a.b", "R-1", "/scan", "~/x", "a: b", "- a", "a b", "#x", "@x", "")]
    assert [name for name, _ in keep_plain_names(names)] == ["a.b", "R-1", "/scan", "~/x"]


def test_media_of_the_project_stand_before_the_known_ones(derived: Derived) -> None:
    text = ROBOT.replace("state: Robot state", "state: {type: Robot state, medium: ourbus}")
    text += "links: {bus: {connects: [pc, lidar], protocol: EtherCAT}}\n"
    names = list_offered_names(derived(text))["media"]
    assert names[:4] == (
        OfferedName("ethercat", "EtherCAT"),
        OfferedName("ourbus", "used in this project"),
        OfferedName("physical", "used in this project"),
        OfferedName("digital", ""),
    )
    assert OfferedName("mqtt", "MQTT") in names
    assert len({name for name, _ in names}) == len(names)


def test_declared_properties_stand_with_their_choices(derived: Derived) -> None:
    declared = "properties: {sil: Safety level, maturity: {choices: [idea, product]}, safe: {type: boolean}}\n"
    names = list_offered_names(derived(ROBOT + declared))
    assert names["properties"] == (
        OfferedName("sil", "Safety level"),
        OfferedName("maturity", "Maturity"),
        OfferedName("safe", "Safe"),
    )
    choices = {kind: [name for name, _ in each] for kind, each in names.items() if kind.startswith("choices:")}
    assert choices == {"choices:maturity": ["idea", "product"], "choices:safe": ["true", "false"]}
