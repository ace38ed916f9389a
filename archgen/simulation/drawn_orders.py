"""The orders in which a run let things wait where nobody wrote one: what it shows can happen, but only in these orders."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from typing import NamedTuple

from archgen.simulation.executor_state import (
    FAVOURED_OTHERS,
    FIRST_FIRST,
    FIXED_RANKS,
    LAST_FIRST,
    RANDOM_ORDER,
    WAIT_SET,
)
from archgen.simulation.simulation_run import SimulationRun

_ORDER_WORDS = {
    WAIT_SET: "in rounds, as ROS 2 does",
    FIRST_FIRST: "first come, first served",
    LAST_FIRST: "last come, first served",
    RANDOM_ORDER: "at random",
    FIXED_RANKS: "by ranks",
}


class DrawnOrder(NamedTuple):
    """Who goes first at a place (`navbox`, `pc`, `gpu`), in words, where several wait there and no order is written."""

    place: str
    words: str


def describe_orders(orders: Iterable[DrawnOrder]) -> str:
    """Write orders in one line: `navbox, base in rounds, as ROS 2 does; pc by ranks`; empty where there are none."""
    places_by_words: dict[str, list[str]] = {}
    for order in orders:
        places_by_words.setdefault(order.words, []).append(order.place)
    return "; ".join(f"{', '.join(dict.fromkeys(places))} {words}" for words, places in places_by_words.items())


def list_drawn_orders(run: SimulationRun, activities: Collection[int]) -> tuple[DrawnOrder, ...]:
    """Return the orders of the executors, hosts and resources that some activities come to, in this sequence."""
    return tuple(
        dict.fromkeys(
            (
                *_list_executor_orders(run, activities),
                *_list_host_orders(run, activities),
                *_list_resource_orders(run, activities),
            )
        )
    )


def _list_executor_orders(run: SimulationRun, activities: Collection[int]) -> Iterator[DrawnOrder]:
    plan, executors = run.plan, run.executors
    visited = {callback.executor for callback in plan.callbacks if callback.activity in activities}
    for number, planned in enumerate(plan.executors):
        # The rounds of ROS 2 are named where they are written too: in them the order of creation is drawn.
        is_open = planned.order in {None, "ros2_executor"}
        if number in visited and is_open and len(executors.callbacks[number]) > 1:
            words = _describe_order(run, executors.order[number], executors.victim[number])
            yield DrawnOrder(planned.id.partition(" ")[2], words)


def _list_host_orders(run: SimulationRun, activities: Collection[int]) -> Iterator[DrawnOrder]:
    plan, processors = run.plan, run.processors
    visited = {plan.activities[activity].processor for activity in activities}
    for number, processor in enumerate(plan.processors):
        if number in visited and processor.host and processor.order is None:
            members = (each.executor for each in plan.callbacks if plan.activities[each.activity].processor == number)
            words = _describe_order(run, processors.scheduler[number], processors.victim[number])
            has_priorities = any(each.priority is not None for each in plan.activities if each.processor == number)
            if sum(plan.executors[executor].threads for executor in dict.fromkeys(members)) > processor.cores:
                yield DrawnOrder(processor.name, f"by priority, then {words}" if has_priorities else words)


def _list_resource_orders(run: SimulationRun, activities: Collection[int]) -> Iterator[DrawnOrder]:
    plan, resources = run.plan, run.resources
    visited = {use[0] for activity in activities for use in plan.activities[activity].uses}
    for number, planned in enumerate(plan.resources):
        users = [each for each in plan.activities if any(use[0] == number for use in each.uses)]
        if number in visited and planned.order is None and len(users) > 1:
            yield DrawnOrder(planned.id, _describe_order(run, resources.order[number], resources.victim[number]))


def _describe_order(run: SimulationRun, order: int, victim: int) -> str:
    if order == FAVOURED_OTHERS:
        return f"with {run.plan.activities[victim].id} after all others"
    return _ORDER_WORDS[order]
