"""Which elements a search looks at first: durations in ms."""

from __future__ import annotations

from dataclasses import replace

import pytest

from archgen.timing.analysis import Analysis, ChainResult, ChainTerm
from archgen.timing.figures.timing_values import UNKNOWN_VALUE, TimingValue
from archgen.timing.search.chain_budgets import list_chain_elements, list_neighbours
from tests.timing.made import MS, analysis, event, ms, periodic
from tests.timing.sketches import analyse_sketch

Figure = float | None


def _value(figure: Figure) -> TimingValue:
    return UNKNOWN_VALUE if figure is None else ms(figure)


def _chain(*terms: tuple[str, Figure, Figure, Figure]) -> ChainResult:
    """Return a chain of steps: sampling, response, link."""
    made = tuple(
        ChainTerm(name, _value(sampling), _value(response), _value(link), "")
        for name, sampling, response, link in terms
    )
    none = UNKNOWN_VALUE
    return ChainResult("c", tuple(term.activity for term in made), made, none, none, none, none, None, "open")


def _analyse(wcet: int = 2, response: float = 5) -> Analysis:
    """Return `a` every 100 ms and `b`, fired, which both respond within some time."""
    activities = [periodic("a", 100, wcet=wcet * MS), event("b", wcet=wcet * MS)]
    return analysis(activities, (), {"a": response, "b": response}, {"a": 100, "b": 100})


def _names(activities: list[object]) -> list[str]:
    return [str(getattr(activity, "id", "")) for activity in activities]


@pytest.mark.parametrize(
    ("terms", "names"),
    [
        ([("a", 1, 2, 3), ("b", 1, 2, 4)], ["b", "a"]),
        ([("a", 1, 2, 4), ("b", 1, 2, 3)], ["a", "b"]),
        ([("a", 100, 2, 3), ("b", 1, None, 4)], ["b", "a"]),  # without a bound before all
        ([("a", 1, 2, 3), ("b", 2, 2, 3), ("a", 9, 2, 3)], ["a", "b"]),
    ],
)
def test_the_element_that_adds_most_comes_first(
    terms: list[tuple[str, Figure, Figure, Figure]], names: list[str]
) -> None:
    assert _names([*list_chain_elements(_analyse(), _chain(*terms))]) == names


def test_what_takes_most_of_the_hosts_of_a_chain_comes_first() -> None:
    loads = {"a @p": 50, "b @p": 10, "c @q": 30, "d @p": 20, "e @q": 1, "far @r": 40}
    nodes = {head: f"period: 100 ms, wcet: {load} ms" for head, load in loads.items()}
    made = analyse_sketch(nodes, "", "hosts: {p: {cores: 1}, q: {cores: 1}, r: {cores: 1}}")
    elements = [made.system.activities[name] for name in "ae"]
    assert _names([*list_neighbours(made, elements)]) == ["c", "d", "b"]
    # A host whose load nobody knows adds nothing.
    assert _names([*list_neighbours(replace(made, hosts={"q": made.hosts["q"]}), elements)]) == ["c"]
