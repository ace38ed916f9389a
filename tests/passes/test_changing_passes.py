"""The passes that change what a project means: envelopes around messages, and monitors."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from archgen.pipeline import transform_project
from tests.judged_projects import judge_shipped
from tests.passes.same_meaning import EXAMPLES, check_packed, pack, write_project

LAYOUTS = {
    "a group on top": "groups:\n  home: {components: {lidar: {is: lidar}, nav: {is: nav, inputs: {scan: lidar.scan}}}}\n",
    "a type on top": "  robot: {components: {lidar: {is: lidar}, nav: {is: nav, inputs: {scan: lidar.scan}}}}\n"
    "groups:\n  home: {components: [robot]}\n",
    "local components": "groups:\n  home:\n    components:\n      lidar: {outputs: {scan: Scan}}\n"
    "      nav: {inputs: {scan: {type: Scan, from: lidar.scan}}, outputs: {way: {from: plan.way}},"
    " components: {plan: {inputs: {scan: self.scan}, outputs: {way: Way}}}}\n",
}
TYPES = (
    "component_types:\n  lidar: {outputs: {scan: Scan}}\n"
    "  nav: {inputs: {scan: Scan}, outputs: {way: {from: plan.way}}, components: {plan: {inputs: {scan: self.scan}, outputs: {way: Way}}}}\n"
)
MESSAGES = "types: {Scan: sensor_msgs/msg/LaserScan, Way: nav_msgs/msg/Path}\n"


@pytest.mark.parametrize("layout", LAYOUTS)
def test_messages_are_wrapped_wherever_ports_are_written(layout: str, tmp_path: Path) -> None:
    checked = write_project(tmp_path, TYPES + LAYOUTS[layout] + MESSAGES)
    transformed = transform_project(checked, ["envelope"])
    assert {each.type for each in transformed.architecture.outputs.values()} == {"Envelope<Scan>", "Envelope<Way>"}
    assert {each.type for each in transformed.architecture.inputs.values()} <= {"Envelope<Scan>", None}
    assert len(transformed.architecture.edges) == len(checked.architecture.edges)
    again = transform_project(transformed, ["envelope"])
    assert pack(again) == pack(transformed)
    plain = transform_project(checked, ["envelope", "remove_generics"])
    data = yaml.safe_load(pack(plain))
    assert data["types"]["Envelope of Scan"]["fields"] == {"sender": {"type": "string"}, "payload": {"type": "Scan"}}
    assert data["types"]["Envelope of Scan"]["message"].endswith("/msg/EnvelopeScan")
    check_packed(plain, tmp_path / "packed")


def test_what_no_pass_can_change_stays_plain_with_all_that_it_is_connected_to(tmp_path: Path) -> None:
    transformed = transform_project(
        write_project(
            tmp_path,
            "groups:\n  g:\n    components:\n"
            "      eye: {inputs: {light: {type: Light, medium: physical, external: sun}}, outputs: {seen: Scan, flat: Scan}}\n"
            "      ours: {inputs: {seen: {type: Scan, from: eye.seen}}, outputs: {own: Way}}\n"
            "      theirs: {inputs: {seen: {type: Scan, from: eye.seen}, way: {type: Way, from: ours.own}}}\n"
            "      serve: {outputs: {ask: Question}}\n"
            "nodes: {theirs: {implements: theirs, status: existing}}\n"
            "types: {Light: , Scan: sensor_msgs/msg/LaserScan, Way: nav_msgs/msg/Path, Question: std_srvs/srv/Trigger}\n",
        ),
        ["envelope"],
    )
    outputs = transformed.architecture.outputs
    assert {name: port.type for name, port in outputs.items()} == {
        "g.eye.seen": "Scan",
        "g.eye.flat": "Envelope<Scan>",
        "g.ours.own": "Way",
        "g.serve.ask": "Question",
    }


def test_a_users_own_envelope_is_used_if_it_is_one_and_left_alone_if_not(tmp_path: Path) -> None:
    ports = "groups: {g: {components: {a: {outputs: {x: Scan}}}}}\ntypes:\n  Scan: sensor_msgs/msg/LaserScan\n"
    own = "  Envelope: {generic: [M], fields: {sender: string, at: builtin_interfaces/Time, payload: M}}\n"
    other = "  Envelope: {fields: {paper: string}}\n"
    wrapped = transform_project(write_project(tmp_path / "own", ports + own), ["envelope"])
    assert wrapped.architecture.outputs["g.a.x"].type == "Envelope<Scan>"
    wrapped = transform_project(write_project(tmp_path / "other", ports + other), ["envelope"])
    assert wrapped.architecture.outputs["g.a.x"].type == "Sender envelope<Scan>"
    assert transform_project(wrapped, ["envelope"]).architecture.outputs["g.a.x"].type == "Sender envelope<Scan>"


@pytest.mark.parametrize("layout", LAYOUTS)
def test_everything_is_watched_wherever_it_is_written(layout: str, tmp_path: Path) -> None:
    checked = write_project(tmp_path, TYPES + LAYOUTS[layout] + MESSAGES)
    transformed = transform_project(checked, ["monitor"])
    architecture = transformed.architecture
    around = "home.robot" if layout == "a type on top" else "home"
    read = {(each.output, each.input) for each in architecture.edges}
    assert (f"{around}.lidar.state", f"{around}.monitor.lidar_state") in read
    assert (f"{around}.nav.plan.state", f"{around}.nav.monitor.plan_state") in read
    # A composed component says how it is by its monitor.
    assert (f"{around}.nav.monitor.state", f"{around}.monitor.nav_state") in read
    assert architecture.types["Lidar state"].message == "diagnostic_msgs/msg/DiagnosticStatus"
    assert pack(transform_project(transformed, ["monitor"])) == pack(transformed)
    check_packed(transformed, tmp_path / "packed")


def test_states_and_monitors_of_the_users_own(tmp_path: Path) -> None:
    transformed = transform_project(
        write_project(
            tmp_path,
            "groups:\n  g:\n    components:\n"
            "      arm: {outputs: {state: Arm state}}\n"
            "      lamp: {outputs: {state: {type: Light, medium: physical}}}\n"
            "      monitor: {title: A screen}\n"
            "      old: {functionality: Works already., status: existing}\n"
            "types: {Arm state: sensor_msgs/msg/JointState, Monitor state: std_msgs/msg/Bool, Light: }\n",
        ),
        ["monitor"],
    )
    data = yaml.safe_load(pack(transformed))
    components = data["groups"]["g"]["components"]
    assert components["arm"]["outputs"] == {"state": {"type": "Arm state"}}
    assert components["lamp"]["outputs"]["own_state"] == {"type": "Lamp state"}
    assert components["monitor"]["outputs"] == {"state": {"type": "Monitor state 2"}}
    assert components["state_monitor"]["inputs"] == {
        "arm_state": {"from": ["arm.state"]},
        "lamp_state": {"from": ["lamp.own_state"]},
        "monitor_state": {"from": ["monitor.state"]},
    }
    assert "outputs" not in components["old"]
    assert transformed.architecture.components["g.state_monitor"].tags == ("state_monitor",)


def test_types_made_from_types_and_instances_add_only_what_is_theirs(tmp_path: Path) -> None:
    transformed = transform_project(
        write_project(
            tmp_path,
            "component_types:\n  motor: {}\n  arm: {components: {elbow: {is: motor}}}\n"
            "  long_arm: {is: arm, components: {wrist: {is: motor}}}\n"
            "groups: {g: {components: {left: {is: long_arm, components: {elbow: {tags: [old]}}}}}}\n",
        ),
        ["monitor"],
    )
    data = yaml.safe_load(pack(transformed))
    assert data["component_types"]["arm"]["components"]["monitor"]["inputs"] == {
        "elbow_state": {"from": ["elbow.state"]}
    }
    assert data["component_types"]["long_arm"]["components"]["monitor"] == {
        "inputs": {"wrist_state": {"from": ["wrist.state"]}}
    }
    assert data["groups"]["g"]["components"]["left"] == {"is": "long_arm", "components": {"elbow": {"tags": ["old"]}}}
    assert not [each for each in transformed.findings if str(each.severity) == "error"]


def test_what_stands_in_something_that_exists_is_left_alone(tmp_path: Path) -> None:
    checked = write_project(
        tmp_path,
        "component_types: {kept: {status: existing, outputs: {p: Scan}}}\n"
        "groups:\n  g:\n    components:\n"
        "      box:\n        status: existing\n        outputs: {q: {from: a.q}}\n        components: {a: {outputs: {q: Scan, z: Scan}}}\n"
        "      ours: {inputs: {q: {type: Scan, from: box.q}}, outputs: {x: Scan}}\n"
        "types: {Scan: sensor_msgs/msg/LaserScan}\n",
    )
    transformed = transform_project(checked, ["envelope", "monitor"])
    outputs = {name: port.type for name, port in transformed.architecture.outputs.items() if not name.endswith("state")}
    assert outputs == {"g.box.a.q": "Scan", "g.box.a.z": "Scan", "g.ours.x": "Envelope<Scan>"}
    data = yaml.safe_load(pack(transformed))
    assert data["component_types"]["kept"]["outputs"] == {"p": {"type": "Scan"}}
    assert list(data["groups"]["g"]["components"]["box"]["components"]) == ["a"]
    assert data["groups"]["g"]["components"]["monitor"]["inputs"] == {"ours_state": {"from": ["ours.state"]}}


def test_long_names_give_ports_that_are_ids(tmp_path: Path) -> None:
    name = "a" * 64
    checked = write_project(
        tmp_path,
        f"groups: {{g: {{components: {{{name}: {{outputs: {{p: Scan}}}}}}}}}}\ntypes: {{Scan: sensor_msgs/msg/LaserScan}}\n",
    )
    check_packed(transform_project(checked, ["monitor"]), tmp_path / "packed")


def test_all_passes_over_the_cleaning_robot(tmp_path: Path) -> None:
    names = ("monitor", "envelope", "remove_generics", "flatten")
    transformed = transform_project(judge_shipped(EXAMPLES / "cleaning_robot"), names)
    assert not [each for each in transformed.findings if str(each.severity) == "error"]
    assert transformed.architecture.shells == {}
    assert transformed.architecture.outputs["cleaning.lidar.p"].type == "Envelope of Laser pose"
    assert transformed.architecture.outputs["cleaning.lidar.state"].type == "Envelope of Lidar state"
    again = check_packed(transformed, tmp_path)
    # What is wrapped stays wrapped once, by whatever name.
    wrapped_again = transform_project(again, ["envelope", "remove_generics", "flatten"])
    assert yaml.safe_load(pack(wrapped_again)) == yaml.safe_load(pack(transformed))
