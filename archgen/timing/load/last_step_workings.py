"""How a figure comes about of a way whose last step has a response of its own: the time to the step before, and that response."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from archgen.timing.load.run_ways import EntryWay
from archgen.timing.load.work_terms import FigureWorking, choose_working


def add_last_step(
    way: EntryWay,
    ways_before: Iterable[EntryWay],
    response: int | None,
    list_delays: Callable[[EntryWay], Iterable[FigureWorking]],
    list_responses: Callable[[int], Iterable[FigureWorking]],
) -> Iterator[FigureWorking]:
    """Yield the working of a way's delay as a sum, where it is the delay of the way before plus the last response (ticks).

    `ways_before` lead to the step before the last one; `list_delays` and `list_responses` offer workings of the two parts.
    """
    way_before = next((each for each in ways_before if each.entry == way.entry and each.steps == way.steps[:-1]), None)
    if way_before is None or way_before.delay is None or response is None or way_before.delay + response != way.delay:
        return
    first = choose_working(list_delays(way_before), way_before.delay)
    last = choose_working(list_responses(response), response)
    if first and last:
        yield FigureWorking(first.value + last.value, 0, (), steps=way.steps, addends=(first, last))
