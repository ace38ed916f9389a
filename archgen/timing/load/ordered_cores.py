"""What an order that is written makes of a core, or a thread, whose callbacks fire one another."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction

from archgen.frozen import dataclass
from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.busy_windows import SearchBudget
from archgen.timing.load.event_streams import EventStream, EventStreams, delay_streams, streams_of_calls
from archgen.timing.load.inner_triggers import InnerTriggers
from archgen.timing.load.level_cascades import EventOrigin
from archgen.timing.load.queue_orders import QueueBound, share_rounds
from archgen.timing.load.queue_responses import CoreQueue
from archgen.timing.load.run_ways import EntryWay
from archgen.timing.load.thread_work import WorstResponse


@dataclass(frozen=True, slots=True)
class OrderedCore:
    """A queue with the ways that lead to what waits in it, and how long any order may make them."""

    queue: CoreQueue
    inner_triggers: InnerTriggers
    find_model: Callable[[EventOrigin], EventStreams | UnknownCause]
    ways_to: dict[str, tuple[EntryWay, ...]]

    def limit(
        self, responses: dict[str, WorstResponse], busy_period: int, budget: SearchBudget
    ) -> dict[str, QueueBound]:
        """Limit responses to what the order makes of them, and in rounds also ways; return the bounds that it gives."""
        if self.queue.works_in_rounds:
            bounds = dict(self._bound_rounds(budget))
        else:
            bounds = self.queue.bound_responses(self.find_activation_model, busy_period, budget)
        for name, bound in bounds.items():
            responses[name] = responses[name].limit_to(bound.response, self.queue.order)
        return bounds

    def _bound_rounds(self, budget: SearchBudget) -> Iterator[tuple[str, QueueBound]]:
        """Yield the bounds of rounds, each behind what fires it, and limit the ways: a run goes on by a step in each round."""
        for name in self.inner_triggers.order:
            task = next(each for each in self.queue.tasks if each.name == name)
            is_taken = self._is_taken_in_next_round(name)
            bound = (
                share_rounds(self.queue.tasks, 2)
                if is_taken
                else self.queue.bound_rounds(task, self.find_activation_model(name), budget)
            )
            if bound is None:
                continue
            yield name, bound
            ways: list[EntryWay] = []
            for way in self.ways_to[name]:
                before = self._delay_before(way) if len(way.steps) > 1 else 0
                rounds = None if before is None else before + (bound.response // 2 if is_taken else bound.response)
                delays = [each for each in (way.delay, rounds) if each is not None]
                ways.append(way._replace(delay=min(delays, default=None)))
            self.ways_to[name] = tuple(ways)

    def _is_taken_in_next_round(self, name: str) -> bool:
        """Whether each message that fires an activity comes from here, at most one in a round, and is never overwritten.

        One more may come before its turn in the next round: queues keep two. With a depth of 1 it takes the other's place.
        """
        firing_arcs = self.inner_triggers.inner_arcs.get(name, ())
        arcs = [arc for arc, _ in firing_arcs]
        return (
            bool(arcs)
            and not self.inner_triggers.outer_arcs.get(name)
            and all(len(way.steps) > 1 for way in self.ways_to[name])
            and all(
                calls <= 1 and self.queue.brings_one_a_round(arc, arcs) and (arc.depth is None or arc.depth > 1)
                for arc, calls in firing_arcs
            )
        )

    def find_activation_model(self, name: str) -> EventStreams | UnknownCause:
        """Return the event model of an activity's activations: what enters, behind the steps before it."""
        # These are delayed by at most as much as any order may delay them: nothing here rests on the order itself.
        if name in self.inner_triggers.silent_ids:
            return ()
        streams: list[EventStream] = []
        for way in self.ways_to[name]:
            if way.entry.kind == "activity" and str(way.entry.key) not in self.inner_triggers.entry_ids:
                return UnknownCause((name,))  # behind a gate
            model = self.find_model(way.entry)
            delay = self._delay_before(way) if len(way.steps) > 1 else 0
            if isinstance(model, UnknownCause) or delay is None:
                return UnknownCause((name,))
            model = streams_of_calls(model, Fraction(way.multiplicity)) if way.multiplicity > 1 else model
            streams += delay_streams(model, max(delay - way.best_before, 0))
        return tuple(streams)

    def _delay_before(self, way: EntryWay) -> int | None:
        """Return how long the way to the step before the last one of a way takes at most."""
        return next(
            each.delay
            for each in self.ways_to[way.steps[-2]]
            if each.entry == way.entry and each.steps == way.steps[:-1]
        )
