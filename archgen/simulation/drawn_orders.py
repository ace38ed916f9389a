"""The orders in which a run let things wait where nobody wrote one: what it shows can happen, but only in these orders."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from archgen.simulation import executor_state
from archgen.simulation.simulation_run import SimulationRun
from archgen.timing.analysis import DrawnOrder

_ORDER_WORDS = {
    executor_state.WAIT_SET: "in rounds, as ROS 2 does",
    executor_state.FIRST_FIRST: "first come, first served",
    executor_state.LAST_FIRST: "last come, first served",
    executor_state.RANDOM_ORDER: "at random",
    executor_state.FIXED_RANKS: "by ranks",
}


def describe_orders(orders: Iterable[DrawnOrder]) -> str:
    """Write orders in one line: `navbox, base in rounds, as ROS 2 does; pc by ranks`; empty where there are none."""
    places_by_words: dict[str, dict[str, None]] = {}
    for order in orders:
        places_by_words.setdefault(order.words, {})[order.place] = None
    return "; ".join(f"{', '.join(places)} {words}" for words, places in places_by_words.items())


def list_drawn_orders(run: SimulationRun, activities: Collection[int]) -> tuple[DrawnOrder, ...]:
    """Return the orders of the executors, hosts and resources that some activities come to, in this sequence."""
    names = [planned.id for planned in run.plan.activities]
    return tuple(
        DrawnOrder(
            place,
            before
            + (
                f"with {names[victim]} after all others"
                if order == executor_state.FAVOURED_OTHERS
                else _ORDER_WORDS[order]
            ),
        )
        for place, before, order, victim in _list_open_orders(run, activities)
    )


def _list_open_orders(run: SimulationRun, activities: Collection[int]) -> Iterator[tuple[str, str, int, int]]:
    """Yield where no order is written: the place, words in front, the order that was drawn, and who is last in it."""
    plan, executors, processors, resources = run.plan, run.executors, run.processors, run.resources
    visited = [plan.activities[activity] for activity in activities]
    visited_executors = {each.executor for each in plan.callbacks if each.activity in activities}
    for number, executor in enumerate(plan.executors):
        # The rounds of ROS 2 are named where they are written too: in them the order of creation is drawn.
        is_open = executor.order in {None, "ros2_executor"} and len(executors.callbacks[number]) > 1
        if is_open and number in visited_executors:
            yield executor.id.partition(" ")[2], "", executors.order[number], executors.victim[number]
    for number, processor in enumerate(plan.processors):
        members = (each.executor for each in plan.callbacks if plan.activities[each.activity].processor == number)
        thread_count = sum(plan.executors[executor].threads for executor in dict.fromkeys(members))
        is_open = processor.host is not None and processor.order is None and thread_count > processor.cores
        if is_open and any(each.processor == number for each in visited):
            ranked = any(each.priority is not None for each in plan.activities if each.processor == number)
            order = processors.scheduler[number], processors.victim[number]
            yield processor.name, "by priority, then " if ranked else "", *order
    for number, resource in enumerate(plan.resources):
        users = [each for each in plan.activities if any(use[0] == number for use in each.uses)]
        if resource.order is None and len(users) > 1 and any(each in users for each in visited):
            yield resource.id, "", resources.order[number], resources.victim[number]
