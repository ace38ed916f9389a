"""Properties and terms as they are declared, and what elements say of themselves."""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal

import pytest

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.link.declare.element_declaration import fold_term
from archgen.model.architecture import Architecture

Linked = Callable[[str], tuple[Architecture, tuple[Diagnostic, ...]]]


def test_a_declaration_says_what_has_it_and_which_values_it_takes(linked: Linked) -> None:
    architecture, found = linked("""
properties:
  trl: {of: component, type: integer, range: [1, 9], required: true, description: D}
  mass: {unit: kg, range: [0, .inf]}
  vendor: Who makes it
  level: {choices: [low, 1.10]}
""")
    assert found == ()
    trl, mass, vendor, level = architecture.properties.values()
    assert (trl.title, trl.of, trl.type, trl.range, trl.required) == ("Trl", ("component",), "integer", (1, 9), True)
    assert (mass.unit, mass.range) == ("kg", (0, Decimal("Infinity")))
    assert (vendor.title, level.choices) == ("Who makes it", ("low", "1.10"))


def test_what_contradicts_itself_is_left_out(told: Callable[[str], list[str]]) -> None:
    found = told("properties: {a: {range: [9, 1]}, c: {required: true}, d: {range: [-.inf, .inf]}}")
    help_line = "write `range: [1, 9]`; what they are measured in is `unit`"
    assert found == [
        f"1:25 wrong-value: the range of the property `a` is not its smallest and its greatest number | {help_line}",
        "1:48 wrong-value: the property `c` is required of every kind of element | say of which ones: `of: [component]`",
    ]


def test_terms_that_texts_cannot_tell_apart_are_one(linked: Linked) -> None:
    architecture, found = linked(
        "glossary: {Arm: a limb, arm: a company, IT: machines, it: a pronoun, two  words: x, empty: }"
    )
    assert {each.term: each.text for each in architecture.glossary.values()} == {
        "Arm": "a limb",
        "IT": "machines",
        "it": "a pronoun",
        "two words": "x",
    }
    assert [each.message for each in found] == [
        "the term `arm` is in the glossary twice: a first capital does not count"
    ]


@pytest.mark.parametrize(
    ("term", "folded"), [("Arm", "arm"), ("MCI", "MCI"), ("E\u0301tude", "étude"), ("A  b", "a b")]
)
def test_a_first_capital_counts_only_where_there_are_others(term: str, folded: str) -> None:
    assert fold_term(term) == folded


def test_values_are_texts_as_written_and_hints_are_data(linked: Linked) -> None:
    architecture, found = linked("""
groups:
  g:
    components:
      a: {title: A, properties: {version: 1.10, done: true, due: 2027-03-01, empty: }, hints: {orca: {x: 1.10, y: [1, true]}}}
      b: {title: B, inputs: {hints: {external: x, hints: {p: {from: a}}}, properties: {external: y}}}
""")
    assert found == ()
    annotations = architecture.components["g.a"].annotations
    assert annotations.properties == {"version": "1.10", "done": "true", "due": "2027-03-01"}
    assert annotations.hints == {"orca": {"x": 1.1, "y": [1, True]}}
    assert annotations.property_places["version"].column == 43
    assert annotations.hint_places["orca",].line == 5
    ports = architecture.components["g.b"].inputs
    assert (ports["hints"].annotations.hints, ports["properties"].external) == ({"p": {"from": "a"}}, "y")


def test_an_instance_lays_its_own_over_its_types_leaf_by_leaf(linked: Linked) -> None:
    architecture, found = linked("""
component_types:
  base: {status: existing, contact: a@b.eu, image: a.png, properties: {trl: 1, sil: 2}, hints: {x: {rate: 1, node: {name: n, a: 1}}, type: {type: G}}}
  box: {is: base, generic: [G], inputs: {hints: {type: G, external: x}}, hints: {y: {type: G}}}
groups: {g: {components: {a: {is: box<T>, properties: {trl: 5}, hints: {x: {period: 2, node: {a: 2}}}, status: planned}}}}
""")
    assert found == ()
    component = architecture.components["g.a"]
    assert component.annotations.properties == {"trl": "5", "sil": "2"}
    assert component.annotations.hints == {
        "x": {"rate": 1, "node": {"name": "n", "a": 2}, "period": 2},
        "type": {"type": "G"},
        "y": {"type": "G"},
    }
    assert (component.status, component.contact, component.image) == ("planned", "a@b.eu", "a.png")
    assert component.inputs["hints"].type == "T"
    assert architecture.component_types["box"].annotations.properties == {"trl": "1", "sil": "2"}
