"""A project over time: which commits count, what is counted, what is kept, in real repositories."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema_rs
import pytest

from archgen import git, pipeline
from archgen.emit.terminal import history_text
from archgen.history import count_history, history_counting
from archgen.history.project_commits import list_commits
from archgen.pipeline import CheckedProject
from archgen.project import LoadedProject, find_tracked_project
from tests import repositories
from tests.running import ROOT, archgen_here

START = """\
archgen: 1
partners: {p: {title: Partner P}, q: {title: "=Q"}}
groups:
  sensing:
    owner: p
    components:
      camera: {outputs: {image: {type: sensor_msgs/msg/Image}}}
"""
SECOND = """\
  acting:
    owner: q
    components:
      arm: {functionality: Grasps., inputs: {image: camera.image}}
nodes: {arm: {implements: arm}, camera: {implements: camera}}
"""
DAYS = ("2026-01-05", "2026-01-20", "2026-02-03", "2026-03-01")


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Make a repository of four commits: a stub, what is beside the project, a second group, and a comment."""
    folder = repositories.repository(tmp_path / "work")
    changes: tuple[dict[str, str | bytes], ...] = (
        {"robot/archgen.yaml": START},
        {"notes.txt": "beside the project"},
        {"robot/archgen.yaml": START + SECOND},
        {"robot/archgen.yaml": START + SECOND + "# a comment\n"},
    )
    for day, files in zip(DAYS, changes, strict=True):
        monkeypatch.setenv("GIT_COMMITTER_DATE", f"{day}T12:00:00+0000")
        repositories.commit(folder, files)
    return folder / "robot"


def test_a_point_for_each_commit_that_changed_the_project(robot: Path) -> None:
    found = count_history(robot)
    assert [point.day for point in found.points] == ["2026-01-05", "2026-02-03", "2026-03-01"]
    assert [
        (p.groups, p.nodes, p.connections, p.project_row.components, p.project_row.mapped) for p in found.points
    ] == [
        (1, 0, 0, 1, 0),
        (2, 2, 1, 2, 2),
        (2, 2, 1, 2, 2),
    ]
    assert found.whole


def test_findings_count_for_the_whole_the_group_and_the_partner(robot: Path) -> None:
    rows = {(row.scope, row.id): row.findings.warning for row in count_history(robot).points[0].rows}
    said = json.loads(archgen_here("check", "--format", "json", cwd=robot).stdout)["summary"]
    assert rows["project", "archgen" if ("project", "archgen") in rows else "robot"] > said["warning"]
    assert rows["group", "sensing"] == rows["partner", "p"] > 0
    assert rows["partner", "q"] == 0


def test_months_are_their_last_commits(robot: Path) -> None:
    assert [point.day for point in count_history(robot, "month").points] == ["2026-01-05", "2026-02-03", "2026-03-01"]


