"""What keys say together with the rest of the project: what they name, and figures that cannot be."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from archgen.diagnostics.diagnostic import Diagnostic, Label
from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.link import mapping_values, sanity_checks
from archgen.link.declare.deadline_declaration import read_deadline
from archgen.link.declare.property_declaration import read_range, read_required
from archgen.link.reference_resolution import ReferenceResolver
from archgen.model.path_resolver import ElementRef
from archgen.model.quantity import Quantity
from archgen.model.requirement import Verification
from archgen.syntax.yaml_tree import MappingNode

KeyDeclarer = Callable[[MappingNode, str, str, ReferenceResolver], Any]
"""Returns what stands at a key of the element with an id; what is wrong with it goes to the resolver's diagnostics."""


def _resolve_id(body: MappingNode, key: str, element_id: str, resolver: ReferenceResolver, kind: str) -> str | None:
    return resolver.resolve_plain_id(mapping_values.get_scalar(body, key), kind, element_id)


def _resolve_ids(
    body: MappingNode, key: str, element_id: str, resolver: ReferenceResolver, kind: str
) -> tuple[str, ...]:
    return resolver.resolve_plain_ids(mapping_values.get_scalars(body, key), kind, element_id)


def _read_positive(
    body: MappingNode, key: str, element_id: str, resolver: ReferenceResolver, dimension: str
) -> Quantity | None:
    return sanity_checks.read_positive(body, key, dimension, element_id, resolver.diagnostics)


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


def read_parents(
    body: MappingNode, key: str, requirement_id: str, resolver: ReferenceResolver
) -> tuple[tuple[str, ...], Span]:
    """Return the requirements that one is a part of, and where the first of them is written."""
    parents = mapping_values.get_scalars(body, key)
    span = parents[0].span if parents else NO_SPAN
    return resolver.resolve_plain_ids(parents, "requirement", requirement_id), span


def read_verifications(
    body: MappingNode, key: str, requirement_id: str, resolver: ReferenceResolver
) -> tuple[Verification, ...]:
    """Return what shows that a requirement is met, each once; of what is both a use case and a chain nothing."""
    found: list[Verification] = []
    seen_texts: set[str] = set()
    for scalar in mapping_values.get_scalars(body, key):
        text = scalar.text.strip()
        if not text or text in seen_texts:
            continue
        seen_texts.add(text)
        use_case_span = resolver.plain_spans["use case"].get(text)
        chain_span = resolver.plain_spans["chain"].get(text)
        if use_case_span and chain_span:
            resolver.diagnostics.append(
                Diagnostic(
                    "ambiguous-reference",
                    f"`{text}` can mean the use case or the chain of this name",
                    scalar.span,
                    labels=(Label(use_case_span, "the use case"), Label(chain_span, "the chain")),
                    help="rename one of them",
                    element=requirement_id,
                )
            )
        elif use_case_span:
            found.append(Verification("use_case", text, scalar.span))
        elif chain_span:
            found.append(Verification("chain", text, scalar.span))
        else:
            is_sentence = any(letter.isspace() for letter in text)
            found.append(Verification("text" if is_sentence else "file", text, scalar.span))
    return tuple(found)


NAMING_TYPES = {"id": _resolve_id, "requirement_ids": _resolve_ids}
"""Types of what is named by its id alone; the description says what a key `offers`."""
DECLARERS: Mapping[str, KeyDeclarer] = {
    "bandwidth": partial(_read_positive, dimension="bandwidth"),
    "chain_deadline": read_deadline,
    "link.connects": read_link_ends,
    "link.latency": sanity_checks.read_latency,
    "property_declaration.range": read_range,
    "property_declaration.required": read_required,
    "requirement.parent": read_parents,
    "requirement.verified_by": read_verifications,
}
"""What declares the keys of a type, and single keys (`KIND.KEY`)."""
