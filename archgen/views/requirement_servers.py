"""What serves a requirement: components, and chains with what the timing analysis says of their deadlines."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from archgen.model.architecture import Chain
from archgen.model.requirement import Requirement
from archgen.views import inline_text
from archgen.views.lookup import Lookup
from archgen.views.shapes import Inlines, Status, Text

_CHAIN_STATUSES: Mapping[str, Status] = {"met": "met", "not proven": "not proven", "missed": "missed", "open": "open"}
"""The states that are verdicts; that a chain has no deadline is none."""


def describe_chain_state(lookup: Lookup, chain: Chain) -> str:
    """Return whether a chain meets its deadline: met, missed, not proven, open or without a deadline; empty if nothing was analysed."""
    results = lookup.timing.chains if lookup.timing else ()
    verdict = next((result.verdict for result in results if result.id == chain.id), "")
    return "without a deadline" if verdict and chain.deadline is None else verdict


def chain_link(lookup: Lookup, chain: Chain) -> Inlines:
    """Link to a chain by its title, with its state behind it: a chip where there are such, else its words."""
    state = describe_chain_state(lookup, chain)
    link = Text(chain.title, ref=f"chain:{chain.id}")
    if not state:
        return (link,)
    status = _CHAIN_STATUSES.get(state)
    return (link, Text(": "), Text(state, strong=state in {"missed", "not proven"}, status=status))


def name_chain(lookup: Lookup, chain: Chain) -> str:
    """Return a chain's id, with its state behind it."""
    state = describe_chain_state(lookup, chain)
    return f"{chain.id} ({state})" if state else chain.id


def is_served(lookup: Lookup, requirement: Requirement) -> bool:
    """Whether a component or a chain serves a requirement, or all of its parts."""
    return requirement.id in lookup.requirement_trace.served


def list_server_words(lookup: Lookup, requirement: Requirement) -> Iterator[str]:
    """Yield the ids of the components that serve a requirement, then those of the chains, then how its parts do."""
    yield from (component.id for component in lookup.components_for_requirement.get(requirement.id, ()))
    chains = lookup.chains_for_requirement.get(requirement.id, ())
    yield from (f"the chain {name_chain(lookup, chain)}" for chain in chains)
    if words := describe_part_service(lookup, requirement):
        yield words


def describe_part_service(lookup: Lookup, requirement: Requirement) -> str:
    """Return how many of a requirement's parts are served, in words; empty for one without parts."""
    trace = lookup.requirement_trace
    return _count_parts(trace.parts.get(requirement.id, ()), trace.served, "served")


def describe_part_verification(lookup: Lookup, requirement: Requirement) -> str:
    """Return how many of a requirement's parts are verified, in words; empty for one without parts."""
    trace = lookup.requirement_trace
    if not trace.is_verification_told:
        return ""
    return _count_parts(trace.parts.get(requirement.id, ()), trace.verified, "verified")


def _count_parts(parts: Sequence[str], holding_ids: frozenset[str], word: str) -> str:
    if not parts:
        return ""
    count = sum(part in holding_ids for part in parts)
    noun = {1: "its part", 2: "both of its parts"}.get(len(parts), f"all {len(parts)} of its parts")
    return (
        f"{noun} {word}" if count == len(parts) else f"{count} of its {len(parts)} part{'s' * (len(parts) != 1)} {word}"
    )


def list_verifiers(lookup: Lookup, requirement: Requirement) -> Iterator[Inlines]:
    """Yield links to what verifies a requirement: use cases, chains with their state, files, sentences."""
    for verification in requirement.verified_by:
        use_case = lookup.architecture.use_cases.get(verification.text) if verification.kind == "use_case" else None
        chain = lookup.architecture.chains.get(verification.text) if verification.kind == "chain" else None
        if use_case:
            yield (Text(use_case.id, ref=f"use_case:{use_case.id}"),)
        elif chain:
            yield (Text("chain "), *chain_link(lookup, chain))
        elif verification.kind == "file":
            address = lookup.repository.file_address(verification.file, 1) if lookup.repository else None
            yield (Text(verification.text, url=address and address.removesuffix("#L1"), code=True),)
        else:
            yield (Text(verification.text),)


def judged_link(lookup: Lookup, requirement_id: str) -> Inlines:
    """Link to a requirement, followed by its title and its state."""
    requirement = lookup.architecture.requirements.get(requirement_id)
    link = inline_text.requirement_link(lookup.architecture, requirement_id)
    return (*link, Text(" "), state_chip(lookup, requirement)) if requirement else link


def state_chip(lookup: Lookup, requirement: Requirement) -> Text:
    """Return the state of a requirement as a chip: met, open, missed or uncovered."""
    state = lookup.requirement_trace.judge(requirement.id)
    return Text(state, status=state)


def list_servers(lookup: Lookup, requirement: Requirement) -> Iterator[Inlines]:
    """Yield links to the components that serve a requirement, then to the chains."""
    for component in lookup.components_for_requirement.get(requirement.id, ()):
        yield (inline_text.component_link(component),)
    for chain in lookup.chains_for_requirement.get(requirement.id, ()):
        yield (Text("chain "), *chain_link(lookup, chain))
