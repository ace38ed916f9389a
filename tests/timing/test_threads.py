"""What runs one after the other: nodes of several components, callback groups, reentrant callbacks, threads, sets of cores."""

from __future__ import annotations

import pytest

from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from tests.property_sizes import try_some
from tests.timing.exceeded import exceeded
from tests.timing.random_systems import architecture
from tests.timing.random_threads import random_threads_text

MS = 10**6

FAST_AND_SLOW = """
groups:
  g:
    components:
      scan: {outputs: {out: D}, timing: {behaviour: periodic, period: 100 ms, wcet: 1 ms, bcet: 1 ms, priority: 90}}
      fast: {inputs: {i: g.scan.out}, timing: {wcet: 2 ms, bcet: 2 ms, priority: 50}}
      slow: {inputs: {i: g.scan.out}, timing: {wcet: 60 ms, bcet: 60 ms, priority: 10}}
types: {D: {message: std_msgs/msg/String}}
hosts: {cpu: {cores: CORES}}
containers: {box: {threads: 4, host: cpu}}
nodes:
  lidar: {implements: g.scan, host: cpu}
  both: {implements: [g.fast, g.slow], PLACE}
chains: {c: {through: [g.scan, g.fast]}}
"""


def responses_of(text: str) -> dict[str, float | None]:
    """Return the worst responses, in ms."""
    found = analyse_architecture(architecture(text)).responses
    return {name: None if r.worst.value is None else float(r.worst.value / MS) for name, r in found.items()}


def bound_of(text: str, chain: str = "c") -> float:
    """Return the bound of a chain, in ms."""
    model = architecture(text)
    bound = bound_all_chains(analyse_architecture(model), model)[chain].bound
    assert bound.complete
    return float((bound.value or 0) / MS)


@pytest.mark.parametrize(
    ("cores", "place", "fast", "chain"),
    [
        # One node is one thread, however many cores there are: who is fast may come just after who is slow.
        (4, "host: cpu", 62, 163),
        # On one core it cannot preempt itself, whatever its priorities are.
        (1, "host: cpu", 62, 163),
        # In a container of several threads its default callback group keeps them apart.
        (4, "container: box", 62, 163),
        (4, "host: cpu, threads: 2", 62, 163),
        (4, "container: box, callback_groups: {one: [fast, slow]}", 62, 163),
        (4, "host: cpu, threads: 2, callback_groups: {one: [fast], two: [slow]}", 2, 103),
        (4, "container: box, callback_groups: {one: [fast]}", 2, 103),
        # One thread runs one callback at a time, whatever the groups are.
        (4, "host: cpu, callback_groups: {one: [fast], two: [slow]}", 62, 163),
    ],
)
def test_components_of_one_node_wait_for_one_another(cores: int, place: str, fast: int, chain: int) -> None:
    text = FAST_AND_SLOW.replace("CORES", str(cores)).replace("PLACE", place)
    if cores > 1:
        text = text.replace(", priority: 50", "").replace(", priority: 10", "")
    assert (responses_of(text)["both.fast"], bound_of(text)) == (fast, chain)


def test_reentrant_callbacks_that_fill_all_threads_are_waited_for() -> None:
    """Two threads, of which `slow` may hold both where two of its jobs come at once: `fast` waits for one to end."""
    text = FAST_AND_SLOW.replace("CORES", "4").replace("PLACE", "host: cpu, threads: 2, reentrant: true")
    text = text.replace("period: 100 ms", "period: 100 ms, jitter: 100 ms")
    fast = responses_of(text)["both.fast"]
    assert fast is not None
    assert fast >= 62


ALONE = """
groups: {g: {components: {x: {outputs: {out: D}}}}}
types: {D: {message: std_msgs/msg/String}}
hosts: {cpu: {cores: 4}}
nodes: {n: {implements: g.x, host: cpu, OPTIONS timing: {behaviour: periodic, period: 10 ms, jitter: 8 ms, wcet: 8 ms}}}
"""


def test_an_activity_never_runs_twice_at_once_unless_it_is_reentrant() -> None:
    """Two may come 2 ms apart: the second waits 6 ms for the first. Side by side it takes 8 ms; the bound is above that."""
    assert responses_of(ALONE.replace("OPTIONS", "")) == {"n": 14}
    side_by_side = responses_of(ALONE.replace("OPTIONS", "threads: 3, reentrant: true,"))["n"]
    assert side_by_side is not None
    assert side_by_side >= 8


def test_more_than_one_thread_can_do_is_bounded_where_callbacks_run_side_by_side() -> None:
    """12 ms each 10 ms is too much for one thread, and no more than two cores and a fifth."""
    text = ALONE.replace("wcet: 8 ms", "wcet: 12 ms")
    assert responses_of(text.replace("OPTIONS", "")) == {"n": None}
    assert responses_of(text.replace("OPTIONS", "threads: 4, reentrant: true,"))["n"] is not None


