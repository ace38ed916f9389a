"""A component type that changed is told once; what its instances lose is judged at each of them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.compare import Comparison
from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.edits import list_edits
from archgen.compare.kinds.functional_kinds import COMPONENT_TYPE
from archgen.compare.kinds.key_spec import ReadContext
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.type_edits import TypeKey, find_type_edits, trace_origins
from archgen.emit.data.comparison_json import write_comparison_json
from archgen.views.changes.comparison_document import ReadingErrors
from tests.compare.conftest import Compared
from tests.compose.test_project_expansion import LONG, SHORT

ROBOT = """\
partners: {x: X, y: Y, z: Z}
types: {State: sensor_msgs/msg/JointState, Goal: std_msgs/msg/String, Text: std_msgs/msg/Header}
component_types:
  motor:
    functionality: Turns.
    inputs: {target: Goal}
    outputs: {state: State}
    timing: {rate: 10 Hz, wcet: 2 ms}
    tags: [drive]
    node: {package: m, executable: motor}
  strong: {is: motor, timing: {wcet: 3 ms}}
  arm:
    inputs: {target: Goal}
    outputs: {state: {from: joint.state}}
    components:
      elbow: {is: motor, inputs: {target: self.target}}
      joint: {inputs: {state: elbow.state}, outputs: {state: State}}
groups:
  body:
    owner: x
    components:
      planner: {outputs: {goal: Goal}}
      a: {is: motor, inputs: {target: planner.goal}}
      b: {is: strong, inputs: {target: planner.goal}}
      left: {is: arm, inputs: {target: planner.goal}}
  legs:
    owner: z
    components:
      c: {is: motor, inputs: {target: planner.goal}, timing: {rate: 5 Hz}, tags: [old]}
      right: {is: arm, inputs: {target: planner.goal}}
  mind:
    owner: y
    components:
      log: {inputs: {a: a.state, b: b.state, c: c.state, d: left.state, e: right.state}, node: {package: l, executable: l}}
