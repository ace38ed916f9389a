"""Turn the merged project into the architecture: declare every element, resolve every reference.

Link component types by themselves, as if each had one instance that says nothing of its own.

What such an instance has is what the type says: a comparison holds the instances of a project against it.
"""

from __future__ import annotations

from collections.abc import Mapping

from archgen.compose import ExpandedProject, expand_project, list_type_entries
from archgen.compose.expanded_project import TypeExpression
from archgen.derivation.wire.wire_names import apply_launch_names
from archgen.diagnostics import NO_SPAN, Diagnostic, Span
from archgen.link import mapping_values
from archgen.link.declare import element_declaration, section_declaration
from archgen.link.declare.component_declaration import declare_component_types, declare_groups
from archgen.link.declare.component_nodes import declare_component_nodes
from archgen.link.declare.element_declaration import declare_elements, declare_sections
from archgen.link.declare.frame_declaration import declare_frames
from archgen.link.declare.handed_parameters import HandedParameters
from archgen.link.declare.node_declaration import NodeContext, declare_nodes, resolve_implements
from archgen.link.declare.section_declaration import declare_use_cases, declare_variants
from archgen.link.declare.timing_declaration import TimingMerger, find_shared_components
from archgen.link.declare.type_declaration import DeclaredTypes
from archgen.link.element_outline import ElementOutline, build_outline, diagnose_undeclared_inputs
from archgen.link.link_memory import LinkMemory
from archgen.link.parameter_texts import flatten_parameters
from archgen.link.reference_resolution import SECTIONS_OF_PLAIN_NAMES, HeardReferences, ReferenceResolver
from archgen.model.architecture import Architecture
from archgen.model.component import PATTERN_GROUP, TypePatterns
from archgen.model.deployment import Container
from archgen.model.known_interfaces import Interfaces
from archgen.syntax.yaml_tree import MappingEntry, MappingNode


def link_project(  # noqa: PLR0913 - all by name
    expansion: ExpandedProject,
    element_outline: ElementOutline,
    *,
    default_id: str,
    default_title: str,
    declared_types: DeclaredTypes,
    interfaces: Interfaces,
    lost_keys: frozenset[str] = frozenset(),
    damaged_elements: frozenset[str] = frozenset(),
    is_partial: bool = False,
    memory: LinkMemory | None = None,
    heard: HeardReferences | None = None,
) -> tuple[Architecture, tuple[Diagnostic, ...]]:
    """Return the architecture of a project's merged slices. What cannot be resolved is left out and reported.

    `default_id` and `default_title` are used where the project states none. `lost_keys` are the keys of what could not
    be read: what they may declare is not reported as unknown, and neither is what may stand in `damaged_elements`, in
    which something could not be read. `is_partial` is whether a whole file or section was lost. What
    `memory` knows from another version of the project is taken over where it is the same. What references mean is
    added to `heard`.
    """
    # Each step takes what the steps before it returned. Ids come first (the outline), then types, because which outputs
    # carry messages decides what a reference to a whole component brings; nodes inherit hosts, owners and timing from
    # containers and components. Every step appends to the same list of diagnostics.
    root = expansion.root
    diagnostics: list[Diagnostic] = [*expansion.diagnostics, *declared_types.diagnostics]
    diagnostics += (*element_outline.diagnostics, *diagnose_undeclared_inputs(element_outline))
    damaged_elements = damaged_elements | expansion.damaged_elements
    types = declared_types.types
    if lost_keys or damaged_elements or not expansion.is_plain:
        memory = None  # what could not be read, and what stands around a component, has a say in too many things
    resolver = make_resolver(root, element_outline, diagnostics, lost_keys, damaged_elements, memory)
    resolver.heard = heard
    parameters = HandedParameters(element_outline, diagnostics)
    declared_groups = declare_groups(element_outline, resolver, types, parameters, memory)
    components, shells = declared_groups.components, declared_groups.shells
    written_targets = resolve_implements(root, resolver)
    implemented = declare_component_nodes(
        element_outline, expansion, written_targets, declared_groups, parameters, resolver
    )
    implements = implemented.implements
    containers = declare_elements(implemented.root, "container", Container, resolver)
    timing_merger = TimingMerger(components, find_shared_components(implements.values()), diagnostics)
    nodes = declare_nodes(
        implemented.root,
        NodeContext(element_outline, resolver, components, containers, timing_merger, memory),
        implemented,
    )
    ros_section = mapping_values.get_mapping(root, "ros")
    distro = mapping_values.get_text(ros_section, "distro")
    nodes = {name: apply_launch_names(node, distro) if node.arguments else node for name, node in nodes.items()}
    declared_sections = declare_sections(root, resolver)
    use_cases = declare_use_cases(root, resolver)
    chains = section_declaration.declare_chains(root, resolver, implements, declared_groups.list_leaf_ports)
    shell_entries = {shell.id: shell.entry for shell in element_outline.shells.values()}
    frames = declare_frames(root, {**element_outline.components, **shell_entries}, resolver, parameters)
    component_types = declare_component_types(expansion, resolver)
    policies = section_declaration.declare_policies(root, resolver)
    views = section_declaration.declare_views(root, resolver)
    glossary = element_declaration.declare_glossary(root, diagnostics)
    suspected_ids = resolver.finish_resolving()
    architecture = Architecture(  # of values only: nothing below resolves a reference
        project=section_declaration.declare_project(root, default_id, default_title),
        distro=distro,
        distro_at=mapping_values.get_span(ros_section, "distro"),
        shared_topics=mapping_values.get_texts(ros_section, "shared_topics"),
        ros_parameters=tuple(flatten_parameters(mapping_values.get_mapping(ros_section, "parameters"))),
        ros_environment=tuple(mapping_values.list_placed_texts(ros_section, "environment")),
        ros_discovery=mapping_values.get_text(ros_section, "discovery"),
        layout=mapping_values.get_layout(root, "layout"),
        **declared_sections,
        use_cases=use_cases,
        groups=declared_groups.groups,
        components=components,
        shells=shells,
        shell_ports=declared_groups.shell_ports,
        component_types=component_types,
        inputs={port.id: port for component in components.values() for port in component.inputs.values()},
        outputs={output.id: output for component in components.values() for output in component.outputs.values()},
        connections=declared_groups.connections,
        edges=declared_groups.edges,
        types=types,
        nodes=nodes,
        containers=containers,
        frames=frames,
        chains=chains,
        views=views,
        policies=policies,
        agreements=section_declaration.declare_agreements(root, resolver),
        variants=declare_variants(root),
        glossary=glossary,
        review=section_declaration.declare_review(root),
        conform=section_declaration.declare_conform(root),
        generate=section_declaration.declare_generate(root),
        repository=section_declaration.declare_repository(root),
        interfaces=interfaces,
        partial=is_partial,
        unread_keys=lost_keys,
        suspected_ids=suspected_ids,
        untyped_components=expansion.damaged_elements,
    )
    return architecture, tuple(diagnostics)


