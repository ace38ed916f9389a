"""What holds up the events of a way on cores that share their work: by hand, in ms."""

from __future__ import annotations

import pytest

from archgen.timing.load.core_paths import SharedWork, WayWork, build_thread_work, build_way_works
from archgen.timing.load.shared_cores import SharedCores
from tests.timing.load.test_idle_backlogs import EVENT, in_ms, prepare
from tests.timing.sketches import analyse_sketch

PC = "hosts: {pc: {cores: 2}}"
NODES = {
    "s @pc": "period: 100 ms, wcet: 10 ms",
    "b +box": f"{EVENT}, wcet: 20 ms",
    "c +box": f"{EVENT}, wcet: 3 ms",
    "t +box": "period: 50 ms, wcet: 5 ms",
}


def prepare_box(cores: int, threads: int) -> SharedCores:
    """Return cores on which s fires b, and b fires c; b, c and t are in a container of some threads."""
    rest = f"hosts: {{pc: {{cores: {cores}}}}}\ncontainers: {{box: {{threads: {threads}, host: pc}}}}"
    return prepare(NODES, "s>b b>c", rest)


def show_work(cores: SharedCores, way_work: WayWork) -> str:
    """Write a way's own steps, the work of others in its threads, and that of others in its containers."""

    def show_shared(shared_work: SharedWork) -> str:
        before = shared_work.way_before[0] if shared_work.way_before else "nothing"
        return f"{in_ms(cores, shared_work.work)} of {shared_work.origin.key} behind {before}"

    steps = " + ".join(f"{name} {in_ms(cores, work)}" for name, work in way_work.step_works)
    others = ", ".join(map(show_shared, way_work.others))
    crowds = "; ".join(f"{', '.join(map(show_shared, members))} in {threads}" for members, threads in way_work.crowds)
    return f"{steps} | {others} | {crowds}"


def show_ways(cores: SharedCores) -> dict[str, str]:
    """Write the work of all ways, by the last steps."""
    return {name: show_work(cores, way_work) for (name, _), way_work in build_way_works(cores).items()}


def test_in_a_thread_with_others_a_way_waits_for_their_work_and_for_its_own_of_other_events() -> None:
    """In one thread, c comes behind b of the same event, and other events of s may bring both again."""
    assert show_ways(prepare_box(2, 1)) == {
        "t": "t 5 | 20 of s behind s, 3 of s behind b | ",
        "s": "s 10 |  | ",
        "b": "s 10 + b 20 | 5 of t behind t, 3 of s behind c | ",
        "c": "s 10 | 5 of t behind t, 20 of s behind b, 3 of s behind c | ",
    }


def test_in_a_container_with_fewer_threads_than_cores_a_way_waits_for_the_others() -> None:
    """What is in a thread of its own there is in nobody's way but its own; c waits for what b and t do."""
    assert show_ways(prepare_box(3, 2)) == {
        "t": "t 5 |  | 20 of s behind b, 3 of s behind c in 2",
        "s": "s 10 |  | ",
        "b": "s 10 + b 20 |  | 5 of t behind t, 3 of s behind c in 2",
        "c": "s 10 + b 20 + c 3 |  | 5 of t behind t, 20 of s behind b, 3 of s behind c in 2",
    }


def test_with_as_many_threads_as_cores_no_core_waits_for_a_thread() -> None:
    assert show_ways(prepare_box(2, 2))["c"] == "s 10 + b 20 + c 3 |  | "


def test_a_thread_holds_all_that_it_may_be_given() -> None:
    """What comes from another thread may be under way there: 20 of b behind s, and 3 of c behind b."""
    cores = prepare_box(2, 1)
    work = build_thread_work(cores, "b")
    assert show_work(cores, work) == " | 5 of t behind nothing, 20 of s behind s, 3 of s behind b | "
    assert (work.key, work.cost, work.slowest, work.left, work.behind, work.from_last) == (("b", 0), 0, 0, 0, 0, 0)
    cores = prepare_box(3, 2)
    assert show_work(cores, build_thread_work(cores, "b")) == (
        " | 20 of s behind s | 5 of t behind t, 3 of s behind c in 2"
    )


def test_what_is_left_comes_behind_and_comes_from_the_last_step_on() -> None:
    cores = prepare_box(3, 2)
    rests = {
        name: [in_ms(cores, ticks) for ticks in (work.cost, work.slowest, work.left, work.behind, work.from_last)]
        for (name, _), work in build_way_works(cores).items()
    }
    assert rests == {
        "t": [5, 5, 5, 0, 5],
        "s": [10, 10, 33, 23, 33],
        "b": [30, 20, 23, 3, 23],
        "c": [33, 20, 3, 0, 3],
    }


