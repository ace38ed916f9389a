"""The cascades of a core: what each event that enters it leads to there, level of urgency by level of urgency."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from fractions import Fraction
from typing import Literal

from archgen.frozen import NamedTuple
from archgen.timing.load.inner_triggers import FiringArc, InnerTriggers
from archgen.timing.system.timing_system import TimingSystem


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
