"""How figures come about on one core on which activities fire one another."""

from __future__ import annotations

from dataclasses import replace

from archgen.timing.analysis import Analysis
from archgen.timing.chains.figure_explanations import explain_word
from archgen.timing.load.response_terms import ResponseTerms
from tests.timing.sketches import analyse_sketch


def analyse() -> Analysis:
    """Analyse a core on which `b` comes of `a`, which is less urgent, and of `d`, as urgent as itself."""
    nodes = {
        "a @pc": "period: 20 ms, wcet: 7 ms, priority: 1",
        "d @pc": "period: 50 ms, wcet: 9 ms, priority: 2",
        "b @pc": "behaviour: event, trigger: any, wcet: 3 ms, priority: 2",
        "c @pc": "period: 100 ms, wcet: 11 ms, priority: 1",
    }
    return analyse_sketch(nodes, "a>b d>b", "hosts: {pc: {cores: 1}}")


def test_the_time_of_a_run_is_that_of_its_level() -> None:
    """`b` is as urgent as its run is at its least urgent step, `a`."""
    lines = [line.text for line in explain_word(analyse(), {}, "b")]
    first = lines.index("b: at most 75 ms from the event on that enters the core, for the run a > b")
    assert lines[first + 1 : first + 6] == [
        "the least t > 0 in which all of this is done is 75 ms; of each ceil((t + how much later it may come) / how often):",
        "1 x 11 ms c = 11 ms, since ceil(75 ms / 100 ms) = 1, events of c",
        "2 x (9 ms d + 3 ms b) = 24 ms, since ceil(75 ms / 50 ms) = 2, events of d",
        "4 x (7 ms a + 3 ms b) = 40 ms, since ceil(75 ms / 20 ms) = 4, events of a",
        "11 ms + 24 ms + 40 ms = 75 ms",
    ]


def test_a_run_of_which_one_part_cannot_be_explained_has_no_working() -> None:
    """A tick is added to the response of `b`: no terms give that, though the two parts still add up."""
    state = analyse().state
    assert state is not None
    (longest, rest) = sorted(state.ways_to["b"], key=lambda way: -(way.delay or 0))
    response = state.responses["b"]
    tampered = replace(
        state,
        responses={**state.responses, "b": response._replace(value=(response.value or 0) + 1)},
        ways_to={**state.ways_to, "b": (longest._replace(delay=(longest.delay or 0) + 1), rest)},
    )
    assert ResponseTerms(state).find_run("b") is not None
    assert ResponseTerms(tampered).find_run("b") is None
