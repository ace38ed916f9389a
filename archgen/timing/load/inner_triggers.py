"""The triggers inside a core, or cores that share their work: what fires what without anything between them that takes time.

An event that fires an activity of a core, and what that fires there in turn, are one amount of work: all of it comes with
the event, so that none of it has a jitter of its own. What comes from other cores, over a link or out of a wait is an
entry: its own event model says how often.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction

from archgen.frozen import NamedTuple, dataclass
from archgen.model.graph_search import find_strong_components
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.timing_system import (
    Activity,
    Arc,
    TimingSystem,
    calls_per_activation,
    is_taken_answer,
)
from archgen.timing.system.trigger_graph import TriggerGraph, has_own_rate

ONE_CALL = Fraction(1)


class FiringArc(NamedTuple):
    """An arc that fires an activity, and how often it does for each activation of its source."""

    arc: Arc
    calls: Fraction = ONE_CALL


@dataclass(frozen=True, slots=True)
class InnerTriggers:
    """What fires the activities of one core, `order` having each behind those of the core that fire it.

    `inner_arcs` and `outer_arcs` are what fires an activity, from the core itself and from elsewhere. Activities without
    either (`entry_ids`) are fired as their own event models say. `gated_inputs` are the inputs that an all-of activity
    waits for, with the arcs into each; `complete_gates` those of which all inputs are known.
    """

    order: tuple[str, ...]
    entry_ids: frozenset[str]
    inner_arcs: Mapping[str, tuple[FiringArc, ...]]
    outer_arcs: Mapping[str, tuple[FiringArc, ...]]
    gated_inputs: Mapping[str, tuple[tuple[FiringArc, ...], ...]]
    complete_gates: frozenset[str]
    silent_ids: frozenset[str]
    """Activities of the core that never fire, or only at the start."""

    @property
    def outer_sources(self) -> Iterator[str]:
        """Yield the activities elsewhere that fire something here."""
        for firing_arcs in self.outer_arcs.values():
            yield from (firing_arc.arc.source for firing_arc in firing_arcs)


def find_inner_triggers(
    system: TimingSystem, triggers: TriggerGraph, resource: ProcessingResource, *, over_links: bool = False
) -> InnerTriggers | None:
    """Return the triggers inside a resource; None where each activity is looked at by itself.

    That is so where cores are joined, or nobody wrote how many there are, where one core has no trigger inside, and on a
    core of some with priorities on which others may run too. With `over_links` what takes a known time on its way is
    inside as well, but no call: its caller may go on.
    """
    if resource.joined or resource.missing or resource.waits:
        return None
    is_ranked = any(system.activities[name].priority is not None for name in resource.members)
    if resource.cores == 1 and resource.stranger_units and is_ranked:
        # While something urgent runs on another core, what is less urgent may end here, and fire more that is urgent.
        return None
    members = dict.fromkeys(resource.members)
    arcs_into = {
        name: _divide_arcs(system, _firing_arcs(system, triggers, name), members, over_links=over_links)
        for name in members
        if _is_fired_by_arcs(system, triggers, name)
        # While several cores work, what has come to a gate is never known: its own event model says what leaves it.
        and (resource.cores == 1 or not _is_gate(system, triggers, name))
    }
    successors: dict[str, list[str]] = {name: [] for name in members}
    for name, (inner_arcs, _) in arcs_into.items():
        for firing_arc in inner_arcs:
            successors[firing_arc.arc.source].append(name)
    if resource.cores == 1 and not any(successors.values()):
        return None
    components = find_strong_components(members, successors.__getitem__)
    # Events that go round have no last one: their own event models, found by repetition, say how many there are.
    ring_ids = {name for ring in components for name in ring if len(ring) > 1 or name in successors[name]}
    return _build_inner_triggers(
        system, triggers, tuple(name for ring in components for name in ring), arcs_into, ring_ids
    )


def _is_gate(system: TimingSystem, triggers: TriggerGraph, name: str) -> bool:
    """Whether not each event that arrives at an activity fires it."""
    activity = system.activities[name]
    if activity.every > 1 or activity.throttle or len(_needed_inputs(system, triggers, name)) > 1:
        return True
    return any(firing_arc.calls.denominator != 1 for firing_arc in _firing_arcs(system, triggers, name))


def _build_inner_triggers(
    system: TimingSystem,
    triggers: TriggerGraph,
    inner_order: tuple[str, ...],
    arcs_into: Mapping[str, tuple[tuple[FiringArc, ...], tuple[FiringArc, ...]]],
    ring_ids: Iterable[str],
) -> InnerTriggers:
    """Return what fires each activity, in order, from the core and from elsewhere."""
    members = dict.fromkeys(inner_order)
    entry_ids = frozenset(members).difference(arcs_into).union(ring_ids)
    fired_ids = [name for name in inner_order if name not in entry_ids]
    needed_inputs = {name: _needed_inputs(system, triggers, name) for name in fired_ids}
    known_inputs = {
        name: {key: arcs for key, arcs in inputs.items() if (name, key) not in triggers.open_inputs}
        for name, inputs in needed_inputs.items()
        if inputs
    }
    return InnerTriggers(
        inner_order,
        entry_ids,
        {name: arcs_into[name][0] for name in fired_ids},
        {name: arcs_into[name][1] for name in fired_ids},
        {name: tuple(tuple(map(FiringArc, arcs)) for arcs in inputs.values()) for name, inputs in known_inputs.items()},
        frozenset(name for name, inputs in known_inputs.items() if len(inputs) == len(needed_inputs[name])),
        frozenset(
            name for name in members if name in triggers.never_firing or system.activities[name].behaviour == "once"
        ),
    )


def _divide_arcs(
    system: TimingSystem, firing_arcs: Iterable[FiringArc], members: Mapping[str, None], *, over_links: bool
) -> tuple[tuple[FiringArc, ...], tuple[FiringArc, ...]]:
    """Return the arcs that come from the core, and those from elsewhere."""
    arcs = tuple(firing_arcs)
    inner_arcs = tuple(each for each in arcs if _is_inside(system, each.arc, members, over_links=over_links))
    return inner_arcs, tuple(each for each in arcs if not _is_inside(system, each.arc, members, over_links=over_links))


def _is_inside(system: TimingSystem, arc: Arc, members: Mapping[str, None], *, over_links: bool) -> bool:
    """Whether an arc lies inside the core, and is taken at the very end of its source (or while that runs)."""
    # What a declared response ends with may have left the core in between. (What waits for a resource is no member of
    # a part with triggers inside.)
    if arc.source not in members or system.activities[arc.source].response is not None:
        return False
    if over_links:
        return arc.role == "data" and arc.worst is not None
    return arc.link is None and arc.worst == 0


def _is_fired_by_arcs(system: TimingSystem, triggers: TriggerGraph, name: str) -> bool:
    """Whether what fires an activity is known arc by arc: it is no timer, and nothing unknown may fire it too."""
    activity = system.activities[name]
    if activity.mode == "match":
        # What is matched may have come long before: the matches have an event model of their own.
        return False
    if has_own_rate(activity) or activity.jitter or name in triggers.never_firing or name in triggers.unknown_rates:
        return False
    if activity.behaviour not in {"event", "on_demand"}:
        return False
    outside_inputs = system.external_inputs.get(name, ())
    inputs = triggers.inputs[name]
    if any(is_taken_answer(arc) for arcs in inputs.values() for arc in arcs):
        return False  # as often as its client asks, and not as its server works
    if any(not arcs or key in outside_inputs for key, arcs in inputs.items()):
        return False
    return bool(inputs or triggers.requests[name])


def _firing_arcs(system: TimingSystem, triggers: TriggerGraph, name: str) -> Iterator[FiringArc]:
    """Yield the arcs that fire an activity; of what it waits for together, not those that are always there."""
    inputs = _needed_inputs(system, triggers, name) or triggers.inputs[name]
    for key, arcs in inputs.items():
        if (name, key) not in triggers.open_inputs:
            yield from map(FiringArc, arcs)
    for arc in triggers.requests[name]:
        calls = calls_per_activation(system.activities[arc.source], arc)
        if calls > 0:
            yield FiringArc(arc, calls)


def _needed_inputs(system: TimingSystem, triggers: TriggerGraph, name: str) -> dict[str, tuple[Arc, ...]]:
    """Return the inputs that an activity waits for together, none where any of its inputs fires it."""
    activity: Activity = system.activities[name]
    if activity.mode != "all":
        return {}
    return {
        key: arcs
        for key, arcs in triggers.inputs[name].items()
        if not any(system.activities[arc.source].behaviour == "once" for arc in arcs)
    }
