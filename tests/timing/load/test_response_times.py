"""Response times against published examples and schedules worked out by hand."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from itertools import permutations

import pytest

from archgen.analyses.resource_load import overloaded_host
from archgen.model.architecture import Architecture
from archgen.timing.figures.timing_values import UnknownCause, unite_causes
from archgen.timing.load.busy_windows import ActivityWork, DivergedError, SearchBudget
from archgen.timing.load.event_streams import EventStream
from archgen.timing.load.link_queueing import settle_links
from archgen.timing.load.response_times import AnalysisEffort, RankedThreads, find_responses
from archgen.timing.load.thread_work import ThreadWork
from archgen.timing.run_analysis import analyse_architecture
from archgen.timing.system.core_placement import find_resources
from archgen.timing.system.system_builder import build_system
from tests.timing.random_systems import in_any_order
from tests.timing.sketches import analyse_sketch
from tests.timing.task_sets import MS, periodic, tasks, worst

Derived = Callable[[str], Architecture]


@pytest.mark.parametrize(
    ("sets", "expected"),
    [
        # The sets of the table of numbers to check against.
        ({"a": ("10", "1"), "b": ("20", "2")}, {"a": 1, "b": 3}),
        (
            {"imu": ("5", "1"), "ctrl": ("10", "2"), "loc": ("20", "4"), "plan": ("100", "20")},
            {"imu": 1, "ctrl": 3, "loc": 8, "plan": 55},
        ),
        # Lehoczky, Fixed priority scheduling of periodic task sets with arbitrary deadlines (RTSS 1990): seven jobs
        # of the second task respond in 114, 102, 116, 104, 118, 106, 94; the worst is the fifth.
        ({"one": ("70", "26"), "two": ("100", "62")}, {"one": 26, "two": 118}),
    ],
)
def test_fixed_priorities(derived: Derived, sets: dict[str, tuple[str, str]], expected: dict[str, object]) -> None:
    found = analyse_architecture(derived(tasks({name: periodic(*row) for name, row in sets.items()})))
    assert worst(found) == expected
    assert {response.tier for response in found.responses.values()} == {"priorities"}


def test_jitter_of_what_has_a_higher_priority_adds_jobs(derived: Derived) -> None:
    """Worked by hand: w = 30 + ceil((w + 15)/40) 10 gives 50 where without jitter it gives 40."""
    rows = {"high": periodic("40", "10", "jitter: 15 ms, priority: {p}"), "low": periodic("100", "30")}
    assert worst(analyse_architecture(derived(tasks(rows))))["low"] == 50
    rows["high"] = periodic("40", "10")
    assert worst(analyse_architecture(derived(tasks(rows))))["low"] == 40


def test_own_jitter_above_the_period_queues(derived: Derived) -> None:
    """Three activations at once where the jitter is two periods: the last one waits for the two before it."""
    found = analyse_architecture(derived(tasks({"a": periodic("10", "4", "jitter: 20 ms, priority: 1")})))
    assert worst(found) == {"a": 12}


def test_without_priorities_the_busy_period_counts(derived: Derived) -> None:
    """Work of 26 and 62 each 70 and 100 keeps a processor busy for 694 ms (Lehoczky's example again)."""
    both = derived(tasks({"one": periodic("70", "26", ""), "two": periodic("100", "62", "")}))
    found = analyse_architecture(in_any_order(both))
    assert worst(found) == {"one": 694, "two": 694}
    assert {response.tier for response in found.responses.values()} == {"host"}


def test_ordinary_work_does_not_disturb_what_has_a_priority(derived: Derived) -> None:
    found = analyse_architecture(
        derived(tasks({"fifo": periodic("10", "2", "priority: 1"), "other": periodic("100", "20", "")}))
    )
    assert worst(found) == {"fifo": 2, "other": 26}


def test_utilisation_of_one_is_overload(derived: Derived) -> None:
    found = analyse_architecture(derived(tasks({"a": periodic("10", "5", ""), "b": periodic("20", "10", "")})))
    assert worst(found) == {"a": ("overload",), "b": ("overload",)}
    assert found.hosts["pc"].verdict == "overload"


def test_several_cores_share_what_is_not_pinned(derived: Derived) -> None:
    """Own 2, and both others at once on the two cores: 2 + (2 + 2)/2 = 4. What was pending came with them: 4 + 4 < 10."""
    rows = {name: periodic("10", "2", "") for name in ("a", "b", "c")}
    found = analyse_architecture(derived(tasks(rows, host="cores: 2")))
    assert worst(found) == {"a": 4, "b": 4, "c": 4}
    assert {response.tier for response in found.responses.values()} == {"cores"}


def test_no_more_threads_than_cores_do_not_wait(derived: Derived) -> None:
    rows = {name: periodic("10", "9", "") for name in ("a", "b", "c")}
    assert worst(analyse_architecture(derived(tasks(rows, host="cores: 3")))) == {"a": 9, "b": 9, "c": 9}


def test_pinned_work_is_analysed_core_by_core(derived: Derived) -> None:
    rows = {
        "a": periodic("10", "2", "core: 0"),
        "b": periodic("20", "4", "core: 0"),
        "c": periodic("50", "30", ""),
    }
    found = analyse_architecture(derived(tasks(rows, host="cores: 2")))
    assert worst(found) == {"a": 6, "b": 6, "c": 30}
    assert found.responses["c"].worst.assumptions == ("cores to which something is pinned are kept for it",)


def test_a_core_that_is_not_there_pins_nothing(derived: Derived) -> None:
    rows = {"a": periodic("10", "2", "core: 2"), "b": periodic("20", "4", "core: 3"), "c": periodic("50", "30", "")}
    loose = {"a": periodic("10", "2", ""), "b": periodic("20", "4", ""), "c": periodic("50", "30", "")}
    assert worst(analyse_architecture(derived(tasks(rows, host="cores: 2")))) == worst(
        analyse_architecture(derived(tasks(loose, host="cores: 2")))
    )


def test_an_executor_runs_one_after_the_other(derived: Derived) -> None:
    text = tasks({"a": periodic("10", "2", ""), "b": periodic("20", "4", "")}, host="cores: 4")
    text = text.replace("host: pc", "container: c") + "containers: {c: {host: pc, threads: 1}}\n"
    found = analyse_architecture(derived(text))
    assert worst(found) == {"a": 6, "b": 6}
    assert {response.tier for response in found.responses.values()} == {"executor"}


def test_an_executor_without_a_host_runs_one_after_the_other_all_the_same(derived: Derived) -> None:
    text = tasks({"a": periodic("10", "2", ""), "b": periodic("20", "4", "")})
    text = text.replace("host: pc", "container: c")
    found = analyse_architecture(derived(text + "containers: {c: {threads: 1}}\n"))
    assert worst(found) == {"a": 6, "b": 6}
    assert {response.tier for response in found.responses.values()} == {"executor"}
    assert found.responses["a"].worst.assumptions == ("assuming a dedicated core for container c",)
    assert set(found.hosts) == {"pc"}


def test_more_members_than_threads_wait_for_one(derived: Derived) -> None:
    """As three on two cores: 2 + (2 + 2)/2 = 4; with a thread for each nobody waits."""
    text = tasks({name: periodic("10", "2", "") for name in "abc"}).replace("host: pc", "container: c")
    assert worst(analyse_architecture(derived(text + "containers: {c: {threads: 2}}\n"))) == {"a": 4, "b": 4, "c": 4}
    assert worst(analyse_architecture(derived(text + "containers: {c: {threads: 3}}\n"))) == {"a": 2, "b": 2, "c": 2}


def test_a_container_without_a_host_can_be_overloaded(derived: Derived) -> None:
    text = tasks({"a": periodic("10", "6", ""), "b": periodic("10", "5", "")}).replace("host: pc", "container: c")
    architecture = derived(text + "containers: {c: {threads: 1}}\n")
    found = analyse_architecture(architecture)
    assert worst(found) == {"a": ("overload", "assuming a dedicated core for container c")} | {
        "b": ("overload", "assuming a dedicated core for container c")
    }
    (finding,) = overloaded_host(architecture, found, limit=Fraction(1))
    assert finding.message == "`c` is overloaded: what runs there takes 110 % of its thread"


def test_what_is_not_known_is_named(derived: Derived) -> None:
    rows = {"a": periodic("10", "2", ""), "b": "behaviour: periodic, period: 20 ms"}
    response = analyse_architecture(in_any_order(derived(tasks(rows)))).responses["a"].worst
    assert (response.value, response.complete, response.missing, response.side) == (2 * MS, False, ("b",), "at least")


def test_what_works_only_at_the_start_is_in_nobodys_way(derived: Derived) -> None:
    rows = {"a": periodic("10", "2", ""), "map": "behaviour: once", "grid": "behaviour: once, wcet: 50 ms"}
    found = analyse_architecture(derived(tasks(rows)))
    assert found.responses["a"].worst.value == 2 * MS
    assert found.responses["grid"].worst.value == 64 * MS  # 50 + 7 times 2 in 64
    assert (found.responses["map"].worst.value, found.responses["map"].worst.missing) == (None, ("map",))
    assert found.hosts["pc"].verdict == "schedulable"


def test_a_declared_response_is_used_as_it_is(derived: Derived) -> None:
    rows = {"a": periodic("10", "2", "response: 7 ms"), "b": periodic("20", "4", "")}
    found = analyse_architecture(derived(tasks(rows)))
    # While a waits it is no busy core: what it does then may come together with the next time.
    assert worst(found) == {"a": 7, "b": 8}
    assert found.responses["a"].worst.assumptions == ("assumed",)


def test_jitter_and_responses_find_one_fixed_point(derived: Derived) -> None:
    """Two elements on two hosts, each firing another on the other host. Worked by hand.

    On p: a 10/2, and d (fired by b) 3, without priorities: busy for 5, longer with d's jitter. On q: b 10/2 and c
    (fired by a) 3. Responses of 5 give jitters of 5: 3 ceil((t+5)/10) + 2 ceil(t/10) <= t at 5; so 5 it is.
    """
    text = """
groups:
  g:
    components:
      a: {outputs: {out: std_msgs/msg/Empty}}
      b: {outputs: {out: std_msgs/msg/Empty}}
      c: {inputs: {in_: a.out}}
      d: {inputs: {in_: b.out}}
nodes:
  a: {implements: a, host: p, timing: {period: 10 ms, wcet: 2 ms}}
  b: {implements: b, host: q, timing: {period: 10 ms, wcet: 2 ms}}
  c: {implements: c, host: q, timing: {wcet: 3 ms}}
  d: {implements: d, host: p, timing: {wcet: 3 ms}}
hosts: {p: {cores: 1}, q: {cores: 1}}
links: {lan: {connects: [p, q], latency: 0 ms}}
""".replace("in_", "input")
    found = analyse_architecture(derived(text))
    assert worst(found) == {"a": 5, "b": 5, "c": 5, "d": 5}
    assert found.paces["c"].jitter.value == 5 * MS


def test_what_grows_for_ever_has_diverged(derived: Derived) -> None:
    """Each host fires the other: a response of more makes a jitter of more, and that a response of more still."""
    text = """
groups:
  g:
    components:
      a: {outputs: {out: std_msgs/msg/Empty}}
      b: {inputs: {one: a.out}, outputs: {out: std_msgs/msg/Empty}}
      c: {inputs: {two: b.out}, outputs: {out: std_msgs/msg/Empty}}
      d: {inputs: {three: c.out}}
nodes:
  a: {implements: a, host: p, timing: {period: 10 ms, wcet: 1 ms}}
  b: {implements: b, host: q, timing: {wcet: 4.5 ms}}
  c: {implements: c, host: p, timing: {wcet: 4.5 ms}}
  d: {implements: d, host: q, timing: {wcet: 4.5 ms}}
hosts: {p: {cores: 1}, q: {cores: 1}}
links: {lan: {connects: [p, q], latency: 0 ms}}
"""
    found = analyse_architecture(in_any_order(derived(text)))
    assert found.diverged == ("a", "b", "c", "d")
    assert worst(found) == dict.fromkeys("abcd", ("diverged",))


def test_who_reads_what_an_overload_sends_is_not_overloaded(derived: Derived) -> None:
    text = """
groups:
  g:
    components:
      a: {outputs: {out: std_msgs/msg/Empty}}
      b: {inputs: {one: a.out}, outputs: {out: std_msgs/msg/Empty}}
      c: {inputs: {one: a.out}}
nodes:
  a: {implements: a, host: pc, timing: {period: 10 ms, wcet: 12 ms}}
  b: {implements: b, host: pc3, timing: {behaviour: event}}
  c: {implements: c, host: pc2, timing: {behaviour: event, wcet: 1 ms}}
hosts: {pc: {cores: 1}, pc2: {cores: 1}, pc3: {cores: 1}}
links: {lan: {connects: [pc, pc2, pc3], latency: 0 ms}}
"""
    architecture = derived(text)
    found = analyse_architecture(architecture)
    assert found.responses["a"].worst.assumptions == ("overload",)
    assert (found.responses["b"].worst.missing, found.responses["b"].worst.assumptions) == (("b",), ())
    assert "overload" not in found.responses["c"].worst.assumptions
    assert [finding.element for finding in overloaded_host(architecture, found, limit=Fraction(1))] == ["pc"]


def test_many_tasks_are_quick_and_exact(derived: Derived) -> None:
    rows = {f"t{n}": periodic(str(10 + n), "0.1") for n in range(60)}
    found = analyse_architecture(derived(tasks(rows)))
    assert found.responses["t0"].worst.value == Fraction(MS, 10)
    assert found.responses["t59"].worst.value == 6 * MS


def test_who_waits_for_a_thread_of_its_container_waits_for_the_least_of_those_that_hold_one(derived: Derived) -> None:
    # b and c may hold both threads when a comes: then a waits, however urgent it is.
    rows = {name: periodic("20", "2") for name in "abc"}
    text = tasks(rows).replace("host: pc,", "container: box,") + "containers: {box: {host: pc, threads: 2}}\n"
    assert worst(analyse_architecture(derived(text))) == {"a": 6, "b": 6, "c": 6}
    wide = text.replace("threads: 2", "threads: 3")
    assert worst(analyse_architecture(derived(wide))) == {"a": 2, "b": 4, "c": 6}


def thread(name: str, priority: int, cost: int, cause: UnknownCause | None = None) -> ThreadWork:
    work = ActivityWork(cost, (EventStream(period=100),))
    return ThreadWork((name,), (work,), cause, priority, priority, Fraction(cost, 100))


def test_ranked_threads_may_be_asked_in_any_order() -> None:
    """Six threads of 10 in 100: the first n are busy for 10 n. Asked in every order, they say what a new one says."""
    causes = {3: UnknownCause(("c",)), 5: UnknownCause(("e",))}
    threads = [thread(str(rank), 9 - rank, 10, causes.get(rank)) for rank in range(6)]
    for counts in permutations(range(0, 7, 2)):
        ranked = RankedThreads(threads)
        for count in counts:
            expected = unite_causes(cause for rank, cause in causes.items() if rank < count)
            assert (ranked.cause_of_first(count) or UnknownCause(())) == expected
            assert ranked.busy_period_of_first(count, SearchBudget()) == 10 * count
            assert ranked.demand_of_first(count).within(1) == 10 * count


def test_a_search_that_did_not_end_is_not_taken_for_an_answer() -> None:
    ranked = RankedThreads([thread("a", 2, 60), thread("b", 1, 60)])
    assert ranked.busy_period_of_first(1, SearchBudget()) == 60
    for _ in range(2):
        with pytest.raises(DivergedError):
            ranked.busy_period_of_first(2, SearchBudget(1000))


@pytest.mark.parametrize(
    ("stale", "found"),
    [
        # What has another event model than before bears on itself and on what is less urgent; what has no priority waits
        # for everything.
        ("a", "a b c d"),
        ("b", "b c d"),
        ("c", "c d"),
        ("d", "d"),
        ("", "d"),
        ("a c", "a b c d"),
    ],
)
def test_only_what_something_stale_bears_on_is_looked_at_again(derived: Derived, stale: str, found: str) -> None:
    rows = {name: periodic("10", "1") for name in "abc"} | {"d": periodic("10", "1", "jitter: 0 ms")}
    system, _, state = settle_links(build_system(derived(tasks(rows)))[0])
    (resource,) = find_resources(system)
    effort = AnalysisEffort(SearchBudget(), frozenset(stale.split()))
    again = find_responses(system, resource, state.event_models, effort)
    assert " ".join(sorted(again)) == found
    assert all(again[name] == state.responses[name] for name in again)


def test_the_order_in_which_elements_are_written_does_not_matter() -> None:
    """1, 1 + 2, 1 + 2 + 4: whoever comes first in the files."""
    timing = {"high": "wcet: 1 ms, priority: 9", "middle": "wcet: 2 ms, priority: 5", "low": "wcet: 4 ms, priority: 1"}
    for names in permutations(timing):
        nodes = {f"{name} @pc": f"period: 100 ms, {timing[name]}" for name in names}
        responses = analyse_sketch(nodes, "", "hosts: {pc: {cores: 1}}").responses
        found = {name: responses[name].worst.value for name in timing}
        assert found == {"high": 1 * MS, "middle": 3 * MS, "low": 7 * MS}
