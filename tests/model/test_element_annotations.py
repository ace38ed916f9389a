"""Properties: which values are numbers, how they compare, and which ones a declaration refuses."""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal

import pytest

from archgen.diagnostics.source_span import NO_SPAN
from archgen.language.language_tables import ANNOTATED_KINDS
from archgen.model.architecture import Architecture, ProjectInfo, list_annotated_elements
from archgen.model.element_annotations import (
    PropertyDeclaration,
    describe_range,
    find_property_fault,
    order_values,
    read_figure,
)
from archgen.model.selector_keys import (
    find_component_properties,
    find_node_properties,
    matches_wildcard,
    parse_property_condition,
)
from tests.compare.test_element_kinds import SECTIONS
from tests.language_samples import SCHEMA

Derived = Callable[[str], Architecture]


@pytest.mark.parametrize(
    ("text", "figure"),
    [
        ("5", ("5", "")),
        ("-2.50 kg", ("-2.50", "kg")),
        ("12kg", ("12", "kg")),
        ("3 m/s^2", ("3", "m/s^2")),
        ("1.10", ("1.10", "")),
        ("123456789012345", ("123456789012345", "")),
        ("1234567890123456", None),
        ("1.2.3", None),
        ("12 kg or so", None),
        ("1e5", ("1", "e5")),
        ("2027-03-01", None),
        ("true", None),
        ("", None),
        ("٣", None),
    ],
)
def test_a_figure_is_a_number_with_any_unit(text: str, figure: tuple[str, str] | None) -> None:
    found = read_figure(text)
    assert (found and (str(found.value), found.unit)) == figure


@pytest.mark.parametrize(
    ("text", "other", "order"),
    [
        ("10", "9", 1),
        ("1.10", "1.1", 0),
        ("2 kg", "2.0 kg", 0),
        ("2 kg", "2000 g", None),
        ("2", "2 kg", None),
        ("2027-03-01", "2026-12-31", 1),
        ("2027-03-01", "5", None),
        ("low", "high", None),
        ("low", "low", 0),
    ],
)
def test_only_what_is_measured_alike_is_compared(text: str, other: str, order: int | None) -> None:
    assert order_values(text, other) == order


def declared(**keys: object) -> PropertyDeclaration:
    return PropertyDeclaration("p", "P", at=NO_SPAN, **keys)  # type: ignore[arg-type]


INFINITE = Decimal("Infinity")


@pytest.mark.parametrize(
    ("declaration", "text", "fault"),
    [
        (declared(), "anything", None),
        (declared(choices=("a", "b")), "c", "it is one of `a`, `b`"),
        (declared(type="string"), "12", None),
        (declared(type="boolean"), "yes", "it is `true` or `false`"),
        (declared(type="date"), "2027-02-30", None),  # a calendar is not kept
        (declared(type="date"), "27-02-01", "it is a day such as `2027-03-01`"),
        (declared(type="integer"), "5.0", None),
        (declared(type="integer"), "5.5", "it is a whole number"),
        (declared(type="integer", unit="EUR"), "5", "it is a whole number in EUR, such as `12 EUR`"),
        (declared(unit="kg"), "5 g", "it is a number in kg, such as `12 kg`"),
        (declared(unit="kg", range=(Decimal(0), Decimal(9))), "10 kg", "it is 0 to 9 kg"),
        (declared(range=(Decimal(0), INFINITE)), "-1", "it is at least 0"),
        (declared(range=(-INFINITE, Decimal(9)), unit="K"), "10 K", "it is at most 9 K"),
        (declared(range=(-INFINITE, INFINITE)), "much", "it is a number"),
    ],
)
def test_what_a_declaration_refuses(declaration: PropertyDeclaration, text: str, fault: str | None) -> None:
    assert find_property_fault(declaration, text) == fault


def test_a_range_in_words() -> None:
    assert describe_range(declared()) == ""
    assert describe_range(declared(range=(-INFINITE, INFINITE))) == "any number"


@pytest.mark.parametrize(
    ("condition", "names"),
    [
        ("sil", "a b"),
        ("sil>=2", "a"),
        ("sil > 2", ""),
        ("sil<2", "b"),
        ("sil=2.0", "a"),
        ("m*s<=5 kg", "a"),
        ("vendor=*me*", "b"),
        ("vendor>=Acme", "b"),  # the same
        ("vendor>Aaa", ""),
    ],
)
def test_conditions(condition: str, names: str) -> None:
    elements = {"a": {"sil": "2", "mass": "5 kg"}, "b": {"sil": "1", "vendor": "Acme"}}
    parsed = parse_property_condition(condition)
    assert parsed is not None
    assert " ".join(name for name, each in elements.items() if parsed.is_met(each, matches_wildcard)) == names


@pytest.mark.parametrize("text", ["", ">=2", "sil=>", "sil!=2", "sil>=", "Sil", "sil 2"])
def test_what_is_no_condition(text: str) -> None:
    assert parse_property_condition(text) is None


def test_the_nearest_holder_of_a_property_counts(derived: Derived) -> None:
    architecture: Architecture = derived("""
groups:
  g:
    properties: {sil: 1, trl: 1, site: lab}
    components:
      whole:
        properties: {sil: 2, trl: 2}
        components: {leaf: {title: L, properties: {sil: 3}}}
nodes: {n: {implements: leaf, host: pc, properties: {ram: 1 GB}}}
hosts: {pc: {properties: {ram: 8 GB, cpu: arm}}}
""")
    leaf = architecture.components["g.whole.leaf"]
    assert dict(find_component_properties(architecture, leaf)) == {"sil": "3", "trl": "2", "site": "lab"}
    assert dict(find_node_properties(architecture, architecture.nodes["n"])) == {"ram": "1 GB", "cpu": "arm"}


def test_all_kinds_may_have_properties_and_the_schema_offers_them_for_of() -> None:
    # A variant is no part of the robot, but another robot.
    assert set(ANNOTATED_KINDS) == set(SECTIONS) - {"variant"}
    assert set(SCHEMA["$defs"]["declared_of"]["items"]["enum"]) == set(ANNOTATED_KINDS)
    assert [kind for kind in ANNOTATED_KINDS if "properties" not in SCHEMA["$defs"][kind]["properties"]] == []


def test_what_nobody_wrote_has_none(derived: Derived) -> None:
    assert list(list_annotated_elements(Architecture(ProjectInfo("p", "P")))) == []
    architecture: Architecture = derived("""
types: {T: std_msgs/msg/Bool}
component_types: {t: {outputs: {o: T}}, base: {abstract: true}}
groups: {g: {components: {a: {is: t}, b: {inputs: {i: a.o}}, whole: {components: {c: C}}}}}
nodes: {n: a}
""")
    listed = {f"{each.kind} {each.id}": each.is_expected for each in list_annotated_elements(architecture)}
    assert listed == {
        "group g": True,
        "component_type t": True,
        "component_type base": False,
        "component g.whole": False,
        "component g.a": True,
        "output g.a.o": True,
        "component g.b": True,
        "input g.b.i": True,
        "component g.whole.c": True,
        "type T": True,
        "node n": True,
    }
