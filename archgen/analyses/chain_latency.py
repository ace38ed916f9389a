"""Does each chain react in time?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.diagnostics.rule_options import RuleOption, format_percentage
from archgen.timing.chains.chain_bounds import find_missed_shares, find_unmet_chains
from archgen.timing.chains.unfound_bounds import find_overloaded_hosts, find_unfound_places
from archgen.timing.figures import figure_wording
from archgen.timing.figures.value_arithmetic import is_boundless, is_known_bound, is_unfound

if TYPE_CHECKING:
    from collections.abc import Iterator
    from fractions import Fraction

    from archgen.model.architecture import Architecture
    from archgen.timing.analysis import Analysis, ChainTerm
    from archgen.timing.chains.chain_bounds import LateChain


def late_chain(architecture: Architecture, analysis: Analysis, *, margin: Fraction) -> Iterator[Diagnostic]:
    """A chain misses its deadline, or nothing proves that it meets it."""
    if not any(chain.deadline_text for chain in architecture.chains.values()):
        return
    for chain, share, best in find_missed_shares(analysis, architecture):
        yield Diagnostic(
            "late-chain",
            f"the chain `{chain.id}` misses its deadline of {figure_wording.format_duration(share.limit)} for {share.name} of its "
            f"reactions: each takes at least {figure_wording.format_duration(best.value or 0)}",
            chain.deadline_places[share.name],
            help=f"`archgen timing --sensitivity {chain.id}` shows which figure shortens it most",
            element=chain.id,
        )
    for late_result in find_unmet_chains(analysis, architecture, margin):
        chain_id, chain = late_result.chain.id, late_result.chain
        deadline = f"its deadline of {chain.deadline}"
        verdict_text = (
            f"the chain `{chain_id}` misses {deadline}"
            if late_result.verdict == "missed"
            else f"nothing proves that the chain `{chain_id}` meets {deadline}"
            + (f" with a margin of {format_percentage(margin)}" if margin else "")
        )
        yield Diagnostic(
            "late-chain",
            f"{verdict_text}: {_describe_bound(analysis, late_result)}",
            chain.at,
            labels=(_label_largest_part(architecture, analysis, late_result),),
            help=f"`archgen timing --sensitivity {chain_id}` shows which figure shortens it most",
            element=chain_id,
        )


def _describe_bound(analysis: Analysis, late_chain: LateChain) -> str:
    """Describe how long a chain takes, or why nobody can say."""
    bound, deadline = late_chain.bound, late_chain.chain.deadline
    if is_boundless(bound):
        hosts = join_words([f"`{host}`" for host in find_overloaded_hosts(analysis, late_chain.terms)])
        return (
            f"it may take any time, for more is to be done on {hosts} than can be" if hosts else "it may take any time"
        )
    if late_chain.verdict == "missed" and late_chain.best.value is not None:
        return f"it takes at least {figure_wording.format_duration(late_chain.best.value)}"
    if bound.value is None or (deadline is not None and bound.value <= deadline.value and is_unfound(bound)):
        places = find_unfound_places(analysis, late_chain.terms)
        hosts = join_words([f"`{place.host}`{place.load_text}" for place in places if place.host])
        return f"no bound was found on {hosts}" if hosts else "no bound was found"
    suffix = "" if is_known_bound(bound) else " and more, for not all of its figures are known"
    return f"it may take {figure_wording.format_duration(bound.value)}{suffix}"


def _label_largest_part(architecture: Architecture, analysis: Analysis, late_chain: LateChain) -> Label:
    """Return a label at what takes the largest part of a chain's time.

    Where a host has too much to do, or leaves no bound to find, the label is at the host: the figures of the elements
    that happen to run there may all be innocent.
    """
    for host_id in find_overloaded_hosts(analysis, late_chain.terms):
        boundless_ids = [
            f"`{term.activity}`"
            for term in late_chain.terms
            if is_boundless(term.response) and analysis.system.activities[term.activity].host == host_id
        ]
        verb = "runs" if len(boundless_ids) == 1 else "run"
        text = f"has more to do than it can, and {join_words(boundless_ids)} {verb} here"
        return Label(architecture.hosts[host_id].at, text)
    for place in find_unfound_places(analysis, late_chain.terms):
        if place.host is not None:
            names = join_words([f"`{name}`" for name in place.activities])
            return Label(architecture.hosts[place.host].at, f"no bound was found for {names} here")
    largest_term = max(late_chain.terms, key=_term_weight)
    activity = analysis.system.activities[largest_term.activity]
    parts = [largest_term.sampling.value, largest_term.response.value, largest_term.link.value]
    is_own_work = None not in parts and parts[1] == max(parts)  # type: ignore[type-var]  # no None among them
    span = activity.places.get("wcet", largest_term.at) if is_own_work else largest_term.at
    return Label(span, f"the largest part: {largest_term.activity}, {_format_term(largest_term)}")


def _term_weight(term: ChainTerm) -> tuple[bool, object]:
    """Return a sort key: unbounded terms above all others, then the known parts of the sum (ns)."""
    is_endless = is_boundless(term.sampling) or is_boundless(term.response)
    return (is_endless, sum((v.value for v in (term.sampling, term.response, term.link) if v.value is not None), 0))


def _format_term(term: ChainTerm) -> str:
    """Format a term of a chain as its waiting, its response and its link; parts of 0 are left out."""
    contributions = (("waits", term.sampling), ("takes", term.response), ("link", term.link))
    phrases = [
        f"{word} {figure_wording.format_duration(value.value) if value.value is not None else figure_wording.name_unknown_reason(value)}"
        for word, value in contributions
        if value.value != 0
    ]
    return ", ".join(phrases) or "no time"


RULES = (
    (
        late_chain,
        Severity.WARNING,
        (RuleOption("margin", 0, 0, 99, "The share of the deadline that must stay free."),),
    ),
)
