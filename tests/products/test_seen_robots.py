"""What a project keeps of robots: nothing, what was written, or why that cannot be read."""

from __future__ import annotations

from pathlib import Path

from archgen.conformance.observed_robot import ObservationKind
from archgen.conformance.seen_record import RECORD_FILE, SeenRobot, write_record
from archgen.pipeline import check_project
from archgen.products.seen_robots import find_seen_components, read_seen_robots

ROBOT = "archgen: 1\ngroups: {g: {components: {a: {outputs: {o: std_msgs/msg/Bool}}, b: {inputs: {i: a.o}}}}}\n"


def test_what_is_kept_is_read_or_told(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(ROBOT, encoding="utf-8")
    assert (read_seen_robots(check_project(tmp_path)), find_seen_components(check_project(tmp_path))) == (
        ((), ""),
        None,
    )
    record = tmp_path / RECORD_FILE
    record.parent.mkdir()
    cases: tuple[tuple[ObservationKind, frozenset[str] | None], ...] = (("workspace", None), ("graph", frozenset()))
    for kind, seen in cases:
        record.write_text(write_record([SeenRobot("rover", "graph.txt", kind, {}, ())]), encoding="utf-8")
        project = check_project(tmp_path)
        assert [robot.name for robot in read_seen_robots(project)[0]] == ["rover"]
        assert find_seen_components(project) == seen
    record.write_text("{", encoding="utf-8")
    robots, obstacle = read_seen_robots(check_project(tmp_path))
    assert robots == ()
    assert obstacle.startswith(f"`{RECORD_FILE}` cannot be read: ")
