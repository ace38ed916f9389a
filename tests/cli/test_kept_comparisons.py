"""What `archgen conform --keep` keeps, in the figures of `archgen stats` and on a page of the site."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from archgen.conformance.seen_record import RECORD_FILE
from archgen.pipeline import check_project
from tests.cli.conftest import Run
from tests.conformance.rovers import ROVER, check_rover, print_graph
from tests.conformance.test_robot_comparison import cut_node


def test_a_record_behind_a_link_out_of_the_project_is_not_written(
    tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("graph.txt").write_text(print_graph(check_rover(tmp_path / "rover").architecture), encoding="utf-8")
    Path("elsewhere").mkdir()
    Path("rover/.archgen").symlink_to("../elsewhere")
    kept = run("conform", "rover", "--against", "graph.txt", "--keep", "Rover 1")
    assert (kept.status, list(Path("elsewhere").iterdir())) == (2, [])
    assert "is a link that leads out of" in kept.err


def test_what_was_seen_stands_in_figures_and_on_a_page(
    tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A node that is gone, an end of another type; a second robot stands beside the first, and its next comparison in its place."""
    monkeypatch.chdir(tmp_path)
    graph = print_graph(check_rover(tmp_path / "rover").architecture)
    planted = re.sub(
        r"/odom: nav_msgs/msg/Odometry|(Topic type: )nav_msgs/msg/Odometry", r"/odom: nav_msgs/msg/Path", graph
    )
    Path("graph.txt").write_text(graph, encoding="utf-8")
    Path("other.txt").write_text(cut_node(planted, "/arm"), encoding="utf-8")
    assert "seen" not in run("stats", "rover").out
    assert run("conform", "rover", "--against", "graph.txt", "--keep", "Rover 1").err.endswith(
        f"wrote rover/{RECORD_FILE}\n"
    )
    first = (tmp_path / "rover" / RECORD_FILE).read_bytes()
    for _ in range(2):
        run("conform", "rover", "--against", "other.txt", "--keep", "Rover  2")
    progress = json.loads(run("stats", "rover", "--format", "json").out)["progress"]
    assert {row["id"]: row["seen"] for row in progress} == {"rover": 4, "sensing": 2, "motion": 2, "north": 2, "": 2}
    assert "4 (80%)" in run("stats", "rover").out
    run("build", "-C", "rover", "-o", "out", "--only", "site")
    page = Path("out/site/as_built.html").read_text(encoding="utf-8")
    text = " ".join(re.sub(r"<[^>]+>", " ", page).split())
    assert "Seen running on Rover 1 12 of 12 ends as designed (100 %); graph.txt" in text
    assert "Seen running on Rover 2 9 of 12 ends as designed (75 %), differs: 1, not there: 2; other.txt" in text
    assert "does not run on the robot" in text
    assert "<script>x" not in page
    run("conform", "rover", "--against", "graph.txt", "--keep", "Rover 1")
    record = tmp_path / "rover" / RECORD_FILE
    assert first[:200] == record.read_bytes()[:200]
    record.write_text("<<<<<<< ours\n", encoding="utf-8")
    assert "cannot be read" in run("stats", "rover").err
    refused = run("conform", "rover", "--against", "graph.txt", "--keep", "Rover 1")
    assert "nothing was kept" in refused.err
    assert record.read_text(encoding="utf-8") == "<<<<<<< ours\n"
    run("build", "-C", "rover", "-o", "out", "--only", "site")
    assert "move it away" in Path("out/site/as_built.html").read_text(encoding="utf-8")


def test_what_people_call_a_robot_is_text(tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("graph.txt").write_text(print_graph(check_rover(tmp_path / "rover", ROVER).architecture), encoding="utf-8")
    run("conform", "rover", "--against", "graph.txt", "--keep", "<script>x</script>\n`y`")
    assert check_project(tmp_path / "rover").input_files[-1] == RECORD_FILE
    run("build", "-C", "rover", "-o", "out", "--only", "site")
    page = Path("out/site/as_built.html").read_text(encoding="utf-8")
    assert ("&lt;script&gt;x&lt;/script&gt; `y`" in page, "<script>x" in page) == (True, False)
