"""Declare ROS nodes: what was written about them, with the components and ports that they name.

Declare the callback groups of a node: which of its components exclude one another.
"""

from __future__ import annotations

import operator
from collections.abc import Iterator, Mapping

from archgen.diagnostics import NO_SPAN, Diagnostic, Label, Span
from archgen.frozen import dataclass, replace
from archgen.link import mapping_values, sanity_checks
from archgen.link.declare.component_nodes import ImplementingNodes
from archgen.link.declare.start_declaration import declare_start, read_command
from archgen.link.declare.timing_declaration import TimingMerger, declare_timing
from archgen.link.element_outline import ElementOutline
from archgen.link.link_memory import LinkedNode, LinkMemory
from archgen.link.parameter_texts import flatten_parameters
from archgen.link.path_guesses import take_path_end
from archgen.link.port_resolution import PortResolver
from archgen.link.reference_resolution import ReferenceResolver, diagnose_unknown_reference
from archgen.link.value_readers import read_element, read_values
from archgen.model.component import Component
from archgen.model.deployment import Container
from archgen.model.node import Node, PortUse, Qos, UseKind, qos_profile
from archgen.model.parameter import ParameterValue
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode

USE_KINDS: tuple[UseKind, ...] = ("publishes", "subscribes", "serves", "calls")
# What a node publishes or serves is an output of its component, what it subscribes to or calls is an input.
_PORT_KINDS: Mapping[UseKind, str] = {
    "publishes": "output",
    "serves": "output",
    "subscribes": "input",
    "calls": "input",
}


@dataclass(frozen=True, slots=True)
class NodeContext:
    """What the declaration of a node needs: the elements that it may name, and where findings go."""

    outline: ElementOutline
    resolver: ReferenceResolver
    components: Mapping[str, Component]
    containers: Mapping[str, Container]
    timing_merger: TimingMerger
    memory: LinkMemory | None = None
    """Nodes that are known from another version of the project."""


def resolve_implements(root: MappingNode, resolver: ReferenceResolver) -> dict[str, tuple[str, ...]]:
    """Resolve what each node implements: component ids by node, without those that cannot be resolved."""
    implements: dict[str, tuple[str, ...]] = {}
    for name, _, body in mapping_values.iterate_elements(root, "nodes"):
        targets = [
            resolver.resolve_reference(w, ("component",), name) for w in mapping_values.get_scalars(body, "implements")
        ]
        implements[name] = tuple(dict.fromkeys(target.id for target in targets if target))
    return implements


def declare_nodes(root: MappingNode, context: NodeContext, implemented: ImplementingNodes) -> dict[str, Node]:
    """Declare every node that is written, by id. Nodes that archgen derives are added later, by `derivation`."""
    return {
        name: _declare_node(name, entry, context, implemented)
        if context.memory is None
        else _recall_node(name, entry, context, implemented, context.memory)
        for name, entry, _ in mapping_values.iterate_elements(root, "nodes")
    }


def _recall_node(
    node_id: str, entry: MappingEntry, context: NodeContext, implemented: ImplementingNodes, memory: LinkMemory
) -> Node:
    """Return a node, one that is known from another version of the project without declaring it anew."""
    components = tuple(context.components[each] for each in implemented.implements[node_id])
    shared_flags = tuple(each.id in context.timing_merger.shared_components for each in components)
    resolver, containers = context.resolver, context.containers
    for known in memory.nodes.list_known(node_id):
        if (
            known.entry is entry
            and len(known.components) == len(components)
            and all(map(operator.is_, known.components, components))
            and known.shared_flags == shared_flags
            and (known.names is resolver.all_names or resolver.gives_answers(known.answers, known.names))
            and (not known.node.container or containers[known.node.container].host == known.container_host)
            and resolver.tell_again(known.references)
        ):
            return known.node
    with resolver.listen() as heard:
        node = _declare_node(node_id, entry, context, implemented)
    if heard.is_flawless:
        host = containers[node.container].host if node.container else None
        answers = tuple(heard.answers)
        linked = LinkedNode(entry, components, shared_flags, host, resolver.all_names, answers, node, heard.references)
        memory.nodes.keep_part(node_id, linked)
    return node


