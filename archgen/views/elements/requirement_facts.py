"""What `archgen show` says of a requirement: what it is part of, where it comes from, what serves and verifies it."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.model.requirement import Requirement, Verification
from archgen.views import requirement_servers
from archgen.views.lookup import Lookup


def list_requirement_facts(lookup: Lookup, requirement: Requirement) -> Iterator[tuple[str, str]]:
    """Yield the facts of a requirement by their keys; empty where nothing is known."""
    yield "state", lookup.requirement_trace.judge(requirement.id)
    yield "parent", ", ".join(requirement.parents)
    for key in ("kind", "priority", "rationale", "source"):
        yield key, " ".join((getattr(requirement, key) or "").split())
    yield "tags", ", ".join(requirement.tags)


def list_requirement_parts(lookup: Lookup, requirement: Requirement) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the lists below a requirement's card: its parts, what serves it, what verifies it."""
    parts = lookup.requirement_trace.parts.get(requirement.id, ())
    if parts:
        yield "parts", tuple(_name_part(lookup, part) for part in parts)
    yield "served by", tuple(requirement_servers.list_server_words(lookup, requirement))
    verifiers = [_name_verification(lookup, each) for each in requirement.verified_by]
    verifiers += filter(None, [requirement_servers.describe_part_verification(lookup, requirement)])
    if verifiers or lookup.requirement_trace.is_verification_told:
        yield "verified by", tuple(verifiers)


def _name_part(lookup: Lookup, part_id: str) -> str:
    part = lookup.architecture.requirements[part_id]
    title = "" if part.title == part.id else f" {part.title}"
    return f"{part.id}{title} ({lookup.requirement_trace.judge(part_id)})"


def _name_verification(lookup: Lookup, verification: Verification) -> str:
    chain = lookup.architecture.chains.get(verification.text) if verification.kind == "chain" else None
    if chain:
        return f"the chain {requirement_servers.name_chain(lookup, chain)}"
    return f"the use case {verification.text}" if verification.kind == "use_case" else verification.text
