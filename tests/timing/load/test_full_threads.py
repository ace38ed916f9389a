"""Threads without a bound on several cores, and the bounds of all others on the cores that are left."""

from __future__ import annotations

import pytest

from archgen.timing.load.full_threads import find_full_ids, leave_out_threads
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.exceeded import exceeded
from tests.timing.load.test_idle_backlogs import EVENT, prepare
from tests.timing.printed import show_ms
from tests.timing.sketches import analyse_sketch, explain, read_sketch, sketch

TIMER = "period: 100 ms, wcet: 10 ms"


def find_worst(nodes: dict[str, str], wires: str = "", rest: str = "hosts: {pc: {cores: 3}}") -> dict[str, str]:
    """Return the largest responses, in ms."""
    responses = analyse_sketch(nodes, wires, rest).responses
    return {name: show_ms(response.worst) for name, response in responses.items()}


@pytest.mark.parametrize("cost", ["90 ms", "250 ms"])
def test_one_thread_without_a_bound_takes_one_core(cost: str) -> None:
    """The others have two cores, as if they were alone on them; what the full thread fires is as full."""
    others = {f"n{at} @pc": TIMER for at in range(6)}
    nodes = {"full @pc": f"period: 100 ms, wcet: {cost}", "fed @pc": f"{EVENT}, wcet: 1 ms", **others}
    found = find_worst(nodes, "full>fed", "hosts: {pc: {cores: 4}}")
    alone = find_worst(others, "", "hosts: {pc: {cores: 2}}")
    assert {name: found[name] for name in alone} == alone
    assert {found[name].split(" ")[0] for name in ("full", "fed")} == {"none"}


def test_as_many_full_threads_as_cores_leave_nothing() -> None:
    full = {f"full{at} @pc": "period: 10 ms, wcet: 11 ms" for at in range(3)}
    assert find_worst({**full, "n @pc": TIMER})["n"] == "none [overload]"
    del full["full0 @pc"]
    assert find_worst({**full, "n @pc": TIMER})["n"] == "10"


def test_what_waits_for_a_full_thread_is_full() -> None:
    """It may be fired by it, or be in its container: that has two threads, and so takes two cores at most."""
    nodes = {
        "full +box": "period: 10 ms, wcet: 11 ms",
        "a +box": TIMER,
        "b +box": TIMER,
        "fed @pc": f"{EVENT}, wcet: 1 ms",
        "n @pc": TIMER,
    }
    cores = prepare(nodes, "full>fed", "hosts: {pc: {cores: 4}}\ncontainers: {box: {threads: 2, host: pc}}")
    full_ids = find_full_ids(cores, [cores.unit_of["full"]])
    assert full_ids == {"full", "a", "b", "fed"}
    left = leave_out_threads(cores, full_ids)
    assert left is not None
    assert (left.core_count, left.inner_triggers.order) == (1, ("n",))
    assert leave_out_threads(cores, {*full_ids, "n"}) is None


def test_how_a_bound_beside_a_full_thread_comes_about_names_it() -> None:
    nodes = {"full @pc": "period: 20 ms, wcet: 30 ms", **{f"n{at} @pc": TIMER for at in range(3)}}
    model = read_sketch(nodes, "", "hosts: {pc: {cores: 3}}")
    lines = explain(analyse_architecture(model), model, "n0")
    assert any("all cores but those of full, which may be busy all the time (2 are left)" in line for line in lines)


def test_no_simulation_exceeds_a_bound_beside_full_threads() -> None:
    nodes = {
        "full @pc": "period: 20 ms, wcet: 30 ms",
        "tight @pc": "period: 20 ms, wcet: 17 ms",
        "s @pc": "period: 50 ms, wcet: 10 ms",
        "a @pc": f"{EVENT}, wcet: 10 ms",
        "b @pc": f"{EVENT}, wcet: 5 ms",
        "t @pc": "period: 40 ms, wcet: 8 ms",
    }
    rest = "hosts: {pc: {cores: 4}}\nchains: {c: {through: [g.s, g.b]}}"
    found = find_worst(nodes, "s>a a>b", rest)
    assert "none" not in "".join(found[name] for name in "sabt")
    wrong, held = exceeded(sketch(nodes, "s>a a>b", rest))
    assert (wrong, held > 6) == ([], True)
