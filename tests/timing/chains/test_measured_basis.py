"""Measured execution times on which a chain rests: through hosts, resources and triggers."""

from __future__ import annotations

from dataclasses import replace

import pytest

from archgen.timing.chains.measured_basis import describe_measured_basis
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
    assert describe_measured_basis(analysis, ("b",)) == (_SENTENCE.format(names) if names else "")
