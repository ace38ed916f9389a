"""Rules that ask for the whole model: where components run, what connections cross, nodes, hosts, containers, links, topics."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from archgen.passes.patterns.architecture_view import ArchitectureView
from archgen.passes.patterns.model_facts import ModelFacts
from tests.passes.patterns.transforming import said, transform, work_of

ROBOT = """
archgen: 1
partners: {uni: {}, firm: {}}
component_types:
  arm:
    inputs: {target: Order}
    outputs: {state: {from: motor.state}}
    components:
      motor: {inputs: {target: self.target}, outputs: {state: Order}}
groups:
  arms:
    owner: uni
    components:
      left: {is: arm, inputs: {target: brain.order}, node: {host: pc}}
      right: {is: arm, inputs: {target: brain.order}, node: {host: nuc}}
  robot:
    owner: firm
    components:
      brain: {inputs: {arms: arms, compass: compass.north}, outputs: {order: Order}}
      compass: {outputs: {north: Order}, node: {container: box}}
      alarm: {inputs: {north: compass.north}, node: {host: nuc, package: alarm, executable: alarm}}
      planner: {inputs: {north: compass.north}, node: {container: box}}
      logger: {title: Logger, tags: [logger], node: {host: pc}}
nodes: {brain: {implements: brain, host: pc, package: brain, executable: brain}}
containers: {box: {host: pc}}
hosts: {pc: {}, nuc: {}}
links: {lan: {connects: [pc, nuc], bandwidth: 1 Gbit/s}}
types: {Order: std_msgs/msg/String}
"""


@pytest.fixture
def facts(tmp_path: Path) -> ModelFacts:
    work = work_of(ROBOT, tmp_path)
    return ModelFacts(work.link(), ArchitectureView(work.tree))


def _after(rules: str, folder: Path, project: str = ROBOT) -> Any:  # noqa: ANN401 - plain data
    data, findings = transform(project, rules, folder)
    assert [each.message for each in findings] == []
    return data


def test_a_component_runs_where_its_node_does_wherever_that_is_written(facts: ModelFacts) -> None:
    assert facts.hosts == {
        # Both instances have their motor from the type: it runs on two hosts.
        "arms.left": "pc",
        "arms.right": "nuc",
        "robot.brain": "pc",
        "robot.compass": "pc",
        "robot.alarm": "nuc",
        "robot.planner": "pc",
        "robot.logger": "pc",
    }


def test_connections_say_what_they_cross(facts: ModelFacts) -> None:
    assert {name: body["crosses"] for name, body in facts.elements["connections"].items()} == {
        "arms.left.state -> robot.brain.arms": ["partner", "process"],
        "arms.right.state -> robot.brain.arms": ["host", "partner", "process"],
        "robot.compass.north -> robot.brain.compass": ["process"],
        "robot.compass.north -> robot.alarm.north": ["host", "process"],
        "robot.compass.north -> robot.planner.north": [],
        "robot.brain.order -> arms.left.target": ["partner", "process"],
        "robot.brain.order -> arms.right.target": ["host", "partner", "process"],
    }


def test_nodes_and_topics_are_seen_however_they_came_to_be(facts: ModelFacts) -> None:
    nodes = facts.elements["nodes"]
    assert nodes["brain"] == {
        "implements": ["robot.brain"],
        "host": "pc",
        "package": "brain",
        "executable": "brain",
    }
    assert nodes["compass"]["container"] == "box"
    assert nodes["left_motor"]["implements"] == ["arm.motor"]
    assert facts.elements["containers"]["box"] == {"host": "pc"}
    assert facts.elements["links"]["lan"]["connects"] == ["pc", "nuc"]
    assert facts.elements["topics"]["/robot/compass/north"] == {
        "flow": "topic",
        "messages": ["std_msgs/msg/String"],
        "types": ["Order"],
        "publishers": ["compass"],
        "subscribers": ["brain", "alarm", "planner"],
    }


def test_a_logger_reads_every_connection_that_leaves_a_host(tmp_path: Path) -> None:
    rules = """
    - find: {connections: {$_: {from: $source.$port, crosses: host}}, components: {$logger: {tags: [logger]}}}
      let: {$name: "${source}_${port}", $input: snake($name)}
      unless: {components: {$logger: {inputs: {$_: {from: [$source.$port]}}}}}
      add: {components: {$logger: {inputs: {$input: {from: [$source.$port]}}}}}
    """
    logger = _after(rules, tmp_path)["groups"]["robot"]["components"]["logger"]
    assert logger["inputs"] == {
        "arms_right_state": {"from": ["arms.right.state"]},
        "robot_compass_north": {"from": ["compass.north"]},
        "robot_brain_order": {"from": ["brain.order"]},
    }


def test_a_group_moves_to_another_host_wherever_that_is_written(tmp_path: Path) -> None:
    rules = """
    - find: {components: {$c: {in: robot, host: pc}}}
      set: {components: {$c: {host: nuc}}}
    """
    data = _after(rules, tmp_path)
    assert data["nodes"]["brain"]["host"] == "nuc"
    assert data["containers"]["box"]["host"] == "nuc"
    assert data["groups"]["robot"]["components"]["logger"]["node"]["host"] == "nuc"
    assert "host" not in data["groups"]["robot"]["components"]["compass"]["node"]
    # One instance moves with what is inside of it, and the other stays.
    arms = _after(
        "- {find: {components: {arms.left: {host: pc}}}, set: {components: {arms.left: {host: nuc}}}}", tmp_path
    )
    work = work_of(ROBOT, tmp_path)
    work.tree.root = work.tree.make_node(arms, ())  # type: ignore[assignment]
    assert ModelFacts(work.link(), ArchitectureView(work.tree)).hosts["arms.left"] == "nuc"


def test_nodes_hosts_containers_and_links_are_changed_and_added(tmp_path: Path) -> None:
    rules = """
    - find: {nodes: {$n: {implements: [$c]}}, components: {$c: {in: robot, host: nuc}}}
      unless: {nodes: {$n: {tags: [far]}}}
      add: {nodes: {$n: {tags: [far]}}}
    - find: {components: {$c: {tags: [logger], host: $h}}}
      unless: {hosts: {disk: }}
      add: {hosts: {disk: {title: Disk}}, links: {usb: {connects: [disk, $h]}}, nodes: {watch: {host: disk, package: w, executable: w}}}
      set: {components: {$c: {host: disk}}}
    - find: {containers: {box: {host: pc}}}
      set: {containers: {box: {threads: 4, host: disk}}}
    - find: {links: {lan: }}
      drop: {links: {lan: }}
    """
    data = _after(rules, tmp_path)
    assert data["groups"]["robot"]["components"]["alarm"]["node"]["tags"] == ["far"]
    assert data["hosts"]["disk"] == {"title": "Disk"}
    assert data["links"] == {"usb": {"connects": ["disk", "pc"]}}
    assert data["nodes"]["watch"] == {"host": "disk", "package": "w", "executable": "w"}
    assert data["groups"]["robot"]["components"]["logger"]["node"]["host"] == "disk"
    assert data["containers"]["box"] == {"host": "disk", "threads": 4}


@pytest.mark.parametrize(
    ("rules", "message"),
    [
        (
            "- {find: {nodes: {left_motor: }}, set: {nodes: {left_motor: {implements: [robot.brain]}}}}",
            "3: the node `left_motor` is that of `['arm.motor']`, and of nothing else",
        ),
        (
            "- {find: {hosts: {pc: }}, add: {hosts: {a b: {title: x}}}}",
            "3: `a b` is no id, so nothing can be called so",
        ),
        (
            "- {find: {hosts: {pc: }}, set: {hosts: {pc: {title: x}}}}",
            "3: this rule changes nothing that it finds, and comes to no end",
        ),
        (
            "- {find: {components: {arms.left.motor: }}, add: {components: {arms.left.motor: {tags: [x]}}}}",
            "3: `arms.left.motor` stands inside of an instance, and what is inside of it is seen in its type",
        ),
    ],
)
def test_what_cannot_be_written_is_told(rules: str, message: str, tmp_path: Path) -> None:
    assert said(ROBOT, rules, tmp_path) == [message]