def _declare_node(node_id: str, entry: MappingEntry, context: NodeContext, implemented: ImplementingNodes) -> Node:
    implements, wholes = implemented.implements[node_id], implemented.wholes.get(node_id, ())
    body, resolver = mapping_values.get_body(entry), context.resolver
    container = resolver.resolve_plain_id(mapping_values.get_scalar(body, "container"), "container", node_id)
    host = resolver.resolve_plain_id(mapping_values.get_scalar(body, "host"), "host", node_id)
    if host and container and context.containers[container].host not in {None, host}:
        resolver.diagnostics.append(_diagnose_other_host(body, node_id, context.containers[container]))
    # Several components may have several owners: the node then belongs to all of them, in the order of `implements`.
    inherited_owners = (owner for component in implements for owner in context.components[component].owners)
    owners = resolver.resolve_owners(body, node_id, inherited_owners)
    # A composed component in one process is named by its own ports, whatever those inside are called.
    port_holders = (
        *wholes,
        *(each for each in implements if not any(each.startswith(f"{whole}.") for whole in wholes)),
    )
    ports = _make_port_resolver(node_id, body, context, tuple(dict.fromkeys(port_holders)))
    resolver.diagnostics.extend(_find_shared_own_names(node_id, body))
    status = "planned" if node_id in implemented.planned_ids else None
    values = {"name": node_id, "status": status, **read_element("node", Node, entry, body)}
    return Node(
        **values,
        implements=implements,
        wholes=wholes,
        owner=next(iter(owners), None),
        co_owners=owners[1:],
        command=read_command(body, resolver, node_id),
        container=container,
        host=host or (context.containers[container].host if container else None),
        callback_groups=declare_callback_groups(body, resolver, node_id, implements),
        uses=tuple(_declare_uses(body, ports, implemented)),
        timing=context.timing_merger.merge_timing(
            node_id, declare_timing(entry, ports, resolver.diagnostics), implements
        ),
        start=declare_start(body, resolver, node_id),
        own_values=tuple(_list_own_values(body)),
        written=node_id not in implemented.planned_ids,
        implements_written=body.get("implements") is not None,
        remap_places={each.key: each.key_span for each in mapping_values.get_mapping(body, "remaps")},
        argument_places=tuple(each.span for each in mapping_values.get_scalars(body, "arguments")),
        executor_places={key: mapping_values.get_span(body, key) for key in EXECUTOR_KEYS if key in body.entries},
    )


def _diagnose_other_host(body: MappingNode, node_id: str, container: Container) -> Diagnostic:
    return Diagnostic(
        "conflicting-values",
        f"`{node_id}` runs in the container `{container.id}`, which is on another host: `{container.host}`",
        mapping_values.get_span(body, "host"),
        labels=(Label(container.at, "the container"),),
        help="leave `host` out: a node in a container runs on the container's host",
        element=node_id,
    )


def _list_own_values(body: MappingNode) -> Iterator[ParameterValue]:
    for entry in mapping_values.get_mapping(body, "parameter_commands"):
        yield ParameterValue(entry.key, None, entry.key_span, entry.key_span)
    yield from flatten_parameters(mapping_values.get_mapping(body, "parameters"))


def _make_port_resolver(
    node_id: str, body: MappingNode, context: NodeContext, implements: tuple[str, ...]
) -> PortResolver:
    # Not `not implements`: a node whose `implements` could not be resolved has no ports, one without it has free ones.
    is_free = body.get("implements") is None
    return PortResolver(context.resolver, node_id, implements, context.outline.port_names, is_free=is_free)


def _find_shared_own_names(node_id: str, body: MappingNode) -> Iterator[Diagnostic]:
    """Yield a finding for each port with several topics and one own name: remapping gives one name another one."""
    for section in (body, mapping_values.get_mapping(body, "internal")):
        for use in USE_KINDS:
            for key, _, use_body in mapping_values.iterate_elements(section, use):
                names = mapping_values.get_scalars(use_body, "topic")
                if len(names) > 1 and mapping_values.get_text(use_body, "own_name"):
                    yield Diagnostic(
                        "conflicting-values",
                        f"`{key}` of `{node_id}` has {len(names)} topics, but one name in the program",
                        mapping_values.get_span(use_body, "own_name"),
                        help="leave `own_name` out, and write what becomes of each name of the program in `remaps`",
                        element=node_id,
                    )


def _declare_uses(body: MappingNode, ports: PortResolver, implemented: ImplementingNodes) -> Iterator[PortUse]:
    for use in USE_KINDS:
        for key, entry, use_body in mapping_values.iterate_elements(body, use):
            port = ports.resolve_port(key, entry.key_span, _PORT_KINDS[use]) if ports.component_ids else None
            for leaf_port in implemented.leaf_ports(_PORT_KINDS[use], port) if port else (None,):
                yield _declare_use(use, leaf_port, entry, use_body)
    internal_body = mapping_values.get_mapping(body, "internal")
    for use in USE_KINDS:
        for _, entry, use_body in mapping_values.iterate_elements(internal_body, use):
            yield _declare_use(use, None, entry, use_body, is_internal=True)


