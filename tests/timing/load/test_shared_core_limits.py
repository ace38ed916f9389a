"""What bounds activities on shared cores without regard to the bounds of others: the smaller of two limits."""

from __future__ import annotations

import pytest

from archgen.timing.load.busy_windows import DivergedError, SearchBudget
from archgen.timing.load.core_paths import CorePaths
from archgen.timing.load.shared_core_limits import SharedCoreLimits, has_priorities, open_refining_budget
from archgen.timing.load.whole_hosts import HostLimit
from tests.timing.load.test_idle_backlogs import find_backlog, in_ms, prepare

HOST = "hosts: {pc: {cores: 2}}"


def test_the_smaller_limit_counts() -> None:
    """The backlog alone gives 25 ms: a host of 20 ms is less, one of 30 ms is not."""
    cores = prepare({f"n{at} @pc": "period: 100 ms, wcet: 10 ms" for at in range(3)}, "", HOST)
    ms = cores.system.activities["n0"].period or 0
    limits = SharedCoreLimits(cores.ways_to, {"n0": HostLimit(ms // 5, ms // 5), "n1": HostLimit(ms // 3, ms // 3)})
    assert [limits.has_limit(f"n{at}") for at in range(3)] == [True, True, False]
    limits.backlog = find_backlog(cores)
    assert [in_ms(cores, limits.limit_delay((f"n{at}", 0)) or 0) for at in range(3)] == [20, 25, 25]
    assert [in_ms(cores, limits.limit_response(f"n{at}") or 0) for at in range(3)] == [20, 25, 25]


@pytest.mark.parametrize(
    ("count", "priority", "is_small"), [(3, "", False), (40, "", True), (40, ", priority: 1", False)]
)
def test_large_hosts_have_next_to_nothing_for_smaller_bounds(count: int, priority: str, is_small: bool) -> None:  # noqa: FBT001
    cores = prepare({f"n{at} @pc": f"period: 100 ms, wcet: 1 ms{priority}" for at in range(count)}, "", HOST)
    assert has_priorities(cores) is bool(priority)
    whole = SearchBudget(1_000_000)
    spend = open_refining_budget(whole, CorePaths(cores), find_backlog(cores)).start_search()
    if is_small:
        with pytest.raises(DivergedError):
            spend(10_000)
    else:
        spend(10_000)
    assert whole.spent_terms == 10_000
