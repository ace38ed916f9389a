"""Rules upon projects: what they find, and where what they write goes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from archgen.passes.patterns.rule_running import run_rules
from tests.passes.patterns.transforming import data_of, pass_of, said, transform, tree_of, work_of

ROBOT = """
archgen: 1
component_types:
  camera: {outputs: {image: Picture}, tags: [sensor]}
  filter: {generic: [T], inputs: {raw: T}, outputs: {clean: T}}
  station:
    inputs: {order: Order}
    outputs: {view: {from: eye.image}}
    components:
      eye: {is: camera}
      desk: {inputs: {order: self.order, seen: eye.image}}
groups:
  robot:
    components:
      left: {is: camera}
      right: {is: camera, outputs: {image: {type: Raw picture}}}
      sharpen: {is: filter<Picture>, inputs: {raw: left.image}}
      head: {is: station, inputs: {order: brain.order}}
      brain:
        inputs: {view: head.view, pictures: {from: [sharpen.clean, right]}}
        outputs: {order: Order}
      shell:
        inputs: {x: brain.order}
        outputs: {y: {from: inner.y}}
        components:
          inner: {inputs: {x: self.x}, outputs: {y: Order}}
types: {Picture: sensor_msgs/msg/Image, Raw picture: sensor_msgs/msg/Image, Order: std_msgs/msg/String}
"""


def _after(rules: str, folder: Path) -> Any:  # noqa: ANN401 - plain data
    data, findings = transform(ROBOT, rules, folder)
    assert findings == ()
    return data


def _parts(data: Any) -> Any:  # noqa: ANN401 - plain data
    return data["groups"]["robot"]["components"]


def test_components_of_every_depth_are_seen_with_what_they_have_from_their_types(tmp_path: Path) -> None:
    from archgen.passes.patterns.architecture_view import ArchitectureView

    view = ArchitectureView(tree_of(ROBOT, tmp_path))
    assert list(view.list_elements("components")) == [
        *("camera", "filter", "station", "station.eye", "station.desk", "robot"),
        *(f"robot.{name}" for name in ("left", "right", "sharpen", "head", "brain", "shell", "shell.inner")),
    ]
    assert view.get_component("robot.sharpen") == {
        "kind": "component",
        "id": "sharpen",
        "in": "robot",
        "is": "filter<Picture>",
        "inputs": {"raw": {"type": "Picture", "from": ["robot.left.image"]}},
        "outputs": {"clean": {"type": "Picture"}},
    }
    brain = view.get_component("robot.brain")
    assert brain is not None
    assert brain["inputs"] == {
        "view": {"from": ["robot.head.view"]},
        "pictures": {"from": ["robot.sharpen.clean", "robot.right"]},
    }
    desk = view.get_component("station.desk")
    assert desk is not None
    assert desk["inputs"] == {"order": {"from": ["self.order"]}, "seen": {"from": ["station.eye.image"]}}
    assert view.is_a("robot.left", "camera")
    assert view.is_a("Envelope<Order>", "Envelope")
    assert not view.is_a("robot.brain", "camera")


@pytest.mark.parametrize(
    ("rules", "path", "wanted"),
    [
        # What an instance takes its data from is the instance's, its ports are its type's.
        (
            "- {find: {components: {robot.left: {outputs: {image: {type: Picture}}}}}, set: {components: {robot.left: {outputs: {image: {type: Order}}}}}}",
            "component_types.camera.outputs.image",
            {"type": "Order"},
        ),
        (
            "- {find: {components: {robot.right: {outputs: {image: {type: Raw picture}}}}}, set: {components: {robot.right: {outputs: {image: {type: Order}}}}}}",
            "groups.robot.components.right.outputs.image",
            {"type": "Order"},
        ),
        # What a generic name stands for is the instance's.
        (
            "- {find: {components: {robot.sharpen: {outputs: {clean: {type: Picture}}}}}, set: {components: {robot.sharpen: {outputs: {clean: {type: Order}}}}}}",
            "groups.robot.components.sharpen.outputs.clean",
            {"type": "Order"},
        ),
        (
            "- {find: {components: {robot.left: {outputs: {image: }}}}, unless: {components: {robot.left: {outputs: {more: }}}}, add: {components: {robot.left: {outputs: {more: Order}}}}}",
            "component_types.camera.outputs.more",
            {"type": "Order"},
        ),
        (
            "- {find: {components: {robot.left: {tags: [sensor]}}}, unless: {components: {robot.left: {tags: [new]}}}, add: {components: {robot.left: {tags: [new]}}}}",
            "groups.robot.components.left.tags",
            ["new"],
        ),
        (
            "- {find: {components: {robot.left: {tags: [sensor]}}}, drop: {components: {robot.left: {tags: [sensor]}}}}",
            "component_types.camera",
            {"outputs": {"image": {"type": "Picture"}}},
        ),
        (
            "- {find: {components: {robot.left: }}, unless: {components: {robot.left: {title: }}}, add: {components: {robot.left: {title: Left eye}}}}",
            "groups.robot.components.left.title",
            "Left eye",
        ),
        # References are written so that they mean the same from where they stand.
        (
            "- {find: {components: {station.desk: {inputs: {order: {from: [$o]}}}}}, where: not $o == station.eye.image, set: {components: {station.desk: {inputs: {order: {from: [station.eye.image]}}}}}}",
            "component_types.station.components.desk.inputs.order.from",
            ["eye.image"],
        ),
        (
            "- {find: {components: {robot.shell.inner: {inputs: {x: {from: [self.x]}}}}}, drop: {components: {robot.shell.inner: {inputs: {x: {from: [self.x]}}}}}, add: {components: {robot.shell.inner: {inputs: {x: {from: [robot.brain.order]}}}}}}",
            "groups.robot.components.shell.components.inner.inputs.x.from",
            ["robot.brain.order"],
        ),
        (
            "- {find: {components: {robot.brain: {inputs: {pictures: {from: [robot.right]}}}}}, drop: {components: {robot.brain: {inputs: {pictures: {from: [robot.right]}}}}}}",
            "groups.robot.components.brain.inputs.pictures.from",
            ["sharpen.clean"],
        ),
        # Components and types come and go.
        (
            "- {find: {components: {robot: }}, unless: {components: {robot.watch: }}, let: {$t: [robot.brain.order]}, add: {components: {robot.watch: {title: Watch, inputs: {in: {from: $t}}, outputs: {out: Order}}}}}",
            "groups.robot.components.watch",
            {"title": "Watch", "inputs": {"in": {"from": ["brain.order"]}}, "outputs": {"out": {"type": "Order"}}},
        ),
        (
            "- {find: {components: {$c: {kind: component, in: robot}}}, where: not $c == robot.brain, drop: {components: {$c: }}}",
            "groups.robot.components",
            {
                "brain": {
                    "inputs": {"view": {"from": ["head.view"]}, "pictures": {"from": ["sharpen.clean", "right"]}},
                    "outputs": {"order": {"type": "Order"}},
                }
            },
        ),
        (
            "- {find: {types: {$t: {message: sensor_msgs/msg/Image}}}, set: {types: {$t: {message: sensor_msgs/msg/CompressedImage}}}}",
            "types.Raw picture",
            {"message": "sensor_msgs/msg/CompressedImage"},
        ),
        (
            "- {find: {types: {Order: }}, unless: {types: {Envelope: }}, add: {types: {Envelope: {generic: [T], fields: {sender: string, payload: T}}}}}",
            "types.Envelope",
            {"generic": ["T"], "fields": {"sender": {"type": "string"}, "payload": {"type": "T"}}},
        ),
        (
            "- {find: {types: {Raw picture: }}, drop: {types: {Raw picture: }}}",
            "types",
            {"Picture": {"message": "sensor_msgs/msg/Image"}, "Order": {"message": "std_msgs/msg/String"}},
        ),
        (
            "- {find: {components: {$f: $body, $i: {is: {$f: $kind}}}}, let: {$name: '${f}_of_${kind}', $new: snake($name), $made: 'specialise($body, T=$kind)'}, unless: {components: {$new: }}, add: {components: {$new: $made}}, set: {components: {$i: {is: $new}}}}",
            "component_types.filter_of_picture",
            {"inputs": {"raw": {"type": "Picture"}}, "outputs": {"clean": {"type": "Picture"}}},
        ),
        (
            "- {find: {components: {$c: {kind: type, id: $n, outputs: }}}, let: {$up: camel($n), $all: 'join($up, \" of type\")'}, unless: {components: {$c: {title: }}}, add: {components: {$c: {title: $all}}}}",
            "component_types.camera.title",
            "Camera of type",
        ),
        (
            "- {find: {components: {robot.head: {is: station}}}, unless: {components: {$other: {id: brain_2}}}, let: {$free: unique(robot.brain)}, add: {components: {$free: {title: Second}}}}",
            "groups.robot.components.brain_2",
            {"title": "Second"},
        ),
    ],
)
def test_what_a_rule_writes_goes_where_it_belongs(rules: str, path: str, wanted: object, tmp_path: Path) -> None:
    data = _after(rules, tmp_path)
    for key in path.split("."):
        data = data[key]
    assert data == wanted


def test_a_set_body_makes_an_instance_say_everything_itself(tmp_path: Path) -> None:
    rules = """
    - find: {components: {$instance: $body}}
      where: [$body has is, $body has in]
      let: {$own: "without($body, is)"}
      drop: {components: {$instance: {is: }}}
      set: {components: {$instance: $own}}
    """
    parts = _parts(_after(rules, tmp_path))
    assert parts["head"] == data_of(
        """
        inputs: {order: {from: [brain.order], type: Order}}
        outputs: {view: {from: [eye.image]}}
        components:
          eye: {outputs: {image: {type: Picture}}, tags: [sensor]}
          desk: {inputs: {order: {from: [self.order]}, seen: {from: [eye.image]}}}
        """
    )


def test_a_name_that_comes_takes_no_reference_away(tmp_path: Path) -> None:
    project = """
    archgen: 1
    groups:
      a: {components: {box: {components: {reader: {inputs: {x: source.o}}}}}}
      b: {components: {source: {outputs: {o: T}}}}
    types: {T: std_msgs/msg/String}
    """
    rules = "- {find: {components: {a.box: }}, unless: {components: {a.box.source: }}, add: {components: {a.box.source: {outputs: {o: T}}}}}"
    data, findings = transform(project, rules, tmp_path)
    assert findings == ()
    assert data["groups"]["a"]["components"]["box"]["components"]["reader"]["inputs"]["x"]["from"] == ["b.source.o"]  # type: ignore[index]


@pytest.mark.parametrize(
    ("rules", "wanted"),
    [
        (
            "- {find: {components: {$c: {tags: [sensor]}}}, add: {components: {$c: {tags: [sensor]}}}}",
            "3: this rule changes nothing that it finds, and comes to no end",
        ),
        (
            "- {find: {components: {robot.brain: }}, unless: {components: {robot.brain: {title: }}}, add: {components: {robot.brain: {outputs: {order: {type: Picture}}}}}}",
            "3: `add` finds `Order` at `outputs.order.type` of `robot.brain`, and not `Picture`",
        ),
        (
            "- {find: {components: {station.desk: }}, add: {components: {station.desk: {inputs: {far: {from: [robot.brain.order]}}}}}}",
            "3: `robot.brain.order` cannot be named at `station.desk`: it lies outside of what is seen from there",
        ),
        (
            "- {find: {components: {robot.brain: }}, add: {components: {robot.brain: {inputs: {far: {from: [nowhere.x]}}}}}}",
            "3: `nowhere.x` is no port and no component",
        ),
        (
            "- {find: {components: {robot.brain: }}, add: {components: {robot.brain: {outputs: {Upper Case: Order}}}}}",
            "3: `Upper Case` is no id, so no port can be called so",
        ),
        (
            "- {find: {components: {robot.brain: }}, add: {components: {robot.No Id: {title: x}}}}",
            "3: `No Id` is no id, so nothing can be called so",
        ),
        (
            "- {find: {components: {robot.brain: }}, add: {components: {nowhere.new: {title: x}}}}",
            "3: `nowhere.new` is to stand in `nowhere`, which there is not",
        ),
        (
            "- {find: {components: {robot.head: }}, add: {components: {robot.head.new: {title: x}}}}",
            "3: `robot.head.new` is to stand in an instance, which has what its type has",
        ),
        (
            "- {find: {components: {$c: {tags: $t}}}, let: {$x: snake($t)}, add: {components: {$c: {title: $x}}}}",
            "3: `snake` takes texts, and this is a list",
        ),
        (
            "- {find: {components: {$c: {tags: $t}}}, add: {components: {$c: {title: 'a $t'}}}}",
            "3: a text is made of texts, and one of these variables stands for a list or a mapping",
        ),
        (
            "- {find: {components: {$c: {outputs: {order: $o}}}}, add: {components: {$c: {inputs: {$o: Order}}}}}",
            "3: a key is a text, and this variable stands for a list or a mapping",
        ),
    ],
)
def test_what_cannot_be_written_ends_the_pass_with_a_finding(rules: str, wanted: str, tmp_path: Path) -> None:
    assert said(ROBOT, rules, tmp_path) == [wanted]


def test_a_rule_that_goes_on_for_ever_is_stopped(tmp_path: Path) -> None:
    rules = "- {find: {components: {robot: }}, let: {$n: unique(robot.new)}, add: {components: {$n: {title: x}}}}"
    work = work_of(ROBOT, tmp_path)
    (finding,) = run_rules(pass_of(rules), work, max_applications=50)
    assert finding.message == "the pass `tried` has changed something 50 times, and still finds more"
    assert finding.help == "say in `unless` when the work of a rule is done"
    assert finding.labels[0].span.file == "archgen.yaml"


def test_two_rules_that_undo_one_another_are_stopped(tmp_path: Path) -> None:
    rules = """
    - {find: {components: {robot.brain: {title: A}}}, set: {components: {robot.brain: {title: B}}}}
    - {find: {components: {robot.brain: {title: B}}}, set: {components: {robot.brain: {title: A}}}}
    - {find: {components: {robot.brain: }}, unless: {components: {robot.brain: {title: }}}, add: {components: {robot.brain: {title: A}}}}
    """
    (finding,) = run_rules(pass_of(rules), work_of(ROBOT, tmp_path), max_applications=100)
    assert "100 times" in finding.message


def test_rules_run_in_order_until_none_finds_anything(tmp_path: Path) -> None:
    rules = """
    - {find: {components: {robot.brain: {tags: [b]}}}, unless: {components: {robot.brain: {tags: [c]}}}, add: {components: {robot.brain: {tags: [c]}}}}
    - {find: {components: {robot.brain: {tags: [a]}}}, unless: {components: {robot.brain: {tags: [b]}}}, add: {components: {robot.brain: {tags: [b]}}}}
    - {find: {components: {robot.brain: {id: brain}}}, unless: {components: {robot.brain: {tags: [a]}}}, add: {components: {robot.brain: {tags: [a]}}}}
    """
    assert _parts(_after(rules, tmp_path))["brain"]["tags"] == ["a", "b", "c"]


def test_what_is_made_knows_where_it_comes_from(tmp_path: Path) -> None:
    rules = "- {find: {components: {robot.brain: }}, unless: {components: {robot.brain: {title: }}}, add: {components: {robot.brain: {title: Brain}}}}"
    work = work_of(ROBOT, tmp_path)
    assert run_rules(pass_of(rules), work) == ()
    origin = work.tree.trace(("groups", "robot", "components", "brain", "title"))
    assert origin.passes == ("tried",)
    assert (origin.at.file, origin.at.line) == ("archgen.yaml", 19)


def test_a_type_and_a_group_of_one_name_are_two(tmp_path: Path) -> None:
    project = """
    archgen: 1
    component_types: {arm: {outputs: {s: T}}}
    groups: {arm: {components: {left: {is: arm}}}}
    types: {T: std_msgs/msg/String}
    """
    rules = """
    - {find: {components: {$i: {is: $type}, $type: {kind: type}}}, unless: {components: {$type: {title: }}}, add: {components: {$type: {title: An arm}}}}
    - {find: {components: {arm: {kind: group}}}, unless: {components: {arm: {title: }}}, add: {components: {arm: {title: Arms}}}}
    """
    data, findings = transform(project, rules, tmp_path)
    assert findings == ()
    assert data["component_types"]["arm"]["title"] == "An arm"  # type: ignore[index]
    assert data["groups"]["arm"]["title"] == "Arms"  # type: ignore[index]
