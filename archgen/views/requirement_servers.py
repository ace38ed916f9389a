"""What serves a requirement: components, and chains with what the timing analysis says of their deadlines."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.model.architecture import Chain, Requirement
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
    """Whether a component or a chain serves a requirement."""
    return requirement.id in lookup.components_for_requirement or requirement.id in lookup.chains_for_requirement


def list_servers(lookup: Lookup, requirement: Requirement) -> Iterator[Inlines]:
    """Yield links to the components that serve a requirement, then to the chains."""
    for component in lookup.components_for_requirement.get(requirement.id, ()):
        yield (inline_text.component_link(component),)
    for chain in lookup.chains_for_requirement.get(requirement.id, ()):
        yield (Text("chain "), *chain_link(lookup, chain))