"""


def list_texts(comparison: Comparison) -> list[str]:
    return [edit.text for edit in list_edits(comparison)]


@pytest.mark.parametrize(
    ("old", "new", "texts"),
    [
        (
            "wcet: 2 ms",
            "wcet: 4 ms",
            # `strong` says its own.
            (
                "component type `motor`: worst case execution time `2 ms` → `4 ms`; in 4 instances: `body.a`, "
                "`body.left.elbow` and 2 more; of X and Z"
            ),
        ),
        (
            "rate: 10 Hz",
            "rate: 8 Hz",
            # `legs.c` says its own.
            "component type `motor`: rate `10 Hz` → `8 Hz`; in 4 instances: `body.a`, `body.b` and 2 more; of X and Z",
        ),
        (
            "Turns.",
            "Turns slowly.",
            (
                "component type `motor`: functionality `Turns.` → `Turns slowly.`; in 5 instances: `body.a`, `body.b` and 3 "
                "more; of X and Z"
            ),
        ),
        (
            "executable: motor",
            "executable: engine",
            (
                "component type `motor`: executable of the node `motor` → `engine`; in 5 instances: `body.a`, `body.b` and 3 "
                "more; of X and Z"
            ),
        ),
        (
            "inputs: {target: Goal}\n    outputs: {state: State}",
            "inputs: {target: Goal, brake: {type: Goal, optional: true, external: The operator}}\n    outputs: {state: State}",
            "component type `motor` now has the input `brake`; in 5 instances: `body.a`, `body.b` and 3 more; of X and Z",
        ),
        (
            "joint: {inputs",
            "joint: {timing: {wcet: 7 ms}, inputs",
            (
                "component type `arm`: worst case execution time of the component `joint` set to `7 ms`; in 2 instances: "
                "`body.left.joint` and `legs.right.joint`; of X and Z"
            ),
        ),
        (
            "rate: 10 Hz, wcet: 2 ms",
            "rate: 10 Hz, wcet: 2 ms, jitter: 1 ms",
            "component type `motor`: jitter set to `1 ms`; in 5 instances: `body.a`, `body.b` and 3 more; of X and Z",
        ),
    ],
)
def test_what_changed_at_a_type_is_one_item(compared: Compared, old: str, new: str, texts: str) -> None:
    assert list_texts(compared(ROBOT, ROBOT.replace(old, new, 1))) == [texts]


def test_an_instance_that_differs_has_its_own_line(compared: Compared) -> None:
    # Its list holds more than the type's.
    assert list_texts(compared(ROBOT, ROBOT.replace("tags: [drive]", "tags: [turning]"))) == [
        "component type `motor`: tags `drive` → `turning`; in 4 instances: `body.a`, `body.b` and 2 more; of X and Z",
        "`legs.c` now has the tag `turning` and no longer has the tag `drive`",
    ]


def test_an_instance_that_changes_by_itself_follows_no_type(compared: Compared) -> None:
    comparison = compared(ROBOT, ROBOT.replace("a: {is: motor,", "a: {is: motor, timing: {wcet: 9 ms},"))
    assert list_texts(comparison) == ["`body.a`: worst case execution time `2 ms` → `9 ms`"]
    assert list(find_type_edits(comparison, comparison.changes)) == []


def test_a_type_without_instances_is_compared(compared: Compared) -> None:
    before = ROBOT + "requirements: {R-1: Holds}\n"
    unused = "  unused: {timing: {rate: 1 Hz}}\n"
    before, after = (text.replace("groups:\n", unused + "groups:\n") for text in (before, before))
    assert list_texts(compared(before, after.replace("rate: 1 Hz", "rate: 2 Hz"))) == [
        "component type `unused`: rate `1 Hz` → `2 Hz`"
    ]


def test_each_instance_breaks_whom_it_breaks(compared: Compared) -> None:
    motor, rest = ROBOT.split("  strong:")
    comparison = compared(ROBOT, motor.replace("state: State", "state: Text") + "  strong:" + rest)
    (edit, *others) = [edit for edit in list_edits(comparison) if edit.breaks]
    assert others == []
    assert edit.text == (
        "component type `motor`: type of the output `state` `State` → `Text`; in 5 instances: `body.a`, `body.b` and 3 "
        "more; of X and Z"
    )
    assert [(each.partner, each.reason) for each in edit.breaks] == [
        ("y", "gives `Text` instead of `State` as `body.a.state`; `mind.log.a` of Y reads it"),
        ("y", "gives `Text` instead of `State` as `body.b.state`; `mind.log.b` of Y reads it"),
        ("y", "gives `Text` instead of `State` as `legs.c.state`; `mind.log.c` of Y reads it"),
    ]
    broken = [change.element_id for change in comparison.changes if change.breaks]
    assert broken == ["body.a.state", "body.b.state", "legs.c.state"]


def test_programs_get_each_change_with_its_type(compared: Compared) -> None:
    comparison = compared(ROBOT, ROBOT.replace("wcet: 2 ms", "wcet: 4 ms"))
    changes = json.loads(write_comparison_json(comparison, ReadingErrors()))["changes"]
    assert [(each["element"], each["key"], each.get("type")) for each in changes] == [
        ("arm", "components.elbow:timing.wcet", "motor"),
        ("motor", "timing.wcet", None),
        ("body.a", "timing.wcet", "motor"),
        ("body.left.elbow", "timing.wcet", "motor"),
        ("legs.c", "timing.wcet", "motor"),
        ("legs.right.elbow", "timing.wcet", "motor"),
    ]
    assert set(trace_origins(comparison, comparison.changes).values()) == {TypeKey("motor", "timing.wcet")}


def test_the_long_form_differs_from_the_short_one_in_its_types_only(compared: Compared) -> None:
    for before, after in ((SHORT, LONG), (LONG, SHORT)):
        changes = compared(before, after).changes
        others = [change for change in changes if change.element_kind != "component_type" and change.key != "is"]
        assert [change.text for change in others] == []
        assert len(changes) == 11


def test_a_thousand_instances_are_one_item(compared: Compared) -> None:
    components = "\n".join(f"      m{number}: {{is: motor}}" for number in range(1000))
    text = f"component_types:\n  motor: {{timing: {{wcet: 2 ms}}}}\ngroups:\n  g:\n    components:\n{components}\n"
    assert list_texts(compared(text, text.replace("2 ms", "3 ms"))) == [
        "component type `motor`: worst case execution time `2 ms` → `3 ms`; in 1000 instances: `g.m0`, `g.m1` and 998 more"
    ]


def test_what_changed_inside_of_a_nested_type_is_told_at_the_type_that_says_it(compared: Compared) -> None:
    text = """\
