"""Elements and keys at a wrong level, and sections with another's name: one finding, and nothing that follows from it."""

from __future__ import annotations

import pytest

from archgen.schema.misplaced_elements import mend_misplaced_elements
from archgen.syntax import yaml_parser
from archgen.syntax.yaml_tree import MappingNode
from tests.judged_projects import check_text

_ROBOT = """\
groups:
  sensing:
    components:
      lidar:
        role: source
        performance:
          range: {accuracy: 3 cm}
        outputs:
          scan: sensor_msgs/msg/LaserScan
      stop:
        role: filter
        inputs:
          scan: lidar.scan
        outputs:
          velocity: geometry_msgs/msg/Twist
  driving:
    components:
      wheels:
        inputs:
          velocity: stop.velocity
nodes:
  lidar_driver:
    implements: lidar
    package: our_lidar
  stop_node:
    implements: stop
    package: robot_stop
  wheel_driver:
    implements: wheels
    package: robot_base
chains:
  see_and_stop:
    through: [lidar, stop]
"""


def _shift(first: str, last: str, columns: int) -> str:
    """Shift the lines of the robot from one to another, named by what they begin with, by some columns."""
    lines = _ROBOT.split("\n")
    begin = next(i for i, line in enumerate(lines) if line.strip().startswith(first))
    end = next(i for i, line in enumerate(lines) if i >= begin and line.strip().startswith(last))
    shifted = [" " * columns + line if columns > 0 else line[-columns:] for line in lines[begin : end + 1]]
    return "\n".join([*lines[:begin], *shifted, *lines[end + 1 :]])


def _find_only(text: str) -> str:
    """Return the only finding of a text beside notes, with its line and help."""
    (finding,) = (d for d in check_text(text) if d.severity != "note")
    return f"{finding.span.line}: {finding.message}; {finding.help}"


def test_the_robot_is_sound() -> None:
    assert not [d for d in check_text(_ROBOT) if d.severity != "note"]


@pytest.mark.parametrize(
    ("slip", "finding"),
    [
        (_ROBOT.replace("nodes:", "groups_too:", 1).replace("groups:", "types:", 1).replace("groups_too", "nodes"),
         "1: what stands below `types` are elements of `groups`; write `groups:` instead of `types:`"),
        (_ROBOT.replace("nodes:", "hosts:", 1),
         "21: what stands below `hosts` are elements of `nodes`; write `nodes:` instead of `hosts:`"),
        (_shift("stop:", "velocity: geometry", 2),
         "10: a component has no key `stop`; it looks like a component: begin it in the column of `lidar`"),
        (_shift("stop_node:", "package: robot_stop", 2),
         ("25: a ROS node has no key `stop_node`; it looks like a ROS node of its own: begin it in the column of "
          "`lidar_driver`")),
        (_shift("outputs:", "scan: sensor_msgs", 2),
         ("8: `outputs` is a key of a component, but stands where a performance indicator does; begin it in the column of "
          "`performance`")),
        (_shift("outputs:", "scan: sensor_msgs", -2),
         "8: `outputs` is a key of a component, but stands where a component does; indent it below `lidar`"),
        (_shift("performance:", "scan: sensor_msgs", -2),
         "6: `performance` is a key of a component, but stands where a component does; indent it below `lidar`"),
        (_shift("chains:", "through:", 2),
         "31: `chains` is a section, but stands where a ROS node does; begin it in the column of `nodes`"),
        (_ROBOT.replace("      stop:", "        stop:"),
         ("10: a component has no key `stop`; if this is an element of its own, begin it in the column of "
         "`lidar`")),
    ],
)  # fmt: skip
def test_one_slip_is_one_finding(slip: str, finding: str) -> None:
    assert _find_only(slip) == finding


def test_components_beside_their_group_are_one_finding() -> None:
    text = "groups:\n  a: {title: A}\n  components: {b: {role: source}, c: {role: sink}}\nnodes: {b: a.b, c: a.c}\n"
    (error,) = (d for d in check_text(text) if d.severity == "error")
    assert f"{error.message}; {error.help}" == (
        "`components` is a key of a functional group, but stands where a functional group does; indent it below `a`"
    )


def test_elements_of_a_section_written_twice_lose_none() -> None:
    document, _ = yaml_parser.parse_yaml(
        "a.yaml", "nodes: {a: x.y}\nhosts: {a: {implements: q, package: p}, b: {implements: x.z}}\n"
    )
    assert document is not None
    (finding,) = mend_misplaced_elements(document)
    assert finding.message == "what stands below `hosts` are elements of `nodes`"
    nodes = document.root.get("nodes")
    assert isinstance(nodes, MappingNode)
    assert [entry.key for entry in nodes] == ["a", "b"]


@pytest.mark.parametrize(
    "text",
    [
        "groups: {nodes: {title: Nodes}, chains: {titel: Chains}}",
        "groups: {g: {components: {inputs: {title: Inputs}, outputs: {title: O, role: sink, rate: 1 Hz}}}}",
        "groups: {g: {title: G, owner: x, implements: y}}",
        "hosts: {a: {cores: 8}, b: {cores: 4, owner: x}}",
        "types: {title: {title: T}}\nnodes: [a]\nviews: x\ngroups: \nhosts: {a: , b: []}",
    ],
)
def test_what_may_be_meant_stays_where_it_is(text: str) -> None:
    document, _ = yaml_parser.parse_yaml("a.yaml", text)
    assert document is not None
    assert not list(mend_misplaced_elements(document))


def test_a_key_twice_without_an_element_between_stays_a_repetition() -> None:
    text = "groups:\n  g:\n    components:\n      a:\n        title: A\n        colour: red\n        role: sink\n        role: source\n"
    assert [(d.rule, d.span.line) for d in check_text(text) if d.severity == "error"] == [
        ("unknown-key", 6),
        ("duplicate-key", 8),
    ]
