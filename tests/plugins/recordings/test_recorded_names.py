"""What recorded names mean: nodes, subscriptions, services, timers, paths; and what nobody may guess."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.plugins.recordings.recorded_names import CallbackPlace, UnmappedError
from tests.measured_project import PROJECT
from tests.plugins.recordings import recorded
from tests.plugins.recordings.recorded import make_names


def test_subscriptions_fire_or_store(tmp_path: Path) -> None:
    names = make_names(tmp_path)
    assert names.find_subscription("/plan", "/scan") == CallbackPlace("plan")
    assert names.find_subscription("/plan", "/map") == CallbackPlace("plan", "g.planner.map")
    for node, topic, why in (
        ("/plan", "/odd", "this node of the design does not read it"),
        ("/odd", "/scan", "no node of the design has this name"),
    ):
        with pytest.raises(UnmappedError, match=why):
            names.find_subscription(node, topic)


def test_two_nodes_of_one_name_are_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    project = PROJECT.replace("  drive: {implements: base}", "  drive: {implements: base, name: plan}")
    monkeypatch.setattr(recorded, "PROJECT", project)
    with pytest.raises(UnmappedError, match="several nodes of the design have this name"):
        make_names(tmp_path).find_node("/plan")


def test_one_topic_that_two_activities_of_a_node_read_is_not_guessed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    project = PROJECT.replace("checker: {outputs", "checker: {inputs: {scan: scanner.scan}, outputs")
    monkeypatch.setattr(recorded, "PROJECT", project)
    with pytest.raises(UnmappedError, match=r"several activities of this node use it: maps.mapper, maps.checker"):
        make_names(tmp_path).find_subscription("/maps", "/scan")


@pytest.mark.parametrize(
    ("periods", "activities"),
    [
        ((1000, 100), ["maps.mapper", "maps.checker"]),
        ((100.9,), ["maps.checker"]),
        ((102,), [None]),
        ((100, 100), [None, None]),
        ((), []),
    ],
)
def test_timers_are_matched_by_their_periods(
    tmp_path: Path, periods: tuple[float, ...], activities: list[str | None]
) -> None:
    assert make_names(tmp_path).match_timers("/maps", [round(period * 10**6) for period in periods]) == activities
