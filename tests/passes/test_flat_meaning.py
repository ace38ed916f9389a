"""What names components, or holds for all that is inside of one, means the same once hierarchy is taken away."""

from __future__ import annotations

from pathlib import Path

import yaml

from archgen.pipeline import CheckedProject, transform_project
from tests.passes.same_meaning import check_packed, pack, write_project

STARTED = """\
component_types:
  arm:
    components:
      motor: {outputs: {angle: Pose}, node: {package: p, executable: m}}
      watch: {inputs: {angle: {from: motor.angle}}, node: {package: p, executable: w, start: motor}}
groups:
  g:
    components:
      left: {is: arm}
      right: {is: arm, node: {start: {after: left}}}
      plan: {title: P, node: {package: p, executable: plan, kind: lifecycle, start: {after: [left], by: boss}}}
      boss: {title: B, node: {package: p, executable: boss, start: {after: [left.motor]}}}
nodes:
  stage: {kind: program, command: [stage], start: {after: [right, plan, boss]}}
types: {Pose: geometry_msgs/msg/Pose}
"""


def _list_waits(checked: CheckedProject) -> dict[str, set[str]]:
    """Return the nodes whose components a node waits for, and the one that brings it up, by node."""
    architecture = checked.architecture
    node_of = {each: node.id for node in architecture.nodes.values() for each in node.implements}
    return {
        node.id: {
            node_of.get(leaf, leaf)
            for target in (*node.start.after, *filter(None, [node.start.by]))
            for leaf in (architecture.leaves_of(target.id) if target.kind == "component" else (target.id,))
        }
        - {node.id}
        for node in architecture.nodes.values()
        if node.start
    }


def test_what_starts_after_a_composed_component_starts_after_all_in_it(tmp_path: Path) -> None:
    checked = write_project(tmp_path, STARTED)
    assert not [each for each in checked.findings if str(each.severity) == "error"]
    assert _list_waits(checked)["plan"] == {"left_motor", "left_watch", "boss"}
    assert _list_waits(checked)["right_motor"] == {"left_motor", "left_watch"}
    transformed = transform_project(checked, ["flatten"])
    assert _list_waits(transformed) == _list_waits(checked)
    assert not [each for each in transformed.findings if str(each.severity) == "error"]
    check_packed(transformed, tmp_path / "packed")


def test_exceptions_of_policies_name_the_inputs_of_leaves(tmp_path: Path) -> None:
    checked = write_project(
        tmp_path,
        "groups:\n  g:\n    components:\n      s: {outputs: {p: Pose}}\n"
        "      box: {inputs: {q: {from: s.p}}, components: {guard: {inputs: {q: self.q}}}}\n"
        "types: {Pose: geometry_msgs/msg/Pose}\n"
        "properties: {guard: {of: [input], type: string}}\n"
        "policies:\n  p: {forbid: {from: s, to: box}, accepted: {box.q: So it was agreed.}}\n"
        "  r: {require: {of: box, inputs_from: s, guarded_by: guard}}\n",
    )
    transformed = transform_project(checked, ["flatten"])
    policies = yaml.safe_load(pack(transformed))["policies"]
    assert policies["p"] == {"forbid": {"from": "s", "to": "g.guard"}, "accepted": {"g.guard.q": "So it was agreed."}}
    assert policies["r"] == {"require": {"of": "g.guard", "inputs_from": "s", "guarded_by": "guard"}}
    wrong_rules = {"forbidden-flow", "refused-source", "unknown-reference", "unneeded-exception"}
    assert wrong_rules.isdisjoint(each.rule for each in transformed.findings)


def test_what_is_selected_by_what_is_around_it_stays_selected(tmp_path: Path) -> None:
    checked = write_project(
        tmp_path,
        "groups:\n  g:\n    components:\n      s: {outputs: {p: Pose}}\n"
        "      box:\n        status: planned\n        tags: [moving]\n        requirements: []\n"
        "        properties: {sil: 2, vendor: us}\n"
        "        components: {a: {inputs: {q: s.p}, outputs: {z: Pose}, tags: [moving], properties: {vendor: them}}}\n"
        "types: {Pose: geometry_msgs/msg/Pose}\n"
        'views: {v: "property:sil>=2", w: "status:planned", x: "s..box -tag:moving", y: "g.* -box+1"}\n',
    )
    transformed = transform_project(checked, ["flatten"])
    data = yaml.safe_load(pack(transformed))
    leaf = data["groups"]["g"]["components"]["a"]
    assert (leaf["status"], leaf["tags"], leaf["properties"]) == ("planned", ["moving"], {"vendor": "them", "sil": 2})
    assert "requirements" not in leaf
    assert data["views"]["x"] == {"show": "s..g.a -tag:moving"}
    assert data["views"]["y"] == {"show": "g.s g.a -g.a+1"}
    assert "wrong-selector" not in {each.rule for each in transformed.findings}
