"""Who fires whom: the arcs that trigger, and the rings among them.

An event that enters a ring of any-of triggers circulates for ever. Activities that wait for all of several inputs, one
of which they feed themselves, wait for ever.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping

from archgen.frozen import dataclass
from archgen.model.graph_search import find_strong_components, is_ring
from archgen.timing.system.timing_system import Activity, Arc, TimingSystem


@dataclass(frozen=True, slots=True)
class TriggerGraph:
    """What fires each activity. `inputs`: the arcs into each trigger input (none: fed from outside, or by nobody).

    `unknown_rates` are activities in rings whose rate cannot be determined; `order` has each activity behind those that
    fire it.
    """

    inputs: Mapping[str, Mapping[str, tuple[Arc, ...]]]
    requests: Mapping[str, tuple[Arc, ...]]
    order: tuple[str, ...]
    unknown_rates: frozenset[str]
    open_inputs: frozenset[tuple[str, str]]
    """Inputs (activity, key) of all-of triggers that close a ring: their other inputs decide how often they fire."""
    never_firing: frozenset[str]
    """Activities that never fire."""
    endless_rings: tuple[tuple[str, ...], ...]
    deadlocked_rings: tuple[tuple[str, ...], ...]


def find_triggers(system: TimingSystem) -> TriggerGraph:
    """Find what fires what, the order to propagate in, and the rings."""
    inputs = {activity.id: _trigger_inputs(system, activity) for activity in system.activities.values()}
    requests = {activity.id: _request_arcs(system, activity) for activity in system.activities.values()}
    search = _TriggerSearch(system, inputs, requests)
    successors = search.find_successors()
    rings = find_strong_components(system.activities, successors.__getitem__)
    ring_of = {member: ring for ring in rings for member in ring}
    # An all-of activity that also waits for an input from outside of its ring fires no more often than that input, so
    # its ring neither runs for ever nor lacks a rate. Leaving out the gated inputs opens such rings, and the order is
    # found anew.
    gated_inputs = {name: keys for name in system.activities if (keys := search.find_gates(name, ring_of[name]))}
    open_inputs = frozenset((name, key) for name, keys in gated_inputs.items() for key in keys)
    cut_successors = search.find_successors(open_inputs) if open_inputs else successors
    ordered_rings = find_strong_components(system.activities, cut_successors.__getitem__) if open_inputs else rings
    unknown_rates = {member for ring in ordered_rings if is_ring(ring, cut_successors) for member in ring}
    # From here on only what is wrong: activities that never fire, rings that never rest.
    firing = search.find_firing()
    return TriggerGraph(
        inputs,
        requests,
        tuple(member for ring in ordered_rings for member in ring),
        frozenset(unknown_rates),
        open_inputs,
        frozenset(system.activities) - firing,
        tuple(search.find_endless_rings(frozenset(gated_inputs), firing)) if unknown_rates else (),
        tuple(search.find_deadlocked_rings(firing)) if len(firing) < len(system.activities) else (),
    )


def has_own_rate(activity: Activity) -> bool:
    """Whether an activity's rate is its own, so that nothing that arrives changes it."""
    # Also event-driven activities that state a period: the declared rate is propagated, and the derived one only
    # reported.
    return activity.behaviour in {"periodic", "once", None} or activity.period is not None


def _trigger_inputs(system: TimingSystem, activity: Activity) -> dict[str, tuple[Arc, ...]]:
    """Return the arcs into each input that fires an activity."""
    if activity.behaviour != "event":
        # All-of does not wait for an optional input that nothing feeds; with any-of an unfed input changes nothing
        # anyway.
        return {}
    arcs_by_input: dict[str, list[Arc]] = {key: [] for key in activity.triggers}
    for arc in system.arcs_into.get(activity.id, ()):
        if arc.role == "data" and arc.input in arcs_by_input:
            arcs_by_input[arc.input].append(arc)
    waits_for_all = activity.mode != "any"
    outside = system.external_inputs.get(activity.id, ())
    return {
        key: tuple(arcs)
        for key, arcs in arcs_by_input.items()
        if arcs or not waits_for_all or key in outside or key not in system.optional_inputs
    }


def _request_arcs(system: TimingSystem, activity: Activity) -> tuple[Arc, ...]:
    """Return the calls that fire an activity. A periodic server looks for calls when it runs, so that none fires it."""
    if activity.behaviour not in {"event", "on_demand"}:
        return ()
    return tuple(arc for arc in system.arcs_into.get(activity.id, ()) if arc.role == "request")


