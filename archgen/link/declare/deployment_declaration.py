"""Declare where nodes run: hosts, containers, resources and links."""

from __future__ import annotations

from archgen.diagnostics.source_span import Span
from archgen.link import mapping_values, sanity_checks
from archgen.link.reference_resolution import ReferenceResolver
from archgen.model.declared_timing import SchedulingOrder
from archgen.model.deployment import Container, Host, Link, Resource
from archgen.model.path_resolver import ElementRef
from archgen.syntax.yaml_tree import MappingNode


def declare_hosts(root: MappingNode) -> dict[str, Host]:
    """Declare the hosts."""
    return {
        name: Host(
            id=name,
            title=mapping_values.get_title(body, name),
            cores=mapping_values.get_integer(body, "cores"),
            scheduling=mapping_values.get_order(body, "scheduling"),
            core_scheduling={core: order for core, (order, _) in _read_core_orders(body).items()},
            description=mapping_values.get_text(body, "description"),
            tags=mapping_values.get_texts(body, "tags"),
            annotations=mapping_values.get_annotations(body),
            at=entry.key_span,
            core_places={core: span for core, (_, span) in _read_core_orders(body).items()},
        )
        for name, entry, body in mapping_values.iterate_elements(root, "hosts")
    }


def _read_core_orders(body: MappingNode) -> dict[int, tuple[SchedulingOrder, Span]]:
    """Return the order on each core for which one is written, and where."""
    orders = mapping_values.get_mapping(body, "scheduling")
    # A key that is no number is reported by the schema.
    return {
        int(entry.key): (order, entry.key_span)
        for entry in orders
        if entry.key.isascii() and entry.key.isdigit() and (order := mapping_values.get_order(orders, entry.key))
    }


def declare_containers(root: MappingNode, resolver: ReferenceResolver) -> dict[str, Container]:
    """Declare the containers."""
    return {
        name: Container(
            id=name,
            title=mapping_values.get_title(body, name),
            host=resolver.resolve_plain_id(mapping_values.get_scalar(body, "host"), "host", name),
            threads=mapping_values.get_integer(body, "threads"),
            scheduling=mapping_values.get_order(body, "scheduling"),
            namespace=mapping_values.get_absolute_name(body, "namespace"),
            name=mapping_values.get_text(body, "name"),
            package=mapping_values.get_text(body, "package"),
            executable=mapping_values.get_text(body, "executable"),
            parameters=mapping_values.get_data(body, "parameters"),
            name_at=mapping_values.get_span(body, "name"),
            annotations=mapping_values.get_annotations(body),
            at=entry.key_span,
        )
        for name, entry, body in mapping_values.iterate_elements(root, "containers")
    }


def declare_resources(root: MappingNode, resolver: ReferenceResolver) -> dict[str, Resource]:
    """Declare the resources."""
    return {
        name: Resource(
            id=name,
            title=mapping_values.get_title(body, name),
            host=resolver.resolve_plain_id(mapping_values.get_scalar(body, "host"), "host", name),
            scheduling=mapping_values.get_order(body, "scheduling"),
            annotations=mapping_values.get_annotations(body),
            at=entry.key_span,
        )
        for name, entry, body in mapping_values.iterate_elements(root, "resources")
    }


def declare_links(root: MappingNode, resolver: ReferenceResolver) -> dict[str, Link]:
    """Declare the links between hosts and devices."""
    links_by_id: dict[str, Link] = {}
    for name, entry, body in mapping_values.iterate_elements(root, "links"):
        best, worst = sanity_checks.read_latency(
            mapping_values.get_mapping(body, "latency"), name, resolver.diagnostics
        )
        ends = _resolve_ends(body, resolver, name)
        links_by_id[name] = Link(
            id=name,
            title=mapping_values.get_title(body, name),
            connects=tuple(dict.fromkeys(end.id for _, end in ends if end and end.kind == "host")),
            devices=tuple(dict.fromkeys(end.id for _, end in ends if end and end.kind == "component")),
            protocol=mapping_values.get_medium(body, "protocol"),
            bandwidth=sanity_checks.read_positive(body, "bandwidth", "bandwidth", name, resolver.diagnostics),
            best=best,
            worst=worst,
            annotations=mapping_values.get_annotations(body),
            at=entry.key_span,
            connects_at=mapping_values.get_span(body, "connects"),
            protocol_at=mapping_values.get_span(body, "protocol"),
            unresolved=tuple(text for text, end in ends if end is None),
        )
    return links_by_id


def _resolve_ends(body: MappingNode, resolver: ReferenceResolver, link_id: str) -> list[tuple[str, ElementRef | None]]:
    """Return what a link connects, each end as written and what it means: a host by its id wins over a component."""
    hosts = resolver.plain_spans["host"]
    ends: list[tuple[str, ElementRef | None]] = []
    for scalar in mapping_values.get_scalars(body, "connects"):
        if scalar.text in hosts:
            ends.append((scalar.text, ElementRef("host", scalar.text)))
        elif _may_be_device(scalar.text, resolver):
            ends.append((scalar.text, resolver.resolve_reference(scalar, ("component",), link_id)))
        else:
            resolver.resolve_plain_id(scalar, "host", link_id)
            ends.append((scalar.text, None))
    return ends


def _may_be_device(text: str, resolver: ReferenceResolver) -> bool:
    """Whether an end of a link that is no host means a component, or a slip of the pen in the name of one."""
    if "." in text or resolver.names.ids_ending_in("component", text):
        return True
    if resolver.guesser.guess_name(text, resolver.plain_spans["host"]):
        return False
    component_names = {path.rpartition(".")[2] for path in resolver.spans["component"]}
    return resolver.guesser.guess_name(text, component_names) is not None
