"""What names components, or holds for all that is inside of one, means the same once hierarchy is taken away."""

from __future__ import annotations

from pathlib import Path

import yaml

from archgen.passes.flat_references import FlatFrames
from archgen.passes.flat_sources import FlatSteps
from archgen.passes.linked_tree import LinkedTree
from archgen.pipeline import CheckedProject, transform_project
from archgen.syntax.yaml_tree import node_to_data
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


BOX = """\
groups:
  g:
    components:
      s: {inputs: {r: {from: box.out}}, outputs: {p: Pose}}
      box:
        inputs: {q: {from: s.p}}
        outputs: {out: {from: last.z}}
        components:
          first: {inputs: {q: self.q}, outputs: {z: Pose}}
          last: {inputs: {q: first.z}, outputs: {z: Pose}}
types: {Pose: geometry_msgs/msg/Pose}
"""


def test_steps_run_between_the_leaves_that_are_connected(tmp_path: Path) -> None:
    checked = write_project(
        tmp_path,
        BOX + "nodes: {box: {implements: box}}\n"
        "use_cases:\n  u:\n    actors: {s: Somebody}\n    steps:\n      - {from: g.s, to: box, say: a}\n"
        "      - {from: box, to: g.s, say: b}\n      - {from: box.out, to: g.s, say: c}\n      - {from: s, to: box}\n",
    )
    transformed = transform_project(checked, ["flatten"])
    assert yaml.safe_load(pack(transformed))["use_cases"]["u"]["steps"] == [
        {"from": "g.s", "to": "g.first", "say": "a"},
        {"from": "g.last", "to": "g.s", "say": "b"},
        {"from": "g.last.z", "to": "g.s", "say": "c"},
        {"from": "s", "to": "g.first"},
    ]
    found = [(each.rule, str(each.span)) for each in checked.findings if "step" in each.rule]
    assert [(each.rule, str(each.span)) for each in transformed.findings if "step" in each.rule] == found


def test_a_node_of_the_name_of_a_composed_component_hides_it_in_no_selector_and_no_link(tmp_path: Path) -> None:
    checked = write_project(
        tmp_path,
        BOX.replace("last: {", "pc: {").replace("last.z", "pc.z")
        + "nodes: {box: {implements: box, host: pc}}\nhosts: {pc: {}, other: {}}\nlinks: {l: {connects: [pc, other, box]}}\n"
        "views: {v: {show: box+1 pc}}\npolicies: {p: {forbid: {from: s, to: box}}}\n",
    )
    transformed = transform_project(checked, ["flatten"])
    data = yaml.safe_load(pack(transformed))
    assert data["views"]["v"] == {"show": "g.first+1 g.pc+1 g.pc"}
    assert data["policies"]["p"]["forbid"] == {"from": "s", "to": "g.first g.pc"}
    assert data["links"]["l"]["connects"] == ["pc", "other", "g.first"]


def test_frames_of_composed_components_become_the_projects(tmp_path: Path) -> None:
    checked = write_project(
        tmp_path,
        """\
component_types:
  arm:
    parameters: {prefix: l}
    frames: {"$(self.prefix)_base": map, "$(self.prefix)_tool": {parent: "$(self.prefix)_base", by: motor, rate: 10 Hz}}
    components:
      motor: {outputs: {z: Pose}, frames: {"$(self.name)_axis": map}, parameters: {name: {from: self.prefix}}}
      watch: {inputs: {z: motor.z}, frames: {"$(self.name)_seen": {parent: map, by: motor}}, parameters: {name: {from: self.prefix}}}
groups: {g: {components: {left: {is: arm}, right: {is: arm, parameters: {prefix: r}}}}}
types: {Pose: geometry_msgs/msg/Pose}
frames: {map: {}}
nodes: {n: {implements: left, package: p, executable: e}}
""",
    )
    assert [each for each in checked.findings if str(each.severity) == "error"] == []
    transformed = transform_project(checked, ["flatten"])
    frames, flat_frames = checked.architecture.frames, transformed.architecture.frames
    assert {name: each.parent for name, each in flat_frames.items()} == {
        name: each.parent for name, each in frames.items()
    }
    assert {name: each.rate for name, each in flat_frames.items()} == {name: each.rate for name, each in frames.items()}
    assert {name: each.by for name, each in flat_frames.items()} == {
        "map": None,
        "l_base": "n",  # the only process of the arm
        "l_tool": "g.left_motor",
        "r_base": "g.right_motor",
        "r_tool": "g.right_motor",
        "l_axis": "g.left_motor",
        "l_seen": "g.left_motor",
        "r_axis": "g.right_motor",
        "r_seen": "g.right_motor",
    }
    check_packed(transformed, tmp_path / "packed")


def test_what_no_component_wrote_stays_as_it_is(tmp_path: Path) -> None:
    checked = write_project(tmp_path, BOX + "use_cases: {u: {title: U}, v: {steps: [{from: nobody, to: box}]}}\n")
    architecture = checked.architecture
    outline = LinkedTree(checked.loaded_project, checked.merged_table, architecture.interfaces).outline
    flat_ids = {each: f"g.{each.rpartition('.')[2]}" for each in architecture.components}
    assert FlatFrames(architecture, outline, flat_ids).write_section(None) is None
    section = checked.merged_table.entries["use_cases"]
    rewritten = FlatSteps(architecture, flat_ids).rewrite_use_cases(section)
    assert node_to_data(rewritten.value) == {
        "u": {"title": "U"},
        "v": {"steps": [{"from": "nobody", "to": "g.first"}]},
    }


def test_internal_topics_and_services_keep_their_names(tmp_path: Path) -> None:
    checked = write_project(
        tmp_path,
        BOX + "nodes:\n  n:\n    implements: box\n    package: p\n    executable: e\n    internal:\n"
        "      publishes: {debug: {message: std_msgs/msg/String}, named: {message: std_msgs/msg/String, topic: fine}}\n"
        "      serves: {ask: {message: std_srvs/srv/Trigger}}\n",
    )
    transformed = transform_project(checked, ["flatten"])
    assert {"/g/box/first/debug", "/g/box/first/ask", "/fine"} <= set(checked.architecture.topics)
    assert transformed.architecture.topics.keys() == checked.architecture.topics.keys()
    check_packed(transformed, tmp_path / "packed")
