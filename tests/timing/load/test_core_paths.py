"""What counts for some steps on cores that share their work."""

from __future__ import annotations

from archgen.timing.load.core_paths import CorePaths
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
