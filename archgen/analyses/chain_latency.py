"""Does each chain react in time?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.diagnostics.rule_options import RuleOption, format_percentage
from archgen.timing.chains.chain_bounds import find_missed_chains
from archgen.timing.figures import figure_wording
from archgen.timing.figures.value_arithmetic import is_boundless, is_known_bound

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from fractions import Fraction

    from archgen.model.architecture import Architecture
    from archgen.timing.analysis import Analysis, ChainTerm
    from archgen.timing.chains.chain_bounds import LateChain
    from archgen.timing.figures.timing_values import TimingValue


def late_chain(architecture: Architecture, analysis: Analysis, *, margin: Fraction) -> Iterator[Diagnostic]:
    """The latency of a chain may exceed its deadline.

    Why: The bound adds up, for each element of the chain, the longest that a sample waits to be read, the longest
    response and the link's latency. Where it is above the deadline, nothing in the design guarantees the reaction in
    time. `archgen timing --chain ID` shows each term, `archgen timing --sensitivity ID` which figure helps most.

    Bad:
        groups:
          driving:
            components:
              scanner:
                outputs: {scan: sensor_msgs/msg/LaserScan}
                timing: {period: 100 ms, wcet: 5 ms}
              brake:
                inputs: {scan: scanner.scan}
                timing: {period: 50 ms, wcet: 2 ms}
        nodes:
          scanner: {implements: scanner}
          brake: {implements: brake}
        chains:
          see_and_stop: {through: [driving.scanner, driving.brake], deadline: 100 ms}

    Good:
        groups:
          driving:
            components:
              scanner:
                outputs: {scan: sensor_msgs/msg/LaserScan}
                timing: {period: 50 ms, wcet: 5 ms}
              brake:
                inputs: {scan: scanner.scan}
                timing: {behaviour: event, wcet: 2 ms}
        nodes:
          scanner: {implements: scanner}
          brake: {implements: brake}
        chains:
          see_and_stop: {through: [driving.scanner, driving.brake], deadline: 100 ms}
    """
    if not any(chain.deadline for chain in architecture.chains.values()):
        return
    for late_result in find_missed_chains(analysis, architecture, margin):
        chain_id, chain = late_result.chain.id, late_result.chain
        yield Diagnostic(
            "late-chain",
            f"{_describe_bound(late_result)}, its deadline is {chain.deadline}"
            + (f" with a margin of {format_percentage(margin)}" if margin else ""),
            chain.at,
            labels=(_label_largest_part(architecture, analysis, late_result),),
            help=f"`archgen timing --sensitivity {chain_id}` shows which figure shortens it most",
            element=chain_id,
        )


def _describe_bound(late_chain: LateChain) -> str:
    """Describe how long a chain may take, or that no bound was found: several cores leave that open."""
    if late_chain.bound.value is None and _find_boundless_terms(late_chain.terms, "unbounded"):
        return f"no bound was found for the chain `{late_chain.chain.id}`"
    return f"the chain `{late_chain.chain.id}` may take {_format_bound(late_chain.bound)}"


def _label_largest_part(architecture: Architecture, analysis: Analysis, late_chain: LateChain) -> Label:
    """Return a label at what takes the largest part of a chain's time.

    Where a host has too much to do, or leaves no bound to find, the label is at the host: the figures of the elements
    that happen to run there may all be innocent.
    """
    for reason, text in (("overload", "has more to do than it can"), ("unbounded", "no bound was found for")):
        terms = _find_boundless_terms(late_chain.terms, reason)
        host = architecture.hosts.get(analysis.system.activities[terms[0].activity].host or "") if terms else None
        if host is not None:
            names = join_words(
                [f"`{term.activity}`" for term in terms if analysis.system.activities[term.activity].host == host.id]
            )
            return Label(host.at, f"{text} {names} here" if reason == "unbounded" else f"{text}, and {names} runs here")
    largest_term = max(late_chain.terms, key=_term_weight)
    activity = analysis.system.activities[largest_term.activity]
    parts = [largest_term.sampling.value, largest_term.response.value, largest_term.link.value]
    is_own_work = None not in parts and parts[1] == max(parts)  # type: ignore[type-var]  # no None among them
    span = activity.places.get("wcet", largest_term.at) if is_own_work else largest_term.at
    return Label(span, f"the largest part: {largest_term.activity}, {_format_term(largest_term)}")


def _find_boundless_terms(terms: Iterable[ChainTerm], reason: str) -> list[ChainTerm]:
    """Return the terms whose response has no bound for a reason, and whose waiting has one."""
    return [
        term
        for term in terms
        if figure_wording.name_unknown_reason(term.response) == reason and not is_boundless(term.sampling)
    ]


def _format_bound(bound: TimingValue) -> str:
    """Format a bound on a latency (ns), with what makes it unbounded or incomplete."""
    # `missed` returns only chains whose bound is exceeded, so that None here means unbounded, never unknown.
    if bound.value is None:
        return "any time, for a host is overloaded" if "overload" in bound.assumptions else "any time"
    suffix = "" if is_known_bound(bound) else " and more, for not all of its figures are known"
    return figure_wording.format_duration(bound.value) + suffix


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
