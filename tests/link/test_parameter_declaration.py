"""What is read of parameters and operations, over several files too, and how a value is handed in."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.link.declare.handed_parameters import fill_in_text, hand_in_value
from archgen.model.parameter import Operation, Parameter, ParameterValue
from archgen.pipeline import CheckedProject, check_project


def check(folder: Path, **files: str) -> CheckedProject:
    for name, text in {"archgen": "archgen: 1", **files}.items():
        (folder / f"{name}.yaml").write_text(text, encoding="utf-8")
    return check_project(folder)


def lines(checked: CheckedProject) -> list[str]:
    return [
        f"{f.span.file}:{f.span.line} {f.rule}: {f.message}" for f in checked.findings if f.rule != "missing-detail"
    ]


def test_all_that_is_declared_is_read(tmp_path: Path) -> None:
    text = """\
groups:
  g:
    components:
      c:
        title: C
        parameters:
          speed: {type: float, value: 0.8, unit: m/s, range: [0, .inf], choices: [0.8, 1], description: D, read_only: true, visibility: private, hints: {a: {b: 1}}}
          side: {from: self.side}
        open: [Follow]
        operations:
          get: Position
          set: {title: Set it, request: {gain: float64, pose: geometry_msgs/Pose}, call: asynchronous, visibility: public, description: D}
"""
    component = check(tmp_path, c=text).architecture.components["g.c"]
    assert component.parameters == {
        "speed": Parameter(
            "speed", "float", 0.8, "m/s", (0, float("inf")), (0.8, 1), "D", read_only=True, visibility="private", hints={"a": {"b": 1}}
        ),
        "side": Parameter("side", handed_from="self.side"),
    }  # fmt: skip
    assert component.open == ("Follow",)
    assert component.operations == {
        "get": Operation("get", "Get", response="Position"),
        "set": Operation(
            "set",
            "Set it",
            request={"gain": "float64", "pose": "geometry_msgs/msg/Pose"},
            call="asynchronous",
            visibility="public",
            description="D",
        ),
    }
    assert component.operations["set"].type_names == ("float64", "geometry_msgs/msg/Pose")


def test_files_complete_a_declaration_and_conflict_by_its_keys(tmp_path: Path) -> None:
    component = "groups: {g: {components: {c: {TITLEparameters: {set: {gain: DECLARATION}}}}}}"
    checked = check(
        tmp_path,
        a=component.replace("TITLE", "title: C, ").replace("DECLARATION", "{type: float, range: [0, 1]}"),
        b=component.replace("TITLE", "").replace("set: {gain: DECLARATION}", "set.gain: 0.5"),
        c=component.replace("TITLE", "").replace("DECLARATION", "{value: 0.6}"),
    )
    assert checked.architecture.components["g.c"].parameters["set.gain"].value == 0.5
    assert lines(checked) == ["c.yaml:1 conflicting-values: `value` of the parameter `set.gain` of `g.c` is written in two places"]  # fmt: skip


def test_parameters_of_a_node_and_of_all_nodes_are_one_value_each(tmp_path: Path) -> None:
    checked = check(
        tmp_path,
        a="ros: {parameters: {limits: {x: 1}}}\nnodes: {n: {parameters: {limits: {x: 1}}}}",
        b="ros: {parameters: {limits: {y: 1}}}\nnodes: {n: {parameters: {limits: {y: 1}, other: 1}}}",
    )
    assert [line for line in lines(checked) if "conflicting" in line] == [
        "b.yaml:1 conflicting-values: `limits` is written in two places",
        "b.yaml:2 conflicting-values: `limits` of `n` is written in two places",
    ]
    assert checked.architecture.ros_parameters == (ParameterValue("limits.x", 1),)
    assert checked.architecture.nodes["n"].own_values == (ParameterValue("limits.x", 1), ParameterValue("other", 1))


def test_parameters_alone_declare_no_component(tmp_path: Path) -> None:
    checked = check(tmp_path, a="groups: {g: {title: G, components: {c: {parameters: {gain: 1}}}}}")
    assert lines(checked)[0] == "a.yaml:1 undeclared-element: no file declares the component `g.c`"


def test_the_types_of_operations_are_used(tmp_path: Path) -> None:
    text = "types: {Pose: geometry_msgs/msg/Pose}\ngroups: {g: {components: {c: {title: C, operations: {get: Pose}}}}}"
    assert [line for line in lines(check(tmp_path, a=text)) if "unused-type" in line] == []


def test_a_value_is_handed_in_by_the_component_around() -> None:
    outer = {"side": Parameter("side", "string", "left")}
    inner = Parameter("arm_side", handed_from="self.side")
    handed = hand_in_value(inner, outer)
    assert handed is not None
    assert (handed.name, handed.value, handed.type) == ("arm_side", "left", "string")
    assert hand_in_value(inner, {}) is None
    assert hand_in_value(Parameter("x", value=1), {}) == Parameter("x", value=1)


@pytest.mark.parametrize(
    ("text", "filled_in"),
    [
        ("$(self.prefix)base_link", ("left_base_link", ())),
        ("$(self.count)", (3, ())),
        ("n$(self.count)", ("n3", ())),
        ("$(self.flag)", (True, ())),
        ("$(self.nix)/x/$(self.set.a)", ("$(self.nix)/x/1.5", ("nix",))),
        ("$$(self.count)", ("$(self.count)", ())),
        ("$(find-pkg-share x)", ("$(find-pkg-share x)", ())),
        ("$(self.unset)", ("$(self.unset)", ())),
        ("$(self.", ("$(self.", ())),
    ],
)
def test_references_in_text_are_filled_in(text: str, filled_in: tuple[object, tuple[str, ...]]) -> None:
    values = {"prefix": "left_", "count": 3, "flag": True, "set.a": 1.5, "unset": None}
    outer = {name: Parameter(name, value=value) for name, value in values.items()}
    assert fill_in_text(text, outer) == filled_in
