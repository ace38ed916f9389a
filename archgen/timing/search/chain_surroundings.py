"""What bears on a chain: its own elements, the largest parts first, and what works on their hosts, the busiest first."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

from archgen.timing.analysis import Analysis, ChainResult, ChainTerm
from archgen.timing.system.timing_system import Activity


def list_chain_elements(analysis: Analysis, result: ChainResult) -> list[Activity]:
    """Return the elements of a chain, the one that adds most first, those without a bound before all."""
    terms = sorted(result.terms, key=_part_order)
    return [analysis.system.activities[name] for name in dict.fromkeys(term.activity for term in terms)]


def _part_order(term: ChainTerm) -> tuple[bool, Fraction]:
    parts = (term.sampling, term.response, term.link)
    return all(part.value is not None for part in parts), -sum(
        (part.value or Fraction(0) for part in parts), Fraction(0)
    )


def list_neighbours(analysis: Analysis, elements: Iterable[Activity]) -> list[Activity]:
    """Return what else works on the hosts of some elements, what takes most of them first."""
    names = {activity.id for activity in elements}
    hosts = dict.fromkeys(activity.host for activity in elements if activity.host)
    shares = [
        (-(share.value or Fraction(0)), name)
        for host in hosts
        for name, share in (analysis.hosts[host].activity_shares if host in analysis.hosts else ())
        if name not in names
    ]
    return [analysis.system.activities[name] for _, name in sorted(shares)]
