"""Types and instances mean what they stand for when everything is written out by hand."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.analyses.size_counts import measure_size
from archgen.model.architecture import Architecture
from archgen.model.selector_evaluation import evaluate_selector
from tests.running import ROOT

SHORT = """
component_types:
  motor: {functionality: Turns., inputs: {target: Goal}, outputs: [Joint state], timing: {rate: 10 Hz, wcet: 2 ms, jitter: 1 ms}, requirements: [R-1], tags: [drive], node: {package: m, executable: motor}}
  strong_motor: {is: motor, inputs: {brake: {type: Goal, optional: true, external: The operator}}, timing: {wcet: 3 ms}}
  filter: {generic: [T], inputs: {raw: T}, outputs: {clean: T}, node: {package: f, executable: f}}
  arm:
    autoconnect: ports
    inputs: {target: Goal}
    outputs: [Joint state]
    components:
      shoulder: {is: motor}
      elbow: {is: strong_motor, inputs: {target: self.target}}
      joint: {inputs: {states: [shoulder.joint_state, elbow.joint_state]}, outputs: {joint_state: {type: Joint state}}}
groups:
  body:
    components:
      planner: {outputs: {goal: {type: Goal, to: [left.target, right.target]}}}
      left: {is: arm, node: {namespace: left, host: pc}}
      right: {is: arm, components: {shoulder: {timing: {behaviour: event}, tags: [old], requirements: [Never hurts]}}, node: {namespace: /right, whole: true, package: arms, executable: arm}}
      smooth: {is: filter<Joint state>, from: left}
      log: {inputs: {a: smooth, b: right.joint_state}}
requirements: {R-1: Moves}
hosts: {pc: }
"""

LONG = """
groups:
  body:
    components:
      planner: {outputs: {goal: {type: Goal}}}
      left:
        inputs: {target: {type: Goal, from: planner.goal}}
        outputs: {joint_state: {type: Joint state, from: joint.joint_state}}
        components:
          shoulder: {functionality: Turns., inputs: {target: {type: Goal, from: self.target}}, outputs: {joint_state: Joint state}, timing: {rate: 10 Hz, wcet: 2 ms, jitter: 1 ms}, requirements: [R-1], tags: [drive]}
          elbow:
            functionality: Turns.
            inputs: {target: {type: Goal, from: self.target}, brake: {type: Goal, optional: true, external: The operator}}
            outputs: {joint_state: Joint state}
            timing: {rate: 10 Hz, wcet: 3 ms, jitter: 1 ms}
            requirements: [R-1]
            tags: [drive]
          joint: {inputs: {states: [shoulder.joint_state, elbow.joint_state]}, outputs: {joint_state: {type: Joint state}}}
      right:
        inputs: {target: {type: Goal, from: planner.goal}}
        outputs: {joint_state: {type: Joint state, from: joint.joint_state}}
        components:
          shoulder: {functionality: Turns., inputs: {target: {type: Goal, from: self.target}}, outputs: {joint_state: Joint state}, timing: {behaviour: event, wcet: 2 ms}, requirements: [R-1, Never hurts], tags: [drive, old]}
          elbow:
            functionality: Turns.
            inputs: {target: {type: Goal, from: self.target}, brake: {type: Goal, optional: true, external: The operator}}
            outputs: {joint_state: Joint state}
            timing: {rate: 10 Hz, wcet: 3 ms, jitter: 1 ms}
            requirements: [R-1]
            tags: [drive]
          joint: {inputs: {states: [shoulder.joint_state, elbow.joint_state]}, outputs: {joint_state: {type: Joint state}}}
      smooth: {inputs: {raw: {type: Joint state, from: left.joint_state}}, outputs: {clean: Joint state}}
      log: {inputs: {a: smooth, b: right.joint_state}}
nodes:
  left_shoulder: {implements: body.left.shoulder, name: shoulder, package: m, executable: motor, namespace: left, host: pc}
  left_elbow: {implements: body.left.elbow, name: elbow, package: m, executable: motor, namespace: left, host: pc}
  smooth: {implements: smooth, package: f, executable: f}
  right: {implements: right, namespace: /right, package: arms, executable: arm}
  left_joint: {implements: left.joint, name: joint, namespace: left, host: pc, status: planned}