def make_resolver(  # noqa: PLR0913, PLR0917 - what a resolver knows
    root: MappingNode,
    element_outline: ElementOutline,
    diagnostics: list[Diagnostic],
    lost_keys: frozenset[str] = frozenset(),
    damaged_elements: frozenset[str] = frozenset(),
    memory: LinkMemory | None = None,
) -> ReferenceResolver:
    """Return what resolves the references of a merged project in which all types are written out."""
    spans: dict[str, dict[str, Span]] = {
        "group": {name: entry.key_span for name, entry in element_outline.groups.items()},
        "component": {
            **{name: entry.key_span for name, entry in element_outline.components.items()},
            **{name: shell.entry.key_span for name, shell in element_outline.shells.items()},
        },
        "output": {output.id: output.at for output in element_outline.list_outputs()},
        "input": {
            f"{c}.{name}": e.key_span for c, inputs in element_outline.inputs.items() for name, e in inputs.items()
        },
        "node": {entry.key: entry.key_span for entry in mapping_values.get_mapping(root, "nodes")},
    }
    plain_spans = {
        kind: {entry.key: entry.key_span for entry in mapping_values.get_mapping(root, section)}
        for kind, section in SECTIONS_OF_PLAIN_NAMES.items()
    }
    make_index = memory.index_paths if memory else None
    all_names = memory.recall_names(spans, plain_spans) if memory else None
    return ReferenceResolver(
        spans, plain_spans, diagnostics, lost_keys, damaged_elements, make_index=make_index, all_names=all_names
    )


_OUTER_SECTIONS = ("component_types", "libraries", "types", "ros", "project")
"""What a type may refer to. Nodes, chains and the like are about instances."""


def link_type_patterns(
    merged_table: MappingNode, architecture: Architecture, heard: HeardReferences | None = None
) -> TypePatterns:
    """Return what the component types of a project say, nothing for a project without any.

    What is wrong in them was reported where the project was linked. What their references mean is added to `heard`.
    """
    if not architecture.component_types:
        return TypePatterns()
    from archgen.compose.type_table import TypeTable

    outer_entries = {name: entry for name, entry in merged_table.entries.items() if name in _OUTER_SECTIONS}
    table = TypeTable(list_type_entries(merged_table), [])
    type_bodies = {
        name: table.get_body(TypeExpression(name, component_type.generic)) or MappingNode({}, component_type.at)
        for name, component_type in architecture.component_types.items()
    }
    expansion = expand_project(_write_patterns(outer_entries, type_bodies))
    patterns = _link_expansion(expansion, architecture, heard)
    components = {**patterns.components, **patterns.shells}
    return TypePatterns(
        {component_id.removeprefix(f"{PATTERN_GROUP}."): component for component_id, component in components.items()},
        {node.implements[0]: node for node in patterns.nodes.values() if len(node.implements) == 1},
    )


def _write_patterns(outer_entries: Mapping[str, MappingEntry], type_bodies: Mapping[str, MappingNode]) -> MappingNode:
    """Return a project of one group, which has a component for each type."""
    components = {name: MappingEntry(name, body.span, body) for name, body in type_bodies.items()}
    groups = _nest_mapping(_nest_mapping(MappingNode(components, NO_SPAN), "components"), PATTERN_GROUP)
    return MappingNode({**outer_entries, **_nest_mapping(groups, "groups").entries}, NO_SPAN)


def _nest_mapping(value: MappingNode, key: str) -> MappingNode:
    return MappingNode({key: MappingEntry(key, NO_SPAN, value)}, NO_SPAN)


def _link_expansion(
    expansion: ExpandedProject, architecture: Architecture, heard: HeardReferences | None
) -> Architecture:
    patterns, _ = link_project(
        expansion,
        build_outline(expansion),
        default_id=architecture.project.id,
        default_title=architecture.project.title,
        declared_types=DeclaredTypes(architecture.types),
        interfaces=architecture.interfaces,
        heard=heard,
    )
    return patterns
