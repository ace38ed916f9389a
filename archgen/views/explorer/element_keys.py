"""The keys of each component and node as selectors see them: `owner:certh`, `tag:safety`, `type:Image`.

`model.selector_keys` finds elements by a key's value; here are the same facts the other way round, for the page, which
evaluates selectors itself. Tests compare both on the same cases.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping

from archgen.model.architecture import Architecture
from archgen.model.component import Component, list_component_ports
from archgen.model.declared_timing import Timing
from archgen.model.deprecation_lookup import list_deprecated_kinds
from archgen.model.node import Node
from archgen.model.parameter_values import find_effective_parameters
from archgen.model.port_media import list_medium_words
from archgen.model.requirement import add_above
from archgen.model.selector_evaluation import SelectorEvaluator
from archgen.model.selector_keys import (
    SelectorHit,
    find_component_properties,
    find_component_status,
    find_node_properties,
    list_participants,
)
from archgen.views.lookup import Lookup

Key = tuple[str, str]
"""The name of a key and a value."""


def list_component_keys(lookup: Lookup) -> Mapping[str, tuple[Key, ...]]:
    """Return the keys of each component by its id, each once, in the order of the language's keys."""
    architecture = lookup.architecture
    types = _list_types(architecture)
    rules = _list_rules(lookup)
    variants = find_changed_by_variants(architecture)
    use_cases: dict[str, list[str]] = defaultdict(list)
    for use_case_id, participants in list_participants(architecture).items():
        for component_id in participants:
            use_cases[component_id].append(use_case_id)
    return {
        component.id: tuple(
            dict.fromkeys(
                (
                    *(("tag", tag) for tag in _list_tags(architecture, component)),
                    *(("owner", owner) for owner in component.owners),
                    *(("type", name) for name in types[component.id]),
                    *(("medium", word) for port in list_component_ports(component) for word in list_medium_words(port)),
                    *((("role", component.role),) if component.role else ()),
                    *((("status", status),) if (status := find_component_status(architecture, component)) else ()),
                    *(("requirement", name) for name in _list_requirements(architecture, component)),
                    *_list_behaviours((component.timing,)),
                    *(("finding", rule) for rule in rules[component.id]),
                    *(("is", name) for name in architecture.list_types_of(component)),
                    *(("library", name) for name in architecture.list_libraries_of(component)),
                    *(("parameter", name) for name in component.parameters),
                    *_list_properties(find_component_properties(architecture, component)),
                    *(("variant", name) for name, hit in variants.items() if component.id in hit.components),
                    *(("deprecated", kind) for kind in list_deprecated_kinds(architecture, component)),
                    *(("use_case", name) for name in use_cases.get(component.id, ())),
                )
            )
        )
        for component in architecture.components.values()
    }


def list_composed_keys(architecture: Architecture, shell: Component) -> tuple[Key, ...]:
    """Return the keys that a composed component has of its own. Selectors do not look at them: they select leaves."""
    return tuple(
        dict.fromkeys(
            (
                *(("tag", tag) for tag in shell.tags),
                *(("owner", owner) for owner in shell.owners),
                *((("role", shell.role),) if shell.role else ()),
                *((("status", shell.status),) if shell.status else ()),
                *(("requirement", name) for name in _list_requirements(architecture, shell)),
                *_list_properties(shell.annotations.properties),
            )
        )
    )


def list_node_keys(lookup: Lookup, node: Node, variants: Mapping[str, SelectorHit]) -> tuple[Key, ...]:
    """Return the keys of a node, each once, with the variants in which it is different."""
    host = lookup.architecture.hosts.get(node.host or "")
    rules = [finding.rule for finding in lookup.findings_of.get(node.id, ()) if finding.element == node.id]
    single_values = (("status", node.status), ("host", node.host), ("package", node.package))
    return tuple(
        dict.fromkeys(
            (
                *(("tag", tag) for tag in (*node.tags, *(host.tags if host else ()))),
                *(("owner", owner) for owner in node.owners),
                *((key, value) for key, value in single_values if value is not None),
                *_list_behaviours(node.timing.values()),
                *(("finding", rule) for rule in rules),
                *(("parameter", name) for name in find_effective_parameters(lookup.architecture, node)),
                *_list_properties(find_node_properties(lookup.architecture, node)),
                *(("variant", name) for name, hit in variants.items() if node.id in hit.nodes),
            )
        )
    )


def find_changed_by_variants(architecture: Architecture) -> Mapping[str, SelectorHit]:
    """Return what is different in each variant by its id."""
    evaluator = SelectorEvaluator(architecture)
    return {name: evaluator.find_by_variant(name) for name in architecture.variants}


def _list_properties(properties: Mapping[str, str]) -> Iterator[Key]:
    """Yield properties as one text each, `sil=2`: the page takes them apart."""
    return (("property", f"{name}={text}") for name, text in properties.items())


def _list_requirements(architecture: Architecture, component: Component) -> Iterator[str]:
    """Yield the requirements that a component serves, and what these are part of, each once."""
    served_ids = [use.text for use in component.requirements if use.is_id]
    yield from dict.fromkeys([*served_ids, *sorted(add_above(architecture.requirements, served_ids))])


def _list_behaviours(timings: Iterable[Timing | None]) -> Iterator[Key]:
    return (("behaviour", timing.behaviour) for timing in timings if timing and timing.behaviour)


def _list_tags(architecture: Architecture, component: Component) -> Iterator[str]:
    """Yield the tags of a component, of its group and of the requirements that it serves."""
    yield from component.tags
    yield from architecture.groups[component.group].tags
    for use in component.requirements:
        if use.is_id and (requirement := architecture.requirements.get(use.text)):
            yield from requirement.tags


def _list_types(architecture: Architecture) -> Mapping[str, Iterable[str]]:
    """Return the names and messages of the types that each component sends, expects or reads."""
    names: dict[str, dict[str, None]] = defaultdict(dict)

    def add_type(component_id: str, type_name: str | None) -> None:
        known_type = architecture.types.get(type_name or "")
        if known_type:
            names[component_id].update(dict.fromkeys(filter(None, (known_type.name, known_type.message))))

    for output in architecture.outputs.values():
        add_type(output.component, output.type)
    for port in architecture.inputs.values():
        add_type(port.component, port.type)
    for edge in architecture.edges:
        add_type(architecture.inputs[edge.input].component, architecture.outputs[edge.output].type)
    return names


def _list_rules(lookup: Lookup) -> Mapping[str, list[str]]:
    """Return the rules that found something about each component, or about the whole that it is part of."""
    rules: dict[str, list[str]] = defaultdict(list)
    for element_id, findings in lookup.findings_of.items():
        for component_id in _list_concerned(lookup.architecture, element_id):
            rules[component_id] += [finding.rule for finding in findings]
    return rules


def _list_concerned(architecture: Architecture, element_id: str) -> Iterable[str]:
    """Return the components that a finding about an element concerns."""
    if element_id in architecture.groups:
        return [component.id for component in architecture.groups[element_id].components.values()]
    # Of a composed one that is not designed to its end, what is missing is a component of the same id.
    return [element_id] if element_id in architecture.components else architecture.leaves_of(element_id)
