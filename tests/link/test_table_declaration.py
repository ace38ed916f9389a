"""Elements are declared by the language's tables: by what is written, where it is written, and with defaults for the rest."""

from __future__ import annotations

import pytest

from archgen.diagnostics.source_span import NO_SPAN
from archgen.link.declare.element_declaration import declare_element, declare_sections, read_link_ends
from archgen.link.reference_resolution import ReferenceResolver
from archgen.link.value_readers import read_values
from archgen.model.deployment import Container, Host, Link
from archgen.syntax.yaml_parser import parse_yaml
from archgen.syntax.yaml_tree import MappingNode

PLAIN_KINDS = ("partner", "host", "requirement", "use case", "chain", "container", "resource")


def read_root(text: str) -> MappingNode:
    """Return what a text says."""
    document, _ = parse_yaml("a.yaml", text)
    assert document is not None
    return document.root


@pytest.fixture
def resolver() -> ReferenceResolver:
    """Give a resolver of a project in which there is nothing."""
    return ReferenceResolver(
        {"component": {}, "output": {}, "input": {}, "node": {}, "group": {}}, {kind: {} for kind in PLAIN_KINDS}, []
    )


def test_only_what_is_written_is_read() -> None:
    body = read_root("{cores: 4, scheduling: {0: fifo}, description: , tags: [a, b], colour: red}")
    values = read_values("host", Host, body)
    assert values.keys() == {"cores", "scheduling", "core_scheduling", "core_places", "fair", "tags"}
    assert (values["cores"], values["core_scheduling"], values["tags"]) == (4, {0: "fifo"}, ("a", "b"))


@pytest.mark.parametrize("value", ["[4]", "{a: 4}", "four", "4.0", "null"])
def test_what_cannot_be_read_has_the_default(value: str, resolver: ReferenceResolver) -> None:
    entry = next(iter(read_root(f"pc: {{cores: {value}, description: {{a: b}}}}")))
    assert declare_element("host", Host, entry, resolver) == Host("pc", "Pc")


def test_places_are_kept_whatever_is_written_there(resolver: ReferenceResolver) -> None:
    entry = next(iter(read_root("box: {name: [a], host: pc}")))
    container = declare_element("container", Container, entry, resolver)
    assert (container.at.column, container.name, container.name_at.column) == (1, None, 13)
    assert [(each.message, each.element) for each in resolver.diagnostics] == [("no host named `pc`", "box")]


def test_a_field_of_its_own_is_given_beside_those_that_are_read(resolver: ReferenceResolver) -> None:
    entry = next(iter(read_root("lan: {title: LAN, bandwidth: 0 bit/s, latency: {best: 2 ms, worst: 1 ms}}")))
    link = declare_element("link", Link, entry, resolver, devices=("g.a",))
    assert (link.title, link.devices, link.bandwidth, link.best, str(link.worst)) == (
        "LAN",
        ("g.a",),
        None,
        None,
        "1 ms",
    )
    assert sorted(each.message for each in resolver.diagnostics) == [
        "`bandwidth` cannot be zero",
        "the best latency (2 ms) is above the worst (1 ms)",
    ]


def test_sections_are_declared_by_the_fields_of_the_architecture(resolver: ReferenceResolver) -> None:
    sections = declare_sections(read_root("{hosts: {pc: {cores: 2}}, partners: {p: {contact: c}}}"), resolver)
    assert {name: [*elements] for name, elements in sections.items() if elements} == {
        "partners": ["p"],
        "hosts": ["pc"],
    }
    assert (sections["hosts"]["pc"].cores, sections["partners"]["p"].contact) == (2, "c")


def test_an_end_of_a_link_is_a_host_before_it_is_a_component() -> None:
    spans = {"component": {"g.pc": NO_SPAN, "g.arm": NO_SPAN}, "output": {}, "input": {}, "node": {}, "group": {}}
    resolver = ReferenceResolver(spans, {"host": {"pc": NO_SPAN}}, [])
    body = read_root("{connects: [pc, arm, printer, pc]}")
    assert read_link_ends(body, "connects", "lan", resolver) == (("pc",), ("g.arm",), ("printer",))
    assert [each.message for each in resolver.diagnostics] == ["no host named `printer`"]
