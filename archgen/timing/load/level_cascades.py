"""The cascades of a core: what each event that enters it leads to there, level of urgency by level of urgency.

The ways on which events reach the activities of a core, from where they enter it, and how long they take at most.

What the events that enter a core ask of it: the work of everything that each of them leads to there.

At the start of a busy period nothing waits, so that no cascade is half done: the work in a window is that of the whole
cascades of all events that come in it. It rests on no response time of the core itself, which is why the busy period of
a chain of callbacks is found at once, and is not longer than their work.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from fractions import Fraction
from typing import Literal

from archgen.frozen import NamedTuple
from archgen.timing.figures.timing_values import UnknownCause, sum_fractions, sum_ratios
from archgen.timing.load.busy_windows import SHARE_BITS, ActivityWork, DemandFunction, GrowingLoad, add_demands
from archgen.timing.load.event_streams import MAX_STREAMS, EventStreams, max_arrivals
from archgen.timing.load.inner_triggers import FiringArc, InnerTriggers
from archgen.timing.system.timing_system import Arc, TimingSystem


class EventOrigin(NamedTuple):
    """Where activations come from, by an activity's id or a number.

    `activity`: events as that activity's own event model says. `arc`: what comes on an arc from elsewhere. `once`: the one
    event that less urgent work may have made at the very start of a busy period. `gate`: where not each event leads on
    (`every`, `throttle`, all-of, calls in some activations only).
    """

    kind: Literal["activity", "arc", "once", "gate"]
    key: str | int


Multiplicities = dict[EventOrigin, int]
"""How many activations each event of an origin makes."""
ONCE_ORIGIN = EventOrigin("once", 0)


class GateRule(NamedTuple):
    """How many events a gate lets through: of each input's (`inputs`) `every` n-th, not closer than `throttle` (ticks).

    Where several `inputs` are waited for together, one event of each may have come before. `calls` is the number of
    calls for each event.
    """

    inputs: tuple[Multiplicities, ...]
    every: int = 1
    throttle: int = 0
    calls: Fraction = Fraction(1)
    is_complete: bool = True

    def count_leaving(self, input_counts: Sequence[int], window: int) -> int:
        """Return the most events that leave in a window (ticks), for those that arrive at each input."""
        passed = _count_all_of(input_counts, is_complete=self.is_complete)
        passed = -(-passed * self.calls.numerator // self.calls.denominator)
        passed = -(-passed // self.every)
        return min(passed, -(-window // self.throttle)) if self.throttle else passed

    def limit_rate(self, input_rates: Sequence[Fraction]) -> Fraction:
        """Return the most events that leave per tick in the long run."""
        rate = min(input_rates) * self.calls / self.every
        return min(rate, Fraction(1, self.throttle)) if self.throttle else rate


def _count_all_of(input_counts: Sequence[int], *, is_complete: bool) -> int:
    if len(input_counts) == 1 and is_complete:
        return input_counts[0]
    # Each input may hold one event from before; not all of them do, or they would have been used.
    calmest = min(input_counts) + 1
    return min(calmest, max(input_counts)) if is_complete else calmest


class LevelCascades(NamedTuple):
    """What counts at one level of urgency: the work of each origin's events (ticks), and the rules of the gates.

    `activations` are those of each activity, by origin.
    """

    volumes: Mapping[EventOrigin, int]
    gate_rules: Sequence[GateRule]
    activations: Mapping[str, Multiplicities]
    unknown_costs: tuple[str, ...]


def build_level_cascades(
    system: TimingSystem,
    inner_triggers: InnerTriggers,
    arc_numbers: Mapping[int, int],
    level_ids: Collection[str],
    foreign_ids: Iterable[str],
) -> LevelCascades:
    """Return the cascades of all events of a core, cut down to what counts at a level (`level_ids`).

    `foreign_ids` work elsewhere too: what they fire here comes from outside. `arc_numbers` has a number for the arcs that
    enter, by identity.
    """
    builder = _LevelBuilder(system, inner_triggers, arc_numbers, frozenset(level_ids))
    for name in inner_triggers.order:
        if name in builder.level_ids:
            builder.activations[name] = builder.count_activations(name)
    for name in foreign_ids:
        if name in builder.level_ids:
            builder.activations[name] = {EventOrigin("activity", name): 1}
    return builder.sum_volumes()


class _LevelBuilder:
    def __init__(
        self,
        system: TimingSystem,
        inner_triggers: InnerTriggers,
        arc_numbers: Mapping[int, int],
        level_ids: frozenset[str],
    ) -> None:
        self.system = system
        self.inner_triggers = inner_triggers
        self.arc_numbers = arc_numbers
        self.level_ids = level_ids
        self.activations: dict[str, Multiplicities] = {}
        self.gate_rules: list[GateRule] = []

    def count_activations(self, name: str) -> Multiplicities:
        """Return the activations of an activity by origin; those of what fires it are known."""
        if name in self.inner_triggers.entry_ids:
            return {EventOrigin("activity", name): 1}
        activity = self.system.activities[name]
        firing_arcs = (*self.inner_triggers.inner_arcs[name], *self.inner_triggers.outer_arcs[name])
        data_arcs = [each for each in firing_arcs if each.arc.role == "data"]
        gated_inputs = self.inner_triggers.gated_inputs.get(name)
        inputs = gated_inputs if gated_inputs is not None else ((tuple(data_arcs),) if data_arcs else ())
        fired: Multiplicities = {}
        if inputs:
            rule = GateRule(
                tuple(self._sum_arcs(arcs) for arcs in inputs),
                activity.every,
                activity.throttle,
                is_complete=gated_inputs is None or name in self.inner_triggers.complete_gates,
            )
            is_plain = len(rule.inputs) == 1 and rule.is_complete and activity.every == 1 and not activity.throttle
            fired = rule.inputs[0] if is_plain else {self._add_gate(rule): 1}
        calls = self._sum_arcs(tuple(each for each in firing_arcs if each.arc.role == "request"))
        return _add_multiplicities((fired, 1), (calls, 1))

    def _sum_arcs(self, firing_arcs: Iterable[FiringArc]) -> Multiplicities:
        return _add_multiplicities(*(self._count_on_arc(each) for each in firing_arcs))

    def _count_on_arc(self, firing_arc: FiringArc) -> tuple[Multiplicities, int]:
        arc, calls = firing_arc
        number = self.arc_numbers.get(id(arc))
        if number is not None:
            return {EventOrigin("arc", number): 1}, 1
        if arc.source in self.inner_triggers.silent_ids:
            return {}, 1
        if arc.source not in self.level_ids:
            # It cannot run while this level keeps the core busy: it may have ended, or made its calls, just before.
            return {ONCE_ORIGIN: 1}, -(-calls.numerator // calls.denominator)
        source_activations = self.activations[arc.source]
        if calls.denominator == 1:
            return source_activations, calls.numerator
        return {self._add_gate(GateRule((source_activations,), calls=calls)): 1}, 1

    def _add_gate(self, rule: GateRule) -> EventOrigin:
        self.gate_rules.append(rule)
        return EventOrigin("gate", len(self.gate_rules) - 1)

    def sum_volumes(self) -> LevelCascades:
        """Return the level, with the work that each origin's events make."""
        volumes: dict[EventOrigin, int] = {}
        unknown_costs: list[str] = []
        for name, activations in self.activations.items():
            cost = self.system.activities[name].wcet
            if cost is None:
                unknown_costs.append(name)
            elif cost:
                for origin, multiplicity in activations.items():
                    volumes[origin] = volumes.get(origin, 0) + cost * multiplicity
        return LevelCascades(volumes, tuple(self.gate_rules), self.activations, tuple(unknown_costs))