@pytest.mark.parametrize(
    ("place", "expected"),
    [
        ("", {"lidar": 1, "both.fast": 62, "both.slow": 62}),
        ("threads: 2, callback_groups: {one: [fast], two: [slow]}", {"lidar": 1, "both.fast": 2, "both.slow": 60}),
        ("container: nowhere", {"lidar": 1, "both.fast": 62, "both.slow": 62}),
    ],
)
def test_threads_without_a_host_have_a_core_of_their_own(place: str, expected: dict[str, float]) -> None:
    text = FAST_AND_SLOW.replace("CORES", "4").replace(", PLACE", f", {place}" if place else "")
    text = text.replace("lidar: {implements: g.scan, host: cpu}", "lidar: {implements: g.scan}")
    text = text.replace("threads: 4, host: cpu}", "threads: 4, host: cpu}, nowhere: {threads: 3}")
    assert responses_of(text) == expected


CORE_SETS = """
groups: {g: {components: {a: {outputs: {out: D}}, b: {outputs: {out: D}}, c: {outputs: {out: D}}}}}
types: {D: {message: std_msgs/msg/String}}
hosts: {cpu: {cores: 4}}
nodes:
  a: {implements: g.a, host: cpu, timing: {period: 100 ms, wcet: 10 ms, CORES_A}}
  b: {implements: g.b, host: cpu, timing: {period: 100 ms, wcet: 20 ms, CORES_B}}
  c: {implements: g.c, host: cpu, timing: {period: 100 ms, wcet: 5 ms, CORES_C}}
"""


@pytest.mark.parametrize(
    ("cores_of", "expected"),
    [
        # Each has one of three cores, and nobody else comes there.
        (("cores: [0, 1, 2]", "cores: [0, 1, 2]", "cores: [0, 1, 2]"), [10, 20, 5]),
        (("core: 3", "cores: [3]", "core: 0"), [30, 30, 5]),
        # On one core with `b`, and on one that `b` never needs.
        (("cores: [0, 1]", "cores: [1]", "core: 3"), [10, 30, 5]),
        # Two at once: `a` waits until the shorter one of the others has ended.
        (("cores: [0, 1]", "cores: [0, 1]", "cores: [0, 1]"), [15, 25, 15]),
        # `c` has core 2 to itself, whatever the others do.
        (("cores: [0, 1]", "cores: [0, 1]", "cores: [1, 2]"), [15, 25, 5]),
        # A set keeps nobody away: what is not pinned may run there too, and on the other two cores.
        (("cores: [0, 1]", "cores: [0, 1]", ""), [15, 25, 5]),
    ],
)
def test_what_may_run_on_any_core_of_a_set_interferes(cores_of: tuple[str, str, str], expected: list[float]) -> None:
    text = CORE_SETS
    for name, cores in zip("ABC", cores_of, strict=True):
        text = text.replace(f", CORES_{name}", f", {cores}" if cores else "")
    assert list(responses_of(text).values()) == expected


def test_a_group_that_is_pinned_apart_works_on_one_core_at_a_time() -> None:
    """`a` waits for `b` of its group, which waits on its own core for `c`: all of it, on one core, is a bound."""
    text = (
        CORE_SETS[: CORE_SETS.index("nodes:")]
        + """
containers: {box: {threads: 2, host: cpu}}
nodes:
  ab: {implements: [g.a, g.b], container: box}
  c: {implements: g.c, host: cpu, timing: {period: 100 ms, wcet: 5 ms, core: 1}}
"""
    )
    text = text.replace(
        "a: {outputs: {out: D}}", "a: {outputs: {out: D}, timing: {period: 100 ms, wcet: 10 ms, core: 0}}"
    )
    text = text.replace(
        "b: {outputs: {out: D}}", "b: {outputs: {out: D}, timing: {period: 100 ms, wcet: 20 ms, core: 1}}"
    )
    assert responses_of(text) == {"ab.a": 35, "ab.b": 35, "c": 35}


def test_a_set_of_all_cores_divides_no_group() -> None:
    """`a` and `b` are of one node: that `a` names all cores, and `b` none, changes nothing."""
    text = FAST_AND_SLOW.replace("CORES", "4").replace("PLACE", "container: box")
    text = (
        text.replace("priority: 90, ", "")
        .replace(", priority: 50", ", cores: [0, 1, 2, 3]")
        .replace(", priority: 10", "")
    )
    assert responses_of(text)["both.fast"] == 62


def test_what_another_core_has_begun_may_come_twice() -> None:
    """`u` waits for 9 ms while both cores work, then runs on core 1. After 9 ms `q` comes there, and `p` on core 0, where
    1 ms of `u` is left. Its next job comes 2 ms later: `p` ends after 1 + 10 + 9.5 ms.
    """
    text = CORE_SETS.replace("cores: 4", "cores: 2").replace(
        "{period: 100 ms, wcet: 5 ms, CORES_C}", "{period: 20 ms, wcet: 10 ms}"
    )
    text = text.replace("period: 100 ms, wcet: 10 ms, CORES_A", "period: 200 ms, wcet: 9500 us, core: 0")
    text = text.replace("period: 100 ms, wcet: 20 ms, CORES_B", "period: 200 ms, wcet: 9 ms, core: 1")
    response = responses_of(text)["a"]
    assert response is not None
    assert response >= 20.5


@pytest.mark.parametrize("first", try_some(range(0, 240, 30), 1, 4))
def test_no_simulation_exceeds_a_bound_of_threads_groups_and_orders(first: int) -> None:
    found = {seed: exceeded(random_threads_text(seed), seconds=1, seeds=4) for seed in range(first, first + 30)}
    assert {seed: wrong for seed, (wrong, _) in found.items() if wrong} == {}
    assert sum(held for _, held in found.values()) > 400