@dataclass(frozen=True, slots=True)
class _TriggerSearch:
    """The system and its triggers, with the questions that `find_triggers` asks of them."""

    system: TimingSystem
    inputs: Mapping[str, Mapping[str, tuple[Arc, ...]]]
    requests: Mapping[str, tuple[Arc, ...]]

    def find_successors(self, left_out: frozenset[tuple[str, str]] = frozenset()) -> dict[str, list[str]]:
        """Return the activities that each activity fires, apart from the inputs that are left out."""
        successors: dict[str, list[str]] = {name: [] for name in self.system.activities}
        for arc in self._trigger_arcs():
            if (arc.target, arc.input) not in left_out:
                successors[arc.source].append(arc.target)
        return successors

    def _trigger_arcs(self) -> Iterator[Arc]:
        """Yield the arcs that fire an activity whose rate is not its own."""
        for name, activity in self.system.activities.items():
            if not has_own_rate(activity):
                for arcs in self.inputs[name].values():
                    yield from arcs
                yield from self.requests[name]

    def find_gates(self, name: str, ring: tuple[str, ...]) -> tuple[str, ...]:
        """Return the inputs by which a ring enters an all-of activity that also waits for something from outside."""
        activity = self.system.activities[name]
        if activity.mode == "any" or has_own_rate(activity):
            return ()
        members = set(ring)
        within = tuple(
            input_key for input_key, arcs in self.inputs[name].items() if any(arc.source in members for arc in arcs)
        )
        return within if len(within) < len(self._needed_inputs(name)) else ()

    def _needed_inputs(self, name: str) -> tuple[str, ...]:
        """Return the inputs that all-of really waits for: what is sent once and kept is always there."""
        activities, inputs = self.system.activities, self.inputs[name].items()
        return tuple(key for key, arcs in inputs if all(activities[arc.source].behaviour != "once" for arc in arcs))

    def find_firing(self) -> frozenset[str]:
        """Return all activities that can ever fire; what is unknown is taken to fire."""
        readers: dict[str, list[str]] = defaultdict(list)
        for arc in self._trigger_arcs():
            readers[arc.source].append(arc.target)
        # The least set closed under `_can_fire`: an activity is looked at again whenever one that feeds it joins the
        # set.
        firing_ids = set[str]()
        pending = list(self.system.activities)[::-1]  # popped from the end: sources first, as a rule
        while pending:
            name = pending.pop()
            if name not in firing_ids and self._can_fire(name, firing_ids):
                firing_ids.add(name)
                pending += readers[name]
        return frozenset(firing_ids)

    def _can_fire(self, name: str, firing: set[str]) -> bool:
        """Whether an activity can fire, given those known to fire so far."""
        activity = self.system.activities[name]
        if has_own_rate(activity) or any(arc.source in firing for arc in self.requests[name]):
            return True
        if activity.behaviour == "on_demand":
            # On demand without a known caller: somebody outside may call it.
            return not self.requests[name]
        fed_inputs = [self._is_fed(name, key, arcs, firing) for key, arcs in self.inputs[name].items()]
        return not fed_inputs or (any(fed_inputs) if activity.mode == "any" else all(fed_inputs))

    def _is_fed(self, name: str, key: str, arcs: tuple[Arc, ...], firing: set[str]) -> bool:
        """Whether something can arrive at an input, given those known to fire so far."""
        if key in self.system.external_inputs.get(name, ()):
            return True
        # An unfed input of all-of is what keeps it from firing; of any-of it proves nothing, so the activity is taken
        # to fire.
        if not arcs:
            return self.system.activities[name].mode == "any"
        return any(arc.source in firing for arc in arcs)

    def find_endless_rings(self, gated_names: frozenset[str], firing: frozenset[str]) -> Iterator[tuple[str, ...]]:
        """Yield the rings in which each event makes at least one more.

        What is conditional may end, and what never fires does not begin.
        """
        successors: dict[str, list[str]] = {name: [] for name in self.system.activities}
        for arc in self._trigger_arcs():
            if arc.target not in gated_names and self._surely_fires(arc) and self._can_start(arc.target, firing):
                successors[arc.source].append(arc.target)
        for ring in find_strong_components(self.system.activities, successors.__getitem__):
            if is_ring(ring, successors):
                yield ring

    def _can_start(self, name: str, firing: frozenset[str]) -> bool:
        """Whether a ring through this activity can begin to run."""
        return name in firing or self.system.activities[name].mode == "any"

    def _surely_fires(self, arc: Arc) -> bool:
        """Whether each activation of the source surely fires the target."""
        source, target = self.system.activities[arc.source], self.system.activities[arc.target]
        if arc.role == "request":
            return source.calls.get(arc.output, 1) >= 1
        # Every n-th or fewer than one call per activation: the event dies out after some rounds.
        return target.every == 1 and arc.output not in source.conditional

    def find_deadlocked_rings(self, firing: frozenset[str]) -> Iterator[tuple[str, ...]]:
        """Yield the rings that never fire, and activities that wait for an input which nothing feeds."""
        successors: dict[str, list[str]] = {name: [] for name in self.system.activities}
        for arc in self._trigger_arcs():
            if arc.source not in firing and arc.target not in firing:
                successors[arc.source].append(arc.target)
        for ring in find_strong_components(self.system.activities, successors.__getitem__):
            if ring[0] in firing:
                continue
            waits_for_all = any(self.system.activities[name].mode != "any" for name in ring)
            if (waits_for_all and is_ring(ring, successors)) or any(self.unfed_inputs(name) for name in ring):
                yield ring

    def unfed_inputs(self, name: str) -> tuple[str, ...]:
        """Return the inputs that all-of waits for and nothing feeds."""
        if self.system.activities[name].mode == "any":
            return ()
        outside = self.system.external_inputs.get(name, ())
        return tuple(key for key, arcs in self.inputs[name].items() if not arcs and key not in outside)
