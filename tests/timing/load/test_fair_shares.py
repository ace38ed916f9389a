"""Threads that share cores fairly: bounds worked by hand, the newcomer's robot, and a simulated kernel that exceeds none."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest

from archgen.emit.terminal.timing_text import format_timing
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.load.fair_cores import ThreadGroup
from archgen.timing.run_analysis import analyse_architecture
from tests.property_sizes import try_some
from tests.timing.random_fair import draw_fair_system, simulate_fair
from tests.timing.random_systems import architecture
from tests.timing.sketches import sketch

MS = 10**6
PERIODIC = "behaviour: periodic, bcet: 0 ms"
LEAD_NOTE = "threads of h lead one another by at most 5 times a slice of 3 ms and a tick of 1 ms"


def responses(nodes: dict[str, str], host: str, rest: str = "") -> dict[str, tuple[Fraction | None, str]]:
    """Return the responses (ms) of a sketch and their tiers."""
    text = sketch(nodes, "", f"hosts: {{h: {host}}}\n{rest}")
    found = analyse_architecture(architecture(text, is_fair=True)).responses
    return {
        name: (None if each.worst.value is None else each.worst.value / MS, each.tier) for name, each in found.items()
    }


def test_a_process_is_cut_once_for_each_of_its_threads() -> None:
    group = ThreadGroup((("a",), ("b",)), 2, is_urgent=False)
    assert [group.cut_work(work, 10) for work in (5, 20, 30)] == [5, 20, 20]
    assert group._replace(width=None).cut_work(30, 10) == group._replace(is_urgent=True).cut_work(30, 10) == 30


def test_no_other_thread_is_served_more_than_the_own_work_and_a_lead() -> None:
    """2 + min(300, 2 + 20) + min(4, 2 + 20) = 28, and in any order all of it: 306."""
    nodes = {
        "a @h": f"{PERIODIC}, period: 1 s, wcet: 2 ms",
        "b @h": f"{PERIODIC}, period: 1 s, wcet: 300 ms",
        "c @h": f"{PERIODIC}, period: 1 s, wcet: 4 ms",
    }
    found = responses(nodes, "{cores: 1}")
    assert found["a"] == (28, "fair")
    assert found["b"] == (306, "host")
    assert responses(nodes, "{cores: 1, scheduling: round_robin}")["a"] == (306, "host")
    # A slice of 1 ms and no tick, three times: 2 + (2 + 3) + 4.
    assert responses(nodes, "{cores: 1, scheduling: {fair: {slice: 1 ms, tick: 0 ms, lead: 3}}}")["a"] == (11, "fair")


def test_light_threads_may_all_be_on_one_core_while_long_ones_keep_the_others_busy() -> None:
    """So what others are served is not divided by the cores: 2 + 4 x 10 + 2 x 22 of them, where all cores are full."""
    nodes = {f"l{at} @h": f"{PERIODIC}, period: 1 s, wcet: 10 ms" for at in range(4)}
    nodes |= {f"b{at} @h": f"{PERIODIC}, period: 1 s, wcet: 700 ms" for at in range(2)}
    nodes["a @h"] = f"{PERIODIC}, period: 1 s, wcet: 2 ms"
    assert responses(nodes, "{cores: 2}")["a"] == (2 + 4 * 10 + 2 * 22, "fair")


def test_real_time_threads_go_first_and_are_not_cut() -> None:
    nodes = {
        "a @h": f"{PERIODIC}, period: 1 s, wcet: 2 ms",
        "b @h": f"{PERIODIC}, period: 1 s, wcet: 300 ms",
        "rt @h": f"{PERIODIC}, period: 1 s, wcet: 100 ms, priority: 5",
    }
    found = responses(nodes, "{cores: 1}")
    assert (found["rt"], found["a"]) == ((100, "priorities"), (2 + 100 + 22, "fair"))


def test_a_neighbour_of_unknown_work_is_served_no_more_either() -> None:
    nodes = {"a @h": f"{PERIODIC}, period: 100 ms, wcet: 2 ms", "b @h": "behaviour: periodic, period: 20 ms"}
    assert responses(nodes, "{cores: 1}")["a"] == (24, "fair")


def test_each_job_of_a_process_with_several_threads_may_wake_up_another_one() -> None:
    """The process of `x` and `y` counts as two threads for `a`: 2 + 2 x 22. Alone each of them has a lead for each job."""
    nodes = {
        "a @h": f"{PERIODIC}, period: 1 s, wcet: 2 ms",
        "x +box": f"{PERIODIC}, period: 1 s, wcet: 300 ms",
        "y +box": f"{PERIODIC}, period: 1 s, wcet: 300 ms",
    }
    box = "containers: {box: {host: h, threads: 2}}"
    assert responses(nodes, "{cores: 1}", box)["a"] == (2 + 2 * 22, "fair")


def test_a_share_of_each_core_that_others_take_makes_all_longer() -> None:
    """9 ms of work take 10 ms beside 10 % of other load, with the lead of the written figures."""
    nodes = {"a @h": f"{PERIODIC}, period: 100 ms, wcet: 9 ms"}
    found = responses(nodes, "{cores: 1, scheduling: {fair: {other_load: 10 %}}}")
    assert found["a"] == (10, "host")


def test_what_nobody_wrote_of_a_fair_order_is_said_at_the_figure() -> None:
    nodes = {"a @h": f"{PERIODIC}, period: 1 s, wcet: 2 ms", "b @h": f"{PERIODIC}, period: 1 s, wcet: 300 ms"}
    for host, notes in (
        ("{cores: 1}", (LEAD_NOTE,)),
        ("{cores: 1, scheduling: fair}", (LEAD_NOTE,)),
        ("{cores: 1, scheduling: {fair: {slice: 3 ms, tick: 1 ms, lead: 5}}}", ()),
    ):
        text = sketch(nodes, "", f"hosts: {{h: {host}}}")
        analysis = analyse_architecture(architecture(text, is_fair=True))
        assert analysis.responses["a"].worst.assumptions == notes
        assert analysis.responses["b"].worst.assumptions == ()


def test_what_only_a_wait_to_be_stored_assumes_of_a_fair_order_is_taken_for_granted() -> None:
    nodes = {
        "s @h": f"{PERIODIC}, period: 1 s, wcet: 1 ms, priority: 5",
        "r +box": f"{PERIODIC}, period: 1 s, wcet: 250 ms",
        "mate +box": f"{PERIODIC}, period: 100 ms, wcet: 6 ms",
        "heavy @h": f"{PERIODIC}, period: 1 s, wcet: 300 ms",
    }
    text = sketch(nodes, "s>r", "hosts: {h: {cores: 1}}\ncontainers: {box: {threads: 1, host: h}}")
    analysis = analyse_architecture(architecture(text, is_fair=True))
    assert {response.tier for response in analysis.responses.values()} == {"priorities", "host"}
    assert sum(LEAD_NOTE in line for line in format_timing(analysis, {}, ())) == 1


def test_other_orders_of_single_cores_are_not_fair() -> None:
    nodes = {
        "a @h": f"{PERIODIC}, period: 1 s, wcet: 2 ms, core: 0",
        "b @h": f"{PERIODIC}, period: 1 s, wcet: 300 ms, core: 0",
        "c @h": f"{PERIODIC}, period: 1 s, wcet: 2 ms, core: 1",
        "d @h": f"{PERIODIC}, period: 1 s, wcet: 300 ms, core: 1",
    }
    found = responses(nodes, "{cores: 2, scheduling: {0: round_robin}}")
    assert (found["a"], found["c"]) == ((302, "host"), (24, "fair"))


@pytest.mark.parametrize(("slice_time", "limit"), [("3 ms", 1300), ("1 ms", 1000), ("0.1 ms", 686)])
def test_the_newcomers_robot_with_a_process_for_each_node(slice_time: str, limit: int) -> None:
    """Eleven threads on four cores. In any order a chain takes 686.75 ms at most."""
    text = (Path(__file__).parents[1] / "search" / "nav_robot.yaml").read_text(encoding="utf-8")
    for old, new in (
        ("container: navbox", "host: pc"),
        ("containers:\n  navbox: {host: pc, threads: 1}\n", ""),
        ("pc: {cores: 4}", f"pc: {{cores: 4, scheduling: {{fair: {{slice: {slice_time}, tick: 1 ms, lead: 5}}}}}}"),
    ):
        text = text.replace(old, new)
    robot = architecture(text, is_fair=True)
    bound = bound_all_chains(analyse_architecture(robot), robot)["scan_and_stop"].bound.value
    assert bound is not None
    assert bound / MS <= limit


def test_other_programs_are_in_the_load_of_their_host_and_in_leads() -> None:
    """2 + (2 + 18) + 4.5 ms of service with a lead of 18 ms, beside 10 % of other load: 24.5 / 0.9."""
    nodes = {
        "a @h": f"{PERIODIC}, period: 1 s, wcet: 1.8 ms",
        "b @h": f"{PERIODIC}, period: 1 s, wcet: 90 ms",
        "c @h": f"{PERIODIC}, period: 1 s, wcet: 3.6 ms",
    }
    host = "{cores: 1, scheduling: {fair: {slice: 2 ms, tick: 1.6 ms, lead: 5, other_load: 10 %}}}"
    # 2 + (2 + 20) + 4, all of it 1 / 0.9 times as long as written.
    assert responses(nodes, host)["a"] == (28, "fair")
    analysis = analyse_architecture(architecture(sketch(nodes, "", f"hosts: {{h: {host}}}"), is_fair=True))
    assert analysis.hosts["h"].utilisation.value == Fraction(954, 10_000) + Fraction(1, 10)
    assert any("other programs take 10 %" in reason.text for reason in analysis.responses["a"].reasons)


def test_a_thread_that_waits_for_the_world_outside_wakes_up_once_more() -> None:
    """A response of 12 ms has 10 ms of waiting in it: 2 + 10 + min(300, 2 + 2 x 20) of the other one."""
    nodes = {
        "a @h": f"{PERIODIC}, period: 1 s, wcet: 2 ms, uses: {{gpu: 10 ms}}",
        "b @h": f"{PERIODIC}, period: 1 s, wcet: 300 ms",
    }
    assert responses(nodes, "{cores: 1}", "resources: {gpu: {host: h}}")["a"] == (2 + 10 + 42, "fair")


def test_threads_that_compute_one_at_a_time_are_not_fair_and_are_served_each() -> None:
    """`x` and `y` are threads of a process in Python: they hand over to one another; for `a` they are two."""
    nodes = {
        "a @h": f"{PERIODIC}, period: 1 s, wcet: 2 ms",
        "x +box": f"{PERIODIC}, period: 1 s, wcet: 300 ms",
        "y +box": f"{PERIODIC}, period: 1 s, wcet: 300 ms",
    }
    text = sketch(nodes, "", "hosts: {h: {cores: 1}}\ncontainers: {box: {host: h, threads: 2}}")
    text = text.replace("container: box", "container: box, language: python")
    found = analyse_architecture(architecture(text, is_fair=True)).responses
    assert (found["a"].worst.value, found["a"].tier) == ((2 + 2 * 22) * MS, "fair")
    assert found["x"].tier != "fair"


@pytest.mark.parametrize("first", try_some(range(0, 300, 30), 1, 5))
def test_no_simulated_kernel_exceeds_a_bound(first: int) -> None:
    tiers: dict[str, int] = {}
    for seed in range(first, first + 30):
        text = draw_fair_system(seed)[0]
        found = analyse_architecture(architecture(text, is_fair=True)).responses
        for name, seen in simulate_fair(seed, runs=2, seconds=0.6).items():
            bound = found[name].worst.value
            tiers[found[name].tier] = tiers.get(found[name].tier, 0) + 1
            assert bound is None or seen <= bound, (seed, name, found[name].tier)
    assert tiers["fair"] > 5


def test_hundreds_of_users_of_one_resource_are_bounded() -> None:
    """Each waits for one use of each other thread, which is counted once for all of them."""
    nodes = {f"u{at} @h": f"{PERIODIC}, period: 1 s, wcet: 1 ms, uses: {{gpu: 600 us}}" for at in range(150)}
    found = responses(nodes, "{cores: 8}", "resources: {gpu: {host: h}}")
    assert {tier for _, tier in found.values()} == {"cores"}
    # 1 + 150 uses, and an eighth of the others' work: of each what comes and what was pending.
    assert {worst for worst, _ in found.values()} == {1 + 150 * Fraction(6, 10) + Fraction(149, 8)}
