"""The profiles of quality of service have the values of ROS 2's middleware interface."""

from __future__ import annotations

from typing import Any

import pytest

from archgen.model.node import QOS_PROFILES, qos_profile
from archgen.schema.language_schema import load_schema


@pytest.mark.parametrize(
    ("name", "reliability", "depth"),
    [
        ("default", "reliable", 10),
        ("sensor_data", "best_effort", 5),
        ("services", "reliable", 10),
        ("parameters", "reliable", 1000),
        ("parameter_events", "reliable", 1000),
        ("system_default", "reliable", None),
    ],
)
def test_profiles(name: str, reliability: str, depth: int | None) -> None:
    found = qos_profile(name, "publishes")
    assert (found.profile, found.reliability, found.depth) == (name, reliability, depth)
    assert (found.durability, found.history, found.deadline) == ("volatile", "keep_last", None)


def test_who_reads_by_the_systems_default_asks_for_best_effort() -> None:
    assert qos_profile("system_default", "subscribes").reliability == "best_effort"
    assert qos_profile("default", "subscribes").reliability == "reliable"


def test_the_language_offers_exactly_these() -> None:
    definitions: dict[str, Any] = load_schema()["$defs"]
    assert set(definitions["qos_profile"]["enum"]) == {*QOS_PROFILES, None}
