"""Members of one container share its threads, and so wait for one another: across cores, and across priorities."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from archgen.model.architecture import Architecture
from archgen.simulation import simulate_system
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.task_sets import MS, worst

Derived = Callable[[str], Architecture]

BOX = """
groups: {g: {components: {a: {}, b: {}, c: {}, d: {}}}}
nodes:
  a: {implements: a, container: box, timing: {period: 20 ms, wcet: 1 ms, bcet: 1 ms, core: 0}}
  b: {implements: b, container: box, timing: {period: 40 ms, wcet: 5 ms, bcet: 5 ms, core: 1}}
  c: {implements: c, container: box, timing: {period: 40 ms, wcet: 5 ms, bcet: 5 ms, core: 1}}
  d: {implements: d, host: pc, timing: {period: 40 ms, wcet: 7 ms, bcet: 7 ms, core: 2}}
containers: {box: {threads: THREADS, host: pc}}
hosts: {pc: {cores: 4}}
"""


def test_who_waits_for_a_thread_waits_for_work_on_other_cores(derived: Derived) -> None:
    """Both threads are held by b and c threads, which take turns on core 1: then a starts only at 9, when b is done, though core 0 is idle.

    While anyone waits, core 0 or 1 works: 1 + 5 + 5 = 11 ms in all. d shares neither threads nor core with them.
    """
    found = analyse_architecture(derived(BOX.replace("THREADS", "2")))
    assert worst(found) == {"a": 11, "b": 11, "c": 11, "d": 7}
    assert "pc core 0 and on those that wait with it" in found.responses["a"].reasons[0].text
    # In any order: the rounds of ROS 2 begin with who is ready.
    executors = {key: replace(each, usual_order=None) for key, each in found.system.executors.items()}
    seen = simulate_system(replace(found.system, executors=executors), 2, 8)
    assert seen.activities["a"].worst_response == 10 * MS


def test_with_a_thread_for_each_member_nobody_waits_across_cores(derived: Derived) -> None:
    found = analyse_architecture(derived(BOX.replace("THREADS", "3")))
    assert worst(found) == {"a": 1, "b": 10, "c": 10, "d": 7}


def test_what_is_too_much_for_one_core_but_not_for_two_has_no_bound_and_is_no_overload(derived: Derived) -> None:
    text = BOX.replace("THREADS", "2").replace("20 ms, wcet: 1 ms, bcet: 1 ms", "20 ms, wcet: 15 ms, bcet: 15 ms")
    found = analyse_architecture(derived(text))
    assert found.responses["a"].worst.assumptions == ("diverged",)
    assert found.hosts["pc"].verdict == "undecided"


def test_one_thread_runs_where_its_first_pinned_member_is(derived: Derived) -> None:
    found = analyse_architecture(derived(BOX.replace("THREADS", "1")))
    assert worst(found) == {"a": 11, "b": 11, "c": 11, "d": 7}
    assert found.responses["c"].worst.assumptions == (
        "container box has one thread: it runs where the first pinned member is",
    )
    assert [name for name, _, _ in found.hosts["pc"].core_loads] == ["pc core 0", "pc core 2"]


def test_a_core_that_is_not_there_keeps_nothing_free(derived: Derived) -> None:
    """The analysis takes d to run anywhere, and so does the simulation: all three cores are there for what is not pinned."""
    text = BOX.replace("THREADS", "3").replace("core: 2", "core: 9").replace("cores: 4", "cores: 3")
    found = analyse_architecture(derived(text))
    assert worst(found)["d"] == 7
    assert simulate_system(found.system, 2, 4).activities["d"].worst_response == 7 * MS


HELD_UP = """
groups: {g: {components: {low: {}, high: {}, middle: {}, other: {}}}}
nodes:
  low: {implements: low, container: box, timing: {period: 1 s, wcet: 1 ms, priority: 1}}
  high: {implements: high, container: box, timing: {period: 10 ms, wcet: 1 ms, priority: 9}}
  middle: {implements: middle, host: pc, timing: {period: 1 s, wcet: 100 ms, priority: 5}}
  other: {implements: other, host: pc, timing: {period: 1 s, wcet: 1 ms, priority: 7}}
containers: {box: {threads: 1, host: pc}}
hosts: {pc: {cores: 1}}
"""


def test_what_a_thread_held_back_comes_at_once_and_delays_who_is_less_urgent(derived: Derived) -> None:
    """While low is begun, middle works for 100 ms: ten jobs of high wait for the thread. When low ends they all come before
    other, which takes 11 ms then, though in a busy period of its priority only one job of high is activated.

    What bounds it is the busy period of all: 1 + 100 + 1 + 12 of high.
    """
    assert worst(analyse_architecture(derived(HELD_UP))) == {"low": 114, "high": 114, "middle": 114, "other": 114}
    alone = HELD_UP.replace("high, container: box", "high, host: pc")
    assert worst(analyse_architecture(derived(alone)))["other"] == 2


GROUP_THAT_WAITS = """
groups: {g: {components: {a: {}, b: {}, c: {}, u: {}}}}
nodes:
  n:
    implements: [a, b, c]
    host: pc
    threads: 2
  u: {implements: u, host: pc, timing: {period: 100 ms, wcet: 1 ms, bcet: 1 ms, uses: {gpu: 10 ms}}}
hosts: {pc: {cores: 2, scheduling: fixed_priority}}
resources: {gpu: {host: pc}}
"""


@pytest.mark.parametrize(("language", "longest"), [("cpp", 18), ("python", 17)])
def test_who_shares_a_group_with_a_user_of_a_gpu_elsewhere_waits_for_all_that_holds_that_up(
    derived: Derived, language: str, longest: int
) -> None:
    """`a` is pinned and urgent; `b` of its group waits for the GPU, and in C++ for the core of `u`, which no priority is above."""
    timings = {
        "a": "{period: 100 ms, wcet: 1 ms, bcet: 1 ms, core: 1, priority: 2}",
        "b": "{period: 100 ms, wcet: 1 ms, bcet: 1 ms, uses: {gpu: 4 ms}}",
        "c": "{period: 100 ms, wcet: 1 ms, bcet: 1 ms}",
    }
    text = GROUP_THAT_WAITS.replace("threads: 2", f"threads: 2\n    language: {language}")
    for name, timing in timings.items():
        text = text.replace(f"{name}: {{}}", f"{name}: {{inputs: {{}}, timing: {timing}}}")
    found = analyse_architecture(derived(text))
    assert found.responses["n.a"].worst.value == longest * MS
    executors = {key: replace(each, usual_order=None) for key, each in found.system.executors.items()}
    seen = simulate_system(replace(found.system, executors=executors), 1, 12).activities["n.a"].worst_response
    assert seen is not None
    assert 16 * MS < seen <= longest * MS
