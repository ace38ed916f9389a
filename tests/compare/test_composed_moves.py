"""Components that move into composed ones or out, composed components under other ids, and connections that are made."""

from __future__ import annotations

import pytest

from tests.compare.conftest import Compared, Told

PLAIN = """\
partners: {x: X, y: Y}
types: {Image: sensor_msgs/msg/Image}
groups:
  body:
    owner: x
    components:
      planner: {outputs: {goal: Goal}}
      arm:
        inputs: {target: planner.goal}
        outputs: {state: {from: motor.state}}
        components:
          motor: {functionality: Turns, inputs: {target: self.target}, outputs: {state: State}}
      camera: {functionality: Sees apples, inputs: {goal: planner.goal}, outputs: {image: Image}}
  mind:
    owner: y
    components:
      log: {inputs: {a: arm.state, image: camera.image}}
nodes:
  camera: {implements: camera, package: c, executable: c, publishes: {image: /image}}
  log: {implements: log, package: l, executable: l}
"""
CAMERA = "      camera: {functionality: Sees apples, inputs: {goal: planner.goal}, outputs: {image: Image}}\n"
INSIDE = (
    PLAIN.replace(CAMERA, "")
    .replace("from: motor.state}}", "from: motor.state}, image: {from: camera.image}}")
    .replace("State}}\n", "State}}\n    " + CAMERA.replace("planner.goal", "self.target"), 1)
    .replace("camera.image}}\nnodes", "arm.image}}\nnodes")
    .replace("implements: camera", "implements: arm.camera")
)
AROUND = PLAIN.replace(
    CAMERA,
    "      camera:\n        inputs: {goal: planner.goal}\n        outputs: {image: {from: eye.image}}\n"
    "        components:\n          eye: {functionality: Sees apples, inputs: {goal: self.goal}, outputs: {image: Image}}\n",
).replace("implements: camera", "implements: camera.eye")


def test_a_component_that_moves_into_a_composed_one_is_moved(told: Told) -> None:
    assert told(PLAIN, INSIDE) == [
        "moved component body.arm.camera: component `body.camera` moved into the composed component `body.arm`",
    ]
    assert told(INSIDE, PLAIN) == [
        "moved component body.camera: component `body.arm.camera` moved out of the composed component `body.arm`",
    ]


def test_whoever_names_what_moved_has_to_follow(compared: Compared) -> None:
    (change,) = compared(PLAIN, INSIDE).changes
    assert [(each.partner, each.category) for each in change.breaks] == [("y", "source")]


@pytest.mark.parametrize(("before", "after"), [(PLAIN, AROUND), (AROUND, PLAIN)])
def test_a_composed_component_around_a_leaf_breaks_nobody(compared: Compared, before: str, after: str) -> None:
    comparison = compared(before, after)
    assert [(each.kind, each.element_kind) for each in comparison.changes] in (
        [("added", "composed"), ("moved", "component")],
        [("removed", "composed"), ("moved", "component")],
    )
    assert [each for change in comparison.changes for each in change.breaks] == []


def test_what_is_inside_of_a_composed_component_follows_its_id(told: Told, compared: Compared) -> None:
    after = PLAIN.replace("      arm:", "      limb:").replace("arm.state", "limb.state")
    assert told(PLAIN, after) == [
        "renamed composed body.limb: composed component `body.arm` is called `limb` now",
    ]
    (change,) = compared(PLAIN, after).changes
    assert [(each.partner, each.reason) for each in change.breaks] == [
        (
            "y",
            "renames what Y reads: `body.arm.motor.state` is `body.limb.motor.state` now; files follow in this change",
        )
    ]


JOINED = """\
groups:
  g:
    autoconnect: ports
    components:
      a: {outputs: {pose: Pose, map: Map}}
      b: {inputs: {pose: {type: Pose}}}
      c: {inputs: {map: a.map, pose: a.pose}}
"""


def test_what_autoconnect_joins_otherwise_is_said_as_such(told: Told) -> None:
    apart = JOINED.replace("    autoconnect: ports\n", "")
    assert told(apart, JOINED) == [
        "added connection g.b.pose: `g.b.pose` now reads `g.a.pose`, its first source, joined by itself"
    ]
    assert told(JOINED, apart) == [
        (
            "removed connection g.b.pose: `g.b.pose` no longer reads `g.a.pose`, joined by itself before; it has no source any "
            "more"
        )
    ]


def test_the_same_connection_written_by_hand_is_no_change(told: Told) -> None:
    written = JOINED.replace("pose: {type: Pose}", "pose: {type: Pose, from: a.pose}")
    assert told(JOINED, written) == []
    # A written one that was changed is not called made.
    assert told(written, written.replace("from: a.pose", "from: a.map").replace("type: Pose, from", "from")) != []


def test_what_a_composed_component_says_of_the_whole_is_compared(told: Told) -> None:
    whole = PLAIN.replace(
        "      arm:\n",
        "      arm:\n        timing: {deadline: 20 ms}\n        performance: {reach: {accuracy: 1 mm}}\n"
        "        parameters: {side: left}\n        operations: {stop: Empty}\n",
    )
    changed = whole.replace("20 ms", "30 ms").replace("1 mm", "2 mm").replace("side: left", "side: right")
    assert told(whole, changed.replace("stop: Empty", "stop: Found")) == [
        "changed composed body.arm: `body.arm`: response of the operation `stop` `Empty` → `Found`",
        "changed composed body.arm: `body.arm`: parameter `side` `left` → `right`",
        "changed composed body.arm: `body.arm`: performance reach accuracy `1 mm` → `2 mm`",
        "changed composed body.arm: `body.arm`: deadline `20 ms` → `30 ms`",
    ]