def test_a_step_without_work_is_done_at_once() -> None:
    nodes = {"s @pc": "period: 100 ms, wcet: 0 ms", "b @pc": f"{EVENT}, wcet: 20 ms"}
    cores = prepare(nodes, "s>b", PC)
    works = build_way_works(cores)
    assert show_ways(cores) == {"s": "s 0 |  | ", "b": "s 0 + b 20 |  | "}
    twenty = cores.system.activities["b"].wcet
    assert [(work.left, work.behind, work.from_last) for work in works.values()] == [
        (twenty, twenty, twenty),
        (twenty, 0, twenty),
    ]


def test_two_ways_to_a_step_each_bring_its_work() -> None:
    """Behind s, c comes twice: behind a (3 ms), and behind b (4 ms)."""
    nodes = {
        "s @pc": "period: 100 ms, wcet: 1 ms",
        "a @pc": f"{EVENT}, wcet: 3 ms",
        "b @pc": f"{EVENT}, wcet: 4 ms",
        "c @pc": f"{EVENT}, wcet: 5 ms",
    }
    cores = prepare(nodes, "s>a s>b a>c b>c", PC)
    works = build_way_works(cores)
    shown = {key: show_work(cores, works[key]) for key in works if key[0] == "c"}
    assert shown == {
        ("c", 0): "s 1 + a 3 + c 5 | 5 of s behind c | ",
        ("c", 1): "s 1 + b 4 + c 5 | 5 of s behind c | ",
    }
    assert [in_ms(cores, works["s", 0].behind), in_ms(cores, works["a", 0].behind)] == [17, 5]


def test_of_a_caller_nobody_knows_what_is_done_when_its_server_begins() -> None:
    nodes = {"s @pc": "period: 100 ms, wcet: 10 ms", "b @pc": "behaviour: on_demand, wcet: 7 ms"}
    cores = prepare(nodes, "s?b", PC)
    rests = {
        name: [in_ms(cores, ticks) for ticks in (work.left, work.behind, work.from_last)]
        for (name, _), work in build_way_works(cores).items()
    }
    assert rests == {"s": [17, 0, 17], "b": [17, 0, 7]}


def test_a_call_further_down_a_way_counts_as_one_too() -> None:
    """Of b, which is called twice, it is not known what is done behind it."""
    nodes = {
        "s @pc": "period: 100 ms, wcet: 10 ms",
        "a @pc": f"{EVENT}, wcet: 5 ms, calls: {{b: 2}}",
        "b @pc": "behaviour: on_demand, wcet: 7 ms",
        "c @pc": f"{EVENT}, wcet: 1 ms",
    }
    cores = prepare(nodes, "s>a a?b b>c", PC)
    rests = {
        name: [in_ms(cores, ticks) for ticks in (work.left, work.behind, work.from_last)]
        for (name, _), work in build_way_works(cores).items()
    }
    assert rests == {"s": [31, 21, 31], "a": [21, 0, 21], "b": [21, 0, 16], "c": [14, 0, 2]}


def test_where_nothing_takes_time_nothing_is_left() -> None:
    cores = prepare({"s @pc": "period: 9 ms, wcet: 0 ms", "t @pc": "period: 9 ms, wcet: 1 ms"}, "", PC)
    assert build_way_works(cores)["s", 0].left == 0


def test_a_way_within_one_thread_has_no_steps_of_its_own() -> None:
    nodes = {"b +box": "period: 100 ms, wcet: 20 ms", "c +box": f"{EVENT}, wcet: 3 ms"}
    cores = prepare(nodes, "b>c", f"{PC}\ncontainers: {{box: {{threads: 1, host: pc}}}}")
    work = build_way_works(cores)["c", 0]
    assert show_work(cores, work) == " | 20 of b behind nothing, 3 of b behind nothing | "
    assert (work.cost, work.slowest) == (0, 0)


@pytest.mark.parametrize(
    ("threads", "members", "work_of_e"),
    [
        (1, {"o": "behaviour: once, wcet: 6 ms"}, "b 9 + e 3 |  | "),
        (
            2,
            {"o": "behaviour: once, wcet: 6 ms", "f": "period: 50 ms, wcet: 4 ms"},
            "b 9 + e 3 |  | 4 of f behind f in 2",
        ),
    ],
)
def test_what_works_only_at_the_start_holds_up_nothing_that_comes_later(
    threads: int, members: dict[str, str], work_of_e: str
) -> None:
    nodes = {"b @pc": "period: 35 ms, wcet: 9 ms", "e +box": f"{EVENT}, wcet: 3 ms"}
    nodes |= {f"{name} +box": timing for name, timing in members.items()}
    rest = f"hosts: {{pc: {{cores: 3}}}}\ncontainers: {{box: {{threads: {threads}, host: pc}}}}"
    assert show_ways(prepare(nodes, "b>e", rest))["e"] == work_of_e
    assert analyse_sketch(nodes, "b>e", rest).responses["e"].worst.value is not None
