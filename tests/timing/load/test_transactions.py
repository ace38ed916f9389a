"""Transactions: which cores fire one another in turn, what their ways are, and what runs beside them."""

from __future__ import annotations

from archgen.timing.load.transactions import Transactions, find_transactions
from archgen.timing.system.core_placement import find_resources
from archgen.timing.system.timing_system import TimingSystem
from archgen.timing.system.trigger_graph import find_triggers
from tests.simulation.systems import arc, call, event, system, timed


def find(of: TimingSystem) -> list[Transactions]:
    """Return the transactions of a system whose resources are called by their numbers."""
    resources = {str(number): resource for number, resource in enumerate(find_resources(of))}
    return list(find_transactions(of, find_triggers(of), resources, of.arcs))


CORES = {"one": 1, "two": 1}


def hosted(*, there: str = "two", **rest: object) -> TimingSystem:
    """Make a chain a > b > c, of which b is on another host."""
    return system(
        (
            timed("a", 100, 1, host="one"),
            event("b", 2, "a", host=there),
            event("c", 3, "b", host="one", **rest),
            timed("x", 50, 1, host="one"),
        ),
        (arc("a", "b", link="lan", best=1, worst=2), arc("b", "c", link="lan", best=1, worst=2)),
        {"one": 1, "two": 1, "three": 1},
    )


def test_ways_over_links_have_their_shortest_and_their_longest_time() -> None:
    (found,) = find(hosted())
    assert {(way.steps, way.best_before, way.link_time) for way in found.ways.values()} == {
        (("a",), 0, 0),
        (("a", "b"), 2, 2),
        (("a", "b", "c"), 5, 4),
        (("x",), 0, 0),
    }
    assert [len(path) for path in found.paths.values()] == [len(way.steps) for way in found.ways.values()]
    assert not found.forked_origins
    assert found.outer_ids == ()


def test_hosts_that_fire_one_another_one_way_only_have_none() -> None:
    chain = hosted()
    assert find(system(tuple(chain.activities.values())[:2], chain.arcs[:1], CORES)) == []


def test_what_is_declared_ends_a_way() -> None:
    of = hosted()
    activities = [
        event("b", 2, "a", host="two", response=9) if each.id == "b" else each for each in of.activities.values()
    ]
    (found,) = find(system(activities, of.arcs, CORES))
    assert ("c",) in {way.steps for way in found.ways.values()}


def test_a_call_begins_a_way_of_its_own() -> None:
    request, answer = call("b", "s")
    of = hosted()
    server = event("s", 1, host="one", behaviour="on_demand")
    (found,) = find(system((*of.activities.values(), server), (*of.arcs, request, answer), CORES))
    assert [way.steps for way in found.ways_to["s"]] == [("s",)]


def test_a_fork_is_known() -> None:
    of = hosted()
    (found,) = find(
        system((*of.activities.values(), event("d", 1, "b", host="one")), (*of.arcs, arc("b", "d", worst=1)), CORES)
    )
    assert [origin.key for origin in found.forked_origins] == ["a"]


def test_pinned_cores_are_places_as_hosts_are() -> None:
    (found,) = find(
        system(
            (
                timed("a", 10, 1, host="pc", cores=(0,)),
                event("b", 1, "a", host="pc", cores=(1,)),
                event("c", 1, "b", host="pc", cores=(0,)),
            ),
            (arc("a", "b"), arc("b", "c")),
            {"pc": 2},
        )
    )
    assert sorted(found.places) == ["0", "1"]
    assert [place.core_count for place in found.places.values()] == [1, 1]
