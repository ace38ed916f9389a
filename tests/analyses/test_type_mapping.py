"""The type mapper's upkeep: types without a message, and types that nothing has."""

from __future__ import annotations

from dataclasses import replace

from archgen.analyses.type_mapping import RULES, unmapped_type, unused_type
from archgen.diagnostics.diagnostic import Diagnostic, Rule, Severity
from archgen.diagnostics.source_span import Span
from archgen.findings.rule_pages import read_rule_page
from archgen.model.architecture import Architecture, ProjectInfo
from archgen.model.component import Input, Output
from archgen.model.known_interfaces import Interfaces
from archgen.model.message_types import ConceptualType


def line(number: int, column: int = 1) -> Span:
    return Span("a.yaml", number, column, number, column + 5)


def architecture(
    *types: ConceptualType,
    outputs: tuple[Output, ...] = (),
    inputs: tuple[Input, ...] = (),
    mapper: tuple[str, ...] = (),
) -> Architecture:
    return Architecture(
        ProjectInfo("demo", "Demo"),
        types={type_.name: type_ for type_ in types},
        outputs={port.id: port for port in outputs},
        inputs={port.id: port for port in inputs},
        interfaces=Interfaces("jazzy", mapper_names=mapper),
    )


def mapped(name: str, message: str | None, number: int, **changes: str) -> ConceptualType:
    return replace(ConceptualType(name, message, at=line(number), message_at=line(number, 20)), **changes)  # type: ignore[arg-type]


def output(name: str, type_: str, number: int, *, physical: bool = False) -> Output:
    return Output(
        f"g.c.{name}",
        name,
        "g.c",
        type_,
        medium="physical" if physical else "ros",
        at=line(number),
        type_at=line(number, 9),
    )


def wanting(name: str, type_: str, number: int) -> Input:
    return Input(f"g.d.{name}", name, "g.d", type=type_, at=line(number), type_at=line(number, 9))


def brief(diagnostic: Diagnostic) -> str:
    help_ = f" ({diagnostic.help})" if diagnostic.help else ""
    return f"{diagnostic.span} {diagnostic.element}: {diagnostic.message}{help_}"


def test_unmapped_type_once_with_all_its_uses() -> None:
    one = architecture(
        mapped("Persons", None, 9),
        mapped("Mapped", "sensor_msgs/msg/Image", 10),
        outputs=(output("a", "Persons", 1), output("b", "Mapped", 2), output("c", "Light", 3, physical=True)),
        inputs=(wanting("a", "Persons", 4), wanting("b", "Unheard", 5)),
    )
    found = list(unmapped_type(one))
    assert [brief(diagnostic) for diagnostic in found] == [
        (
            "a.yaml:1:9 Persons: no message is named for the type `Persons` "
            "(name it below `types:`, as in `Persons: {message: package/msg/Name}`)"
        ),
        (
            "a.yaml:5:9 Unheard: no message is named for the type `Unheard` "
            "(name it below `types:`, as in `Unheard: {message: package/msg/Name}`)"
        ),
    ]
    assert [(str(label.span), label.text) for label in found[0].labels] == [
        ("a.yaml:9:1", "declared here, without a message"),
        ("a.yaml:4:9", "also used here"),
    ]


def test_unmapped_type_may_be_a_slip() -> None:
    one = architecture(
        mapped("Grasp plan", "demo_msgs/msg/Plan", 1),
        outputs=(output("a", "Pont cloud", 2), output("b", "Grasp plans", 3)),
        mapper=("Laser scan", "Point cloud"),
    )
    assert [diagnostic.help for diagnostic in unmapped_type(one)] == [
        "did you mean `Point cloud`?",
        "did you mean `Grasp plan`?",
    ]


def test_unused_types() -> None:
    one = architecture(
        mapped("Used", "std_msgs/msg/Bool", 1),
        mapped("Light", None, 2),
        mapped("Grasping", "demo_msgs/action/Grasp", 3, request="Wish", response="Grasp", feedback="Progress"),
        mapped("Wish", "demo_msgs/msg/Wish", 4),
        mapped("Progress", "demo_msgs/msg/Progress", 5),
        mapped("Recogised objects", "demo_msgs/msg/Objects", 6),
        ConceptualType("Laser scan", "sensor_msgs/msg/LaserScan", origin="shipped"),
        outputs=(
            output("a", "Used", 11),
            output("b", "Light", 12, physical=True),
            output("c", "Grasping", 13),
            output("d", "Recognised objects", 14),
        ),
    )
    assert [brief(diagnostic) for diagnostic in unused_type(one)] == [
        "a.yaml:6:1 Recogised objects: nothing has the type `Recogised objects` (did you mean `Recognised objects`?)"
    ]


def test_rules_have_pages() -> None:
    rules = [Rule.from_function(*rule) for rule in RULES]
    assert {rule.name: rule.severity for rule in rules} == {
        "unmapped-type": Severity.WARNING,
        "borrowed-call": Severity.WARNING,
        "borrowed-message": Severity.NOTE,
        "unused-type": Severity.NOTE,
    }
    for rule in rules:
        assert all(read_rule_page(rule))
