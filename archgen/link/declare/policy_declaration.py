"""Declare policies: flows that the project forbids, sources that it asks for, and what it accepts all the same."""

from __future__ import annotations

from archgen.diagnostics.source_span import Span
from archgen.link import mapping_values
from archgen.link.reference_resolution import ReferenceResolver
from archgen.link.value_readers import read_element
from archgen.model.architecture import Policy, SourceDemand
from archgen.syntax.yaml_tree import MappingNode, ScalarNode


def declare_policies(root: MappingNode, resolver: ReferenceResolver) -> dict[str, Policy]:
    """Declare the policies, except one that says neither whole, which merging has reported."""
    policies_by_id: dict[str, Policy] = {}
    for name, entry, body in mapping_values.iterate_elements(root, "policies"):
        forbid = mapping_values.get_mapping(body, "forbid")
        has_flow = forbid.get("from") is not None and forbid.get("to") is not None
        demand = _declare_demand(mapping_values.get_mapping(body, "require"))
        if not has_flow and demand is None:
            continue
        accepted, places = _resolve_accepted(body, resolver, name)
        policies_by_id[name] = Policy(
            **read_element("policy", Policy, entry, body),
            forbid_from=(mapping_values.get_text(forbid, "from") or "") if has_flow else "",
            forbid_to=(mapping_values.get_text(forbid, "to") or "") if has_flow else "",
            require=demand,
            accepted=accepted,
            from_at=mapping_values.get_span(forbid, "from"),
            to_at=mapping_values.get_span(forbid, "to"),
            accepted_places=places,
        )
    return policies_by_id


def _declare_demand(body: MappingNode) -> SourceDemand | None:
    of, inputs_from = mapping_values.get_text(body, "of"), mapping_values.get_text(body, "inputs_from")
    if of is None or inputs_from is None:
        return None
    return SourceDemand(
        of,
        inputs_from,
        mapping_values.get_text(body, "guarded_by"),
        mapping_values.get_span(body, "of"),
        mapping_values.get_span(body, "inputs_from"),
    )


def _resolve_accepted(
    body: MappingNode, resolver: ReferenceResolver, policy_id: str
) -> tuple[dict[str, str], dict[str, Span]]:
    """Return the reasons by the complete ids of inputs, and where these are written."""
    reasons: dict[str, str] = {}
    places: dict[str, Span] = {}
    accepted = mapping_values.get_mapping(body, "accepted")
    for entry in accepted:
        reason = mapping_values.get_text(accepted, entry.key)
        target = resolver.resolve_reference(ScalarNode(entry.key, entry.key, entry.key_span), ("input",), policy_id)
        if target and reason is not None:
            reasons[target.id] = reason
            places[target.id] = entry.key_span
    return reasons, places
