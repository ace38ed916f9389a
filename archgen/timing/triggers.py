"""Who fires whom: the arcs that trigger, and the rings among them.

An event that enters a ring of any-of triggers circulates for ever. Activities that wait for all of several inputs, one
of which they feed themselves, wait for ever.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping

from archgen.frozen import dataclass
from archgen.timing.rings import components
from archgen.timing.system import Activity, Arc, System


@dataclass(frozen=True, slots=True)
class Triggers:
    """What fires each activity. `inputs`: the arcs into each trigger input (none: fed from outside, or by nobody).

    `unknown_rates` are activities in rings whose rate cannot be determined; `order` has each activity behind those that
    fire it.
    """

    inputs: Mapping[str, Mapping[str, tuple[Arc, ...]]]
    requests: Mapping[str, tuple[Arc, ...]]
    order: tuple[str, ...]
    unknown: frozenset[str]
    open: frozenset[tuple[str, str]]
    """Inputs (activity, key) of all-of triggers that close a ring: their other inputs decide how often they fire."""
    never: frozenset[str]
    """Activities that never fire."""
    endless: tuple[tuple[str, ...], ...]
    deadlocked: tuple[tuple[str, ...], ...]


def triggers(system: System) -> Triggers:
    """Find what fires what, the order to propagate in, and the rings."""
    inputs = {a.id: _inputs(system, a) for a in system.activities.values()}
    requests = {a.id: _requests(system, a) for a in system.activities.values()}
    found = _Finding(system, inputs, requests)
    after = found.after()
    rings = components(system.activities, after.__getitem__)
    whole = {member: ring for ring in rings for member in ring}
    # An all-of activity that also waits for an input from outside of its ring fires no more often than that input, so
    # its ring neither runs for ever nor lacks a rate. Leaving out the gated inputs opens such rings, and the order is
    # found anew.
    gated = {name: keys for name in system.activities if (keys := found.gates(name, whole[name]))}
    open_ = frozenset((name, key) for name, keys in gated.items() for key in keys)
    cut = found.after(open_) if open_ else after
    order = components(system.activities, cut.__getitem__) if open_ else rings
    unknown = {member for ring in order if found.is_ring(ring, cut) for member in ring}
    # From here on only what is wrong: activities that never fire, rings that never rest.
    firing = found.firing()
    return Triggers(
        inputs,
        requests,
        tuple(member for ring in order for member in ring),
        frozenset(unknown),
        open_,
        frozenset(system.activities) - firing,
        tuple(found.endless(frozenset(gated), firing)) if unknown else (),
        tuple(found.deadlocked(firing)) if len(firing) < len(system.activities) else (),
    )


def states_itself(activity: Activity) -> bool:
    """Whether an activity's rate is its own, so that nothing that arrives changes it."""
    # Also event-driven activities that state a period: the declared rate is propagated, and the derived one only
    # reported.
    return activity.behaviour in {"periodic", "once", None} or activity.period is not None


def _inputs(system: System, activity: Activity) -> dict[str, tuple[Arc, ...]]:
    """Return the arcs into each input that fires an activity."""
    if activity.behaviour != "event":
        # All-of does not wait for an optional input that nothing feeds; with any-of an unfed input changes nothing
        # anyway.
        return {}
    found: dict[str, list[Arc]] = {key: [] for key in activity.triggers}
    for arc in system.into.get(activity.id, ()):
        if arc.role == "data" and arc.input in found:
            found[arc.input].append(arc)
    waits_for_all = activity.mode == "all"
    outside = system.external.get(activity.id, ())
    return {
        key: tuple(arcs)
        for key, arcs in found.items()
        if arcs or not waits_for_all or key in outside or key not in system.optional
    }


def _requests(system: System, activity: Activity) -> tuple[Arc, ...]:
    """Return the calls that fire an activity. A periodic server looks for calls when it runs, so that none fires it."""
    if activity.behaviour not in {"event", "on_demand"}:
        return ()
    return tuple(arc for arc in system.into.get(activity.id, ()) if arc.role == "request")


