"""What the events that enter a core ask of it: the work of everything that each of them leads to there.

At the start of a busy period nothing waits, so that no cascade is half done: the work in a window is that of the whole
cascades of all events that come in it. It rests on no response time of the core itself, which is why the busy period of
a chain of callbacks is found at once, and is not longer than their work.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction

from archgen.timing.figures.timing_values import UnknownCause, sum_fractions, sum_ratios
from archgen.timing.load.busy_windows import SHARE_BITS, ActivityWork, DemandFunction, GrowingLoad, add_demands
from archgen.timing.load.event_streams import EventStreams, max_arrivals
from archgen.timing.load.inner_triggers import FiringArc
from archgen.timing.load.level_cascades import ONCE_ORIGIN, EventOrigin, LevelCascades

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