def _add_multiplicities(*terms: tuple[Multiplicities, int]) -> Multiplicities:
    """Return the sum of terms, each so many times."""
    if len(terms) == 1 and terms[0][1] == 1:
        return terms[0][0]
    total: Multiplicities = {}
    for multiplicities, factor in terms:
        for origin, multiplicity in multiplicities.items():
            total[origin] = total.get(origin, 0) + multiplicity * factor
    return total


def number_arcs(inner_triggers: InnerTriggers) -> tuple[dict[int, int], tuple[FiringArc, ...]]:
    """Return the arcs that enter a core, and their numbers by identity: arcs are large to compare."""
    entering_arcs: list[FiringArc] = []
    numbers: dict[int, int] = {}
    for firing_arcs in inner_triggers.outer_arcs.values():
        for firing_arc in firing_arcs:
            numbers[id(firing_arc.arc)] = len(entering_arcs)
            entering_arcs.append(firing_arc)
    return numbers, tuple(entering_arcs)


Priority = int | None
"""A level of urgency: all threads of this priority or a higher one, None all threads."""


class EntryWay(NamedTuple):
    """A way from where an event enters a core to an activity: each step fires at the end of the one before, for it alone.

    `steps` are the activities, the last one included. Each event comes `multiplicity` times. The last activity starts
    `best_before` (ticks) after the event at the earliest, and ends `delay` (ticks) after it at the latest: None where
    that is not bounded. `entry_arc` is the arc by which the event comes, None where the first step has events of its own.
    Of a way over hosts the links take `link_time` at most, all together.
    """

    entry: EventOrigin
    entry_arc: FiringArc | None
    steps: tuple[str, ...]
    multiplicity: int = 1
    best_before: int = 0
    delay: int | None = None
    link_time: int = 0


