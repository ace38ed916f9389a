"""What an insertion does to the rest of a project: no element of any kind changes unseen."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline
from archgen.edit import edit_proof

ROBOT = """\
archgen: 1
groups:
  g:
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image}, timing: {rate: 10 Hz}}
      screen: {inputs: {image: camera.image}}
nodes:
  cam: {implements: camera, container: box, publishes: {image: {topic: /image}}}
  show: {implements: screen, host: pc, timing: {wcet: 2 ms}}
hosts: {pc: {cores: 4}, nuc: {cores: 2}}
containers: {box: {host: nuc}}
links: {cable: {connects: [pc, nuc]}}
chains: {see: {through: [camera, screen], deadline: 100 ms}}
"""


def changed_elements(folder: Path, old: str, new: str, element_id: str = "x") -> tuple[str, ...]:
    """Return what changes besides the new element when a text of ROBOT is replaced."""
    (folder / "archgen.yaml").write_text(ROBOT, encoding="utf-8")
    assert old in ROBOT
    checked_project = pipeline.check_project(folder / "archgen.yaml")
    consequences = edit_proof.find_consequences(checked_project, "archgen.yaml", ROBOT.replace(old, new, 1), element_id)
    assert consequences.errors == ()
    return consequences.changed_elements


@pytest.mark.parametrize(
    ("old", "new", "element"),
    [
        ("cores: 4", "cores: 8", "pc"),
        ("wcet: 2 ms", "wcet: 3 ms", "g.screen"),
        ("host: pc,", "host: nuc,", "show"),
        ("topic: /image", "topic: /picture", "cam.publishes.image"),
        ("deadline: 100 ms", "deadline: 90 ms", "see"),
        ("through: [camera, screen]", "through: [cam, screen]", "see"),
        ("connects: [pc, nuc]", "connects: [pc, nuc], bandwidth: 1 MB/s", "cable"),
        ("box: {host: nuc}", "box: {host: pc}", "box"),
        (", nuc: {cores: 2}}", ", nuc: {cores: 2, title: Small}}", "nuc"),
        ("rate: 10 Hz", "rate: 11 Hz", "g.camera"),
    ],
)
def test_whatever_changes_is_seen(tmp_path: Path, old: str, new: str, element: str) -> None:
    assert element in changed_elements(tmp_path, old, new)


def test_a_new_element_that_catches_a_reference_changes_what_refers_to_it(tmp_path: Path) -> None:
    """`through: camera` leads to the component, unless there is a node of this name."""
    assert changed_elements(tmp_path, "  show:", "  camera: {package: p}\n  show:", "camera") == ("see",)


@pytest.mark.parametrize(
    ("old", "new", "element_id"),
    [
        ("  show:", "  x: {implements: screen, host: nuc}\n  show:", "x"),
        ("  show:", "  x: {implements: [camera, screen], host: nuc, timing: {wcet: 1 ms}}\n  show:", "x"),
        ("      screen:", "      x: {inputs: {image: camera.image}}\n      screen:", "g.x"),
        ("  g:", "  x: {title: X}\n  g:", "x"),
        ("nodes:", "\nnodes:", "x"),
    ],
)
def test_a_new_element_alone_changes_nothing_else(tmp_path: Path, old: str, new: str, element_id: str) -> None:
    assert changed_elements(tmp_path, old, new, element_id) == ()


ARMS = """\
archgen: 1
component_types:
  motor: {inputs: {target: Goal}, outputs: {state: Goal}, node: {package: arms, executable: motor}}
  arm: {inputs: {target: Goal}, components: {elbow: {is: motor, inputs: {target: self.target}}}}
groups:
  body:
    autoconnect: ports
    components:
      left: {is: arm}
      planner: {outputs: {target: Goal}}
"""


def _judge_arms(folder: Path, added: str, element_id: str) -> edit_proof.EditConsequences:
    """Return what follows from text at the end of ARMS."""
    (folder / "archgen.yaml").write_text(ARMS, encoding="utf-8")
    checked_project = pipeline.check_project(folder / "archgen.yaml")
    return edit_proof.find_consequences(checked_project, "archgen.yaml", ARMS + added, element_id)


def test_what_flows_into_the_leaves_of_a_new_instance_changes_nothing_else(tmp_path: Path) -> None:
    consequences = _judge_arms(tmp_path, "      right: {is: arm}\n", "body.right")
    assert (consequences.errors, consequences.changed_elements) == ((), ())
    assert consequences.renamed_nodes == (("elbow", "left_elbow"),)


def test_a_second_source_that_takes_a_connection_away_changes_it(tmp_path: Path) -> None:
    consequences = _judge_arms(tmp_path, "      second: {outputs: {target: Goal}}\n", "body.second")
    assert consequences.changed_elements == ("body.planner.target -> body.left.elbow.target",)


def test_a_new_node_takes_the_place_of_the_one_that_its_component_brings_and_no_other(tmp_path: Path) -> None:
    own = _judge_arms(tmp_path, "nodes: {elbow: {implements: left.elbow, status: planned}}\n", "elbow")
    assert (own.errors, own.changed_elements) == ((), ())
    other = _judge_arms(tmp_path, "nodes: {elbow: {implements: planner, status: planned}}\n", "elbow")
    assert other.changed_elements == ("elbow",)


def test_a_type_called_like_a_node_hides_no_change_of_the_node(tmp_path: Path) -> None:
    text = "nodes: {left_elbow: {implements: left.elbow}}\n"
    (tmp_path / "archgen.yaml").write_text(ARMS + text, encoding="utf-8")
    checked_project = pipeline.check_project(tmp_path / "archgen.yaml")
    changed = (ARMS + text.replace("left.elbow}", "left.elbow, host: pc}")).replace(
        "groups:", "  left_elbow: {title: x}\nhosts: {pc: {}}\ngroups:", 1
    )
    consequences = edit_proof.find_consequences(checked_project, "archgen.yaml", changed, "left_elbow")
    assert consequences.changed_elements == ("left_elbow",)
