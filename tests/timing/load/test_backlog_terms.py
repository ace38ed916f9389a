"""How a delay comes about that what may be pending bounds: its terms add up, and are printed so that all can be followed."""

from __future__ import annotations

from fractions import Fraction

from archgen.timing.chains.working_lines import WorkingLines
from archgen.timing.load.core_paths import build_thread_work
from archgen.timing.load.shared_core_terms import BacklogTerms
from archgen.timing.load.work_terms import CountFormulas
from tests.timing.hand_reader import read_equations
from tests.timing.load.test_idle_backlogs import EVENT, find_backlog, in_ms, prepare
from tests.timing.load.test_works_of_ways import prepare_box


def test_a_delay_is_what_is_printed() -> None:
    """70 ms = 40 of s and a, and (60 that come + 40 pending - 40) / 2 with both cores busy."""
    nodes = {
        "s @pc": "period: 200 ms, wcet: 10 ms",
        "a @pc": f"{EVENT}, wcet: 30 ms",
        "t @pc": "period: 200 ms, wcet: 20 ms",
    }
    cores = prepare(nodes, "s>a", "hosts: {pc: {cores: 2}}")
    backlog = find_backlog(cores)
    assert backlog is not None
    workings = BacklogTerms(backlog, CountFormulas(cores.system.tick))
    (working,) = workings.list_delays(cores.ways_to["a"][0])
    assert (in_ms(cores, working.value), working.is_consistent) == (70, True)
    lines = [line.text for line in WorkingLines(cores.system.tick).explain_response(working, 0)]
    assert [each.holds for line in lines for each in read_equations(line)] == [True] * 8
    assert "  ".join(lines[-2:]).startswith(
        "B = (20 ms + 40 ms + 40 ms - 40 ms) / 2 = 30 ms: what comes, and 40 ms that"
    )
    (hold,) = workings.list_holds("a", backlog.find_busy_window(build_thread_work(cores, "a")))
    assert hold.is_consistent


def test_a_wait_for_threads_is_part_of_a_but_no_work_that_is_taken_off_b() -> None:
    """(2 x 5 + 2 x 20 + 2 x 3) x 1 / 6 ms for two threads instead of three cores, and (10 + 33 + 38 - 33) / 3 = 16 beside."""
    cores = prepare_box(3, 2)
    backlog = find_backlog(cores)
    assert backlog is not None
    workings = BacklogTerms(backlog, CountFormulas(cores.system.tick))
    (working,) = workings.list_delays(cores.ways_to["c"][0])
    assert (in_ms(cores, working.value), working.activation, working.steps) == (Fraction(175, 3), 1, ("s", "b", "c"))
    lines = [line.text for line in WorkingLines(cores.system.tick).explain_response(working, 0)]
    assert lines[1:] == [
        "1 x (10 ms s + 20 ms b + 3 ms c) = 33 ms, its own",
        (
            "1 x ~9.333 ms t, b, c = ~9.333 ms, others in the container: ((ceil(~90.833 ms / 50 ms)) x 5 ms + "
            "(ceil(~105.333 ms / 100 ms)) x 20 ms + (ceil(~116.667 ms / 100 ms)) x 3 ms) x 1 / (2 x 3), as 2 threads work, "
            "and not 3 cores"
        ),
        "A = 33 ms + ~9.333 ms = ~42.333 ms",
        "2 x 5 ms t = 10 ms, since ceil(~58.333 ms / 50 ms) = 2, events of t",
        "1 x (10 ms s + 20 ms b + 3 ms c) = 33 ms, since ceil(~58.333 ms / 100 ms) = 1, events of s",
        "1 x 5 ms t = 5 ms, events of t that may be ~19.833 ms old",
        "1 x 33 ms s = 33 ms, events of s that may be ~19.333 ms old",
        (
            "B = (10 ms + 33 ms + 5 ms + 33 ms - 33 ms) / 3 = 16 ms: what comes, and 38 ms that may have been pending when a "
            "core was idle last, without the work in A"
        ),
        "~42.333 ms + 16 ms = ~58.333 ms, A + B",
    ]
    (hold,) = workings.list_holds("b", backlog.find_busy_window(build_thread_work(cores, "b")))
    lines = [line.text for line in WorkingLines(cores.system.tick).explain_response(hold, 0)]
    assert lines[1] == (
        "1 x 20 ms b = 20 ms, since ceil(~65.167 ms / 100 ms) = 1, events of s, those of ~24.333 ms before included"
    )
    assert "B = (5 ms + 33 ms + 5 ms + 33 ms - 20 ms) / 3 = ~18.667 ms" in lines[-2]


def test_a_way_of_one_step_is_not_named() -> None:
    cores = prepare_box(3, 2)
    backlog = find_backlog(cores)
    assert backlog is not None
    (working,) = BacklogTerms(backlog, CountFormulas(cores.system.tick)).list_delays(cores.ways_to["s"][0])
    assert working.steps == ()