def begin_way(name: str) -> EntryWay:
    """Return the way to an activity that has events of its own."""
    return EntryWay(EventOrigin("activity", name), None, (name,))


def find_entry_ways(
    system: TimingSystem, inner_triggers: InnerTriggers, arc_numbers: Mapping[int, int]
) -> dict[str, tuple[EntryWay, ...]]:
    """Return the ways to each activity of a core. One with too many, or behind a gate, begins a way of its own."""
    ways_to: dict[str, tuple[EntryWay, ...]] = {}
    for name in inner_triggers.order:
        ways_to[name] = _find_ways_to(system, inner_triggers, arc_numbers, name, ways_to) or (begin_way(name),)
    return ways_to


def _find_ways_to(
    system: TimingSystem,
    inner_triggers: InnerTriggers,
    arc_numbers: Mapping[int, int],
    name: str,
    ways_to: Mapping[str, tuple[EntryWay, ...]],
) -> tuple[EntryWay, ...]:
    """Return the ways to an activity that each event takes, none where not each event fires it."""
    if name in inner_triggers.entry_ids or is_gate(system, inner_triggers, name):
        return ()
    ways = [
        EntryWay(EventOrigin("arc", arc_numbers[id(each.arc)]), each, (name,))
        for each in inner_triggers.outer_arcs[name]
    ]
    for arc, calls in inner_triggers.inner_arcs[name]:
        if arc.source in inner_triggers.silent_ids:
            continue
        # A call may come as soon as its caller starts, data at its end.
        best_case = 0 if arc.role == "request" else (system.activities[arc.source].bcet or 0) + (arc.best or 0)
        ways += [
            way._replace(
                steps=(*way.steps, name),
                multiplicity=way.multiplicity * int(calls),
                best_before=way.best_before + best_case,
                link_time=way.link_time + (arc.worst or 0),
            )
            for way in ways_to[arc.source]
        ]
        if len(ways) > MAX_STREAMS:
            return ()
    return tuple(ways)


def find_run_arcs(
    inner_triggers: InnerTriggers, ways_to: Mapping[str, tuple[EntryWay, ...]]
) -> dict[str, tuple[Arc, ...]]:
    """Return the arcs by which a way goes on to each activity from another one of its core."""
    return {
        name: tuple(firing_arc.arc for firing_arc in firing_arcs)
        for name, firing_arcs in inner_triggers.inner_arcs.items()
        # What begins a way of its own is reached by none that began before.
        if firing_arcs and ways_to[name][0].entry != EventOrigin("activity", name)
    }


def is_gate(system: TimingSystem, inner_triggers: InnerTriggers, name: str) -> bool:
    """Whether not each event that arrives at an activity fires it."""
    activity = system.activities[name]
    gated_inputs = inner_triggers.gated_inputs.get(name)
    if gated_inputs is not None and (len(gated_inputs) > 1 or name not in inner_triggers.complete_gates):
        return True
    if activity.every > 1 or activity.throttle:
        return True
    return any(firing_arc.calls.denominator != 1 for firing_arc in inner_triggers.inner_arcs[name])


ModelFinder = Callable[[EventOrigin], EventStreams | UnknownCause]
"""Finds the event model of what enters a core."""
ArcModelFinder = Callable[[EventOrigin, FiringArc | None], EventStreams | UnknownCause]
"""The same, told the arc by which it enters, where there is one."""


def look_up_arcs(model_of: ArcModelFinder, entering_arcs: Sequence[FiringArc]) -> ModelFinder:
    """Return what finds event models by their origins alone."""
    return lambda origin: model_of(origin, entering_arcs[int(origin.key)] if origin.kind == "arc" else None)


