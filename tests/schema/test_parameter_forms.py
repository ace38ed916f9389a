"""Declarations of parameters in normal form, and what is wrong with them."""

from __future__ import annotations

import pytest

from archgen.model.parameter import MAX_NAME_LENGTH
from archgen.schema import normalise_document, validate_document
from archgen.schema.component_sugar import expand_parameters
from archgen.syntax.yaml_parser import parse_yaml
from archgen.syntax.yaml_tree import MappingNode, node_to_data


def normalise(parameters: str) -> tuple[object, list[str]]:
    text = f"groups: {{g: {{components: {{c: {{parameters: {parameters}}}}}}}}}"
    document, _ = parse_yaml("f", text)
    assert document is not None
    findings = [*validate_document(document), *normalise_document(document)]
    node = document.root
    for key in ("groups", "g", "components", "c", "parameters"):
        below = node.get(key)
        assert isinstance(below, MappingNode)
        node = below
    normal_form = node_to_data(node)
    assert list(expand_parameters(document.root)) == []
    assert node_to_data(node) == normal_form, "normalising twice changes nothing"
    return normal_form, [
        f"{d.span.column - text.index(parameters) - 1} {d.rule}: {d.message} | {d.help}" for d in findings
    ]


@pytest.mark.parametrize(
    ("parameters", "normal_form"),
    [
        ("{gain: 0.5, names: [a, 1], on: true}", {"gain": {"value": 0.5}, "names": {"value": ["a", 1]}, "on": {"value": True}}),
        ("{gain: , side: {from: self.side}}", {"gain": {}, "side": {"from": "self.side"}}),
        ("{a: {b: {c: 1, d: {type: float}}}, a.e: 2}", {"a.b.c": {"value": 1}, "a.b.d": {"type": "float"}, "a.e": {"value": 2}}),
        ("{gain: {unit: m, description: d}}", {"gain.unit": {"value": "m"}, "gain.description": {"value": "d"}}),
        ("{gain: {value: 1, extra: 2}}", {"gain.value": {"value": 1}, "gain.extra": {"value": 2}}),
        ("{gain: {value: 1, unit: 1.10, description: }}", {"gain": {"value": 1, "unit": "1.10"}}),
        ("{gain: {value: , unit: m}}", {"gain": {"unit": "m", "value": None}}),
        ("{gain: {value: 1, hints: {orca: {tag: Car}}}}", {"gain": {"value": 1, "hints": {"orca": {"tag": "Car"}}}}),
        ("{controller: {type: PID, gain: 2}}", {"controller.type": {"value": "PID"}, "controller.gain": {"value": 2}}),
        ("{a: 1, a.b: 2}", {"a": {"value": 1}, "a.b": {"value": 2}}),
        ("{gain: {}}", {"gain": {}}),
    ],
)  # fmt: skip
def test_values_are_declarations_and_sets_dotted_names(parameters: str, normal_form: object) -> None:
    assert normalise(parameters) == (normal_form, [])


@pytest.mark.parametrize(
    ("parameters", "findings"),
    [
        (
            "{a: {b: 1}, a.b: 2}",
            ["12 conflicting-values: the parameter `a.b` is written twice | a set and a name with a dot mean the same: keep one of them"],
        ),
        (
            "{x: {type: float, valeu: 1}}",
            ["18 unknown-key: the declaration of the parameter `x` has no key `valeu` | did you mean `value`?"],
        ),
        (
            "{x: {type: double, default: 1}}",
            ["19 unknown-key: the declaration of the parameter `x` has no key `default` | write the value as `value`"],
        ),
        (
            "{x: {type: int, value: 1, min: 0}}",
            ["26 unknown-key: the declaration of the parameter `x` has no key `min` | write what it may be as `range: [LOWEST, HIGHEST]` or `choices: [...]`"],
        ),
        # A set of a plugin's parameters: nothing says that one parameter is meant.
        ("{x: {type: nav2::Planner, default: 1}}", []),
        (
            "{x: {value: 1, range: [2, 1]}}",
            ["22 wrong-value: a range is the least and the greatest number | write both: `range: [0, 1.5]`"],
        ),
        (
            "{x: {value: 1, range: [2]}}",
            ["22 wrong-value: a range is the least and the greatest number | write both: `range: [0, 1.5]`"],
        ),
        (
            "{x: {type: flaot, unit: m}}",
            ["11 wrong-value: `type` cannot be `flaot` | did you mean `float`?"],
        ),
        (
            "{a..b: 1}",
            ["1 wrong-value: `a..b` cannot be a parameter's name | a parameter's name has no blank, and something before and behind each dot, such as `localiser.particles`; write `a_b`"],
        ),
    ],
)  # fmt: skip
def test_what_contradicts_itself_is_found_at_its_place(parameters: str, findings: list[str]) -> None:
    assert normalise(parameters)[1] == findings


def test_a_name_is_bounded() -> None:
    deep = "{" + "".join(f"{'k' * 190}: {{" for _ in range(3)) + "a: 1" + "}" * 4
    normal_form, findings = normalise(deep)
    assert normal_form == {}
    assert [finding.partition(" ")[2] for finding in findings] == [
        f"wrong-value: the name of a parameter has more than {MAX_NAME_LENGTH} characters | use shorter names, or fewer sets in one another"
    ]


def test_types_and_components_inside_others_are_brought_into_it_too() -> None:
    text = """\
groups: {g: {components: {shell: {components: {leaf: {parameters: {a: {b: 1}}}}}}}}
component_types: {arm: {parameters: {gain: 2}, components: {motor: {parameters: {c: {d: 3}, c.d: 4}}}}}
"""
    document, _ = parse_yaml("f", text)
    assert document is not None
    assert [f"{d.span.line} {d.element}: {d.message}" for d in expand_parameters(document.root)] == [
        "2 arm.motor: the parameter `c.d` is written twice"
    ]
    assert node_to_data(document.root) == {
        "groups": {"g": {"components": {"shell": {"components": {"leaf": {"parameters": {"a.b": {"value": 1}}}}}}}},
        "component_types": {
            "arm": {
                "parameters": {"gain": {"value": 2}},
                "components": {"motor": {"parameters": {"c.d": {"value": 3}}}},
            }
        },
    }
