"""Cards of the functional level: groups, components with their ports, and component types."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.model.component import Component, ComponentType, Group, Input, Output
from archgen.model.port_media import uses_ros, word_of_medium
from archgen.views import timing_words
from archgen.views.elements import promise_words
from archgen.views.elements.card_parts import (
    ElementCard,
    drop_empty_lists,
    format_fact,
    known_facts,
    list_finding_lines,
)
from archgen.views.elements.parameter_blocks import list_operation_lines, list_parameter_lines
from archgen.views.lookup import Lookup
from archgen.views.timing.element_timing import make_whole_fact


def make_group_card(_lookup: Lookup, group: Group) -> ElementCard:
    """Make the card of a group."""
    facts = [
        ("owner", ", ".join(group.owners) or "?"),
        ("tags", ", ".join(group.tags)),
        ("description", group.description or ""),
    ]
    component_lines = tuple(f"{c.name}: {c.title}" for c in group.components.values())
    return ElementCard("group", group.id, group.title, group.at, known_facts(facts), (("components", component_lines),))


def make_component_card(lookup: Lookup, component: Component) -> ElementCard:
    """Make the card of a component that holds no others."""
    facts = [
        ("group", component.group),
        *_list_origin_facts(component),
        ("owner", ", ".join(component.owners) or "?"),
        ("role", component.role or "?"),
        ("functionality", " ".join((component.functionality or "?").split())),
        ("requirements", "; ".join(use.text for use in component.requirements)),
        ("timing", timing_words.format_short_timing(component.timing)),
        ("tags", ", ".join(component.tags)),
    ]
    architecture = lookup.architecture
    inputs = tuple(
        f"{port.name} <- {'; '.join(_describe_sources(lookup, port)) or '?'}" for port in component.inputs.values()
    )
    outputs = tuple(
        f"{port.name} ({port.type or '?'}){_mark_deprecated(port)} -> {', '.join(_list_readers(lookup, port)) or 'nobody'}"
        for port in component.outputs.values()
    )
    nodes = tuple(
        f"{node.id} ({architecture.nodes[node.id].at if node.written else 'still to be decided'})"
        for node in lookup.nodes_of.get(component.id, ())
    )
    lists = (
        ("inputs", inputs),
        ("outputs", outputs),
        *drop_empty_lists(
            ("parameters", tuple(list_parameter_lines(component))),
            ("operations", tuple(list_operation_lines(component))),
        ),
        ("nodes", nodes),
        ("findings", tuple(list_finding_lines(lookup, component.id))),
    )
    return ElementCard("component", component.id, component.title, component.at, known_facts(facts), lists)


def _list_origin_facts(component: Component) -> list[tuple[str, str]]:
    """Return what a component stands in, and what it is made from."""
    type_text = component.component_type or ""
    return [("parent", component.parent or ""), ("is", f"exactly {type_text}" if component.is_reference else type_text)]


def make_composed_card(lookup: Lookup, shell: Component) -> ElementCard:
    """Make the card of a component that holds components: its ports, with what stands behind them, and what is inside."""
    architecture = lookup.architecture
    facts = [
        ("group", shell.group),
        *_list_origin_facts(shell),
        ("owner", ", ".join(shell.owners) or "?"),
        ("functionality", " ".join((shell.functionality or "?").split())),
        ("requirements", "; ".join(use.text for use in shell.requirements)),
        ("timing", timing_words.format_timing_sentence(shell.timing)),
        ("worst way", "".join(run.text for run in make_whole_fact(lookup, shell.id))),
        ("tags", ", ".join(shell.tags)),
    ]
    inputs = tuple(
        f"{port.name} <- {'; '.join(_describe_sources(lookup, port)) or '?'}"
        f" => {', '.join(architecture.shell_ports[f'input {port.id}']) or 'nobody inside'}"
        for port in shell.inputs.values()
    )
    outputs = tuple(
        f"{port.name} ({port.type or '?'}){_mark_deprecated(port)} <= {', '.join(architecture.shell_ports[f'output {port.id}']) or '?'}"
        f"{' (autoconnect)' if port.is_made else ''}"
        for port in shell.outputs.values()
    )
    lists = (
        ("inputs", inputs),
        ("outputs", outputs),
        ("components", shell.children),
        *drop_empty_lists(
            ("parameters", tuple(list_parameter_lines(shell))), ("operations", tuple(list_operation_lines(shell)))
        ),
        ("findings", tuple(list_finding_lines(lookup, shell.id))),
    )
    return ElementCard("composed", shell.id, shell.title, shell.at, known_facts(facts), lists)


def make_component_type_card(lookup: Lookup, component_type: ComponentType) -> ElementCard:
    """Make the card of a component type."""
    architecture = lookup.architecture
    facts = [
        ("is", component_type.base or ""),
        ("generic", ", ".join(component_type.generic)),
        ("abstract", "yes" if component_type.is_abstract else ""),
        ("owner", component_type.owner or ""),
        *promise_words.list_card_facts(component_type),
        ("functionality", " ".join((component_type.functionality or "").split())),
    ]
    instances = tuple(
        each.id
        for each in (*architecture.shells.values(), *architecture.components.values())
        if each.type_name == component_type.id
    )
    lists = (
        ("inputs", tuple(f"{name} ({kind or '?'})" for name, kind in component_type.inputs.items())),
        ("outputs", tuple(f"{name} ({kind or '?'})" for name, kind in component_type.outputs.items())),
        ("components", component_type.components),
        *drop_empty_lists(
            ("parameters", tuple(list_parameter_lines(component_type))),
            ("operations", tuple(list_operation_lines(component_type))),
            ("frames", tuple(f"{frame.id} in {frame.parent or 'nothing'}" for frame in component_type.frames)),
        ),
        ("instances", tuple(dict.fromkeys(instances))),
        ("findings", tuple(list_finding_lines(lookup, component_type.id))),
    )
    return ElementCard(
        "component type", component_type.id, component_type.title, component_type.at, known_facts(facts), lists
    )


def _describe_sources(lookup: Lookup, port: Input) -> Iterator[str]:
    """Describe where an input gets its data: connections with their types, then what is outside."""
    for connection in port.connections:
        wildcard = "" if connection.kind == "output" else ".*"
        types = dict.fromkeys(lookup.architecture.outputs[output].type or "?" for output in connection.outputs)
        yield f"{connection.target}{wildcard} ({', '.join(types)})"
    if port.external:
        yield f"outside: {port.external}"


def _list_readers(lookup: Lookup, port: Output) -> list[str]:
    """Return who reads an output."""
    readers = [
        connection.input
        for leaf in lookup.architecture.leaf_ports_of("output", port.id)
        for connection in lookup.readers_of.get(leaf, ())
    ]
    return readers + ([f"outside: {port.external}"] if port.external else [])


def _mark_deprecated(port: Output) -> str:
    return " (deprecated)" if port.deprecated else ""


def make_port_card(lookup: Lookup, port: Input | Output) -> ElementCard:
    """Make the card of an input or an output."""
    facts = [
        ("component", port.component),
        ("type", port.type or ("?" if isinstance(port, Output) else "")),
        ("frame", lookup.architecture.frame_of(port) or ""),
        ("medium", word_of_medium(port)),
        ("description", port.description or ""),
    ]
    if isinstance(port, Output):
        facts.append(("message", lookup.architecture.message_of(port) or ("?" if uses_ros(port) else "")))
        facts += promise_words.list_card_facts(port)
        readers = ("readers", tuple(_list_readers(lookup, port)))
        return ElementCard("output", port.id, port.name, port.at, known_facts(facts), (readers,))
    facts.append(("freshness", format_fact(port.freshness)))
    return ElementCard(
        "input",
        port.id,
        port.name,
        port.at,
        known_facts(facts),
        (("sources", tuple(_describe_sources(lookup, port))),),
    )
