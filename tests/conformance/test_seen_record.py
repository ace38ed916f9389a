"""What is kept of comparisons with robots: written, read whatever a merge or a hand made of it, held against the model of today."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.conformance.seen_record import (
    EndState,
    SeenDifference,
    SeenRecordError,
    SeenRobot,
    join_states,
    keep_known,
    list_seen_components,
    read_record,
    replace_robots,
    write_record,
)
from tests.conformance.rovers import check_rover

ROBOT = SeenRobot(
    "rover 3", "graph.txt", "graph", {"base publishes /odom": "seen"}, (SeenDifference("other-qos", "a.b", "x"),)
)


def test_a_record_is_read_as_it_was_written_and_told_where_it_is_none() -> None:
    other = SeenRobot("rover 3", "src", "workspace", {})
    newer = SeenRobot("rover 3", "graph.txt", "graph", {"base publishes /odom": "differs"})
    assert read_record(write_record([ROBOT, other])) == (ROBOT, other)
    assert replace_robots([other, ROBOT], [newer]) == (newer, other)
    text = write_record([ROBOT])
    for broken in (
        *(
            "",
            "[]",
            "3",
            "{}",
            "<<<<<<< ours\n",
            "[" * 100_000,
            '{"archgen_conform": 2}',
            '{"archgen_conform": 1, "robots": [3]}',
        ),
        *(
            text.replace('"seen"', "7"),
            text.replace('"seen"', "[]"),
            text.replace('"graph"', '"dream"'),
            text.replace('"ends": {', '"ends": [{'),
        ),
    ):
        with pytest.raises(SeenRecordError):
            read_record(broken)


def test_several_robots_are_told_together_and_only_of_what_the_model_has(tmp_path: Path) -> None:
    architecture = check_rover(tmp_path).architecture
    ends: dict[str, EndState] = {f"{each.node} {each.use} {each.name}": "seen" for each in architecture.endpoints}
    sources = SeenRobot("a", "src", "workspace", {**ends, "gone publishes /x": "seen"})
    graph = SeenRobot(
        "a", "graph.txt", "graph", {**ends, "base publishes /odom": "missing", "camera publishes /image": "untold"}
    )
    known = keep_known(architecture, [sources, graph])
    assert len(known[0].ends) == len(known[1].ends) == 12
    assert [join_states(known, each) for each in ("base publishes /odom", "lidar publishes /scan", "x")] == [
        "seen",
        "seen",
        None,
    ]
    assert list_seen_components(architecture, known) == {"sensing.lidar", "motion.planner", "motion.arm"}
    assert list_seen_components(architecture, [sources]) == frozenset()
