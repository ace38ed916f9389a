"""What a component around hands in: parameters, texts with them, and names of frames."""

from __future__ import annotations

from pathlib import Path

from tests.compose.test_project_expansion import read_architecture
from tests.judged_projects import check_text

TEXT = """
component_types:
  arm:
    parameters: {side: {type: string}, speed: {type: float, value: 0.5, unit: m/s}}
    components:
      hand:
        parameters: {side: {from: self.side}}
        components:
          motor:
            parameters: {side: {from: self.side}, frame: "$(self.side)_motor", price: "$$(dollars)"}
            inputs: {x: {external: E}}
      brake: {parameters: {limit: {from: self.speed}}, inputs: {x: {external: E}}}
    frames: {"$(self.side)_base": body, "$(self.side)_tip": {parent: "$(self.side)_base"}}
groups:
  g:
    components:
      left: {is: arm, parameters: {side: left}}
      right: {is: arm, parameters: {side: right, speed: 0.2}}
frames: {body: {}}
"""


def test_values_are_handed_in_to_any_depth(tmp_path: Path) -> None:
    components = read_architecture(tmp_path, TEXT).components
    motor = components["g.right.hand.motor"].parameters
    assert {name: each.value for name, each in motor.items()} == {
        "side": "right",
        "frame": "right_motor",
        "price": "$(dollars)",
    }
    limits = [components[f"g.{side}.brake"].parameters["limit"] for side in ("left", "right")]
    assert [(each.value, each.type) for each in limits] == [(0.5, "float"), (0.2, "float")]
    # The type's value for one, the instance's for the other: each says where it is written.
    assert [each.value_at.line for each in limits] == [4, 18]


def test_each_instance_has_frames_of_its_own(tmp_path: Path) -> None:
    frames = read_architecture(tmp_path, TEXT).frames
    assert {name: frame.parent for name, frame in frames.items()} == {
        "body": None,
        "left_base": "body",
        "left_tip": "left_base",
        "right_base": "body",
        "right_tip": "right_base",
    }


def test_what_the_component_around_lacks_is_told_once() -> None:
    text = TEXT.replace("from: self.speed", "from: self.sped").replace("$(self.side)_motor", "$(self.sid)_motor")
    wrong = [finding for finding in check_text(text) if finding.rule == "unknown-reference"]
    assert [(finding.span.line, finding.message, finding.help) for finding in wrong] == [
        (10, "`g.left.hand` has no parameter `sid` to hand in", "did you mean `side`?"),
        (12, "`g.left` has no parameter `sped` to hand in", "did you mean `speed`?"),
    ]


def test_there_must_be_a_component_around() -> None:
    text = "groups: {g: {components: {a: {functionality: F., parameters: {side: {from: self.side}}}}}}"
    wrong = [finding.message for finding in check_text(text) if finding.rule == "unknown-reference"]
    assert wrong == ["`self.side` names a parameter of the component around `g.a`, but there is none"]


def test_the_node_and_the_ports_of_an_instance_are_named_by_its_parameters(tmp_path: Path) -> None:
    architecture = read_architecture(
        tmp_path,
        "component_types:\n"
        "  eye:\n"
        "    parameters: {side: {type: string}, rate: {type: float, unit: Hz, range: [1, 9], value: 2}}\n"
        '    outputs: {image: {type: T, frame: "$(self.side)_eye"}}\n'
        "    components: {lens: {functionality: F., parameters: {rate: {from: self.rate}}}}\n"
        '    node: {whole: true, package: e, namespace: "/$(self.side)", publishes: {image: "$(self.side)_image"}}\n'
        '    frames: {"$(self.side)_eye": body}\n'
        "groups: {g: {components: {left: {is: eye, parameters: {side: left}}}}}\n"
        "frames: {body: {}}\n",
    )
    assert architecture.shells["g.left"].outputs["image"].frame == "left_eye"
    assert [(node.namespace, node.uses[0].topics) for node in architecture.nodes.values()] == [
        ("/left", ("left_image",))
    ]
    rate = architecture.components["g.left.lens"].parameters["rate"]
    assert (rate.value, rate.unit, rate.range) == (2, "Hz", (1, 9))


def test_a_wrong_value_that_is_handed_in_is_told_where_it_is_written() -> None:
    text = TEXT.replace("value: 0.5, unit: m/s}", "value: 0.5, range: [0, 1]}").replace("speed: 0.2", "speed: 2")
    wrong = [finding for finding in check_text(text) if finding.rule == "wrong-parameter"]
    assert [(finding.span.line, finding.element) for finding in wrong] == [(18, "g.right")]
