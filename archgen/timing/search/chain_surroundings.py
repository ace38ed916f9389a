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


def list_waiting_elements(analysis: Analysis, result: ChainResult) -> list[Activity]:
    """Return the elements of a chain at which something waits for others on their hosts, the longest wait first.

    A wait is what a response, or the time until a message is stored, has beside the element's own work and its own clock.
    What has no bound comes before all; a declared response waits for nobody.
    """
    waits = {term.activity: _find_wait(analysis, term) for term in result.terms}
    waiting_ids = [name for name, wait in waits.items() if wait is None or wait > 0]
    waiting_ids.sort(key=lambda name: (waits[name] is not None, -(waits[name] or 0)))
    return [analysis.system.activities[name] for name in waiting_ids]


def _find_wait(analysis: Analysis, term: ChainTerm) -> Fraction | None:
    """Return for how long something waits at a step, in ns; None where nobody knows."""
    activity, pace = analysis.system.activities[term.activity], analysis.paces[term.activity]
    if term.response.value is None or term.sampling.value is None:
        return None
    wait = Fraction(0)
    own_response = analysis.responses[activity.id]
    if activity.wcet is not None and own_response.tier != "declared":
        # In a run the first step has all of its wait; each of the others waits just as well.
        response = max(term.response.value, own_response.worst.value or term.response.value)
        wait += max(Fraction(0), response - activity.wcet * analysis.system.tick)
    if pace.behaviour == "periodic" and pace.gap.value is not None:
        wait += max(Fraction(0), term.sampling.value - pace.gap.value)
    return wait


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
