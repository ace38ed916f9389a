"""Does each chain react in time?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostic import Diagnostic, Label, Severity
from archgen.timing import wording
from archgen.timing.chains import missed
from archgen.timing.sums import boundless, known

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.model.architecture import Architecture
    from archgen.timing.analysis import Analysis, Term
    from archgen.timing.value import Value


def late_chain(architecture: Architecture, analysis: Analysis) -> Iterator[Diagnostic]:
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
    for late in missed(analysis, architecture):
        name, chain = late.chain.id, late.chain
        largest = max(late.terms, key=_weight)
        yield Diagnostic(
            "late-chain",
            f"the chain `{name}` may take {_said(late.bound)}, its deadline is {chain.deadline}",
            chain.at,
            labels=(Label(largest.at, f"the largest part: {largest.activity}, {_part(largest)}"),),
            help=f"`archgen timing --sensitivity {name}` shows which figure shortens it most",
            element=name,
        )


def _said(bound: Value) -> str:
    """Format a bound on a latency (ns), with what makes it unbounded or incomplete."""
    # `missed` returns only chains whose bound is exceeded, so that None here means unbounded, never unknown.
    if bound.value is None:
        return "any time, for a host is overloaded" if "overload" in bound.assumptions else "any time"
    more = "" if known(bound) else " and more, for not all of its figures are known"
    return wording.duration(bound.value) + more


def _weight(term: Term) -> tuple[bool, object]:
    """Return a sort key: unbounded terms above all others, then the known parts of the sum (ns)."""
    endless = boundless(term.sampling) or boundless(term.response)
    return (endless, sum((v.value for v in (term.sampling, term.response, term.link) if v.value is not None), 0))


def _part(term: Term) -> str:
    """Format a term of a chain as its waiting, its response and its link; parts of 0 are left out."""
    parts = (("waits", term.sampling), ("takes", term.response), ("link", term.link))
    said = [
        f"{word} {wording.duration(value.value) if value.value is not None else wording.reason(value)}"
        for word, value in parts
        if value.value != 0
    ]
    return ", ".join(said) or "no time"


RULES = ((late_chain, Severity.WARNING),)