@dataclass(frozen=True, slots=True)
class _Finding:
    """The system and its triggers, with the questions that `find_triggers` asks of them."""

    system: System
    inputs: Mapping[str, Mapping[str, tuple[Arc, ...]]]
    requests: Mapping[str, tuple[Arc, ...]]

    def after(self, left_out: frozenset[tuple[str, str]] = frozenset()) -> dict[str, list[str]]:
        """Return the activities that each activity fires, apart from the inputs that are left out."""
        found: dict[str, list[str]] = {name: [] for name in self.system.activities}
        for arc in self._arcs():
            if (arc.target, arc.input) not in left_out:
                found[arc.source].append(arc.target)
        return found

    def _arcs(self) -> Iterator[Arc]:
        """Yield the arcs that fire an activity whose rate is not its own."""
        for name, activity in self.system.activities.items():
            if not states_itself(activity):
                for arcs in self.inputs[name].values():
                    yield from arcs
                yield from self.requests[name]

    def is_ring(self, members: tuple[str, ...], after: Mapping[str, list[str]]) -> bool:
        """Whether a strong component holds a loop: several members, or one that fires itself."""
        return len(members) > 1 or members[0] in after[members[0]]

    def gates(self, name: str, ring: tuple[str, ...]) -> tuple[str, ...]:
        """Return the inputs by which a ring enters an all-of activity that also waits for something from outside."""
        activity = self.system.activities[name]
        if activity.mode != "all" or states_itself(activity):
            return ()
        members = set(ring)
        within = tuple(k for k, arcs in self.inputs[name].items() if any(arc.source in members for arc in arcs))
        return within if len(within) < len(self._needed(name)) else ()

    def _needed(self, name: str) -> tuple[str, ...]:
        """Return the inputs that all-of really waits for: what is sent once and kept is always there."""
        return tuple(key for key, arcs in self.inputs[name].items() if not any(self._once(arc) for arc in arcs))

    def _once(self, arc: Arc) -> bool:
        """Whether an arc's source publishes only once, at the start."""
        return self.system.activities[arc.source].behaviour == "once"

    def firing(self) -> frozenset[str]:
        """Return all activities that can ever fire; what is unknown is taken to fire."""
        readers: dict[str, list[str]] = defaultdict(list)
        for arc in self._arcs():
            readers[arc.source].append(arc.target)
        # The least set closed under `_can_fire`: an activity is looked at again whenever one that feeds it joins the
        # set.
        found = set[str]()
        waiting = list(self.system.activities)[::-1]  # popped from the end: sources first, as a rule
        while waiting:
            name = waiting.pop()
            if name not in found and self._fires(name, found):
                found.add(name)
                waiting += readers[name]
        return frozenset(found)

    def _fires(self, name: str, firing: set[str]) -> bool:
        """Whether an activity can fire, given those known to fire so far."""
        activity = self.system.activities[name]
        if states_itself(activity) or any(arc.source in firing for arc in self.requests[name]):
            return True
        if activity.behaviour == "on_demand":
            # On demand without a known caller: somebody outside may call it.
            return not self.requests[name]
        fed = [self._fed(name, key, arcs, firing) for key, arcs in self.inputs[name].items()]
        return not fed or (all(fed) if activity.mode == "all" else any(fed))

    def _fed(self, name: str, key: str, arcs: tuple[Arc, ...], firing: set[str]) -> bool:
        """Whether something can arrive at an input, given those known to fire so far."""
        if key in self.system.external.get(name, ()):
            return True
        # An unfed input of all-of is what keeps it from firing; of any-of it proves nothing, so the activity is taken
        # to fire.
        if not arcs:
            return self.system.activities[name].mode == "any"
        return any(arc.source in firing for arc in arcs)

    def endless(self, gated: frozenset[str], firing: frozenset[str]) -> Iterator[tuple[str, ...]]:
        """Yield the rings in which each event makes at least one more.

        What is conditional may end, and what never fires does not begin.
        """
        after: dict[str, list[str]] = {name: [] for name in self.system.activities}
        for arc in self._arcs():
            if arc.target not in gated and self._sure(arc) and self._starts(arc.target, firing):
                after[arc.source].append(arc.target)
        for ring in components(self.system.activities, after.__getitem__):
            if self.is_ring(ring, after):
                yield ring

    def _starts(self, name: str, firing: frozenset[str]) -> bool:
        """Whether a ring through this activity can begin to run."""
        return name in firing or self.system.activities[name].mode == "any"

    def _sure(self, arc: Arc) -> bool:
        """Whether each activation of the source surely fires the target."""
        source, target = self.system.activities[arc.source], self.system.activities[arc.target]
        if arc.role == "request":
            return source.calls.get(arc.output, 1) >= 1
        # Every n-th or fewer than one call per activation: the event dies out after some rounds.
        return target.every == 1 and arc.output not in source.conditional

    def deadlocked(self, firing: frozenset[str]) -> Iterator[tuple[str, ...]]:
        """Yield the rings that never fire, and activities that wait for an input which nothing feeds."""
        after: dict[str, list[str]] = {name: [] for name in self.system.activities}
        for arc in self._arcs():
            if arc.source not in firing and arc.target not in firing:
                after[arc.source].append(arc.target)
        for ring in components(self.system.activities, after.__getitem__):
            if ring[0] in firing:
                continue
            waits = any(self.system.activities[name].mode == "all" for name in ring)
            if (waits and self.is_ring(ring, after)) or any(self.unfed(name) for name in ring):
                yield ring

    def unfed(self, name: str) -> tuple[str, ...]:
        """Return the inputs that all-of waits for and nothing feeds."""
        if self.system.activities[name].mode != "all":
            return ()
        outside = self.system.external.get(name, ())
        return tuple(key for key, arcs in self.inputs[name].items() if not arcs and key not in outside)