def _declare_use(
    use: UseKind, port: str | None, entry: MappingEntry, use_body: MappingNode, *, is_internal: bool = False
) -> PortUse:
    names = mapping_values.get_scalars(use_body, "topic" if use in {"publishes", "subscribes"} else "name")
    return PortUse(
        use=use,
        key=entry.key,
        port=port,
        topics=tuple(scalar.text for scalar in names),
        own_name=mapping_values.get_text(use_body, "own_name"),
        named_by=mapping_values.get_text(use_body, "named_by"),
        when=mapping_values.get_data(use_body, "when"),
        message=mapping_values.get_message(use_body, "message"),
        qos=_read_qos(use, use_body),
        internal=is_internal,
        at=entry.key_span,
        message_at=mapping_values.get_span(use_body, "message"),
        topic_places=tuple(scalar.span for scalar in names),
    )


def _read_qos(use: UseKind, use_body: MappingNode) -> Qos | None:
    """Return the values of the profile with the written ones over them; None where no `qos` is written."""
    qos_body = mapping_values.get_mapping(use_body, "qos")
    if not qos_body.entries:
        return None
    values = read_values("qos", Qos, qos_body)
    base = qos_profile(mapping_values.get_text(qos_body, "profile") or "default", use)
    return replace(base, **values, written=True, at=mapping_values.get_span(use_body, "qos"))


EXECUTOR_KEYS = ("threads", "scheduling", "callback_groups", "reentrant")
"""The keys of a node that say how its callbacks are run."""


def declare_callback_groups(
    body: MappingNode, resolver: ReferenceResolver, node_id: str, implements: tuple[str, ...]
) -> dict[str, tuple[str, ...]]:
    """Return the components of each callback group, by the group's id.

    What the node does not implement is left out and reported, and so is a component that is named again.
    """
    groups: dict[str, tuple[str, ...]] = {}
    first_spans: dict[str, Span] = {}
    groups_body = mapping_values.get_mapping(body, "callback_groups")
    written_names = {scalar.text for scalar in mapping_values.get_scalars(body, "implements")}
    is_complete = 0 < len(written_names) <= len(implements)
    for entry in groups_body:
        sanity_checks.report_empty_list(groups_body, entry.key, "component", node_id, resolver.diagnostics)
        members: list[str] = []
        for scalar in mapping_values.get_scalars(groups_body, entry.key):
            component = _resolve_component(scalar, resolver, node_id, implements, is_complete=is_complete)
            if component in first_spans:
                resolver.diagnostics.append(_diagnose_second_group(scalar, first_spans[component], node_id))
            elif component is not None:
                first_spans[component] = scalar.span
                members.append(component)
        if members:
            groups[entry.key] = tuple(members)
    return groups


def _resolve_component(
    reference: ScalarNode,
    resolver: ReferenceResolver,
    node_id: str,
    implements: tuple[str, ...],
    *,
    is_complete: bool,
) -> str | None:
    """Return the component of the node that a reference means: its id, or the end of it.

    Where not all that the node implements is known (`is_complete`), it may be what is not.
    """
    matching = [name for name in implements if name == reference.text or name.endswith(f".{reference.text}")]
    if len(matching) == 1:
        return matching[0]
    if matching:
        resolver.report(
            "ambiguous-reference",
            f"`{reference.text}` can mean {' or '.join(f'`{name}`' for name in matching)}",
            reference.span,
            help_line=f"write `{matching[0]}`, for instance",
            element=node_id,
        )
    elif is_complete and not resolver.is_lost(reference.text):
        length = reference.text.count(".") + 1
        guess = resolver.guesser.guess_name(reference.text, [take_path_end(name, length) for name in implements])
        diagnostic = diagnose_unknown_reference(
            reference, f"component of `{node_id}`", guess, NO_SPAN, node_id, known_names=implements
        )
        resolver.diagnostics.append(diagnostic)
    return None


def _diagnose_second_group(reference: ScalarNode, first_span: Span, node_id: str) -> Diagnostic:
    return Diagnostic(
        "conflicting-values",
        f"`{reference.text}` is in two places of `callback_groups`",
        reference.span,
        labels=(Label(first_span, "named here"),),
        help="a component is in one group: keep one of them",
        element=node_id,
    )
