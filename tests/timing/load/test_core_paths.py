"""What counts for some steps on cores that share their work."""

from __future__ import annotations

import pytest

from archgen.timing.load.core_paths import CorePath, CorePaths
from archgen.timing.load.path_work import split_lanes
from tests.timing.load.test_idle_backlogs import in_ms, prepare

HOST = "hosts: {pc: {cores: 2}}"


def test_a_path_takes_what_its_steps_take() -> None:
    """3 + 0 + 5 ms: a step that only passes on takes nothing."""
    nodes = {
        "a @pc": "period: 100 ms, wcet: 3 ms",
        "b @pc": "behaviour: event, wcet: 0 ms",
        "c @pc": "behaviour: event, wcet: 5 ms",
    }
    cores = prepare(nodes, "a>b b>c", HOST)
    path = CorePaths(cores).look_up(("a", "b", "c"))
    assert (in_ms(cores, path.cost), path.own_cost) == (8, 0)
    assert CorePaths(cores).look_up(("b",)).cost == 0


@pytest.mark.parametrize(("widths", "works"), [((1, 1), [3, 5]), ((1, 2), [3, 3, 3]), ((2, 1), [2, 2, 5])])
def test_what_is_reentrant_counts_as_several_lanes(widths: tuple[int, ...], works: list[int]) -> None:
    path = CorePath(0, 0, None, (), (), ([0], [1]), widths, frozenset(), ())
    assert split_lanes(path, [3, 5]) == works


def test_of_the_last_step_each_activation_is_known_where_one_way_leads_to_it_or_it_is_looked_at_alone() -> None:
    """Two ways lead to c, both behind b, of s and of d; to a only one."""
    nodes = {
        "s @pc": "period: 100 ms, wcet: 1 ms",
        "d @pc": "period: 100 ms, wcet: 2 ms",
        "a @pc": "behaviour: event, wcet: 3 ms",
        "b @pc": "behaviour: event, trigger: any, wcet: 4 ms",
        "c @pc": "behaviour: event, wcet: 5 ms",
    }
    cores = prepare(nodes, "s>a s>b d>b b>c", HOST)
    steps = [("s", "a"), ("c",), ("b", "c")]
    found = {path: CorePaths(cores).look_up(path).last_step for path in steps}
    shown = {
        " ".join(path): last and (in_ms(cores, last.cost), [(each[1], each[2]) for each in last.arrivals])
        for path, last in found.items()
    }
    assert shown == {"s a": (3, [(1, None)]), "c": (5, [(1, ("b", 0)), (1, ("b", 1))]), "b c": None}
