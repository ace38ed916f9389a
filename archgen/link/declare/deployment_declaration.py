"""Declare where nodes run: hosts, containers, resources and links."""

from __future__ import annotations

from archgen.diagnostics.source_span import Span
from archgen.link import mapping_values, sanity_checks
from archgen.link.reference_resolution import ReferenceResolver
from archgen.model.declared_timing import SchedulingOrder
from archgen.model.deployment import Container, Host, Link, Resource
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
    """Declare the links between hosts."""
    links_by_id: dict[str, Link] = {}
    for name, entry, body in mapping_values.iterate_elements(root, "links"):
        best, worst = sanity_checks.read_latency(
            mapping_values.get_mapping(body, "latency"), name, resolver.diagnostics
        )
        connects = resolver.resolve_plain_ids(mapping_values.get_scalars(body, "connects"), "host", name)
        links_by_id[name] = Link(
            id=name,
            title=mapping_values.get_title(body, name),
            connects=connects,
            bandwidth=sanity_checks.read_positive(body, "bandwidth", "bandwidth", name, resolver.diagnostics),
            best=best,
            worst=worst,
            annotations=mapping_values.get_annotations(body),
            at=entry.key_span,
            connects_at=mapping_values.get_span(body, "connects"),
            unresolved=tuple(host for host in mapping_values.get_texts(body, "connects") if host not in connects),
        )
    return links_by_id
