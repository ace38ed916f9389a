"""What a run starts from takes as long as the plan is: it starts again for each seed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from archgen.simulation.plan_builder import build_plan
from archgen.simulation.run_state import WireStates
from archgen.simulation.simulation_plan import PlannedCallback
from tests.simulation.systems import arc, event, system, timed


class _Counted(tuple[PlannedCallback, ...]):
    """Counts who is asked for while somebody goes through all."""

    __slots__ = ()
    asked_for = 0

    def __iter__(self) -> Iterator[PlannedCallback]:
        """Yield each."""
        for callback in super().__iter__():
            type(self).asked_for += 1
            yield callback


def _count_callbacks(reader_count: int) -> int:
    names = [f"r{number}" for number in range(reader_count)]
    plan = build_plan(
        system([timed("cam", 100, 1), *(event(name, 1, "cam") for name in names)], [arc("cam", name) for name in names])
    )
    _Counted.asked_for = 0
    assert WireStates(replace(plan, callbacks=_Counted(plan.callbacks)), ()).keeps_order == [True] * reader_count
    return _Counted.asked_for


def test_no_wire_goes_through_all_callbacks() -> None:
    assert _count_callbacks(40) <= 2 * _count_callbacks(20)