requirements: {R-1: Moves}
hosts: {pc: }
"""


def read_architecture(folder: Path, text: str) -> Architecture:
    file = folder / "robot.yaml"
    file.write_text(text, encoding="utf-8")
    checked = pipeline.check_project(file)
    assert [str(finding) for finding in checked.findings if finding.severity == "error"] == []
    return checked.architecture


@pytest.fixture(scope="module")
def short(tmp_path_factory: pytest.TempPathFactory) -> Architecture:
    return read_architecture(tmp_path_factory.mktemp("short"), SHORT)


@pytest.fixture(scope="module")
def long(tmp_path_factory: pytest.TempPathFactory) -> Architecture:
    return read_architecture(tmp_path_factory.mktemp("long"), LONG)


def test_short_and_long_form_have_the_same_components_and_ports(short: Architecture, long: Architecture) -> None:
    assert list(short.components) == list(long.components)
    for component_id, component in short.components.items():
        written_out = replace(component, component_type=None, is_reference=False)
        plain_inputs = {
            name: replace(port, connections=(), from_written=False) for name, port in component.inputs.items()
        }
        other = long.components[component_id]
        other_inputs = {name: replace(port, connections=(), from_written=False) for name, port in other.inputs.items()}
        assert replace(written_out, inputs=plain_inputs) == replace(other, inputs=other_inputs)


def test_short_and_long_form_are_connected_alike(short: Architecture, long: Architecture) -> None:
    assert {(edge.output, edge.input) for edge in short.edges} == {(edge.output, edge.input) for edge in long.edges}
    assert [(e.node, e.use, e.name) for e in sorted(short.endpoints, key=str)] == [
        (e.node, e.use, e.name) for e in sorted(long.endpoints, key=str)
    ]


def test_short_and_long_form_have_the_same_nodes(short: Architecture, long: Architecture) -> None:
    def describe(architecture: Architecture) -> set[tuple[object, ...]]:
        return {
            (n.id, n.full_name, n.implements, n.wholes, n.package, n.executable, n.host, n.status)
            for n in architecture.nodes.values()
        }

    assert describe(short) == describe(long)


def test_short_and_long_form_are_counted_alike(short: Architecture, long: Architecture) -> None:
    def count(architecture: Architecture) -> object:
        # Whether a node that only says where it runs is counted as planned depends on how it is written.
        return replace(measure_size(architecture), component_types=0, made_connections=0, nodes=0, planned_nodes=0)

    assert count(short) == count(long)
    assert measure_size(short).component_types == 4
    assert measure_size(short).made_connections == 2
    assert measure_size(short).composed == measure_size(long).composed == 2


def test_what_autoconnect_joined_is_marked(short: Architecture) -> None:
    made = {(c.input, c.outputs, c.shell_port) for c in short.connections if c.is_made}
    assert made == {
        ("body.left.shoulder.target", ("body.planner.goal",), "body.left.target"),
        ("body.right.shoulder.target", ("body.planner.goal",), "body.right.target"),
    }


@pytest.mark.parametrize(
    ("selector", "components"),
    [
        ("body.left", "left.shoulder left.elbow left.joint"),
        ("left.**", "left.shoulder left.elbow left.joint"),
        ("left.joint_state", "left.joint"),
        ("is:motor", "left.shoulder left.elbow right.shoulder right.elbow"),
        ("is:strong_motor", "left.elbow right.elbow"),
        ("is:arm -is:motor", "left.joint right.joint"),
        ("is:filter", "smooth"),
        ('is:"filter<Joint state>"', "smooth"),
        ("left.joint+1", "left.joint smooth"),
        ("body.** -is:*", "planner log"),
    ],
)
def test_selectors_reach_into_composed_components(short: Architecture, selector: str, components: str) -> None:
    selection, problems = evaluate_selector(selector, short)
    assert problems == ()
    assert selection.components == {f"body.{name}" for name in components.split()}


def test_a_reference_is_its_type_also_after_the_type_has_changed(tmp_path: Path) -> None:
    text = (
        "component_types: {laser: {outputs: {scan: T}}}\ngroups: {g: {components: {a: {same_as: laser, title: Front}}}}"
    )
    component = read_architecture(tmp_path, text).components["g.a"]
    assert (component.title, component.component_type, component.is_reference) == ("Front", "laser", True)
    changed = read_architecture(tmp_path, text.replace("{scan: T}", "{scan: T, power: U}")).components["g.a"]
    assert list(changed.outputs) == ["scan", "power"]


def test_each_instance_has_containers_of_its_own(tmp_path: Path) -> None:
    architecture = read_architecture(
        tmp_path,
        "component_types:\n"
        "  eye: {containers: {box: {threads: 2}}, components: {driver: {outputs: {image: T}, node: {package: d, plugin: D, container: box}}}}\n"
        "groups: {g: {components: {left: {is: eye}, right: {is: eye}}}}\n",
    )
    assert {name: node.container for name, node in architecture.nodes.items()} == {
        "left_driver": "left_box",
        "right_driver": "right_box",
    }
    assert {name: container.threads for name, container in architecture.containers.items()} == {
        "left_box": 2,
        "right_box": 2,
    }


def test_containers_of_instances_take_place_and_namespace_of_what_is_around(tmp_path: Path) -> None:
    architecture = read_architecture(
        tmp_path,
        "hosts: {pc: , pd: }\n"
        "component_types:\n"
        "  eye:\n"
        "    parameters: {side: left}\n"
        '    containers: {box: {name: "$(self.side)_box", namespace: eyes, package: p, executable: e, parameters: {rate: 1}}}\n'
        "    components: {driver: {outputs: {image: T}, node: {plugin: D, container: box}}}\n"
        "groups:\n"
        "  g:\n"
        "    components:\n"
        "      one: {is: eye, node: {namespace: robot_1, host: pc}}\n"
        "      two: {is: eye, parameters: {side: right}, node: {namespace: robot_2}, containers: {box: {host: pd, namespace: /own}}}\n",
    )
    assert {name: (each.full_name, each.host) for name, each in architecture.containers.items()} == {
        "one_box": ("/robot_1/eyes/left_box", "pc"),
        "two_box": ("/own/right_box", "pd"),
    }
    assert {(each.package, each.executable, str(each.parameters)) for each in architecture.containers.values()} == {
        ("p", "e", "{'rate': 1}")
    }


def test_names_of_today_stay_where_a_component_stands_deeper(tmp_path: Path) -> None:
    architecture = read_architecture(
        tmp_path,
        "groups: {g: {components: {a: {components: {b: {functionality: Inner.}}}, b: {functionality: Outer.}}}}",
    )
    assert {node.id: node.implements for node in architecture.nodes.values()} == {"b": ("g.b",), "a_b": ("g.a.b",)}


def test_the_example_has_nothing_to_complain_about() -> None:
    checked = pipeline.check_project(ROOT / "examples" / "cleaning_robot")
    assert [str(finding) for finding in checked.findings] == []
    size = measure_size(checked.architecture)
    assert (size.components, size.composed, size.component_types, size.connections) == (14, 3, 6, 18)
    motors = [checked.architecture.components[f"cleaning.{arm}.elbow"] for arm in ("left_arm", "right_arm")]
    assert [{name: each.value for name, each in motor.parameters.items()} for motor in motors] == [
        {"joint": "left_elbow", "max_speed": 1.0},
        {"joint": "right_elbow", "max_speed": 0.7},
    ]
    assert set(checked.architecture.frames) == {"map", "base_link", "left_hand", "right_hand"}


def test_a_packed_project_of_types_is_the_project(tmp_path: Path, short: Architecture) -> None:
    (tmp_path / "archgen.yaml").write_text("archgen: 1\n", encoding="utf-8")
    head, tail = SHORT.split("groups:")
    (tmp_path / "types.yaml").write_text(head, encoding="utf-8")
    (tmp_path / "robot.yaml").write_text("groups:" + tail, encoding="utf-8")
    folder = pipeline.check_project(tmp_path).architecture
    assert replace(folder, project=short.project, interfaces=short.interfaces) == replace(
        short, interfaces=short.interfaces
    )
