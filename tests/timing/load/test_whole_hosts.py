"""A host of several cores, taken as one: what goes to and fro between its cores is done as soon as one would do it all."""

from __future__ import annotations

from dataclasses import replace

import pytest

from archgen.timing.load.core_responses import CoreResponses
from archgen.timing.load.level_cascades import EntryWay, EventOrigin
from archgen.timing.load.thread_work import WorstResponse
from archgen.timing.load.whole_hosts import HostLimit, find_whole_hosts, limit_responses, list_host_limits
from archgen.timing.system.core_placement import ProcessingResource
from archgen.timing.system.timing_system import ResourceUse
from archgen.timing.system.trigger_graph import find_triggers
from tests.simulation.systems import arc, event, system, timed
from tests.timing.sketches import analyse_sketch, list_responses

WAYS = {"s": "core: 0", "a": "core: 1", "b": "core: 0", "c": "core: 1", "d": "core: 0", "e": "core: 1"}


@pytest.mark.parametrize(
    ("cost", "last_tier"),
    [
        # Both bounds are the same for the last step: of equal ones the host's is named.
        (15, "whole host"),
        # 6 x 17 ms are more than one core does in 100 ms, but an event never meets the one before it.
        (17, "whole way"),
    ],
)
def test_a_chain_between_two_cores_to_and_fro(cost: int, last_tier: str) -> None:
    timings = f"wcet: {cost} ms, bcet: {cost} ms"
    nodes = {f"{name} @pc": f"{pin}, {timings}" for name, pin in WAYS.items()}
    nodes["s @pc"] = f"period: 100 ms, {nodes['s @pc']}"
    analysis = analyse_sketch(nodes, "s>a a>b b>c c>d d>e", "hosts: {pc: {cores: 2}}")
    tiers = {**dict.fromkeys(WAYS, "whole way"), "e": last_tier}
    assert list_responses(analysis) == [f"{name} {cost}..{cost} {tier}" for name, tier in tiers.items()]


def ways(*delays: int | None) -> tuple[EntryWay, ...]:
    """Return ways to `a` with some delays."""
    return tuple(EntryWay(EventOrigin("activity", "a"), None, ("a",), delay=delay) for delay in delays)


@pytest.mark.parametrize(
    ("response", "delays", "storing_wait", "limit"),
    [
        (WorstResponse(8, "host"), (20, 30), WorstResponse(7, "host"), HostLimit(8, 30, 7)),
        (WorstResponse(8, "host"), (20,), None, HostLimit(8, 20, None)),
        (WorstResponse(8, "host"), (20, None), None, None),
        (WorstResponse(8, "host"), (), None, None),
        (WorstResponse(None, "host"), (20,), None, None),
        (WorstResponse(8, "declared"), (20,), None, None),
    ],
)
def test_the_longest_way_limits_where_all_are_bounded(
    response: WorstResponse, delays: tuple[int | None, ...], storing_wait: WorstResponse | None, limit: HostLimit | None
) -> None:
    waits = {} if storing_wait is None else {"a": storing_wait}
    limits = list_host_limits(CoreResponses({"a": response}, {"a": ways(*delays)}, waits))
    assert limits == ({} if limit is None else {"a": limit})


@pytest.mark.parametrize(
    ("response", "limited"),
    [
        (WorstResponse(9, "host"), WorstResponse(8, "whole host")),
        (WorstResponse(8, "host"), WorstResponse(8, "host")),
        (WorstResponse(None, "host"), WorstResponse(8, "whole host")),
    ],
)
def test_a_longer_response_is_cut(response: WorstResponse, limited: WorstResponse) -> None:
    found = limit_responses(
        CoreResponses({"a": response, "b": response}, {"a": ways(19, 20, 21, None), "b": ways(99)}, {}),
        {"a": HostLimit(8, 20)},
    )
    assert found == CoreResponses({"a": limited, "b": response}, {"a": ways(19, 20, 20, 20), "b": ways(99)}, {})


@pytest.mark.parametrize("tier", ["declared", "unknown"])
def test_what_is_declared_or_unknown_stays(tier: str) -> None:
    found = CoreResponses({"a": WorstResponse(9, tier)}, {"a": ways(99)}, {})  # type: ignore[arg-type]
    assert limit_responses(found, {"a": HostLimit(8, 20)}) == found


@pytest.mark.parametrize(
    ("wait", "limit", "expected"),
    [
        (7, 6, WorstResponse(6, "whole host")),
        (6, 6, WorstResponse(6, "host")),
        (None, 6, WorstResponse(6, "whole host")),
        (7, None, WorstResponse(7, "host")),
    ],
)
def test_a_longer_wait_is_cut(wait: int | None, limit: int | None, expected: WorstResponse) -> None:
    waits = {"a": WorstResponse(wait, "host"), "b": WorstResponse(99, "host")}
    found = limit_responses(CoreResponses({}, {}, waits), {"a": HostLimit(8, 20, limit)})
    assert found.storing_waits == {"a": expected, "b": waits["b"]}


def core(name: str, cores: int = 1, **rest: object) -> ProcessingResource:
    """Return cores of the host that run some activities, each called by one letter."""
    return ProcessingResource(name, "pc", cores, tuple((each,) for each in name), **rest)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("resources", "hosts"),
    [
        ([core("a"), core("b")], ["pc"]),
        ([core("ab", 2)], ["pc"]),
        ([core("ab")], []),  # one core is what it is anyway
        ([core("ab", undisturbed=True)], ["pc"]),  # one of several
        ([core("ab", missing=("cores",))], []),
        ([core("a"), core("c")], []),  # nothing fires anything
        ([core("a"), core("b"), core("g")], []),  # what waits for a GPU leaves all cores idle
        ([core("abg", 2)], []),
        ([replace(core("ab", 2), host=None)], []),
        ([core("c"), core("ab", 2, missing=("cores",))], []),
    ],
)
def test_hosts_of_several_cores_on_which_activities_fire_one_another(
    resources: list[ProcessingResource], hosts: list[str]
) -> None:
    user = timed("g", 100, 1, uses={"gpu": ResourceUse(1, 1)})
    made = system((timed("a", 100, 1), event("b", 1, "a"), timed("c", 100, 1), user), (arc("a", "b"),))
    assert list(find_whole_hosts(made, find_triggers(made), resources)) == hosts