class CascadeDemand:
    """The demand of a level for given event models of what enters; an origin without a model has a cause instead."""

    def __init__(self, level: LevelCascades, model_of: ModelFinder) -> None:
        """Look up the event models of all that counts."""
        self.level = level
        self._streams: dict[EventOrigin, EventStreams] = {}
        self.causes: list[UnknownCause] = []
        self._rates: dict[EventOrigin, Fraction] = {ONCE_ORIGIN: Fraction(0)}
        for origin in self._find_used_origins():
            if origin.kind in {"activity", "arc"}:
                model = model_of(origin)
                if isinstance(model, UnknownCause):
                    self.causes.append(model)
                else:
                    self._streams[origin] = model

    def _find_used_origins(self) -> dict[EventOrigin, None]:
        """Return the origins that work rests on, directly or through gates."""
        pending = [origin for origin, volume in self.level.volumes.items() if volume]
        used: dict[EventOrigin, None] = {}
        while pending:
            origin = pending.pop()
            if origin in used:
                continue
            used[origin] = None
            if origin.kind == "gate":
                for multiplicities in self.level.gate_rules[int(origin.key)].inputs:
                    pending += multiplicities
        return used

    def share(self) -> Fraction:
        """Return the share of a core that all this takes in the long run; what is unknown of it counts as nothing."""
        ratios = [
            (volume * numerator, denominator)
            for origin, volume in self.level.volumes.items()
            if volume
            for numerator, denominator in [self._find_ratio(origin)]
        ]
        return Fraction(*sum_ratios(ratios))

    def _find_ratio(self, origin: EventOrigin) -> tuple[int, int]:
        """Return the rate of an origin as numerator and denominator, which may have common factors."""
        if origin.kind == "gate":
            return self.rate_of(origin).as_integer_ratio()
        return sum_ratios([stream.max_rate_ratio for stream in self._streams.get(origin, ())])

    def rate_of(self, origin: EventOrigin) -> Fraction:
        """Return the most events of an origin per tick in the long run; 0 where that is not known."""
        rate = self._rates.get(origin)
        if rate is None and origin.kind != "gate":
            rate = self._rates[origin] = Fraction(*self._find_ratio(origin))
        if rate is None:
            rule = self.level.gate_rules[int(origin.key)]
            rate = rule.limit_rate(
                [
                    sum_fractions(self.rate_of(each) * number for each, number in inputs.items())
                    for inputs in rule.inputs
                ]
            )
            self._rates[origin] = rate
        return rate

    def streams_of(self, origin: EventOrigin) -> EventStreams:
        """Return the event model of what enters."""
        return self._streams[origin]

    def list_streams(self) -> list[EventStreams]:
        """Return the event models of all that enters and makes work."""
        return list(self._streams.values())

    @property
    def has_gates(self) -> bool:
        """Whether not all work is a multiple of what enters."""
        return any(origin.kind == "gate" for origin, volume in self.level.volumes.items() if volume)

    def demand_function(self) -> DemandFunction:
        """Return the most work in a window (ticks)."""
        volumes = self.level.volumes
        demand = GrowingLoad(
            ActivityWork(volume, self._streams[origin])
            for origin, volume in volumes.items()
            if volume and origin in self._streams
        ).demand_function()
        once_work = volumes.get(ONCE_ORIGIN, 0)
        if once_work:
            demand = add_demands(demand, DemandFunction(lambda _: once_work, 0, 0, once_work << SHARE_BITS))
        gate_volumes = [
            (int(origin.key), volume) for origin, volume in volumes.items() if origin.kind == "gate" and volume
        ]
        return add_demands(demand, self._gate_demand(gate_volumes)) if gate_volumes else demand

    def _gate_demand(self, gate_volumes: Sequence[tuple[int, int]]) -> DemandFunction:
        gate_rules, streams = self.level.gate_rules, self._streams
        last_gate = max(index for index, _ in gate_volumes)
        # Gates are numbered in the order of triggers, so that each rests on earlier ones only.
        term_count = 4 * sum(len(inputs) for rule in gate_rules[: last_gate + 1] for inputs in rule.inputs)

        def work_within(window: int) -> int:
            gate_counts: list[int] = []

            def count_events(origin: EventOrigin) -> int:
                if origin.kind == "gate":
                    return gate_counts[int(origin.key)]
                return 1 if origin.kind == "once" else max_arrivals(streams.get(origin, ()), window)

            for rule in gate_rules[: last_gate + 1]:
                input_counts = [
                    sum([count_events(origin) * number for origin, number in inputs.items()]) for inputs in rule.inputs
                ]
                gate_counts.append(rule.count_leaving(input_counts, window))
            return sum([volume * gate_counts[index] for index, volume in gate_volumes])

        return DemandFunction(work_within, term_count)