component_types:
  motor: {outputs: {state: S}}
  arm: {components: {m: {is: motor}, n: {timing: {wcet: 2 ms}}}}
  robot: {components: {left: {is: arm}}}
groups: {g: {components: {r: {is: robot}}}}
"""
    assert list_texts(compared(text, text.replace("2 ms", "3 ms"))) == [
        (
            "component type `arm`: worst case execution time of the component `n` `2 ms` → `3 ms`; in its instance "
            "`g.r.left.n`"
        )
    ]


def test_a_type_under_another_name_is_the_same_one_as_an_argument_too(compared: Compared) -> None:
    before = """\
types: {Pose: geometry_msgs/msg/Pose}
component_types:
  filter: {title: Low pass, functionality: Smooths what arrives., generic: [T], inputs: {i: T}, outputs: {o: T}, timing: {rate: 10 Hz}}
groups:
  g:
    components:
      s: {outputs: {o: Pose}}
      f: {is: filter<Pose>, inputs: {i: s.o}}
      r: {inputs: {i: f.o}}
"""
    after = before.replace("Pose", "Place").replace("msg/Place", "msg/Pose").replace("filter", "sieve")
    texts = list_texts(compared(before, after))
    assert [text for text in texts if "made from" in text or "`f`" in text] == []
    # What changed at the type that has another name now is told at the type all the same.
    assert [text for text in list_texts(compared(before, after.replace("10 Hz", "5 Hz"))) if "rate" in text] == [
        "component type `sieve`: rate `10 Hz` → `5 Hz`; in its instance `g.f`"
    ]


TYPED_START = """\
component_types:
  station: {title: S, node: {command: [serve, x], start: {phase: core, ready: {port: 81}}}}
  line: {title: L, components: {first: {title: F}, second: {title: S, node: {start: {after: first}}}, third: {title: T}}}
groups: {g: {components: {a: {is: station}, b: {is: station, node: {start: {ready: {port: 82}}}}, c: {is: line}}}}
"""


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("phase: core", "phase: network", "component type `station`: start phase of the node `core` → `network`, so earlier than before; in 2 instances: `g.a` and `g.b`"),
        ("[serve, x]", "[serve]", "component type `station`: command of the node `serve x` → `serve`; in 2 instances: `g.a` and `g.b`"),
        ("port: 81", "port: 80", "component type `station`: port that shows it is up of the node 81 → 80; in its instance `g.a`"),
        ("after: first", "after: third", "node `second`: start after `g.c.first` → `g.c.third`"),
    ],
)  # fmt: skip
def test_the_start_up_of_a_type_is_told_once(compared: Compared, old: str, new: str, line: str) -> None:
    assert list_texts(compared(TYPED_START, TYPED_START.replace(old, new, 1))) == [line]


def test_of_a_type_without_a_pattern_only_what_it_says_itself_is_known(tmp_path: Path) -> None:
    """A version whose patterns were not linked, as where a caller gives the architecture alone."""
    (tmp_path / "robot.yaml").write_text(ROBOT, encoding="utf-8")
    architecture = pipeline.check_project(tmp_path / "robot.yaml").architecture
    context = ReadContext(ArchitectureVersion(architecture), MatchedIds())
    motor = architecture.component_types["motor"]
    values = {key.name: key.value_of(motor, context) for key in COMPONENT_TYPE.keys if key.name != "title"}
    assert {name: value for name, value in values.items() if value} == {
        "functionality": "Turns.",
        "inputs.": {"target": "Goal"},
        "outputs.": {"state": "State"},
    }
    # A key of many values has none, a plain one is not known.
    assert (values["timing."], values["parameters."], values["tags"], values["role"]) == ({}, {}, None, None)


def test_the_owner_of_a_type_that_got_another_id_is_the_same(compared: Compared) -> None:
    text = """\
partners: {lab: Robots}
component_types: {motor: {owner: lab, outputs: {o: std_msgs/msg/Bool}}}
groups: {g: {owner: lab, components: {c: C}}}
"""
    changes = compared(text, text.replace("lab", "institute")).changes
    assert [(change.kind, change.element_kind) for change in changes] == [("renamed", "partner")]
