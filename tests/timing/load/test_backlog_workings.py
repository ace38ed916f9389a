"""How a delay comes about that what may be pending bounds: its terms add up, and are printed so that all can be followed."""

from __future__ import annotations

from archgen.timing.chains.working_lines import WorkingLines
from archgen.timing.load.backlog_workings import BacklogWorkings
from archgen.timing.load.way_works import build_thread_work
from archgen.timing.load.work_terms import CountFormulas
from tests.timing.hand_reader import read_equations
from tests.timing.load.test_idle_backlogs import EVENT, find_backlog, in_ms, prepare


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
    workings = BacklogWorkings(backlog, CountFormulas(cores.system.tick))
    (working,) = workings.list_delays(cores.ways_to["a"][0])
    assert (in_ms(cores, working.value), working.is_consistent) == (70, True)
    lines = [line.text for line in WorkingLines(cores.system.tick).explain_response(working, 0)]
    assert [each.holds for line in lines for each in read_equations(line)] == [True] * 8
    assert "  ".join(lines[-2:]).startswith(
        "B = (20 ms + 40 ms + 40 ms - 40 ms) / 2 = 30 ms: what comes, and 40 ms that"
    )
    (hold,) = workings.list_holds("a", backlog.find_busy_window(build_thread_work(cores, "a")))
    assert hold.is_consistent
