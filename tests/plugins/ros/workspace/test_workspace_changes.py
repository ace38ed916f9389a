"""A pull request that changes code and not the model: `archgen review` says what differs since, and nothing of before."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent

import pytest

from archgen.products import reviewed_change
from tests.cli.conftest import Run
from tests.plugins.ros.workspace.test_workspace_import import WORKSPACE, write_workspace
from tests.repositories import commit, git, repository

DRIVER = "src/my_driver/my_driver/driver.py"


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, run: Run) -> Path:
    """Return a repository on a branch, with a workspace and its model, which differs from it already at one place."""
    pytest.importorskip("tree_sitter_cpp")
    root = repository(tmp_path / "r", {"README.md": "x"})
    monkeypatch.chdir(root)
    write_workspace(root / "src", WORKSPACE)
    assert run("import", "workspace", "src", "--distro", "humble", "-o", "robot").status == 0
    project = root / "robot/archgen.yaml"
    project.write_text(project.read_text(encoding="utf-8") + "conform: {against: ../src}\n", encoding="utf-8")
    filter_file = "src/my_filter/src/filter.cpp"
    commit(root, {filter_file: Path(filter_file).read_text(encoding="utf-8").replace("SensorDataQoS()", "QoS(5)")})
    git(root, "checkout", "-q", "-b", "change")
    return root


def review(run: Run) -> tuple[int, str, str]:
    done = run("review", "robot", "--base", "main", "--no-build", "-o", "out")
    return done.status, done.out + done.err, Path("out/comment.md").read_text(encoding="utf-8")


def test_what_a_change_of_the_code_alters_is_told(robot: Path, run: Run) -> None:
    """The service that is gone since is an error at its line in the model; that QoS differed before is nobody's news."""
    text = (robot / DRIVER).read_text(encoding="utf-8")
    commit(robot, {DRIVER: text.replace('self.create_service(Trigger, "~/reset", self.reset)', "pass")})
    status, shown, comment = review(run)
    assert status == 1
    assert "error[not-running]: `/front/front_driver` does not serve `/front/front_driver/reset` in ../src" in shown
    assert "other-qos" not in shown
    assert (
        "### Code and model\n\nThis change alters the code, and the model does not say so:\n\n- error `not-running`: "
        in comment
    )
    assert "; in the code `../src/my_bringup/launch/robot.launch.py:12`" in comment
    assert "not-running" in Path("out/findings.sarif").read_text(encoding="utf-8")


def test_a_change_of_both_alters_nothing(robot: Path, run: Run) -> None:
    text = (robot / DRIVER).read_text(encoding="utf-8")
    model = (robot / "robot/robot.yaml").read_text(encoding="utf-8")
    assert '    serves: {reset: "~/reset"}\n' in model
    changed = model.replace('    serves: {reset: "~/reset"}\n', '    serves: {reset: "~/again"}\n')
    commit(robot, {DRIVER: text.replace('"~/reset"', '"~/again"'), "robot/robot.yaml": changed})
    status, shown, comment = review(run)
    assert "Code and model" not in comment
    assert "not-running" not in shown
    assert "other-name" not in shown
    assert status in {0, 1}


def test_a_workspace_that_cannot_be_read_is_said(robot: Path, run: Run) -> None:
    """What the branch itself says of the comparison does not count: it may not switch it off, or lead it elsewhere."""
    project = (robot / "robot/archgen.yaml").read_text(encoding="utf-8")
    broken = dedent(WORKSPACE["my_bringup/launch/robot.launch.py"])
    commit(
        robot,
        {"robot/archgen.yaml": project.replace("../src", "../other"), "src/my_bringup/launch/other.launch.py": broken},
    )
    _, shown, comment = review(run)
    assert "warning: ../src is not held against the model: " in shown
    assert "2 launch files start nodes, and none of them includes the others" in shown
    assert "Code and model" not in comment


def test_what_a_branch_puts_in_the_place_of_a_workspace_is_not_read(robot: Path, run: Run) -> None:
    for manifest in (robot / "src").rglob("package.xml"):
        manifest.unlink()
    bag = (
        "rosbag2_bagfile_information:\n  version: 5\n  duration: {nanoseconds: 1000}\n  topics_with_message_count: []\n"
    )
    commit(robot, {"src/metadata.yaml": bag, "src/x.mcap": "no bag at all"})
    _, shown, comment = review(run)
    assert "warning: ../src is not held against the model: " in shown
    assert "it is nothing that says how a robot is; give one of these: a folder with packages of ROS\n" in shown
    assert "Code and model" not in comment


def test_a_workspace_that_is_too_large_is_said(robot: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reviewed_change, "_MAX_FILES", 3)
    commit(robot, {"README.md": "y"})
    assert "warning: ../src is not held against the model: src: it holds more than 3 files, or 200 MB" in review(run)[1]


def test_a_link_of_the_branch_leads_nowhere_else(robot: Path, run: Run, tmp_path: Path) -> None:
    """What lies outside of the repository is not read, whatever the branch makes of its folder of sources."""
    (robot / "src").rename(tmp_path / "elsewhere")
    (robot / "src").symlink_to(tmp_path / "elsewhere")
    git(robot, "add", "-A")
    git(robot, "commit", "-q", "-m", "x")
    assert "warning: ../src is not held against the model: it is no folder of this repository" in review(run)[1]
