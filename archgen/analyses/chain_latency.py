"""Does each chain react in time?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.diagnostics.rule_options import RuleOption, format_percentage
from archgen.timing.chains.chain_bounds import find_missed_chains
from archgen.timing.figures import figure_wording
from archgen.timing.figures.value_arithmetic import is_boundless, is_known_bound

if TYPE_CHECKING:
    from collections.abc import Iterator
    from fractions import Fraction

    from archgen.model.architecture import Architecture
    from archgen.timing.analysis import Analysis, ChainTerm
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
        largest_term = max(late_result.terms, key=_term_weight)
        yield Diagnostic(
            "late-chain",
            f"the chain `{chain_id}` may take {_format_bound(late_result.bound)}, its deadline is {chain.deadline}"
            + (f" with a margin of {format_percentage(margin)}" if margin else ""),
            chain.at,
            labels=(
                Label(largest_term.at, f"the largest part: {largest_term.activity}, {_format_term(largest_term)}"),
            ),
            help=f"`archgen timing --sensitivity {chain_id}` shows which figure shortens it most",
            element=chain_id,
        )


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
