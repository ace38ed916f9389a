"""What is shown of a project in an editor: after a key, soon after, at rest."""

from __future__ import annotations

import threading
from pathlib import Path

import pytest

from archgen.live.warm_project import EditedProject, WholeCheck

ROBOT = """\
archgen: 1
groups: {g: {components: {eye: {outputs: {o: std_msgs/msg/Bool}}, brake: {inputs: {i: eye.o}}}}}
"""


@pytest.fixture
def project(tmp_path: Path) -> EditedProject:
    """Open a project."""
    (tmp_path / "archgen.yaml").write_text(ROBOT, encoding="utf-8")
    return EditedProject(tmp_path)


def test_a_request_sees_the_text_as_it_is(project: EditedProject) -> None:
    project.set_text("archgen.yaml", ROBOT.replace("brake", "stop"))
    assert "g.stop" in project.checked.architecture.components
    assert project.line_of("archgen.yaml", 2) == ROBOT.replace("brake", "stop").split("\n")[1]
    assert ("component", "g.stop") in {(name.kind, name.id) for name in project.index.names}
    project.drop_text("archgen.yaml")
    assert "g.brake" in project.checked.architecture.components
    assert project.offered_names["sources"][0].name == "g.eye.o"


def test_a_whole_check_of_an_older_text_is_let_go(project: EditedProject) -> None:
    older = project.start_whole_check()()
    project.set_text("archgen.yaml", ROBOT)
    assert not project.take_whole_check(older)
    assert project.take_whole_check(project.start_whole_check()())
    assert project.is_whole
    project.look_again()
    assert not project.is_whole


def test_a_check_in_a_thread_and_one_beside_it_do_not_meet(project: EditedProject) -> None:
    project.set_text("archgen.yaml", ROBOT)
    check = project.start_whole_check()
    found: list[WholeCheck] = []
    thread = threading.Thread(target=lambda: found.append(check()))
    thread.start()
    for _ in range(5):
        project.check_wholly()
    thread.join()
    names = project.index.names
    assert project.take_whole_check(found[0])
    assert project.index.names == names


def test_what_waits_for_a_slip_goes_at_rest(project: EditedProject) -> None:
    text = ROBOT.replace("o: std", "spare: std_msgs/msg/Bool, o: std")
    project.set_text("archgen.yaml", text)
    project.check_wholly()
    assert "unread-output" in {finding.rule for finding in project.findings}
    project.set_text("archgen.yaml", text.replace("eye.o", "eye.x"))
    project.check_quickly()
    project.settle()
    assert "unread-output" in {finding.rule for finding in project.findings}
    project.check_wholly()
    assert "unread-output" in {finding.rule for finding in project.findings}
    project.settle()
    assert "unread-output" not in {finding.rule for finding in project.findings}
    assert project.lookup.timing is None


def test_a_text_that_was_read_already_is_not_checked_again(project: EditedProject, tmp_path: Path) -> None:
    project.check_wholly()
    checked = project.checked
    assert not project.set_text("archgen.yaml", ROBOT)  # opened
    assert not project.drop_text("archgen.yaml")  # and closed
    assert project.is_whole
    assert project.checked is checked
    assert project.set_text("archgen.yaml", ROBOT.replace("brake", "stop"))
    assert "g.stop" in project.checked.architecture.components
    assert project.drop_text("archgen.yaml")
    project.check_wholly()
    project.set_text("archgen.yaml", ROBOT)
    (tmp_path / "archgen.yaml").write_text(ROBOT.replace("brake", "stop"), encoding="utf-8")
    assert project.drop_text("archgen.yaml")  # another one lies on the disk by now
    assert "g.stop" in project.checked.architecture.components


def test_a_broken_file_that_is_opened_is_mended(project: EditedProject, tmp_path: Path) -> None:
    broken = f"{ROBOT}hosts: {{pc: [\n"
    (tmp_path / "archgen.yaml").write_text(broken, encoding="utf-8")
    project.check_wholly()
    assert project.set_text("archgen.yaml", broken)
    assert "g.eye" in project.checked.architecture.components


def test_a_key_after_opening_falls_back_to_what_could_be_read(project: EditedProject) -> None:
    project.check_wholly()
    project.set_text("archgen.yaml", ROBOT)
    project.set_text("archgen.yaml", "{" + ROBOT)
    assert "g.eye" in project.checked.architecture.components
