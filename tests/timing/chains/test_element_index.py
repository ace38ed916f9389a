"""Measured execution times on which a chain rests: through hosts, resources and triggers."""

from __future__ import annotations

from dataclasses import replace

import pytest

from archgen.timing.chains.element_index import MeasuredBasis
from archgen.timing.run_analysis import analyse_system
from archgen.timing.system.timing_system import Activity, ResourceUse
from tests.simulation.systems import arc, event, system, timed

_SENTENCE = "the execution time of {} is the longest that was seen, not proven"


@pytest.mark.parametrize(
    ("changes", "names"),
    [
        ({}, ""),
        ({"a": {"wcet_measured": True}}, "a"),
        ({"far": {"wcet_measured": True}}, ""),
        ({"far": {"wcet_measured": True, "host": "pc"}}, "far"),
        ({"far": {"wcet_measured": True, "host": "pc"}, "b": {"response": 9}}, ""),
        (
            {"far": {"wcet_measured": True, "uses": {"gpu": ResourceUse(1)}}, "b": {"uses": {"gpu": ResourceUse(1)}}},
            "far",
        ),
        ({"a": {"wcet_measured": True}, "b": {"wcet_measured": True}}, "a, b"),
    ],
)
def test_what_a_chain_rests_on(changes: dict[str, dict[str, object]], names: str) -> None:
    activities: list[Activity] = [timed("a", 10, 1), event("b", 1, "a", host="pc"), timed("far", 10, 1, host="box")]
    changed = [replace(one, **changes.get(one.id, {})) for one in activities]  # type: ignore[arg-type]
    analysis = analyse_system(system(changed, [arc("a", "b")], {"pc": 1, "box": 1}))
    assert MeasuredBasis(analysis).describe(("b",)) == (_SENTENCE.format(names) if names else "")


def test_what_goes_round_rests_on_all_of_it() -> None:
    """`a` and `c` share a host with each other's triggers: both rest on both, and `d` on all before it; `e` on nothing."""
    activities: list[Activity] = [
        event("a", 1, "c", host="pc"),
        event("c", 1, "a", host="box"),
        event("d", 1, "c"),
        timed("e", 10, 1),
    ]
    measured = [replace(one, wcet_measured=True) for one in activities]
    arcs = [arc("a", "c"), arc("c", "a"), arc("c", "d")]
    basis = MeasuredBasis(analyse_system(system(measured, arcs, {"pc": 1, "box": 1})))
    for through, names in (("a", "a, c"), ("c", "a, c"), ("d", "a, c, d"), ("e", "e"), ("ae", "a, c, e")):
        assert basis.describe(through) == _SENTENCE.format(names)