def test_what_is_kept_is_taken_and_what_is_broken_is_counted_again(
    robot: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cache = tmp_path / "cache"
    first = count_history(robot, cache=cache)
    (file,) = cache.iterdir()
    with monkeypatch.context() as patched:
        patched.setattr(history_counting, "count_commits", lambda *_: pytest.fail("nothing is left to count"))
        assert count_history(robot, cache=cache) == first
    for wrong in (
        b"",
        b"{",
        b"[]",
        b'{"x": 1}',
        json.dumps({key: {} for key in json.loads(file.read_bytes())}).encode(),
    ):
        file.write_bytes(wrong)
        assert count_history(robot, cache=cache) == first


def test_several_processes_count_what_one_counts(robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    line = list_commits(find_tracked_project(robot), "revision")
    alone = history_counting.count_commits(robot, line)
    monkeypatch.setattr(history_counting, "_COMMITS_PER_PROCESS", 1)
    monkeypatch.setattr("os.cpu_count", lambda: 3)
    told: list[tuple[int, int]] = []
    assert history_counting.count_commits(robot, line, lambda done, of: told.append((done, of))) == alone
    assert sorted(told) == [(1, 3), (2, 3), (3, 3)]


def test_a_killed_process_costs_time_only(robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    line = list_commits(find_tracked_project(robot), "revision")
    alone = history_counting.count_commits(robot, line)
    monkeypatch.setattr(history_counting, "_COMMITS_PER_PROCESS", 1)
    monkeypatch.setattr("os.cpu_count", lambda: 2)
    monkeypatch.setattr(history_counting, "_START", "raise SystemExit({root!r} and 1)")
    assert history_counting.count_commits(robot, line) == alone


def test_a_process_that_dies_in_the_middle_of_a_line_costs_time_only(
    robot: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    line = list_commits(find_tracked_project(robot), "revision")
    alone = history_counting.count_commits(robot, line)
    monkeypatch.setattr(history_counting, "_COMMITS_PER_PROCESS", 1)
    monkeypatch.setattr("os.cpu_count", lambda: 2)
    thread_errors: list[object] = []
    monkeypatch.setattr("threading.excepthook", thread_errors.append)
    for half in ('{{"commit":', "null", "[1]", '{{"rows": []}}'):
        monkeypatch.setattr(history_counting, "_START", f"import sys; {{root!r}}; sys.stdout.write({half!r})")
        assert history_counting.count_commits(robot, line) == alone
    assert not thread_errors


def test_a_revision_that_does_not_load_has_its_errors(tmp_path: Path) -> None:
    folder = repositories.repository(tmp_path / "robot", {"archgen.yaml": START})
    repositories.commit(folder, {"archgen.yaml": "groups: [\n"})
    last = count_history(folder).points[-1]
    assert (last.project_row.components, last.project_row.findings.error > 0) == (0, True)


def test_a_shallow_clone_says_so(robot: Path, tmp_path: Path) -> None:
    repositories.git(tmp_path, "clone", "-q", "--depth", "1", f"file://{robot.parent}", "shallow")
    found = count_history(tmp_path / "shallow/robot")
    assert (len(found.points), found.whole) == (1, False)
    text = history_text.format_history(found)
    assert text.startswith("this clone is shallow")
    assert "\nfrom " not in text  # there is nothing to compare it with


def test_where_nothing_was_committed_there_is_an_error(tmp_path: Path) -> None:
    folder = repositories.repository(tmp_path / "robot")
    (folder / "archgen.yaml").write_text(START)
    with pytest.raises(git.NoCommitsError):
        count_history(folder)
    done = archgen_here("stats", "--history", cwd=folder, status=2)
    assert b"nothing was committed in this repository yet" in done.stderr


def test_the_terminal_shows_what_grew(robot: Path, tmp_path: Path) -> None:
    env = {"XDG_CACHE_HOME": str(tmp_path / "cache")}
    lines = archgen_here("stats", "--history", "--by", "month", cwd=robot, env=env).stdout.decode().splitlines()
    assert lines[0].split() == [
        *("when", "groups", "components", "connections", "nodes"),
        *("described", "typed", "mapped", "timed", "traced", "findings"),
    ]
    assert lines[1].split()[:5] == ["2026-01", "1", "1", "0", "0"]
    assert lines[5] == "from 2026-01 to 2026-03"
    assert lines[7].split()[:6] == ["group", "Sensing", "1", "0", "%", "100"]


def test_json_is_as_the_schema_says_and_csv_is_safe_to_open(robot: Path, tmp_path: Path) -> None:
    env = {"XDG_CACHE_HOME": str(tmp_path / "cache")}
    data = json.loads(archgen_here("stats", "--history", "--format", "json", cwd=robot, env=env).stdout)
    schema = json.loads((ROOT / "schemas/history.schema.json").read_text(encoding="utf-8"))
    jsonschema_rs.validator_for(schema).validate(data)
    assert (data["by"], data["complete"], len(data["points"])) == ("revision", True, 3)
    rows = archgen_here("stats", "--history", "--format", "csv", cwd=robot, env=env).stdout.decode().splitlines()
    assert rows[0].startswith("commit,day,scope,id,title,components,described")
    assert any(",partner,q,'=Q,1," in row for row in rows)


def test_options_that_need_the_history(robot: Path) -> None:
    for words in (("--by", "month"), ("--format", "csv")):
        assert b"belong to --history" in archgen_here("stats", *words, cwd=robot, status=2).stderr


def test_a_folder_older_than_the_project_in_it(tmp_path: Path) -> None:
    folder = repositories.repository(tmp_path / "work", {"notes.txt": "before there was a project"})
    repositories.commit(folder, {"archgen.yaml": START})
    assert [point.project_row.components for point in count_history(folder).points] == [1]


def test_csv_shows_what_a_terminal_or_a_workflow_would_obey(tmp_path: Path) -> None:
    title = r'"P\n::error::x \e[31m"'
    folder = repositories.repository(tmp_path / "work", {"archgen.yaml": START.replace("Partner P", title)})
    out = history_text.history_to_csv(count_history(folder))
    assert "P\n\\::error::x ␛[31m" in out
    assert "\x1b" not in out


def test_what_says_the_same_is_judged_once(robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    judged = []

    def judge(loaded: LoadedProject, _: object) -> CheckedProject:
        judged.append(loaded.files.commit)
        return pipeline.judge_project(loaded)

    monkeypatch.setattr(pipeline, "check_loaded_project", judge)
    points = count_history(robot).points
    assert len(judged) == 2  # the third only adds a comment
    assert points[1].project_row == points[2].project_row
    repositories.commit(robot.parent, {"robot/archgen.yaml": START + SECOND.replace("{implements: arm}", "{}")})
    assert count_history(robot).points[-1].project_row.mapped == 1


def test_a_comment_that_silences_a_finding_counts(tmp_path: Path) -> None:
    line = "      camera: {outputs: {image: {type: sensor_msgs/msg/Image}}}\n"
    folder = repositories.repository(tmp_path / "robot", {"archgen.yaml": START})
    repositories.commit(
        folder, {"archgen.yaml": START.replace(line, f"{line[:-1]}  # archgen: ignore[unread-output] later\n")}
    )
    repositories.commit(folder, {"archgen.yaml": START + "# archgen: ignore[unread-output] later\n"})
    first, second, third = (point.project_row.findings.warning for point in count_history(folder).points)
    assert second < first <= third
