"""Declare what links connect: hosts, and components that are devices."""

from __future__ import annotations

from archgen.link import mapping_values
from archgen.link.reference_resolution import ReferenceResolver
from archgen.model.path_resolver import ElementRef
from archgen.syntax.yaml_tree import MappingNode


def read_link_ends(
    body: MappingNode, key: str, link_id: str, resolver: ReferenceResolver
) -> tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]:
    """Return the hosts that a link connects, the components that are devices on it, and the ends that name neither."""
    ends = _resolve_ends(body, key, resolver, link_id)
    hosts, devices = (
        tuple(dict.fromkeys(end.id for _, end in ends if end and end.kind == kind)) for kind in ("host", "component")
    )
    return hosts, devices, tuple(text for text, end in ends if end is None)


def _resolve_ends(
    body: MappingNode, key: str, resolver: ReferenceResolver, link_id: str
) -> list[tuple[str, ElementRef | None]]:
    """Return what a link connects, each end as written and what it means: a host by its id wins over a component."""
    hosts = resolver.plain_spans["host"]
    ends: list[tuple[str, ElementRef | None]] = []
    for scalar in mapping_values.get_scalars(body, key):
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
