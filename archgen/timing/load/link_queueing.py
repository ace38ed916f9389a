"""How long messages are on a link of which only the bandwidth is written: until all that can wait before it is sent.

In whatever order messages are sent, each has left at the end of the longest busy period. That delays what comes next,
and makes what this sends in turn burstier; so links and everything else are looked at in turns, from below, until
nothing changes.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import count

from archgen.frozen import replace
from archgen.timing.figures.tick_unit import NS_PER_SECOND
from archgen.timing.figures.timing_values import UnknownCause, sum_ratios, unite_causes
from archgen.timing.load.busy_windows import (
    ActivityWork,
    DivergedError,
    GroupBudgets,
    GrowingLoad,
    SearchBudget,
    longest_busy_period,
)
from archgen.timing.load.event_models import sent_model
from archgen.timing.load.event_propagation import propagate_events
from archgen.timing.load.propagation_state import PropagationState
from archgen.timing.system.timing_system import Arc, TimingSystem, group_arcs
from archgen.timing.system.trigger_graph import TriggerGraph, find_triggers

_MAX_TURNS = 24
"""Turns after which links that still change are given up."""
_MAX_LINK_WAIT = 20 * NS_PER_SECOND
"""A computed latency (ns) above this is not given: the link counts as unknown."""
SATURATED_CAUSE, DIVERGED_CAUSE = UnknownCause(notes=("unbounded",)), UnknownCause(notes=("diverged",))


def settle_links(system: TimingSystem) -> tuple[TimingSystem, TriggerGraph, PropagationState]:
    """Return the system with the latencies of its links, where only the bandwidth is written, and its state."""
    waits: dict[str, int | None] = {
        arc.link: 0
        for arc in system.arcs
        if arc.link is not None and arc.worst is None and system.bandwidths.get(arc.link)
    }
    group_budgets = GroupBudgets()
    for turn in count(1):
        candidate = _apply_waits(system, waits) if waits else system
        trigger_graph = find_triggers(candidate)
        state = propagate_events(candidate, trigger_graph, group_budgets)
        arcs_by_link = group_arcs((arc.link or "", arc) for arc in candidate.arcs if arc.link in waits)
        new_waits = {
            link: None if old_wait is None else _link_wait(state, link, arcs_by_link[link])
            for link, old_wait in waits.items()
        }
        if new_waits == waits:
            break
        # Every so many turns whatever still changes is given up, so that the others can settle without it. None stays
        # None, thus the loop ends.
        waits = (
            new_waits
            if turn % _MAX_TURNS
            else {link: old_wait if old_wait == waits[link] else None for link, old_wait in new_waits.items()}
        )
    state.searched_terms = group_budgets.spent_terms
    return candidate, trigger_graph, state


def _apply_waits(system: TimingSystem, waits: Mapping[str, int | None]) -> TimingSystem:
    """Return the system with computed latencies, on top of the best ones that are written."""

    def apply_wait(arc: Arc) -> Arc:
        wait = waits.get(arc.link) if arc.link is not None and arc.worst is None else None
        return arc if wait is None else replace(arc, best=arc.best or 0, worst=(arc.best or 0) + wait)

    arcs = tuple(apply_wait(arc) for arc in system.arcs)
    return replace(
        system,
        arcs=arcs,
        arcs_into=group_arcs((arc.target, arc) for arc in arcs),
        arcs_from=group_arcs((arc.source, arc) for arc in arcs),
        queued_links=frozenset(link for link, wait in waits.items() if wait is not None),
    )


def _link_wait(state: PropagationState, link: str, arcs: Iterable[Arc]) -> int | None:
    """Return the computed wait for a link in ticks, None where there is none."""
    busy_period = longest_queueing(state, link, arcs)
    return (
        None
        if isinstance(busy_period, UnknownCause) or busy_period * state.system.tick > _MAX_LINK_WAIT
        else busy_period
    )


def longest_queueing(state: PropagationState, link: str, arcs: Iterable[Arc]) -> int | UnknownCause:
    """Return the longest busy period of a link in ticks (rounded up), or why there is none."""
    bandwidth = state.system.bandwidths[link]
    if not bandwidth:
        return UnknownCause((link,))
    # Ticks per byte. A bandwidth is in B/s here: one byte takes 1 / bandwidth seconds.
    ticks_numerator, ticks_denominator = (NS_PER_SECOND / (bandwidth * state.system.tick)).as_integer_ratio()
    work_of: dict[int, ActivityWork] = {}
    causes: list[UnknownCause] = []
    for arc in arcs:
        event_model = sent_model(state, arc)
        if isinstance(event_model, UnknownCause):
            causes.append(event_model if event_model.missing else UnknownCause((arc.source,), event_model.notes))
        elif arc.size is None and event_model:
            causes.append(UnknownCause((arc.topic,)))
        elif arc.size:
            # All readers of an output have its one event model. (Each model is kept, so that no other has its identity.)
            cost = -(-arc.size * ticks_numerator // ticks_denominator)
            same_work = work_of.get(id(event_model))
            work_of[id(event_model)] = ActivityWork(cost + same_work.cost if same_work else cost, event_model)
    works = list(work_of.values())
    sent_numerator, sent_denominator = sum_ratios(
        (stream.max_rate_ratio[0] * work.cost, stream.max_rate_ratio[1]) for work in works for stream in work.streams
    )
    # Before the causes: what is known fills the link already, whatever else comes.
    if sent_numerator >= sent_denominator:
        return SATURATED_CAUSE
    if causes:
        return unite_causes(causes)
    try:
        return longest_busy_period(GrowingLoad(works).demand_function(), SearchBudget()) if works else 0
    except DivergedError:
        return DIVERGED_CAUSE
