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
    path = CorePath(0, 0, None, (), (), ([0], [1]), widths, frozenset(), {}, 2)
    assert split_lanes(path, [3, 5]) == works
